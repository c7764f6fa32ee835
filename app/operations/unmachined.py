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
from ..toolpath.machining_areas import MachiningAreas
from .compute import under_clamps
from .registry import method_of


def unmachined_findings(areas: MachiningAreas, regions: Sequence[Region]) -> tuple[Finding, ...]:
    """Return the findings that count of what no path of a job makes.

    Args:
        areas: of the job.
        regions: that the job machines.
    """
    found = [*under_clamps(areas.job, areas.drawn, regions)]
    for operation in areas.job.operations:
        if operation.cut.enabled:
            found += _missed(operation, areas)
    return tuple(dict.fromkeys(each for each in found if each.counts))


def _missed(operation: Operation, areas: MachiningAreas) -> Iterable[Finding]:
    method = method_of(operation)
    if operation.HOLES:
        return method.missed(areas, operation, None)
    area, tool = areas.of(operation), areas.job.tool(operation.cut.tool)
    # of a program that tells no operations, each tool may be one that mills
    if area is None or tool.kind.drills:
        return ()
    return method.missed(areas, operation, area)
