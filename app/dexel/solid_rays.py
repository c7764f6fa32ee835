"""Vertical lines through a solid of triangles: where they meet it, and which triangles are near."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from app.dexel.solid import SolidStock
from app.model.motion import Floats


class SolidRays:
    """Answers where vertical lines meet a solid; its triangles are found by their boxes as seen from above."""

    def __init__(self, solid: SolidStock) -> None:
        self.triangles = solid.triangles
        low, high = self.triangles.min(axis=1), self.triangles.max(axis=1)
        self._boxes = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))

    def met(self, points: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return where the lines through points (m, 2) meet triangles, each meeting of n: point, height in mm, 1 = it looks up, -1 = down.

        A line through an edge meets both of its triangles; upright triangles are met by none.
        """
        point, triangle = self._boxes.query(shapely.points(points))
        a, b, c = np.moveaxis(self.triangles[triangle], 1, 0)
        x, y = points[point].T
        sides = [(q[:, 0] - p[:, 0]) * (y - p[:, 1]) - (q[:, 1] - p[:, 1]) * (x - p[:, 0]) for p, q in ((b, c), (c, a), (a, b))]
        total = sides[0] + sides[1] + sides[2]
        met = (total != 0) & ~np.any([side * np.sign(total) < 0 for side in sides], axis=0)
        heights = (sides[0] * a[:, 2] + sides[1] * b[:, 2] + sides[2] * c[:, 2])[met] / total[met]
        return point[met], heights, np.sign(total[met])

    def tops(self, points: Floats) -> Floats:
        """Return the solid's top (m,) over points (m, 2), mm; -infinite beside it."""
        point, met, _ = self.met(points)
        heights = np.full(len(points), -np.inf)
        np.maximum.at(heights, point, met)
        return heights

    def near(self, x: float, y: float, far: float) -> Floats:
        """Return the triangles (k, 3, 3) whose boxes, seen from above, come into the square of half side `far` mm round a place."""
        return np.asarray(self.triangles[self._boxes.query(shapely.box(x - far, y - far, x + far, y + far))])
