"""The heights that a drawing milled to depths asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from app.dexel.outline import inside
from app.dexel.target import MARGIN, Target
from app.dexel.workpiece import Grid
from app.toolpath.coverage import CHORD, areas_of
from app.toolpath.flat import grown
from app.workflow.parts import FlatPart

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class FlatTarget:
    """Wanted heights, and which cells some tool of the job reaches, (rows, cols)."""

    target: Target
    reach: Mask


def flat_target(part: FlatPart, grid: Grid) -> FlatTarget:
    """Return the heights of a part over a grid, program coordinates.

    Within the walls and their stock to leave metal is wanted down to the floor; it is gouged below the deepest operation's depth.
    Elsewhere the part's top is wanted, and what stands on it is not spoken of.
    """
    areas = areas_of(part.regions, part.job)
    top, shape = np.float32(-part.origin[2]), (grid.rows, grid.cols)
    wanted, low = np.full(shape, top, np.float32), np.full(shape, top, np.float32)
    high, reach = np.full(shape, np.inf, np.float32), np.zeros(shape, bool)
    if areas is None:
        return FlatTarget(Target(grid, np.pad(wanted, MARGIN, mode="edge"), low, high), reach)
    deepest = max(operation.cut.depth for operation in part.job.operations if operation.cut.enabled)
    floor, slack = top - np.float32(areas.depth), part.wall_tolerance + CHORD
    wanted[_cells(areas.floor, part, grid)] = floor
    low[_cells(grown(areas.floor, slack, CHORD), part, grid)] = top - np.float32(deepest)
    high[_cells(shapely.union(grown(areas.wanted, -slack, CHORD), _unreached(areas.floor, areas.reach, slack)), part, grid)] = floor
    reach = _cells(grown(areas.reach, -slack, CHORD), part, grid)
    return FlatTarget(Target(grid, np.pad(wanted, MARGIN, mode="edge"), low, high), reach)


def _unreached(floor: Shape, reach: Shape, slack: float) -> Shape:
    """Return the part of the floor that no tool reaches, without a rim."""
    return grown(shapely.difference(floor, reach), -slack, CHORD)


def _cells(shape: Shape, part: FlatPart, grid: Grid) -> Mask:
    """Return (rows, cols) which cells' centres lie in a shape of the part."""
    rings = shapely.get_rings(shapely.get_parts(shape))
    return inside(grid, [shapely.get_coordinates(ring)[:-1] - part.origin[:2] for ring in rings])

