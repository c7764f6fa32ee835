"""Contours: the tool follows walls."""

from __future__ import annotations

from collections.abc import Iterable

from ...core.progress import NO_PROGRESS
from ...model.finding import Finding
from ...model.operation import ContourOperation, Operation, Side
from ...toolpath.sheets import Sheet, Sheets
from ..engrave.open_line import line_paths
from ..registry import Way, register
from .paths import about_walls, contour


def _missed(sheets: Sheets, operation: Operation, sheet: Sheet | None) -> Iterable[Finding]:
    """Return where the tool does not fit along the walls or lines."""
    assert isinstance(operation, ContourOperation) and sheet is not None
    tool = sheets.job.tool(operation.cut.tool)
    if operation.side is Side.ON:
        return line_paths(sheet, tool, operation.cut.direction, NO_PROGRESS)[1]
    level = sheet.frame(tool.radius + operation.cut.stock_to_leave)
    return about_walls(sheets, operation, sheet, level)[1]


register(ContourOperation, Way(contour, _missed))
