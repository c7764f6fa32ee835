"""Tapping: threads by a tap, which the control leads in a cycle of its own."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.hole_operations import TapOperation
from ...model.operation import Operation
from ...toolpath.drill_holes import holes_of
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..holes import circle_findings
from ..registry import OperationMethod, register
from .paths import VERB, tap
from .proof import tapped_proof


def _missed(areas: MachiningAreas, operation: Operation, _: MachiningArea | None) -> Iterable[Finding]:
    assert isinstance(operation, TapOperation)
    return circle_findings(holes_of(areas.job, areas.drawn, operation), areas.job, operation, VERB)


register(TapOperation, OperationMethod(tap, _missed, proof=tapped_proof))
