"""Reaming: drilled holes brought to size, down and out at feed."""

from __future__ import annotations

from ...model.hole_operations import ReamOperation
from ..holes import circles_missed
from ..registry import OperationMethod, register
from .paths import VERB, ream

register(ReamOperation, OperationMethod(ream, circles_missed(VERB)))
