"""Bridges between rings: where the tool can go from one ring to the next without touching a wall."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...geometry import kernels
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, Ring
from ...geometry.outlines import Outlines
from ...geometry.primitives import (
    CX,
    CY,
    TURN,
    X0,
    X1,
    Y0,
    Y1,
    Indices,
    Rows,
    fraction_on,
    lengths,
    point_on,
    points_at,
)
from ...geometry.triangulation import neighbours
from ..build import split_row

_LONGEST = 64
"""Rows of a ring from whose middles a bridge to the level outside it is looked for, the longest ones."""

_TRIED_OUTWARD = 16
"""The same for a straight line of bridges out to the outermost level."""


@dataclass(frozen=True)
class RingBridge:
    """A straight way between two rings that keeps the outermost frame's distance from all walls.

    Attributes:
        a, b: its ends.
        length: mm.
    """

    a: RingPlace
    b: RingPlace
    length: float


def inward_bridges(
    levels: Sequence[OffsetLevel], halves: Sequence[OffsetLevel], field: DistanceField
) -> list[RingBridge]:
    """Return bridges from every ring to rings of the level before.

    From any point of a level the way towards its nearest point on the drawing keeps the distance rule by
    construction: distance falls by exactly the length gone. So each bridge is as long as the levels are apart.

    Args:
        levels: the pocket's levels, outermost first; rings are numbered through them in order.
        halves: closed runs inside each level, numbered on after all levels.
        field: distances from the drawing.
    """
    bridges: list[RingBridge] = []
    first, half_first = 0, sum(len(level.rings) for level in levels)
    for k, outer in enumerate(levels):
        if not outer.rings:
            break
        target = RingField.of(outer.rings, first)
        first += len(outer.rings)
        for number, some in ((first, levels[k + 1 : k + 2]), (half_first, halves[k : k + 1])):
            for inner in some:
                bridges.extend(_from_rings(inner.rings, number, target, field, inner.distance - outer.distance))
        half_first += sum(len(half.rings) for half in halves[k : k + 1])
    return bridges


class FeetOnRings(NamedTuple):
    """What of the rings of one level is nearest to each of n points.

    Attributes:
        distance: (n,) mm.
        row: (n,) of the field. fraction: (n,) of its length. point: (n, 2) there, mm.
    """

    distance: NDArray[np.float64]
    row: Indices
    fraction: NDArray[np.float64]
    point: NDArray[np.float64]


@dataclass(frozen=True)
class RingField:
    """Distances from the rings of one level.

    Attributes:
        field: of all their rows.
        ring, row: (n,) which ring each of these belongs to, and its number there.
    """

    field: DistanceField
    ring: NDArray[np.int64]
    row: NDArray[np.int64]

    @staticmethod
    def of(rings: Sequence[Ring], first: int) -> RingField:
        """Return the field of rings, one or more, numbered from `first`."""
        return RingField(
            DistanceField.of(np.concatenate([r.rows for r in rings])),
            np.repeat(np.arange(first, first + len(rings)), [len(r.rows) for r in rings]),
            np.concatenate([np.arange(len(r.rows)) for r in rings]),
        )

    def nearest_of(self, points: NDArray[np.float64]) -> FeetOnRings:
        """Return what is nearest to points (n, 2)."""
        distance, found = self.field.nearest(points)
        rows = self.field.rows[found]
        fraction = fractions_at(rows, points)
        return FeetOnRings(distance, found, fraction, points_at(rows, fraction))

    def place(self, row: int, part: float) -> RingPlace:
        """Return the place at a fraction of a row of the field."""
        return RingPlace(int(self.ring[row]), int(self.row[row]), part)


@dataclass(frozen=True, eq=False)
class _Middles:
    """Middles of the longest rows of some rings, of each ring the longest first.

    Attributes:
        ring, row: (n,) which of the rings, and the row of it. rank: (n,) how many longer ones the ring has.
        points: (n, 2) the middles.
        feet: (n, 2) what of the drawing is nearest to each. distance: (n,) how far away that is, mm.
    """

    ring: Indices
    row: Indices
    rank: Indices
    points: Rows
    feet: Rows
    distance: NDArray[np.float64]

    @staticmethod
    def of(rings: Sequence[Ring], most: int, field: DistanceField) -> _Middles:
        """Return those of so many rows a ring at most."""
        outlines = Outlines.joined([ring.rows for ring in rings])
        order = np.lexsort((-outlines.sizes, outlines.owner))
        rank = np.arange(len(order)) - outlines.first[outlines.owner]
        order, ring, rank = (each[rank < most] for each in (order, outlines.owner, rank))
        points = points_at(outlines.rows[order], np.full(len(order), 0.5))
        distance, nearest = field.nearest(points)
        feet = foot(field.rows[nearest], points)
        return _Middles(ring, order - outlines.first[ring], rank, points, feet, distance)

    def towards_wall(self, some: Indices, length: float | NDArray[np.float64]) -> Rows:
        """Return where some of them come to by going a length, mm, straight to their feet."""
        return self.points[some] + (self.feet[some] - self.points[some]) * (length / self.distance[some])[:, None]


def _from_rings(
    rings: Sequence[Ring], number: int, target: RingField, field: DistanceField, step: float
) -> list[RingBridge]:
    """Return the best bridge from each of some rings, numbered from `number`, to each ring of the level before that it
    can reach.
    """
    if not rings:
        return []
    middles = _Middles.of(rings, _LONGEST, field)
    arrived = middles.towards_wall(np.arange(len(middles.ring)), step)
    off, rows = target.field.nearest(arrived)
    kept = np.flatnonzero(off <= tolerances.LEVEL)
    pair = middles.ring[kept] * (int(target.ring[-1]) + 1) + target.ring[rows[kept]]
    best = kept[np.sort(np.unique(pair, return_index=True)[1])]
    parts = fractions_at(target.field.rows[rows[best]], arrived[best])
    begins = zip((number + middles.ring[best]).tolist(), middles.row[best].tolist(), strict=True)
    ends = zip(target.ring[rows[best]].tolist(), target.row[rows[best]].tolist(), parts.tolist(), strict=True)
    return [RingBridge(RingPlace(*begin, 0.5), RingPlace(*end), step) for begin, end in zip(begins, ends, strict=True)]


def outward(
    rings: Mapping[int, Ring], counts: Indices, targets: Sequence[tuple[float, RingField]], field: DistanceField
) -> dict[int, list[RingBridge]]:
    """Return for each of some rings bridges in one straight line from it out to the outermost level, the innermost
    first; none if there is no such line.

    The way from a point to its nearest point on the drawing crosses all levels outside it, each as far from the next as
    they are.

    Args:
        rings: by their numbers.
        counts: (n,) how many of the levels lie outside each of these.
        targets: (distance from the drawing, rings there) of the levels, outermost first.
        field: distances from the drawing.
    """
    lines: dict[int, list[RingBridge]] = {number: [] for number in rings}
    if not rings:
        return lines
    numbers, middles = np.fromiter(rings, np.int64), _Middles.of(list(rings.values()), _TRIED_OUTWARD, field)
    missing = counts > 0
    for rank in range(_TRIED_OUTWARD):
        some = np.flatnonzero((middles.rank == rank) & missing[middles.ring])
        if not len(some):
            break
        there, crossed = _crossed(middles, some, counts[middles.ring[some]], targets)
        missing[middles.ring[some[there]]] = False
        for k, line in zip(some[there].tolist(), crossed, strict=True):
            number = int(numbers[middles.ring[k]])
            at, before = RingPlace(number, int(middles.row[k]), 0.5), float(middles.distance[k])
            for level, place in line:
                lines[number].append(RingBridge(at, place, before - level))
                at, before = place, level
    return lines


def _crossed(
    middles: _Middles, some: Indices, counts: Indices, targets: Sequence[tuple[float, RingField]]
) -> tuple[Indices, list[list[tuple[float, RingPlace]]]]:
    """Return (which of some middles come out to the outermost level straight (k,), where each of these crosses the
    levels on the way, with these levels' distances, the innermost first).
    """
    there = np.full(len(some), True)
    found: list[tuple[float, RingField, Indices, Indices, list[float]]] = []
    for k in range(int(counts.max()) - 1, -1, -1):
        level, target = targets[k]
        at = np.flatnonzero(there & (counts > k))
        feet = target.nearest_of(middles.towards_wall(some[at], middles.distance[some[at]] - level))
        there[at[feet.distance > tolerances.LEVEL]] = False
        found.append((level, target, at, feet.row, feet.fraction.tolist()))
    crossed: dict[int, list[tuple[float, RingPlace]]] = {k: [] for k in np.flatnonzero(there).tolist()}
    for level, target, requested, row_of, part_of in found:
        for one, row, part in zip(requested.tolist(), row_of.tolist(), part_of, strict=True):
            if there[one]:
                crossed[one].append((level, target.place(row, part)))
    return np.flatnonzero(there), list(crossed.values())


def foot(rows: Rows, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point of each row (n, 8) nearest to each point (n, 2)."""
    return points_at(rows, fractions_at(rows, points))


def fractions_at(rows: Rows, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the fraction in [0, 1] of each row's length (n, 8) that is nearest to each point (n, 2)."""
    along, arm = rows[:, X1:CX] - rows[:, X0:X1], points - rows[:, X0:X1]
    arc = rows[:, TURN] != 0
    square = along[:, 0] * along[:, 0] + along[:, 1] * along[:, 1]
    parts = np.clip((arm[:, 0] * along[:, 0] + arm[:, 1] * along[:, 1]) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    if arc.any():
        rows, points = rows[arc], points[arc]
        start, end, at = (
            np.arctan2(y - rows[:, CY], x - rows[:, CX])
            for x, y in ((rows[:, X0], rows[:, Y0]), (rows[:, X1], rows[:, Y1]), (points[:, 0], points[:, 1]))
        )
        sweep, turn = ((angle - start) * rows[:, TURN] % math.tau for angle in (end, at))
        beyond = np.where(turn - sweep < math.tau - turn, 1.0, 0.0)
        parts[arc] = np.where(turn <= sweep, turn / np.where(sweep > 0, sweep, 1.0), beyond)
    return parts


def fraction_at(row: Rows, point: NDArray[np.float64]) -> float:
    """Return the fraction in [0, 1] of a row's length that is nearest to a point."""
    x, y = point.tolist()
    return fraction_on(row.tolist(), (x, y))


def nearest_on(ring: Ring, number: int, point: NDArray[np.float64]) -> tuple[float, RingPlace]:
    """Return (distance, place) of what of a ring is nearest to a point (2,), mm."""
    distance, row = kernels.nearest_of_few(np.ascontiguousarray(ring.rows), *point.tolist())
    return float(distance), RingPlace(number, int(row), fraction_at(ring.rows[row], point))


class RingEdges:
    """Between which points along rings the shortest ways from ring to ring are looked for: the edges of a Delaunay
    triangulation, of which the shortest tree through all rings is part.

    Those of the same rings, which are asked for again and again while paths are compared, are kept.
    """

    def __init__(self, rings: Sequence[Ring]) -> None:
        self.rings = rings
        self._known: dict[tuple[float, tuple[int, ...]], _Edges] = {}

    def between(self, some: Sequence[int], spacing: float) -> _Edges:
        """Return the edges between points of some rings, given by their numbers, spaced by mm."""
        key = (spacing, tuple(some))
        if key not in self._known:
            self._known[key] = _Edges.of([self.rings[k] for k in some], spacing)
        return self._known[key]


@dataclass(frozen=True, eq=False)
class _Edges:
    """Ways between rings, the shortest first.

    Attributes:
        ends: (n, 2) numbers of the points that each joins. size: (n,) their lengths, mm.
        ring, row, part, points: (m,) and (m, 2) of the points: which of the rings, its row, how far along that, where.
    """

    ends: Indices
    size: NDArray[np.float64]
    ring: Indices
    row: Indices
    part: NDArray[np.float64]
    points: NDArray[np.float64]

    @staticmethod
    def of(rings: Sequence[Ring], spacing: float) -> _Edges:
        """Return those between points along some rings, spaced by mm, but none within a ring or to another region."""
        outlines = Outlines.joined([ring.rows for ring in rings])
        counts = np.maximum(1, np.ceil(outlines.sizes / spacing)).astype(np.int64)
        row = np.repeat(np.arange(len(outlines.rows)), counts)
        part = (np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[row]
        points, ring = points_at(outlines.rows[row], part), outlines.owner[row]
        edges, region = neighbours(points), np.array([each.region for each in rings])[ring]
        one, other = edges.T
        edges = edges[(ring[one] != ring[other]) & (region[one] == region[other])]
        size = np.hypot(*(points[edges[:, 0]] - points[edges[:, 1]]).T)
        order = np.argsort(size, kind="stable")
        return _Edges(edges[order], size[order], ring, row - outlines.first[ring], part, points)


def level_bridges(
    edges: RingEdges, some: Sequence[int], group: Callable[[int], int], spacing: float, most: int | None = None
) -> Iterator[tuple[RingBridge, NDArray[np.float64]]]:
    """Yield candidates between some rings with their ends (2, 2), shortest first; clearance is not checked.

    Args:
        edges: of all rings.
        some: numbers of those to join.
        group: tells the group of a ring; what is already joined, and by then still more, has the same one.
        spacing: between points, mm.
        most: candidates between any two rings, the shortest; None = all.
    """
    found = edges.between(some, spacing)
    number = np.array(some, np.int64)
    groups = np.array([group(k) for k in some])[found.ring]
    order = np.flatnonzero(groups[found.ends[:, 0]] != groups[found.ends[:, 1]])
    one, other = number[found.ring[found.ends[order]]].T
    if most is not None:
        kept = _rank(np.minimum(one, other) * len(edges.rings) + np.maximum(one, other)) < most
        order, one, other = order[kept], one[kept], other[kept]
    for k, a, b in zip(order.tolist(), one.tolist(), other.tolist(), strict=True):
        if group(a) == group(b):
            continue
        ends = found.ends[k]
        start, end = (
            RingPlace(ring, int(found.row[i]), float(found.part[i])) for ring, i in zip((a, b), ends, strict=True)
        )
        yield RingBridge(start, end, float(found.size[k])), found.points[ends]


def _rank(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many equal keys come before each."""
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.concatenate([[True], np.diff(keys[order]) != 0])) if len(keys) else np.zeros(0, np.int64)
    ranks = np.empty(len(keys), np.int64)
    ranks[order] = np.arange(len(keys)) - np.repeat(first, np.diff(np.append(first, len(keys))))
    return ranks


class KeptWalls(NamedTuple):
    """Walls that straight ways keep off.

    Attributes:
        field: distances from them. distance: that is kept, mm.
    """

    field: DistanceField
    distance: float

    def is_clear(self, a: np.ndarray, b: np.ndarray) -> bool:
        """Tell whether the straight way from a to b stays at least `distance` - 1 um from the walls.

        Distance changes by no more than the length gone, so a step of (measured - needed) cannot pass a wall unseen.
        """
        way, field = np.array([*a, *b], np.float64), self.field
        return bool(kernels.stays_clear(field.rows, field.order, field.nodes, way, self.distance, tolerances.LEVEL))


# Pieces of closed paths: places on them, and the rows from one place to another.


_SAME = 1e-9  # fraction of a row


@dataclass(frozen=True)
class RingPlace:
    """A point of a ring: fraction in [0, 1] of one of its rows."""

    ring: int
    row: int
    fraction: float


def point_of(rows: Rows, place: RingPlace) -> Rows:
    """Return the point (2,) at a place of a ring's rows."""
    return np.array(point_on(rows[place.row].tolist(), place.fraction))


def position(place: RingPlace, count: int, forward: bool) -> float:
    """Return where a place is along a ring of `count` rows, in rows from its beginning."""
    at = place.row + place.fraction
    return at if forward else count - at


def point_at(rows: Rows, at: float) -> Rows:
    """Return the point (2,) at a position along a closed ring, in rows from its beginning or past it."""
    row = math.floor(at)
    return point_of(rows, RingPlace(0, row % len(rows), at - row))


def along(rows: Rows, start: float, distance: float) -> float:
    """Return the position so many mm on from another one along a closed ring, or back if less than 0; at most once
    round.
    """
    ends = np.append(0.0, np.cumsum(lengths(rows)))
    row = math.floor(start)
    lap = row // len(rows)
    k = row - lap * len(rows)
    total = float(ends[-1])
    where = float(ends[k] + (start - row) * (ends[k + 1] - ends[k])) + distance
    turns = math.floor(where / total)
    rest = where - turns * total
    at = min(int(np.searchsorted(ends, rest, "right")) - 1, len(rows) - 1)
    return (lap + turns) * len(rows) + at + (rest - float(ends[at])) / float(ends[at + 1] - ends[at])


def span(rows: Rows, start: float, end: float) -> Rows:
    """Return a closed ring's rows from one position to another, going on past its beginning."""
    first, last = math.floor(start), math.ceil(end) - 1
    if last < first:
        return rows[:0]
    if last == first:
        return part_of(rows[first % len(rows)], start - first, end - first)
    whole = rows[np.arange(first, last + 1) % len(rows)]
    if start == first and end == last + 1:
        return whole
    head, tail = part_of(whole[0], start - first, 1.0), part_of(whole[-1], 0.0, end - last)
    return np.concatenate([head, whole[1:-1], tail])


def part_of(row: Rows, start: float, end: float) -> Rows:
    """Return a row from one fraction to another as (1, 8), or nothing where they are the same."""
    if end - start < _SAME:
        return row[None][:0]
    if end < 1:
        row = split_row(row, end)[0]
    if start > 0:
        row = split_row(row, start / end)[1]
    return row[None]


def straight(a: Rows, b: Rows) -> Rows:
    """Return the line from one point (2,) to another as (1, 8)."""
    return np.array([[*a, *b, 0.0, 0.0, 0.0, 0.0]])


def joined(rows: Rows) -> Rows:
    """Make each row begin exactly where the one before ends (bridges meet rings within rounding)."""
    rows = rows.copy()
    rows[1:, :2] = rows[:-1, 2:4]
    return rows


# Which rings are joined by which bridges: a forest, grown by bridges that join what was apart (Kruskal).


Edge = tuple[RingPlace, RingPlace, float]
"""A bridge as seen from one of its rings: place on this ring, place on the other one, length, mm."""


class BridgeForest:
    """A forest over rings numbered from 0."""

    def __init__(self, count: int) -> None:
        self._parent = list(range(count))
        self.neighbours: list[list[Edge]] = [[] for _ in range(count)]

    def group(self, ring: int) -> int:
        """Return the number of the group that a ring is in."""
        while self._parent[ring] != ring:
            self._parent[ring] = self._parent[self._parent[ring]]
            ring = self._parent[ring]
        return ring

    def joined(self, bridge: RingBridge) -> bool:
        """Tell whether both ends are in one group already."""
        return self.group(bridge.a.ring) == self.group(bridge.b.ring)

    def add(self, bridge: RingBridge) -> None:
        """Take a bridge unless it would close a loop."""
        if self.joined(bridge):
            return
        self._parent[self.group(bridge.a.ring)] = self.group(bridge.b.ring)
        self.neighbours[bridge.a.ring].append((bridge.a, bridge.b, bridge.length))
        self.neighbours[bridge.b.ring].append((bridge.b, bridge.a, bridge.length))

    def roots(self, depth: Sequence[float]) -> list[int]:
        """Return the innermost ring of each group.

        Args:
            depth: how far inside each ring is.
        """
        best: dict[int, int] = {}
        for ring in range(len(depth)):
            group = self.group(ring)
            if group not in best or depth[ring] > depth[best[group]]:
                best[group] = ring
        return list(best.values())

    def longest_way(self, root: int) -> list[tuple[int, Edge | None]]:
        """Return the rings from a root to the one farthest from it over bridges, each with the bridge to the next; the
        last with none.
        """
        before: dict[int, tuple[int, Edge] | None] = {root: None}
        far = {root: 0.0}
        waiting = [root]
        while waiting:
            ring = waiting.pop()
            for edge in self.neighbours[ring]:
                if edge[1].ring not in before:
                    before[edge[1].ring] = ring, edge
                    far[edge[1].ring] = far[ring] + edge[2]
                    waiting.append(edge[1].ring)
        way: list[tuple[int, Edge | None]] = []
        at, step = max(far, key=lambda ring: far[ring]), None
        while True:
            way.append((at, step))
            previous = before[at]
            if previous is None:
                return way[::-1]
            at, step = previous
