"""Regions that need no polygons: what is proven cleared all over by cutters that keep off the walls is within reach all
over, too.

What a cutter covers whose centre stays its radius from the walls is within its reach by definition. So where such moves
alone cover all squares of a region, nothing is left there and nothing out of reach; polygons are asked of the other
regions only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.progress import Progress
from ...geometry.primitives import Rows
from ...model.job import Job
from ...model.moves import Area, Program
from ...model.operation import Side
from ...model.part import Region
from .areas import united
from .flat import region_shapes
from .proven import uncertain
from .wanted import CHORD, Wanted, areas_of_operations, wanted_of

_SAME = 1e-9
"""mm between floors that are one."""


@dataclass(frozen=True, eq=False)
class Floor:
    """The one floor of a job.

    Attributes:
        open: what is wanted in the regions that are not settled; None where all are.
        all: what is wanted in all regions.
        tiles: boxes that hold every point of the floor that is not proven covered.
    """

    open: Wanted | None
    all: Wanted
    tiles: NDArray[np.object_]


def one_floor(program: Program, job: Job) -> Area | None:
    """Return the area of a job that clears all of one area down to one floor and its walls, by flat tools; None for any
    other job.
    """
    areas = areas_of_operations(program, job)
    works = [
        (each, area) for each, area in zip(job.operations, areas, strict=True) if each.cut.enabled and area.regions
    ]
    if not works or program.tabs or program.dog_bones or program.allowance_mm:
        return None
    operation, first = works[0]
    for each, area in works:
        cut, outside = each.cut, each.wall_side is not Side.INSIDE
        elsewhere = (
            area.regions is not first.regions
            or area.lines
            or area.bare
            or abs(cut.floor - operation.cut.floor) >= _SAME
        )
        other = not job.tool(cut.tool).kind.square
        if elsewhere or outside or other or cut.stock_to_leave:
            return None
    return first if any(each.COARSE for each, _ in works) else None


def settled(program: Program, job: Job, paths: Sequence[tuple[Rows, float]], progress: Progress) -> Floor | None:
    """Return the floor of a job that has but one (`one_floor`), regions that are settled told apart; None where they
    cannot be.

    Args:
        paths: (rows, radius, mm) of moves as deep as the floor that keep off the walls by at least their radius.

    Raises:
        Cancelled: by progress.
    """
    area = one_floor(program, job)
    shapes = region_shapes(area.regions, CHORD) if area else np.zeros(0, dtype=object)
    if area is None or len(shapes) != len(area.regions):
        return None
    tiles = uncertain(shapely.multipolygons(shapes), paths, progress)
    doubtful = np.zeros(len(shapes), np.bool_)
    doubtful[shapely.STRtree(shapes).query(tiles)[1]] = True
    if doubtful.all():
        return None
    regions = tuple(region for region, doubt in zip(area.regions, doubtful.tolist(), strict=True) if doubt)
    (some,) = wanted_of(_with_regions(program, job, area, regions or area.regions[:1]), job)
    floor = united(shapes[~doubtful])
    if not regions:
        return Floor(None, replace(some, floor=floor, reach=floor, wanted=floor, out_of_reach=shapely.Polygon()), tiles)
    floor, reach, wanted = (united([floor, shape]) for shape in (some.floor, some.reach, some.wanted))
    return Floor(some, replace(some, floor=floor, reach=reach, wanted=wanted, out_of_reach=some.beyond), tiles)


def _with_regions(program: Program, job: Job, area: Area, regions: tuple[Region, ...]) -> Program:
    """Return a program whose area has other regions."""
    areas = tuple(
        replace(each, regions=regions) if each.regions is area.regions else each
        for each in areas_of_operations(program, job)
    )
    return replace(program, areas=areas)
