"""Discs along the medial axis, each cleared by one arc that the disc before it keeps within the limit.

Cleared is a disc about c0 of radius R0; the next one has its centre c, its reach R, and the cutter goes round c at
rho = R - r. Nothing within R0 - |c - c0| of c is metal, and that bounds the engaged angle along the whole arc (see
`limit`). Of all places on the axis that keep the limit the farthest is taken, and no farther than that the scallop
between the two discs, along a wall that touches both, is as low as it must be for the way along the walls.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from .axis import RoughAxis
from .cleared_discs import ClearedDisc, ClearedDiscs, Point, WallClearance
from .limit import EngagementLimit

_CONTAINED = 1e-4
"""mm; a disc that sticks out of a clear one by less adds nothing."""

_PROGRESS = 1e-4
"""mm; less is a standstill."""

_HALVINGS = 40
"""Of a straight way, at most; a quarter of `_PROGRESS` ends them before."""


@dataclass(frozen=True)
class WalkStop:
    """A place beyond which the axis goes on and the cutter does not: where, mm, and how wide the area is there, mm."""

    place: Point
    width: float


@dataclass
class AxisWalk:
    """Walks along the axis of one connected part.

    Attributes:
        discs: that were cleared so far.
        stops: where it had to stop.
    """

    limit: EngagementLimit
    room: WallClearance
    axis: RoughAxis
    discs: ClearedDiscs = field(default_factory=ClearedDiscs)
    stops: list[WalkStop] = field(default_factory=list)

    def begin(self, tree: AxisTree) -> ClearedDisc:
        """Return the first disc, that of the root."""
        (x, y), reach = _place(self.axis.points[tree.root], self.axis.reach[tree.root])
        if self.limit.grid is not None:
            (x, y), radius = self.limit.grid.nearest((x, y)), self.limit.radius
            reach = radius + self.limit.grid.within(min(reach, self.room.at((x, y))) - radius)
        return ClearedDisc(x, y, reach, -1)

    def along(self, tree: AxisTree, swept: NDArray[np.bool_], progress: Progress) -> None:
        """Clear all of a tree, from its root on.

        Args:
            swept: (n,) points of the axis whose discs are clear already, beside the root's: they need no arc.

        Raises:
            Cancelled: by progress.
        """
        number = self.discs.add(self.begin(tree))
        waiting = [(tree.root, child, number) for child in reversed(tree.children(tree.root))]
        done = 0
        while waiting:
            before, node, payer = waiting.pop()
            chain = [before, node]
            if swept[node]:
                (x, y), reach = _place(self.axis.points[node], self.axis.reach[node])
                last: int | None = self.discs.add(ClearedDisc(x, y, reach, payer, swept=True))
            else:
                while len(on := tree.children(chain[-1])) == 1 and not swept[on[0]]:
                    chain += on
                last = self._follow(chain, payer)
            done += len(chain) - 1
            progress.step(min(1.0, done / len(tree.order)), "Clear along the axis")
            if last is not None:
                waiting += [(chain[-1], child, last) for child in reversed(tree.children(chain[-1]))]

    def fits(self, centre: Point, reach: float, payer: int) -> bool:
        """Tell whether the arc round a place keeps the limit, if a disc pays for it."""
        paying = self.discs.each[payer]
        away = math.dist(centre, paying.centre)
        return away + reach <= paying.reach or (
            away <= paying.reach - self.limit.clear_needed(reach - self.limit.radius)
        )

    def _near(self, centre: Point, reach: float, payer: int) -> bool:
        """Tell whether an arc keeps the limit, and its scallop is low enough."""
        if not self.fits(centre, reach, payer):
            return False
        paying = self.discs.each[payer]
        away = math.dist(centre, paying.centre)
        if away + reach <= paying.reach + _CONTAINED:
            return True
        rise = paying.reach - reach
        return away * away - rise * rise <= 2 * self.limit.scallop * (math.sqrt(paying.reach) + math.sqrt(reach)) ** 2

    def _follow(self, chain: Sequence[int], payer: int) -> int | None:
        """Clear along points of the axis, the last one itself; return the disc there, None where it came to a stop."""
        points = self.axis.points[list(chain)]
        reach = self.axis.reach[list(chain)]
        at, k = points[0], 0
        while True:
            ahead = k + 1
            while ahead < len(points) and self._near(*_place(points[ahead], reach[ahead]), payer):
                ahead += 1
            if ahead == len(points):
                return self._taken(*_place(points[-1], reach[-1]), payer)
            start = at if ahead == k + 1 else points[ahead - 1]
            found = self._farthest(start, points[ahead], payer)
            if found is None or math.dist(found, at) < _PROGRESS:
                x, y = at.tolist()
                self.stops.append(WalkStop((x, y), 2 * self.room.at((x, y))))
                return None
            centre, wide = self._exact(found, payer)
            payer = self._taken(centre, wide, payer)
            at, k = np.array(found), ahead - 1

    def _farthest(self, start: np.ndarray, end: np.ndarray, payer: int) -> Point | None:
        """Return the farthest place on a straight way that still fits; its end does not."""
        low, high = 0.0, 1.0
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            x, y = (start + middle * (end - start)).tolist()
            if self._near((x, y), self.room.at((x, y)), payer):
                low = middle
            else:
                high = middle
            if (high - low) * float(np.hypot(*(end - start))) < _PROGRESS / 4:
                break
        x, y = (start + low * (end - start)).tolist()
        return (x, y) if low > 0.0 else None

    def _exact(self, place: Point, payer: int) -> tuple[Point, float]:
        """Return a place moved onto the axis itself, where it still fits, and its reach."""
        centre, wide = self.room.to_axis(place, self.limit.radius / 8)
        if self.fits(centre, wide, payer) and wide >= self.room.needed:
            return centre, wide
        return place, self.room.at(place)

    def _taken(self, centre: Point, reach: float, payer: int) -> int:
        """Clear a disc; return its number, or that of its payer, if it lies in that one."""
        paying = self.discs.each[payer]
        if math.dist(centre, paying.centre) + reach <= paying.reach + _CONTAINED:
            return payer
        if self.limit.grid is not None:
            near = self.limit.grid.nearest(centre)
            wide = self.room.at(near)
            if wide >= self.room.needed and self.fits(near, wide, payer):
                centre, reach = near, wide
        return self.discs.add(ClearedDisc(*centre, reach, payer))


@dataclass(frozen=True, eq=False)
class AxisTree:
    """A spanning tree of a connected part of the axis.

    Attributes:
        root: its widest point, of those at which it should begin if it has any.
        order: all points, each after the one before it.
        after: the points behind each, the shortest branch first.
    """

    root: int
    order: Sequence[int]
    after: dict[int, list[int]]

    def children(self, node: int) -> list[int]:
        """Return the points behind one."""
        return self.after.get(node, [])


def trees(axis: RoughAxis, begin: NDArray[np.bool_] | None = None) -> list[AxisTree]:
    """Return a spanning tree of each connected part, made of its widest edges.

    Args:
        begin: (n,) points of the axis at which it should begin rather than elsewhere; None = no matter where.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

    count = len(axis.points)
    if not count:
        return []
    a, b = axis.edges.T if len(axis.edges) else np.zeros((2, 0), np.int64)
    weight = 1 + 2 * axis.reach.max() - np.minimum(axis.reach[a], axis.reach[b])
    graph = coo_matrix((weight, (np.minimum(a, b), np.maximum(a, b))), (count, count)).tocsr()
    spanning = minimum_spanning_tree(graph)
    _, label = connected_components(spanning, directed=False)
    found = []
    linked = np.zeros(count, np.bool_)
    linked[axis.edges.ravel()] = True
    for part in np.unique(label[linked]) if linked.any() else ():
        members = np.flatnonzero(label == part)
        wished = members[begin[members]] if begin is not None else members
        roots = wished if len(wished) else members
        root = int(roots[np.argmax(axis.reach[roots])])
        order, before = breadth_first_order(spanning, root, directed=False)
        found.append(_tree(axis, root, order.tolist(), before))
    return found


def _tree(axis: RoughAxis, root: int, order: list[int], before: np.ndarray) -> AxisTree:
    long = dict.fromkeys(order, 0.0)
    after: dict[int, list[int]] = {}
    for node in reversed(order[1:]):
        parent = int(before[node])
        long[parent] += long[node] + float(np.hypot(*(axis.points[node] - axis.points[parent])))
        after.setdefault(parent, []).append(node)
    for children in after.values():
        children.sort(key=lambda child: long[child])
    return AxisTree(root, order, after)


def _place(point: np.ndarray, reach: float) -> tuple[Point, float]:
    x, y = point.tolist()
    return (x, y), float(reach)
