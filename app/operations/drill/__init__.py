"""Drilling: circles, straight down at their centres."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.hole_operations import DrillOperation
from ...model.operation import Operation
from ...toolpath.drill_holes import holes_of
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..registry import OperationMethod, register
from .paths import drill, hole_findings


def _missed(areas: MachiningAreas, operation: Operation, _: MachiningArea | None) -> Iterable[Finding]:
    assert isinstance(operation, DrillOperation)
    return hole_findings(holes_of(areas.job, areas.drawn, operation), areas.job, operation)


register(DrillOperation, OperationMethod(drill, _missed))
