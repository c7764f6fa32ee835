"""Thread milling: threads in holes and on bosses, on a helix."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.hole_operations import ThreadOperation
from ...model.operation import Operation
from ...toolpath.drill_holes import holes_of
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..holes import circle_findings
from ..registry import OperationMethod, register
from .paths import VERB, thread
from .proof import milled_proof


def _missed(areas: MachiningAreas, operation: Operation, _: MachiningArea | None) -> Iterable[Finding]:
    assert isinstance(operation, ThreadOperation)
    return circle_findings(holes_of(areas.job, areas.drawn, operation), areas.job, operation, VERB)


register(ThreadOperation, OperationMethod(thread, _missed, proof=milled_proof))
