"""Slots along drawn lines."""

from __future__ import annotations

from collections.abc import Iterable

from ...core.progress import NO_PROGRESS
from ...model.finding import Finding
from ...model.operation import Operation
from ...model.slot_operation import SlotOperation
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..engrave.open_line import line_paths
from ..registry import OperationMethod, register
from .paths import outermost_distance, slot, slot_findings


def _missed(areas: MachiningAreas, operation: Operation, area: MachiningArea | None) -> Iterable[Finding]:
    """Return what of the slots clamps are in the way of, and which are too narrow for the tool to go in arcs."""
    assert isinstance(operation, SlotOperation) and area is not None
    tool = areas.job.tool(operation.cut.tool)
    if area.lines:
        return line_paths(area, tool, operation.cut.direction, NO_PROGRESS)[1]
    return slot_findings(areas, operation, area, area.frame(outermost_distance(areas.job, operation)))


register(SlotOperation, OperationMethod(slot, _missed))
