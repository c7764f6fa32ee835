"""What draughtsmen do with curves that meet: trim, extend, break, parallels. Curves in, curves out."""

from __future__ import annotations

import math
from collections.abc import Iterable

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...geometry.sample import Box, bounds
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from ..curves.intersections import intersection_points, lies_on, nearest_point
from ..curves.shapes import shown
from .split import split

_WHOLE = 1e-9
"""Radians of an ellipse's parameter by which a whole turn may be short: an angle, whatever the size, so no length says
it.
"""


def trimmed(curve: Curve, at: Point, edges: Iterable[Curve]) -> tuple[Curve, ...]:
    """Return what stays of a curve when the piece at a point is taken out, up to the nearest edges on both sides.

    Raises:
        InputError: no edge meets the curve.
    """
    box = _grown(bounds(curve))
    cuts = [p for edge in edges if _may_reach(edge, box) for p in intersection_points(curve, edge)]
    pieces = split(curve, cuts)
    if len(pieces) == 1 and not _closed(curve):
        raise InputError(f"Nothing crosses the curve near {shown(at)}; draw an edge across it, or delete it.")
    if len(pieces) == 1:
        raise InputError("A closed curve must be crossed twice to be trimmed; draw another edge across it.")
    gone = min(pieces, key=lambda piece: math.dist(nearest_point(piece, at), at))
    pieces = split(curve, [gone.start, gone.end])  # not at the edges beyond these two
    nearest = min(pieces, key=lambda piece: math.dist(nearest_point(piece, at), at))
    return tuple(piece for piece in pieces if piece is not nearest)


def _grown(box: Box) -> Box:
    return (box[0] - WELD, box[1] - WELD, box[2] + WELD, box[3] + WELD)


def _may_reach(curve: Curve, box: Box) -> bool:
    """Return False where a curve surely has no point in a box: quickly, for ten thousand of them."""
    x0, y0, x1, y1 = box
    if isinstance(curve, Line):
        (ax, ay), (bx, by) = curve.start, curve.end
        return not ((ax < x0 and bx < x0) or (ax > x1 and bx > x1) or (ay < y0 and by < y0) or (ay > y1 and by > y1))
    if isinstance(curve, Arc | Circle):
        (x, y), r = curve.centre, curve.radius
        return x + r >= x0 and x - r <= x1 and y + r >= y0 and y - r <= y1
    return True


def extended(curve: Curve, at: Point, edges: Iterable[Curve]) -> Curve:
    """Return a line or arc whose end nearest to a point goes on to the first edge.

    Raises:
        InputError: the curve is neither, or no edge lies ahead.
    """
    if not isinstance(curve, Line | Arc):
        raise InputError("Only lines and arcs can be extended; draw on from the end of other curves.")
    forward = math.dist(at, curve.end) <= math.dist(at, curve.start)
    found = [p for edge in edges for p in _met_ahead(curve, edge) if not between(curve, p)]
    ends = curve.start, curve.end  # an arc that went on to its own other end would be a circle
    ahead = [
        (way, p)
        for p in found
        if (way := way_ahead(curve, p, forward)) > WELD and min(math.dist(p, end) for end in ends) > WELD
    ]
    if not ahead:
        raise InputError(
            f"No edge lies ahead of the end at {shown(curve.end if forward else curve.start)}; draw one, or give the "
            "length."
        )
    to = min(ahead)[1]
    start, end = (curve.start, to) if forward else (to, curve.end)
    return Line(start, end) if isinstance(curve, Line) else Arc(start, end, curve.centre, curve.ccw)


def broken(curve: Curve, first: Point, second: Point | None) -> tuple[Curve, ...]:
    """Return a curve in two pieces at a point, or without what lies between two points.

    Of a closed curve what lies from the first point to the second in its direction goes.

    Raises:
        InputError: the point lies at an end, or a closed curve is broken at one point.
    """
    a = nearest_point(curve, first)
    if second is None:
        if _closed(curve):
            raise InputError("A closed curve is broken at two points; give another one.")
        pieces = split(curve, [a])
        if len(pieces) < 2:
            raise InputError(f"{shown(a)} is an end of the curve; give a point between its ends.")
        return pieces
    b = nearest_point(curve, second)
    if math.dist(a, b) < WELD:
        raise InputError("Both points are the same place of the curve; give two, or one alone.")
    pieces = split(curve, [a, b])
    if _closed(curve):
        return tuple(p for p in pieces if math.dist(p.start, a) >= WELD)
    return tuple(p for p in pieces if not {_is_at(p.start, a, b), _is_at(p.end, a, b)} >= {1, 2})


def _is_at(point: Point, a: Point, b: Point) -> int:
    return 1 if math.dist(point, a) < WELD else 2 if math.dist(point, b) < WELD else 0


def parallel(curve: Line | Arc | Circle, away: float, side: Point) -> Curve:
    """Return the parallel of a line, arc or circle at a distance, on the side of a point.

    Raises:
        InputError: the inner parallel is none.
    """
    if isinstance(curve, Line):
        return min(beside(curve, away), key=lambda line: math.dist(touch_of(line, side), side))
    outside = math.dist(side, curve.centre) > curve.radius
    radius = curve.radius + (away if outside else -away)
    if radius < WELD:
        raise InputError(f"The radius is {curve.radius:.3f} mm; its inner parallel must be nearer than that.")
    if isinstance(curve, Circle):
        return Circle(curve.centre, radius, curve.ccw)
    (x, y), grown = curve.centre, radius / curve.radius
    start, end = ((x + (p[0] - x) * grown, y + (p[1] - y) * grown) for p in (curve.start, curve.end))
    return Arc(start, end, curve.centre, curve.ccw)


def _closed(curve: Curve) -> bool:
    if isinstance(curve, Ellipse):
        return curve.end_parameter - curve.start_parameter > math.tau - _WHOLE
    return isinstance(curve, Circle)


def _met_ahead(curve: Line | Arc, edge: Curve) -> list[Point]:
    """Return where a line or arc without ends meets an edge."""
    if isinstance(edge, Line | Arc | Circle):
        return [p for p in intersection_points(curve, edge, extended=True) if lies_on(edge, p)]
    return intersection_points(_whole(curve), edge)


def _whole(curve: Line | Arc) -> Curve:
    """Return the circle of an arc, or a line so long that it reaches everything drawn."""
    if isinstance(curve, Arc):
        return Circle(curve.centre, curve.radius)
    size = math.dist(curve.start, curve.end)
    ux, uy = (curve.end[0] - curve.start[0]) / size * 1e5, (curve.end[1] - curve.start[1]) / size * 1e5
    return Line((curve.start[0] - ux, curve.start[1] - uy), (curve.end[0] + ux, curve.end[1] + uy))


def between(curve: Curve, point: Point) -> bool:
    """Return whether a point of the endless line or whole circle lies within a curve, not at its ends."""
    return lies_on(curve, point) and min(math.dist(point, curve.start), math.dist(point, curve.end)) > WELD


def way_ahead(curve: Line | Arc, point: Point, forward: bool) -> float:
    """Return how far beyond an end a point of the endless line or whole circle lies, along it."""
    end, other = (curve.end, curve.start) if forward else (curve.start, curve.end)
    if isinstance(curve, Line):
        size = math.dist(curve.start, curve.end)
        return ((point[0] - end[0]) * (end[0] - other[0]) + (point[1] - end[1]) * (end[1] - other[1])) / size
    (x, y) = curve.centre
    turn = math.atan2(point[1] - y, point[0] - x) - math.atan2(end[1] - y, end[0] - x)
    return curve.radius * ((turn if forward == (curve.sweep > 0) else -turn) % math.tau)


def beside(line: Line, away: float) -> tuple[Line, Line]:
    """Return the parallels of a line at a distance, on its left and on its right."""
    size = math.dist(line.start, line.end)
    ox, oy = -(line.end[1] - line.start[1]) / size * away, (line.end[0] - line.start[0]) / size * away
    (ax, ay), (bx, by) = line.start, line.end
    return Line((ax + ox, ay + oy), (bx + ox, by + oy)), Line((ax - ox, ay - oy), (bx - ox, by - oy))


def touch_of(curve: Line | Arc | Circle, centre: Point, radius: float = 0.0) -> Point:
    """Return the point of the endless line or whole circle that is nearest to a centre.

    Of a circle that another of `radius` about the centre holds within itself it is the farthest point: there they
    touch.
    """
    if not isinstance(curve, Line):
        away = math.dist(centre, curve.centre)
        (x, y), r = curve.centre, curve.radius
        if abs(away + r - radius) < abs(abs(away - r) - radius):
            r = -r
        return (x + (centre[0] - x) / away * r, y + (centre[1] - y) / away * r) if away > 0 else curve.start
    dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
    along = ((centre[0] - curve.start[0]) * dx + (centre[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
    return (curve.start[0] + along * dx, curve.start[1] + along * dy)
