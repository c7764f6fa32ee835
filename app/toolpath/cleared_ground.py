"""Ground that is cut already, and how deep: what a cutter may go down to, or go over, without touching metal."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import tolerances
from ..geometry.kernels import build_tree
from ..geometry.primitives import Rows, boxes
from ..model.curves import Point
from ..model.tool import Tool
from . import cleared_kernels as kernels

_SLACK = 0.01
"""Of a cutter's radius: so thin a skin may stand on ground that counts as cut; at least 1 um."""

_BUDGET = 4_000
"""Squares that one way is divided into at most; about 2 ms."""

_LOOSE = 128
"""Rows that are looked at one by one before they get a tree."""

_SAME_HEIGHT = 1e-9

Row = NDArray[np.float64]
"""(8,) a line or an arc, see `app.geometry.primitives`."""


class Disc(NamedTuple):
    """A disc by its centre and radius, mm."""

    x: float
    y: float
    radius: float


class _RowTree(NamedTuple):
    """Rows that share a tree, as the kernels read it: the first of them, how many, its first node, its leaves; without
    leaves there is no tree yet.
    """

    first: int
    rows: int
    node: int
    leaves: int


class _FlatCuts:
    """What flat ends have cut: rows, how deep, and how far beside them."""

    def __init__(self) -> None:
        self._rows, self._reach, self._boxes = np.empty((256, 8)), np.empty((256, 2)), np.empty((256, 4))
        self._order, self._nodes, self._best = np.empty(256, np.int64), np.empty((256, 4)), np.empty((256, 2))
        self._count = 0
        self._trees: list[_RowTree] = []
        self._forest: tuple[NDArray[Any], ...] | None = None
        self._deep: list[float] = []

    def add(self, rows: Rows, z: NDArray[np.float64], radius: float) -> None:
        """Take rows (n, 8), each cut down to its z (n,) by a disc of a radius, mm."""
        first, self._count = self._count, self._count + len(rows)
        if self._count > len(self._rows):
            size = 2 * self._count
            self._rows, self._reach, self._boxes = (
                _longer(each, size) for each in (self._rows, self._reach, self._boxes)
            )
            self._order = _longer(self._order, size)
        self._rows[first : self._count] = rows
        self._reach[first : self._count, 0], self._reach[first : self._count, 1] = z, radius
        for height in set(z.tolist()):
            self._note(height)
        last = self._trees.pop() if self._trees and not self._trees[-1].leaves else None
        loose = last or _RowTree(first, 0, self._nodes_used(), 0)
        self._trees.append(loose._replace(rows=self._count - loose.first))
        if self._count - loose.first > _LOOSE:
            self._plant()
        self._forest = None

    def beyond(self, place: Point, z: float, enough: float) -> tuple[float, Row | None]:
        """Return how far a place is from ground cut down to z, mm, negative within it, and the row that it is nearest
        to.
        """
        if not self._count:
            return np.inf, None
        gap, row = kernels.beyond(*self._arrays(), *place, z, enough, np.inf)
        return float(gap), self._rows[row] if row >= 0 else None

    def covers(self, a: Point, b: Point, radius: float, z: float) -> bool:
        """Tell whether a disc stays on ground cut down to z on its straight way from a to b."""
        slack = max(_SLACK * radius, tolerances.LEVEL)
        way, z = np.array([*a, *b], np.float64), z + _SAME_HEIGHT
        return bool(self._count and kernels.covers(*self._arrays(), way, radius, z, slack, _BUDGET, np.empty(2)))

    def covered_after(self, places: NDArray[np.float64], k: int, radius: float, z: float) -> int:
        """Return the first place (m, 2) from number k on at which a disc lies on ground cut down to z; -1 where there
        is none.
        """
        if not self._count:
            return -1
        slack = max(_SLACK * radius, tolerances.LEVEL)
        return int(kernels.covered_after(*self._arrays(), places, k, radius, z + _SAME_HEIGHT, slack, _BUDGET))

    def depths(self) -> list[float]:
        """Return how deep it was cut anywhere, mm below Z 0, the least first."""
        return self._deep

    def _note(self, height: float) -> None:
        k = bisect_left(self._deep, -height - _SAME_HEIGHT)
        if k == len(self._deep) or self._deep[k] > -height + _SAME_HEIGHT:
            self._deep.insert(k, -height)

    def _nodes_used(self) -> int:
        return self._trees[-1].node + max(0, 2 * self._trees[-1].leaves - 1) if self._trees else 0

    def _plant(self) -> None:
        """Make one tree of the loose rows and of all trees before them that are no larger."""
        first, count, node, _ = self._trees.pop()
        self._boxes[first : self._count] = boxes(self._rows[first : self._count])
        while self._trees and self._trees[-1].rows <= count:
            first, more, node, _ = self._trees.pop()
            count += more
        order, nodes = build_tree(self._boxes[first : self._count])
        leaves = (len(nodes) + 1) // 2
        if node + len(nodes) > len(self._nodes):
            size = 2 * (node + len(nodes))
            self._nodes, self._best = _longer(self._nodes, size), _longer(self._best, size)
        self._order[first : self._count] = order
        self._nodes[node : node + len(nodes)] = nodes
        self._best[node : node + len(nodes)] = kernels.bounds(self._reach[first : self._count], order, leaves)
        self._trees.append(_RowTree(first, count, node, leaves))

    def _arrays(self) -> tuple[NDArray[Any], ...]:
        if self._forest is None:
            trees = np.array(self._trees, np.int64).reshape(-1, 4)
            self._forest = (self._rows, self._reach, self._order, self._nodes, self._best, trees)
        return self._forest


def _longer(array: NDArray[Any], size: int) -> NDArray[Any]:
    longer = np.empty((size, *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


@dataclass
class ClearedGround:
    """Ground cut so far, by all tools.

    A flat end clears all that it sweeps. A cutter of another shape is not as wide at its tip, so beside what its flat
    part sweeps only the very places it has been at are clear, and only for itself.
    """

    wells: dict[Disc, float] = field(default_factory=dict)
    """Heights down to which discs were cleared by helices, mm."""
    _flat: _FlatCuts = field(default_factory=_FlatCuts)
    _own: dict[int, _FlatCuts] = field(default_factory=dict)
    _floors: dict[tuple[int, Point, float], float] = field(default_factory=dict)
    """Floors that were asked for since something was added: a way to a place asks for them again and again."""

    def add(self, tool: Tool, rows: Rows, z: NDArray[np.float64]) -> None:
        """Take a path as cut.

        Args:
            rows: (n, 8) of its centre; arcs sweep less than pi.
            z: (n,) how deep each row was cut, mm; for a row along which it changes, the height of its higher end.
        """
        deep = z < 0
        if not deep.all():
            rows, z = rows[deep], z[deep]
        if not len(rows):
            return
        self._floors.clear()
        if flat_radius(tool) > 0:
            self._flat.add(rows, z, flat_radius(tool))
        if not tool.kind.square:
            self._own.setdefault(tool.number, _FlatCuts()).add(rows, z, 0.0)

    def floor(self, tool: Tool, place: Point, more: float = 0.0) -> float:
        """Return down to which height all ground under a cutter at a place is cut, mm, <= 0.

        Args:
            more: mm, >= 0, that is asked about beyond the cutter's radius.
        """
        key = tool.number, place, tool.radius + more
        if key not in self._floors:
            self._floors[key] = self._floor(tool, place, more)
        return self._floors[key]

    def _floor(self, tool: Tool, place: Point, more: float) -> float:
        radius = tool.radius + more
        flat = _deepest(self._flat, lambda z: self._flat.covers(place, place, radius, z))
        own = self._own.get(tool.number)
        if own is None or more:
            return flat
        return min(
            flat, _deepest(own, lambda z: own.beyond(place, z + _SAME_HEIGHT, tolerances.WELD)[0] <= tolerances.WELD)
        )

    def nearest(self, place: Point, z: float) -> tuple[float, Row | None]:
        """Return how far a place is from ground that flat ends have cut down to z, mm, and the path (8,) there.

        The distance is negative within that ground; (inf, None) where there is none.
        """
        return self._flat.beyond(place, z + _SAME_HEIGHT, -np.inf)

    def is_clear(self, tool: Tool, a: Point, b: Point, z: float) -> bool:
        """Tell whether a cutter with its tip at height z touches no metal on its straight way from a to b."""
        return z >= 0 or self._flat.covers(a, b, tool.radius, z)

    def clear_places(self, tool: Tool, places: Sequence[Point], z: float) -> Iterator[int]:
        """Give the numbers of the places at which a cutter with its tip at height z touches no metal, in order, each as
        it is asked for.
        """
        if z >= 0:
            yield from range(len(places))
            return
        table = np.array(places, np.float64).reshape(-1, 2)
        k = self._flat.covered_after(table, 0, tool.radius, z)
        while k >= 0:
            yield k
            k = self._flat.covered_after(table, k + 1, tool.radius, z)


def flat_radius(tool: Tool) -> float:
    """Return the radius, mm, of the level ground that a tool leaves under its axis."""
    return tool.profile.flat


def _deepest(ground: _FlatCuts, is_clear: Callable[[float], bool]) -> float:
    """Return the lowest of a ground's heights that is clear, 0 where none is; what is clear at one is at all higher
    ones.
    """
    depths = ground.depths()
    low, high = 0, len(depths)
    while low < high:
        middle = (low + high) // 2
        if is_clear(-depths[middle]):
            low = middle + 1
        else:
            high = middle
    return -depths[low - 1] if low else 0.0
