"""Curves that meet end to end, one after the other."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from ...core.tolerances import WELD
from ...model.curves import Curve, Point, reversed_curve

_CELL = 10 * WELD
"""mm; ends are sorted into squares so wide: one that is near lies in the same or a neighbouring one."""


@dataclass(frozen=True, slots=True)
class CurveChain:
    """Curves of which each begins where the one before ends.

    Attributes:
        numbers: of the curves, in the direction of travel, which is that of the lowest number.
        curves: they, each in that direction.
        closed: the last one ends where the first begins.
    """

    numbers: tuple[int, ...]
    curves: tuple[Curve, ...]
    closed: bool


def chained(curves: Mapping[int, Curve]) -> list[CurveChain]:
    """Return the chains of some curves by their lowest numbers; where three or more ends meet all chains end."""
    nodes = _nodes(curves)
    at: dict[int, list[int]] = {}
    for number, both in nodes.items():
        for node in both if both[0] != both[1] else ():
            at.setdefault(node, []).append(number)
    done, found = set[int](), list[CurveChain]()
    for number in sorted(curves):
        if number in done:
            continue
        first, last = nodes[number]
        if first == last:
            found.append(CurveChain((number,), (curves[number],), closed=True))
            continue
        done.add(number)
        ahead = _walk(last, at, nodes, done)
        closed = bool(ahead) and ahead[-1].node == first and len(at[first]) == 2
        behind = [] if closed else _walk(first, at, nodes, done)
        way = [
            *((n, not forward) for n, forward, _ in reversed(behind)),
            (number, True),
            *((n, forward) for n, forward, _ in ahead),
        ]
        turned = tuple(curves[n] if forward else reversed_curve(curves[n]) for n, forward in way)
        found.append(CurveChain(tuple(n for n, _ in way), turned, closed))
    return found


class _ChainStep(NamedTuple):
    """A curve of a chain by its number, whether it is gone along forward, and the node where that ends."""

    number: int
    forward: bool
    node: int


class _KnownNode(NamedTuple):
    """A point where curves end."""

    number: int
    place: Point


def _walk(
    node: int, at: Mapping[int, list[int]], nodes: Mapping[int, tuple[int, int]], done: set[int]
) -> list[_ChainStep]:
    """Return what follows from a node."""
    way = list[_ChainStep]()
    while len(at[node]) == 2:
        onward = next((number for number in at[node] if number not in done), None)
        if onward is None:
            break
        done.add(onward)
        first, last = nodes[onward]
        forward = first == node
        node = last if forward else first
        way.append(_ChainStep(onward, forward, node))
    return way


def _nodes(curves: Mapping[int, Curve]) -> dict[int, tuple[int, int]]:
    """Return for each curve numbers of the points where it starts and ends; ends within WELD of one another are one
    point.
    """
    cells: dict[tuple[int, int], list[_KnownNode]] = {}
    count = 0

    def node(point: Point) -> int:
        nonlocal count
        x, y = point
        left, low = math.floor((x - WELD) / _CELL), math.floor((y - WELD) / _CELL)
        right, high = math.floor((x + WELD) / _CELL), math.floor((y + WELD) / _CELL)
        for i in range(left, right + 1):
            for j in range(low, high + 1):
                for known, place in cells.get((i, j), ()):
                    if math.dist(place, point) <= WELD:
                        return known
        count += 1
        cells.setdefault((math.floor(x / _CELL), math.floor(y / _CELL)), []).append(_KnownNode(count, point))
        return count

    return {number: (node(curve.start), node(curve.end)) for number, curve in curves.items()}
