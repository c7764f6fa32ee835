"""Curves cut at points: the pieces of a line, arc, circle, ellipse or spline between places on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ...core.tolerances import WELD
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ..curves.intersections import nearest_parameter


def split(curve: Curve, points: Sequence[Point]) -> tuple[Curve, ...]:
    """Return the pieces of a curve between points on it, in its direction, each ending exactly at its point.

    Points at its ends, and points that repeat, cut nothing. A circle or whole ellipse needs two points; with fewer it
    stays whole.
    """
    if isinstance(curve, Line):
        return tuple(Line(a, b) for a, b in _neighbours(curve, sorted(points, key=lambda p: math.dist(p, curve.start))))
    if isinstance(curve, Arc):
        ordered = sorted(points, key=lambda p: _turned(curve, p))
        return tuple(Arc(a, b, curve.centre, curve.ccw) for a, b in _neighbours(curve, ordered))
    if isinstance(curve, Circle):
        return _circle(curve, points)
    if isinstance(curve, Ellipse):
        return _ellipse(curve, points)
    return _spline(curve, points)


def _neighbours(curve: Line | Arc, ordered: Sequence[Point]) -> list[tuple[Point, Point]]:
    way = [curve.start]
    for point in (*ordered, curve.end):
        if math.dist(point, way[-1]) >= WELD and (point == curve.end or math.dist(point, curve.end) >= WELD):
            way.append(point)
    return list(pairwise(way))


def _turned(arc: Arc, point: Point) -> float:
    """Return how far along an arc a point lies, radians; a hair before the start counts as the start."""
    turn = math.atan2(point[1] - arc.centre[1], point[0] - arc.centre[0]) - arc.start_angle
    ahead = turn % math.tau if arc.sweep > 0 else -turn % math.tau
    return 0.0 if ahead > math.tau - 1e-6 else ahead


def _circle(curve: Circle, points: Sequence[Point]) -> tuple[Curve, ...]:
    angles = {p: math.atan2(p[1] - curve.centre[1], p[0] - curve.centre[0]) for p in points}
    ordered = sorted(dict.fromkeys(points), key=lambda p: angles[p] if curve.ccw else -angles[p])
    kept = [p for k, p in enumerate(ordered) if k == 0 or math.dist(p, ordered[k - 1]) >= WELD]
    if len(kept) > 1 and math.dist(kept[0], kept[-1]) < WELD:  # on either side of where angles begin again
        kept.pop()
    if len(kept) < 2:
        return (curve,)
    return tuple(Arc(a, b, curve.centre, curve.ccw) for a, b in zip(kept, (*kept[1:], kept[0]), strict=True))


def _ellipse(curve: Ellipse, points: Sequence[Point]) -> tuple[Curve, ...]:
    first, last = curve.start_parameter, curve.end_parameter
    whole = last - first > math.tau - 1e-9
    places = sorted({first + (nearest_parameter(curve, p) - first) % math.tau for p in points})
    if whole and len(places) < 2:
        return (curve,)
    small = WELD / math.hypot(*curve.major)
    cuts = (
        [*places, places[0] + math.tau]
        if whole
        else [first, *(t for t in places if first + small < t < last - small), last]
    )
    pieces = tuple(replace(curve, start_parameter=a, end_parameter=b) for a, b in pairwise(cuts))
    return pieces if curve.ccw else pieces[::-1]


def _spline(curve: Spline, points: Sequence[Point]) -> tuple[Curve, ...]:
    low, high = curve.knots[0], curve.knots[-1]
    small = 1e-9 * (high - low)
    cuts = sorted({t for t in (nearest_parameter(curve, p) for p in points) if low + small < t < high - small})
    pieces, rest = list[Curve](), curve
    for at in cuts:
        before, rest = _halves(rest, at)
        pieces.append(before)
    return (*pieces, rest)


def _halves(curve: Spline, at: float) -> tuple[Spline, Spline]:
    """Return a spline before and after a parameter, by knots inserted until the curve passes a control point there."""
    from scipy.interpolate import BSpline, insert  # not when the window opens

    p = curve.degree
    weights = np.array(curve.weights or (1.0,) * len(curve.control_points))
    control = np.column_stack([np.array(curve.control_points) * weights[:, None], weights])
    made = BSpline(np.array(curve.knots), control, p)
    missing = p - int(np.count_nonzero(made.t == at))
    if missing > 0:
        made = insert(at, made, m=missing)
    first = int(np.searchsorted(made.t, at, side="left"))
    low = _as_spline(p, [*made.t[: first + p], at], made.c[:first], bool(curve.weights))
    return low, _as_spline(p, [at, *made.t[first:]], made.c[first - 1 :], bool(curve.weights))


def _as_spline(degree: int, knots: Sequence[float], control: np.ndarray, rational: bool) -> Spline:
    count = len(knots) - degree - 1
    control = control[:count]
    points = tuple((float(x / w), float(y / w)) for x, y, w in control)
    return Spline(degree, points, tuple(map(float, knots)), tuple(float(w) for w in control[:, 2]) if rational else ())
