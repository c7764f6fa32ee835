"""What of the walls a cutter's rim does not touch: inner corners, and places that are too narrow for it.

A cutter that follows a ring touches the wall at the foot of each of its places: as far to the right of travel as the
ring is from the walls. What of the walls no foot covers is a gap. Where the ring turns at one place from before a gap
to behind it, and the wall between turns no more than the ring does, the gap is an inner corner; every other one is a
place where the cutter does not fit in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...geometry.distance import DistanceField
from ...geometry.near_points import all_within
from ...geometry.offset.offset import OffsetLevel
from ...geometry.outlines import Outlines
from ...geometry.primitives import TURN, Indices, Rows, lengths, path_length, points_at, sweeps
from ...toolpath.leads.contour_path import Floats, fractions_at, headings_at, left_of
from ...toolpath.machining_areas import MachiningArea

_LEAST = 1e-3
"""mm; shorter gaps are the paths' own error."""

_JUMP = 1e-4
"""mm between the feet before and after a joint that is a corner."""

_SAME = 2e-3
"""mm between a foot and the end of the gap that it stands at."""

_EXCESS = 0.6
"""Radians by which the walls of a corner may turn more than the ring does that touches both: they may be round towards
the cutter.
"""

_BOTTOM = 2.1
"""Radians; walls that turn more than this in more than one place face each other: what lies between is the bottom of a
slot.
"""

_BESIDE = 0.35
"""Radians by which the walls beside a sharp corner may turn."""


@dataclass(frozen=True, eq=False)
class WallGap:
    """A run of wall that the cutter does not touch, in the wall's direction: the area to machine on its left.

    Attributes:
        rows: (m, 8) the wall, cut to the gap.
        walls: indices of these rows among the sheet's.
        region: number of its region.
        bare: True when it begins or ends at a clamp or the frame.
        left: (k,) by how much the wall turns left at each of its joints and in each of its arcs, radians; right turns
            are left out.
        corner: (x, y) where the centre of the cutter turns that touches the wall before and behind it; None where there
            is none.
        excess: by how much more the wall turns left than the ring does there, radians; inf where there is no such
            place.
        turn: of the ring there, radians, in [0, pi].
    """

    rows: Rows
    walls: tuple[int, ...]
    region: int
    bare: bool
    left: Floats
    corner: tuple[float, float] | None = None
    excess: float = np.inf
    turn: float = 0.0

    @property
    def length(self) -> float:
        """Of the wall, mm."""
        return path_length(self.rows)

    @property
    def is_corner(self) -> bool:
        """True of inner corners; elsewhere the cutter does not fit in.

        A corner may be sharp or made by an arc or a chamfer, but not the bottom of a slot, whose walls face each other.
        """
        if self.corner is None or self.bare or self.excess > _EXCESS:
            return False
        return bool(self.left.sum() <= _BOTTOM or self.left.max() >= self.left.sum() - _BESIDE)


def gaps(level: OffsetLevel, area: MachiningArea) -> list[WallGap]:
    """Return all gaps in the walls of regions that a level's rings are in; clamps and the frame are no walls."""
    if not level.rings:
        return []
    known = {ring.region for ring in level.rings}
    spans = _covered(level, area)
    chains = _chains(_uncovered(spans, area, known), area)
    return _with_corners(_made(chains, area), level) if chains else []


def feet(rows: Rows, fraction: float, distance: float) -> Floats:
    """Return where a cutter touches the wall (n, 2) at a fraction of each row of a ring."""
    part = np.full(len(rows), fraction)
    touched: Floats = points_at(rows, part) - distance * left_of(headings_at(rows, part))
    return touched


class _WallSpans(NamedTuple):
    """Parts of rows of walls, sorted by both: the row, and from where to where, in [0, 1] along it."""

    row: Indices
    low: Floats
    high: Floats


class _WallPart(NamedTuple):
    """A part of a row of a wall, from where to where, in [0, 1] along it."""

    row: int
    low: float
    high: float


class _RingJoints(NamedTuple):
    """Joints at the ends of rows: where the cutter touches before and behind, the place, the left turn, radians."""

    before: Floats
    behind: Floats
    place: Floats
    turn: Floats


def _covered(level: OffsetLevel, area: MachiningArea) -> _WallSpans:
    """Return what each row of a level's rings covers of the walls."""
    rings, distance = np.concatenate([ring.rows for ring in level.rings]), level.distance
    region = np.repeat([ring.region for ring in level.rings], [len(ring.rows) for ring in level.rings])
    walls = area.distances.rows
    row = _touched(feet(rings, 0.5, distance), region, area)
    a, b = (fractions_at(walls[row], feet(rings, part, distance)) for part in (0.0, 1.0))
    low, high = np.minimum(a, b), np.maximum(a, b)
    order = np.lexsort((low, row))
    return _WallSpans(row[order], low[order], high[order])


def _touched(points: Floats, region: Indices, area: MachiningArea) -> Indices:
    """Return the wall row (n,) that each point lies on: where walls of two regions lie on each other, that of its own
    region.
    """
    row: Indices = area.distances.nearest(points)[1].copy()
    owner = area.primitives.region
    for each in np.unique(region[owner[row] != region]).tolist():
        own = np.flatnonzero(owner == each)
        requested = np.flatnonzero((region == each) & (owner[row] != each))
        if len(own):
            off, which = DistanceField.of(area.distances.rows[own]).nearest(points[requested])[:2]
            row[requested[off < _SAME]] = own[which[off < _SAME]]
    return row


def _uncovered(spans: _WallSpans, area: MachiningArea, known: set[int]) -> dict[int, list[tuple[float, float]]]:
    """Return for each row of the walls of some regions the parts of it that no span covers."""
    row, low, high = spans
    size = lengths(area.distances.rows)
    bounds = np.searchsorted(row, np.arange(len(size) + 1))
    found: dict[int, list[tuple[float, float]]] = {}
    for k in np.flatnonzero(~area.bare & np.isin(area.primitives.region, list(known))).tolist():
        least, at, free = _LEAST / max(size[k], 1e-300), 0.0, []
        for j in range(bounds[k], bounds[k + 1]):
            if low[j] - at > least:
                free.append((at, float(low[j])))
            at = max(at, float(high[j]))
        if 1 - at > least or at == 0.0:
            free.append((at, 1.0))
        if free:
            found[k] = free
    return found


def _chains(free: dict[int, list[tuple[float, float]]], area: MachiningArea) -> list[list[_WallPart]]:
    """Return runs that go on from row to row of the walls."""
    following = np.empty(len(area.primitives.previous), np.int64)
    following[area.primitives.previous] = np.arange(len(following))

    def begins(row: int) -> bool:
        return row in free and free[row][0][0] == 0.0

    def ends(row: int) -> bool:
        return row in free and free[row][-1][1] == 1.0

    chains = []
    used: set[int] = set()  # rows whose first part has its place in a chain

    def chain_from(row: int, part: int) -> list[_WallPart]:
        chain = [_WallPart(row, *free[row][part])]
        while part == len(free[row]) - 1 and ends(row):
            row, part = int(following[row]), 0
            if not begins(row) or row in used:
                break
            used.add(row)
            chain.append(_WallPart(row, *free[row][0]))
        return chain

    for row, parts in free.items():
        for k in range(len(parts)):
            if k or not (begins(row) and ends(int(area.primitives.previous[row]))):
                if k == 0:
                    used.add(row)
                chains.append(chain_from(row, k))
    for row in free:  # what is left are whole contours
        if row not in used and begins(row):
            used.add(row)
            chains.append(chain_from(row, 0))
    return chains


def _made(chains: Sequence[Sequence[_WallPart]], area: MachiningArea) -> list[WallGap]:
    """Return the gap that each run of parts of walls is, of those that are long enough."""
    parts = np.array([part for chain in chains for part in chain])
    first = np.append(0, np.cumsum([len(chain) for chain in chains]))
    walls, low, high = parts[:, 0].astype(np.int64), parts[:, 1], parts[:, 2]
    rows = area.distances.rows[walls]
    end = np.where((high == 1.0)[:, None], rows[:, 2:4], points_at(rows, high))
    rows[:, :2], rows[:, 2:4] = points_at(rows, low), end
    following = np.empty(len(area.primitives.previous), np.int64)
    following[area.primitives.previous] = np.arange(len(following))
    bare = (low == 0.0) & area.bare[area.primitives.previous[walls]], (high == 1.0) & area.bare[following[walls]]
    joints = np.maximum(_turns(rows[:-1], rows[1:]), 0.0)
    bends = np.where(rows[:, TURN] > 0, sweeps(rows), 0.0)
    long = np.add.reduceat(lengths(rows), first[:-1]) > _LEAST
    return [
        WallGap(
            rows[a:b],
            tuple(walls[a:b].tolist()),
            int(area.primitives.region[walls[b - 1]]),
            bool(bare[0][a] or bare[1][b - 1]),
            np.concatenate([joints[a : b - 1], bends[a:b]]),
        )
        for a, b in zip(first[:-1][long].tolist(), first[1:][long].tolist(), strict=True)
    ]


def _with_corners(found: Sequence[WallGap], level: OffsetLevel) -> list[WallGap]:
    """Return the gaps, each with the place where a ring turns from before it to behind it."""
    before, behind, joints, turn = _joints(Outlines.joined([ring.rows for ring in level.rings]), level.distance)
    jump = np.hypot(*(before - behind).T) > _JUMP
    if not jump.any() or not found:
        return list(found)
    before, behind, joints, turn = before[jump], behind[jump], joints[jump], turn[jump]
    ends = np.array([[*gap.rows[0, :2], *gap.rows[-1, 2:4]] for gap in found])
    corners = np.hstack([before, behind])
    place, corner_at = all_within(corners, ends, _SAME)
    off = np.hypot.reduce(corners[corner_at] - ends[place], axis=1)
    order = np.lexsort((off, place))[::-1]
    nearest = dict(zip(place[order].tolist(), corner_at[order].tolist(), strict=True))  # of several the last one stays
    result = []
    for number, gap in enumerate(found):
        if number not in nearest:
            result.append(gap)
            continue
        k = nearest[number]
        corner = float(joints[k, 0]), float(joints[k, 1])
        excess = float(gap.left.sum()) - float(turn[k])
        result.append(replace(gap, corner=corner, excess=excess, turn=float(turn[k])))
    return result


def _joints(rings: Outlines, distance: float) -> _RingJoints:
    """Return the joints of some rings."""
    rows = rings.rows
    after = rows[rings.following]
    turn = np.maximum(_turns(rows, after), 0.0)
    return _RingJoints(feet(rows, 1.0, distance), feet(after, 0.0, distance), rows[:, 2:4], turn)


def _turns(before: Rows, behind: Rows) -> Floats:
    """Return by how much (n,) a path turns left from the end of each row to the beginning of the one behind it,
    radians.
    """
    ahead, onward = headings_at(before, np.ones(len(before))), headings_at(behind, np.zeros(len(behind)))
    turn: Floats = np.arctan2(ahead[:, 0] * onward[:, 1] - ahead[:, 1] * onward[:, 0], (ahead * onward).sum(axis=1))
    return turn
