"""Ellipses and splines become lines and arcs that join smoothly, within a stated distance both ways."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from app import tolerances
from app.errors import GeometryError
from app.fit.bezier import Pieces, pieces_of
from app.fit.biarc import biarc, distances
from app.model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline

Floats = NDArray[np.float64]
_SMALLEST = 1e-9
"""A stretch of parameter below which a corner that no arc can follow becomes a line."""
_MOST = 20_000
"""A curve that needs more arcs than this, some 100 m of it, is not what was meant."""
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


@dataclass(frozen=True)
class _Fit:
    """Primitives that replace the curve between two of its parameters."""

    first: float
    last: float
    primitives: tuple[Line | Arc, ...]


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
    fits = [fit for a, b in _smooth_stretches(pieces) for fit in _straight(pieces, a, b) or _stretch(pieces, a, b, 0.8 * tolerance)]
    for _ in range(_ROUNDS):
        bounds = _bounds(pieces, fits)
        if max(bounds) <= tolerance:
            return LinesAndArcs(_joined(fits, curve, closed), max(bounds))
        fits = [finer for fit, bound in zip(fits, bounds, strict=True) for finer in _finer(pieces, fit, bound, tolerance)]
    raise GeometryError(f"the curve that begins at ({curve.start[0]:.3f}, {curve.start[1]:.3f}) cannot be followed by arcs "
                        f"within {tolerance:g} mm; draw it again with fewer control points.")


def _check(curve: Ellipse | Spline) -> None:
    values = ((*curve.centre, *curve.major, curve.ratio, curve.start_parameter, curve.end_parameter) if isinstance(curve, Ellipse)
              else (*(v for point in curve.control_points for v in point), *curve.knots, *curve.weights))
    if not all(map(math.isfinite, values)):
        raise GeometryError(f"the {type(curve).__name__.lower()} has a coordinate that is not a number; delete it or draw it again.")


def _as_circle(curve: Ellipse | Spline, pieces: Pieces, closed: bool, tolerance: float) -> LinesAndArcs | None:
    """Return one circle or arc for a curve that is one; a closed one may differ by the tolerance, as it has no ends to keep."""
    places = np.linspace(0.0, len(pieces), 8 * len(pieces) + 1)
    points, _ = pieces.at(places)
    centre = _middle_of(points[0], points[len(points) // 3], points[2 * len(points) // 3])
    if isinstance(curve, Ellipse):
        centre = np.array(curve.centre)
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
        return LinesAndArcs((Arc(curve.start, curve.end, _levelled(curve.start, curve.end, at), sweep > 0),), bound + tolerances.WELD)
    return None


def _middle_of(a: Floats, b: Floats, c: Floats) -> Floats | None:
    """Return the centre of the circle through three points, or None where they lie in a line."""
    u, v = b - a, c - a
    double = 2 * (u[0] * v[1] - u[1] * v[0])
    if abs(double) < 1e-6 * max(float(u @ u), float(v @ v)):
        return None
    centre: Floats = a + np.array([v[1] * (u @ u) - u[1] * (v @ v), u[0] * (v @ v) - v[0] * (u @ u)]) / double
    return centre


def _levelled(start: Point, end: Point, centre: Point) -> Point:
    """Return the point nearest to centre that is equally far from start and end."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    along = ((centre[0] - (start[0] + end[0]) / 2) * dx + (centre[1] - (start[1] + end[1]) / 2) * dy) / (dx * dx + dy * dy)
    return centre[0] - along * dx, centre[1] - along * dy


def _finer(pieces: Pieces, fit: _Fit, bound: float, tolerance: float) -> list[_Fit]:
    """Return the fit itself where its bound is within tolerance, else fits of its two halves."""
    middle = (fit.first + fit.last) / 2
    if bound <= tolerance or not fit.first < middle < fit.last:
        return [fit]
    return _stretch(pieces, fit.first, middle, 0.5 * tolerance) + _stretch(pieces, middle, fit.last, 0.5 * tolerance)


def _smooth_stretches(pieces: Pieces) -> list[tuple[float, float]]:
    corners = pieces.corners()
    return list(pairwise(corners))


def _stretch(pieces: Pieces, first: float, last: float, target: float) -> list[_Fit]:
    """Cover the parameters from first to last, greedily: each fit is about the longest within target.

    Raises:
        GeometryError: the curve needs too many.
    """
    fits: list[_Fit] = []
    step = min(1.0, (last - first) / 2)
    while first < last:
        fit, step = _longest(pieces, first, last, (step, target))
        fits.append(fit)
        first = fit.last
        if len(fits) > _MOST:
            raise GeometryError(f"the curve needs more than {_MOST} arcs at a tolerance this fine; check its size, or draw it again.")
    return fits


def _straight(pieces: Pieces, first: float, last: float) -> list[_Fit]:
    """Return one line, or nothing unless all control points lie on it, within a tenth of WELD, and none turns back."""
    polygon = pieces.polygon[round(first) : round(last)].reshape(-1, 2)
    chord = polygon[-1] - polygon[0]
    length = math.hypot(*chord)
    if length < tolerances.WELD:
        return []
    offset = np.abs((polygon - polygon[0]) @ np.array([-chord[1], chord[0]])) / length
    along = np.diff((polygon - polygon[0]) @ chord)
    if offset.max() > tolerances.WELD / 10 or along.min() < -tolerances.WELD / 10 * length:
        return []
    return [_Fit(first, last, (_line(polygon[0], polygon[-1]),))]


def _line(start: Floats, end: Floats) -> Line:
    return Line((float(start[0]), float(start[1])), (float(end[0]), float(end[1])))


def _longest(pieces: Pieces, first: float, last: float, guess: tuple[float, float]) -> tuple[_Fit, float]:
    """Return about the longest fit from `first` that stays within the target, and a step to try next.

    The error of a biarc grows with the third power of its length, so few trials find the length.
    """
    step, target = guess
    best: _Fit | None = None
    for _ in range(60):
        end = last if first + step * 1.05 >= last else first + step
        fit, error = _trial(pieces, first, end)
        factor = 0.95 * (target / max(error, target * 1e-3)) ** (1 / 3)
        if error <= target:
            if end == last or factor < 1.2 or best is not None:
                return fit, (end - first) * min(max(factor, 0.7), 2.0)
            best, step = fit, (end - first) * min(factor, 2.0)
            continue
        if best is not None:
            return best, best.last - best.first
        step = (end - first) * min(max(factor, 0.1), 0.7)
        if step < _SMALLEST:
            break
    points, _ = pieces.at(np.array([first, end]))
    return _Fit(first, end, (_line(points[0], points[1]),)), 1e-3


def _trial(pieces: Pieces, first: float, last: float) -> tuple[_Fit, float]:
    """Return the biarc over a stretch, or the chord where it turns back, and its greatest distance from samples; inf: none."""
    places = np.linspace(first, last, max(17, 8 * math.ceil(last - first) + 1))
    points, _ = pieces.at(places)
    start, end = (float(points[0, 0]), float(points[0, 1])), (float(points[-1, 0]), float(points[-1, 1]))
    steps = np.diff(points, axis=0)
    made: tuple[Line | Arc, ...] = ()
    if start != end and math.dist(start, end) > 0.6 * float(np.hypot(steps[:, 0], steps[:, 1]).sum()):
        made = biarc(start, pieces.direction(first, True), end, pieces.direction(last, False))
    made = made or (Line(start, end),)
    return _Fit(first, last, made), float(distances(points[1:-1], made).max())


def _bounds(pieces: Pieces, fits: list[_Fit]) -> list[float]:
    """Return for every fit a bound of its distance from the stretch of curve that it replaces, mm."""
    ranges = _shares(pieces, fits)
    fit_of = np.repeat(np.arange(len(fits)), [len(fit.primitives) for fit in fits])
    primitives = [primitive for fit in fits for primitive in fit.primitives]
    owners, first, last = [], [], []
    for owner, (a, b) in enumerate(ranges):
        inner = np.unique(np.concatenate([[a], np.arange(math.ceil(a), math.floor(b) + 1), [b], np.linspace(a, b, 7)]))
        inner = inner[(inner >= a) & (inner <= b)]
        owners += [owner] * (len(inner) - 1)
        first += inner[:-1].tolist()
        last += inner[1:].tolist()
    small = pieces.cut(np.array(first), np.array(last))
    start = np.array([primitives[k].start for k in owners])
    end = np.array([primitives[k].end for k in owners])
    arcs = np.array([isinstance(primitives[k], Arc) for k in owners])
    centre = np.array([p.centre if isinstance(p, Arc) else p.start for p in primitives])[owners]
    bound = np.where(arcs, 0.0, small.off_lines(start, end))
    if arcs.any():
        bound[arcs] = Pieces(small.control[arcs]).off_circles(start[arcs], centre[arcs])
    result = np.zeros(len(fits))
    np.maximum.at(result, fit_of[owners], bound)
    return [float(bound) for bound in result]


def _shares(pieces: Pieces, fits: list[_Fit]) -> list[tuple[float, float]]:
    """Return the parameters that each primitive replaces; in a biarc they part where the curve crosses the common normal."""
    pairs = [fit for fit in fits if len(fit.primitives) == 2]
    low, high = np.array([f.first for f in pairs]), np.array([f.last for f in pairs])
    if pairs:
        joint = np.array([f.primitives[0].end for f in pairs])
        along = np.array([_end_direction(f.primitives[0]) for f in pairs])
        for _ in range(48):
            middle = (low + high) / 2
            before = ((pieces.at(middle)[0] - joint) * along).sum(axis=1) < 0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
    cuts = iter(((low + high) / 2).tolist())
    shares: list[tuple[float, float]] = []
    for fit in fits:
        if len(fit.primitives) == 2:
            cut = next(cuts)
            shares += [(fit.first, cut), (cut, fit.last)]
        else:
            shares.append((fit.first, fit.last))
    return shares


def _end_direction(primitive: Line | Arc) -> Point:
    if isinstance(primitive, Line):
        return primitive.end[0] - primitive.start[0], primitive.end[1] - primitive.start[1]
    x, y = primitive.end[0] - primitive.centre[0], primitive.end[1] - primitive.centre[1]
    return (-y, x) if primitive.ccw else (y, -x)


def _joined(fits: list[_Fit], curve: Ellipse | Spline, closed: bool) -> tuple[Line | Arc, ...]:
    """Return all primitives with ends that meet exactly, the first and last at the curve's own ends."""
    found = [primitive for fit in fits for primitive in fit.primitives]
    ends = [curve.start, *(p.end for p in found[:-1]), curve.start if closed else curve.end]
    return tuple(
        Line(a, b) if isinstance(p, Line) else Arc(a, b, _levelled(a, b, p.centre), p.ccw)
        for p, a, b in zip(found, ends, ends[1:], strict=False) if a != b
    )
