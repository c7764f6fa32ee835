"""Adaptive clearing: areas cleared with an engaged angle that is proven to be nowhere above a limit."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ...model.finding import Finding
from ...model.operation import AdaptiveOperation, Operation
from ...model.tool import Tool
from ...toolpath.narrow import too_small
from ...toolpath.sheets import Sheet, Sheets
from ..effort import Workload, over_area
from ..registry import Way, register
from .paths import adaptive, least_width, room_needed


def _missed(sheets: Sheets, operation: Operation, sheet: Sheet | None) -> Iterable[Finding]:
    """Return which regions are too small for the tool."""
    assert isinstance(operation, AdaptiveOperation) and sheet is not None
    level = sheet.frame(room_needed(sheets.job, operation))
    return too_small(sheet.regions, level, sheets.job.tool(operation.cut.tool), least_width(sheets.job, operation))


def _effort(extent: Workload, operation: Operation, tool: Tool) -> float:
    """As of rings a step apart that engages so much of the rim along a straight wall."""
    assert isinstance(operation, AdaptiveOperation)
    return over_area(extent, operation, tool, tool.radius * (1 - math.cos(operation.most_engaged_deg)))


register(AdaptiveOperation, Way(adaptive, _missed, _effort))
