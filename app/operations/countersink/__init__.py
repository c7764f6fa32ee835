"""Countersinking and spotting: cones at the edges or in the middle of circles."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.hole_operations import CountersinkOperation
from ...model.operation import Operation
from ...toolpath.drill_holes import holes_of
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..holes import circle_findings
from ..registry import OperationMethod, register
from .paths import VERB, countersink


def _missed(areas: MachiningAreas, operation: Operation, _: MachiningArea | None) -> Iterable[Finding]:
    assert isinstance(operation, CountersinkOperation)
    return circle_findings(holes_of(areas.job, areas.drawn, operation), areas.job, operation, VERB)


register(CountersinkOperation, OperationMethod(countersink, _missed))
