"""Two arcs that meet smoothly between two points with given tangents, and distances from them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from app import tolerances
from app.model.curves import Arc, Line, Point

Floats = NDArray[np.float64]


def biarc(start: Point, leaving: Point, end: Point, arriving: Point) -> tuple[Line | Arc, ...]:
    """Return one line, or two arcs (either may be a line), tangent to both unit directions and to one another.

    The point where they meet is the middle between the tips of two tangents of one length: Bolton (1975),
    "Biarc curves". Returns () where the directions turn back so far that there is no such pair.
    """
    vx, vy = end[0] - start[0], end[1] - start[1]
    chord2 = vx * vx + vy * vy
    sx, sy = leaving[0] + arriving[0], leaving[1] + arriving[1]
    lean = vx * sx + vy * sy
    spread = 2 * (1 - leaving[0] * arriving[0] - leaving[1] * arriving[1])
    root = lean + math.sqrt(lean * lean + spread * chord2)
    if root <= 0.0 or chord2 == 0.0:
        return ()
    reach = chord2 / root
    middle = ((start[0] + end[0] + reach * (leaving[0] - arriving[0])) / 2, (start[1] + end[1] + reach * (leaving[1] - arriving[1])) / 2)
    first, last = _from_tangent(start, leaving, middle), _from_tangent(end, (-arriving[0], -arriving[1]), middle)
    if first is None or last is None:
        return ()
    if isinstance(first, Line) and isinstance(last, Line) and abs(vx * leaving[1] - vy * leaving[0]) < tolerances.WELD:
        return (Line(start, end),)
    return first, _turned(last)


def _turned(curve: Line | Arc) -> Line | Arc:
    if isinstance(curve, Line):
        return Line(curve.end, curve.start)
    return Arc(curve.end, curve.start, curve.centre, not curve.ccw)


def _from_tangent(start: Point, direction: Point, end: Point) -> Line | Arc | None:
    """Return the arc that leaves start in a unit direction and ends at end; a line where its sagitta is below WELD.

    None where the arc would turn by half a circle or more.
    """
    vx, vy = end[0] - start[0], end[1] - start[1]
    side, ahead = direction[0] * vy - direction[1] * vx, direction[0] * vx + direction[1] * vy
    if ahead <= 0.0:
        return None
    if abs(side) / 4 < tolerances.WELD / 2:
        return Line(start, end)
    height = ahead / side / 2
    return Arc(start, end, ((start[0] + end[0]) / 2 - vy * height, (start[1] + end[1]) / 2 + vx * height), side > 0)


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
