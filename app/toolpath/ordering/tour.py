"""In which order strokes are cut, so that the tool travels little between them.

Greedy at first: always on to the stroke that begins nearest. Then 2-opt (a run of strokes the other way round) and
Or-opt (up to three strokes elsewhere) among strokes near one another, and in the end kicks: two runs somewhere are
swapped, the tour settles again, and what is no better is taken back. The work is counted, not timed, so that the same
strokes always give the same order. Few strokes are put into the shortest order of all.

References:
    Lin, Kernighan: 2-opt; Or: moving runs of up to three; Bentley: neighbour lists and queues; Held, Karp: few strokes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.near_points import nearest
from ...geometry.primitives import Indices, reversed_rows
from ...model.curves import Point
from ..build import Stroke

_FEW = 9
"""Strokes whose shortest order is found by trying all."""

_NEAR = 8
"""Strokes that begin near the end of one, and as many that end near its beginning."""

_LOG = 512
"""Turns that can be taken back after a kick that was no good."""

_PORTION = 1_000_000
"""Work between two looks at whether to stop; about 30 ms."""

_GREEDILY, _IN_BUCKET = 4_000, 2.0
"""Strokes that are put in greedy order before those in it are taken out of the buckets, and how many begin in one."""

_BASE, _EACH, _MOST = 2_000_000, 12_000, 45_000_000
"""Work that a tour is worth: so much, so much more a stroke, and at most (about 1.5 s)."""

_WAITING, _WORK = 2, 4
"""Places in the state of a tour, see `tour_kernels`."""


def in_short_order(
    strokes: Sequence[Stroke],
    start: Point = (0.0, 0.0),
    progress: Progress = NO_PROGRESS,
    *,
    before: Sequence[tuple[int, int]] = (),
    reversible: bool = False,
) -> tuple[Stroke, ...]:
    """Return the strokes in an order of short travel from the end of each to the beginning of the next.

    It is never longer than the greedy order, and the shortest of all for up to nine strokes. The way back is not
    counted.

    Args:
        strokes: each is cut without a lift, from its beginning to its end.
        start: where the tool is before the first one, mm.
        progress: looked at many times a second.
        before: pairs (a, b) of indices into `strokes`: a is cut before b.
        reversible: open strokes may be cut from their end to their beginning; closed ones keep their direction.

    Raises:
        ParameterError: `before` names a stroke that is not there, or goes round in a circle.
        Cancelled: by progress.
    """
    if not strokes:
        return ()
    tour = _Tour(strokes, start, before, reversible)
    tour.begin_greedily(progress.part(0.0, 0.2))
    greedy, length = tour.order.copy(), tour.travel
    if len(strokes) <= _FEW:
        tour.shorten_few()
    else:
        tour.shorten(progress.part(0.2, 1.0))
    progress.step(1.0)
    if tour.travel >= length:
        return tuple(strokes[k - 1] for k in greedy[1:])
    return tuple(_other_way(strokes[k - 1]) if tour.turned[k] else strokes[k - 1] for k in tour.order[1:])


def _other_way(stroke: Stroke) -> Stroke:
    """Return an open stroke cut from its end; a closed one as it is."""
    if stroke.closed:
        return stroke
    least_z = None if stroke.least_z is None else stroke.least_z[::-1].copy()
    return replace(stroke, rows=reversed_rows(stroke.rows), purpose=stroke.purpose[::-1].copy(), least_z=least_z)


class _Tour:
    """An order of strokes 1 … n behind the start, stroke 0, as the kernels want it."""

    def __init__(
        self, strokes: Sequence[Stroke], start: Point, before: Sequence[tuple[int, int]], mirrored: bool
    ) -> None:
        places = [(*start, *start), *((*stroke.rows[0, :2], *stroke.rows[-1, 2:4]) for stroke in strokes)]
        self._count = len(places)
        self._ends = np.array(places, np.float64).reshape(-1, 4)
        self.order = np.full(self._count, -1, np.int64)
        self.order[0] = 0
        self.turned = np.zeros(self._count, np.bool_)
        self._mirrored = mirrored
        self._pairs = np.unique(np.array(before, np.int64).reshape(-1, 2) + 1, axis=0)
        if len(self._pairs) and not 1 <= self._pairs.min() <= self._pairs.max() < self._count:
            raise ParameterError(
                f"A stroke that must be cut before another is none of the strokes 0 to {self._count - 2}."
            )
        self._rules = (*_lists(self._pairs, self._count), *_lists(self._pairs[:, ::-1], self._count))

    @property
    def travel(self) -> float:
        """The whole of it, mm."""
        from ..ordering import tour_kernels

        return float(tour_kernels.travel(self._ends, self.order))

    def begin_greedily(self, progress: Progress) -> None:
        """Always go on to the stroke that begins nearest of those that may be cut."""
        from ..ordering import tour_kernels

        waiting = np.bincount(self._pairs[:, 1], minlength=self._count).astype(np.int64)
        waiting[0] = -1
        for first in range(1, self._count, _GREEDILY):
            progress.step(first / self._count, "Order of strokes")
            buckets = _buckets(self._ends[:, :2], np.flatnonzero(waiting >= 0))
            last = min(first + _GREEDILY, self._count)
            tour_kernels.greedy(self._ends, self._rules, buckets, waiting, self.order, first, last)
        if self.order.min() < 0:
            raise ParameterError("Strokes that must be cut before one another go round in a circle.")

    def shorten_few(self) -> None:
        """Find the shortest order."""
        from ..ordering import tour_kernels

        needed = np.zeros(self._count, np.int64)
        np.bitwise_or.at(needed, self._pairs[:, 1], 1 << (self._pairs[:, 0] - 1))
        tour_kernels.shortest(self._ends, needed, self._mirrored, self.order, self.turned)
        self._ends[self.turned] = self._ends[self.turned][:, [2, 3, 0, 1]]

    def shorten(self, progress: Progress) -> None:
        """Settle, and then kick."""
        from ..ordering import tour_kernels

        place = np.empty(self._count, np.int64)
        place[self.order] = np.arange(self._count)
        queue = np.concatenate([self.order, np.ones(self._count, np.int64)])
        state = np.array([1, 0, self._count, 0, 0, self._mirrored], np.int64)
        tour = (
            self._ends,
            self.order,
            place,
            self.turned,
            self._near(),
            self._rules,
            queue,
            np.empty((_LOG, 2), np.int64),
            state,
        )
        work = min(_BASE + _EACH * self._count, _MOST)
        while state[_WAITING]:
            progress.step(min(state[_WORK] / work, 1.0), "Order of strokes")
            tour_kernels.settle(tour, state[_WORK] + _PORTION)
        while state[_WORK] < work:
            progress.step(state[_WORK] / work, "Order of strokes")
            tour_kernels.kick(tour, min(state[_WORK] + _PORTION, work))

    def _near(self) -> Indices:
        """Return (n + 1, m) strokes near each one, -1 where there are fewer: it can go on to these, or come from
        them.
        """
        begins, ends = self._ends[:, :2], self._ends[:, 2:]
        ways = [(ends, begins), (begins, ends)] + ([(ends, ends), (begins, begins)] if self._mirrored else [])
        count = min(_NEAR + 1, self._count)
        found = np.hstack([nearest(there, here, count)[1] for here, there in ways])
        found[found == np.arange(self._count)[:, None]] = -1
        found = -np.sort(-found, axis=1)
        found[:, 1:][found[:, 1:] == found[:, :-1]] = -1
        found = -np.sort(-found, axis=1)
        near: Indices = np.ascontiguousarray(found[:, : int((found >= 0).sum(axis=1).max())])
        return near


def _buckets(begins: NDArray[np.float64], strokes: Indices) -> tuple[Indices, Indices, NDArray[np.float64]]:
    """Return strokes by the square that they begin in, as `tour_kernels.greedy` wants them.

    Args:
        begins: (n + 1, 2) where all strokes begin. strokes: numbers of those that are wanted, one or more.
    """
    places = begins[strokes]
    low, (wide, high) = places.min(axis=0), np.ptp(places, axis=0).tolist()
    side = max(math.sqrt(wide * high * _IN_BUCKET / len(strokes)), max(wide, high) * _IN_BUCKET / len(strokes), 1e-6)
    column, row = ((places - low) / side).astype(np.int64).T
    columns, rows = int(column.max()) + 1, int(row.max()) + 1
    order = np.argsort(row * columns + column, kind="stable")
    edges = np.concatenate([[0], np.cumsum(np.bincount(row * columns + column, minlength=rows * columns))])
    starts = edges[np.arange(rows)[:, None] * columns + np.arange(columns + 1)]
    return np.ascontiguousarray(starts, np.int64), np.ascontiguousarray(strokes[order]), np.array([*low, side])


def _lists(pairs: NDArray[np.int64], count: int) -> tuple[Indices, Indices]:
    """Return a list of lists, (count + 1,) where each begins and all of them: the second of the pairs that begin with
    each number.
    """
    sorted_pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    first = np.searchsorted(sorted_pairs[:, 0], np.arange(count + 1))
    return first.astype(np.int64), np.ascontiguousarray(sorted_pairs[:, 1])


# In which order the strokes of an operation are cut.


def in_order(strokes: Sequence[Stroke], start: Point, progress: Progress = NO_PROGRESS) -> list[list[Stroke]]:
    """Return strokes in groups that stay together, those of lower rank first, otherwise with short travel between them.

    Args:
        start: where the tool is before, mm.

    Raises:
        Cancelled: by progress.
    """
    groups: list[list[Stroke]] = []
    for stroke in strokes:
        if not len(stroke.rows):
            continue
        if stroke.follows and groups:
            groups[-1].append(stroke)
        else:
            groups.append([stroke])
    ordered: list[list[Stroke]] = []
    for _, some in groupby(sorted(groups, key=_rank), _rank):
        members = list(some)
        whole = [_as_one(group) for group in members]
        place = {id(one): group for one, group in zip(whole, members, strict=True)}
        ordered.extend(
            place[id(one)] for one in in_short_order(whole, ordered[-1][-1].end if ordered else start, progress)
        )
    return ordered


def _rank(group: list[Stroke]) -> int:
    return group[0].rank


def _as_one(group: list[Stroke]) -> Stroke:
    """Return a stroke that begins where a group does and ends where it does, for the sake of its ends."""
    rows = np.array([[*group[0].start, *group[-1].end, 0.0, 0.0, 0.0, 0.0]])
    return replace(group[0], rows=rows, purpose=group[0].purpose[:1], least_z=None)
