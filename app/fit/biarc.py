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

    () where the directions turn back so far that there is no such pair.
    """
    from app.fit.biarc_kernels import meeting

    exists, *middle = meeting(start, leaving, end, arriving)
    if not exists:
        return ()
    first = _from_tangent(start, leaving, (middle[0], middle[1]))
    last = _from_tangent(end, (-arriving[0], -arriving[1]), (middle[0], middle[1]))
    if first is None or last is None:
        return ()
    off = abs((end[0] - start[0]) * leaving[1] - (end[1] - start[1]) * leaving[0])
    if isinstance(first, Line) and isinstance(last, Line) and off < tolerances.WELD:
        return (Line(start, end),)
    return first, _turned(last)


def _turned(curve: Line | Arc) -> Line | Arc:
    if isinstance(curve, Line):
        return Line(curve.end, curve.start)
    return Arc(curve.end, curve.start, curve.centre, not curve.ccw)


def _from_tangent(start: Point, direction: Point, end: Point) -> Line | Arc | None:
    """Return what leaves start in a unit direction and ends at end; None where it would turn by half a circle or more."""
    from app.fit.biarc_kernels import LINE, NONE, from_tangent

    kind, cx, cy, turn = from_tangent(start, direction, end)
    if kind == NONE:
        return None
    return Line(start, end) if kind == LINE else Arc(start, end, (cx, cy), turn > 0)


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
