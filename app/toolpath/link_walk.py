"""The walk through a tree of rings: each ring once, the bridges of the longest way once, all others there and back.

From the first ring the walk goes along the longest way of the tree: round a ring back to where it was entered, then straight
on to the next. What hangs beside is an excursion from where its bridge begins: there, all of it, and back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.geometry.distance import DistanceField
from app.geometry.offset import Ring
from app.geometry.primitives import Rows, lengths, reversed_rows
from app.model.moves import Purpose
from app.model.operation import Direction
from app.tolerances import LEVEL
from app.toolpath.bridge import Bridge, RingField, is_clear
from app.toolpath.build import Stroke
from app.toolpath.link_rows import Place, joined, point_of, position, span, straight
from app.toolpath.link_tree import Edge, Tree
from app.toolpath.runs import Trip


@dataclass(frozen=True, eq=False)
class Walked:
    """What is walked.

    Attributes:
        rings: all of them.
        depth: (n,) how far inside each is: number of its level.
        tree: bridges between them.
        trips: from places of rings and back.
        walls: distances that are kept, and how much, mm.
    """

    rings: Sequence[Ring]
    depth: Sequence[float]
    tree: Tree
    trips: Sequence[Trip]
    walls: tuple[DistanceField, float]


@dataclass
class _Visit:
    """A ring being walked: pieces still to go, each followed by an excursion over a bridge."""

    pieces: list[tuple[Rows, tuple[Place, Place] | Trip | None]]
    way_back: Rows | None


class Walk:
    """Makes strokes of trees."""

    def __init__(self, walked: Walked, direction: Direction, outside_in: bool) -> None:
        self._walked, self._climb, self._outside_in = walked, direction is Direction.CLIMB, outside_in
        self._trips: dict[int, list[Trip]] = {}
        for trip in walked.trips:
            self._trips.setdefault(trip.place.ring, []).append(trip)
        self._rows: list[Rows] = []
        self._cuts: list[NDArray[np.bool_]] = []

    def stroke(self, root: int, line: Sequence[Bridge]) -> Stroke:
        """Return the walk through the whole tree that holds `root`, which it begins at; outside-in it ends there.

        Args:
            line: bridges from the root on, one ring after the other, that are gone once; none = the longest way.
        """
        self._rows, self._cuts = [], []
        way: list[tuple[int, Edge | None]] = [(bridge.a.ring, (bridge.a, bridge.b, bridge.length)) for bridge in line]
        way = [*way, (line[-1].b.ring, None)] if line else self._walked.tree.longest_way(root)
        ahead = np.cumsum([edge[2] if edge else 0.0 for _, edge in way][::-1])[::-1]
        entry, came_from = way[0][1][0] if way[0][1] else Place(root, 0, 0.0), None
        for k, (ring, edge) in enumerate(way):
            leave = self._leave(entry, edge, float(ahead[k])) if edge else None
            self._round(entry, came_from, edge if leave else None)
            if leave is None:
                break
            rows, there = leave
            self._append(rows, np.zeros(len(rows), np.bool_))
            entry, came_from = there, Place(ring, edge[0].row if edge else 0, edge[0].fraction if edge else 0.0)
        cuts = np.concatenate(self._cuts)
        last = int(np.flatnonzero(cuts)[-1]) + 1
        path = joined(np.concatenate(self._rows)[:last])
        purpose = np.where(cuts[:last], Purpose.POCKET, Purpose.LINK).astype(np.uint8)
        region = self._walked.rings[root].region
        return Stroke(reversed_rows(path), purpose[::-1].copy(), region) if self._outside_in else Stroke(path, purpose, region)

    def _append(self, rows: Rows, cuts: NDArray[np.bool_]) -> None:
        self._rows.append(rows)
        self._cuts.append(cuts)

    def _leave(self, entry: Place, edge: Edge, ahead: float) -> tuple[Rows, Place] | None:
        """Return (the shortest way from a place of a ring to the next one, where it comes to), None if back and forth is shorter.

        Args:
            edge: the bridge to the next ring.
            ahead: length of all bridges from here on, mm.
        """
        here, there, length = edge
        ring, start = self._walked.rings[entry.ring].rows, point_of(self._walked.rings[entry.ring].rows, entry)
        away, place, end = RingField.of([self._walked.rings[there.ring]], there.ring).nearest(start)
        count = len(ring)
        gone = span(ring, *sorted((position(entry, count, True), position(here, count, True))))
        other = span(ring, max(position(entry, count, True), position(here, count, True)),
                     min(position(entry, count, True), position(here, count, True)) + count)
        along = min((gone, other), key=lambda rows: float(lengths(rows).sum()))
        again = float(lengths(along).sum())
        if away <= min(again + length, ahead) + LEVEL and is_clear(self._walked.walls[0], start, end, self._walked.walls[1]):
            return straight(start, end), place
        if again > ahead:
            return None
        if again > 0 and np.hypot(*(along[0, :2] - start)) > np.hypot(*(along[-1, 2:4] - start)):
            along = reversed_rows(along)
        bridge = straight(point_of(ring, here), point_of(self._walked.rings[there.ring].rows, there))
        return np.concatenate([along, bridge]), there

    def _round(self, entry: Place, came_from: Place | None, after: Edge | None) -> None:
        """Append a ring from its entry back to it, with all that hangs on it but the bridge that is taken after it."""
        stack = [self._visit(entry, came_from, after, main=True)]
        while stack:
            visit = stack[-1]
            if not visit.pieces:
                stack.pop()
                if visit.way_back is not None:
                    self._append(visit.way_back, np.zeros(1, np.bool_))
                continue
            piece, excursion = visit.pieces.pop(0)
            self._append(piece, np.ones(len(piece), np.bool_))
            if isinstance(excursion, Trip):
                backwards = self._outside_in
                self._append(reversed_rows(excursion.rows) if backwards else excursion.rows,
                             (excursion.cuts[::-1] if backwards else excursion.cuts))
            elif excursion is not None:
                here, there = excursion
                out = straight(*(point_of(self._walked.rings[place.ring].rows, place) for place in excursion))
                self._append(out, np.zeros(1, np.bool_))
                stack.append(self._visit(there, here, None, main=False))
                stack[-1].way_back = reversed_rows(out)

    def _visit(self, entry: Place, came_from: Place | None, after: Edge | None, main: bool) -> _Visit:
        """Cut a ring into pieces between its bridges, all round from `entry`; a bridge at the entry comes last."""
        number = entry.ring
        rows, count = self._walked.rings[number].rows, len(self._walked.rings[number].rows)
        forward = self._forward(number, came_from, after, main)
        if not forward:
            rows = reversed_rows(rows)
        start = position(entry, count, forward)
        beside: list[tuple[Place, tuple[Place, Place] | Trip]] = [
            (a, (a, b)) for a, b, _ in self._walked.tree.neighbours[number]
            if (came_from is None or b.ring != came_from.ring) and (after is None or b.ring != after[1].ring)]
        beside += [(trip.place, trip) for trip in self._trips.get(number, ())]
        ahead = sorted((((position(place, count, forward) - start) % count or count, k) for k, (place, _) in enumerate(beside)))
        pieces: list[tuple[Rows, tuple[Place, Place] | Trip | None]] = []
        done = 0.0
        for gone, k in ahead:
            pieces.append((span(rows, start + done, start + gone), beside[k][1]))
            done = gone
        pieces.append((span(rows, start + done, start + count), None))
        return _Visit(pieces, None)

    def _forward(self, ring: int, came_from: Place | None, after: Edge | None, main: bool) -> bool:
        """Tell whether a ring is walked in its own direction, in which the walls' side is to the right.

        Metal stands on the walls' side where a ring is come to from inside, else inside it. Outside-in the walk is turned
        round at the end, so along the longest way a ring is come to from where this walk goes on to.
        """
        depth = self._walked.depth
        before = came_from.ring if came_from else None
        if self._outside_in and main:
            before = after[1].ring if after else None
        inner = self._outside_in if before is None else depth[before] < depth[ring]
        return (inner == self._climb) if self._outside_in else (inner != self._climb)
