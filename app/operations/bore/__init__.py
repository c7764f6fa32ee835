"""Boring: circles milled on a helix, with a finishing turn; counterbores."""

from __future__ import annotations

from ...model.hole_operations import BoreOperation
from ..holes import circles_missed
from ..registry import OperationMethod, register
from .paths import VERB, bore

register(BoreOperation, OperationMethod(bore, circles_missed(VERB)))
