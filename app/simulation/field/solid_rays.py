"""Vertical lines through a solid of triangles: where they meet it."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .solid import SolidStock
from .triangle_tree import TriangleTree


class SolidRays:
    """Answers where vertical lines meet a solid."""

    def __init__(self, solid: SolidStock) -> None:
        self.triangles = solid.triangles

    @cached_property
    def tree(self) -> TriangleTree:
        """Of the solid's triangles."""
        return TriangleTree.of(self.triangles)

    def met(self, points: Floats) -> tuple[NDArray[np.int64], Floats, Floats]:
        """Return where the lines through points (m, 2) meet triangles, each meeting of n: point, height in mm, 1 = it looks up, -1 = down.

        A line through an edge meets one of its two triangles, so that what is met going up is left again in a closed solid, whatever
        edges and corners the line goes through; upright triangles are met by none.
        """
        return self.tree.met(points)

    def tops(self, points: Floats) -> Floats:
        """Return the solid's top (m,) over points (m, 2), mm; -infinite beside it."""
        return self.tree.tops(points)
