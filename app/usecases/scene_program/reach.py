"""How low a scene's tools come at all, whatever passes they take: the surfaces' heights closed by each tool's profile.

Nothing of it is what paths are made with: heights of the triangles at the cells' centres, dilated by the profile to
where the tip may be, and eroded to what is cut from there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...simulation.cutter import Cutter
from ...simulation.field.solid_kernels import drop
from ...simulation.field.target import MOST_REACH, cutter_profile, dilated
from ...simulation.field.workpiece import Grid

Floats = NDArray[np.float64]
Heights = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class FamilyReach:
    """What one family of passes may do, in the coordinates of the grid.

    Attributes:
        cutter: its tool. leave: stock to leave, mm, >= 0.
        lowest: that its tip may be, mm.
        area: where its centre may be; None: anywhere.
    """

    cutter: Cutter
    leave: float
    lowest: float
    area: shapely.Geometry | None


@dataclass(frozen=True, eq=False)
class SurfaceGrid:
    """Surfaces over a grid, seen from above.

    Attributes:
        heights: (rows, cols) mm; -infinite where there is no surface.
    """

    grid: Grid
    heights: Heights

    @staticmethod
    def of(triangles: Floats, grid: Grid) -> SurfaceGrid:
        """Return the tops of triangles (n, 3, 3) at the cells' centres."""
        heights = np.full((grid.rows, grid.cols), -np.inf, np.float32)
        met = np.zeros(heights.shape, np.int32)
        drop(np.ascontiguousarray(triangles), (grid.x0, grid.y0, grid.pitch), 0, len(triangles), heights, met)
        return SurfaceGrid(grid, heights)

    def left_thick(self, leave: float) -> SurfaceGrid:
        """Return it with stock left on it, square to it: on planes exactly, beside walls to a cell, in corners a little
        more.
        """
        if not leave:
            return self
        rise = np.hypot(1.0, np.hypot(*slopes(self.heights, self.grid.pitch)))
        thick = np.asarray(self.heights + leave * rise, np.float32)
        if leave < MOST_REACH * self.grid.pitch:
            ball = cutter_profile(Cutter(leave, 0.0, leave), self.grid.pitch)
            thick = np.maximum(thick, dilated(self.heights, ball) + np.float32(leave))
        return replace(self, heights=thick)


def slopes(heights: Heights, pitch: float) -> tuple[Floats, Floats]:
    """Return how heights (rows, cols) rise along X and along Y, mm per mm: at each cell the less steep of the ways to
    both sides.

    So a cell beside an upright wall is as level as what it lies on. Where nothing is known it is 0.
    """
    found = []
    for axis in (1, 0):
        with np.errstate(invalid="ignore"):
            step = np.diff(heights.astype(np.float64), axis=axis) / pitch
        step[~np.isfinite(step)] = np.inf
        pad = [(0, 0), (0, 0)]
        pad[axis] = (1, 1)
        wide = np.pad(step, pad, constant_values=np.inf)
        count = heights.shape[axis]
        back, on = (wide.take(range(first, first + count), axis) for first in (0, 1))
        flat = np.where(np.abs(back) <= np.abs(on), back, on)
        found.append(np.where(np.isfinite(flat), flat, 0.0))
    return found[0], found[1]


@dataclass(frozen=True, eq=False)
class TipGrid:
    """How low a tool's tip comes without going into surfaces, over a grid and the tool's radius round it.

    Attributes:
        heights: (rows, cols) mm; infinite where the tool may not be.
    """

    grid: Grid
    heights: Heights

    def reached(self, cutter: Cutter, grid: Grid, progress: Progress = NO_PROGRESS) -> Heights:
        """Return (rows, cols) the lowest that the tool cuts from there, at the cells of a grid.

        Raises:
            Cancelled: the job was asked to stop.
        """
        wide, pitch = self.grid, self.grid.pitch
        low = -dilated(-self.heights, cutter_profile(cutter, pitch), progress)
        rows, cols = (
            np.clip(((at - start) / pitch).astype(np.int64), 0, most - 1)
            for at, start, most in ((grid.ys(), wide.y0, wide.rows), (grid.xs(), wide.x0, wide.cols))
        )
        return np.asarray(low[np.ix_(rows, cols)], np.float32)


def tip_heights(triangles: Floats, grid: Grid, requested: FamilyReach, progress: Progress = NO_PROGRESS) -> TipGrid:
    """Return how low a tool's tip comes without going into surfaces.

    Args:
        triangles: (n, 3, 3) of the surfaces, mm.

    Raises:
        Cancelled: the job was asked to stop.
    """
    pitch = max(grid.pitch, requested.cutter.radius / MOST_REACH)
    reach = math.ceil((requested.cutter.radius + min(requested.leave, requested.cutter.radius)) / pitch) + 1
    wide = _over(grid, pitch, reach)
    area = SurfaceGrid.of(triangles, wide).left_thick(requested.leave)
    form = cutter_profile(requested.cutter, pitch)
    tip = np.maximum(dilated(area.heights, form, progress), np.float32(requested.lowest))
    if requested.area is not None:
        xs, ys = np.meshgrid(wide.xs(), wide.ys())
        tip[~shapely.contains_xy(requested.area, xs, ys)] = np.inf
    return TipGrid(wide, tip)


def _over(grid: Grid, pitch: float, reach: int) -> Grid:
    """Return a grid over another one and so many cells round it; of the same pitch, its cells are the same."""
    rows, cols = (math.ceil(count * grid.pitch / pitch - 1e-9) + 2 * reach for count in (grid.rows, grid.cols))
    return Grid(grid.x0 - reach * pitch, grid.y0 - reach * pitch, pitch, rows, cols)
