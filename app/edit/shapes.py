"""Curves from the points that a draughtsman gives, and their lengths."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from app.edit.sample import sample, spline_points
from app.errors import InputError
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from app.tolerances import WELD

_FIT = 1e-3
"""Ends of an arc whose distances from the centre differ by up to this are drawn with the centre moved between them, mm."""


def shown(point: Point) -> str:
    """Return a point as the user reads it, mm with 3 decimals."""
    return f"({point[0]:.3f}, {point[1]:.3f})"


def lines_through(points: list[Point], close: bool = False) -> tuple[Line, ...]:
    """Return the lines from point to point.

    Raises:
        InputError: fewer than two points, neighbours that are the same, or a close with fewer than three points.
    """
    if len(points) < 2:
        raise InputError("A line needs two points or more; write line x,y x,y.")
    if close and len(points) < 3:
        raise InputError("Closing needs three points or more; add a point before close.")
    ring = [*points, points[0]] if close else points
    for number, (a, b) in enumerate(pairwise(ring), start=1):
        if math.dist(a, b) < WELD:
            raise InputError(f"Point {number + 1} is the same as point {number}, {shown(a)}; leave one of them out.")
    return tuple(Line(a, b) for a, b in pairwise(ring))


def rectangle(a: Point, b: Point) -> tuple[Line, ...]:
    """Return the four sides of the rectangle with these opposite corners, counter-clockwise from its lower left.

    Raises:
        InputError: it has no width or no height.
    """
    (x0, x1), (y0, y1) = sorted((a[0], b[0])), sorted((a[1], b[1]))
    if x1 - x0 < WELD or y1 - y0 < WELD:
        raise InputError(f"The rectangle is {x1 - x0:.3f} by {y1 - y0:.3f} mm; give opposite corners that differ in x and in y.")
    return lines_through([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], close=True)


def circle(centre: Point, radius: float) -> Circle:
    """Return a circle.

    Raises:
        InputError: the radius is not greater than 0.
    """
    if radius < WELD:
        raise InputError(f"The radius is {radius:.3f} mm; it must be greater than 0.")
    return Circle(centre, radius)


def arc_about(start: Point, end: Point, centre: Point, ccw: bool = True) -> Arc:
    """Return the arc from start to end about a centre, which must be equally far from both within 1 um.

    The ends are kept exactly; the centre moves onto their perpendicular bisector by what little it is off.

    Raises:
        InputError: the ends are the same, or one is nearer to the centre.
    """
    if math.dist(start, end) < WELD:
        raise InputError(f"The arc begins and ends at {shown(start)}; draw a full circle with circle x,y r.")
    a, b = math.dist(start, centre), math.dist(end, centre)
    if abs(a - b) > _FIT or min(a, b) < WELD:
        raise InputError(f"The start is {a:.3f} mm from the centre and the end {b:.3f} mm; both must be equally far. "
                         f"Move the end to {shown(on_circle(end, centre, a))}.")
    dx, dy = end[0] - start[0], end[1] - start[1]
    middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    along = ((centre[0] - middle[0]) * dx + (centre[1] - middle[1]) * dy) / (dx * dx + dy * dy)
    return Arc(start, end, (centre[0] - along * dx, centre[1] - along * dy), ccw)


def on_circle(towards: Point, centre: Point, radius: float) -> Point:
    """Return the point of a circle in the direction of another point (at angle 0 for the centre itself)."""
    turn = math.atan2(towards[1] - centre[1], towards[0] - centre[0])
    return (centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn))


def arc_through(start: Point, via: Point, end: Point) -> Arc:
    """Return the arc from start by way of a point to the end.

    Raises:
        InputError: two of the points are the same, or all lie on a straight line.
    """
    if math.dist(start, end) < WELD or math.dist(start, via) < WELD or math.dist(via, end) < WELD:
        raise InputError("Two of the three points of the arc are the same; give three different points.")
    (ax, ay), (bx, by) = (via[0] - start[0], via[1] - start[1]), (end[0] - start[0], end[1] - start[1])
    cross = ax * by - ay * bx
    height = abs(cross) / math.hypot(bx, by)
    if height < WELD:
        raise InputError(f"The three points of the arc lie on a straight line at {shown(via)}; move the middle one off it.")
    aa, bb = ax * ax + ay * ay, bx * bx + by * by
    centre = (start[0] + (by * aa - ay * bb) / (2 * cross), start[1] + (ax * bb - bx * aa) / (2 * cross))
    return Arc(start, end, centre, ccw=cross > 0)


def curve_length(curve: Curve) -> float:
    """Return the length of a curve, mm: exact for lines, arcs and circles, that of the samples for others."""
    if isinstance(curve, Line):
        return math.dist(curve.start, curve.end)
    if isinstance(curve, Arc):
        return curve.radius * abs(curve.sweep)
    if isinstance(curve, Circle):
        return math.tau * curve.radius
    return float(np.hypot(*np.diff(sample(curve), axis=0).T).sum())


def middle_of(curve: Curve) -> Point:
    """Return the point half way along a line or arc, or between the ends of an ellipse's or spline's parameters, mm."""
    if isinstance(curve, Line):
        return ((curve.start[0] + curve.end[0]) / 2, (curve.start[1] + curve.end[1]) / 2)
    if isinstance(curve, Arc):
        turn = curve.start_angle + curve.sweep / 2
        return (curve.centre[0] + curve.radius * math.cos(turn), curve.centre[1] + curve.radius * math.sin(turn))
    if isinstance(curve, Circle):
        return (curve.centre[0] - curve.radius, curve.centre[1])
    if isinstance(curve, Ellipse):
        return curve.at((curve.start_parameter + curve.end_parameter) / 2)
    x, y = spline_points(curve, np.array([(curve.knots[0] + curve.knots[-1]) / 2]))[0]
    return (float(x), float(y))


def centre_of(curve: Curve) -> Point:
    """Return the centre of an arc, circle or ellipse, mm.

    Raises:
        InputError: the curve has none.
    """
    if isinstance(curve, Arc | Circle | Ellipse):
        return curve.centre
    raise InputError("A line or spline has no centre; name an arc, a circle or an ellipse.")


def radius_of(curve: Curve) -> float:
    """Return the radius of an arc or circle, mm.

    Raises:
        InputError: the curve has none.
    """
    if isinstance(curve, Arc | Circle):
        return curve.radius
    raise InputError("Only arcs and circles have a radius; name one of these.")
