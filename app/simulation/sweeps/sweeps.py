"""A course over a grid, made ready to be cut: what each motion does and with which cutter, its pieces, and the tiles
that these meet.
"""

from __future__ import annotations

import math
import os
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import wait
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import Cancelled
from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, MotionKind, Motions, Plane
from ...model.motion_path import anchored
from ..cutter import Cutter
from ..field.workpiece import Grid, Heights
from .course import Course, Ints, Rapids, TrimOptions
from .pieces import PieceSplitter, SweepWindow, helix_chord

BATCH = 2_000_000
"""Pieces that are made at a time: about 250 MB."""

CHUNKS = 4
"""Parts in which pieces are sorted."""

WORKERS = max(2, os.cpu_count() or 2)
"""Pieces of work that sweep tiles beside one another: one a core, two at least."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class CutField:
    """Heights that are being cut, and the motion that cut each cell last.

    Attributes:
        heights: (rows, cols) mm, overwritten.
        owner: (rows, cols) row of the motion, -1 = none, overwritten; (0, 0): it is not noted.
    """

    heights: Heights
    owner: Ints


@dataclass(frozen=True, slots=True)
class HeightLimits:
    """Between which heights there is something to cut.

    Attributes:
        top: no metal is higher, mm. floor: none is lower.
        touch: depth from which a motion that is asked is told of, mm.
    """

    top: float
    floor: float
    touch: float


@dataclass(frozen=True, eq=False)
class TileIndex:
    """Pieces by the tiles that they meet.

    Attributes:
        bounds: (tiles + 1,) where each tile's pieces begin in the list. refs: the list.
        turned: (tiles,) whether a tile's lines run along Y.
        spans: (n, 2) from where to where along each straight piece cells are evaluated, mm.
    """

    bounds: NDArray[np.int64]
    refs: Ints
    turned: Mask
    spans: Floats


class Sweeps:
    """A course over a grid.

    Attributes:
        grid: the cells. course: what is cut along; `motions` are its, anchored.
        does: (n,) what each motion does: nothing, it cuts, it is asked. shapes, cutter: rows of the cutters, and each
            motion's.
        trace: each motion is evaluated wherever the one before it in its chain has not swept as deep; else those that
            another one outdoes do nothing.
        batches: first motions and ends of the parts that are cut at a time.
    """

    def __init__(self, grid: Grid, course: Course, cutters: Mapping[int, Cutter], options: TrimOptions) -> None:
        """Make a course ready.

        Args:
            grid: the cells.
            course: motions and their tools.
            cutters: by T number.
            options: what rapids do, and what is to be noted.

        Raises:
            ParameterError: a tool that cuts is not among the cutters.
        """
        self.grid, self.course, self.trace = grid, course, options.trace
        self.motions = anchored(course.motions) if any(course.motions.known_from) else course.motions
        self.does = _deeds(course, options.rapids)
        self.shapes, self.cutter = _shape_rows(course, cutters, self.does, options.touch)
        if options.heights_alone:
            self.does[superseded(self.motions, self.cutter, self.does)] = 0
        radius = np.where(self.does > 0, self.shapes[self.cutter, 0], -math.inf)
        self.splitter = PieceSplitter(
            self.motions, window=SweepWindow(grid.box, radius), helix_chord=helix_chord(grid.pitch)
        )
        self.batches = tuple(_batches(self.splitter.counts))

    def part(self, first: int, last: int, behind: int = 0) -> CoursePart:
        """Return the motions first … last - 1; `behind` motions before them tell how the chain goes on, and are not
        cut.
        """
        return CoursePart(self, first, last, behind)

    @cached_property
    def tiles(self) -> list[tuple[int, int, int, int]]:
        """First row, first column, rows and columns of each tile."""
        from .sweep_kernels import TILE

        grid = self.grid
        return [
            (row, col, min(TILE, grid.rows - row), min(TILE, grid.cols - col))
            for row in range(0, grid.rows, TILE)
            for col in range(0, grid.cols, TILE)
        ]


class CoursePart:
    """Some motions of a course that follow one another, in pieces."""

    def __init__(self, sweeps: Sweeps, first: int, last: int, behind: int) -> None:
        pieces = sweeps.splitter.pieces(first - behind, last)
        for array in (pieces.start, pieces.end):
            array.setflags(write=False)
        self._sweeps, self.motion = sweeps, pieces.motion
        self._first = int(np.searchsorted(pieces.motion, first))
        self.does = sweeps.does[pieces.motion]
        self._pieces, self._cutter = pieces, sweeps.cutter[pieces.motion]
        self._where = (float(sweeps.grid.x0), float(sweeps.grid.y0), float(sweeps.grid.pitch))

    def sorting(self, top: float, stop: int | None = None) -> TileIndex:
        """Return the pieces by tile.

        Args:
            top: no metal is higher, mm.
            stop: motions from this one on do nothing; how tiles' lines run does not depend on it, so that what is cut
                up to a motion is, bit for bit, what is cut on the way to a later one.
        """
        sorting = self._sorted(self.does, top)
        if stop is None or not len(self.motion) or stop > self.motion[-1]:
            return sorting
        return replace(self._sorted(np.where(self.motion < stop, self.does, np.uint8(0)), top), turned=sorting.turned)

    def without_asking(self) -> CoursePart:
        """Make motions that are only asked do nothing; return the part itself."""
        from .tile_kernels import ASKS

        self.does = np.where(self.does == ASKS, np.uint8(0), self.does)
        return self

    def cut(
        self,
        before: Heights,
        field: CutField,
        sorting: TileIndex,
        limits: HeightLimits,
        progress: Progress = NO_PROGRESS,
    ) -> Floats:
        """Cut all tiles, or, where `before` is the field's own heights, those that some piece meets.

        Args:
            before: (rows, cols) the heights to begin with.
            field: what is left is written there.
            sorting: of this part. limits: of the metal.
            progress: told as tiles are done.

        Returns:
            (refs, 5) what each piece does in its tile: volume in mm of height, engaged cells, greatest depth, its cell,
            and the height that is reached there; empty where nothing is asked nor traced.

        Raises:
            Cancelled: the job was asked to stop.
        """
        from .tile_kernels import ASKS, cut_tile

        tables, boxes, bounds = self._tables(self.does), self._sweeps.tiles, sorting.bounds
        told = np.zeros((len(sorting.refs) if field.owner.size or bool(np.any(self.does == ASKS)) else 0, 5))
        old = before.view()
        old.setflags(write=False)

        def cut(tile: int) -> None:
            mine = slice(bounds[tile], bounds[tile + 1])
            cut_tile(
                *tables,
                sorting.spans,
                self.motion,
                sorting.refs[mine],
                self._where,
                boxes[tile],
                bool(sorting.turned[tile]),
                old,
                field.heights,
                field.owner,
                told[mine],
                (limits.floor, limits.touch),
            )

        sizes = np.diff(bounds)
        order = np.argsort(-sizes, kind="stable")
        in_parallel(cut, (order[sizes[order] > 0] if before is field.heights else order).tolist(), progress)
        return told

    def _tables(self, does: NDArray[np.uint8]) -> tuple[NDArray[np.generic], ...]:
        pieces = self._pieces
        return pieces.start, pieces.end, does, self._cutter, pieces.arc, self._sweeps.shapes, pieces.arcs

    def _sorted(self, does: NDArray[np.uint8], top: float) -> TileIndex:
        from .tile_kernels import count, fill, survey

        sweeps, tiles, pieces = self._sweeps, len(self._sweeps.tiles), len(self.motion)
        steps = np.linspace(self._first, pieces, CHUNKS + 1).astype(int).tolist()
        counts, votes = np.zeros((CHUNKS, tiles), np.int64), np.zeros((CHUNKS, tiles), np.int64)
        common = (*self._tables(does), self._where, (sweeps.grid.rows, sweeps.grid.cols))
        spans, met = np.empty((pieces, 2)), np.empty((pieces, 5), np.int16)

        def look(k: int) -> None:
            survey(*common, steps[k], steps[k + 1], not sweeps.trace, top, spans, met)
            count(*common, steps[k], steps[k + 1], met, counts[k], votes[k])

        in_parallel(look, list(range(CHUNKS)))
        bounds = np.concatenate([[0], np.cumsum(counts.sum(axis=0))])
        places, refs = bounds[:-1] + np.cumsum(counts, axis=0) - counts, np.empty(bounds[-1], np.int32)
        in_parallel(lambda k: fill(*common, steps[k], steps[k + 1], met, places[k], refs), list(range(CHUNKS)))
        return TileIndex(bounds, refs, votes.sum(axis=0) > 0, spans)


def in_parallel(work: Callable[[int], None], parts: list[int], progress: Progress = NO_PROGRESS) -> None:
    """Do the parts of a work on the pool, in the order of the list as threads come free.

    Raises:
        Cancelled: the job was asked to stop; what had begun is finished first.
    """
    waiting, done, stop = deque(parts), deque[int](), threading.Event()

    def worker() -> None:
        while waiting and not stop.is_set():
            try:
                part = waiting.popleft()
            except IndexError:
                return
            work(part)
            done.append(part)

    threads = [pool().submit(worker) for _ in range(min(WORKERS, len(parts)))]
    try:
        while wait(threads, timeout=0.05).not_done:
            progress.step(len(done) / len(parts), "Cutting")
    except Cancelled:
        stop.set()
        wait(threads)
        raise
    for thread in threads:
        thread.result()


def _batches(counts: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Yield parts of a course whose pieces fit into memory: first motion, and the first one of the next part; at least
    one part.
    """
    ends, first, total = np.cumsum(counts), 0, len(counts)
    while True:
        done = int(ends[first - 1]) if first else 0
        last = max(first + 1, int(np.searchsorted(ends, done + BATCH, "right"))) if total else 0
        yield first, last
        if last >= total:
            return
        first = last


def _deeds(course: Course, rapids: Rapids) -> NDArray[np.uint8]:
    """Return what each motion does: 0 nothing, 1 it cuts, 2 it is asked."""
    rapid = {Rapids.IGNORED: 0, Rapids.ASKED: 2, Rapids.CUT: 1}[rapids]
    does = np.where(course.motions.kind == MotionKind.RAPID, rapid, 1).astype(np.uint8)
    does[list(course.left_out)] = 0
    return does


def _shape_rows(
    course: Course, cutters: Mapping[int, Cutter], does: NDArray[np.uint8], touch: float
) -> tuple[Floats, Ints]:
    """Return the rows of the cutters, each followed by the slimmer one of its rapids, and each motion's row.

    A motion without a cutter does nothing if it is a rapid.
    """
    numbers = np.flatnonzero(np.bincount(course.tool))
    index = np.searchsorted(numbers, np.arange(numbers[-1] + 1 if len(numbers) else 0))[course.tool]
    rows = np.zeros((2 * max(len(numbers), 1), 7))
    for k, number in enumerate(numbers.tolist()):
        cutter = cutters.get(number)
        if cutter is not None:
            rows[2 * k] = shape_row(cutter)
            rows[2 * k + 1] = shape_row(cutter.shrunk(min(touch, cutter.radius / 2)) or cutter)
            continue
        mine = index == k
        cuts = np.flatnonzero(mine & (does == 1) & (course.motions.kind != MotionKind.RAPID))
        if len(cuts):
            raise course.strange_tool(int(cuts[0]))
        does[mine] = 0
    return rows, (2 * index + (does == 2)).astype(np.int32)


def shape_row(cutter: Cutter) -> Floats:
    """Return a cutter's row for the kernels."""
    from .sweep_kernels import BALL, BULL, CONE, FLAT_END, TAPER

    cone = 0.0 if math.isinf(cutter.slope) else cutter.slope
    if cone:
        kind = TAPER if cutter.fillet else CONE
    elif cutter.fillet:
        kind = BULL if cutter.flat else BALL
    else:
        kind = FLAT_END
    return np.array([cutter.radius, cutter.flat, cutter.fillet, cutter.fillet_span, cone, cutter.lift, kind])


# Motions that change nothing in what is left: another one goes the same way, nowhere higher.
#
# A cutter over a place that goes deeper there takes all that it took before, whatever its shape. So of the turns of a
# helix on one circle the last ones count alone, and of passes along one line or arc the deepest. Heights are the least
# of all sweeps: which of the two came first is the same to them. It is not to a rapid that asks how high the metal is
# when it comes, so none may lie between.


SAME = 1e-9
"""mm that two ways may differ by and be the same: what sums of a program's numbers differ by in their last bits."""


def superseded(motions: Motions, cutter: NDArray[np.int32], does: NDArray[np.uint8]) -> Mask:
    """Return which motions cut nothing that another does not; of motions that are alike all but one.

    Args:
        motions: n motions.
        cutter: (n,) what each is cut with; motions of different ones are not compared.
        does: (n,) what each does, by the numbers of `tile_kernels`.
    """
    from .tile_kernels import ASKS, CUTS

    kind = motions.kind
    turns = ((kind == MotionKind.ARC_CW) | (kind == MotionKind.ARC_CCW)) & (motions.plane == Plane.XY)
    asked = np.cumsum(does == ASKS, dtype=np.int32)
    rows = np.flatnonzero((does == CUTS) & (turns | (kind <= MotionKind.LINE)))
    rows = _not_alone(motions, rows, turns[rows], (cutter, asked))
    ways = _ways(motions, rows, turns[rows])
    group = _groups((*ways.columns, cutter[rows], asked[rows]))
    answer = np.zeros(len(motions), bool)
    answer[rows[_not_lowest(group, ways.first, ways.last)]] = True
    return answer


def _not_alone(
    motions: Motions, rows: NDArray[np.intp], turns: Mask, others: tuple[NDArray[np.int32], ...]
) -> NDArray[np.intp]:
    """Return those of the rows that may go the way of another: their columns have a hash that some other row has, too.

    Of millions of motions few go one way, and sorting one number each is quicker than sorting all columns.
    """
    code = np.zeros(len(rows), np.uint64)
    for column in _columns(motions, rows, turns):
        _mix(code, (column + 0.0).view(np.uint64))  # of two zeros there is one left
    for other in others:
        _mix(code, other[rows].astype(np.uint64))
    order = np.argsort(code, kind="stable")
    same = code[order[1:]] == code[order[:-1]]
    met = np.zeros(len(rows), bool)
    met[order[1:][same]] = met[order[:-1][same]] = True
    return rows[met]


def _mix(code: NDArray[np.uint64], values: NDArray[np.uint64]) -> None:
    """Mix values into hashes, in place (the finishing step of splitmix64)."""
    code ^= values
    code *= np.uint64(0xBF58476D1CE4E5B9)
    code ^= code >> np.uint64(29)


class _Ways(NamedTuple):
    """What ways m motions go in XY.

    Attributes:
        columns: (m,) each; motions go one way where all of these are alike.
        first, last: (m,) the heights at which they begin and end there, mm.
    """

    columns: tuple[Floats, ...]
    first: Floats
    last: Floats


def _ways(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> _Ways:
    """Return the ways of motions."""
    low, high = motions.start[rows, 2], motions.end[rows, 2]
    swapped = _swapped(motions, rows, turns)
    return _Ways(tuple(_columns(motions, rows, turns)), np.where(swapped, high, low), np.where(swapped, low, high))


def _columns(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> Iterator[Floats]:
    """Yield what tells the ways of motions apart, column by column: of millions a table of them takes a gigabyte."""
    swapped = _swapped(motions, rows, turns)
    for axis in (0, 1):
        a, b = motions.start[rows, axis], motions.end[rows, axis]
        yield np.rint(np.where(swapped, b, a) / SAME)
        yield np.rint(np.where(swapped, a, b) / SAME)
        yield np.rint(np.where(turns, motions.centre[rows, axis], 0.0) / SAME)
    yield np.where(turns, motions.turns[rows], 0).astype(np.float64)


def _swapped(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> Mask:
    """Return which motions are told from their ends: a line is the same from there, an arc too, the other way round."""
    start, end = motions.start, motions.end
    x, other_x = start[rows, 0], end[rows, 0]
    later = (x > other_x) | ((x == other_x) & (start[rows, 1] > end[rows, 1]))
    return np.asarray(np.where(turns, motions.kind[rows] == MotionKind.ARC_CW, later))


def _groups(columns: Sequence[NDArray[np.generic]]) -> NDArray[np.int64]:
    """Return (m,) a number for each row, the same for rows whose columns (m,) are all alike."""
    order = np.lexsort(columns)
    changes = np.zeros(max(len(order) - 1, 0), np.bool_)
    for column in columns:
        sorted_column = column[order]
        changes |= sorted_column[1:] != sorted_column[:-1]
    group = np.empty(len(order), np.int64)
    group[order] = np.concatenate([[0], np.cumsum(changes)]) if len(order) else 0
    return group


def _not_lowest(group: NDArray[np.int64], first: Floats, last: Floats) -> Mask:
    """Return for each of m pairs of heights whether one of its group has both no higher.

    In the order of first heights, it is the least of the last heights so far that tells; ranks that fall from group to
    group let the least begin anew with each.
    """
    count = len(group)
    order = np.lexsort((last, first, group))
    rank = np.unique(last, return_inverse=True)[1]
    value = rank[order] - group[order] * (count + 1)
    least = np.minimum.accumulate(value)
    answer = np.zeros(count, bool)
    answer[order[1:]] = (group[order[1:]] == group[order[:-1]]) & (least[:-1] <= value[1:])
    return answer
