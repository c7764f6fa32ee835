"""The heights that are wanted, and how heights compare with them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from concurrent.futures import wait
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np

from app.dexel.cutter import Cutter
from app.dexel.solid import SolidStock
from app.dexel.workpiece import Grid, Heights
from app.pool import pool
from app.progress import NO_PROGRESS, Progress

RIM = 2e-3
"""mm sideways within which a height beside a wall counts as met: what path and rounding may be off."""

STRIPS = 32
"""Parts in which a field is worked through."""

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Target:
    """Heights that are wanted over a grid, program coordinates, (rows, cols) each, mm.

    Attributes:
        wanted: the part at the cells' centres; -infinite where there is none.
        low: metal that is lower is gouged. high: metal that is higher is left. Infinite where the part says nothing.
            Beside walls they lie apart, so that a cell on a wall may fall to either side.
    """

    grid: Grid
    wanted: Heights
    low: Heights
    high: Heights

    def deviation(self, heights: Heights) -> Heights:
        """Return how far heights are above high (> 0) or below low (< 0), mm."""
        return np.asarray(heights - np.clip(heights, self.low, self.high), np.float32)


def solid_target(solid: SolidStock, grid: Grid, leave: float = 0.0, progress: Progress = NO_PROGRESS) -> Target:
    """Return the heights of a solid with stock to leave on it.

    Raises:
        ParameterError: the grid does not fit into memory.
        Cancelled: the job was asked to stop.
    """
    wanted, low, high = _part_over(solid, grid)
    for dx, dy in ((-RIM, -RIM), (-RIM, RIM), (RIM, -RIM), (RIM, RIM)):
        progress.step(0.0, "Laying the part over the grid")
        _, below, above = _part_over(solid, Grid(grid.x0 + dx, grid.y0 + dy, grid.pitch, grid.rows, grid.cols))
        np.minimum(low, below, out=low)
        np.maximum(high, above, out=high)
    if leave:
        thick = _ball(leave, grid.pitch)
        wanted, low, high = (dilated(field, thick) for field in (wanted, low, high))
    return Target(grid, wanted, low, high)


def _part_over(solid: SolidStock, grid: Grid) -> tuple[Heights, Heights, Heights]:
    """Return a solid's tops, and low and high as in `Target`; beside the solid, metal may be cut or left."""
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
    """Return a cutter's heights over its tip on a grid of (2 k + 1) x (2 k + 1) cells round its axis, infinite beyond its radius."""
    reach = int(cutter.radius / pitch)
    steps = np.arange(-reach, reach + 1) * pitch
    return np.asarray(cutter.lift + cutter.heights(np.hypot(steps[:, None], steps[None, :])), np.float32)


def dilated(heights: Heights, profile: Heights, progress: Progress = NO_PROGRESS) -> Heights:
    """Return (rows, cols) the greatest of heights minus profile round each cell.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from app.dexel.judge_kernels import dilate

    source, form = (np.ascontiguousarray(field, np.float32) for field in (heights, profile))
    source.setflags(write=False)
    form.setflags(write=False)
    out = np.empty_like(source)
    by_strips(len(out), lambda first, last: dilate(source, form, out, first, last), progress)
    return out


def within_reach(wanted: Heights, cutters: Iterable[Cutter], pitch: float, progress: Progress = NO_PROGRESS) -> Heights:
    """Return (rows, cols) the lowest height that any of some cutters surely reaches without touching the part.

    A cutter is led where it would stay clear of the part even if it were wider by half a cell's diagonal, so metal beside a
    steep wall may count as out of reach though it is not, up to that width.

    Args:
        wanted: the part. cutters: that may be used. pitch: mm.

    Raises:
        Cancelled: the job was asked to stop.
    """
    lowest = np.full(wanted.shape, np.inf, np.float32)
    half = pitch / math.sqrt(2.0)
    for cutter in cutters:
        tip = dilated(wanted, cutter_profile(cutter.grown(half), pitch), progress)
        np.minimum(lowest, -dilated(-tip, cutter_profile(cutter, pitch), progress), out=lowest)
    return lowest


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
