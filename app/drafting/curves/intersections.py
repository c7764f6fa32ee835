"""Where curves meet, the nearest point of a curve, and where lines from a point touch it: for snaps, trims and the
language.

Lines, arcs and circles in closed form; ellipses and splines from samples, refined by Newton's method to 1e-12 of their
size.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...geometry.sample import Box, Points, spline_points
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from .perpendiculars import spline_tangents

_ON = 1e-9
"""How far beyond the end of a curve a point still counts as on it, as a share of its size."""

At = Callable[[float], tuple[float, float]]
Chords = tuple[Points, NDArray[np.intp]]
"""A polyline, and the numbers of its chords that count."""


def intersection_points(a: Curve, b: Curve, extended: bool = False, within: Box | None = None) -> list[Point]:
    """Return the points where two curves meet, mm; stretches that they share give none.

    Args:
        extended: lines go on beyond their ends, arcs round to whole circles.
        within: x0, y0, x1, y1 in mm of where it is enough to look; ellipses and splines cost much less then.
    """
    if not (_simple(a) and _simple(b)):
        return _refined(a, b, within)
    found = _unbounded(a, b)
    return [p for p in found if extended or (lies_on(a, p) and lies_on(b, p))]


def lies_on(curve: Curve, point: Point) -> bool:
    """Return whether a point of the endless line or whole circle lies between the ends of a line, arc or circle."""
    if isinstance(curve, Line):
        dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
        along = ((point[0] - curve.start[0]) * dx + (point[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
        return -_ON <= along <= 1 + _ON
    if isinstance(curve, Arc):
        turn = math.atan2(point[1] - curve.centre[1], point[0] - curve.centre[0]) - curve.start_angle
        ahead = turn % math.tau if curve.sweep > 0 else -turn % math.tau
        return ahead <= abs(curve.sweep) + _ON or ahead >= math.tau - _ON
    return True


def nearest_point(curve: Curve, point: Point) -> Point:
    """Return the point of a curve that is nearest to a point, mm."""
    if isinstance(curve, Line):
        dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
        along = ((point[0] - curve.start[0]) * dx + (point[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
        along = min(max(along, 0.0), 1.0)
        return (curve.start[0] + along * dx, curve.start[1] + along * dy)
    if isinstance(curve, Arc | Circle):
        (x, y), r = curve.centre, curve.radius
        away = math.dist(point, curve.centre)
        on = (x + (point[0] - x) / away * r, y + (point[1] - y) / away * r) if away > 0 else (x + r, y)
        if lies_on(curve, on):
            return on
        return min(curve.start, curve.end, key=lambda p: math.dist(p, point))
    at, _ = _parametric(curve)
    return at(nearest_parameter(curve, point))


def tangent_points(curve: Curve, point: Point) -> list[Point]:
    """Return the points of an arc, circle, ellipse or spline where a line from a point outside touches it, mm."""
    if isinstance(curve, Arc | Circle):
        (x, y), r = curve.centre, curve.radius
        away = math.dist(point, curve.centre)
        if away <= r:
            return []
        towards, half = math.atan2(point[1] - y, point[0] - x), math.acos(r / away)
        both = [(x + r * math.cos(t), y + r * math.sin(t)) for t in (towards - half, towards + half)]
        return [p for p in both if lies_on(curve, p)]
    if isinstance(curve, Ellipse):
        return _ellipse_tangents(curve, point)
    return spline_tangents(curve, point) if isinstance(curve, Spline) else []


def _simple(curve: Curve) -> bool:
    return isinstance(curve, Line | Arc | Circle)


def _unbounded(a: Curve, b: Curve) -> list[Point]:
    if isinstance(a, Line) and isinstance(b, Line):
        return _line_line(a, b)
    if isinstance(a, Line) and isinstance(b, Arc | Circle):
        return _line_circle(a, b.centre, b.radius)
    if isinstance(b, Line) and isinstance(a, Arc | Circle):
        return _line_circle(b, a.centre, a.radius)
    assert isinstance(a, Arc | Circle) and isinstance(b, Arc | Circle)
    return _circle_circle(a, b)


def _line_line(a: Line, b: Line) -> list[Point]:
    ux, uy = a.end[0] - a.start[0], a.end[1] - a.start[1]
    vx, vy = b.end[0] - b.start[0], b.end[1] - b.start[1]
    cross = ux * vy - uy * vx
    if abs(cross) <= 1e-12 * math.hypot(ux, uy) * math.hypot(vx, vy):
        return []
    t = ((b.start[0] - a.start[0]) * vy - (b.start[1] - a.start[1]) * vx) / cross
    return [(a.start[0] + t * ux, a.start[1] + t * uy)]


def _line_circle(line: Line, centre: Point, radius: float) -> list[Point]:
    size = math.dist(line.start, line.end)
    ux, uy = (line.end[0] - line.start[0]) / size, (line.end[1] - line.start[1]) / size
    dx, dy = centre[0] - line.start[0], centre[1] - line.start[1]
    along, off = dx * ux + dy * uy, dx * uy - dy * ux
    square = (radius - abs(off)) * (radius + abs(off))
    if square < -1e-9 * radius * radius:
        return []
    half = math.sqrt(max(square, 0.0))
    steps = (along,) if half < 1e-9 * radius else (along - half, along + half)
    return [(line.start[0] + s * ux, line.start[1] + s * uy) for s in steps]


def _circle_circle(a: Arc | Circle, b: Arc | Circle) -> list[Point]:
    (ax, ay), (bx, by), r, q = a.centre, b.centre, a.radius, b.radius
    away = math.dist(a.centre, b.centre)
    if away < 1e-12 * max(r, q):
        return []
    ux, uy = (bx - ax) / away, (by - ay) / away
    along = (away + (r - q) * (r + q) / away) / 2
    square = (r - along) * (r + along)
    if square < -1e-9 * r * r:
        return []
    half = math.sqrt(max(square, 0.0))
    sides = (0.0,) if half < 1e-9 * r else (-half, half)
    return [(ax + along * ux - h * uy, ay + along * uy + h * ux) for h in sides]


def _parametric(curve: Curve) -> tuple[At, Points]:
    """Return a curve as a function of a parameter, and parameters close enough that no bend is missed between."""
    if isinstance(curve, Ellipse):
        count = max(8, math.ceil((curve.end_parameter - curve.start_parameter) / math.radians(2)) + 1)
        return curve.at, np.linspace(curve.start_parameter, curve.end_parameter, count)
    if isinstance(curve, Spline):
        knots = np.unique(curve.knots)
        fine = np.linspace(knots[:-1], knots[1:], 24, endpoint=False, axis=1).ravel()

        def at(t: float) -> tuple[float, float]:
            x, y = spline_points(curve, np.array([t]))[0]
            return (float(x), float(y))

        return at, np.append(fine, knots[-1])
    if isinstance(curve, Line):
        (ax, ay), (bx, by) = curve.start, curve.end
        return lambda t: (ax + t * (bx - ax), ay + t * (by - ay)), np.array((0.0, 1.0))
    first, sweep = (curve.start_angle, curve.sweep) if isinstance(curve, Arc) else (0.0, math.tau)
    (x, y), r = curve.centre, curve.radius
    count = max(8, math.ceil(abs(sweep) / math.radians(2)) + 1)
    return lambda t: (x + r * math.cos(t), y + r * math.sin(t)), np.linspace(first, first + sweep, count)


def _refined(a: Curve, b: Curve, within: Box | None) -> list[Point]:
    rows_a, rows_b = _rows(a, within), _rows(b, within)
    if not (len(rows_a) and len(rows_b)):
        return []
    (at_a, ta, pa), (at_b, tb, pb) = _sampled(a), _sampled(b)
    found: list[Point] = []
    for i, j, s, u in _crossing_chords((pa, rows_a), (pb, rows_b)):
        point = _newton(
            at_a,
            at_b,
            (ta[i] + s * (ta[i + 1] - ta[i]), tb[j] + u * (tb[j + 1] - tb[j])),
            (ta[0], ta[-1]),
            (tb[0], tb[-1]),
        )
        if point is not None and all(math.dist(point, p) > 1e-9 * (1 + math.hypot(*point)) for p in found):
            found.append(point)
    return found


@lru_cache(1024)
def _sampled(curve: Curve) -> tuple[At, Points, Points]:
    at, parameters = _parametric(curve)
    points = spline_points(curve, parameters) if isinstance(curve, Spline) else np.array([at(t) for t in parameters])
    return at, parameters, points


@lru_cache(64)
def _rows(curve: Curve, within: Box | None) -> NDArray[np.intp]:
    """Return the numbers of the chords of a curve's samples that reach into a box."""
    _, _, points = _sampled(curve)
    if within is None:
        return np.arange(len(points) - 1)
    low, high = np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])
    return np.flatnonzero((low <= within[2:]).all(axis=1) & (high >= within[:2]).all(axis=1))


def _crossing_chords(a: Chords, b: Chords) -> list[tuple[int, int, float, float]]:
    """Return which chords of two polylines cross, and where on each, with a margin for what bulges beyond its chord."""
    (pa, rows_a), (pb, rows_b) = a, b
    u, v = (pa[rows_a + 1] - pa[rows_a])[:, None], (pb[rows_b + 1] - pb[rows_b])[None]
    w = pb[None, rows_b] - pa[rows_a, None]
    cross = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (w[..., 0] * v[..., 1] - w[..., 1] * v[..., 0]) / cross
        t = (w[..., 0] * u[..., 1] - w[..., 1] * u[..., 0]) / cross
    margin = 0.05
    found = np.nonzero((s >= -margin) & (s <= 1 + margin) & (t >= -margin) & (t <= 1 + margin))
    return [(int(rows_a[i]), int(rows_b[j]), float(s[i, j]), float(t[i, j])) for i, j in zip(*found, strict=True)]


def _newton(
    a: At, b: At, start: tuple[float, float], range_a: tuple[float, float], range_b: tuple[float, float]
) -> Point | None:
    s, t = start
    (s0, s1), (t0, t1) = sorted(range_a), sorted(range_b)
    hs, ht = 1e-6 * (s1 - s0), 1e-6 * (t1 - t0)
    for _ in range(30):
        s, t = min(max(s, s0), s1), min(max(t, t0), t1)
        pa, pb = a(s), b(t)
        fx, fy = pa[0] - pb[0], pa[1] - pb[1]
        if math.hypot(fx, fy) <= 1e-12 * (1 + math.hypot(*pa)):
            return pa
        low_s, high_s, low_t, high_t = max(s - hs, s0), min(s + hs, s1), max(t - ht, t0), min(t + ht, t1)
        (ax0, ay0), (ax1, ay1), (bx0, by0), (bx1, by1) = a(low_s), a(high_s), b(low_t), b(high_t)
        ax, ay = (ax1 - ax0) / (high_s - low_s), (ay1 - ay0) / (high_s - low_s)
        bx, by = (bx1 - bx0) / (high_t - low_t), (by1 - by0) / (high_t - low_t)
        size = by * ax - bx * ay
        if size == 0:
            return None
        s, t = s - (by * fx - bx * fy) / size, t - (ay * fx - ax * fy) / size
    return pa if math.hypot(fx, fy) <= 1e-9 * (1 + math.hypot(*pa)) else None


def nearest_parameter(curve: Curve, point: Point) -> float:
    """Return the parameter of the point of a curve that is nearest to a point: an angle, a share of a line, a spline's
    knot value.
    """
    at, parameters, points = _sampled(curve)
    best = int(np.argmin(np.hypot(*(points - point).T)))
    low, high = float(parameters[max(best - 1, 0)]), float(parameters[min(best + 1, len(parameters) - 1)])
    golden = (math.sqrt(5) - 1) / 2
    for _ in range(80):
        a, b = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, b) if math.dist(at(a), point) < math.dist(at(b), point) else (a, high)
    return _polished(at, (low + high) / 2, point, (float(parameters[0]), float(parameters[-1])))


def _polished(at: At, t: float, point: Point, span: tuple[float, float]) -> float:
    """Return a parameter at which the way to the point stands square on the curve: distances alone tell it to half the
    digits.
    """
    low, high = min(span), max(span)
    step = 1e-5 * (high - low)

    def slope(u: float) -> float:
        before, after, here = at(max(u - step, low)), at(min(u + step, high)), at(u)
        return (after[0] - before[0]) * (here[0] - point[0]) + (after[1] - before[1]) * (here[1] - point[1])

    for _ in range(4):
        a, b = slope(max(t - step, low)), slope(min(t + step, high))
        if a == b:
            break
        t = min(max(t - slope(t) * (min(t + step, high) - max(t - step, low)) / (b - a), low), high)
    return t


def _ellipse_tangents(curve: Ellipse, point: Point) -> list[Point]:
    """In the ellipse's own frame, scaled to a unit circle, tangents stay tangents."""
    size = math.hypot(*curve.major)
    ux, uy = curve.major[0] / size, curve.major[1] / size
    dx, dy = point[0] - curve.centre[0], point[1] - curve.centre[1]
    p, q = (dx * ux + dy * uy) / size, (dy * ux - dx * uy) / (size * curve.ratio)
    away = math.hypot(p, q)
    if away <= 1:
        return []
    towards, half = math.atan2(q, p), math.acos(1 / away)
    span = curve.end_parameter - curve.start_parameter
    both = [t for t in (towards - half, towards + half) if (t - curve.start_parameter) % math.tau <= span + _ON]
    return [curve.at(t) for t in both]
