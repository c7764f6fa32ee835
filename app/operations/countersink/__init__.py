"""Countersinking and spotting: cones at the edges or in the middle of circles."""

from __future__ import annotations

from ...model.hole_operations import CountersinkOperation
from ..holes import circles_missed
from ..registry import OperationMethod, register
from .paths import VERB, countersink

register(CountersinkOperation, OperationMethod(countersink, circles_missed(VERB)))
