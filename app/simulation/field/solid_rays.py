"""Vertical lines through a solid of triangles: where they meet it, and which triangles are near."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from ...model.motion import Floats
from .solid import SolidStock


class SolidRays:
    """Answers where vertical lines meet a solid; its triangles are found by their boxes as seen from above."""

    def __init__(self, solid: SolidStock) -> None:
        self.triangles = solid.triangles
        low, high = self.triangles.min(axis=1), self.triangles.max(axis=1)
        self._boxes = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))

    def met(self, points: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return where the lines through points (m, 2) meet triangles, each meeting of n: point, height in mm, 1 = it looks up, -1 = down.

        A line through an edge meets one of its two triangles, so that what is met going up is left again in a closed solid, whatever
        edges and corners the line goes through; upright triangles are met by none.
        """
        point, triangle = self._boxes.query(shapely.points(points))
        a, b, c = np.moveaxis(self.triangles[triangle], 1, 0)
        place = points[point]
        turn = np.sign(_side(a, b, c[:, :2]))
        sides = [_side(p, q, place) for p, q in ((b, c), (c, a), (a, b))]
        total = sides[0] + sides[1] + sides[2]
        met = (total != 0) & (turn != 0)
        for side, (p, q) in zip(sides, ((b, c), (c, a), (a, b)), strict=True):
            met &= _holds(side * turn, (q - p)[:, :2] * turn[:, None])
        heights = (sides[0] * a[:, 2] + sides[1] * b[:, 2] + sides[2] * c[:, 2])[met] / total[met]
        return point[met], heights, turn[met]

    def tops(self, points: Floats) -> Floats:
        """Return the solid's top (m,) over points (m, 2), mm; -infinite beside it."""
        point, met, _ = self.met(points)
        heights = np.full(len(points), -np.inf)
        np.maximum.at(heights, point, met)
        return heights


def _side(a: Floats, b: Floats, place: Floats) -> Floats:
    """Return twice the signed areas of (a, b, place); to the bit the negative of the same with a and b exchanged."""
    swap = (a[:, 0] > b[:, 0]) | ((a[:, 0] == b[:, 0]) & (a[:, 1] >= b[:, 1]))
    p, q = np.where(swap[:, None], b[:, :2], a[:, :2]), np.where(swap[:, None], a[:, :2], b[:, :2])
    area = (q[:, 0] - p[:, 0]) * (place[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (place[:, 0] - p[:, 0])
    return np.asarray(np.where(swap, -area, area))


def _holds(area: Floats, way: Floats) -> NDArray[np.bool_]:
    """Return which places are on the inner side of a counter-clockwise edge; on the edge itself one of both sides has them."""
    return np.asarray((area > 0) | ((area == 0) & ((way[:, 1] < 0) | ((way[:, 1] == 0) & (way[:, 0] > 0)))))
