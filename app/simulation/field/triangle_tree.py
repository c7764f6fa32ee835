"""Triangles in a tree of boxes: which one is nearest to a place, in closed form, and which ones an upright line
meets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.pool import in_bands, pool
from ...model.motion import Floats
from ..box_tree import box_tree

_BAND = 256
"""Segments that are measured by one piece of work: the same ones whatever the machine, as where a search begins can
tell in the last digits.
"""

_WORTH_TWO_CORES = 500
"""Upright lines from which a second core is worth its start."""


class UprightMeetings(NamedTuple):
    """Where upright lines meet triangles, n times.

    Attributes:
        point: (n,) number of the point that each line goes through. height: (n,) mm.
        up: (n,) 1 where the triangle looks up, -1 where it looks down.
    """

    point: NDArray[np.int64]
    height: Floats
    up: Floats


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

        points, out = np.ascontiguousarray(points), np.empty(len(points))
        in_bands(lambda band: tops(self.boxes, self.triangles, points[band], out[band]), len(points), _WORTH_TWO_CORES)
        return out

    def met(self, points: Floats) -> UprightMeetings:
        """Return where upright lines through points (m, 2) meet triangles.

        A line through an edge meets one of its two triangles, so that what is met going up is left again in a closed
        solid, whatever edges and corners the line goes through; upright triangles are met by none.
        """
        from .ray_kernels import met

        places, counts = np.ascontiguousarray(points), np.empty(len(points), np.int64)
        none = np.zeros((0, 2))
        in_bands(
            lambda band: met(self.boxes, self.triangles, places[band], counts[band], none),
            len(points),
            _WORTH_TWO_CORES,
        )
        first = np.concatenate([[0], np.cumsum(counts)])
        found = np.empty((int(first[-1]), 2))

        def find(band: slice) -> None:
            mine = found[first[band.start] : first[band.stop]]
            if len(mine):
                met(self.boxes, self.triangles, places[band], counts[band], mine)

        in_bands(find, len(points), _WORTH_TWO_CORES)
        return UprightMeetings(np.repeat(np.arange(len(points)), counts), found[:, 0].copy(), found[:, 1].copy())
