"""Curves that SVG can only draw in parts become whole again: circles and arcs of several arcs, splines of several
Béziers.
"""

from __future__ import annotations

import math
from itertools import groupby

from ...core import tolerances
from ...geometry.arcs.arcs import equally_far
from ...model.curves import Arc, Circle, Curve, Ellipse, Point, Spline

_TURN = 1e-9
"""Angles that differ by less are the same, radians."""
_LEVEL = 1e-9
"""Ends of an arc as equally far from its centre as this, mm, are left so: to level rounding over a short chord moves
the centre more.
"""
_CLOSED = 1e-6
"""An arc that lacks less than this of a full turn, radians, is left as its parts, for its chord tells too little."""


def joined(run: list[Curve]) -> list[Curve]:
    """Return the same line of curves with as few as draw it.

    Neighbouring arcs of one circle or ellipse, the same to WELD, become one; Béziers of one degree become one spline.

    Args:
        run: each begins where the one before ends; splines are of Béziers.
    """
    made: list[Curve] = []
    for degree, group in groupby(run, _degree):
        curves = list(group)
        if degree:
            made.append(_spline(degree, curves))
            continue
        for curve in curves:
            both = _both(made[-1], curve) if made else None
            if both is None:
                made.append(curve)
            else:
                made[-1] = both
    return made


def beziers_joined(run: list[Curve]) -> list[Curve]:
    """Return the same line of curves, neighbouring Béziers of one degree as one spline.

    Exact wherever the curves will be moved to: so many are moved as one.
    """
    made: list[Curve] = []
    for degree, group in groupby(run, _degree):
        curves = list(group)
        made += [_spline(degree, curves)] if degree else curves
    return made


def _degree(curve: Curve) -> int:
    return curve.degree if isinstance(curve, Spline) else 0


def _spline(degree: int, parts: list[Curve]) -> Spline:
    """Return splines that follow one another, each of Béziers, as one."""
    points = [parts[0].start] + [p for part in parts if isinstance(part, Spline) for p in part.control_points[1:]]
    count = (len(points) - 1) // degree
    inner = [float(k) for k in range(1, count) for _ in range(degree)]
    return Spline(degree, tuple(points), (0.0,) * (degree + 1) + tuple(inner) + (float(count),) * (degree + 1))


def _both(a: Curve, b: Curve) -> Curve | None:
    """Return one curve for two neighbours, or None where they are not of one circle or ellipse."""
    if isinstance(a, Arc) and isinstance(b, Arc):
        return _arcs(a, b)
    return _ellipses(a, b) if isinstance(a, Ellipse) and isinstance(b, Ellipse) else None


def _arcs(a: Arc, b: Arc) -> Arc | Circle | None:
    if a.ccw != b.ccw or math.dist(a.centre, b.centre) > tolerances.WELD or abs(a.radius - b.radius) > tolerances.WELD:
        return None
    first, second = abs(a.sweep), abs(b.sweep)
    centre = _between(a.centre, b.centre, first / (first + second))
    if abs(first + second - math.tau) < _CLOSED and math.dist(a.start, b.end) < tolerances.WELD:
        return Circle(centre, (math.dist(a.start, centre) + math.dist(a.end, centre)) / 2, a.ccw)
    if first + second > math.tau - _CLOSED:
        return None
    if abs(math.dist(a.start, centre) - math.dist(b.end, centre)) > _LEVEL:
        centre = equally_far(a.start, b.end, centre)
    return Arc(a.start, b.end, centre, a.ccw)


def _ellipses(a: Ellipse, b: Ellipse) -> Ellipse | None:
    near = (
        math.dist(a.centre, b.centre) <= tolerances.WELD
        and abs(a.ratio - b.ratio) * math.hypot(*a.major) <= tolerances.WELD
    )
    along = min(math.dist(a.major, b.major), math.dist(a.major, (-b.major[0], -b.major[1])))
    first, second = a.end_parameter - a.start_parameter, b.end_parameter - b.start_parameter
    whole = first + second
    if a.ccw != b.ccw or not near or along > tolerances.WELD or whole > math.tau + _TURN:
        return None
    start = a.start_parameter if a.ccw else a.start_parameter - second
    centre = _between(a.centre, b.centre, first / whole)
    return Ellipse(centre, a.major, a.ratio, start, start + (math.tau if whole > math.tau - _TURN else whole), a.ccw)


def _between(a: Point, b: Point, share: float) -> Point:
    return a[0] * share + b[0] * (1 - share), a[1] * share + b[1] * (1 - share)
