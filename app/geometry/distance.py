"""Exact distances from points to lines and arcs, by a tree of boxes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.pool import in_bands
from . import kernels
from .primitives import Indices, Rows, boxes

_WORTH_LINES = 8
"""Points on one line along X from which all of them are asked together."""


@dataclass(frozen=True)
class DistanceField:
    """Distance from any point to the nearest of some lines and arcs.

    Attributes:
        rows: (n, 8), n > 0.
        boxes, order, nodes: the tree over them, see `kernels`.
    """

    rows: Rows
    boxes: Rows
    order: Indices
    nodes: Rows

    @staticmethod
    def of(rows: Rows) -> DistanceField:
        """Build the tree over rows (n, 8), n > 0."""
        rows = np.ascontiguousarray(rows)
        around = np.ascontiguousarray(boxes(rows))
        order, nodes = kernels.build_tree(around)
        return DistanceField(rows, around, order, nodes)

    def nearest(
        self, points: NDArray[np.float64], limit: float = np.inf, enough: float = -1.0
    ) -> tuple[NDArray[np.float64], Indices]:
        """Return (distances (m,) mm, rows (m,)) for points (m, 2).

        Args:
            limit: rows farther than this give (limit, -1), mm.
            enough: the first row found that is no farther is given, whether it is the nearest or not, mm.
        """
        points = np.ascontiguousarray(points, dtype=np.float64)
        distances, found = np.empty(len(points)), np.empty(len(points), np.int64)

        def measure(part: slice) -> None:
            kernels.nearest_many(
                self.rows, self.order, self.nodes, points[part], enough, limit, distances[part], found[part]
            )

        in_bands(measure, len(points))
        return distances, found

    def gap(self, x: float, y: float) -> float:
        """Return the distance of one point, mm: for one, `nearest` mostly makes arrays."""
        return float(kernels.nearest_between(self.rows, self.order, self.nodes, x, y, -1.0, np.inf)[0])

    def farthest(self, points: NDArray[np.float64]) -> float:
        """Return the distance of that of points (m, 2) which is farthest from all rows, mm; 0 of none."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        return max(
            in_bands(lambda part: float(kernels.farthest(self.rows, self.order, self.nodes, points[part])), len(points))
        )

    def inside(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return for points (m, 2) whether the closed rows enclose them by the even-odd rule."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        result = np.empty(len(points), np.bool_)
        heights, line = np.unique(points[:, 1], return_inverse=True)
        if len(heights) * _WORTH_LINES <= len(points):
            along = np.argsort(line, kind="stable")
            first = np.searchsorted(line[along], np.arange(len(heights) + 1))
            found = np.empty(len(points), np.bool_)
            kernels.inside_on_lines(self.rows, self.order, self.nodes, heights, first, points[along, 0], found)
            result[along] = found
            return result
        in_bands(
            lambda part: kernels.inside_many(self.rows, self.order, self.nodes, points[part], result[part]),
            len(points),
        )
        return result
