"""What a job asks for and no path of it makes, from the drawing alone: what `make` tells on its way, `cut` says of any
program.

A region that no tool enters, a wall to follow from outside where none fits, what clamps lie over, a circle that no
drill can drill.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ..model.finding import Finding
from ..model.operation import Operation
from ..model.part import Region
from ..toolpath.sheets import Sheets
from .compute import under_clamps
from .registry import way_of


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


def _missed(operation: Operation, sheets: Sheets) -> Iterable[Finding]:
    way = way_of(operation)
    if operation.DRILLS:
        return way.missed(sheets, operation, None)
    sheet, tool = sheets.of(operation), sheets.job.tool(operation.cut.tool)
    # of a program that tells no operations, each tool may be one that mills
    if sheet is None or tool.kind.drills:
        return ()
    return way.missed(sheets, operation, sheet)
