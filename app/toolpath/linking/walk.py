"""The walk through a tree of rings: each ring once, the bridges of the longest way once, all others there and back.

From the first ring the walk goes along the longest way of the tree: round a ring back to where it was entered, then
straight on to the next. What hangs beside is an excursion from where its bridge begins: there, all of it, and back.
Where rings cover twice what lies between them such a way there and back is two slants, which leave a piece of the outer
ring out (`link_slant.py`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.tolerances import LEVEL
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import Ring
from ...geometry.primitives import Rows, path_length, reversed_rows
from ...model.moves import Purpose
from ...model.operation import Direction
from ..build import Stroke
from .bridge import RingBridge, is_clear, nearest_on
from .rows import RingPlace, joined, point_at, point_of, position, span, straight
from .runs import Detour
from .slant import left_out, room_beside
from .tree import BridgeForest, Edge


@dataclass(frozen=True, eq=False)
class WalkedTree:
    """What is walked.

    Attributes:
        rings: all of them.
        depth: (n,) how far inside each is: number of its level.
        tree: bridges between them.
        trips: from places of rings and back.
        walls: distances that are kept, and how much, mm.
        step: between levels no farther apart than the tool's radius, mm; 0 = farther: every ring is walked whole.
    """

    rings: Sequence[Ring]
    depth: Sequence[float]
    tree: BridgeForest
    trips: Sequence[Detour]
    walls: tuple[DistanceField, float]
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
        gone = span(ring, *sorted((position(entry, count, True), position(here, count, True))))
        other = span(
            ring,
            max(position(entry, count, True), position(here, count, True)),
            min(position(entry, count, True), position(here, count, True)) + count,
        )
        along = min((gone, other), key=lambda rows: path_length(rows))
        again = path_length(along)
        if away <= min(again + length, ahead) + LEVEL and is_clear(
            self._walked.walls[0], start, end, self._walked.walls[1]
        ):
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
        left = left_out(rows, outer, apex, room_beside(rows, outer, taken), (*walked.walls, walked.step))
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
