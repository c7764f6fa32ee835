"""The heights that are wanted, and how heights compare with them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import wait
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np

from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ..cutter import Cutter
from .solid import SolidStock
from .workpiece import Grid, Heights

RIM = 2e-3
"""mm sideways within which a height beside a wall counts as met: what path and rounding may be off."""

MARGIN = 12
"""Cells round a grid in which the part's surface is looked for too; as `judge_kernels.MOST_RINGS`."""

MOST_REACH = 32
"""Cells from the middle of a profile to its rim; work grows with the square."""

STRIPS = 32
"""Parts in which a field is worked through."""

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class TargetHeights:
    """Heights that are wanted over a grid, program coordinates, (rows, cols) each, mm.

    Attributes:
        around: the part at the cells' centres, MOST_RINGS cells wider than the grid on each side; -infinite where there
            is none.
        low: metal that is lower is gouged. high: metal that is higher is left. Infinite where the part says nothing.
            Beside walls they lie apart, so that a cell on a wall may fall to either side.
    """

    grid: Grid
    around: Heights
    low: Heights
    high: Heights

    @property
    def heights(self) -> Heights:
        """(rows, cols) the part at the cells' centres."""
        return self.around[MARGIN:-MARGIN, MARGIN:-MARGIN]

    def deviation(self, heights: Heights) -> Heights:
        """Return how far heights are above high (> 0) or below low (< 0), mm."""
        return np.asarray(heights - np.clip(heights, self.low, self.high), np.float32)


def solid_target(solid: SolidStock, grid: Grid, leave: float = 0.0, progress: Progress = NO_PROGRESS) -> TargetHeights:
    """Return the heights of a solid with stock to leave on it.

    Raises:
        ParameterError: the grid does not fit into memory.
        Cancelled: the job was asked to stop.
    """
    if leave > MOST_REACH * grid.pitch:
        return _sampled(solid_target(solid, _coarser(grid, leave), leave, progress), grid)
    wide = _wider(grid, MARGIN + int(leave / grid.pitch) + 1)
    around, low, high = _part_over(solid, wide)
    for dx, dy in ((-RIM, -RIM), (-RIM, RIM), (RIM, -RIM), (RIM, RIM)):
        progress.step(0.0, "Laying the part over the grid")
        _, below, above = _part_over(solid, Grid(wide.x0 + dx, wide.y0 + dy, wide.pitch, wide.rows, wide.cols))
        np.minimum(low, below, out=low)
        np.maximum(high, above, out=high)
    if leave:
        thick = _ball(leave, grid.pitch)
        around, low, high = (dilated(field, thick) for field in (around, low, high))
    more = (wide.rows - grid.rows) // 2
    rim, own = (slice(more - MARGIN, MARGIN - more or None), slice(more, -more))
    return TargetHeights(grid, around[rim, rim].copy(), low[own, own].copy(), high[own, own].copy())


def _wider(grid: Grid, cells: int) -> Grid:
    """Return a grid with so many cells more on each side."""
    return Grid(
        grid.x0 - cells * grid.pitch,
        grid.y0 - cells * grid.pitch,
        grid.pitch,
        grid.rows + 2 * cells,
        grid.cols + 2 * cells,
    )


def _coarser(grid: Grid, leave: float) -> Grid:
    """Return a grid over the same place, and some more, whose cells are no finer than stock to leave needs."""
    pitch = leave / MOST_REACH
    x0, y0, x1, y1 = grid.box
    return Grid(x0 - 2 * pitch, y0 - 2 * pitch, pitch, int((y1 - y0) / pitch) + 5, int((x1 - x0) / pitch) + 5)


def _sampled(coarse: TargetHeights, grid: Grid) -> TargetHeights:
    """Return a target on finer cells; low and high are those of the coarse cells around, so that nothing is told too
    early.
    """
    import cv2  # for stock to leave alone

    kernel = np.ones((3, 3), np.uint8)
    low, high = cv2.erode(coarse.low, kernel), cv2.dilate(coarse.high, kernel)
    rows, cols = (
        np.clip(((at - start) / coarse.grid.pitch).astype(np.int64), 0, most - 1)
        for at, start, most in (
            (grid.ys(), coarse.grid.y0, coarse.grid.rows),
            (grid.xs(), coarse.grid.x0, coarse.grid.cols),
        )
    )
    fields = (np.asarray(field, np.float32)[np.ix_(rows, cols)] for field in (coarse.heights, low, high))
    around, low, high = fields
    return TargetHeights(grid, np.pad(around, MARGIN, mode="edge"), low, high)


def _part_over(solid: SolidStock, grid: Grid) -> tuple[Heights, Heights, Heights]:
    """Return a solid's tops, and low and high as in `TargetHeights`; beside the solid, metal may be cut or left."""
    workpiece = solid.over(grid)
    beside = workpiece.heights <= workpiece.floor
    wanted = np.where(beside, np.float32(-np.inf), workpiece.heights)
    return wanted, wanted.copy(), np.where(beside, np.float32(np.inf), workpiece.heights)


def _ball(radius: float, pitch: float) -> Heights:
    """Return the underside of a ball as a profile."""
    reach = int(radius / pitch)
    steps = np.arange(-reach, reach + 1) * pitch
    square = radius**2 - steps[:, None] ** 2 - steps[None, :] ** 2
    return np.where(square >= 0, -np.sqrt(np.maximum(square, 0.0)), np.inf).astype(np.float32)


def cutter_profile(cutter: Cutter, pitch: float) -> Heights:
    """Return a cutter's heights over its tip on a grid of (2 k + 1) x (2 k + 1) cells round its axis, infinite beyond
    its radius.
    """
    reach = int(cutter.radius / pitch)
    steps = np.arange(-reach, reach + 1) * pitch
    return np.asarray(cutter.lift + cutter.heights(np.hypot(steps[:, None], steps[None, :])), np.float32)


def dilated(heights: Heights, profile: Heights, progress: Progress = NO_PROGRESS) -> Heights:
    """Return (rows, cols) the greatest of heights minus profile round each cell.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from .judge_kernels import dilate

    source, form = frozen(heights), frozen(profile)
    out = np.empty_like(source)
    by_strips(len(out), lambda first, last: dilate(source, form, out, first, last), progress)
    return out


def frozen(field: Heights) -> Heights:
    """Return a field as kernels read it: contiguous, and not to be written."""
    view = np.ascontiguousarray(field, np.float32).view()
    view.setflags(write=False)
    return view


def by_strips(rows: int, work: Callable[[int, int], T], progress: Progress = NO_PROGRESS) -> list[T]:
    """Do a work on strips of rows on the pool, and return what each gave.

    Args:
        work: is given the first row and the one behind the last.

    Raises:
        Cancelled: the job was asked to stop.
    """
    edges = np.linspace(0, rows, min(STRIPS, rows) + 1).astype(int).tolist()
    parts = [pool().submit(work, first, last) for first, last in pairwise(edges)]
    try:
        while wait(parts, timeout=0.05).not_done:
            progress.step(sum(part.done() for part in parts) / len(parts), "Comparing with the part")
    except BaseException:
        for part in parts:
            part.cancel()
        wait(parts)
        raise
    return [part.result() for part in parts]
