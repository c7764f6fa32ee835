"""How deep places lie in a solid: the exact distance to its nearest triangle."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from app.dexel.solid import SolidStock
from app.dexel.solid_rays import SolidRays
from app.model.motion import Floats

STEPS = 5
"""Points of the metal that was cut over a cell that are asked, in each stretch of the solid."""


ASIDE = 1.3e-7
"""mm by which a line is moved, so that it hardly ever meets an edge, which two triangles share."""


class DepthInSolid:
    """Answers how deep vertical lines lie in a solid with stock to leave on it."""

    def __init__(self, solid: SolidStock, leave: float = 0.0) -> None:
        self._rays, self._leave = SolidRays(solid), leave

    def over(self, place: tuple[float, float], span: tuple[float, float], rough: float) -> float:
        """Return how deep the deepest of some points on a vertical line lies below the surface, mm, >= 0.

        Args:
            place: x, y of the line, mm.
            span: its low and its high end, mm; only what of it lies in the solid, and stock to leave above it, is asked.
            rough: about how deep that is, mm; twice as far away no triangle is looked for.
        """
        deepest = 0.0
        for low, high in self._stretches(place, span):
            deepest = max(deepest, *(self._leave + self._distance((*place, z), rough) for z in np.linspace(low, high, STEPS).tolist()))
        if self._leave and deepest == 0.0:  # only stock to leave was cut
            deepest = max(0.0, self._leave - self._distance((*place, span[0]), rough + self._leave))
        return deepest

    def _stretches(self, place: tuple[float, float], span: tuple[float, float]) -> Iterator[tuple[float, float]]:
        """Yield the parts of a vertical line that lie in the solid."""
        _, heights, up = self._rays.met(np.array([[place[0] + ASIDE, place[1] + ASIDE * 0.7]]))
        order = np.argsort(heights, kind="stable")
        solids = np.cumsum(-up[order])  # a face that looks down begins one, a face that looks up ends one
        for (low, high), within in zip(pairwise(heights[order].tolist()), solids.tolist(), strict=False):
            if within > 0 and min(high, span[1]) > max(low, span[0]):
                yield max(low, span[0]), min(high, span[1])

    def _distance(self, point: tuple[float, float, float], rough: float) -> float:
        """Return the distance to the nearest triangle, mm."""
        from trimesh import triangles

        closest_point: Callable[[Floats, Floats], Floats] = triangles.closest_point
        x, y, _ = point
        far = 2 * rough + 1e-6
        while True:
            near = self._rays.near(x, y, far)
            if len(near):
                there = closest_point(near, np.broadcast_to(np.array(point), (len(near), 3)))
                least = float(np.min(np.linalg.norm(there - np.array(point), axis=1)))
                if least <= far or len(near) == len(self._rays.triangles):
                    return least
            far *= 2
