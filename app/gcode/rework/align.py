"""Which motions of two programs are the same ones: an alignment of two long tables of numbers, row by row.

As in a patient comparison of two texts: rows that come once in both are anchors, the longest run of anchors that keeps
the order in both is taken, and what lies between two anchors is looked at again by itself.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress

Floats = NDArray[np.float64]
Whole = NDArray[np.int64]

GRID = 16.0
"""Size of the grid that anchors are looked for on, in tolerances."""
FEW = 4096
"""Pairs of rows that are compared one by one."""
DEEPEST = 40
"""Levels of division, at most."""
FIRST_STEP = 64
"""Rows that are compared at first."""


@dataclass(frozen=True)
class AlignmentTable:
    """Rows to be aligned.

    Attributes:
        numbers: (n, k) what may differ by the tolerance.
        names: (n, m) what must be alike.
    """

    numbers: Floats
    names: Whole

    def __len__(self) -> int:
        return len(self.numbers)

    def keys(self, grid: float, shift: float) -> Whole:
        """Return (n,) keys; rows in the same cells of a grid, and with like names, have the same."""
        cells = np.floor(self.numbers / grid + shift).astype(np.int64)
        key = np.zeros(len(self), np.int64)
        for column in (*cells.T, *self.names.T):
            key = (key ^ column) * np.int64(0x5851F42D4C957F2D)
            key ^= key >> np.int64(29)
        return key


@dataclass(frozen=True, slots=True)
class MatchedRun:
    """`count` rows of a from row `a` on that are the rows of b from row `b` on."""

    a: int
    b: int
    count: int


@dataclass(frozen=True, slots=True)
class _Range:
    """Rows a0 to a1 and b0 to b1, ends excluded, that are still to be aligned; `level` counts how often it was
    parted.
    """

    a0: int
    a1: int
    b0: int
    b1: int
    level: int = 0

    @property
    def empty(self) -> bool:
        return self.a0 >= self.a1 or self.b0 >= self.b1


def align(
    a: AlignmentTable, b: AlignmentTable, tolerance: float, progress: Progress = NO_PROGRESS
) -> tuple[MatchedRun, ...]:
    """Return the rows that are the same in both tables, in order; runs never touch on both sides.

    Args:
        a, b: with like columns.
        tolerance: numbers that differ by no more are the same.
        progress: told of how much is aligned.

    Raises:
        Cancelled: the job was asked to stop.
    """
    return tuple(_joined(sorted(_Aligner(a, b, tolerance).runs(progress), key=lambda run: run.a)))


def _joined(runs: list[MatchedRun]) -> Iterator[MatchedRun]:
    """Yield runs with those that follow each other on both sides made one."""
    current: MatchedRun | None = None
    for run in runs:
        if current is not None and (run.a, run.b) == (current.a + current.count, current.b + current.count):
            current = MatchedRun(current.a, current.b, current.count + run.count)
            continue
        if current is not None:
            yield current
        current = run
    if current is not None:
        yield current


class _Aligner:
    """Two tables, and their keys on two grids: what a border of the one parts lies within a cell of the other."""

    def __init__(self, a: AlignmentTable, b: AlignmentTable, tolerance: float) -> None:
        self._a, self._b, self._tolerance = a, b, tolerance
        grid = GRID * tolerance
        self._keys = [(a.keys(grid, shift), b.keys(grid, shift)) for shift in (0.0, 0.5)]

    def runs(self, progress: Progress) -> Iterator[MatchedRun]:
        """Yield every run, in no order."""
        waiting = [_Range(0, len(self._a), 0, len(self._b))]
        while waiting:
            rows = waiting.pop()
            progress.step(rows.a0 / max(len(self._a), 1), "aligning")
            head = self._along(rows.a0, rows.b0, min(rows.a1 - rows.a0, rows.b1 - rows.b0), 1)
            left = _Range(rows.a0 + head, rows.a1, rows.b0 + head, rows.b1, rows.level)
            tail = self._along(left.a1 - 1, left.b1 - 1, min(left.a1 - left.a0, left.b1 - left.b0), -1)
            left = _Range(left.a0, left.a1 - tail, left.b0, left.b1 - tail, rows.level)
            if head:
                yield MatchedRun(rows.a0, rows.b0, head)
            if tail:
                yield MatchedRun(left.a1, left.b1, tail)
            if not left.empty and left.level < DEEPEST:
                waiting += self._parted(left)

    def _along(self, a: int, b: int, most: int, way: int) -> int:
        """Return how many rows from these on, forwards or backwards, are the same."""
        count, step = 0, FIRST_STEP
        while count < most:
            ahead = np.arange(min(step, most - count))
            same = self._same(a + way * (count + ahead), b + way * (count + ahead))
            if not same.all():
                return count + int(np.argmin(same))
            count += len(ahead)
            step *= 4
        return count

    def _same(self, a: Whole, b: Whole) -> NDArray[np.bool_]:
        """Tell which rows of a are the same as those of b beside them."""
        near = np.all(np.abs(self._a.numbers[a] - self._b.numbers[b]) <= self._tolerance, axis=-1)
        return np.asarray(near & np.all(self._a.names[a] == self._b.names[b], axis=-1))

    def _parted(self, rows: _Range) -> list[_Range]:
        """Return the ranges from one anchor to the next."""
        anchors = self._anchors(rows)
        found, at = [], 0
        last = (rows.a0, rows.b0)
        while at < len(anchors):
            a, b = (int(value) for value in anchors[at])
            found.append(_Range(last[0], a, last[1], b, rows.level + 1))
            count = self._along(a, b, min(rows.a1 - a, rows.b1 - b), 1)
            found.append(_Range(a, a + count, b, b + count, rows.level + 1))
            last = (a + count, b + count)
            at = max(int(np.searchsorted(anchors[:, 0], last[0])), int(np.searchsorted(anchors[:, 1], last[1])))
        found += [_Range(last[0], rows.a1, last[1], rows.b1, rows.level + 1)] if len(anchors) else []
        return [each for each in found if not each.empty]

    def _anchors(self, rows: _Range) -> Whole:
        """Return (k, 2) rows that come once in both, the same in both, in the order of both."""
        if (rows.a1 - rows.a0) * (rows.b1 - rows.b0) <= FEW:
            return self._anchors_of_few(rows)
        for keys_a, keys_b in self._keys:
            pairs = _unique_in_both(keys_a[rows.a0 : rows.a1], keys_b[rows.b0 : rows.b1]) + np.array([rows.a0, rows.b0])
            pairs = pairs[self._same(pairs[:, 0], pairs[:, 1])]
            if len(pairs):
                return np.asarray(pairs[_longest_rise(pairs[:, 1])], np.int64)
        return np.zeros((0, 2), np.int64)

    def _anchors_of_few(self, rows: _Range) -> Whole:
        """Return the anchors of a range in which every row is soon compared with every other."""
        a, b = np.arange(rows.a0, rows.a1), np.arange(rows.b0, rows.b1)
        same = self._same(a[:, None], b)
        once = same & (same.sum(axis=1, keepdims=True) == 1) & (same.sum(axis=0) == 1)
        pairs = np.argwhere(once)
        return pairs[_longest_rise(pairs[:, 1])] + (rows.a0, rows.b0) if len(pairs) else pairs


def _unique_in_both(a: Whole, b: Whole) -> Whole:
    """Return (k, 2) places of keys that come once in a and once in b, in the order of a."""
    keys_a, first_a, count_a = np.unique(a, return_index=True, return_counts=True)
    keys_b, first_b, count_b = np.unique(b, return_index=True, return_counts=True)
    once_a, once_b = count_a == 1, count_b == 1
    _, at_a, at_b = np.intersect1d(keys_a[once_a], keys_b[once_b], assume_unique=True, return_indices=True)
    pairs = np.column_stack([first_a[once_a][at_a], first_b[once_b][at_b]])
    return np.asarray(pairs[np.argsort(pairs[:, 0])], np.int64)


def _longest_rise(values: Whole) -> Whole:
    """Return the places of a longest rising subsequence."""
    ends: list[int] = []
    places: list[int] = []
    before: list[int] = []
    for place, value in enumerate(values.tolist()):
        at = bisect_left(ends, value)
        ends[at : at + 1] = [value]
        places[at : at + 1] = [place]
        before.append(places[at - 1] if at else -1)
    found, place = [], places[-1]
    while place >= 0:
        found.append(place)
        place = before[place]
    return np.array(found[::-1])
