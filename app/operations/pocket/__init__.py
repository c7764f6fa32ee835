"""Pockets: the area cleared in rings."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.operation import Operation, PocketOperation
from ...toolpath.narrow import finest, too_small
from ...toolpath.sheets import Sheet, Sheets
from ..registry import Way, register
from .paths import pocket, wall_distance


def _missed(sheets: Sheets, operation: Operation, sheet: Sheet | None) -> Iterable[Finding]:
    """Return which regions are too small for the tool, where no contour goes along their walls."""
    assert isinstance(operation, PocketOperation) and sheet is not None
    if wall_distance(sheets.job, operation):
        return ()
    tool = sheets.job.tool(operation.cut.tool)
    level = sheet.frame(tool.radius + operation.cut.stock_to_leave)
    return too_small(sheet.regions, level, tool, finest(sheets.job, operation))


register(PocketOperation, Way(pocket, _missed))
