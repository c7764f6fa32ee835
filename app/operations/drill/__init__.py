"""Drilling: circles, straight down at their centres."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.operation import DrillOperation, Operation
from ...toolpath.drill_holes import holes_of
from ...toolpath.sheets import Sheet, Sheets
from ..registry import Way, register
from .paths import about_holes, drill


def _missed(sheets: Sheets, operation: Operation, _: Sheet | None) -> Iterable[Finding]:
    assert isinstance(operation, DrillOperation)
    return about_holes(holes_of(sheets.job, sheets.drawn, operation), sheets.job, operation)


register(DrillOperation, Way(drill, _missed))
