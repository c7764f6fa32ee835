"""Ellipses and splines become lines and arcs that join smoothly, within a stated distance both ways."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.errors import GeometryError
from ...model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline
from . import span_kernels as kernels
from .bezier import BezierCurve, pieces_of, products
from .bezier_kernels import surely_not_round

Floats = NDArray[np.float64]
_MOST = 20_000
"""A curve that needs more arcs than this, some 100 m of it, is not what was meant."""
_ROOM = 64
"""Spans that are covered at a time."""
_ROUNDS = 24
"""How often stretches whose bound exceeds the tolerance are halved; samples seldom miss anything, so mostly never."""


@dataclass(frozen=True, slots=True)
class LinesAndArcs:
    """What a curve has become.

    Attributes:
        primitives: each begins exactly where the one before ends; the first and the last keep the curve's ends;
            one circle for a closed circular curve; empty for a curve without length.
        deviation: bound of the distance between the curve and the primitives, both ways, mm.
    """

    primitives: tuple[Primitive, ...]
    deviation: float


def lines_and_arcs(curve: Ellipse | Spline, tolerance: float = tolerances.CURVE) -> LinesAndArcs:
    """Return lines and arcs within `tolerance` of an ellipse or a spline, and the curve within it of them.

    Corners are kept; between them neighbours share their tangent. Every stretch of the curve is bound to its own
    arc by Bernstein coefficients of the squared distance from the centre. The stretch runs from one end of the arc to
    the other, so its projection covers the arc and the same bound holds from the arc to the curve.

    Args:
        curve: mm.
        tolerance: mm, > 0.

    Raises:
        GeometryError: the curve has values that are not finite, or cannot be followed.

    References:
        Longest-first biarc fitting: Meek and Walton (1993), "Approximating quadratic NURBS curves by arc splines".
    """
    _check(curve)
    pieces = pieces_of(curve)
    if len(pieces) == 0 or float(np.ptp(pieces.polygon.reshape(-1, 2), axis=0).max()) < tolerances.WELD:
        return LinesAndArcs((), 0.0)
    closed = math.dist(curve.start, curve.end) < tolerances.WELD
    round_one = _as_circle(curve, pieces, closed, tolerance)
    if round_one is not None:
        return round_one
    spans = np.concatenate([_span_of(pieces, a, b, 0.8 * tolerance) for a, b in pairwise(pieces.corners())])
    for _ in range(_ROUNDS):
        bounds = _bounds(pieces, spans)
        if (worst := float(bounds.max())) <= tolerance:
            return LinesAndArcs(_joined(spans, curve, closed), worst)
        spans = _finer(pieces, spans, bounds, tolerance)
    raise GeometryError(
        f"the curve that begins at ({curve.start[0]:.3f}, {curve.start[1]:.3f}) cannot be followed by arcs "
        f"within {tolerance:g} mm; draw it again with fewer control points."
    )


def _check(curve: Ellipse | Spline) -> None:
    values = (
        (*curve.centre, *curve.major, curve.ratio, curve.start_parameter, curve.end_parameter)
        if isinstance(curve, Ellipse)
        else (*(v for point in curve.control_points for v in point), *curve.knots, *curve.weights)
    )
    if not all(map(math.isfinite, values)):
        raise GeometryError(
            f"the {type(curve).__name__.lower()} has a coordinate that is not a number; delete it or draw it again."
        )


def _as_circle(curve: Ellipse | Spline, pieces: BezierCurve, closed: bool, tolerance: float) -> LinesAndArcs | None:
    """Return one circle or arc for a curve that is one; a closed one may differ by the tolerance, as it has no ends to
    keep.
    """
    given = curve.centre if isinstance(curve, Ellipse) else None
    limit = tolerance if closed else tolerances.WELD
    if surely_not_round(pieces.control, given is not None, *(given or (0.0, 0.0)), limit):
        return None
    places = np.linspace(0.0, len(pieces), 8 * len(pieces) + 1)
    points, _ = pieces.at(places)
    centre = _middle_of(points[0], points[len(points) // 3], points[2 * len(points) // 3])
    if given is not None:
        centre = np.array(given)
    if centre is None:
        return None
    arms = points - centre
    turns = np.arctan2(arms[:-1, 0] * arms[1:, 1] - arms[:-1, 1] * arms[1:, 0], (arms[:-1] * arms[1:]).sum(axis=1))
    sweep = float(turns.sum())
    one_way = bool(np.all(turns > 0) or np.all(turns < 0)) and abs(sweep) < math.tau + 1e-6
    if not one_way or (closed and abs(sweep) < 6.0) or (not closed and abs(sweep) > math.tau - 1e-6):
        return None
    radii = np.hypot(arms[:, 0], arms[:, 1])
    radius = float(radii.max() + radii.min()) / 2 if closed else float(radii[0])
    on = centre + arms[0] / radii[0] * radius
    edges = np.linspace(0.0, len(pieces), 8 * len(pieces) + 1)
    small = pieces.cut(edges[:-1], edges[1:])
    count = len(small)
    bound = float(small.off_circles(np.tile(on, (count, 1)), np.tile(centre, (count, 1))).max())
    at = (float(centre[0]), float(centre[1]))
    if closed and bound <= tolerance:
        return LinesAndArcs((Circle(at, radius, sweep > 0),), bound)
    if not closed and bound <= tolerances.WELD:
        return LinesAndArcs(
            (Arc(curve.start, curve.end, equally_far(curve.start, curve.end, at), sweep > 0),), bound + tolerances.WELD
        )
    return None


def _middle_of(a: Floats, b: Floats, c: Floats) -> Floats | None:
    """Return the centre of the circle through three points, or None where they lie in a line."""
    u, v = b - a, c - a
    double = 2 * (u[0] * v[1] - u[1] * v[0])
    if abs(double) < 1e-6 * max(float(u @ u), float(v @ v)):
        return None
    centre: Floats = a + np.array([v[1] * (u @ u) - u[1] * (v @ v), u[0] * (v @ v) - v[0] * (u @ u)]) / double
    return centre


def equally_far(start: Point, end: Point, centre: Point) -> Point:
    """Return the point nearest to centre that is equally far from start and end, which differ."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    along = ((centre[0] - (start[0] + end[0]) / 2) * dx + (centre[1] - (start[1] + end[1]) / 2) * dy) / (
        dx * dx + dy * dy
    )
    return centre[0] - along * dx, centre[1] - along * dy


def _finer(pieces: BezierCurve, spans: Floats, bounds: Floats, tolerance: float) -> Floats:
    """Return the spans, those whose bound is beyond the tolerance in two halves."""
    middle = (spans[:, kernels.FIRST] + spans[:, kernels.LAST]) / 2
    coarse = (bounds > tolerance) & (spans[:, kernels.FIRST] < middle) & (middle < spans[:, kernels.LAST])
    parts: list[Floats] = []
    done = 0
    for k in np.flatnonzero(coarse).tolist():
        first, last = spans[k, [kernels.FIRST, kernels.LAST]].tolist()
        halves = (
            _covered(pieces, first, float(middle[k]), 0.5 * tolerance),
            _covered(pieces, float(middle[k]), last, 0.5 * tolerance),
        )
        parts += [spans[done:k], *halves]
        done = k + 1
    return np.concatenate([*parts, spans[done:]])


def _span_of(pieces: BezierCurve, first: float, last: float, target: float) -> Floats:
    """Return the spans (k, COLUMNS) between two corners: one line, where all control points lie on it, within a tenth
    of WELD, and none turns back; else what covers them.
    """
    polygon = pieces.polygon[round(first) : round(last)].reshape(-1, 2)
    chord = polygon[-1] - polygon[0]
    length = math.hypot(*chord)
    if length >= tolerances.WELD:
        offset = np.abs((polygon - polygon[0]) @ np.array([-chord[1], chord[0]])) / length
        along = np.diff((polygon - polygon[0]) @ chord)
        if offset.max() <= tolerances.WELD / 10 and along.min() >= -tolerances.WELD / 10 * length:
            span = np.zeros((1, kernels.COLUMNS))
            span[0, [kernels.FIRST, kernels.LAST, kernels.PARTS]] = first, last, 1.0
            span[0, kernels.X0 : kernels.X1], span[0, kernels.X2 : kernels.CX] = polygon[0], polygon[-1]
            return span
    return _covered(pieces, first, last, target)


def _covered(pieces: BezierCurve, first: float, last: float, target: float) -> Floats:
    """Return spans (k, COLUMNS) from a parameter to another, greedily: each is about the longest within target.

    Raises:
        GeometryError: the curve needs too many.
    """
    state, parts, count = np.array([first, min(1.0, (last - first) / 2)]), [], 0
    while state[0] < last:
        rows = np.zeros((_ROOM, kernels.COLUMNS))
        made = kernels.cover(pieces.control, state, last, target, pieces.still, rows)
        parts.append(rows[:made])
        count += made
        if count > _MOST:
            raise GeometryError(
                f"the curve needs more than {_MOST} arcs at a tolerance this fine; check its size, or draw it again."
            )
    return np.concatenate(parts)


def _bounds(pieces: BezierCurve, spans: Floats) -> Floats:
    """Return for every span a bound of its distance from what replaces it (k,), mm."""
    found = np.empty(len(spans))
    kernels.bounds(pieces.control, spans, products(pieces.degree), found)
    return found


def _joined(spans: Floats, curve: Ellipse | Spline, closed: bool) -> tuple[Line | Arc, ...]:
    """Return all primitives with ends that meet exactly, the first and last at the curve's own ends."""
    made: list[Line | Arc] = []
    at, last = curve.start, curve.start if closed else curve.end
    rows = spans.tolist()
    for k, (_, _, _, _, x1, y1, x2, y2, cx, cy, turn, dx, dy, dturn, parts) in enumerate(rows):
        if parts == 2.0:
            made += _primitive(at, (x1, y1), (cx, cy), turn)
            at, cx, cy, turn = (x1, y1), dx, dy, dturn
        end = (x2, y2) if k < len(rows) - 1 else last
        made += _primitive(at, end, (cx, cy), turn)
        at = end
    return tuple(made)


def _primitive(start: Point, end: Point, centre: Point, turn: float) -> tuple[Line | Arc, ...]:
    """Return the line (turn 0) or the arc between two places; nothing where they are one."""
    if start == end:
        return ()
    return (Arc(start, end, equally_far(start, end, centre), turn > 0),) if turn else (Line(start, end),)
