"""The pieces of rings that clear what is left: rings in short rows, and as few and as short runs of these as do."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.pool import in_bands
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel
from ...geometry.primitives import X1, Y1, Indices, Rows, lengths, points_at, reversed_rows
from .. import rest_kernels
from ..rest_material import CentreReach

_LONGEST = 6.0
"""Radii; runs are chosen in pieces of this length, and those side by side joined again."""

_TO_GET_THERE = 6.0
"""Radii of way that a run costs besides its own."""

_AS_NEAR = 2e-3
"""mm; rows no farther from a cell than this and the nearest one clear it as well: both sides of a ring there and back
do.
"""

_MOST_BUCKETS = 1_000_000
"""Squares that cells are sorted into, at most, so that far-off cells need no memory between them."""

_SEEN_BYTES = 4
"""What it takes to remember that a row clears a cell."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RingChunks:
    """Rings, cut into short rows.

    Attributes:
        rows: (n, 8), ring by ring, each beginning where the one before ends.
        source: (n,) number of the row that each is a piece of.
        size: (n,) length of each, mm.
        first: (m + 1,) number of the first row of each ring.
        level: (m,) number of its level. region: (m,) number of its region.
    """

    rows: Rows
    source: Indices
    size: Floats
    first: Indices
    level: Indices
    region: Indices

    @staticmethod
    def of(levels: Sequence[OffsetLevel], longest: float) -> RingChunks:
        """Return the rings of levels in rows no longer than `longest`, mm."""
        rings = [ring for level in levels for ring in level.rings]
        rows = np.concatenate([np.zeros((0, 8)), *(ring.rows for ring in rings)])
        count = np.maximum(1, np.ceil(lengths(rows) / longest)).astype(np.int64)
        source = np.repeat(np.arange(len(rows)), count)
        before = np.cumsum(count) - count
        part = np.arange(len(source)) - np.repeat(before, count)
        cut = rows[source]
        cut[:, :2] = points_at(cut, part / count[source])
        last = part + 1 == count[source]
        cut[:-1, 2:4] = np.where(last[:-1, None], cut[:-1, 2:4], cut[1:, :2])
        starts = np.concatenate([[0], np.cumsum([len(ring.rows) for ring in rings])]).astype(np.int64)
        first = np.append(before, len(source))[starts]
        level = np.repeat(np.arange(len(levels)), [len(level.rings) for level in levels])
        region = np.array([ring.region for ring in rings], np.int64)
        return RingChunks(np.ascontiguousarray(cut), source, lengths(cut), first, level, region)

    @property
    def ring(self) -> Indices:
        """(n,) number of the ring of each row."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))

    def after(self, chunk: int, count: int) -> int:
        """Return the row that comes so many after another one, round and round its ring."""
        ring = int(np.searchsorted(self.first, chunk, "right")) - 1
        low, high = int(self.first[ring]), int(self.first[ring + 1])
        return low + (chunk - low + count) % (high - low)

    def path(self, chunk: int, count: int, backwards: bool = False) -> Rows:
        """Return the way (k, 8) along so many rows from one on; pieces of one row are one again."""
        ring = int(np.searchsorted(self.first, chunk, "right")) - 1
        low, high = int(self.first[ring]), int(self.first[ring + 1])
        index = low + (chunk - low + np.arange(count)) % (high - low)
        new = np.concatenate([[True], (np.diff(self.source[index]) != 0) | (np.diff(index) != 1)])
        rows = self.rows[index[new]]
        rows[:, [X1, Y1]] = self.rows[index[np.concatenate([new[1:], [True]])]][:, [X1, Y1]]
        return reversed_rows(rows) if backwards else rows


@dataclass(frozen=True)
class RingRun:
    """A piece of a ring to be cut: so many short rows from one on.

    Attributes:
        sense: +1 it is cut in the ring's own direction, -1 the other way, 0 either way.
    """

    chunk: int
    count: int
    sense: int = 0


@dataclass(frozen=True, eq=False)
class RestCells:
    """Cells in which metal is left.

    Attributes:
        centres: (n, 2) mm.
        need: (n,) how near a run must come to the centre of each, mm.
    """

    centres: Floats
    need: Floats

    @staticmethod
    def of(centres: Floats, cutting: Rows, within: float) -> RestCells:
        """Return cells that are cleared by runs within a distance, mm, or by the row nearest to them if none is as
        near.

        Args:
            cutting: (n, 8) all rows that there are to choose from, n > 0.
        """
        nearest = DistanceField.of(cutting).nearest(centres, enough=within - 2 * _AS_NEAR)[0]
        return RestCells(centres, np.maximum(within, nearest + _AS_NEAR))


def runs(chunks: RingChunks, cutting: NDArray[np.bool_], cells: RestCells, reach: CentreReach) -> list[RingRun]:
    """Return runs that clear all cells, each time the one that clears most for its length.

    Args:
        cutting: (n,) which rows cut anything.
    """
    kept, buckets = np.flatnonzero(cutting), _Buckets.of(cells, reach.radius)
    counts = np.zeros(len(cutting), np.int64)
    counts[kept] = buckets.counts(chunks.rows[kept])
    order, group = _in_order(chunks, kept[counts[kept] > 0])
    if not len(order):
        return []
    size = chunks.size[order]
    spans = _spans(group, size, _LONGEST * reach.radius)
    chosen = np.empty((len(spans), 2), np.int64)
    first = np.concatenate([[0], np.cumsum(counts[order])])
    reach.ask_memory(_SEEN_BYTES * float(first[-1]))
    seen = buckets.seen(chunks.rows[order], first)
    count = rest_kernels.choose(size, spans, _TO_GET_THERE * reach.radius, first, seen, len(cells.centres), chosen)
    return _joined(chosen[:count], order, group)


def all_runs(chunks: RingChunks, cutting: NDArray[np.bool_], cells: RestCells, reach: CentreReach) -> list[RingRun]:
    """Return all pieces of rings that cut anything within the cutter's radius of some cell."""
    kept = np.flatnonzero(cutting)
    buckets = _Buckets.of(
        RestCells(cells.centres, np.full(len(cells.centres), reach.radius + reach.corner)), reach.radius
    )
    order, group = _in_order(chunks, kept[buckets.counts(chunks.rows[kept]) > 0])
    edges = (
        np.flatnonzero(np.concatenate([[True], np.diff(group) != 0, [True]])) if len(order) else np.zeros(1, np.int64)
    )
    return [RingRun(int(order[a]), b - a) for a, b in pairwise(edges.tolist())]


def _in_order(chunks: RingChunks, kept: Indices) -> tuple[Indices, Indices]:
    """Return (rows, number of the group of each): groups of rows that follow one another round a ring, in their
    order.
    """
    if not len(kept):
        return kept, kept
    ring = chunks.ring[kept]
    changes = np.flatnonzero(np.diff(ring)) + 1
    begins, stops = np.concatenate([[0], changes]), np.concatenate([changes, [len(kept)]])
    new = np.concatenate([[True], (np.diff(kept) != 1) | (np.diff(ring) != 0)])
    order, group = kept.copy(), np.cumsum(new)
    whole = (kept[begins] == chunks.first[ring[begins]]) & (kept[stops - 1] == chunks.first[ring[begins] + 1] - 1)
    broken = group[begins] != group[stops - 1]
    for a, b in zip(begins[whole & broken].tolist(), stops[whole & broken].tolist(), strict=True):
        # the last group of such a ring goes on into its first one
        turn = int(np.count_nonzero(group[a:b] == group[b - 1]))
        group[b - turn : b] = group[a]
        order[a:b], group[a:b] = np.roll(order[a:b], turn), np.roll(group[a:b], turn)
    return order, group


def _spans(group: Indices, size: Floats, longest: float) -> Indices:
    """Return (n, 2) first and last + 1 of equal pieces of groups, none much longer than `longest`, mm."""
    edges = np.flatnonzero(np.concatenate([[True], np.diff(group) != 0, [True]]))
    first, count = edges[:-1], np.diff(edges)
    pieces = np.minimum(count, np.maximum(1, np.ceil(np.add.reduceat(size, first) / longest))).astype(np.int64)
    of = np.repeat(np.arange(len(pieces)), pieces)
    number = np.arange(len(of)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    low, high = (np.round(k * (count / pieces)[of]).astype(np.int64) for k in (number, number + 1))
    return np.ascontiguousarray(
        first[of, None] + np.stack([low, np.where(number + 1 == pieces[of], count[of], high)], 1)
    )


def _joined(chosen: Indices, order: Indices, group: Indices) -> list[RingRun]:
    """Return chosen pieces as runs; those side by side are one."""
    runs: list[RingRun] = []
    last = -1
    for a, b in sorted(map(tuple, chosen.tolist())):
        if runs and a == last and group[a] == group[a - 1]:
            runs[-1] = RingRun(runs[-1].chunk, runs[-1].count + b - a)
        else:
            runs.append(RingRun(int(order[a]), b - a))
        last = b
    return runs


@dataclass(frozen=True, eq=False)
class _Buckets:
    """Cells sorted into squares, for kernels.

    Attributes:
        arrays: centres (n, 2) and needs (n,) of the cells, mm, by square; (rows, columns + 1) where each square begins;
            and corner, side, mm, and the largest need of all.
    """

    arrays: tuple[Floats, Floats, Indices, Floats]

    @staticmethod
    def of(cells: RestCells, radius: float) -> _Buckets:
        centres = cells.centres
        x0, y0 = centres.min(axis=0)
        wide, high = (np.ptp(centres, axis=0) + radius).tolist()
        side = max(radius / 4, math.sqrt(wide * high / _MOST_BUCKETS))
        column, row = ((centres - [x0, y0]) / side).astype(np.int64).T
        wide, high = int(column.max()) + 1, int(row.max()) + 1
        order = np.argsort(row * wide + column, kind="stable")
        counts = np.bincount(row * wide + column, minlength=wide * high)
        before = np.concatenate([[0], np.cumsum(counts)])
        starts = np.empty((high, wide + 1), np.int64)
        starts[:, :wide] = before[:-1].reshape(high, wide)
        starts[:, wide] = before[wide::wide]
        grid = np.array([x0, y0, side, float(cells.need.max())])
        return _Buckets((np.ascontiguousarray(centres[order]), np.ascontiguousarray(cells.need[order]), starts, grid))

    def counts(self, rows: Rows) -> Indices:
        """Return how many cells each row (n, 8) clears."""
        rows, counts = np.ascontiguousarray(rows), np.empty(len(rows), np.int64)

        def look(band: slice) -> None:
            rest_kernels.count_seen(rows[band], *self.arrays, counts[band])

        in_bands(look, len(rows))
        return counts

    def seen(self, rows: Rows, first: Indices) -> NDArray[np.int32]:
        """Return the cells that rows (n, 8) clear, those of each behind the ones before: row k's from first[k] on."""
        rows, seen = np.ascontiguousarray(rows), np.empty(int(first[-1]), np.int32)

        def look(band: slice) -> None:
            rest_kernels.list_seen(rows[band], *self.arrays, first[band], seen)

        in_bands(look, len(rows))
        return seen
