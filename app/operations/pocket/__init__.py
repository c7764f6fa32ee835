"""Pockets: the area cleared in rings."""

from __future__ import annotations

from collections.abc import Iterable

from ...model.finding import Finding
from ...model.operation import Operation, PocketOperation
from ...model.tool import Tool
from ...toolpath.narrow import finest, too_small
from ...toolpath.sheets import Sheet, Sheets
from ..effort import Workload, over_area
from ..registry import Way, register
from .paths import candidates, pocket, wall_distance


def _missed(sheets: Sheets, operation: Operation, sheet: Sheet | None) -> Iterable[Finding]:
    """Return which regions are too small for the tool, where no contour goes along their walls."""
    assert isinstance(operation, PocketOperation) and sheet is not None
    if wall_distance(sheets.job, operation):
        return ()
    tool = sheets.job.tool(operation.cut.tool)
    level = sheet.frame(tool.radius + operation.cut.stock_to_leave)
    return too_small(sheet.regions, level, tool, finest(sheets.job, operation))


def _effort(extent: Workload, operation: Operation, tool: Tool) -> float:
    assert isinstance(operation, PocketOperation)
    return over_area(extent, operation, tool, operation.stepover or candidates(tool.radius, extent.pieces)[0])


register(PocketOperation, Way(pocket, _missed, _effort))
