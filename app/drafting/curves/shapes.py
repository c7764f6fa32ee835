"""Curves from the points that a draughtsman gives, and their lengths."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...geometry.sample import Points, sample, spline_points
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

_ROUNDING = 1e-12
"""Distances that differ by no more than this share of the coordinates are the same but for the last digits of a
number.
"""

_FIT = 1e-3
"""Ends of an arc whose distances from the centre differ by up to this are drawn with the centre moved between them,
mm.
"""


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
        raise InputError(
            f"The rectangle is {x1 - x0:.3f} by {y1 - y0:.3f} mm; give opposite corners that differ in x and in y."
        )
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

    The ends are kept exactly; the centre moves onto their perpendicular bisector where it is off by more than rounding.

    Raises:
        InputError: the ends are the same, or one is nearer to the centre.
    """
    if math.dist(start, end) < WELD:
        raise InputError(f"The arc begins and ends at {shown(start)}; draw a full circle with circle x,y r.")
    a, b = math.dist(start, centre), math.dist(end, centre)
    if abs(a - b) <= _ROUNDING * max(a, *map(abs, (*start, *end))) and min(a, b) >= WELD:
        return Arc(start, end, centre, ccw)
    if abs(a - b) > _FIT or min(a, b) < WELD:
        raise InputError(
            f"The start is {a:.3f} mm from the centre and the end {b:.3f} mm; both must be equally far. "
            f"Move the end to {shown(on_circle(end, centre, a))}."
        )
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
        raise InputError(
            f"The three points of the arc lie on a straight line at {shown(via)}; move the middle one off it."
        )
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


def arc_of_radius(start: Point, end: Point, radius: float, ccw: bool = True, large: bool = False) -> Arc:
    """Return the arc between two points with a radius: the smaller of the two, or the larger one.

    Raises:
        InputError: the ends are the same, or farther apart than the diameter.
    """
    chord = math.dist(start, end)
    if chord < WELD:
        raise InputError(f"The arc begins and ends at {shown(start)}; draw a full circle with circle x,y r.")
    if chord > 2 * radius * (1 + 1e-12):
        raise InputError(
            f"The ends are {chord:.3f} mm apart, more than the diameter; the radius must be {chord / 2:.3f} mm or more."
        )
    off = math.sqrt(max(radius * radius - chord * chord / 4, 0.0)) * (1 if ccw != large else -1)
    ux, uy = (end[0] - start[0]) / chord, (end[1] - start[1]) / chord
    centre = ((start[0] + end[0]) / 2 - off * uy, (start[1] + end[1]) / 2 + off * ux)
    return Arc(start, end, centre, ccw)


def arc_along(start: Point, heading: float, end: Point) -> Arc:
    """Return the arc that leaves a point in a direction, radians, and ends at another.

    Raises:
        InputError: the end lies straight ahead or behind.
    """
    ux, uy = math.cos(heading), math.sin(heading)
    dx, dy = end[0] - start[0], end[1] - start[1]
    cross = ux * dy - uy * dx
    if abs(cross) < WELD:
        raise InputError(f"{shown(end)} lies straight ahead or behind; draw a line there, or move the end aside.")
    radius = (dx * dx + dy * dy) / (2 * cross)
    return Arc(start, end, (start[0] - uy * radius, start[1] + ux * radius), ccw=cross > 0)


def circle_through(a: Point, b: Point, c: Point) -> Circle:
    """Return the circle through three points.

    Raises:
        InputError: two are the same, or all lie on a straight line.
    """
    arc = arc_through(a, b, c)
    return Circle(arc.centre, arc.radius)


def rounded_rectangle(a: Point, b: Point, radius: float) -> tuple[Line | Arc, ...]:
    """Return the rectangle with these opposite corners and quarter circles at all four, counter-clockwise.

    Raises:
        InputError: no width, no height, or a radius that does not fit.
    """
    sides = rectangle(a, b)
    (x0, y0), (x1, y1) = sides[0].start, sides[1].end
    room = min(x1 - x0, y1 - y0) / 2
    if not WELD <= radius <= room:
        raise InputError(
            f"The radius is {radius:.3f} mm; it must be greater than 0 and at most {room:.3f} mm, half the shorter "
            "side."
        )
    r, made = radius, list[Line | Arc]()
    points = [
        (x0 + r, y0),
        (x1 - r, y0),
        (x1, y0 + r),
        (x1, y1 - r),
        (x1 - r, y1),
        (x0 + r, y1),
        (x0, y1 - r),
        (x0, y0 + r),
    ]
    centres = [(x1 - r, y0 + r), (x1 - r, y1 - r), (x0 + r, y1 - r), (x0 + r, y0 + r)]
    for k in range(4):
        p, q, onward = points[2 * k], points[2 * k + 1], points[(2 * k + 2) % 8]
        made += [Line(p, q)] * (math.dist(p, q) >= WELD)
        made.append(Arc(q, onward, centres[k]))
    return tuple(made)


def polygon(centre: Point, corners: int, first: Point) -> tuple[Line, ...]:
    """Return the regular polygon about a centre with its first corner at a point, counter-clockwise.

    Raises:
        InputError: the corner is the centre.
    """
    radius, begin = math.dist(centre, first), math.atan2(first[1] - centre[1], first[0] - centre[0])
    if radius < WELD:
        raise InputError("The polygon has no size; give a corner away from its centre.")
    turns = [begin + math.tau * k / corners for k in range(1, corners)]
    return lines_through(
        [first, *((centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t)) for t in turns)], close=True
    )


def slot(a: Point, b: Point, width: float) -> tuple[Line | Arc, ...]:
    """Return the outline of everything within half a width of a straight line, counter-clockwise.

    Raises:
        InputError: the line has no length, or the slot no width.
    """
    size, r = math.dist(a, b), width / 2
    if size < WELD or r < WELD:
        raise InputError(
            f"The slot is {size:.3f} mm between its centres and {width:.3f} mm wide; both must be greater than 0."
        )
    ox, oy = (b[1] - a[1]) / size * r, -(b[0] - a[0]) / size * r
    p, q, s, t = (a[0] + ox, a[1] + oy), (b[0] + ox, b[1] + oy), (b[0] - ox, b[1] - oy), (a[0] - ox, a[1] - oy)
    return (Line(p, q), Arc(q, s, b), Line(s, t), Arc(t, p, a))


def ellipse(
    centre: Point, end: Point, half: float, span: tuple[float, float] = (0.0, math.tau), ccw: bool = True
) -> Ellipse:
    """Return an ellipse, or a part of it.

    Args:
        end: of one half axis. half: length of the other, mm.
        span: range of the parameter from `end` on, radians.

    Raises:
        InputError: a half axis without length, or an empty span.
    """
    along = (end[0] - centre[0], end[1] - centre[1])
    size = math.hypot(*along)
    if size < WELD or half < WELD:
        raise InputError(f"The half axes are {size:.3f} and {half:.3f} mm; both must be greater than 0.")
    first, last = span
    if not 1e-9 < last - first <= math.tau + 1e-9:
        raise InputError("The part of an ellipse spans more than 0\u00b0 and at most 360\u00b0.")
    if half > size * (1 + 1e-12):  # a hair more is the rounding of a text
        turned = (-along[1] * half / size, along[0] * half / size)
        return Ellipse(centre, turned, size / half, first - math.pi / 2, last - math.pi / 2, ccw)
    return Ellipse(centre, along, min(half / size, 1.0), first, last, ccw)


def spline_through(points: list[Point], close: bool = False) -> Spline:
    """Return the cubic spline through points, its parameter the way between them; C2, round the closing point too.

    Raises:
        InputError: fewer than three points, or neighbours that are the same.
    """
    if len(points) < 3:
        raise InputError("A spline needs three points or more; write spline x,y x,y x,y.")
    ring = [*points, points[0]] if close else points
    lines_through(ring)  # tells of neighbours that are the same
    from scipy.interpolate import CubicSpline  # not when the window opens

    way = np.concatenate([[0.0], np.cumsum([math.dist(a, b) for a, b in pairwise(ring)])])
    made = CubicSpline(way, np.array(ring), bc_type="periodic" if close else "natural")
    return _clamped(made, np.array(ring))


def _clamped(made: CubicSpline, points: Points) -> Spline:
    """Return a piecewise cubic through points as a B-spline with threefold knots, which holds every point to the last
    digit.
    """
    x = made.x
    knots = np.concatenate([[x[0]] * 4, *([k] * 3 for k in x[1:-1]), [x[-1]] * 4])
    starts, ends = points[:-1], points[1:]
    thirds = np.diff(x)[:, None] / 3
    inner = np.stack([starts, starts + made(x[:-1], 1) * thirds, ends - made(x[1:], 1) * thirds], axis=1).reshape(-1, 2)
    control = np.concatenate([inner, ends[-1:]])
    return Spline(3, tuple((float(u), float(v)) for u, v in control), tuple(map(float, knots)))
