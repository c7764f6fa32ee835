"""Cuts a work piece by motions: the lowest height of every sweep in every cell, exactly."""

from __future__ import annotations

import math
import os
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import wait
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.dexel.cutter import Cutter
from app.dexel.pieces import Pieces, Splitter, Window
from app.dexel.workpiece import Grid, Heights, Workpiece, ensure_memory
from app.errors import Cancelled, ParameterError
from app.model.motion import Floats, MotionKind, Motions
from app.model.motion_path import anchored
from app.pool import pool
from app.progress import NO_PROGRESS, Progress
from app.tolerances import LEVEL

BATCH = 2_000_000
"""Pieces that are made at a time: about 250 MB."""

CHUNKS = 4
"""Parts in which pieces are sorted."""

WORKERS = max(2, os.cpu_count() or 2)

Ints = NDArray[np.int32]


class Rapids(Enum):
    """What rapid motions do."""

    IGNORED = "ignored"
    ASKED = "asked"
    CUT = "cut"


@dataclass(frozen=True, slots=True)
class TrimOptions:
    """What to note beside the heights.

    Attributes:
        rapids: ASKED: they cut nothing, and metal that they meet is told.
        touch: a rapid that goes no deeper into metal than this is told as none, mm; also how much slimmer than its cutter it is taken.
        trace: note the motion that cut each cell last, and each motion's volume and engaged cells. Every motion is then evaluated
            in all cells that the one before it in its chain has not swept as deep, which takes three times as long.
    """

    rapids: Rapids = Rapids.ASKED
    touch: float = LEVEL
    trace: bool = False


@dataclass(frozen=True, eq=False)
class Course:
    """What is cut along.

    Attributes:
        motions: n motions; where they are not known to begin (`Motions.known_from`) they are anchored.
        tool: (n,) T number of each.
        left_out: rows that neither cut nor are asked, such as those to a place of the machine.
    """

    motions: Motions
    tool: Ints
    left_out: tuple[int, ...] = ()

    @staticmethod
    def of(motions: Motions, tools: tuple[int, ...], left_out: tuple[int, ...] = ()) -> Course:
        """Return the course of a program; `tools` has the T number of each of its states."""
        return Course(motions, np.array(tools, np.int32)[motions.state], left_out)


@dataclass(frozen=True, slots=True)
class RapidHit:
    """A rapid motion that goes through metal.

    Attributes:
        motion: its row. x, y: where it is deepest, mm. depth: how deep, mm. cells: how many it meets.
        z: height that the cutter reaches there, mm; the metal stands `depth` higher.
    """

    motion: int
    x: float
    y: float
    depth: float
    cells: int
    z: float


@dataclass(frozen=True, eq=False)
class Cut:
    """What a course has left of a work piece.

    Attributes:
        before: the work piece.
        heights: (rows, cols) mm.
        rapids: those that met metal, in their order.
        owner: (rows, cols) row of the motion that cut each cell last, -1 where none did; None if it was not traced.
        volume: (n,) mm³ that each motion took; empty if not traced.
        engaged: (n,) cells that each motion lowered; empty if not traced.
    """

    before: Workpiece
    heights: Heights
    rapids: tuple[RapidHit, ...] = ()
    owner: Ints | None = None
    volume: Floats = field(default_factory=lambda: np.zeros(0))
    engaged: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def removed_volume(self) -> float:
        """mm³, from the heights before and after."""
        taken = np.subtract(self.before.heights, self.heights).sum(dtype=np.float64)
        return float(taken) * self.before.grid.pitch**2

    @property
    def workpiece(self) -> Workpiece:
        """What is left, to be cut again."""
        return Workpiece(self.before.grid, self.heights, self.before.floor, self.before.hidden)


def trim(workpiece: Workpiece, course: Course, cutters: Mapping[int, Cutter], options: TrimOptions = TrimOptions(),
         progress: Progress = NO_PROGRESS) -> Cut:  # fmt: skip
    """Cut a work piece.

    Heights are within 5e-6 mm (1 + slope of the surface) of exact for heights up to 32 mm; beside a vertical wall a cell whose centre
    is on the wall may fall to either side. They do not depend on the order of chains of motions, bit for bit, as long as there are
    no more than BATCH pieces (breaking up a chain changes which cells are evaluated, and so the rounding).

    Args:
        workpiece: it is left as it is.
        course: motions and their tools.
        cutters: by T number.
        options: what to note.
        progress: told as tiles are done.

    Raises:
        ParameterError: a tool that cuts is not among the cutters, or the notes would not fit into memory.
        Cancelled: the job was asked to stop.
    """
    job = _Job(workpiece, course, cutters, options)
    for batch, share in job.batches():
        batch.run(progress.part(*share))
    progress.step(1.0, "Cut")
    return job.result()


class _Job:
    """The state of one trim."""

    def __init__(self, workpiece: Workpiece, course: Course, cutters: Mapping[int, Cutter], options: TrimOptions) -> None:
        self.workpiece, self.options, self.grid = workpiece, options, workpiece.grid
        ensure_memory(self.grid, 8 if options.trace else 4)
        motions = course.motions
        self.motions = anchored(motions) if any(motions.known_from) else motions
        self.does = _deeds(course, options)
        self.shapes, self.cutter = _shape_rows(course, cutters, self.does, options)
        self.heights = np.empty_like(workpiece.heights)
        self.owner = np.full(workpiece.heights.shape if options.trace else (0, 0), -1, np.int32)
        noted = len(motions) if options.trace else 0
        self.volume, self.engaged = np.zeros(noted), np.zeros(noted, np.int64)
        self.hits: dict[int, RapidHit] = {}

    def batches(self) -> Iterator[tuple[_Batch, tuple[float, float]]]:
        """Yield parts of the course that fit into memory, and which part of the whole they are."""
        radius = np.where(self.does > 0, self.shapes[self.cutter, 0], -math.inf)
        splitter = Splitter(self.motions, window=Window(self.grid.box, radius))
        ends = np.cumsum(splitter.counts)
        first, total = 0, len(self.motions)
        before = self.workpiece.heights
        while True:
            done = int(ends[first - 1]) if first else 0
            last = max(first + 1, int(np.searchsorted(ends, done + BATCH, "right"))) if total else 0
            share = (done / int(ends[-1]), int(ends[last - 1]) / int(ends[-1])) if total else (0.0, 1.0)
            yield _Batch(self, splitter.pieces(first, last), before), share
            if last >= total:
                return
            before, first = self.heights, last

    def result(self) -> Cut:
        """Return what was cut."""
        return Cut(self.workpiece, self.heights, tuple(self.hits[row] for row in sorted(self.hits)),
                   self.owner if self.options.trace else None, self.volume, self.engaged)  # fmt: skip


class _Batch:
    """Pieces, sorted by the tiles that they meet."""

    def __init__(self, job: _Job, pieces: Pieces, before: Heights) -> None:
        self._job, self._motion, self._before = job, pieces.motion, before.view()
        for array in (self._before, pieces.start, pieces.end):
            array.setflags(write=False)
        self._does = job.does[self._motion]
        self._tables = (pieces.start, pieces.end, self._does, job.cutter[self._motion], pieces.arc, job.shapes, pieces.arcs)
        self._where = (float(job.grid.x0), float(job.grid.y0), float(job.grid.pitch))
        self._spans = np.empty((len(pieces), 2))

    def run(self, progress: Progress) -> None:
        """Cut all tiles."""
        from app.dexel.tile_kernels import ASKS, cut_tile

        job, boxes = self._job, _tile_boxes(self._job.grid)
        bounds, refs, votes = self._sorted(len(boxes))
        told = np.zeros((len(refs) if job.options.trace or bool(np.any(self._does == ASKS)) else 0, 5))
        limits = (float(job.workpiece.floor), float(job.options.touch))

        def cut(tile: int) -> None:
            mine = slice(bounds[tile], bounds[tile + 1])
            cut_tile(*self._tables, self._spans, self._motion, refs[mine], self._where, boxes[tile], bool(votes[tile] > 0),
                     self._before, job.heights, job.owner, told[mine], limits)  # fmt: skip

        _in_parallel(cut, np.argsort(-np.diff(bounds), kind="stable").tolist(), progress)
        if len(told):
            self._take_notes(refs, told)

    def _sorted(self, tiles: int) -> tuple[NDArray[np.int64], Ints, NDArray[np.int64]]:
        """Return where each tile's pieces begin in the list, the list, and how the tiles' lines should run (> 0: along Y)."""
        from app.dexel.tile_kernels import count, fill, survey

        grid, full = self._job.grid, self._job.options.trace
        steps = np.linspace(0, len(self._motion), CHUNKS + 1).astype(int).tolist()
        counts, votes = np.zeros((CHUNKS, tiles), np.int64), np.zeros((CHUNKS, tiles), np.int64)
        common, met = (*self._tables, self._where, (grid.rows, grid.cols)), np.empty((len(self._motion), 5), np.int16)
        top = float(self._before.max())

        def look(k: int) -> None:
            survey(*common, steps[k], steps[k + 1], not full, top, self._spans, met)
            count(*common, steps[k], steps[k + 1], met, counts[k], votes[k])

        _in_parallel(look, list(range(CHUNKS)))
        bounds = np.concatenate([[0], np.cumsum(counts.sum(axis=0))])
        places, refs = bounds[:-1] + np.cumsum(counts, axis=0) - counts, np.empty(bounds[-1], np.int32)
        _in_parallel(lambda k: fill(*common, steps[k], steps[k + 1], met, places[k], refs), list(range(CHUNKS)))
        return bounds, refs, votes.sum(axis=0)

    def _take_notes(self, refs: Ints, told: Floats) -> None:
        from app.dexel.tile_kernels import ASKS

        job, motion, asks = self._job, self._motion[refs], self._does[refs] == ASKS
        if job.options.trace:
            job.volume += np.bincount(motion, np.where(asks, 0.0, told[:, 0]), len(job.volume)) * job.grid.pitch**2
            job.engaged += np.bincount(motion, np.where(asks, 0.0, told[:, 1]), len(job.engaged)).astype(np.int64)
        for k in np.flatnonzero(asks & (told[:, 1] > 0)):
            row, (_, cells, depth, place, z) = int(motion[k]), told[k]
            x, y = job.grid.place(int(place))
            hit, old = RapidHit(row, x, y, float(depth), int(cells), float(z)), job.hits.get(row)
            deepest = hit if old is None or hit.depth > old.depth else old
            job.hits[row] = replace(deepest, cells=hit.cells + (old.cells if old else 0))


def _in_parallel(work: Callable[[int], None], parts: list[int], progress: Progress = NO_PROGRESS) -> None:
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


def _tile_boxes(grid: Grid) -> list[tuple[int, int, int, int]]:
    """Return first row, first column, rows and columns of each tile."""
    from app.dexel.sweep_kernels import TILE

    return [(row, col, min(TILE, grid.rows - row), min(TILE, grid.cols - col))
            for row in range(0, grid.rows, TILE) for col in range(0, grid.cols, TILE)]


def _deeds(course: Course, options: TrimOptions) -> NDArray[np.uint8]:
    """Return what each motion does: 0 nothing, 1 it cuts, 2 it is asked."""
    rapid = {Rapids.IGNORED: 0, Rapids.ASKED: 2, Rapids.CUT: 1}[options.rapids]
    does = np.where(course.motions.kind == MotionKind.RAPID, rapid, 1).astype(np.uint8)
    does[list(course.left_out)] = 0
    return does


def _shape_rows(course: Course, cutters: Mapping[int, Cutter], does: NDArray[np.uint8], options: TrimOptions) -> tuple[Floats, Ints]:
    """Return the rows of the cutters, each followed by the slimmer one of its rapids, and each motion's row.

    A motion without a cutter does nothing if it is a rapid.
    """
    numbers = np.flatnonzero(np.bincount(course.tool))
    index = np.searchsorted(numbers, np.arange(numbers[-1] + 1 if len(numbers) else 0))[course.tool]
    rows = np.zeros((2 * max(len(numbers), 1), 7))
    for k, number in enumerate(numbers.tolist()):
        cutter = cutters.get(number)
        if cutter is not None:
            rows[2 * k] = _shape_row(cutter)
            rows[2 * k + 1] = _shape_row(cutter.shrunk(min(options.touch, cutter.radius / 2)) or cutter)
            continue
        mine = index == k
        cuts = np.flatnonzero(mine & (does == 1) & (course.motions.kind != MotionKind.RAPID))
        if len(cuts):
            raise ParameterError(f"T{number} cuts from line {int(course.motions.line[cuts[0]])} on, but nobody has said what it is; "
                                 f"give its shape, such as {number}=flat:6.")
        does[mine] = 0
    return rows, (2 * index + (does == 2)).astype(np.int32)


def _shape_row(cutter: Cutter) -> Floats:
    """Return a cutter's row for the kernels."""
    from app.dexel.sweep_kernels import BALL, BULL, CONE, FLAT_END, TAPER

    cone = 0.0 if math.isinf(cutter.slope) else cutter.slope
    if cone:
        kind = TAPER if cutter.fillet else CONE
    elif cutter.fillet:
        kind = BULL if cutter.flat else BALL
    else:
        kind = FLAT_END
    return np.array([cutter.radius, cutter.flat, cutter.fillet, cutter.fillet_span, cone, cutter.lift, kind])
