"""Tapping: threads by a tap, which the control leads in a cycle of its own."""

from __future__ import annotations

from ...model.hole_operations import TapOperation
from ..holes import circles_missed
from ..registry import OperationMethod, register
from .paths import VERB, tap, tapped_proof

register(TapOperation, OperationMethod(tap, circles_missed(VERB), proof=tapped_proof))
