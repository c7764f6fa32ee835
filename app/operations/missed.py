"""What a job asks for and no path of it makes, from the drawing alone: what `make` tells on its way, `cut` says of any program.

A region that no tool enters, a wall to follow from outside where none fits, what clamps lie over, a circle that no drill can drill.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..core.progress import NO_PROGRESS
from ..geometry.offset.offset import Level
from ..model.finding import Finding
from ..model.operation import ContourOperation, DrillOperation, Operation, PocketOperation, Side
from ..model.part import Region
from ..model.tool import ToolKind
from ..toolpath.drill_holes import holes_of
from ..toolpath.narrow import finest, too_small
from ..toolpath.sheets import Sheet, Sheets
from .compute import under_clamps
from .contour.contour import about_walls
from .drill.drill import about_holes
from .engrave.open_line import line_paths
from .pocket.pocket import wall_distance


def missed(sheets: Sheets, regions: Sequence[Region]) -> tuple[Finding, ...]:
    """Return the findings that count of what no path of a job makes.

    Args:
        sheets: of the job.
        regions: that the job machines.
    """
    found = [*under_clamps(sheets.job, sheets.drawn, regions)]
    for operation in sheets.job.operations:
        if operation.cut.enabled:
            found += _missed(operation, sheets)
    return tuple(dict.fromkeys(each for each in found if each.counts))


def _missed(operation: Operation, sheets: Sheets) -> Iterator[Finding]:
    job, tool = sheets.job, sheets.job.tool(operation.cut.tool)
    if isinstance(operation, DrillOperation):
        yield from about_holes(holes_of(job, sheets.drawn, operation), job, operation)
        return
    sheet = sheets.of(operation)
    if sheet is None or tool.kind is ToolKind.DRILL:  # of a program that tells no operations, each tool may be one that mills
        return
    wall = tool.radius + operation.cut.stock_to_leave
    if isinstance(operation, PocketOperation) and not wall_distance(job, operation):
        yield from too_small(sheet.regions, _level(sheet, wall), tool, finest(job, operation))
    elif isinstance(operation, ContourOperation) and operation.side is Side.ON:
        yield from line_paths(sheet, tool, operation.cut.direction, NO_PROGRESS)[1]
    elif isinstance(operation, ContourOperation):
        yield from about_walls(sheets, operation, sheet, _level(sheet, wall))[1]


def _level(sheet: Sheet, distance: float) -> Level:
    return sheet.frame(distance)
