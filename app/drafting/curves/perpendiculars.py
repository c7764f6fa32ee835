"""Where the way from a point to an ellipse or a spline stands square on it or touches it: every such place, to the last
digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...geometry.sample import Points, derivative, spline_points
from ...model.curves import Ellipse, Point, Spline

_SAMPLES = 24
"""So many places of each span are looked at; of two solutions closer than that neither may be found."""

_HALVINGS = 60
"""Of a stretch, until it is as short as a number can tell."""
_VANISHES = 1e-9
"""Of the lengths of both factors, and mm: what is less is 0."""

Numbers = NDArray[np.float64]
Ways = Callable[[Numbers], tuple[Points, Points]]
"""From parameters to the ways there from the point, and the directions of the curve; each of any positive length."""


def perpendicular_feet(curve: Ellipse | Spline, base: Point) -> list[Point]:
    """Return the points of a curve where the way from a point stands square on it, mm, in the order of its
    parameter.
    """
    return _places(curve, base, lambda way, along: np.einsum("ij,ij->i", way, along))


def spline_tangents(curve: Spline, base: Point) -> list[Point]:
    """Return the points of a spline where a line from a point touches it, mm, in the order of its parameter."""
    return _places(curve, base, lambda way, along: way[:, 0] * along[:, 1] - way[:, 1] * along[:, 0])


def _places(curve: Ellipse | Spline, base: Point, product: Callable[[Points, Points], Numbers]) -> list[Point]:
    """Return the points where a product of way and direction vanishes, found by halving between samples of opposite
    signs.
    """
    ways = _of_ellipse(curve, base) if isinstance(curve, Ellipse) else _of_spline(curve, base)
    spans = (
        np.linspace(curve.start_parameter, curve.end_parameter, 13)
        if isinstance(curve, Ellipse)
        else np.unique(curve.knots)
    )
    at = np.append(np.linspace(spans[:-1], spans[1:], _SAMPLES, endpoint=False, axis=1).ravel(), spans[-1])
    signs = np.sign(product(*ways(at)))
    rows = np.flatnonzero((signs[:-1] * signs[1:] < 0) | (signs[:-1] == 0))
    low, high, sign = at[rows], at[rows + 1], signs[rows]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        before = np.sign(product(*ways(middle))) == sign
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    found = np.append(np.where(sign == 0, at[rows], low), at[-1:] if signs[-1] == 0 else [])
    way, along = ways(found)
    sizes = np.hypot(*way.T) * np.hypot(*along.T)
    good = np.abs(product(way, along)) <= _VANISHES * sizes  # at a kink the sign changes and nothing vanishes
    if isinstance(curve, Ellipse):
        return _distinct([curve.at(float(t)) for t in found[good]])
    return _distinct([(float(x), float(y)) for x, y in spline_points(curve, found[good])])


def _distinct(points: list[Point]) -> list[Point]:
    kept = list[Point]()
    for point in points:
        if all(math.dist(point, other) > _VANISHES for other in kept):
            kept.append(point)
    return kept


def _of_ellipse(curve: Ellipse, base: Point) -> Ways:
    a = np.array(curve.major)
    b, to_centre = curve.ratio * np.array((-a[1], a[0])), np.subtract(curve.centre, base)

    def ways(t: Numbers) -> tuple[Points, Points]:
        c, s = np.cos(t)[:, None], np.sin(t)[:, None]
        return to_centre + c * a + s * b, c * b - s * a

    return ways


def _of_spline(curve: Spline, base: Point) -> Ways:
    """A point of a rational spline is p / w; the direction is that of p' w - p w', and no quotient is needed."""
    weights = curve.weights or (1.0,) * len(curve.control_points)
    weighted = tuple(
        ((x - base[0]) * w, (y - base[1]) * w) for (x, y), w in zip(curve.control_points, weights, strict=True)
    )
    p, w = (
        Spline(curve.degree, weighted, curve.knots),
        Spline(curve.degree, tuple((w, 0.0) for w in weights), curve.knots),
    )
    p_on, w_on = derivative(p), derivative(w)

    def ways(t: Numbers) -> tuple[Points, Points]:
        place, weight = spline_points(p, t), spline_points(w, t)[:, :1]
        return place, spline_points(p_on, t) * weight - place * spline_points(w_on, t)[:, :1]

    return ways
