"""The edges of triangles: which of them share one, and where a surface ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """The edges of n triangles, 3 n uses of them.

    Attributes:
        edge: (3 n,) number of the edge of each use; the uses of triangle k are 3 k, 3 k + 1 and 3 k + 2.
        forward: (3 n,) whether it is run through from the corner with the smaller number to that with the larger one.
        count: uses of each edge.
    """

    edge: Ints
    forward: NDArray[np.bool_]
    count: Ints

    @staticmethod
    def of(triangles: Floats) -> MeshEdges:
        """Return the edges of triangles (n, 3, 3); corners at exactly the same place are one."""
        return MeshEdges.between(numbered(triangles.reshape(-1, 3)))

    @staticmethod
    def between(start: Ints) -> MeshEdges:
        """Return the edges of triangles by the numbers (3 n,) of their corners."""
        end = np.roll(start.reshape(-1, 3), -1, axis=1).ravel()
        both = np.minimum(start, end) * (int(start.max(initial=0)) + 1) + np.maximum(start, end)
        edge = numbered_rows(both[:, None])
        return MeshEdges(edge, np.asarray(start < end), np.bincount(edge))

    def open_uses(self) -> Ints:
        """Return the uses of edges that belong to an odd number of triangles: there the surface ends."""
        return np.flatnonzero(self.count[self.edge] % 2)


AT_ONCE = 1 << 16
"""Triangles that are looked at together: what is needed meanwhile stays small."""


def numbered(places: Floats) -> Ints:
    """Return the number of each place (n, 3), from 0 in the order in which they come; equal ones have one, and there is
    one zero only.
    """
    return numbered_rows((places + 0.0).view(np.int64))


def numbered_rows(rows: Ints) -> Ints:
    """Return the number of each row (n, m) of whole numbers, from 0 in the order in which they come; equal ones have
    the same.
    """
    from .corner_kernels import number_rows

    number, size = np.empty(len(rows), np.int64), 2 << max(4, len(rows).bit_length())
    number_rows(np.ascontiguousarray(rows).view(np.uint64), np.full(size, -1, np.int32), number)
    return number


def doubled_areas(triangles: Floats) -> Floats:
    """Return twice the area of each triangle (n, 3, 3), mm2."""
    doubled = np.empty(len(triangles))
    for first in range(0, len(triangles), AT_ONCE):
        some = triangles[first : first + AT_ONCE]
        doubled[first : first + AT_ONCE] = np.linalg.norm(
            np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0]), axis=1
        )
    return doubled
