"""Method D on clouds of a surface: which of its points lie on the true shape, by the facets of the polyhedron behind
it.

As the points of a path are parted into ranges along one segment, those of a surface are parted into facets: points that
hang together and lie within epsilon of one plane. Those at a facet's border are effective, those within it are not.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError, ParameterError
from ...model.motion import Floats
from .effective_points import PointState

Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class CloudFacets:
    """The facets of a cloud of n points.

    Attributes:
        facet: (n,) number of each point's facet.
        planes: (f, 6) unit normal and a place of each, mm; all of its points lie within epsilon of it.
        state: (n,) PointState: EFFECTIVE at the border of a facet or of the cloud, else INVALID.
    """

    facet: Ints
    planes: Floats
    state: NDArray[np.uint8]


def facets_of_grid(points: Floats, epsilon: float) -> CloudFacets:
    """Part a grid of points (rows, cols, 3) mm, of two rows and columns at least, numbered row by row.

    Args:
        points: neighbours in a row or a column are neighbours on the surface.
        epsilon: mm, > 0.

    Raises:
        GeometryError: it is no such grid, or a point has no finite place.
        ParameterError: epsilon out of its range.
    """
    if points.ndim != 3 or points.shape[2] != 3 or min(points.shape[:2]) < 2:
        raise GeometryError(
            f"A grid of points of shape {points.shape}; expected (rows, cols, 3), of two or more each way."
        )
    number = np.arange(points.shape[0] * points.shape[1]).reshape(points.shape[:2])
    across = np.column_stack((number[:, :-1].ravel(), number[:, 1:].ravel()))
    down = np.column_stack((number[:-1].ravel(), number[1:].ravel()))
    rim = np.ones(points.shape[:2], np.bool_)
    rim[1:-1, 1:-1] = False
    return _parted(points.reshape(-1, 3), np.concatenate((across, down)), rim.ravel(), epsilon)


def facets_of_rows(rows: Sequence[Floats], epsilon: float) -> CloudFacets:
    """Part a cloud scanned in rows, each (n, 3) mm, n >= 2, two rows at least, numbered row by row.

    Args:
        rows: points beside one another in a row are neighbours, and so is each with the nearest of the rows beside its
            own.
        epsilon: mm, > 0.

    Raises:
        GeometryError: rows are too few or too short, or a point has no finite place.
        ParameterError: epsilon out of its range.
    """
    if len(rows) < 2 or any(row.ndim != 2 or row.shape[1] != 3 or len(row) < 2 for row in rows):
        raise GeometryError("A cloud of rows of points; expected two or more rows of two or more points (n, 3).")
    points = np.concatenate(rows)
    _ensure_finite(points)
    begin = np.cumsum([0, *(len(row) for row in rows)])
    rim = np.zeros(len(points), np.bool_)
    rim[begin[:-1]] = rim[begin[1:] - 1] = rim[: begin[1]] = rim[begin[-2] :] = True
    return _parted(points, row_neighbours(rows), rim, epsilon)


def row_neighbours(rows: Sequence[Floats]) -> Ints:
    """Return the pairs (m, 2) of neighbours among points of rows (n, 3), numbered row by row: those beside one another
    in a row, and each with the nearest of the rows beside its own.
    """
    from scipy.spatial import KDTree

    begin = np.cumsum([0, *(len(row) for row in rows)])
    pairs = [np.column_stack((np.arange(a, b - 1), np.arange(a + 1, b))) for a, b in pairwise(begin)]
    trees = [KDTree(row) for row in rows]
    for row in range(len(rows)):
        for other in (row - 1, row + 1):
            if 0 <= other < len(rows):
                nearest = trees[other].query(rows[row])[1] + begin[other]
                pairs.append(np.column_stack((np.arange(begin[row], begin[row + 1]), nearest)))
    return np.concatenate(pairs)


def distinct_pairs(pairs: Ints) -> Ints:
    """Return pairs (m, 2) of numbers >= 0 in order, each once; numpy's own way over rows takes ten times as long."""
    count = int(pairs.max(initial=0)) + 1
    return np.column_stack(np.divmod(np.unique(pairs[:, 0] * count + pairs[:, 1]), count))


def _ensure_finite(points: Floats) -> None:
    if not np.isfinite(points).all():
        worst = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise GeometryError(f"Point {worst} of a cloud is at {points[worst].tolist()}; expected finite coordinates.")


def _parted(points: Floats, pairs: Ints, rim: NDArray[np.bool_], epsilon: float) -> CloudFacets:
    """Part points (n, 3) with pairs of neighbours (m, 2); those on the rim (n,) are effective anyhow."""
    from . import facet_kernels

    if not (epsilon > 0 and math.isfinite(epsilon)):
        raise ParameterError(f"epsilon is {epsilon:g} mm; it must be greater than 0.")
    points = np.ascontiguousarray(points)
    _ensure_finite(points)
    both = distinct_pairs(np.concatenate((pairs, pairs[:, ::-1])))
    offsets, beside = np.searchsorted(both[:, 0], np.arange(len(points) + 1)), both[:, 1].copy()
    rough, facet, planes = np.empty(len(points)), np.empty(len(points), np.int64), np.empty((len(points), 6))
    facet_kernels.roughness(points, offsets, beside, rough)
    count = facet_kernels.grow(points, offsets, beside, np.argsort(rough, kind="stable"), epsilon, facet, planes)
    state = np.where(rim, PointState.EFFECTIVE, PointState.INVALID).astype(np.uint8)
    state[both[facet[both[:, 0]] != facet[both[:, 1]], 0]] = PointState.EFFECTIVE
    return CloudFacets(facet, planes[:count].copy(), state)
