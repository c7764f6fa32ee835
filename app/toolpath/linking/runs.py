"""Runs between rings farther apart than half the tool: what rings leave uncut, and the short ways that cut it.

Let A(d) be all points at distance d or more from the walls, L the distance of a ring and s the stepover. Rings at L and
L + s leave U = {L + R < D < L + s} without what the tool sweeps round A(L + s). Be h = L + s - a with
a = max(s - R, R²/(L + s)): from a point p of U the way to its nearest wall meets level h at a point q not farther than
a <= R. If a point x of A(L + s) were within R of q it would be within R of p: x is L + s or more from the wall's point
w, so (x - q) n >= ((L + s)² - R² - h²) / 2h >= a/2 with n the direction from w to q and p, and |x - p| <= |x - q| for
every p between q and q + a n. So q is on a part of level h that rings leave uncovered, and a run along those parts cuts
all of U: total cover for every s <= 2R, proven along lines and arcs in closed form, nothing sampled.

A part need not be run along: a straight way covers U where it comes within R of the corners of squares that hold all of
U, since the swath of a straight way is convex. The squares are those of a quad tree that rings are not proven to cover
and from which a part of level h is no farther than they are inside of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.pool import pool
from ...geometry.distance import DistanceField
from ...geometry.near_points import groups_within
from ...geometry.offset.offset import OffsetLevel, Ring
from ...geometry.outlines import Outlines
from ...geometry.primitives import Indices, Rows, lengths, path_length, points_at, reversed_rows, samples
from ..coverage import uncut_kernels
from . import runs_kernels
from .bridge import KeptWalls, RingField, RingPlace, part_of, straight

TOUCH = 1e-6
"""mm by which a point may be farther from a ring than the tool's radius and still counts as cut by it."""

_CHORD = 1e-3
"""Of the radius: chords of parts stay so near to them, and so much is spared where ways cover them."""

_FINEST = 64
"""Half sides of the smallest squares go so many times into the radius."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Detour:
    """A way from a place of a ring to what rings leave, and back to that place.

    Attributes:
        place: where it begins and ends.
        rows: (n, 8), each beginning where the one before ends.
        cuts: (n,) True where it cuts, False where it only leads to a cut or back from it.
        length: mm.
    """

    place: RingPlace
    rows: Rows
    cuts: NDArray[np.bool_]

    @property
    def length(self) -> float:
        """mm."""
        return path_length(self.rows)


@dataclass(frozen=True, eq=False)
class GapFilling:
    """What cuts all that some levels leave.

    Attributes:
        halves: closed runs just inside each level, aligned with the levels.
        detours: the others.
    """

    halves: tuple[OffsetLevel, ...] = ()
    detours: tuple[Detour, ...] = ()

    @property
    def length(self) -> float:
        """mm."""
        return sum(ring.length for half in self.halves for ring in half.rings) + sum(
            detour.length for detour in self.detours
        )


NOTHING = GapFilling()


@dataclass(frozen=True, eq=False)
class _Gap:
    """A part of a ring between two levels that neither of them covers."""

    rows: Rows
    closed: bool
    ring: Ring


def between(distances: Sequence[float], stepover: float, radius: float) -> tuple[float, ...]:
    """Return for each level's distance that of the level inside it along which runs go; none where rings cover all, mm.

    Args:
        stepover: of the levels, mm, at most 2 radius.
        radius: of the tool, mm.
    """
    if stepover <= radius:
        return ()
    return tuple(level + stepover - max(stepover - radius, radius**2 / (level + stepover)) for level in distances)


def fill(
    levels: Sequence[OffsetLevel], halves: Sequence[OffsetLevel], field: DistanceField, radius: float
) -> GapFilling:
    """Return closed runs and trips that cut all that the levels leave.

    Args:
        levels: rings, outermost first.
        halves: the levels `between` them, one inside each.
        field: distances from the walls; the outermost level's is kept.
        radius: of the tool, mm.
    """
    halves = halves[: len(levels)]
    walls = KeptWalls(field, levels[0].distance if levels else 0.0)
    numbers = accumulate((len(level.rings) for level in levels), initial=0)
    sides = [
        RingField.of(level.rings, first) if level.rings else None for level, first in zip(levels, numbers, strict=False)
    ]
    spaces = [
        _Space((outer, inner), (level, half), walls, radius)
        for outer, inner, level, half in zip(sides, [*sides[1:], None], [*levels[1:], None], halves, strict=True)
    ]
    gaps = [space.gaps() for space in spaces]
    filled = [
        space.filled(some, corners)
        for space, some, corners in zip(spaces, gaps, pool().map(_Space.corners, spaces, gaps), strict=True)
    ]
    rings = tuple(OffsetLevel(half.distance, tuple(closed)) for half, (closed, _) in zip(halves, filled, strict=True))
    return GapFilling(rings, tuple(detour for _, detours in filled for detour in detours))


def gaps_of(half: OffsetLevel, inner: RingField | None, radius: float) -> list[_Gap]:
    """Return the parts of rings between two levels that the inner one's rings do not cover."""
    if inner is None:
        return [_Gap(ring.rows, closed=True, ring=ring) for ring in half.rings]
    path = inner.field
    gaps: list[_Gap] = []
    for ring in half.rings:
        found, count = runs_kernels.uncovered(
            np.ascontiguousarray(ring.rows), path.rows, path.order, path.nodes, path.boxes, radius + TOUCH
        )
        gaps += _connected(ring, found[:count])
    return gaps


def _connected(ring: Ring, parts: Floats) -> list[_Gap]:
    """Return parts (n, 3) of a ring's rows, in order, with those that follow one another joined."""
    if not len(parts):
        return []
    count = len(ring.rows)
    before = np.roll(parts, 1, axis=0)
    follows = ((before[:, 0] + 1) % count == parts[:, 0] % count) & (before[:, 2] == 1) & (parts[:, 1] == 0)
    if follows.all() and len(parts) == count:
        return [_Gap(ring.rows, closed=True, ring=ring)]
    turned = -int(np.argmin(follows))
    parts, follows = np.roll(parts, turned, axis=0), np.roll(follows, turned)
    starts = np.append(np.flatnonzero(~follows), len(parts))
    return [
        _Gap(np.concatenate([part_of(ring.rows[int(row)], u, v) for row, u, v in parts[a:b]]), closed=False, ring=ring)
        for a, b in pairwise(starts)
    ]


@dataclass(frozen=True, eq=False)
class _Gaps:
    """The gaps of a level in groups: those that may belong to one uncut place.

    Attributes:
        each: all of them. outlines: their rows. group: (n,) number of the group of each, numbered as they come.
    """

    each: list[_Gap]
    outlines: Outlines
    group: Indices

    @property
    def groups(self) -> list[list[_Gap]]:
        """By their numbers."""
        found: list[list[_Gap]] = [[] for _ in range(int(self.group.max(initial=-1)) + 1)]
        for k, gap in zip(self.group.tolist(), self.each, strict=True):
            found[k].append(gap)
        return found


class _RingEnd(NamedTuple):
    """How far the nearest place of rings is, mm, which it is, and where (2,)."""

    distance: float
    place: RingPlace
    point: Floats


class _RunWithEnds(NamedTuple):
    """A run, and what of each side's rings is nearest to its beginning and to its end."""

    rows: Rows
    begins: Sequence[_RingEnd]
    stops: Sequence[_RingEnd]


class _Space:
    """Between a level and the one inside it: the rings that trips start from, and what they keep clear of."""

    def __init__(
        self,
        sides: tuple[RingField | None, RingField | None],
        levels: tuple[OffsetLevel | None, OffsetLevel],
        walls: KeptWalls,
        radius: float,
    ) -> None:
        self._inner, self._sides = sides[1], [side for side in sides if side is not None]
        self._next, self._half = levels
        self._walls, self._radius = walls, radius

    def gaps(self) -> _Gaps:
        """Return all gaps between the two levels; those of one group come near one another."""
        gaps = gaps_of(self._half, self._inner, self._radius)
        outlines = Outlines.joined([gap.rows for gap in gaps])
        if len(gaps) < 2:
            return _Gaps(gaps, outlines, np.zeros(len(gaps), np.int64))
        reach = 2 * (self._next.distance - self._half.distance if self._next else self._radius)
        step = self._radius / 4
        owner, points = _along(outlines, step)
        return _Gaps(gaps, outlines, groups_within(points, owner, len(gaps), reach + step))

    def corners(self, gaps: _Gaps) -> list[Floats]:
        """Return for each group of gaps the corners (m, 2) of what holds it and all that is uncut beyond it."""
        if not gaps.each:
            return []
        outlines = gaps.outlines
        row, points = samples(outlines.rows, _CHORD * self._radius)
        group, uncut = self._uncut(gaps)
        last = outlines.rows[outlines.first[1:] - 1, 2:4]
        owner = np.concatenate([group, gaps.group[outlines.owner[row]], gaps.group])
        order = np.argsort(owner, kind="stable")
        hulls = shapely.convex_hull(
            shapely.linestrings(np.concatenate([uncut, points, last])[order], indices=owner[order])
        )
        found, of = shapely.get_coordinates(hulls, return_index=True)
        return np.split(found, np.searchsorted(of, np.arange(1, len(hulls))))

    def _uncut(self, gaps: _Gaps) -> tuple[Indices, Floats]:
        """Return (number of the group (n,), points (n, 2)) of the outermost corners of squares that hold all that is
        uncut beyond gaps.
        """
        if self._next is None or self._inner is None:
            return np.zeros(0, np.int64), np.zeros((0, 2))
        beside, walls, path = DistanceField.of(gaps.outlines.rows), self._walls.field, self._inner.field
        radii = np.full(len(path.rows), self._radius)
        found, count = runs_kernels.squares_beyond(
            walls.rows,
            walls.order,
            walls.nodes,
            beside.rows,
            beside.order,
            beside.nodes,
            path.rows,
            path.order,
            path.nodes,
            radii,
            uncut_kernels.widest(radii, path.order, len(path.nodes)),
            np.array([self._half.distance, self._radius / _FINEST]),
            self._squares(_along(gaps.outlines, self._radius / 4)[1], self._next.distance - self._half.distance),
        )
        group = gaps.group[gaps.outlines.owner[found[:count, 3].astype(np.int64)]]
        corners, owner = runs_kernels.outermost(found[:count], group, int(gaps.group.max()) + 1)
        return owner, corners

    def _squares(self, points: Floats, reach: float) -> Floats:
        """Return squares (n, 3) of half a radius that hold all within `reach`, at most a radius, of ways along points
        (m, 2).
        """
        size = self._radius / 2
        steps = np.arange(
            -int(np.ceil((reach + self._radius / 4) / size)), int(np.ceil((reach + self._radius / 4) / size)) + 1
        )
        around = np.stack(np.meshgrid(steps, steps), -1).reshape(-1, 2)
        cells = _different((_different(np.floor(points / size).astype(np.int64))[:, None] + around).reshape(-1, 2))
        return np.column_stack([(cells + 0.5) * size, np.full(len(cells), size / 2)])

    def filled(self, gaps: _Gaps, corners: Sequence[Floats]) -> tuple[list[Ring], list[Detour]]:
        """Return (closed runs, trips) for all gaps, given the `corners` of their groups."""
        rings: list[Ring] = []
        detours: list[Detour] = []
        open_ones = [gap for gap in gaps.each if not gap.closed]
        known = dict(zip(map(id, open_ones), self._ends_of([gap.rows for gap in open_ones]), strict=True))
        for group, spur in zip(gaps.groups, self._spurs(corners), strict=True):
            if spur is not None:
                detours.append(spur)
                continue
            runs = [known[id(gap)] for gap in group if not gap.closed]
            rings += [gap.ring for gap in group if gap.closed]
            alone = [self._run(run) for run in runs]
            both = self._round(runs) if len(runs) == 2 else None
            detours += [both] if both and both.length < sum(detour.length for detour in alone) else alone
        return rings, detours

    def _ends_of(self, runs: Sequence[Rows]) -> list[_RunWithEnds]:
        """Return runs with what is nearest to their ends; all are asked for at once."""
        ends = np.array([end for run in runs for end in (run[0, :2], run[-1, 2:4])]).reshape(-1, 2)
        sides = []
        for side in self._sides:
            feet = side.nearest_of(ends)
            places = map(side.place, feet.row.tolist(), feet.fraction.tolist())
            sides.append(list(map(_RingEnd, feet.distance.tolist(), places, feet.point)))
        return [
            _RunWithEnds(run, [side[2 * k] for side in sides], [side[2 * k + 1] for side in sides])
            for k, run in enumerate(runs)
        ]

    def _spurs(self, places: Sequence[Floats]) -> list[Detour | None]:
        """Return for each set of points (m, 2) the shortest straight way there and back that comes within the radius of
        all of them.
        """
        if not places:
            return []
        counts = np.array([len(each) for each in places])
        probes = np.concatenate([_far_apart(each) for each in places])
        requested = [side.nearest_of(probes) for side in self._sides]
        starts = np.concatenate([each.point.reshape(len(places), -1, 2) for each in requested], axis=1)
        ways = np.empty((len(places), 2 * starts.shape[1], 3))
        runs_kernels.tips(
            np.concatenate(places),
            np.append(0, np.cumsum(counts)),
            np.ascontiguousarray(starts),
            self._radius * (1 - 2 * _CHORD),
            ways,
        )
        spurs: list[Detour | None] = []
        for k in range(len(places)):
            mine = slice(3 * k, 3 * k + 3)
            sides = [
                (side, feet.row[mine], feet.fraction[mine]) for side, feet in zip(self._sides, requested, strict=True)
            ]
            spurs.append(self._spur(starts[k], ways[k], sides))
        return spurs

    def _spur(self, starts: Floats, ways: Floats, sides: Sequence[tuple[RingField, Indices, Floats]]) -> Detour | None:
        """Return the shortest of ways there and back that is clear.

        Args:
            starts: (n, 2) where they begin, three a side. ways: (2 n, 3) length, infinite where there is none, and
                where each ends.
            sides: rings, rows of theirs (3,) and fractions (3,) where ways begin.
        """
        for way in np.argsort(ways[:, 0], kind="stable").tolist():
            (length, *tip), start = ways[way], starts[way // 2]
            if not np.isfinite(length):
                return None
            if length > 0 and self._walls.is_clear(start, np.array(tip)):
                side, rows, parts = sides[way // 6]
                probe = way // 2 % 3
                out, back = straight(start, np.array(tip)), straight(np.array(tip), start)
                return Detour(
                    side.place(int(rows[probe]), float(parts[probe])),
                    np.concatenate([out, back]),
                    np.array([True, False]),
                )
        return None

    def _run(self, one: _RunWithEnds) -> Detour:
        """Return the shortest trip along a run: round, or there and back."""
        ways: list[tuple[float, RingPlace, Rows, Rows]] = []
        length = path_length(one.rows)
        both = (one.rows, one.begins), (reversed_rows(one.rows), one.stops)
        for side in range(len(self._sides)):
            for (run, ends), (back_again, _) in (both, both[::-1]):
                away, place, start = ends[side]
                out = np.concatenate([straight(start, run[0, :2]), run])
                back = np.concatenate([back_again, straight(run[0, :2], start)])
                ways.append((2 * (away + length), place, out, back))
                home = straight(run[-1, 2:4], start)
                ways.append((away + length + float(np.hypot(*(run[-1, 2:4] - start))), place, out, home))
        ways.sort(key=lambda way: way[0])
        _, place, out, back = next(
            way for way in ways if self._clear(way[2][0]) and (len(way[3]) > 1 or self._clear(way[3][0]))
        )
        cuts = np.arange(len(out) + len(back)) < len(out)
        cuts[0] = False
        return Detour(place, np.concatenate([out, back]), cuts)

    def _round(self, runs: Sequence[_RunWithEnds]) -> Detour | None:
        """Return the shortest trip along one run and back along another."""
        best: Detour | None = None
        first, second = ([(run.rows, run.begins), (reversed_rows(run.rows), run.stops)] for run in runs)
        for side in range(len(self._sides)):
            for one, ends in first:
                _, place, start = ends[side]
                for two, _ in second:
                    across, out, home = (
                        straight(one[-1, 2:4], two[0, :2]),
                        straight(start, one[0, :2]),
                        straight(two[-1, 2:4], start),
                    )
                    cuts = np.ones(len(one) + len(two) + 3, np.bool_)
                    cuts[[0, len(one) + 1, -1]] = False
                    detour = Detour(place, np.concatenate([out, one, across, two, home]), cuts)
                    if (best is None or detour.length < best.length) and all(
                        self._clear(way[0]) for way in (out, across, home)
                    ):
                        best = detour
        return best

    def _clear(self, row: Rows) -> bool:
        return self._walls.is_clear(row[:2], row[2:4])


def _different(cells: Indices) -> Indices:
    """Return every one of some cells (n, 2) once, in order."""
    first, high = cells.min(axis=0), int(cells[:, 1].max() - cells[:, 1].min()) + 1
    codes = np.unique((cells[:, 0] - first[0]) * high + cells[:, 1] - first[1])  # many times as quick as rows
    different: Indices = np.column_stack([codes // high, codes % high]) + first
    return different


def _along(outlines: Outlines, step: float) -> tuple[Indices, Floats]:
    """Return (number of the path (n,), points (n, 2)) along paths, at most `step` mm apart, both ends included."""
    rows = outlines.rows
    counts = np.maximum(1, np.ceil(lengths(rows) / step)).astype(np.int64)
    row = np.repeat(np.arange(len(rows)), counts)
    part = (np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[row]
    owner = np.concatenate([outlines.owner[row], np.arange(len(outlines))])
    return owner, np.concatenate([points_at(rows[row], part), rows[outlines.first[1:] - 1, 2:4]])


def _far_apart(points: Floats) -> Floats:
    """Return three places (3, 2): the middle of the box of points, the one farthest from that, the one farthest from
    the last.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    one = points[np.argmax(np.hypot(*(points - middle).T))]
    other = points[np.argmax(np.hypot(*(points - one).T))]
    return np.array([middle, one, other])
