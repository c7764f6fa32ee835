"""Rational B-spline curves with which surfaces are made: through points, of lines and arcs, and brought into one space.

A spline is in the space of every knot vector that holds its own, and of every higher degree. So it is brought there by
interpolating it where that space's basis functions peak (Greville): exact but for rounding, for knots and degree alike.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...model.curves import Circle, Line, Primitive
from ...model.motion import Nurbs

Floats = NDArray[np.float64]

_ALIKE = 1e-9
"""Knots nearer than this, of 1, are one."""


def homogeneous(curve: Nurbs) -> Floats:
    """Return control points (k, 4): w x, w y, w z, w."""
    return np.column_stack([curve.points * curve.weights[:, None], curve.weights])


def of_homogeneous(points: Floats, knots: Floats, degree: int) -> Nurbs:
    """Return the curve of control points (k, 4)."""
    return Nurbs(points[:, :3] / points[:, 3:], points[:, 3].copy(), knots, degree)


def spline_of(points: Floats, knots: Floats, degree: int) -> Any:
    """Return scipy's spline of control points (k, …)."""
    from scipy.interpolate import BSpline

    return BSpline(knots, points, degree)


def unit_knots(knots: Floats) -> Floats:
    """Return knots that go from 0 to 1."""
    made: Floats = (knots - knots[0]) / (knots[-1] - knots[0])
    return made


def even_knots(count: int, degree: int) -> Floats:
    """Return clamped knots, evenly spread from 0 to 1."""
    return np.concatenate([np.zeros(degree), np.linspace(0, 1, count - degree + 1), np.ones(degree)])


class SplineSpace(NamedTuple):
    """The splines of some knots and a degree."""

    knots: Floats
    degree: int


class ControlledSpline(NamedTuple):
    """A spline by its control points (n, …), clamped knots and degree."""

    points: Floats
    knots: Floats
    degree: int


class CompatibleCurves(NamedTuple):
    """Curves in one space: control points (k, 4) of each, knots from 0 to 1, degree."""

    points: list[Floats]
    knots: Floats
    degree: int


def brought(points: Floats, space: SplineSpace, target: SplineSpace) -> Floats:
    """Return control points of a spline in another space, which holds its own."""
    from scipy.interpolate import make_interp_spline

    (own, own_degree), (requested, degree) = space, target
    if own_degree == degree and len(own) == len(requested) and np.array_equal(own, requested):
        return points
    peaks = np.array([requested[k + 1 : k + 1 + degree].mean() for k in range(len(requested) - degree - 1)])
    peaks[0], peaks[-1] = requested[0], requested[-1]
    made: Floats = make_interp_spline(peaks, spline_of(points, own, own_degree)(peaks), k=degree, t=requested).c
    return made


def clamped(points: Floats, knots: Floats, degree: int) -> tuple[Floats, Floats]:
    """Return control points and clamped knots of a periodic spline as scipy has it."""
    low, high = knots[degree], knots[-degree - 1]
    inner = knots[degree + 1 : -degree - 1]
    ends = np.concatenate([np.full(degree + 1, low), inner, np.full(degree + 1, high)])
    return brought(points, SplineSpace(knots, degree), SplineSpace(ends, degree)), ends


def parameters(points: Floats, exponent: float) -> Floats:
    """Return parameters (n,) from 0 to 1 of points (n, …), by chord lengths to an exponent: 1, or 0.5 for centripetal
    ones.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1) ** exponent
    made = np.concatenate([[0.0], np.cumsum(steps)])
    return unit_knots(made)


def through(points: Floats, at: Floats, degree: int, closed: bool = False) -> ControlledSpline:
    """Return the spline through points (n, …) at parameters (n,).

    Args:
        points: where it is closed, the last is the first.
        degree: fewer points make it lower.
        closed: smooth from its end to its beginning; an even degree becomes odd, for which that has one answer.
    """
    from scipy.interpolate import make_interp_spline

    degree = min(degree, len(points) - 1)
    if degree == 1:
        return ControlledSpline(points, np.concatenate([[at[0]], at, [at[-1]]]), 1)
    if not closed:
        made = make_interp_spline(at, points, k=degree)
        return ControlledSpline(made.c, made.t, degree)
    if degree % 2 == 0:
        degree += 1 if degree + 1 < len(points) else -1
    made = make_interp_spline(at, points, k=degree, bc_type="periodic")
    control, knots = clamped(made.c, made.t, degree)
    return ControlledSpline(control, knots, degree)


def of_primitives(primitives: Sequence[Primitive]) -> Nurbs:
    """Return the curve of joined lines, arcs or one circle in the plane z = 0, exactly: rational of degree 2, straight
    ones of 1.
    """
    if all(isinstance(each, Line) for each in primitives):
        corners = np.array([primitives[0].start, *(each.end for each in primitives)])
        at = parameters(corners, 1.0)
        return Nurbs(
            np.column_stack([corners, np.zeros(len(corners))]),
            np.ones(len(corners)),
            np.concatenate([[0.0], at, [1.0]]),
            1,
        )
    rows: list[tuple[float, float, float]] = [(*primitives[0].start, 1.0)]
    lengths: list[float] = []
    for each in primitives:
        pieces = _line(each) if isinstance(each, Line) else _arc(each)
        rows += [row for piece in pieces for row in piece]
        lengths += [_length(each) / len(pieces)] * len(pieces)
    control = np.array(rows)
    at = unit_knots(np.concatenate([[0.0], np.cumsum(lengths)]))
    knots = np.concatenate([[0.0], np.repeat(at, 2), [1.0]])
    return Nurbs(np.column_stack([control[:, :2], np.zeros(len(control))]), control[:, 2], knots, 2)


def _line(line: Line) -> list[list[tuple[float, float, float]]]:
    (ax, ay), (bx, by) = line.start, line.end
    return [[((ax + bx) / 2, (ay + by) / 2, 1.0), (bx, by, 1.0)]]


def _arc(arc: Any) -> list[list[tuple[float, float, float]]]:
    """Return for each piece of an arc or a circle its middle control point and its end, x, y, weight."""
    (cx, cy), radius = arc.centre, arc.radius
    if isinstance(arc, Circle):
        start, sweep = 0.0, math.tau if arc.ccw else -math.tau
    else:
        start, sweep = arc.start_angle, arc.sweep
    turn = unit_arc(start, start + sweep)
    made = [(cx + radius * x, cy + radius * y, w) for x, y, w in turn]
    made[-1] = (*arc.end, 1.0)
    return [[made[k], made[k + 1]] for k in range(1, len(made), 2)]


def _length(primitive: Primitive) -> float:
    if isinstance(primitive, Line):
        return math.dist(primitive.start, primitive.end)
    return primitive.radius * (math.tau if isinstance(primitive, Circle) else abs(primitive.sweep))


def unit_arc(start: float, end: float) -> Floats:
    """Return control points (2 n + 1, 3) x, y, weight of an arc of the unit circle, of n pieces of a quarter turn at
    most, radians.
    """
    count = max(1, math.ceil(abs(end - start) / (math.pi / 2) - 1e-12))
    angles = np.linspace(start, end, 2 * count + 1)
    half = abs(end - start) / (2 * count)
    weights = np.where(np.arange(2 * count + 1) % 2, math.cos(half), 1.0)
    return np.column_stack([np.cos(angles) / weights, np.sin(angles) / weights, weights])


def arc_knots(count: int) -> Floats:
    """Return the knots from 0 to 1 of `unit_arc` with so many control points."""
    return np.concatenate([[0.0], np.repeat(np.linspace(0, 1, (count + 1) // 2), 2), [1.0]])


def compatible(curves: Sequence[Nurbs]) -> CompatibleCurves:
    """Return curves in one space, exact but for rounding."""
    degree = max(curve.degree for curve in curves)
    requested: list[list[float]] = []
    for curve in curves:
        for knot, times in _multiplicities(unit_knots(curve.knots)):
            known = next((each for each in requested if abs(each[0] - knot) <= _ALIKE), None)
            more = times + degree - curve.degree
            if known is None:
                requested.append([knot, more])
            else:
                known[1] = max(known[1], more)
    requested.sort()
    knots = np.concatenate([np.full(int(times), knot) for knot, times in requested])
    made = []
    for curve in curves:
        own = _snapped(unit_knots(curve.knots), [knot for knot, _ in requested])
        made.append(brought(homogeneous(curve), SplineSpace(own, curve.degree), SplineSpace(knots, degree)))
    return CompatibleCurves(made, knots, degree)


class _Knot(NamedTuple):
    """A knot, and how many times it stands there."""

    value: float
    times: int


def _multiplicities(knots: Floats) -> list[_Knot]:
    found: list[_Knot] = []
    for knot in knots.tolist():
        if found and knot - found[-1].value <= _ALIKE:
            found[-1] = found[-1]._replace(times=found[-1].times + 1)
        else:
            found.append(_Knot(knot, 1))
    return found


def _snapped(knots: Floats, requested: list[float]) -> Floats:
    known = np.array(requested)
    made: Floats = known[np.abs(known[None, :] - knots[:, None]).argmin(axis=1)]
    return made


def checked(weights: Floats, what: str) -> None:
    """Refuse weights that are not positive, which too different rational sections lead to.

    Raises:
        GeometryError: one is not.
    """
    if not (weights > 0).all():
        raise GeometryError(
            f"{what} goes through infinity between its sections; add sections, or take fewer different ones."
        )
