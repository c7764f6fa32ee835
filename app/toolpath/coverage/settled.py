"""Floor that needs no polygons: what is proven cleared by cutters that keep off the walls is within reach, too.

What a cutter covers whose centre stays its radius from the walls is within its reach by definition. So squares that
such moves alone cover have nothing left and nothing out of reach; polygons are made round the other squares only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core.progress import Progress
from ...geometry.near_points import groups
from ...geometry.primitives import Rows
from ...model.job import Job
from ...model.moves import Area, Program
from ...model.operation import Side
from .areas import Shapes, each_with_each, gathered, unions, united
from .cut_out import cut_out
from .flat import grown, region_shapes
from .floor_target import CHORD, FITS, FloorTarget, areas_of_operations, cutters_of
from .proven import uncertain
from .reachable import CutterInArea

_SAME = 1e-9
"""mm between floors that are one."""

_SPARE = 0.1
"""mm of floor more than can have a say in what is reached."""


@dataclass(frozen=True, eq=False)
class SingleFloor:
    """The one floor of a job.

    Attributes:
        open: what is wanted in the boxes; None where there are none.
        all: what is wanted on all of the floor.
        tiles: boxes that hold every point of the floor that is not proven covered.
    """

    open: FloorTarget | None
    all: FloorTarget
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


def settled(program: Program, job: Job, paths: Sequence[tuple[Rows, float]], progress: Progress) -> SingleFloor | None:
    """Return the floor of a job that has but one (`one_floor`), with what of it is in doubt told apart; None where all
    is.

    Args:
        paths: (rows, radius, mm) of moves as deep as the floor that keep off the walls by at least their radius.

    Raises:
        Cancelled: by progress.
    """
    area = one_floor(program, job)
    shapes = region_shapes(area.regions, CHORD) if area else np.zeros(0, dtype=object)
    if not len(shapes) or not any(len(rows) for rows, _ in paths):
        return None
    floor = gathered(shapes)
    tiles = uncertain(floor, paths, progress)
    depth, cutters = cutters_of(program, job)
    known = FloorTarget(depth, floor, floor, floor, True, cutters, shapely.Polygon())
    if not len(tiles):
        return SingleFloor(None, known, tiles)
    near, reach = _around(shapes, tiles, cutters)
    some = FloorTarget(depth, near, reach, reach, True, cutters)
    return SingleFloor(some, replace(known, out_of_reach=some.beyond), tiles)


def _around(shapes: Shapes, tiles: Shapes, cutters: Sequence[CutterInArea]) -> tuple[Shape, Shape]:
    """Return what of a floor lies in boxes, and what of that cutters reach: their openings of the floor.

    Boxes that touch are asked together, and as much of the floor round them as can have a say in it. It is cut off
    there as if by walls, which are too far away to keep a cutter from the boxes.

    Args:
        shapes: (n,) polygons of the floor's regions. tiles: (m,) boxes that do not overlap.
    """
    number = groups(len(tiles), np.column_stack(shapely.STRtree(tiles).query(tiles, predicate="intersects")))
    order = np.argsort(number, kind="stable")
    lumps = unions(np.split(tiles[order], np.flatnonzero(np.diff(number[order])) + 1))
    far = max(each.wall for each in cutters) + max(each.radius for each in cutters) + _SPARE
    x0, y0, x1, y1 = shapely.bounds(lumps).T
    lump, pieces = cut_out(shapes, np.asarray(shapely.box(x0 - far, y0 - far, x1 + far, y1 + far), dtype=object))
    floors = each_with_each(shapely.intersection, pieces, lumps[lump])
    reached = [each_with_each(partial(_reached, each), pieces, floors) for each in cutters]
    return gathered(floors), united([gathered(each) for each in reached])


def _reached(cutter: CutterInArea, pieces: Shapes, floors: Shapes, grid_size: float | None = None) -> Shapes:
    """Return what a cutter reaches of floors (n,) that stays in pieces (n,) of an area; on a grid where it is asked for
    so.
    """
    opened = grown(grown(pieces, FITS - cutter.wall, CHORD), cutter.radius - FITS, CHORD)
    return np.asarray(shapely.intersection(opened, floors, grid_size=grid_size), dtype=object)
