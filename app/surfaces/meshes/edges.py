"""The edges of triangles: which of them share one, and where a surface ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .corners import numbered, numbered_rows

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
