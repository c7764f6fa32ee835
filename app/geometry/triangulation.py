"""Which of many points are neighbours: the edges of their Delaunay triangulation."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

FEW = 200_000
"""Points up to which shapely is quicker than scipy, and without the third of a second in which that is imported."""


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
    codes = np.unique(edges.min(axis=1) * len(points) + edges.max(axis=1))  # many times as quick as rows
    return np.column_stack(np.divmod(codes, max(len(points), 1)))


def _triangles(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the corners (m, 3) of all triangles."""
    if len(points) <= FEW:
        import shapely

        points = np.ascontiguousarray(points)
        with suppress(shapely.errors.GEOSException):
            made = shapely.delaunay_triangles(shapely.multipoints(points))
            corners = shapely.get_coordinates(made).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
            different = points.view(np.complex128).ravel() if len(points) else np.zeros(0, np.complex128)
            found = _number_of(points, corners)
            # of points that nearly lie on one another it may lose one; scipy does not
            if np.count_nonzero(np.bincount(found)) == len(np.unique(different)) or not len(found):
                return found.reshape(-1, 3)
    from scipy.spatial import Delaunay, QhullError

    try:
        return np.asarray(Delaunay(points).simplices, np.int64)
    except (QhullError, ValueError):
        return np.zeros((0, 3), np.int64)


def _number_of(points: NDArray[np.float64], requested: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the index of each wanted point, which is one of the points to the last bit; the first of equal ones."""
    place = points.view(np.complex128).ravel()  # ordered by x, then by y
    order = np.argsort(place, kind="stable")
    return order[np.searchsorted(place[order], np.ascontiguousarray(requested).view(np.complex128).ravel())]
