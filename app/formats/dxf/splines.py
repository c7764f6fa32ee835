"""DXF splines of every sort to splines that begin and end on their control points."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...model.curves import Spline

MOST_POINTS = 100_000
"""Of a spline; to follow one of so many within a micrometre takes some ten seconds."""

Homogeneous = tuple[float, float, float]


def spline_curve(entity: Any) -> Spline | None:
    """Return a SPLINE as a clamped (rational) spline in drawing units; None when it is not a curve at all.

    One given by fit points alone becomes the interpolating cubic that CAD programs draw, a closed one that which goes
    on without a corner where it began. One whose knots are not
    clamped (closed and periodic ones) gets knots inserted at both ends, which leaves its shape as it is.

    Raises:
        InputError: it has more than MOST_POINTS points.
    """
    _ensure_few(entity, entity.dxf.layer)
    try:
        if entity.closed and not len(entity.control_points):
            return _closed_through([(float(p[0]), float(p[1])) for p in entity.fit_points])
        return _clamped(entity.construction_tool())
    except (ValueError, IndexError, ZeroDivisionError, ArithmeticError):
        return None


def _closed_through(points: list[tuple[float, float]]) -> Spline | None:
    """Return the closed cubic through points, of a continuous curvature also where it begins; its parameter is the
    length of the chords. None of fewer than three points.
    """
    from scipy.interpolate import CubicSpline

    corners = [point for point, following in zip(points, points[1:] + points[:1], strict=True) if point != following]
    if len(corners) < 3:
        return None
    ring = np.array([*corners, corners[0]])
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(ring, axis=0).T))])
    thirds = CubicSpline(at, ring, bc_type="periodic").derivative()(at) / 3
    steps = np.diff(at)[:, None]
    inner = np.stack([ring[:-1] + thirds[:-1] * steps, ring[1:] - thirds[1:] * steps, ring[1:]], axis=1)
    control = np.concatenate([ring[:1], inner.reshape(-1, 2)])
    knots = [at[0], *np.repeat(at, 3), at[-1]]
    return Spline(3, tuple(map(tuple, control.tolist())), tuple(map(float, knots)))


def spline_of_edge(edge: Any, layer: str) -> Spline | None:
    """Return an edge of a hatch's boundary that is a spline, in drawing units; None when it is not a curve at all.

    Raises:
        InputError: it has more than MOST_POINTS points.
    """
    from ezdxf.math import BSpline, fit_points_to_cad_cv

    _ensure_few(edge, layer)
    try:
        if edge.control_points:
            return _clamped(BSpline(edge.control_points, edge.degree + 1, edge.knot_values, edge.weights or None))
        tangents = (edge.start_tangent, edge.end_tangent)
        return _clamped(fit_points_to_cad_cv(edge.fit_points, tangents if all(tangents) else None))
    except (ValueError, IndexError, ZeroDivisionError, ArithmeticError):
        return None


def _ensure_few(entity: Any, layer: str) -> None:
    count = max(len(entity.control_points), len(entity.fit_points))
    if count > MOST_POINTS:
        raise InputError(f"On layer {layer} {too_many(count)}")


def _clamped(tool: Any) -> Spline | None:
    """Return a spline of the library as one that begins and ends on its control points."""
    points = [(float(p.x), float(p.y)) for p in tool.control_points]
    knots, degree = [float(k) for k in tool.knots()], tool.order - 1
    weights = [float(w) for w in tool.weights()] or [1.0] * len(points)
    if not _sound(points, knots, weights, degree):
        return None
    control = [(x * w, y * w, w) for (x, y), w in zip(points, weights, strict=True)]
    for _ in range(2):
        control, knots = _clamped_start(control, knots, degree)
        control, knots = control[::-1], [knots[0] + knots[-1] - k for k in reversed(knots)]
    placed = [(x / w, y / w) for x, y, w in control]
    if not _sound(placed, knots, [w for _, _, w in control], degree):  # knots so large that their differences are lost
        return None
    rational = any(abs(w - weights[0]) > 1e-12 * weights[0] for w in weights)
    return Spline(degree, tuple(placed), tuple(knots), tuple(w for _, _, w in control) if rational else ())


def too_many(count: int, most: int = MOST_POINTS, what: str = "spline") -> str:
    """Return what is wrong with a curve of so many points."""
    return f"a {what} has {count} points; {most} are the most, so split it or thin it out in the CAD program."


def _sound(points: list[tuple[float, float]], knots: list[float], weights: list[float], degree: int) -> bool:
    numbers = [v for p in points for v in p] + knots + weights
    return (
        degree >= 1
        and len(points) > degree
        and len(knots) == len(points) + degree + 1
        and len(weights) == len(points)
        and all(map(math.isfinite, numbers))
        and all(w > 0 for w in weights)
        and all(a <= b for a, b in pairwise(knots))
        and knots[degree] < knots[len(points)]
    )


def _clamped_start(
    control: list[Homogeneous], knots: list[float], degree: int
) -> tuple[list[Homogeneous], list[float]]:
    """Return the same spline from the first knot of its range on, with that knot repeated degree + 1 times.

    References:
        Knot insertion: Boehm (1980), "Inserting new knots into B-spline curves".
    """
    at = knots[degree]
    while knots.count(at) < degree:
        k = max(i for i, knot in enumerate(knots) if knot == at)
        low = [knots[i] for i in range(k - degree + 1, k + 1)]
        shares = [(at - a) / (b - a) if b > a else 0.0 for a, b in zip(low, knots[k + 1 : k + degree + 1], strict=True)]
        mixed = [
            _mix(control[i - 1], control[i], share)
            for i, share in zip(range(k - degree + 1, k + 1), shares, strict=True)
        ]
        control = [*control[: k - degree + 1], *mixed, *control[k:]]
        knots = [*knots[: k + 1], at, *knots[k + 1 :]]
    last = max(i for i, knot in enumerate(knots) if knot == at)
    return control[last - degree :], [at, *knots[last - degree + 1 :]]


def _mix(a: Homogeneous, b: Homogeneous, share: float) -> Homogeneous:
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share
