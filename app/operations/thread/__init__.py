"""Thread milling: threads in holes and on bosses, on a helix."""

from __future__ import annotations

from ...model.hole_operations import ThreadOperation
from ..holes import circles_missed
from ..registry import OperationMethod, register
from .paths import VERB, thread
from .proof import milled_proof

register(ThreadOperation, OperationMethod(thread, circles_missed(VERB), proof=milled_proof))
