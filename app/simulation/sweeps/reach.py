"""What tools can reach of a solid without touching it: grey dilation by a tool's profile, and erosion by it.

The tool's tip may be where no part of the solid is in the tool: no lower than the greatest of part minus profile round
it (dilation). The lowest that it cuts at a place is the least of tip plus profile round it (erosion). On cells both are
known to half a cell's diagonal, so there are two answers: what is surely reached, by a cutter that keeps as much more
away, and what may be, by one that keeps as much less.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ..cutter import Cutter
from ..field.solid import SolidStock
from ..field.target import MOST_REACH, cutter_profile, dilated, solid_target
from ..field.workpiece import Grid, Heights

CELLS = 1024
"""Along the longer side of the stock at most."""

PIN = np.zeros((1, 1), np.float32)
"""Profile of a cutter that is narrower than a cell."""


@dataclass(frozen=True, eq=False)
class ReachableHeights:
    """The lowest heights that some tool gets to, (rows, cols) each, mm.

    Attributes:
        grid: the stock, and the widest tool's radius round it.
        sure: some tool gets as low as that. possible: none gets lower.
        over_part: how far above the part the tool that gets lowest stays there; part and tool both taken at the cells'
            centres, so that a slope is no height.
    """

    grid: Grid
    sure: Heights
    possible: Heights
    over_part: Heights

    def over(self, grid: Grid) -> tuple[Heights, Heights, Heights]:
        """Return sure, possible and over_part at the cells of another grid."""
        cols = np.clip(((grid.xs() - self.grid.x0) / self.grid.pitch).astype(np.int64), 0, self.grid.cols - 1)
        rows = np.clip(((grid.ys() - self.grid.y0) / self.grid.pitch).astype(np.int64), 0, self.grid.rows - 1)
        place = np.ix_(rows, cols)
        return self.sure[place], self.possible[place], self.over_part[place]


def reach_of(
    solid: SolidStock,
    leave: float,
    box: tuple[float, float, float, float],
    cutters: Iterable[Cutter],
    progress: Progress = NO_PROGRESS,
) -> ReachableHeights:
    """Return what some cutters reach of a solid with stock to leave on it.

    Args:
        box: x0, y0, x1, y1 of the stock, mm.
        cutters: at least one.

    Raises:
        Cancelled: the job was asked to stop.
    """
    cutters = tuple(cutters)
    widest = max(cutter.radius for cutter in cutters)
    x0, y0, x1, y1 = box
    pitch = max((x1 - x0) / CELLS, (y1 - y0) / CELLS, widest / MOST_REACH)
    more = widest + 2 * pitch
    rows, cols = (math.ceil((side + 2 * more) / pitch) for side in (y1 - y0, x1 - x0))
    grid = Grid(x0 - more, y0 - more, pitch, rows, cols)
    target, half = solid_target(solid, grid, leave, progress).heights, pitch / math.sqrt(2.0)
    sure = [_lowest(target, cutter.grown(half), cutter, pitch, progress) for cutter in cutters]
    possible = [_lowest(target, cutter.shrunk(half), cutter, pitch, progress) for cutter in cutters]
    nearest = np.minimum.reduce([_lowest(target, cutter, cutter, pitch, progress) for cutter in cutters])
    over_part = np.zeros_like(target)
    # beside the part there is none to keep away from
    np.subtract(nearest, target, out=over_part, where=np.isfinite(target))
    return ReachableHeights(grid, np.minimum.reduce(sure), np.minimum.reduce(possible), over_part)


def _lowest(target: Heights, paths: Cutter | None, cuts: Cutter, pitch: float, progress: Progress) -> Heights:
    """Return how low a cutter gets where another one is led clear of the part."""
    form = cutter_profile(paths, pitch) if paths is not None else PIN
    tip = dilated(target, form, progress)
    return np.asarray(-dilated(-tip, cutter_profile(cuts, pitch), progress))


def reachable(
    left: NDArray[np.bool_], sure: NDArray[np.bool_], possible: NDArray[np.bool_], near: NDArray[np.bool_], cells: int
) -> NDArray[np.bool_]:
    """Return which of the cells that are left count as within reach.

    Sure ones do, and possible ones in places that are wide enough: beside inner corners possible reach is too wide by a
    part of a cell, so that what is no wider than so many cells is no finding. On slopes heights differ within a cell by
    more than that; there those count that a tool comes near enough to.

    Args:
        left: more than the tolerance is. sure, possible: told from heights, and so by a slope times a cell too little,
            too much.
        near: a tool is led to within the tolerance of the part, at the cell's centre.
        cells: so many in a row are a wide place.
    """
    import cv2

    maybe = (left & possible).astype(np.uint8)
    opened = cv2.morphologyEx(
        maybe, cv2.MORPH_OPEN, np.ones((cells, cells), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0
    )
    return np.asarray((left & (sure | (possible & near))) | opened.astype(bool))
