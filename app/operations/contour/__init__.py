"""Contours: the tool follows walls."""

from __future__ import annotations

from collections.abc import Iterable

from ...core.progress import NO_PROGRESS
from ...model.contour_operation import ContourOperation
from ...model.finding import Finding
from ...model.operation import Operation, Side
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ..engrave.open_line import line_paths
from ..registry import OperationMethod, register
from .paths import contour, prepared_contour, wall_findings


def _missed(areas: MachiningAreas, operation: Operation, area: MachiningArea | None) -> Iterable[Finding]:
    """Return where the tool does not fit along the walls or lines."""
    assert isinstance(operation, ContourOperation) and area is not None
    tool = areas.job.tool(operation.cut.tool)
    if operation.side is Side.ON:
        return line_paths(area, tool, operation.cut.direction, NO_PROGRESS)[1]
    level = area.frame(tool.radius + operation.cut.stock_to_leave)
    return wall_findings(areas, operation, area, level)[1]


register(ContourOperation, OperationMethod(contour, _missed, prepared=prepared_contour))
