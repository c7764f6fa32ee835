"""Distances from lines and arcs, each by itself: what fitted curves are held against."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app.model.curves import Arc, Line

Floats = NDArray[np.float64]


def distances(points: Floats, primitives: Sequence[Line | Arc]) -> Floats:
    """Return the distance (m,) of points (m, 2) from the nearest of some primitives, mm."""
    result = np.full(len(points), np.inf)
    for primitive in primitives:
        result = np.minimum(result, _distance(points, primitive))
    return result


def _distance(points: Floats, primitive: Line | Arc) -> Floats:
    (ax, ay), (bx, by) = primitive.start, primitive.end
    px, py = points[:, 0] - ax, points[:, 1] - ay
    if isinstance(primitive, Line):
        dx, dy = bx - ax, by - ay
        share = np.clip((px * dx + py * dy) / max(dx * dx + dy * dy, 1e-300), 0.0, 1.0)
        return np.hypot(px - share * dx, py - share * dy)
    cx, cy = primitive.centre[0] - ax, primitive.centre[1] - ay
    radius = math.hypot(cx, cy)
    qx, qy = px - cx, py - cy
    radial = np.abs((px * px + py * py - 2 * (px * cx + py * cy)) / (np.hypot(qx, qy) + radius))
    angle = np.arctan2(-cx * qy + cy * qx, -cx * qx - cy * qy)
    sweep = primitive.sweep
    turn = np.mod(angle if sweep > 0 else -angle, math.tau)
    ends = np.minimum(np.hypot(px, py), np.hypot(points[:, 0] - bx, points[:, 1] - by))
    return np.where(turn <= abs(sweep), radial, ends)
