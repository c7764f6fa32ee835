"""Vertical lines through a solid of triangles: where they meet it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .solid import SolidStock


class SolidRays:
    """Answers where vertical lines meet a solid."""

    def __init__(self, solid: SolidStock) -> None:
        self._solid = solid

    def met(self, points: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return where the lines through points (m, 2) meet triangles, each meeting of n: point, height in mm, 1 = it
        looks up, -1 = down.

        A line through an edge meets one of its two triangles, so that what is met going up is left again in a closed
        solid, whatever edges and corners the line goes through; upright triangles are met by none.
        """
        return self._solid.tree.met(points)

    def tops(self, points: Floats) -> Floats:
        """Return the solid's top (m,) over points (m, 2), mm; -infinite beside it."""
        return self._solid.tree.tops(points)
