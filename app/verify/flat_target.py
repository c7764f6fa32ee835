"""The heights that a drawing milled to depths asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ..simulation.field.outline import inside
from ..simulation.field.target import MARGIN, Target
from ..simulation.field.workpiece import Grid
from ..toolpath.build import MovesBuilder
from ..toolpath.coverage.areas import united
from ..toolpath.coverage.flat import grown, region_shapes
from ..toolpath.coverage.wanted import CHORD, bone_shape
from .bounds import bounds_of
from .parts import FlatPart

Mask = NDArray[np.bool_]

NO_MOVES = MovesBuilder().moves()


@dataclass(frozen=True, eq=False)
class FlatTarget:
    """Wanted heights, and which cells some tool of the job reaches, (rows, cols)."""

    target: Target
    reach: Mask


def flat_target(part: FlatPart, grid: Grid) -> FlatTarget:
    """Return the heights of a part over a grid, program coordinates.

    Within the walls and their stock to leave metal is wanted down to the floor; it is gouged below the deepest
    operation that may be there. Elsewhere the part's top is wanted, and what stands on it is not spoken of.
    """
    found = part.wanted
    top, shape = np.float32(-part.origin[2]), (grid.rows, grid.cols)
    wanted, low = np.full(shape, top, np.float32), np.full(shape, top, np.float32)
    high, reach = np.full(shape, np.inf, np.float32), np.zeros(shape, bool)
    slack, pockets = part.wall_tolerance + CHORD, any(each.whole for each in found)
    for each in found:  # from the shallowest to the deepest, which has the last word
        floor = top - np.float32(each.depth)
        mine = _cells(each.floor, part, grid)
        wanted[mine if each.whole or not pockets else _cells(each.wanted, part, grid)] = floor
        within = _cells(_shrunk(each.reach, slack), part, grid)
        high[within if each.wanted is each.reach else _cells(_shrunk(each.wanted, slack), part, grid)] = floor
        high[_cells(_shrunk(each.beyond, slack), part, grid)] = floor
        reach[mine] = False  # what a tool reaches that does not go as deep is no reach here
        reach |= within
    for bound in bounds_of(part.program(NO_MOVES), part.job):
        mine = _cells(united(grown(region_shapes(bound.area.regions, CHORD), slack - bound.leave, CHORD)), part, grid)
        low[mine] = np.minimum(low[mine], top - np.float32(bound.floor))
        for bone in part.dog_bones:
            cells = _cells(grown(bone_shape(bone), slack, CHORD), part, grid)
            low[cells] = np.minimum(low[cells], top - np.float32(bound.floor))
    return FlatTarget(Target(grid, np.pad(wanted, MARGIN, mode="edge"), low, high), reach)


def _shrunk(shape: Shape, by: float) -> Shape:
    """Return what of each part of a shape is deeper inside than so many mm."""
    return shapely.multipolygons(shapely.get_parts(grown(shapely.get_parts(shape), -by, CHORD)))


def _cells(shape: Shape, part: FlatPart, grid: Grid) -> Mask:
    """Return (rows, cols) which cells' centres lie in a shape of the part."""
    rings = shapely.get_rings(shapely.get_parts(shape))
    return inside(grid, [shapely.get_coordinates(ring)[:-1] - part.origin[:2] for ring in rings])
