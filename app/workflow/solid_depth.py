"""How deep places lie in a solid: the exact distance to its nearest triangle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.dexel.solid import SolidStock
from app.model.motion import Floats

STEPS = 5
"""Points of the metal that was cut over a cell that are asked."""


def depth_in_solid(solid: SolidStock, place: tuple[float, float], low: float, high: float) -> float:
    """Return how deep the deepest of some points on a vertical line lies in a solid, mm.

    Args:
        solid: closed.
        place: x, y of the line, mm.
        low, high: of the line in the solid, mm; the points are spread over it.
    """
    from trimesh import triangles

    closest_point: Callable[[Floats, Floats], Floats] = triangles.closest_point
    z = np.linspace(low, high, STEPS)
    points = np.column_stack([np.full(STEPS, place[0]), np.full(STEPS, place[1]), z])
    corners = solid.triangles
    least, most = corners.min(axis=1), corners.max(axis=1)
    box = np.maximum(np.maximum(least - points[:, None], points[:, None] - most), 0.0)
    far = np.linalg.norm(box, axis=2)  # no triangle is nearer than its box
    vertex = np.min(np.linalg.norm(corners.reshape(1, -1, 3) - points[:, None], axis=2), axis=1)
    deepest = 0.0
    for point, boxes, known in zip(points, far, vertex, strict=True):
        near = corners[boxes <= known]
        there = closest_point(near, np.broadcast_to(point, (len(near), 3)))
        deepest = max(deepest, float(np.min(np.linalg.norm(there - point, axis=1))))
    return deepest
