"""The heights that are wanted, and how heights compare with them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import wait
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
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


# Which cells of a grid have their centre inside closed outlines, or near them: even-odd, exact but for the last bit of
# float64.


_AT_A_TIME = 1 << 20
"""Edges with lines of centres, or with cells, that are looked at together."""

Indices = NDArray[np.int64]

Mask = NDArray[np.bool_]


def inside(grid: Grid, outlines: Sequence[Floats]) -> Mask:
    """Return (rows, cols) whether a cell's centre lies inside.

    Each line of centres is crossed by the outlines' edges (an edge counts for y0 <= y < y1); a cell is inside where an
    odd number of crossings lie left of its centre.

    Args:
        grid: where.
        outlines: (n, 2) points each, mm; closed from the last to the first.
    """
    start, end = _edges(outlines)
    first = _count(np.minimum(start[:, 1], end[:, 1]), grid.y0, grid.pitch, grid.rows)
    stop = _count(np.maximum(start[:, 1], end[:, 1]), grid.y0, grid.pitch, grid.rows)
    crossings = np.zeros((grid.rows, grid.cols + 1), np.uint8)
    for edge, row in _spread(first, stop):
        share = (grid.y0 + (row + 0.5) * grid.pitch - start[edge, 1]) / (end[edge, 1] - start[edge, 1])
        x = start[edge, 0] + share * (end[edge, 0] - start[edge, 0])
        # the first cell whose centre lies beyond the crossing
        np.bitwise_xor.at(crossings, (row, _count(x, grid.x0, grid.pitch, grid.cols)), 1)
    return np.bitwise_xor.accumulate(crossings[:, :-1], axis=1).astype(bool)


def beside(grid: Grid, outlines: Sequence[Floats], distance: float) -> Mask:
    """Return (rows, cols) whether a cell's centre lies within a distance of an outline.

    Quick where that is small beside a cell.

    Args:
        grid, outlines: as of `inside`.
        distance: mm, >= 0.
    """
    start, end = _edges(outlines)
    low, high = np.minimum(start, end) - distance, np.maximum(start, end) + distance
    first, stop = (_count(each[:, 1], grid.y0, grid.pitch, grid.rows) for each in (low, np.nextafter(high, np.inf)))
    near = np.zeros((grid.rows, grid.cols), bool)
    for edge, row in _spread(first, stop):
        a, way = start[edge], end[edge] - start[edge]
        y = grid.y0 + (row + 0.5) * grid.pitch
        # what of the edge is no farther from the line of centres, and the cells along that
        flat = way[:, 1] == 0
        parts = [(y + off - a[:, 1]) / np.where(flat, 1.0, way[:, 1]) for off in (-distance, distance)]
        ends = [np.where(flat, k, np.clip(part, 0.0, 1.0)) for k, part in enumerate(parts)]
        across = np.sort(np.stack([a[:, 0] + part * way[:, 0] for part in ends]), axis=0)
        left = _count(across[0] - distance, grid.x0, grid.pitch, grid.cols)
        right = _count(np.nextafter(across[1] + distance, np.inf), grid.x0, grid.pitch, grid.cols)
        for k, col in _spread(left, right):
            arm = np.stack([grid.x0 + (col + 0.5) * grid.pitch, y[k]], 1) - a[k]
            square = np.einsum("ij,ij->i", way[k], way[k])
            share = np.clip(np.einsum("ij,ij->i", arm, way[k]) / np.where(square > 0, square, 1.0), 0.0, 1.0)
            off = arm - share[:, None] * way[k]
            close = np.hypot(off[:, 0], off[:, 1]) <= distance
            near[row[k[close]], col[close]] = True
    return near


def _edges(outlines: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Return where the edges of closed outlines begin and end, (n, 2) each."""
    counts = np.array([len(points) for points in outlines], np.int64)
    start = np.concatenate([np.zeros((0, 2)), *outlines])
    after = np.arange(1, len(start) + 1)
    stops = np.cumsum(counts)[counts > 0]
    after[stops - 1] = stops - counts[counts > 0]
    return start, start[after]


def _count(at: Floats, zero: float, pitch: float, most: int) -> Indices:
    """Return how many centres along a side of the grid lie before each place."""
    return np.clip(np.ceil((at - zero) / pitch - 0.5), 0, most).astype(np.int64)


def _spread(first: Indices, stop: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield (which, number) for all numbers from the first of each up to its stop, in portions."""
    counts = np.maximum(stop - first, 0)
    ends = np.cumsum(counts)
    cuts = np.searchsorted(ends, np.arange(0, int(ends[-1]) if len(ends) else 0, _AT_A_TIME), "right")
    for begin, end in pairwise([*cuts.tolist(), len(counts)]):
        some = counts[begin:end]
        which = np.repeat(np.arange(begin, end), some)
        yield which, np.arange(len(which)) - np.repeat(np.cumsum(some) - some, some) + first[which]
