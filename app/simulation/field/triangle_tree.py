"""Triangles in a tree of boxes: which one is nearest to a place, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.motion import Floats

_BITS = 16


@dataclass(frozen=True, eq=False)
class TriangleTree:
    """A balanced binary tree over triangles that lie near one another.

    Attributes:
        boxes: (2^k - 1, 6) x0, y0, z0, x1, y1, z1 of each node, the root first; children of i are 2 i + 1 and 2 i + 2.
        triangles: (n, 9) in the order of the leaves.
    """

    boxes: Floats
    triangles: Floats

    @staticmethod
    def of(triangles: Floats) -> TriangleTree:
        """Return the tree of triangles (n, 3, 3), n > 0."""
        from .nearest_kernels import LEAF

        order = np.argsort(_along_a_curve(triangles.mean(axis=1)), kind="stable")
        rows = triangles[order]
        leaves = 1
        while leaves * LEAF < len(rows):
            leaves *= 2
        level = np.full((leaves, 6), np.inf)
        level[:, 3:] = -np.inf
        leaf = np.arange(len(rows)) // LEAF
        np.minimum.at(level[:, :3], leaf, rows.min(axis=1))
        np.maximum.at(level[:, 3:], leaf, rows.max(axis=1))
        levels = [level]
        while len(level) > 1:
            level = np.column_stack([np.minimum(level[::2, :3], level[1::2, :3]), np.maximum(level[::2, 3:], level[1::2, 3:])])
            levels.append(level)
        return TriangleTree(np.ascontiguousarray(np.concatenate(levels[::-1])), np.ascontiguousarray(rows.reshape(-1, 9)))

    def distances(self, places: Floats) -> Floats:
        """Return how far places (m, 3) are from the nearest triangle, mm."""
        from .nearest_kernels import distances

        out = np.empty(len(places))
        distances(self.boxes, self.triangles, np.ascontiguousarray(places), out)
        return out

    def deepest(self, segments: Floats, known: Floats, fine: float) -> Floats:
        """Return the greatest distance (m,) of the places of upright segments (m, 4) x, y, low, high; see `nearest_kernels.deepest`."""
        from .nearest_kernels import deepest

        out = np.empty(len(segments))
        deepest(self.boxes, self.triangles, np.ascontiguousarray(segments), np.ascontiguousarray(known), fine, out)
        return out


def _along_a_curve(places: Floats) -> np.ndarray:
    """Return numbers of places (n, 3) whose order keeps near ones together: the bits of x, y and z, interleaved (Morton)."""
    low, high = places.min(axis=0), places.max(axis=0)
    cells = ((places - low) / np.maximum(high - low, 1e-300) * ((1 << _BITS) - 1)).astype(np.int64)
    number = np.zeros(len(places), np.int64)
    for bit in range(_BITS):
        for axis in range(3):
            number |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return number
