"""Adaptive clearing: areas cleared with an engaged angle that is proven to be nowhere above a limit."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ...model.adaptive_operation import AdaptiveOperation
from ...model.finding import Finding
from ...model.operation import Operation
from ...model.tool import Tool
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ...toolpath.narrow_regions import too_small
from ..effort import Workload, over_area
from ..registry import OperationMethod, register
from .paths import adaptive, least_width, room_needed


def _missed(areas: MachiningAreas, operation: Operation, area: MachiningArea | None) -> Iterable[Finding]:
    """Return which regions are too small for the tool."""
    assert isinstance(operation, AdaptiveOperation) and area is not None
    level = area.frame(room_needed(areas.job, operation))
    return too_small(area.regions, level, areas.job.tool(operation.cut.tool), least_width(areas.job, operation))


def _effort(extent: Workload, operation: Operation, tool: Tool) -> float:
    """As of rings a step apart that engages so much of the rim along a straight wall."""
    assert isinstance(operation, AdaptiveOperation)
    return over_area(extent, operation, tool, tool.radius * (1 - math.cos(operation.most_engaged_deg)))


register(AdaptiveOperation, OperationMethod(adaptive, _missed, _effort))
