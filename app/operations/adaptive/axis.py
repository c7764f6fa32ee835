"""The medial axis of an area, roughly: what lies as far from two places of the walls.

Edges are those of the Voronoi diagram of points along the walls; distances are exact. Paths along it are proven by
these distances alone, so that the axis is rough costs nothing but a little length. Where it ends in a corner, its last
point is exact: the corner of the offset ring there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from ...geometry.primitives import Primitives, lengths, points_at
from .cleared_discs import WallClearance

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_ADDS = 0.01
"""mm; a branch whose tip adds less to the disc that it leaves is none."""

_HALVINGS = 40
"""Of an edge of the graph that leaves the room, for where it does: a trillionth of the edge is left."""

_NEIGHBOURS = 1
"""Points along one wall so near to each other have no edge between them."""


@dataclass(frozen=True, eq=False)
class RoughAxis:
    """A graph.

    Attributes:
        points: (n, 2) mm.
        reach: (n,) how far from walls each point is, less the stock to leave, mm.
        edges: (m, 2) pairs of points.
    """

    points: Floats
    reach: Floats
    edges: Indices


def rough_axis(
    walls: Primitives, room: WallClearance, corners: Floats, spacing: float, progress: Progress
) -> RoughAxis:
    """Return the axis where a cutter finds room.

    Args:
        walls: closed contours, the area to the left.
        room: distances, and how much is needed.
        corners: (k, 2) points in which branches end.
        spacing: of the points along the walls, mm.
    """
    from scipy.spatial import Voronoi

    progress.step(0.0, "Medial axis")
    sites, contour, number, count = _sites(walls, spacing)
    diagram = Voronoi(sites)
    pairs, ends = diagram.ridge_points, np.array(diagram.ridge_vertices, np.int64)
    same = contour[pairs[:, 0]] == contour[pairs[:, 1]]
    apart = np.abs(number[pairs[:, 0]] - number[pairs[:, 1]])
    apart = np.minimum(apart, count[contour[pairs[:, 0]]] - apart)
    kept = (ends >= 0).all(axis=1) & ~(same & (apart <= _NEIGHBOURS))
    edges = ends[kept]
    progress.step(0.5, "Medial axis")
    used = np.unique(edges)
    reach = np.full(len(diagram.vertices), -1.0)
    reach[used] = room.reach(diagram.vertices[used])
    points, edges = _renumbered(*_cut_off(diagram.vertices, reach >= room.needed, edges, room))
    points, edges = _with_corners(points, edges, corners)
    axis = RoughAxis(points, room.reach(points), edges)
    return _pruned(axis, len(points) - len(corners), room)


def _sites(walls: Primitives, spacing: float) -> tuple[Floats, Indices, Indices, Indices]:
    """Return points along walls, the contour of each, its number there, and how many each contour has."""
    rows = walls.rows
    parts = np.maximum(1, np.ceil(lengths(rows) / spacing)).astype(np.int64)
    index = np.repeat(np.arange(len(rows)), parts)
    first = np.repeat(np.cumsum(parts) - parts, parts)
    sites = points_at(rows[index], (np.arange(len(index)) - first) / parts[index])
    contour = (np.cumsum(walls.previous != np.arange(len(rows)) - 1) - 1)[index]
    count = np.bincount(contour)
    number = np.arange(len(index)) - (np.cumsum(count) - count)[contour]
    return sites, contour, number, count


def _cut_off(points: Floats, fits: NDArray[np.bool_], edges: Indices, room: WallClearance) -> tuple[Floats, Indices]:
    """Return the graph up to where there is just room; edges of which one end has none end there."""
    ends = fits[edges]
    part = edges[ends[:, 0] != ends[:, 1]]
    part = np.where(fits[part[:, :1]], part, part[:, ::-1])
    good, bad = points[part[:, 0]], points[part[:, 1]]
    low, high = np.zeros(len(part)), np.ones(len(part))
    for _ in range(_HALVINGS if len(part) else 0):
        middle = (low + high) / 2
        there = room.reach(good + middle[:, None] * (bad - good)) >= room.needed
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    more = np.column_stack([part[:, 0], np.arange(len(points), len(points) + len(part))])
    places = good + low[:, None] * (bad - good)
    return np.concatenate([points, places]), np.concatenate([edges[ends.all(axis=1)], more])


def _renumbered(points: Floats, edges: Indices) -> tuple[Floats, Indices]:
    used, places = np.unique(edges, return_inverse=True)
    return points[used], places.reshape(-1, 2)


def _with_corners(points: Floats, edges: Indices, corners: Floats) -> tuple[Floats, Indices]:
    """Return the graph with corners joined to the points nearest to them."""
    if not len(corners):
        return points, edges
    first = len(points)
    if not first:
        return corners, edges
    from scipy.spatial import cKDTree

    _, near = cKDTree(points).query(corners)
    more = np.column_stack([np.arange(first, first + len(corners)), near])
    return np.concatenate([points, corners]), np.concatenate([edges, more])


def _pruned(axis: RoughAxis, first: int, room: WallClearance) -> RoughAxis:
    """Return the axis without branches whose tips add next to nothing; corners, from number `first` on, stay."""
    edges, kept = axis.edges, np.ones(len(axis.edges), np.bool_)
    joined: list[list[int]] = [[] for _ in axis.points]
    for k, (a, b) in enumerate(edges.tolist()):
        joined[a].append(k)
        joined[b].append(k)
    alive = [len(each) for each in joined]
    for tip in range(first):
        if alive[tip] != 1:
            continue
        way, at = _branch(axis, joined, kept, tip)
        x, r = axis.points, axis.reach
        if way and float(np.hypot(*(x[tip] - x[at]))) + r[tip] - r[at] < _ADDS:
            kept[way] = False
            for k in way:
                for end in edges[k].tolist():
                    alive[end] -= 1
    # points without an edge go too: a part of which nothing is left is one that still needs its middle
    points, edges = _renumbered(axis.points, edges[kept])
    return RoughAxis(points, room.reach(points), edges)


def _branch(
    axis: RoughAxis, joined: Sequence[Sequence[int]], kept: NDArray[np.bool_], tip: int
) -> tuple[list[int], int]:
    """Return the edges from a tip to where the axis branches, and the point there."""
    way: list[int] = []
    at, before = tip, -1
    while True:
        on = [k for k in joined[at] if kept[k] and k != before]
        if (before >= 0 and len(on) != 1) or not on:
            return way, at
        before = on[0]
        a, b = axis.edges[before].tolist()
        at = b if at == a else a
        way.append(before)
        if len(way) > len(axis.edges):
            return way, at
