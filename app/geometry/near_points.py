"""Which points lie near which, and what hangs together through that.

Trees where there are many points: own ones or shapely's, as importing scipy's takes longer than a whole small job. Few
points are compared with one another.
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

Floats = NDArray[np.float64]

Indices = NDArray[np.int64]

FEW = 100_000
"""Distances that are sooner worked out than a tree is built."""

_CELL = 1 + 1e-6
"""Reaches that a cell of a grid is wide: points within reach lie in neighbouring cells, however the last digit of one
of `_MOST_CELLS` falls.
"""

_MOST_CELLS = 2**31
"""Cells of a grid along either axis: all of them can be numbered, and their edges told."""


def pairs_within(points: Floats, reach: float) -> Indices:
    """Return the pairs (m, 2) of points within a distance of one another, the lower index first, in order.

    Args:
        points: (n, d).
        reach: mm.
    """
    if len(points) ** 2 <= FEW:
        near = np.triu(_distances(points, points) <= reach, 1)
        return np.argwhere(near).astype(np.int64)
    pairs = _near(points, points, reach)
    return pairs[pairs[:, 0] < pairs[:, 1]]


def all_within(points: Floats, places: Floats, reach: float) -> tuple[Indices, Indices]:
    """Return (place, point), each (m,), of all points within a distance of places; by place, then by point.

    Args:
        points: (n, d).
        places: (k, d).
        reach: mm.
    """
    if len(points) * len(places) <= FEW:
        place, point = np.nonzero(_distances(places, points) <= reach)
        return place.astype(np.int64), point.astype(np.int64)
    place, point = _near(points, places, reach).T
    return place, point


def _near(points: Floats, places: Floats, reach: float) -> Indices:
    """Return (place, point), (m, 2), of all points within a distance of places; by place, then by point."""
    import shapely

    plane, around = (np.zeros((len(each), 2)) for each in (points, places))
    plane[:, : points.shape[1]] = points[:, :2]  # near there is near enough to be compared
    around[:, : points.shape[1]] = places[:, :2]
    tree = shapely.STRtree(shapely.points(plane))
    place, point = tree.query(shapely.points(around), "dwithin", reach * (1 + 1e-12))
    square = np.zeros(len(place))
    for axis in range(points.shape[1]):
        square += (places[place, axis] - points[point, axis]) ** 2
    kept = np.sqrt(square) <= reach
    pairs = np.column_stack([place[kept], point[kept]]).astype(np.int64)
    ordered: Indices = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    return ordered


def nearest(points: Floats, places: Floats, count: int) -> tuple[Floats, Indices]:
    """Return (distance, index), each (k, count), of the points nearest to places, the nearest first; of points as far
    the one of the lower index.

    Args:
        points: (n, 2).
        places: (k, 2).
        count: 1 to n.
    """
    if len(points) * len(places) <= FEW:
        distance = _distances(places, points)
        order = np.argsort(distance, axis=1, kind="stable")[:, :count]
        return np.take_along_axis(distance, order, 1), order.astype(np.int64)
    from . import kernels, near_kernels

    points, places = np.ascontiguousarray(points), np.ascontiguousarray(places)
    away, which = np.empty((len(places), count)), np.empty((len(places), count), np.int64)
    near_kernels.nearest_points(points, *kernels.build_tree(np.hstack([points, points])), places, away, which)
    return away, which


def pairs_meeting(boxes: Floats, owner: Indices) -> Indices:
    """Return the pairs (m, 2) of owners, the lower one first, in order, each once, of boxes that meet or touch.

    Args:
        boxes: (n, 4) x0, y0, x1, y1.
        owner: (n,) whose each one is, >= 0.
    """
    if len(boxes) ** 2 <= FEW:
        apart = (boxes[:, None, :2] > boxes[None, :, 2:]).any(axis=2)
        pairs = owner[np.argwhere(~(apart | apart.T))]
        pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    else:
        from . import kernels, near_kernels

        boxes, owner = np.ascontiguousarray(boxes), np.ascontiguousarray(owner)
        found, count = near_kernels.meeting_boxes(*kernels.build_tree(boxes), boxes, owner)
        pairs = found[:count]
    span = int(owner.max(initial=0)) + 1
    codes = np.sort(pairs[:, 0] * span + pairs[:, 1])
    return np.column_stack(np.divmod(codes[np.diff(codes, prepend=-1) > 0], span))


def groups(count: int, pairs: Indices) -> Indices:
    """Return (count,) the number of the group of each of `count` things, numbered by the first of each.

    Args:
        count: how many.
        pairs: (m, 2) of things that belong together.
    """
    if len(pairs) <= FEW // 20:
        return _by_first(_merged(count, pairs))
    from . import kernels

    number = np.empty(count, np.int64)
    kernels.merge(np.ascontiguousarray(pairs, np.int64), number)
    return _by_first(number)


def groups_within(points: Floats, owner: Indices, count: int, reach: float) -> Indices:
    """Return (count,) the number of the group of each of `count` things, numbered by the first of each; those of which
    two points lie within a distance of one another are in one.

    Args:
        points: (n, 2) of all things. owner: (n,) whose each one is.
        reach: mm, > 0.
    """
    if len(points) ** 2 <= FEW or float(np.ptp(points, axis=0).max()) > _MOST_CELLS * reach:
        return groups(count, owner[pairs_within(points, reach)])
    from . import kernels

    number = np.empty(count, np.int64)
    column, row = np.floor((points - points.min(axis=0)) / (reach * _CELL)).astype(np.int64).T
    columns = int(column.max()) + 3
    cell = row * columns + column + 1
    order = np.argsort(cell, kind="stable")
    kernels.merge_within(np.ascontiguousarray(points[order]), owner[order], cell[order], columns, reach, number)
    return _by_first(number)


def places_of_each(values: Indices, numbers: Indices) -> list[Indices]:
    """Return for each of some numbers (m,) at which places of values (n,) it stands, rising; however many there are,
    the values are sorted once.
    """
    order = np.argsort(values, kind="stable")
    first, stop = (np.searchsorted(values[order], numbers, side).tolist() for side in ("left", "right"))
    return [order[a:b] for a, b in zip(first, stop, strict=True)]


def near_together(points: Floats, most: int) -> list[Indices]:
    """Return the numbers of points in lots that lie near one another, each in rising order: halves along the longer
    side, until none has more than so many.

    Args:
        points: (n, 2). most: >= 1.
    """
    waiting, lots = [np.arange(len(points))], list[Indices]()
    while waiting:
        some = waiting.pop()
        if len(some) <= most:
            lots.append(np.sort(some))
            continue
        axis = int(np.argmax(np.ptp(points[some], axis=0)))
        order = some[np.argsort(points[some, axis], kind="stable")]
        waiting += [order[len(order) // 2 :], order[: len(order) // 2]]
    return lots


def _by_first(number: Indices) -> Indices:
    """Return group numbers given anew in the order in which the groups first appear."""
    _, first, inverse = np.unique(number, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    return rank[inverse]


def _merged(count: int, pairs: Indices) -> Indices:
    head = list(range(count))

    def first(k: int) -> int:
        while head[k] != k:
            head[k] = head[head[k]]
            k = head[k]
        return k

    for a, b in pairs.tolist():
        one, other = first(a), first(b)
        head[max(one, other)] = min(one, other)
    return np.array([first(k) for k in range(count)], np.int64)


def _distances(places: Floats, points: Floats) -> Floats:
    """Return (k, n) distances; each coordinate's difference is taken first, so that places far from zero lose
    nothing.
    """
    square = np.zeros((len(places), len(points)))
    for axis in range(points.shape[1]):
        square += (places[:, axis, None] - points[None, :, axis]) ** 2
    return np.sqrt(square)


# Questions to a tree of shapes, asked in portions.


_PORTION = 500
"""Shapes a question; the library holds all other threads while it answers, the window's among them."""


def near(
    tree: shapely.STRtree, shapes: NDArray[np.object_], distance: float | NDArray[np.float64] | None = None
) -> NDArray[np.int64]:
    """Return pairs (2, m): index of a shape, index in the tree, whose boxes meet, or that come within a distance.

    Args:
        distance: mm, for all shapes or for each; None compares boxes only.
    """
    found = [np.zeros((2, 0), np.int64)]
    for first in range(0, len(shapes), _PORTION):
        part = slice(first, first + _PORTION)
        if distance is None:
            pairs = tree.query(shapes[part])
        else:
            pairs = tree.query(shapes[part], predicate="dwithin", distance=np.broadcast_to(distance, len(shapes))[part])
        found.append(pairs + np.array([[first], [0]]))
    return np.concatenate(found, axis=1)
