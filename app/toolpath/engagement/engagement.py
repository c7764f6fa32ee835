"""How much of the cutter is engaged in standing metal, move by move, in the order of cutting.

Engaged is the part of the rim of the cutter's front half, as seen along the path, that lies in metal nobody has removed
at that depth yet. Of an engaged angle phi the engaged share of the diameter is (1 - cos phi) / 2: what a run along the
standing side takes with a stepover of as much; 1 = a full slot. How thick the metal is along the axis plays no part,
and what goes straight down is not engaged.

The metal is a field of heights in square cells (`engagement_kernels`): the job's stock box, cut by every cutting move
as a flat cutter would, as wide as its tool is at the stock's top. The cells' centres decide, so a share may be off by
`Engagement.bounds` for each straight edge of the metal, somewhat more where it is curved as sharply as the cutter.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.primitives import boxes
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Program
from ...model.stock_box import StockBox, stock_box
from ...model.tool import Tool
from ..coverage.areas import move_rows
from .engagement_kernels import SHIFT, mark, sweep
from .places import CELL, Floats, Indices, PathPlaces, cutting_radius, places, runs

STEPS = 100
"""Equal steps of the share in which lengths are counted."""

_MOST_KEPT = 1 << 21
"""Places, of some 100 bytes each, that are kept from tool to tool."""

_THINNEST = 0.05
"""Radii of a tool; so wide is it taken to cut at least, however little of a pointed one is in the metal."""


@dataclass(frozen=True, eq=False)
class Engagement:
    """How far the cutter is engaged along a program of n moves.

    Attributes:
        shares: (n,) the largest engaged share of the diameter along each move, in [0, 1]; 0 for rapids and what goes
            straight down.
        lengths: (operations, STEPS) mm of path in the plane whose share lies within each step, the last one with 1
            itself.
        largest: (operations,) the largest share of each operation's moves, 0 where it has none.
        bounds: (operations,) by how much these shares may be off: one and a half cells over the diameter.
    """

    shares: Floats
    lengths: Floats = field(repr=False)
    largest: Floats
    bounds: Floats

    @property
    def most(self) -> float:
        """The largest share over all."""
        return float(self.largest.max(initial=0.0))

    def above(self, share: float, operation: int | None = None) -> float:
        """Return the part of the length, in [0, 1], of one operation or of all, along which more than a share is
        engaged.

        Args:
            share: in [0, 1]; counts in whole steps.
            operation: index in the job; None = all.
        """
        lengths = self.lengths.sum(axis=0) if operation is None else self.lengths[operation]
        total = float(lengths.sum())
        return float(lengths[math.ceil(share * STEPS - 1e-9) :].sum()) / total if total > 0 else 0.0


@dataclass(frozen=True, eq=False)
class EngagementSamples:
    """What was seen along the path of a program, n moves in m cells.

    Attributes:
        begin, end: (n,) positions of each move on one scale for all, mm; alike where it was not looked at.
        first, last: (m,) positions between which each cell lies.
        share: (m,) engaged share in its middle.
        block: (m,) number of its block, not falling.
        owner: (m,) the move in its middle.
        radii: by T number, what each tool was taken to be, mm.
        pitches: by T number, side of the cells that its engagement was measured in, mm.
    """

    begin: Floats
    end: Floats
    first: Floats
    last: Floats
    share: Floats
    block: Indices
    owner: Indices
    radii: dict[int, float]
    pitches: dict[int, float]

    def bound(self, tool: int) -> float:
        """Return by how much the shares of a tool may be off.

        Half a cell's diagonal by which the rim that is looked at lies inside the true one, and as much from a cell's
        centre to where in it metal ends, over the diameter.
        """
        return 1.5 * self.pitches[tool] / (2 * self.radii[tool])


def engagement(program: Program, job: Job, progress: Progress = NO_PROGRESS) -> Engagement:
    """Return how far the cutter is engaged along a program.

    Args:
        program: whose cutting moves are looked at in their order.
        job: what it was computed from: stock, tools, operations.

    Raises:
        ParameterError: the job has no such tool.
        Cancelled: by progress.
    """
    seen, moves = sample_engagement(program, job, progress), program.moves
    shares, operations = np.zeros(len(moves)), max(len(job.operations), 1)
    lengths, largest, bounds = np.zeros((operations, STEPS)), np.zeros(operations), np.zeros(operations)
    for number in seen.radii:
        own = np.unique(moves.operation[(moves.tool == number) & (moves.kind != MoveKind.RAPID)])
        bounds[own] = np.maximum(bounds[own], seen.bound(number))
    going = np.flatnonzero(seen.end > seen.begin)
    if len(going):
        low, high = _own(seen, going)
        pairs = np.column_stack([low, high]).ravel()
        shares[going] = np.maximum.reduceat(np.append(seen.share, 0.0), pairs)[::2]
        np.maximum.at(largest, moves.operation, shares)
        step = np.clip(np.ceil(seen.share * STEPS - 1e-9) - 1, 0, STEPS - 1).astype(np.int64)
        np.add.at(lengths, (moves.operation[seen.owner], step), seen.last - seen.first)
    return Engagement(shares, lengths, largest, bounds)


def sample_engagement(program: Program, job: Job, progress: Progress = NO_PROGRESS) -> EngagementSamples:
    """Return what is seen along the path of a program; arguments and errors are those of `engagement`."""
    moves = program.moves
    cutting = moves.kind != MoveKind.RAPID
    begin, end = np.zeros(len(moves)), np.zeros(len(moves))
    if not cutting.any():
        none, no = np.zeros(0), np.zeros(0, np.int64)
        return EngagementSamples(
            begin=begin, end=end, first=none, last=none, share=none, block=no, owner=no, radii={}, pitches={}
        )
    lowest = np.minimum(moves.start[:, 2], moves.end[:, 2])
    numbers = np.unique(moves.tool[cutting]).tolist()
    radii = {
        number: _radius(job.tool(number), -float(lowest[cutting & (moves.tool == number)].min())) for number in numbers
    }
    path = _CuttingRuns(moves, radii, stock_box(job, program.regions, program.lines))
    found: dict[int, _SeenRun] = {}
    pitches = {}
    for k, number in enumerate(numbers):
        pitches[number] = path.along(number, found, progress.part(k / len(numbers), (k + 1) / len(numbers)))
    progress.step(1.0, "Measuring engagement")
    at, blocks, cells = 0.0, 0, []
    for _, (run, share) in sorted(found.items()):
        begin[run.moves], end[run.moves] = run.begin + at, run.end + at
        cells.append((run.first + at, run.last + at, share, run.block + blocks, run.owner))
        at, blocks = float(end[run.moves[-1]]), blocks + (int(run.block[-1]) + 1 if len(run.block) else 0)
    first, last, share, block, owner = (np.concatenate(column) for column in zip(*cells, strict=True))
    return EngagementSamples(begin, end, first, last, share, block, owner, radii, pitches)


def _radius(tool: Tool, depth: float) -> float:
    return max(cutting_radius(tool, depth), _THINNEST * tool.radius) if depth > 0 else tool.radius


class _SeenRun(NamedTuple):
    """Where a run was looked at, and the share of the tool that is engaged at each place."""

    places: PathPlaces
    share: Floats


class _CuttingRuns:
    """The cutting moves of all tools, run by run."""

    def __init__(self, moves: Moves, radii: dict[int, float], stock: StockBox) -> None:
        self._moves, self._radii, self._stock = moves, radii, stock
        self._runs = list(runs(moves, {number: CELL * radius for number, radius in radii.items()}))
        self._tools = [int(moves.tool[chosen[0]]) for chosen in self._runs]
        self._kept: dict[int, PathPlaces] = {}

    def along(self, number: int, found: dict[int, _SeenRun], progress: Progress) -> float:
        """Put what is seen along the path of one tool, run by run, into `found`; return the side of the cells, mm."""
        own = [k for k, tool in enumerate(self._tools) if tool == number]
        radii = self._radii[number], max(self._radii.values())
        material = EngagementField.along(
            self._moves, radii, self._stock, lambda: (self._places(k, progress).rows[:-1] for k in own)
        )
        for k, tool in enumerate(self._tools[: own[-1] + 1]):
            here = progress.part(k / (own[-1] + 1), (k + 1) / (own[-1] + 1))
            run = self._places(k, here)
            if tool == number:
                found[k] = _SeenRun(replace(run, rows=run.rows[:0]), material.engaged(run.rows, here)[run.seen])
            else:
                material.cut(run.rows, self._radii[tool], here)
        return material.pitch

    def _places(self, k: int, progress: Progress) -> PathPlaces:
        """Return where run k is looked at; the first ones are kept, since every tool asks for them."""
        progress.step(0.0, "Measuring engagement")
        if k in self._kept:
            return self._kept[k]
        run = places(self._moves, self._runs[k], self._radii[self._tools[k]])
        if sum(len(kept.rows) for kept in self._kept.values()) + len(run.rows) <= _MOST_KEPT:
            self._kept[k] = run
        return run


def _own(seen: EngagementSamples, going: Indices) -> tuple[Indices, Indices]:
    """Return (first, behind the last) of the cells whose middles lie on each move, or else of one that the move lies
    in.
    """
    low, high = spans(seen.begin[going], seen.end[going], seen.first, seen.last)
    low = low + ((seen.owner[low] != going) & (high - low > 1))
    return low, high - ((seen.owner[high - 1] != going) & (high - low > 1))


def spans(begin: Floats, end: Floats, first: Floats, last: Floats) -> tuple[Indices, Indices]:
    """Return (first, behind the last) of the pieces first … last that lie in begin … end; those that only touch do not,
    but one does.
    """
    hair = np.minimum((end - begin) / 4, 1e-9 + 1e-6 * (last - first).max(initial=0.0))
    low = np.searchsorted(last, begin + hair, side="right")
    high = np.searchsorted(first, end - hair, side="left")
    low = np.minimum(low, max(len(first) - 1, 0))
    return low, np.maximum(high, low + 1)


# The metal that the engagement of one tool is measured in: heights of square cells along its path, cut in the order of
# the moves.


_SIDE = 1 << SHIFT
"""Cells along a side of a tile."""

_ODD = (math.sqrt(5) - 1) / 2
"""Keeps paths at round coordinates off the cells' borders, where rounding would decide."""

_FINENESS = 20.0 / (1 - _ODD / 16)
"""Cells in the radius of the cutter."""

_COARSEST = 1000.0
"""Cells in the radius of the largest cutter, at most."""

_MOST_TILES = 1 << 14
"""Of 4,096 cells, 4 bytes each: 256 MiB."""

_MOST_INDEXED = 1 << 24
"""Tiles in the rectangle round all moves."""

_INSIDE = math.sqrt(0.5) + 1e-6
"""Cells by which the rim that is looked at lies inside the true one: what the cutter has gone over counts as cut up to
there.
"""

_SLICE = 1 << 13
"""Places between two looks at whether to stop."""


@dataclass(frozen=True, eq=False)
class EngagementField:
    """The metal along the path of one tool; cutting changes it.

    Attributes:
        radius: of the tool, mm.
        frame: x and y of the corner of its first cell, side of a cell, mm.
        heights: of the cells, tile after tile, mm; -inf where there is no metal.
        index: (rows, columns) slot of each tile, -1 where the tool does not come.
    """

    radius: float
    frame: tuple[float, float, float]
    heights: NDArray[np.float32]
    index: NDArray[np.int32]

    @staticmethod
    def along(
        moves: Moves, radii: tuple[float, float], stock: StockBox, places: Callable[[], Iterable[Floats]]
    ) -> EngagementField:
        """Return the uncut field along the path of a tool.

        Args:
            moves: all of them; every cutter may be led anywhere along them.
            radii: of the tool, and of the largest tool, mm.
            stock: where there is metal.
            places: gives those of the tool's path, (n, 6) each.
        """
        radius, largest = radii
        pitch = max(radius / _FINENESS, largest / _COARSEST)
        reach = boxes(move_rows(moves)[moves.kind != MoveKind.RAPID])
        low, high = reach[:, :2].min(axis=0) - largest, reach[:, 2:].max(axis=0) + largest
        while True:
            tile = pitch * _SIDE
            x, y = ((np.floor((low - 2 * pitch) / tile) - _ODD / _SIDE) * tile).tolist()
            cols, rows = (np.ceil((high + 2 * pitch - (x, y)) / tile) + 1).tolist()
            count = 0
            if rows * cols <= _MOST_INDEXED:
                index = np.full((int(rows), int(cols)), -1, np.int32)
                for each in places():
                    mark(index, (x, y, pitch), each, radius)
                count = int((index == 0).sum())
                if count <= _MOST_TILES:
                    index[index == 0] = np.arange(count)
                    return EngagementField(radius, (x, y, pitch), _metal(index, (x, y, pitch), stock), index)
            pitch *= max(math.sqrt(2), math.sqrt(count / _MOST_TILES))

    @property
    def pitch(self) -> float:
        """Side of a cell, mm."""
        return self.frame[2]

    def cut(self, rows: Floats, radius: float, progress: Progress) -> None:
        """Cut along a path (n, 6) of any tool."""
        self._led(rows, (radius, radius, 0.0), np.zeros((0, 2)), progress)

    def engaged(self, rows: Floats, progress: Progress) -> Floats:
        """Return the engaged share (n,) of the tool's diameter at places (n, 6) of its path, which is cut."""
        inner = max(self.radius - _INSIDE * self.pitch, 0.25 * self.radius)
        # no cell under the front half is cut from farther behind
        lag = math.sqrt((2 * self.radius - inner) ** 2 - inner * inner)
        count = max(32, math.ceil(2 * math.pi * self.radius / self.pitch))
        angle = (np.arange(count) + 0.5) / count * np.pi - np.pi / 2
        return self._led(rows, (self.radius, inner, lag), np.column_stack([np.cos(angle), np.sin(angle)]), progress)

    def _led(self, rows: Floats, cutter: tuple[float, float, float], rim: Floats, progress: Progress) -> Floats:
        share, done = np.zeros(len(rows)), 0
        for first in range(0, len(rows), _SLICE):
            progress.step(first / len(rows), "Measuring engagement")
            span = (first, min(first + _SLICE, len(rows)), done)
            done = sweep(self.heights, self.index, self.frame, rows, rim, cutter, span, share)
        return share


def _metal(index: NDArray[np.int32], frame: tuple[float, float, float], stock: StockBox) -> NDArray[np.float32]:
    """Return the heights of the stock in all tiles of an index."""
    (x, y, pitch), (rows, cols) = frame, np.nonzero(index >= 0)
    inner = (np.arange(_SIDE) + 0.5) * pitch
    xs, ys = x + (cols * _SIDE * pitch)[:, None] + inner, y + (rows * _SIDE * pitch)[:, None] + inner
    across, along = (xs >= stock.x0) & (xs <= stock.x1), (ys >= stock.y0) & (ys <= stock.y1)
    heights = np.full((len(rows), _SIDE, _SIDE), -np.inf, np.float32)
    heights[along[:, :, None] & across[:, None, :]] = stock.z1
    return heights.ravel()
