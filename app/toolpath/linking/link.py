"""One stroke: rings joined by a tree of bridges, and walked so that the tool never lifts (step 143).

The walk starts on the innermost ring and goes outwards where it can, so the tool widens what is already cut; or the
other way round, from the outermost frame inwards. A ring that is reached from inside has its metal on the wall side,
one reached from outside has it inside: climb milling takes the first in the ring's own direction and the second the
other way round.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.tolerances import LEVEL
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, Ring
from ...geometry.primitives import CX, CY, TURN, R, Rows, lengths, path_length, reversed_rows, sweeps
from ...model.moves import Purpose
from ...model.operation import Direction
from ..build import Stroke
from ..leads.contour_path import headings_at, left_of
from .bridge import (
    BridgeForest,
    Edge,
    KeptWalls,
    RingBridge,
    RingEdges,
    RingField,
    RingPlace,
    along,
    inward_bridges,
    joined,
    level_bridges,
    nearest_on,
    outward,
    point_at,
    point_of,
    position,
    span,
    straight,
)
from .runs import NOTHING, Detour, GapFilling

_TRIED = 32
"""Bridges between two rings that are looked at before they are taken to have none."""


@dataclass(frozen=True)
class LinkOptions:
    """How rings are cut.

    Attributes:
        direction: climb or conventional.
        outside_in: begin at the walls, not inside.
    """

    direction: Direction = Direction.CLIMB
    outside_in: bool = False


def link(
    levels: Sequence[OffsetLevel],
    field: DistanceField,
    options: LinkOptions,
    filling: GapFilling = NOTHING,
    step: float = 0.0,
) -> tuple[Stroke, ...]:
    """Return as few strokes as there are connected areas that the tool's centre can be in.

    Args:
        levels: rings of the pocket tool, outermost first.
        field: distances from the drawing.
        filling: what cuts all that the levels leave.
        step: between levels, mm, where it is no more than the tool's radius: then ways between rings save pieces of
            them; 0 = none is.
    """
    if not levels:
        return ()
    rings = [ring for level in (*levels, *filling.halves) for ring in level.rings]
    depth = [float(k) for k, level in enumerate(levels) for _ in level.rings]
    depth += [k + 0.5 for k, level in enumerate(filling.halves) for _ in level.rings]
    bridges = inward_bridges(levels, filling.halves, field)
    areas = sum(ring.area > 0 for ring in levels[0].rings)
    known = RingEdges(rings)
    tree = _grown(_SeparateRings(known, BridgeForest(len(rings)), areas), bridges, levels, field)
    lines = _lines_out(tree.roots(depth), _NumberedRings(rings, depth), levels, field)
    bridges = [*(bridge for line in lines.values() for bridge in line), *bridges]
    tree = _grown(_SeparateRings(known, BridgeForest(len(rings)), areas), bridges, levels, field)
    return _strokes(
        WalkedTree(rings, depth, tree, filling.detours, KeptWalls(field, levels[0].distance), step), options, lines
    )


def _grown(
    apart: _SeparateRings, bridges: Sequence[RingBridge], levels: Sequence[OffsetLevel], field: DistanceField
) -> BridgeForest:
    for bridge in bridges:
        apart.tree.add(bridge)
    _join_across(levels, apart, field)
    return apart.tree


def _lines_out(
    roots: Sequence[int], walked: _NumberedRings, levels: Sequence[OffsetLevel], field: DistanceField
) -> dict[int, list[RingBridge]]:
    """Return the straight line of bridges from each root out to the outermost level, innermost first; roots without one
    have none.
    """
    deep = max((walked.depth[root] for root in roots), default=0.0)
    first, targets = 0, []
    for k, level in enumerate(levels):
        if k < deep:
            targets.append((level.distance, RingField.of(level.rings, first)))
        first += len(level.rings)
    counts = np.array([min(math.ceil(walked.depth[root]), len(targets)) for root in roots], np.int64)
    return outward({root: walked.rings[root] for root in roots}, counts, targets, field)


def link_by_proof(
    levels: Sequence[OffsetLevel], field: DistanceField, direction: Direction, spacing: float
) -> tuple[Stroke, ...]:
    """Return few strokes through rings that are no exact levels, such as those of pixels.

    Between such rings no bridge is clear by construction, so every bridge, shortest first, is proven clear step by
    step.

    Args:
        levels: rings of the pocket tool, outermost first; bridges keep the outermost one's distance.
        field: distances from the walls.
        spacing: between points of rings that bridges may begin at, mm.
    """
    rings = [ring for level in levels for ring in level.rings]
    tree = BridgeForest(len(rings))
    if levels:
        apart = _SeparateRings(RingEdges(rings), tree, sum(ring.area > 0 for ring in levels[0].rings))
        _join(range(len(rings)), apart, KeptWalls(field, levels[0].distance), spacing, _TRIED)
    depth = [float(k) for k, level in enumerate(levels) for _ in level.rings]
    return _strokes(
        WalkedTree(rings, depth, tree, (), KeptWalls(field, levels[0].distance if levels else 0.0)),
        LinkOptions(direction),
        {},
    )


def _strokes(walked: WalkedTree, options: LinkOptions, lines: Mapping[int, Sequence[RingBridge]]) -> tuple[Stroke, ...]:
    """Return the walks through all trees of a forest.

    Args:
        lines: bridges that a tree's walk goes along, by root; the longest way through the tree where there are none.
    """
    walk = TreeWalk(walked, options.direction, options.outside_in)
    return tuple(walk.stroke(root, lines.get(root, ())) for root in walked.tree.roots(walked.depth))


@dataclass(frozen=True)
class _NumberedRings:
    """All rings, and how far inside each is: the number of its level."""

    rings: Sequence[Ring]
    depth: Sequence[float]


@dataclass
class _SeparateRings:
    """Rings that should be in as many groups as there are connected areas.

    Attributes:
        edges: of all of them. tree: over them.
        areas: rings of the outermost level that turn left.
    """

    edges: RingEdges
    tree: BridgeForest
    areas: int

    @property
    def too_many(self) -> int:
        """Groups more than there are areas."""
        return len({self.tree.group(k) for k in range(len(self.edges.rings))}) - self.areas


def _join_across(levels: Sequence[OffsetLevel], apart: _SeparateRings, field: DistanceField) -> None:
    """Join what bridges from level to level left apart, over ridges: between rings with nothing inside, outermost ones,
    or any.
    """
    depth = [k for k, level in enumerate(levels) for _ in level.rings]
    tops = [
        k
        for k in range(len(depth))
        if all(there.ring >= len(depth) or depth[there.ring] <= depth[k] for _, there, _ in apart.tree.neighbours[k])
    ]
    for some in (tops, range(len(levels[0].rings)), range(len(apart.edges.rings))):
        _join(some, apart, KeptWalls(field, levels[0].distance), levels[0].distance / 4)


def _join(
    some: Sequence[int], apart: _SeparateRings, walls: KeptWalls, spacing: float, tried: int | None = None
) -> None:
    """Join groups of rings by the shortest bridges between some of them that are clear, until there are no more than
    areas.

    Args:
        walls: that bridges keep off.
        spacing: between points that bridges may begin at, mm.
        tried: bridges between two rings that are looked at; None = all.
    """
    too_many = apart.too_many
    if too_many <= 0 or len(some) < 2:
        return
    for bridge, (a, b) in level_bridges(apart.edges, some, apart.tree.group, spacing, tried):
        if walls.is_clear(a, b):
            apart.tree.add(bridge)
            too_many -= 1
            if too_many == 0:
                return


# The walk through a tree of rings: each ring once, the bridges of the longest way once, all others there and back.
#
# From the first ring the walk goes along the longest way of the tree: round a ring back to where it was entered, then
# straight on to the next. What hangs beside is an excursion from where its bridge begins: there, all of it, and back.
# Where rings cover twice what lies between them such a way there and back is two slants, which leave a piece of the
# outer ring out.


@dataclass(frozen=True, eq=False)
class WalkedTree:
    """What is walked.

    Attributes:
        rings: all of them.
        depth: (n,) how far inside each is: number of its level.
        tree: bridges between them.
        trips: from places of rings and back.
        walls: that all ways keep off.
        step: between levels no farther apart than the tool's radius, mm; 0 = farther: every ring is walked whole.
    """

    rings: Sequence[Ring]
    depth: Sequence[float]
    tree: BridgeForest
    trips: Sequence[Detour]
    walls: KeptWalls
    step: float = 0.0


@dataclass(frozen=True, eq=False)
class _Excursion:
    """Over a bridge to all that hangs there, and back.

    Attributes:
        here, there: where the bridge begins and ends.
        leave, back: (2,) where the ring here is left, and come back to.
        left: of the ring there before and after `there`, what is left out, in rows.
        slants: True where its ways cut what is left out.
    """

    here: RingPlace
    there: RingPlace
    leave: Rows
    back: Rows
    left: tuple[float, float]
    slants: bool


@dataclass(eq=False)
class _Visit:
    """A ring being walked: pieces still to go, each followed by an excursion over a bridge.

    Attributes:
        first, last: (2,) where it begins and ends.
        way_back: to the ring that it was come to from, and whether that cuts.
    """

    pieces: list[tuple[Rows, _Excursion | Detour | None]]
    first: Rows
    last: Rows
    way_back: tuple[Rows, bool] | None = None


class TreeWalk:
    """Makes strokes of trees."""

    def __init__(self, walked: WalkedTree, direction: Direction, outside_in: bool) -> None:
        self._walked, self._climb, self._outside_in = walked, direction is Direction.CLIMB, outside_in
        self._trips: dict[int, list[Detour]] = {}
        for detour in walked.trips:
            self._trips.setdefault(detour.place.ring, []).append(detour)
        self._rows: list[Rows] = []
        self._cuts: list[NDArray[np.bool_]] = []

    def stroke(self, root: int, line: Sequence[RingBridge]) -> Stroke:
        """Return the walk through the whole tree that holds `root`, which it begins at; outside-in it ends there.

        Args:
            line: bridges from the root on, one ring after the other, that are gone once; none = the longest way.
        """
        self._rows, self._cuts = [], []
        way: list[tuple[int, Edge | None]] = [(bridge.a.ring, (bridge.a, bridge.b, bridge.length)) for bridge in line]
        way = [*way, (line[-1].b.ring, None)] if line else self._walked.tree.longest_way(root)
        ahead = np.cumsum([edge[2] if edge else 0.0 for _, edge in way][::-1])[::-1]
        entry, came_from = way[0][1][0] if way[0][1] else RingPlace(root, 0, 0.0), None
        for k, (ring, edge) in enumerate(way):
            leave = self._leave(entry, edge, float(ahead[k])) if edge else None
            self._round(entry, came_from, edge if leave else None)
            if leave is None:
                break
            rows, there = leave
            self._append(rows, np.zeros(len(rows), np.bool_))
            entry, came_from = there, RingPlace(ring, edge[0].row if edge else 0, edge[0].fraction if edge else 0.0)
        cuts = np.concatenate(self._cuts)
        last = int(np.flatnonzero(cuts)[-1]) + 1
        path = joined(np.concatenate(self._rows)[:last])
        purpose = np.where(cuts[:last], Purpose.POCKET, Purpose.LINK).astype(np.uint8)
        region = self._walked.rings[root].region
        return (
            Stroke(reversed_rows(path), purpose[::-1].copy(), region)
            if self._outside_in
            else Stroke(path, purpose, region)
        )

    def _append(self, rows: Rows, cuts: NDArray[np.bool_]) -> None:
        self._rows.append(rows)
        self._cuts.append(cuts)

    def _leave(self, entry: RingPlace, edge: Edge, ahead: float) -> tuple[Rows, RingPlace] | None:
        """Return (the shortest way from a place of a ring to the next one, where it comes to), None if back and forth
        is shorter.

        Args:
            edge: the bridge to the next ring.
            ahead: length of all bridges from here on, mm.
        """
        here, there, length = edge
        ring, start = self._walked.rings[entry.ring].rows, point_of(self._walked.rings[entry.ring].rows, entry)
        away, place = nearest_on(self._walked.rings[there.ring], there.ring, start)
        end = point_of(self._walked.rings[there.ring].rows, place)
        count = len(ring)
        gone = span(ring, *sorted((position(entry, count, forward=True), position(here, count, forward=True))))
        other = span(
            ring,
            max(position(entry, count, forward=True), position(here, count, forward=True)),
            min(position(entry, count, forward=True), position(here, count, forward=True)) + count,
        )
        along = min((gone, other), key=lambda rows: path_length(rows))
        again = path_length(along)
        if away <= min(again + length, ahead) + LEVEL and self._walked.walls.is_clear(start, end):
            return straight(start, end), place
        if again > ahead:
            return None
        if again > 0 and np.hypot(*(along[0, :2] - start)) > np.hypot(*(along[-1, 2:4] - start)):
            along = reversed_rows(along)
        bridge = straight(point_of(ring, here), point_of(self._walked.rings[there.ring].rows, there))
        return np.concatenate([along, bridge]), there

    def _round(self, entry: RingPlace, came_from: RingPlace | None, after: Edge | None) -> None:
        """Append a ring from its entry back to it, with all that hangs on it but the bridge that is taken after it."""
        stack = [self._visit(entry, came_from, after)]
        while stack:
            visit = stack[-1]
            if not visit.pieces:
                stack.pop()
                if visit.way_back is not None:
                    self._append(visit.way_back[0], np.full(1, visit.way_back[1]))
                continue
            piece, excursion = visit.pieces.pop(0)
            self._append(piece, np.ones(len(piece), np.bool_))
            if isinstance(excursion, Detour):
                backwards = self._outside_in
                self._append(
                    reversed_rows(excursion.rows) if backwards else excursion.rows,
                    (excursion.cuts[::-1] if backwards else excursion.cuts),
                )
            elif excursion is not None:
                stack.append(self._visit(excursion.there, excursion.here, None, excursion.left))
                stack[-1].way_back = straight(stack[-1].last, excursion.back), excursion.slants
                self._append(straight(excursion.leave, stack[-1].first), np.full(1, excursion.slants))

    def _visit(
        self, entry: RingPlace, came_from: RingPlace | None, after: Edge | None, left: tuple[float, float] | None = None
    ) -> _Visit:
        """Cut a ring into pieces between its bridges, all round from `entry`; a bridge at the entry comes last.

        Args:
            left: before and after the entry, what an excursion leaves out, in rows of the ring's own direction; None on
                the main way.
        """
        number = entry.ring
        rows, count = self._walked.rings[number].rows, len(self._walked.rings[number].rows)
        forward = self._forward(number, came_from, after, main=left is None)
        edges = [
            (a, b)
            for a, b, _ in self._walked.tree.neighbours[number]
            if (came_from is None or b.ring != came_from.ring) and (after is None or b.ring != after[1].ring)
        ]
        detours = self._trips.get(number, [])
        taken = [entry, *(a for a, _ in edges), *(detour.place for detour in detours)]
        if not forward:
            rows = reversed_rows(rows)
        start = position(entry, count, forward)
        stops: list[tuple[float, float, float, _Excursion | Detour]] = []
        for k, (a, b) in enumerate(edges):
            at = (position(a, count, forward) - start) % count or count
            here, there = self._left_out(a, b, [*taken[: k + 1], *taken[k + 2 :]])
            before, beyond = here if forward else here[::-1]
            leave, back = point_at(rows, start + at - before), point_at(rows, start + at + beyond)
            stops.append((at, before, beyond, _Excursion(a, b, leave, back, there, here != there)))
        stops += [
            ((position(detour.place, count, forward) - start) % count or count, 0.0, 0.0, detour) for detour in detours
        ]
        before, done = (left or (0.0, 0.0)) if forward else (left or (0.0, 0.0))[::-1]
        visit = _Visit([], point_at(rows, start + done), point_at(rows, start + count - before))
        for at, back_off, beyond, stop in sorted(stops, key=lambda each: each[0]):
            visit.pieces.append((span(rows, start + done, start + at - back_off), stop))
            done = at + beyond
        visit.pieces.append((span(rows, start + done, start + count - before), None))
        return visit

    def _left_out(
        self, here: RingPlace, there: RingPlace, taken: Sequence[RingPlace]
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return what an excursion leaves out before and after each end of its bridge, in rows of the rings' own
        directions.
        """
        walked, none = self._walked, (0.0, 0.0)
        outer, inner = (here, there) if walked.depth[here.ring] < walked.depth[there.ring] else (there, here)
        if not walked.step or walked.depth[inner.ring] - walked.depth[outer.ring] != 1 or walked.depth[outer.ring] < 1:
            return none, none
        if outer is there:
            taken = [a for a, b, _ in walked.tree.neighbours[there.ring] if b.ring != here.ring]
        rows = walked.rings[outer.ring].rows
        apex = point_of(walked.rings[inner.ring].rows, inner)
        left = left_out(rows, outer, apex, room_beside(rows, outer, taken), walked)
        return (left, none) if outer is here else (none, left)

    def _forward(self, ring: int, came_from: RingPlace | None, after: Edge | None, main: bool) -> bool:
        """Tell whether a ring is walked in its own direction, in which the walls' side is to the right.

        Metal stands on the walls' side where a ring is come to from inside, else inside it. Outside-in the walk is
        turned round at the end, so along the longest way a ring is come to from where this walk goes on to.
        """
        depth = self._walked.depth
        before = came_from.ring if came_from else None
        if self._outside_in and main:
            before = after[1].ring if after else None
        inner = self._outside_in if before is None else depth[before] < depth[ring]
        return (inner == self._climb) if self._outside_in else (inner != self._climb)


# Slants: ways there and back between two rings that leave out a piece of the outer one and cut what it would have cut.
#
# Where levels are no farther apart than the tool's radius, every point between two levels is cut by the outer one: by
# the ring's point y on the way to the nearest wall. So when a piece of a ring is left out, only what lies within a
# step inwards of it is still to be cut, and its rows, moved inwards by the step, bound all of that. A straight way
# cuts whatever it comes within the radius of, which is convex: it cuts a row's whole strip when it comes as near to
# the strip's corners. The outermost level's rings have nothing outside them that cuts their walls' side, and stay
# whole.


_LONGEST = (4.0, 3.0, 2.0, 1.5, 1.0, 0.5)
"""Steps along the ring that a slant takes on either side; the longer the less way it costs."""

_SPARE = 1e-3
"""Of the step: so much nearer than it slants come to all that they have to cut."""

_WIDEST = 0.5 * np.pi
"""Radians; along arcs that turn more no piece is left out."""

Floats = NDArray[np.float64]


def left_out(
    rows: Rows, place: RingPlace, apex: Floats, room: tuple[float, float], walked: WalkedTree
) -> tuple[float, float]:
    """Return how much of a ring before and after a place slants to a point of the ring inside it leave out, in rows.

    Args:
        rows: of the outer ring, in its own direction: walls are on the right.
        place: where the bridge to the inner ring begins.
        apex: (2,) where it ends.
        room: before and after the place that may be left out, mm.
        walked: whose walls are kept off, and whose step it is between levels.
    """
    step, at, found = walked.step, place.row + place.fraction, [0.0, 0.0]
    for side, sign in enumerate((-1.0, 1.0)):
        for share in _LONGEST:
            if share * step > room[side]:
                continue
            end = along(rows, at, sign * share * step)
            start = point_at(rows, end)
            if covers(start, apex, span(rows, *sorted((at, end))), step) and walked.walls.is_clear(start, apex):
                found[side] = abs(end - at)
                break
    return found[0], found[1]


def covers(a: Floats, b: Floats, rows: Rows, step: float) -> bool:
    """Tell whether a straight way cuts all that some rows cut within a step to their left, by a tool of a radius of
    that or more.
    """
    if np.any(np.abs(sweeps(rows)) > _WIDEST):
        return False
    corners = _corners(rows, step)
    ahead = b - a
    part = np.clip((corners - a) @ ahead / float(ahead @ ahead), 0.0, 1.0)
    return bool(np.all(np.hypot(*(corners - a - part[:, None] * ahead).T) <= step * (1 - _SPARE)))


def _corners(rows: Rows, step: float) -> Floats:
    """Return points whose hull holds the strip of a step to the left of each row; no arc's strip goes past its
    centre.
    """
    bent = rows[:, TURN] != 0
    wide = np.where(bent & (rows[:, TURN] > 0), np.minimum(step, rows[:, R]), step)[:, None]
    ends = [(rows[:, 2 * k : 2 * k + 2], left_of(headings_at(rows, np.full(len(rows), float(k))))) for k in (0, 1)]
    corners = [point + width * aside for point, aside in ends for width in (0.0, wide)]
    arcs, half = rows[bent], np.abs(sweeps(rows[bent])) / 2
    middle = -arcs[:, [TURN]] * left_of(headings_at(arcs, np.full(len(arcs), 0.5)))
    outer = arcs[:, R] + np.where(arcs[:, TURN] < 0, step, 0.0)
    return np.concatenate([*corners, arcs[:, [CX, CY]] + middle * (outer / np.cos(half))[:, None]])


def room_beside(rows: Rows, place: RingPlace, others: Sequence[RingPlace]) -> tuple[float, float]:
    """Return how much of a ring before and after a place is its own, mm: half the way to the next other place, at most
    a quarter round.
    """
    size = lengths(rows)
    ends = np.append(0.0, np.cumsum(size))
    total = float(ends[-1])
    where = np.array([ends[other.row] + other.fraction * size[other.row] for other in (place, *others)])
    after, before = (where[1:] - where[0]) % total, (where[0] - where[1:]) % total
    return (min(total / 4, float(before.min(initial=total)) / 2), min(total / 4, float(after.min(initial=total)) / 2))
