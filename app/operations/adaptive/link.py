"""Smooth ways over clear ground: from a pose to another one by arcs and lines that touch.

A pose is a place and a direction of travel. Poses lie on the circles that paths take round the centres of discs, so a
smaller circle that touches such a circle from within lies in the disc as well: the way leaves along one of these, goes
straight, and comes in along another.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .cleared_discs import Point

Row = tuple[float, float, float, float, float, float, float, float]
Circle = tuple[float, float, float]

_TURNED = 0.3
"""Of the radius of the path round a disc: so large are the arcs of a way back over it."""

_SAME = 1e-9
"""Radians, and mm: what is as near is one angle or one place."""
_FLAT = 1e-4
"""Radians; a way that turns by less is straight, and its radius has no meaning."""
_HAIR = 2e-4
"""mm by which a circle may reach out of a disc that it touches."""

_HALVINGS = 12
"""Of the circle on which a way arrives, at most; then it arrives straight."""


@dataclass(frozen=True)
class PathPose:
    """Where a path ends or begins, on a circle counter-clockwise round the centre of a clear disc.

    Attributes:
        x, y: mm.
        angle: of the place, seen from the centre, radians; the path goes on a quarter turn to the left of that.
        turn: radius of the circle, mm.
    """

    x: float
    y: float
    angle: float
    turn: float

    def circle(self, share: float) -> Circle:
        """Return the circle of a share of the radius that touches the path here from within."""
        radius = share * self.turn
        return self.x - radius * math.cos(self.angle), self.y - radius * math.sin(self.angle), radius


def smooth_way(start: PathPose, end: PathPose, over: Sequence[Point], into: Circle) -> list[Row]:
    """Return rows from a pose to another one.

    Args:
        over: places that it goes over, rounded off at each.
        into: the circle in which the cutter's centre may be where the way comes in.
    """
    leaving, share = start.circle(_TURNED), _TURNED
    for _ in range(_HALVINGS):
        coming = end.circle(share)
        places = [_tangent(leaving, over[0] if over else None, coming)[0]]
        last = _tangent(leaving, None, coming)[1] if not over else _onto(over[-1], coming)
        if _swept(last, (end.x, end.y), coming) <= _inside(coming, (end.x, end.y), into) + _SAME:
            break
        share /= 2
    else:
        coming, last = (end.x, end.y, 0.0), (end.x, end.y)
        places = [_off(leaving, over[0] if over else last)]
    rows = _arc((start.x, start.y), places[0], leaving)
    rows += _rounded([places[0], *over, last])
    return rows + _arc(last, (end.x, end.y), coming)


def way_in(end: PathPose, into: Circle) -> list[Row]:
    """Return half a turn over clear ground to a pose, from where the cutter may come down."""
    share = _TURNED
    for _ in range(_HALVINGS):
        coming = end.circle(share)
        if _inside(coming, (end.x, end.y), into) >= math.pi:
            return _arc((2 * coming[0] - end.x, 2 * coming[1] - end.y), (end.x, end.y), coming)
        share /= 2
    return []


def _tangent(a: Circle, over: Point | None, b: Circle) -> tuple[Point, Point]:
    """Return where a straight way leaves one circle and comes onto another, both counter-clockwise."""
    if over is not None:
        return _off(a, over), over
    dx, dy = b[0] - a[0], b[1] - a[1]
    far = math.hypot(dx, dy)
    if far <= abs(a[2] - b[2]) + _SAME:
        at = math.atan2(dy, dx)
        return (a[0] + a[2] * math.cos(at), a[1] + a[2] * math.sin(at)), (
            b[0] + b[2] * math.cos(at),
            b[1] + b[2] * math.sin(at),
        )
    # the normal of the way points to its right, away from both centres
    at = math.atan2(dy, dx) - math.acos((a[2] - b[2]) / far)
    cosine, sine = math.cos(at), math.sin(at)
    return (a[0] + a[2] * cosine, a[1] + a[2] * sine), (b[0] + b[2] * cosine, b[1] + b[2] * sine)


def _off(a: Circle, to: Point) -> Point:
    """Return where a straight way to a place leaves a circle."""
    return _tangent(a, None, (*to, 0.0))[0]


def _onto(start: Point, b: Circle) -> Point:
    """Return where a straight way from a place comes onto a circle."""
    return _tangent((*start, 0.0), None, b)[1]


def _swept(a: Point, b: Point, circle: Circle) -> float:
    """Return the angle from a to b counter-clockwise round a circle; none where they are one place."""
    if math.dist(a, b) < _SAME:
        return 0.0
    first, last = (math.atan2(p[1] - circle[1], p[0] - circle[0]) for p in (a, b))
    return (last - first) % math.tau


def _inside(circle: Circle, end: Point, into: Circle) -> float:
    """Return the angle over which a circle, up to a place on it, lies within another one; a full turn if all does."""
    x, y, radius = circle
    away = math.hypot(x - into[0], y - into[1])
    if away + radius <= into[2] + _HAIR or radius == 0.0:
        return math.tau
    if away == 0.0:
        return 0.0
    share = (into[2] * into[2] - away * away - radius * radius) / (2 * away * radius)
    if share <= -1.0:
        return 0.0
    half = math.acos(min(1.0, share))
    ahead = math.atan2(y - into[1], x - into[0])
    at = (math.atan2(end[1] - y, end[0] - x) - ahead) % math.tau
    return at - half if half <= at <= math.tau - half + 1e-6 else 0.0


def _arc(a: Point, b: Point, circle: Circle) -> list[Row]:
    if circle[2] <= 0.0 or math.dist(a, b) < 1e-7:
        return []
    return [(*a, *b, *circle, 1.0)]


def _line(a: Point, b: Point) -> list[Row]:
    return [(*a, *b, 0.0, 0.0, 0.0, 0.0)] if math.dist(a, b) > 1e-7 else []


def _rounded(points: Sequence[Point]) -> list[Row]:
    """Return lines through points, the corners rounded with as large arcs as half of the lines leave room for."""
    rows: list[Row] = []
    at = points[0]
    for before, corner, after in zip(points, points[1:], points[2:], strict=False):
        came, goes = math.dist(before, corner), math.dist(corner, after)
        if min(came, goes) < 1e-6:
            continue
        ux, uy = (corner[0] - before[0]) / came, (corner[1] - before[1]) / came
        vx, vy = (after[0] - corner[0]) / goes, (after[1] - corner[1]) / goes
        turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)
        if abs(turn) < _FLAT or abs(turn) > math.pi - 0.05:
            rows += _line(at, corner)
            at = corner
            continue
        room = min(came, goes) / 2
        radius = room / math.tan(abs(turn) / 2)
        first = (corner[0] - room * ux, corner[1] - room * uy)
        last = (corner[0] + room * vx, corner[1] + room * vy)
        side = math.copysign(1.0, turn)
        centre = (first[0] - side * radius * uy, first[1] + side * radius * ux)
        rows += _line(at, first)
        rows.append((*first, *last, *centre, radius, side))
        at = last
    return rows + _line(at, points[-1])
