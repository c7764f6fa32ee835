"""Pockets: the area cleared in rings."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.operation import Operation, PocketOperation
from ...model.tool import Tool
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ...toolpath.narrow_regions import finest, too_small
from ..effort import Workload, over_area
from ..registry import OperationMethod, register
from .paths import candidates, left_to_carvings, pocket, wall_distance


def _missed(areas: MachiningAreas, operation: Operation, area: MachiningArea | None) -> Iterable[Finding]:
    """Return which regions are too small for the tool, where no contour goes along their walls."""
    assert isinstance(operation, PocketOperation) and area is not None
    if wall_distance(areas.job, operation):
        return ()
    tool = areas.job.tool(operation.cut.tool)
    level = area.frame(tool.radius + operation.cut.stock_to_leave)
    small = too_small(area.regions, level, tool, finest(areas.job, operation))
    return left_to_carvings(small, areas.job, operation)


def _effort(extent: Workload, operation: Operation, tool: Tool) -> float:
    assert isinstance(operation, PocketOperation)
    return over_area(extent, operation, tool, operation.stepover or candidates(tool.radius, extent.pieces)[0])


register(PocketOperation, OperationMethod(pocket, _missed, _effort))
