"""Walk from curve to curve: which end goes on where, also at points where three or more meet."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...model.curves import Circle, Line, Point, Primitive
from .pieces import ChainPiece

Nodes = NDArray[np.int64]


class Step(NamedTuple):
    """A piece by its number, and whether it is travelled forward."""

    piece: int
    forward: bool


class PiecePath(NamedTuple):
    """Pieces one after the other, and whether they close."""

    steps: list[Step]
    closed: bool


class TracedPaths(NamedTuple):
    """Every path, by its first piece, and every point where more than two ends meet."""

    paths: list[PiecePath]
    branches: list[Junction]


@dataclass(frozen=True)
class Junction:
    """A point where more than two ends meet.

    Attributes:
        place: where, mm.
        entity_ids: the curves whose ends meet there, one for each end.
    """

    place: Point
    entity_ids: tuple[int, ...]

    @property
    def odd(self) -> bool:
        """Whether one end is left over when outlines pass through."""
        return len(self.entity_ids) % 2 == 1


def paths(pieces: Sequence[ChainPiece], nodes: Nodes) -> TracedPaths:
    """Return how the pieces go on in one another.

    End 2 k is the start of piece k and end 2 k + 1 its end.
    """
    at: dict[int, list[int]] = {}
    for end, node in enumerate(nodes.ravel().tolist()):
        if node >= 0:
            at.setdefault(node, []).append(end)
    partner: dict[int, int] = {}
    crowded = [ends for ends in at.values() if len(ends) > 2]
    spurs = _bridges(at) if crowded else set()
    for ends in at.values():
        couples = [(ends[0], ends[1])] if len(ends) == 2 else _couples(ends, pieces, spurs)
        for a, b in couples:
            partner[a], partner[b] = b, a
    found = [PiecePath([Step(k, True)], True) for k, piece in enumerate(pieces) if piece.is_circle]
    found += _walks(len(pieces), partner, {k for k, piece in enumerate(pieces) if piece.is_circle})
    return TracedPaths(sorted(found, key=lambda path: min(path.steps)), [_branch(pieces, ends) for ends in crowded])


def _branch(pieces: Sequence[ChainPiece], ends: Sequence[int]) -> Junction:
    first = pieces[ends[0] // 2]
    return Junction(first.start if ends[0] % 2 == 0 else first.end, tuple(pieces[end // 2].entity for end in ends))


def _walks(count: int, partner: dict[int, int], done: set[int]) -> list[PiecePath]:
    """Follow partners: first from ends that have none, then round the loops that are left."""
    found = []
    seen = set(done)
    loose = [end for end in range(2 * count) if end not in partner]
    for first in [*loose, *range(0, 2 * count, 2)]:
        if first // 2 in seen:
            continue
        steps: list[Step] = []
        end = first
        while end // 2 not in seen:
            seen.add(end // 2)
            steps.append(Step(end // 2, end % 2 == 0))
            if (end ^ 1) not in partner:
                break
            end = partner[end ^ 1]
        closed = first in partner
        found.append(PiecePath(steps if closed else _forward(steps), closed))
    return found


def _forward(steps: list[Step]) -> list[Step]:
    """Return an open path in the direction of the piece that was drawn first."""
    return steps if min(steps).forward else [Step(k, not forward) for k, forward in reversed(steps)]


class _CoupleCost(NamedTuple):
    """What speaks against two ends going on in one another, the weightiest first; and the ends."""

    spurs: int
    apart: int
    turn: float
    a: int
    b: int


def _couples(ends: list[int], pieces: Sequence[ChainPiece], spurs: set[int]) -> list[tuple[int, int]]:
    """Pair the ends that meet at one point.

    Curves that belong to a loop come before those that belong to none. Where an even number meets, a curve stays with
    the one that was drawn next from its end on (two outlines that touch stay two); else the smallest turn wins.
    """
    directions = {end: _away(pieces[end // 2], end % 2 == 0) for end in ends}

    def cost(a: int, b: int) -> _CoupleCost:
        (ax, ay), (bx, by) = directions[a], directions[b]
        turn = math.pi - abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
        apart = int(len(ends) % 2 == 1 or a % 2 == 0 or b != a + 1)
        return _CoupleCost((a // 2 in spurs) + (b // 2 in spurs), apart, round(turn, 9), a, b)

    couples = []
    free = set(ends)
    for *_, a, b in sorted(cost(a, b) for a in ends for b in ends if a < b):
        if a in free and b in free:
            couples.append((a, b))
            free -= {a, b}
    return couples


def _away(piece: ChainPiece, from_start: bool) -> Point:
    """Return the direction (of any length) in which a piece leaves one of its ends."""
    if from_start:
        return tangent(piece.primitives[0], True)
    x, y = tangent(piece.primitives[-1], False)
    return -x, -y


def tangent(primitive: Primitive, at_start: bool) -> Point:
    """Return the direction of travel (of any length) at the start or the end of a primitive."""
    if isinstance(primitive, Line):
        return primitive.end[0] - primitive.start[0], primitive.end[1] - primitive.start[1]
    x, y = primitive.start if at_start or isinstance(primitive, Circle) else primitive.end
    x, y = x - primitive.centre[0], y - primitive.centre[1]
    return (-y, x) if primitive.ccw else (y, -x)


def _bridges(at: dict[int, list[int]]) -> set[int]:
    """Return the pieces that lie on no loop: Tarjan (1974), "A note on finding the bridges of a graph", without
    recursion.
    """
    search = _BridgeSearch(at)
    return {piece for root in at if root not in search.order for piece in search.bridges_from(root)}


class _BridgeSearch:
    """A walk through a graph, deep first.

    Attributes:
        order: when each node was reached. low: the earliest node that is reached from it and those behind it, but for
            the way that it was reached by.
    """

    def __init__(self, at: dict[int, list[int]]) -> None:
        self._at = at
        self._node_of = {end: node for node, ends in at.items() for end in ends}
        self.order: dict[int, int] = {}
        self.low: dict[int, int] = {}

    def bridges_from(self, root: int) -> Iterator[int]:
        """Yield the bridges among all that hangs together with a node that was not reached before."""
        stack = [self._reached(root, -1)]
        while stack:
            node, came, ends = stack[-1]
            end = next(ends, None)
            if end is None:
                stack.pop()
                if stack and self._returned(node, stack[-1].node):
                    yield came
            elif end // 2 != came:
                other = self._node_of[end ^ 1]
                if other not in self.order:
                    stack.append(self._reached(other, end // 2))
                self.low[node] = min(self.low[node], self.order[other])

    def _reached(self, node: int, came: int) -> _ReachedNode:
        self.order[node] = self.low[node] = len(self.order)
        return _ReachedNode(node, came, iter(self._at[node]))

    def _returned(self, node: int, parent: int) -> bool:
        """Take over what is reached from a node; tell whether nothing before it is: what leads to it is a bridge."""
        self.low[parent] = min(self.low[parent], self.low[node])
        return self.low[node] > self.order[parent]


class _ReachedNode(NamedTuple):
    """A node, the piece by which it was reached (-1: none), and the ends there that were not looked at yet."""

    node: int
    came: int
    ends: Iterator[int]
