"""One stroke: rings joined by a tree of bridges, and walked so that the tool never lifts (step 143).

The walk starts on the innermost ring and goes outwards where it can, so the tool widens what is already cut. A ring
that is reached from inside has its metal on the wall side, one reached from outside has it inside: climb milling takes
the first in the ring's own direction and the second the other way round.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from app.geometry.distance import DistanceField
from app.geometry.offset import Level, Ring
from app.geometry.primitives import Rows, points_at, reversed_rows
from app.model.moves import Purpose
from app.model.operation import Direction
from app.toolpath.bridge import Bridge, Place, inward_bridges, is_clear, level_bridges
from app.toolpath.build import Stroke, split_row

_SAME = 1e-9  # fraction of a row

_TRIED = 32
"""Bridges between two rings that are looked at before they are taken to have none."""


def link(levels: Sequence[Level], field: DistanceField, direction: Direction) -> tuple[Stroke, ...]:
    """Return as few strokes as there are connected areas that the tool's centre can be in.

    Args:
        levels: rings of the pocket tool, outermost first.
        field: distances from the drawing.
    """
    tree = _Tree(sum(len(level.rings) for level in levels))
    for bridge in inward_bridges(levels, field):
        tree.add(bridge)
    if levels:
        _join_across(levels[0], tree, field)
    return _strokes(levels, tree, direction)


def link_by_proof(levels: Sequence[Level], field: DistanceField, direction: Direction, spacing: float) -> tuple[Stroke, ...]:
    """Return few strokes through rings that are no exact levels, such as those of pixels.

    Between such rings no bridge is clear by construction, so every bridge, shortest first, is proven clear step by step.

    Args:
        levels: rings of the pocket tool, outermost first; bridges keep the outermost one's distance.
        field: distances from the walls.
        spacing: between points of rings that bridges may begin at, mm.
    """
    rings = [ring for level in levels for ring in level.rings]
    tree = _Tree(len(rings))
    too_many = len(rings) - sum(ring.area > 0 for ring in levels[0].rings) if levels else 0
    for bridge, (a, b) in level_bridges(rings, range(len(rings)), spacing, _TRIED) if too_many > 0 else ():
        if not tree.joined(bridge) and is_clear(field, a, b, levels[0].distance):
            tree.add(bridge)
            too_many -= 1
            if too_many == 0:
                break
    return _strokes(levels, tree, direction)


def _strokes(levels: Sequence[Level], tree: _Tree, direction: Direction) -> tuple[Stroke, ...]:
    """Return the walks through all trees of a forest over the rings of some levels."""
    rings = [ring for level in levels for ring in level.rings]
    depth = [k for k, level in enumerate(levels) for _ in level.rings]
    walk = _Walk(rings, depth, tree.neighbours, direction)
    return tuple(walk.stroke(root) for root in _roots(tree, depth))


def _join_across(outermost: Level, tree: _Tree, field: DistanceField) -> None:
    """Join what the inner levels left apart, over the ridges between rings of the outermost level.

    There are as many connected areas as rings that turn left; when no more groups are left, all are joined.
    """
    rings = outermost.rings
    groups = [tree.group(k) for k in range(len(rings))]
    too_many = len(set(groups)) - sum(ring.area > 0 for ring in rings)
    if too_many <= 0:
        return
    for bridge, (a, b) in level_bridges(rings, groups, outermost.distance / 4):
        if not tree.joined(bridge) and is_clear(field, a, b, outermost.distance):
            tree.add(bridge)
            too_many -= 1
            if too_many == 0:
                return


def _point(rings: Sequence[Ring], place: Place) -> Rows:
    point: Rows = points_at(rings[place.ring].rows[place.row][None], np.array([place.fraction]))[0]
    return point


def _roots(tree: _Tree, depth: Sequence[int]) -> list[int]:
    """Return the innermost ring of each connected group."""
    best: dict[int, int] = {}
    for ring in range(len(depth)):
        group = tree.group(ring)
        if group not in best or depth[ring] > depth[best[group]]:
            best[group] = ring
    return list(best.values())


class _Tree:
    """A forest over the rings, grown by bridges that join what was apart (Kruskal)."""

    def __init__(self, count: int) -> None:
        self._parent = list(range(count))
        self.neighbours: list[list[tuple[Place, Place]]] = [[] for _ in range(count)]

    def group(self, ring: int) -> int:
        """Return the number of the group that a ring is in."""
        while self._parent[ring] != ring:
            self._parent[ring] = self._parent[self._parent[ring]]
            ring = self._parent[ring]
        return ring

    def joined(self, bridge: Bridge) -> bool:
        """Tell whether both ends are in one group already."""
        return self.group(bridge.a.ring) == self.group(bridge.b.ring)

    def add(self, bridge: Bridge) -> None:
        """Take a bridge unless it would close a loop."""
        if self.joined(bridge):
            return
        self._parent[self.group(bridge.a.ring)] = self.group(bridge.b.ring)
        self.neighbours[bridge.a.ring].append((bridge.a, bridge.b))
        self.neighbours[bridge.b.ring].append((bridge.b, bridge.a))


@dataclass
class _Visit:
    """A ring being walked: blocks of rows still to cut, each followed by an excursion over a bridge."""

    blocks: list[tuple[Rows, tuple[Place, Place] | None]]
    way_back: Rows | None


class _Walk:
    def __init__(self, rings: Sequence[Ring], depth: Sequence[int], neighbours: Sequence[Sequence[tuple[Place, Place]]],
                 direction: Direction) -> None:
        self._rings, self._depth, self._neighbours, self._direction = rings, depth, neighbours, direction

    def stroke(self, root: int) -> Stroke:
        """Return the walk through the whole tree that holds `root`, ending with the last cut."""
        exits = self._neighbours[root]
        entry = exits[0][0] if exits else Place(root, 0, 0.0)
        rows: list[Rows] = []
        links: list[bool] = []
        stack = [self._visit(entry, came_from=None)]
        while stack:
            visit = stack[-1]
            if not visit.blocks:
                stack.pop()
                if visit.way_back is not None:
                    rows.append(visit.way_back)
                    links.append(True)
                continue
            block, excursion = visit.blocks.pop(0)
            rows.extend(block[:, None])
            links.extend([False] * len(block))
            if excursion is not None:
                here, there = excursion
                out = self._bridge(here, there)
                rows.append(out)
                links.append(True)
                stack.append(self._visit(there, here, reversed_rows(out)))
        last = max(k for k, is_link in enumerate(links) if not is_link) + 1
        path = np.concatenate(rows[:last])
        purpose = np.where(links[:last], Purpose.LINK, Purpose.POCKET).astype(np.uint8)
        return Stroke(_joined(path), purpose, self._rings[root].region)

    def _bridge(self, here: Place, there: Place) -> Rows:
        a, b = _point(self._rings, here), _point(self._rings, there)
        return np.array([[*a, *b, 0.0, 0.0, 0.0, 0.0]])

    def _visit(self, entry: Place, came_from: Place | None, way_back: Rows | None = None) -> _Visit:
        """Cut a ring into blocks between its bridges, all round from `entry`; a bridge at the entry comes last."""
        rows = self._rings[entry.ring].rows
        count = len(rows)
        exits = [(a, b) for a, b in self._neighbours[entry.ring] if (a, b) != (entry, came_from)]
        inwards = came_from is not None and self._depth[came_from.ring] < self._depth[entry.ring]
        forward = inwards != (self._direction is Direction.CLIMB)
        if not forward:
            rows = reversed_rows(rows)
        start = _position(entry, count, forward)
        ahead = [((_position(a, count, forward) - start) % count or count, (a, b)) for a, b in exits]
        ahead.sort(key=lambda item: item[0])
        blocks: list[tuple[Rows, tuple[Place, Place] | None]] = []
        done = 0.0
        for gone, excursion in ahead:
            blocks.append((_span(rows, start + done, start + gone), excursion))
            done = gone
        blocks.append((_span(rows, start + done, start + count), None))
        return _Visit(blocks, way_back)


def _position(place: Place, count: int, forward: bool) -> float:
    """Return where a place is along a ring of `count` rows, in rows from its beginning."""
    position = place.row + place.fraction
    return position if forward else count - position


def _span(rows: Rows, start: float, end: float) -> Rows:
    """Return a closed ring's rows from one position to another, going on past its beginning."""
    count = len(rows)
    parts = []
    for k in range(math.floor(start), math.ceil(end)):
        part = _part(rows[k % count], max(start - k, 0.0), min(end - k, 1.0))
        parts.append(part)
    return np.concatenate(parts) if parts else rows[:0]


def _part(row: Rows, start: float, end: float) -> Rows:
    """Return a row from one fraction to another as (1, 8), or nothing where they are the same."""
    if end - start < _SAME:
        return row[None][:0]
    if end < 1:
        row = split_row(row, end)[0]
    if start > 0:
        row = split_row(row, start / end)[1]
    return row[None]


def _joined(rows: Rows) -> Rows:
    """Make each row begin exactly where the one before ends (bridges meet rings within rounding)."""
    rows = rows.copy()
    rows[1:, :2] = rows[:-1, 2:4]
    return rows
