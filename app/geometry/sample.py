"""Curves as rows of points, for picking and for the extent of what is drawn. Never for tool paths."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..model.curves import Arc, Circle, Curve, Ellipse, Line, Spline

Points = NDArray[np.float64]
Box = tuple[float, float, float, float]

_STEP = math.radians(2)
"""Radians of turn from point to point of an arc or an ellipse: enough for an extent and for picking."""
_SPAN_POINTS = 12
"""Points a span of a spline: enough for an extent and for picking."""
_KNOWN = 4096
"""Boxes of ellipses and splines that are kept: picking by windows asks for the same ones again and again."""


def sample(curve: Curve) -> Points:
    """Return (n, 2) points along a curve in its direction, ends included; arcs every 2 degrees, splines 12 a span."""
    if isinstance(curve, Line):
        return np.array((curve.start, curve.end))
    if isinstance(curve, Arc):
        return _turned(curve.centre, curve.radius, curve.start_angle, curve.sweep)
    if isinstance(curve, Circle):
        return _turned(curve.centre, curve.radius, 0.0, math.tau if curve.ccw else -math.tau)
    if isinstance(curve, Ellipse):
        return _ellipse(curve)
    knots = np.unique(curve.knots)
    fine = np.linspace(knots[:-1], knots[1:], _SPAN_POINTS, endpoint=False, axis=1).ravel()
    return spline_points(curve, np.append(fine, knots[-1]))


def spline_points(spline: Spline, parameters: Points) -> Points:
    """Return (n, 2) points of a spline at parameters within its knots (de Boor's algorithm on weighted points)."""
    p, knots = spline.degree, np.asarray(spline.knots, np.float64)
    weights = np.asarray(spline.weights or (1.0,) * len(spline.control_points), np.float64)
    control = np.column_stack([np.asarray(spline.control_points) * weights[:, None], weights])
    span = np.clip(np.searchsorted(knots, parameters, side="right") - 1, p, len(control) - 1)
    d = control[span[:, None] - p + np.arange(p + 1)]
    for level in range(1, p + 1):
        for j in range(p, level - 1, -1):
            low, high = knots[span - p + j], knots[span + 1 + j - level]
            width = np.where(high > low, high - low, 1.0)
            share = ((parameters - low) / width)[:, None]
            d[:, j] = (1 - share) * d[:, j - 1] + share * d[:, j]
    return np.asarray(d[:, p, :2] / d[:, p, 2:])


def derivative(spline: Spline) -> Spline:
    """Return the derivative of a polynomial spline by its parameter, as a spline of a degree less."""
    p, knots, control = spline.degree, np.asarray(spline.knots), np.asarray(spline.control_points)
    width = knots[p + 1 : -1] - knots[1 : -p - 1]
    steps = p * np.diff(control, axis=0) / np.where(width > 0, width, 1.0)[:, None]
    return Spline(p - 1, tuple((float(x), float(y)) for x, y in steps), spline.knots[1:-1])


def bounds(curve: Curve) -> Box:
    """Return x0, y0, x1, y1 of a curve, mm: exact for lines, arcs and circles, within 1e-3 of the size for others."""
    if isinstance(curve, Circle):
        (x, y), r = curve.centre, curve.radius
        return (x - r, y - r, x + r, y + r)
    (x0, y0), (x1, y1) = curve.start, curve.end
    if isinstance(curve, Line):
        return (min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1))
    return _round_bounds(curve) if isinstance(curve, Arc) else _sampled_bounds(curve)


def _round_bounds(arc: Arc) -> Box:
    xs, ys = zip(arc.start, arc.end, *_quadrants_within(arc), strict=True)
    return (min(xs), min(ys), max(xs), max(ys))


@lru_cache(_KNOWN)
def _sampled_bounds(curve: Ellipse | Spline) -> Box:
    points = np.concatenate([[curve.start, curve.end], sample(curve)])
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    return (x0, y0, x1, y1)


def union(boxes: list[Box]) -> Box | None:
    """Return the box round all boxes, or None when there are none."""
    if not boxes:
        return None
    x0, y0, x1, y1 = zip(*boxes, strict=True)
    return (min(x0), min(y0), max(x1), max(y1))


def bounds_of_all(curves: Iterable[Curve]) -> Box | None:
    """Return the box round the bounds of all curves; None when there are none.

    Of many splines few reach its sides: one whose control points lie within what others span is not asked, as it keeps
    to their hull.
    """
    boxes, splines = list[Box](), list[Spline]()
    for curve in curves:
        if isinstance(curve, Spline) and min(curve.weights, default=1.0) > 0:
            boxes.append(_box_of((curve.start, curve.end)))
            splines.append(curve)
        else:
            boxes.append(bounds(curve))
    box = union(boxes)
    for spline in splines:
        x0, y0, x1, y1 = _box_of(spline.control_points)
        if box is None or x0 < box[0] or y0 < box[1] or x1 > box[2] or y1 > box[3]:
            box = union([bounds(spline), *(() if box is None else (box,))])
    return box


def _box_of(points: Sequence[tuple[float, float]]) -> Box:
    xs, ys = zip(*points, strict=True)
    return (min(xs), min(ys), max(xs), max(ys))


def quadrants(curve: Arc | Circle) -> list[tuple[float, float]]:
    """Return the points of an arc or circle that lie farthest right, up, left and down of its centre, where it has
    them.
    """
    if isinstance(curve, Arc):
        return _quadrants_within(curve)
    (x, y), r = curve.centre, curve.radius
    return [(x + r, y), (x, y + r), (x - r, y), (x, y - r)]


def _quadrants_within(arc: Arc) -> list[tuple[float, float]]:
    (x, y), r, sweep, start = arc.centre, arc.radius, arc.sweep, arc.start_angle
    found = []
    for k, point in enumerate(((x + r, y), (x, y + r), (x - r, y), (x, y - r))):
        ahead = (k * math.pi / 2 - start) * (1 if sweep > 0 else -1) % math.tau
        if ahead <= abs(sweep):
            found.append(point)
    return found


def _turned(centre: tuple[float, float], radius: float, first: float, sweep: float) -> Points:
    count = max(2, math.ceil(abs(sweep) / _STEP) + 1)
    turn = np.linspace(first, first + sweep, count)
    return np.column_stack([centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)])


def _ellipse(curve: Ellipse) -> Points:
    span = curve.end_parameter - curve.start_parameter
    t = np.linspace(curve.start_parameter, curve.end_parameter, max(2, math.ceil(span / _STEP) + 1))
    c, s = np.cos(t), np.sin(t) * curve.ratio
    (x, y), (ax, ay) = curve.centre, curve.major
    points = np.column_stack([x + c * ax - s * ay, y + c * ay + s * ax])
    return points if curve.ccw else points[::-1]
