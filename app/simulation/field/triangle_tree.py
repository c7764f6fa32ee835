"""Triangles in a tree of boxes: which one is nearest to a place, in closed form, and which ones an upright line
meets.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.pool import pool
from ...model.motion import Floats
from ..box_tree import box_tree

_BAND = 4096
"""Segments that are measured by one piece of work: the same ones whatever the machine, as where a search begins can
tell in the last digits.
"""


@dataclass(frozen=True, eq=False)
class TriangleTree:
    """A balanced binary tree over triangles that lie near one another.

    Attributes:
        boxes: of the nodes, as `box_tree` gives them.
        triangles: (n, 9) in the order of the leaves.
    """

    boxes: Floats
    triangles: Floats

    @staticmethod
    def of(triangles: Floats) -> TriangleTree:
        """Return the tree of triangles (n, 3, 3), n > 0."""
        order, boxes = box_tree(triangles.min(axis=1), triangles.max(axis=1))
        return TriangleTree(boxes, np.ascontiguousarray(triangles[order].reshape(-1, 9)))

    def distances(self, places: Floats) -> Floats:
        """Return how far places (m, 3) are from the nearest triangle, mm."""
        from .nearest_kernels import distances

        out = np.empty(len(places))
        distances(self.boxes, self.triangles, np.ascontiguousarray(places), out)
        return out

    def deepest(self, segments: Floats, known: Floats, fine: float) -> Floats:
        """Return the greatest distance (m,) of the places of upright segments (m, 4) x, y, low, high; see
        `nearest_kernels.deepest`.
        """
        from .nearest_kernels import deepest

        segments, known, out = np.ascontiguousarray(segments), np.ascontiguousarray(known), np.empty(len(segments))

        def measure(first: int) -> None:
            band = slice(first, first + _BAND)
            deepest(self.boxes, self.triangles, segments[band], known[band], fine, out[band])

        firsts = range(0, len(segments), _BAND)
        list(map(measure, firsts) if len(firsts) < 2 else pool().map(measure, firsts))
        return out

    def tops(self, points: Floats) -> Floats:
        """Return the highest place (m,) where upright lines through points (m, 2) meet triangles, mm; -infinite where
        they meet none.
        """
        from .ray_kernels import tops

        out = np.empty(len(points))
        tops(self.boxes, self.triangles, np.ascontiguousarray(points), out)
        return out

    def met(self, points: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return where upright lines through points (m, 2) meet triangles, each meeting of n: point, height in mm, 1 =
        up, -1 = down.
        """
        from .ray_kernels import met

        places, counts = np.ascontiguousarray(points), np.empty(len(points), np.int64)
        none = np.zeros((0, 2))
        met(self.boxes, self.triangles, places, counts, none)
        found = np.empty((int(counts.sum()), 2))
        if len(found):
            met(self.boxes, self.triangles, places, counts, found)
        return np.repeat(np.arange(len(points)), counts), found[:, 0].copy(), found[:, 1].copy()
