"""Which of many points are neighbours: the edges of their Delaunay triangulation."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

FEW = 2000
"""Points that are sooner triangulated by shapely than scipy is imported."""


def neighbours(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the pairs of points that a Delaunay triangulation joins; the shortest tree through all of them is among
    these.

    Args:
        points: (n, 2), mm.

    Returns:
        (m, 2) of indices, the lower one first, each pair once, in order; none of fewer than three points or of points
        on a line.
    """
    corners = _triangles(points)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    return np.unique(np.sort(edges, axis=1), axis=0)


def _triangles(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the corners (m, 3) of all triangles; those of few points without scipy, which takes longer to import."""
    if len(points) <= FEW:
        import shapely

        # of points that nearly lie on one another it may lose one; scipy does not
        with suppress(shapely.errors.GEOSException):
            made = shapely.get_parts(shapely.delaunay_triangles(shapely.multipoints(points)))
            corners = shapely.get_coordinates(made).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
            return _number_of(points, corners).reshape(-1, 3)
    from scipy.spatial import Delaunay, QhullError

    try:
        return np.asarray(Delaunay(points).simplices, np.int64)
    except (QhullError, ValueError):
        return np.zeros((0, 3), np.int64)


def _number_of(points: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the index of each wanted point, which is one of the points to the last bit."""
    order = np.lexsort(points.T[::-1]).astype(np.int64)
    both = np.concatenate([points[order], wanted])
    rank = np.unique(both, axis=0, return_inverse=True)[1].ravel()
    first = np.zeros(len(both), np.int64)
    first[rank[: len(points)][::-1]] = order[::-1]
    return first[rank[len(points) :]]
