"""Every state of a work piece on its way: reached at once from copies of the squares of cells that changed, and bit for
bit.

A course falls into blocks of motions that take about as long to cut. Behind each block the squares are kept that it has
changed. To reach a state, every square takes its newest copy from behind the last whole block before it, and the
motions from there on are cut. Each motion is evaluated wherever the one before it has not swept as deep, whatever comes
after it (`TrimOptions.trace`), and lines of cells run as they do when the whole course is cut: so the order in which
states are reached leaves no trace in them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...core.tolerances import LEVEL
from ...model.motion import Floats
from ...model.motion_path import lengths
from ..cutter import Cutter
from ..field.workpiece import Workpiece, ensure_memory
from ..sweeps.course import Course, Ints, Rapids, TrimOptions
from ..sweeps.sweeps import CutField, HeightLimits, Mask, Sweeps

Box = tuple[int, int, int, int]

SIDE = 32
"""Cells along the side of a square that is kept."""

BYTES_A_CELL = 8
"""Of a copy: a height and an owner."""


@dataclass(frozen=True, slots=True)
class HistoryOptions:
    """How much is kept.

    Attributes:
        blocks: parts of the way behind which changes are kept, at most; >= 1.
        budget: bytes that the copies may take; with less than they need every second block is given up, and so on.
    """

    blocks: int = 512
    budget: int = 256 << 20


@dataclass(frozen=True, eq=False)
class _Batch:
    """Motions of one course that `trim` cuts at a time.

    Attributes:
        sweeps: the course. start: its first motion, counted through all courses.
        first, last: the motions, counted in their own course.
        turned: how tiles' lines run. limits: of the metal.
    """

    sweeps: Sweeps
    start: int
    first: int
    last: int
    turned: Mask
    limits: HeightLimits

    def cut(self, field: CutField, first: int, last: int, progress: Progress) -> Box | None:
        """Do the motions of this batch among first … last - 1, counted through all courses; return where the field may
        have changed.
        """
        low, high = max(first - self.start, self.first), min(last - self.start, self.last)
        if low >= high:
            return None
        part = self.sweeps.part(low, high, int(low > self.first)).without_asking()
        own = field if self.start == 0 else CutField(field.heights, np.maximum(field.owner - np.int32(self.start), -1))
        sorting = replace(part.sorting(self.limits.top), turned=self.turned)
        part.cut(own.heights, own, sorting, self.limits, progress)
        if own is not field:
            np.copyto(field.owner, own.owner + np.int32(self.start), where=own.owner >= 0)
        met = [self.sweeps.tiles[k] for k in np.flatnonzero(np.diff(sorting.bounds))]
        return _round(met) if met else None


class History:
    """All states of a work piece that is cut along courses, one after the other.

    Attributes:
        motions: how many there are, of all courses.
        ends: (blocks,) motions that are done behind each block; rising, the last one is `motions`.
        base: the field before all motions.
    """

    def __init__(
        self,
        workpiece: Workpiece,
        courses: Sequence[Course],
        cutters: Mapping[int, Cutter],
        options: HistoryOptions = HistoryOptions(),
        progress: Progress = NO_PROGRESS,
    ) -> None:
        """Cut everything once, and keep what changes.

        Args:
            workpiece: it is left as it is.
            courses: of the programs, in the order of cutting.
            cutters: by T number.
            options: how much is kept.
            progress: of this part.

        Raises:
            ParameterError: a tool that cuts is not among the cutters, or the grid does not fit into memory.
            Cancelled: the job was asked to stop.
        """
        ensure_memory(workpiece.grid, 4 * BYTES_A_CELL)
        self._workpiece, self._cutters = workpiece, cutters
        self.motions = sum(len(course.motions) for course in courses)
        self.base = CutField(workpiece.heights.copy(), np.full(workpiece.heights.shape, -1, np.int32))
        self._batches: list[_Batch] = []
        sweeps = [Sweeps(workpiece.grid, course, cutters, TrimOptions(trace=True)) for course in courses]
        ends = _block_ends(np.concatenate([_costs(each) for each in sweeps]), options.blocks)
        self._kept = _Copies(workpiece.heights.shape, len(ends), options.budget)
        self._cut_once(sweeps, ends, progress)
        self.ends = self._kept.close(ends)

    @property
    def bytes(self) -> int:
        """What the copies take."""
        return self._kept.bytes

    def advance(self, field: CutField, first: int, last: int, progress: Progress = NO_PROGRESS) -> None:
        """Do the motions first … last - 1 on a field that is as the ones before have left it.

        Raises:
            Cancelled: the job was asked to stop; the field is good for nothing then.
        """
        for batch in self._batches:
            progress.step(0.0)
            batch.cut(field, first, last, progress)

    def advance_along(self, field: CutField, course: Course, motion: int) -> None:
        """Cut a field along the way that one motion has gone so far.

        Args:
            field: as the motions before have left it; overwritten.
            course: that way, all of it cutting. motion: whose it is, counted through all courses.
        """
        sweeps = Sweeps(self._workpiece.grid, course, self._cutters, TrimOptions(Rapids.IGNORED, trace=True))
        own = CutField(field.heights, np.full_like(field.owner, -1))
        part = sweeps.part(0, len(course.motions))
        top = float(self._workpiece.heights.max())
        part.cut(own.heights, own, part.sorting(top), HeightLimits(top, float(self._workpiece.floor), LEVEL))
        field.owner[own.owner >= 0] = motion

    def behind(self, motion: int) -> tuple[int, int]:
        """Return the number of the last block that ends at or before a motion, -1 = none, and how many motions are done
        there.
        """
        block = int(np.searchsorted(self.ends, motion, "right")) - 1
        return block, int(self.ends[block]) if block >= 0 else 0

    def restore(self, field: CutField, block: int) -> None:
        """Overwrite a field with what there was behind a block; -1: before all motions."""
        self._kept.restore(field, self.base, block)

    def _cut_once(self, sweeps: Sequence[Sweeps], ends: NDArray[np.int64], progress: Progress) -> None:
        heights, start = self._workpiece.heights.copy(), 0
        field = CutField(heights, self.base.owner.copy())
        self._kept.begin(field)
        for each in sweeps:
            for first, last in each.batches:
                top = float(field.heights.max())
                turned = each.part(first, last).sorting(top).turned
                self._batches.append(
                    _Batch(each, start, first, last, turned, HeightLimits(top, float(self._workpiece.floor), LEVEL))
                )
                self._cut_batch(field, ends, progress)
            start += len(each.motions)

    def _cut_batch(self, field: CutField, ends: NDArray[np.int64], progress: Progress) -> None:
        """Do the last batch, block by block."""
        batch = self._batches[-1]
        first, last = batch.start + batch.first, batch.start + batch.last
        for block in range(int(np.searchsorted(ends, first, "right")), len(ends)):
            low, high = max(first, int(ends[block - 1]) if block else 0), min(last, int(ends[block]))
            if low >= high:
                return
            progress.step(low / max(self.motions, 1), "Preparing playback")
            self._kept.stir(batch.cut(field, low, high, NO_PROGRESS))
            if high == ends[block]:
                self._kept.take(field, block)


class _Copies:
    """Copies of squares, the oldest first; as few as the budget wants."""

    def __init__(self, shape: tuple[int, int], blocks: int, budget: int) -> None:
        self._blocks = blocks
        self._squares = math.ceil(shape[0] / SIDE) * math.ceil(shape[1] / SIDE)
        most = max(budget // (SIDE * SIDE * BYTES_A_CELL), 0)
        self._heights, self._owner = (np.empty((most, SIDE, SIDE), kind) for kind in (np.float32, np.int32))
        self._square, self._block = np.empty(most, np.int32), np.empty(most, np.int32)
        self._count, self._merged = 0, 0
        self._last: CutField | None = None
        self._stirred: list[Box] = []
        self._bounds = np.zeros(self._squares + 1, np.int64)
        self._slots, self._blocks_of_slots = (np.zeros(0, np.int32) for _ in range(2))

    @property
    def bytes(self) -> int:
        """What the copies take."""
        return self._count * SIDE * SIDE * BYTES_A_CELL

    def begin(self, field: CutField) -> None:
        """Compare with this field first."""
        self._last = CutField(field.heights.copy(), field.owner.copy())

    def stir(self, box: Box | None) -> None:
        """Something may have changed in a box."""
        if box is not None:
            self._stirred.append(box)

    def take(self, field: CutField, block: int) -> None:
        """Keep what has changed, if the block is the last one of those that have become one."""
        from .history_kernels import keep

        if (block + 1) % (1 << self._merged) and block + 1 < self._blocks:
            return
        if not self._stirred:
            return
        assert self._last is not None
        found = _changed(field, self._last, _round([(r, c, end - r, stop - c) for r, c, end, stop in self._stirred]))
        self._stirred = []
        while self._count + len(found) > len(self._square) and (self._forget(found, block) or self._merge()):
            pass
        if self._count + len(found) > len(self._square):
            self._count = 0  # not even one state fits: every state is cut from the start
            self._square = self._square[:0]
            return
        mine = slice(self._count, self._count + len(found))
        keep(field.heights, field.owner, found, self._heights, self._owner, self._count)
        self._square[mine], self._block[mine] = found, block >> self._merged
        self._count = mine.stop

    def close(self, ends: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the ends of the blocks that are left of those that there were; nothing is taken any more."""
        self._last = None
        square, block = self._square[: self._count], self._block[: self._count]
        self._slots = np.lexsort((block, square)).astype(np.int32)
        self._blocks_of_slots = block[self._slots]
        self._bounds = np.searchsorted(square[self._slots], np.arange(self._squares + 1)).astype(np.int64)
        if not len(self._square):
            return ends[:0]
        step = 1 << self._merged
        return ends[np.minimum(np.arange(step - 1, len(ends) + step - 1, step), len(ends) - 1)]

    def restore(self, field: CutField, base: CutField, block: int) -> None:
        """See `History.restore`."""
        from .history_kernels import restore

        restore(
            block,
            self._blocks_of_slots,
            self._slots,
            self._bounds,
            self._heights,
            self._owner,
            base.heights,
            base.owner,
            field.heights,
            field.owner,
        )

    def _forget(self, squares: Ints, block: int) -> bool:
        """Give up the copies that newer ones from behind the same block will replace; return whether there were any."""
        old = (self._block[: self._count] == block >> self._merged) & np.isin(self._square[: self._count], squares)
        self._keep(np.flatnonzero(~old))
        return bool(old.any())

    def _merge(self) -> bool:
        """Make one block of each two, keeping the later copy of each square; return whether that can give room."""
        square, block = self._square[: self._count], self._block[: self._count]
        if not len(block) or int(block[-1]) == 0:
            return False
        self._merged += 1
        block >>= 1
        key = block.astype(np.int64) * self._squares + square
        self._keep(np.sort(len(key) - 1 - np.unique(key[::-1], return_index=True)[1]))
        return True

    def _keep(self, slots: NDArray[np.int64]) -> None:
        """Give up all copies but those in some slots, which rise."""
        from .history_kernels import close_ranks

        close_ranks(slots, self._heights, self._owner)
        self._square[: len(slots)], self._block[: len(slots)] = self._square[slots], self._block[slots]
        self._count = len(slots)


class Playhead:
    """A place on the way, and the metal there.

    Attributes:
        history: of which. motion: how many motions are done. field: the metal then; it is overwritten when the playhead
            moves.
    """

    def __init__(self, history: History) -> None:
        self.history, self.motion = history, 0
        self.field = CutField(history.base.heights.copy(), history.base.owner.copy())

    def move_to(self, motion: int, progress: Progress = NO_PROGRESS) -> None:
        """Go to the place where a number of motions is done.

        Raises:
            Cancelled: the job was asked to stop; the playhead is at the start then.
        """
        motion = min(max(motion, 0), self.history.motions)
        block, done = self.history.behind(motion)
        if not done <= self.motion <= motion:
            self.history.restore(self.field, block)
            self.motion = done
        here, self.motion = self.motion, -1
        self.history.advance(self.field, here, motion, progress)
        self.motion = motion


def _costs(sweeps: Sweeps) -> Floats:
    """Return (n,) about how many mm² each motion is evaluated on."""
    radius = sweeps.shapes[sweeps.cutter, 0]
    return np.where(sweeps.does == 1, radius * (2 * lengths(sweeps.motions) + math.pi * radius), 0.0) + 1e-9


def _block_ends(costs: Floats, blocks: int) -> NDArray[np.int64]:
    """Return where blocks of about equal costs end."""
    total = np.cumsum(costs)
    if not len(total):
        return np.zeros(0, np.int64)
    wanted = np.linspace(0.0, float(total[-1]), blocks + 1)[1:-1]
    return np.unique(np.append(np.searchsorted(total, wanted, "left") + 1, len(costs))).clip(1, len(costs))


def _round(tiles: list[Box]) -> Box:
    """Return first row and column, and the ends of rows and columns, round tiles given by first row and column, rows
    and columns.
    """
    all_of = np.array(tiles)
    ends = all_of[:, :2] + all_of[:, 2:]
    return int(all_of[:, 0].min()), int(all_of[:, 1].min()), int(ends[:, 0].max()), int(ends[:, 1].max())


def _changed(field: CutField, before: CutField, box: Box) -> Ints:
    """Return the squares in which two fields differ; the older one becomes like the newer one."""
    from .history_kernels import changed

    rows, cols = field.heights.shape
    squares = np.empty(math.ceil(rows / SIDE) * math.ceil(cols / SIDE), np.int32)
    count = changed(field.heights, field.owner, before.heights, before.owner, box, SIDE, squares)
    return squares[:count]


def changed_box(field: CutField, before: CutField) -> Box | None:
    """Return first row and column, and the ends of rows and columns, round all squares in which two fields differ;
    None: they are alike.

    Args:
        field: the newer one. before: the older one; it becomes like the newer one.
    """
    rows, cols = field.heights.shape
    found = _changed(field, before, (0, 0, rows, cols))
    if not len(found):
        return None
    row, col = np.divmod(found, math.ceil(cols / SIDE))
    ends = (int(row.max()) + 1) * SIDE, (int(col.max()) + 1) * SIDE
    return int(row.min()) * SIDE, int(col.min()) * SIDE, min(ends[0], rows), min(ends[1], cols)
