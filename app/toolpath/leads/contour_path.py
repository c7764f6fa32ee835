"""A path of the cutter's centre along walls or lines, measured by how far along it something is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.pool import in_bands
from ...geometry.distance import DistanceField
from ...geometry.outlines import Outlines
from ...geometry.primitives import CX, CY, TURN, X0, Y0, Indices, Rows, lengths, points_at, sweeps
from . import contour_path_kernels as path_kernels

Floats = NDArray[np.float64]

_SNAP = 1e-6
"""mm; a break this near to the end of a row is the end of the row."""

_WORTH_TWO_CORES = 100
"""Rows from which a second core is worth its start: along a wall there are thousands of steps to one."""

_STEP = 1e-3
"""mm; the shortest step of the proof that a move keeps clear: between such places clearance cannot fall by more than
1e-6 mm unseen.
"""

_MISS = 1e-6
"""mm by which a computed clearance may fall short."""


@dataclass(frozen=True, eq=False)
class ContourPath:
    """A path in the direction of travel.

    Attributes:
        rows: (n, 8) lines and arcs, each beginning where the one before ends.
        closed: True when it ends where it begins.
        region: number of its region, 0 = none.
        rank: how many other contours lie round it; what lies inside is cut first.
        area: that it encloses, or the ring that it was cut out of, mm2; negative when the area to machine lies round
            it; 0 of open lines.
        loop: number of the drawn loop that it follows or was cut out of; 0 of rings and open lines.
    """

    rows: Rows
    closed: bool
    region: int = 0
    rank: int = 0
    area: float = 0.0
    loop: int = 0

    @cached_property
    def alone(self) -> ContourPaths:
        """The path as the only one of many."""
        return ContourPaths.of([self])

    @property
    def sizes(self) -> Floats:
        """(n,) length of each row, mm."""
        return self.alone.outlines.sizes

    @property
    def ends(self) -> Floats:
        """(n,) how far along each row ends, mm."""
        return self.alone.ends

    @property
    def ring(self) -> tuple[int, float, int]:
        """What all pieces of one ring or loop have alike."""
        return self.region, self.area, self.loop

    @property
    def length(self) -> float:
        """Of the whole path, mm."""
        return float(self.ends[-1])

    @cached_property
    def _field(self) -> DistanceField:
        return DistanceField.of(self.rows)

    def rows_at(self, where: Floats) -> tuple[Indices, Floats]:
        """Return (row, fraction of it) at places (m,) along the path, mm; closed ones go on past their end."""
        return self.alone.rows_at(np.zeros(len(where), np.int64), where)

    def points(self, where: Floats) -> Floats:
        """Return the points (m, 2) at places along the path."""
        return self.alone.points(np.zeros(len(where), np.int64), where)

    def headings(self, where: Floats) -> Floats:
        """Return the directions of travel (m, 2), of length 1, at places along the path."""
        return self.alone.headings(np.zeros(len(where), np.int64), where)

    def nearest(self, points: Floats) -> tuple[Floats, Floats]:
        """Return (how far along (m,), distance (m,)) of what of the path is nearest to points (m, 2), mm."""
        distance, row = self._field.nearest(points)
        size = self.sizes[row]
        return self.ends[row] - size * (1 - fractions_at(self.rows[row], points)), distance

    def span(self, start: float, stop: float, breaks: Floats) -> tuple[Rows, Floats]:
        """Return (rows, how far along the middle of each is) from one place to another, cut at some breaks as well.

        Args:
            start, stop: mm, start < stop; a closed path goes on past its end.
            breaks: (k,) mm, in [0, length].
        """
        found, middle = self.alone.spans(np.array([start]), np.array([stop]), [breaks])
        return found.rows, middle


@dataclass(frozen=True, eq=False)
class ContourPaths:
    """Many paths, measured all at once.

    Attributes:
        outlines: their rows, one path after the other.
        closed: (m,) which of them end where they begin.
    """

    outlines: Outlines
    closed: NDArray[np.bool_]

    @staticmethod
    def of(paths: Sequence[ContourPath]) -> ContourPaths:
        """Return some paths as one."""
        return ContourPaths(
            Outlines.joined([path.rows for path in paths]), np.array([path.closed for path in paths], np.bool_)
        )

    @cached_property
    def ends(self) -> Floats:
        """(n,) how far along its path each row ends, mm."""
        total = np.empty(len(self.outlines.rows))
        path_kernels.running_sums(self.outlines.sizes, self.outlines.first, total)
        return total

    @cached_property
    def lengths(self) -> Floats:
        """(m,) length of each path, mm."""
        total: Floats = self.ends[self.outlines.first[1:] - 1]
        return total

    def rows_at(self, path: Indices, where: Floats) -> tuple[Indices, Floats]:
        """Return (row, fraction of it) at places (k,) along paths (k,), mm; closed ones go on past their end."""
        length, round_it = self.lengths[path], self.closed[path] & (self.lengths[path] > 0)
        along = np.where(round_it, where % np.where(round_it, length, 1.0), np.clip(where, 0.0, length))
        row = np.empty(len(where), np.int64)
        first = self.outlines.first
        path_kernels.counts_below(self.ends, first, np.ascontiguousarray(path), along, True, row)
        row = np.minimum(first[path] + row, first[path + 1] - 1)
        size = self.outlines.sizes[row]
        fraction = (along - (self.ends[row] - size)) / np.maximum(size, 1e-300)
        return row, np.clip(fraction, 0.0, 1.0)

    def points(self, path: Indices, where: Floats) -> Floats:
        """Return the points (k, 2) at places (k,) along paths (k,)."""
        row, fraction = self.rows_at(path, where)
        return points_at(self.outlines.rows[row], fraction)

    def headings(self, path: Indices, where: Floats) -> Floats:
        """Return the directions of travel (k, 2), of length 1, at places (k,) along paths (k,)."""
        row, fraction = self.rows_at(path, where)
        return headings_at(self.outlines.rows[row], fraction)

    def spans(self, start: Floats, stop: Floats, breaks: Sequence[Floats]) -> tuple[Outlines, Floats]:
        """Return each path's rows from one place to another, cut at some breaks as well, and how far along the middle
        of each is (n,).

        Args:
            start, stop: (m,) mm, start < stop; a closed path goes on past its end.
            breaks: of each path (k,) mm, in [0, length].
        """
        path, bounds = self._bounds(start, stop, breaks)
        whole = path[1:] == path[:-1]  # a piece between two bounds of one path
        path, first, last = path[:-1][whole], bounds[:-1][whole], bounds[1:][whole]
        middle = (last + first) / 2
        row, _ = self.rows_at(path, middle)
        size, rows, length = self.outlines.sizes[row], self.outlines.rows[row], self.lengths[path]
        lap = np.where(self.closed[path], middle - middle % np.where(length > 0, length, 1.0), 0.0)
        begin = lap + self.ends[row] - size
        first, last = ((each - begin) / np.maximum(size, 1e-300) for each in (first, last))
        pieces = rows.copy()
        pieces[:, :2] = points_at(rows, np.where(first * size < _SNAP, 0.0, np.clip(first, 0.0, 1.0)))
        ends = np.append(np.flatnonzero(np.diff(path)), len(path) - 1)
        begins = np.append(0, ends[:-1] + 1)
        inner = np.setdiff1d(np.arange(len(path)), ends)
        pieces[inner, 2:4] = pieces[inner + 1, :2]
        round_it = self.closed & (np.abs(stop - start - self.lengths) < _SNAP)
        pieces[ends[round_it], 2:4] = pieces[begins[round_it], :2]
        cut = ends[~round_it & ((1 - last[ends]) * size[ends] >= _SNAP)]
        pieces[cut, 2:4] = points_at(rows[cut], last[cut])
        return Outlines(pieces, np.append(0, ends + 1)), middle

    def _bounds(self, start: Floats, stop: Floats, breaks: Sequence[Floats]) -> tuple[Indices, Floats]:
        """Return (path, place along it, mm), in order, of all beginnings, stops, ends of rows and breaks between."""
        own = [
            some[np.abs(self.ends[a:b, None] - some).min(axis=0) > _SNAP] if len(some) else some
            for some, a, b in zip(
                breaks, self.outlines.first[:-1].tolist(), self.outlines.first[1:].tolist(), strict=True
            )
        ]
        number = np.arange(len(self.outlines))
        of = np.concatenate([self.outlines.owner, np.repeat(number, [len(some) for some in own])])
        place = np.concatenate([self.ends, *own])
        length = np.where(self.closed & (self.lengths > 0), self.lengths, 1.0)
        low = np.where(self.closed, np.floor(start / length), 0.0)
        laps = np.where(self.closed, np.ceil(stop / length) - low, 1.0).astype(np.int64)
        counts = laps[of]
        lap = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        of, place = np.repeat(of, counts), np.repeat(place, counts)
        place = np.where(self.closed[of], (low[of] + lap) * length[of], 0.0) + place
        between = (place > start[of] + _SNAP) & (place < stop[of] - _SNAP)
        of, place = np.concatenate([number, of[between], number]), np.concatenate([start, place[between], stop])
        order = np.lexsort((place, of))
        of, place = of[order], place[order]
        once = np.append(True, (of[1:] != of[:-1]) | (place[1:] != place[:-1]))
        return of[once], place[once]


def headings_at(rows: Rows, fraction: Floats) -> Floats:
    """Return the directions of travel (n, 2), of length 1, at a fraction in [0, 1] of each row."""
    straight = rows[:, 2:4] - rows[:, :2]
    angle = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX]) + sweeps(rows) * fraction
    bent = rows[:, [TURN]] * np.stack([-np.sin(angle), np.cos(angle)], 1)
    ahead = np.where(rows[:, [TURN]] == 0, straight, bent)
    unit: Floats = ahead / np.maximum(np.hypot(ahead[:, 0], ahead[:, 1]), 1e-300)[:, None]
    return unit


def fractions_at(rows: Rows, points: Floats) -> Floats:
    """Return the fraction in [0, 1] of each row's length (n,) that is nearest to each point (n, 2)."""
    along = rows[:, 2:4] - rows[:, :2]
    line = ((points - rows[:, :2]) * along).sum(axis=1) / np.maximum((along * along).sum(axis=1), 1e-300)
    start = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX])
    sweep = np.maximum(np.abs(sweeps(rows)), 1e-300)
    turn = (np.arctan2(points[:, 1] - rows[:, CY], points[:, 0] - rows[:, CX]) - start) * rows[:, TURN] % (2 * np.pi)
    arc = np.where(turn <= sweep, turn / sweep, np.where(turn - sweep < 2 * np.pi - turn, 1.0, 0.0))
    return np.clip(np.where(rows[:, TURN] == 0, line, arc), 0.0, 1.0)


def left_of(headings: Floats) -> Floats:
    """Return directions (n, 2) turned left by a right angle."""
    return np.stack([-headings[:, 1], headings[:, 0]], 1)


def line_row(a: Floats, b: Floats) -> Rows:
    """Return the row (8,) of a straight line."""
    return np.array([a[0], a[1], b[0], b[1], 0.0, 0.0, 0.0, 0.0])


def keep_clear(field: DistanceField, rows: Rows, need: Floats) -> NDArray[np.bool_]:
    """Tell for each row (n, 8) whether all of it is at least `need` (n,) mm from everything.

    Distance changes by no more than the way gone, so each step of what is to spare passes nothing unseen. Where nothing
    is to spare, as beside the wall that a path follows, steps are 1 um.
    """
    good = np.empty(len(rows), np.bool_)
    rows, need = np.ascontiguousarray(rows), np.ascontiguousarray(need, np.float64)
    size = lengths(rows)

    def look(band: slice) -> None:
        path_kernels.keep_clear(
            field.rows, field.order, field.nodes, rows[band], size[band], need[band], _STEP, _MISS, good[band]
        )

    in_bands(look, len(rows), _WORTH_TWO_CORES)
    return good
