"""The area that curves enclose where they close up, by Green's theorem: half the integral of x dy - y dx round them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...geometry.sample import derivative, spline_points
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Spline
from .chains import chained


def enclosed_area(curves: Sequence[Curve]) -> float | None:
    """Return the area within curves that together form one closed contour, mm2; None where they form none, or several.

    Exact but for rational splines, which it does not measure (None). Ends that are nearer than the program welds meet;
    a contour that crosses itself counts what it goes round twice twice, and opposite ways against one another.
    """
    chains = chained(dict(enumerate(curves)))
    if len(chains) != 1 or not chains[0].closed:
        return None
    swept = [_swept(curve) for curve in chains[0].curves]
    return None if None in swept else abs(sum(each for each in swept if each is not None))


def _swept(curve: Curve) -> float | None:
    """Return half the integral of x dy - y dx along a curve, mm2."""
    if isinstance(curve, Circle):
        return math.pi * curve.radius**2 * (1 if curve.ccw else -1)
    if isinstance(curve, Spline):
        return _of_spline(curve)
    (x, y), (ex, ey) = curve.start, curve.end
    if isinstance(curve, Line):
        return (x * ey - y * ex) / 2
    if isinstance(curve, Arc):
        return (x * ey - y * ex + curve.radius**2 * (curve.sweep - math.sin(curve.sweep))) / 2
    return _of_ellipse(curve)


def _of_ellipse(curve: Ellipse) -> float:
    (cx, cy), (x, y), (ex, ey) = curve.centre, curve.start, curve.end
    turned = (curve.end_parameter - curve.start_parameter) * (1 if curve.ccw else -1)
    return (cx * (ey - y) - cy * (ex - x) + math.hypot(*curve.major) ** 2 * curve.ratio * turned) / 2


def _of_spline(curve: Spline) -> float | None:
    """Integrate span by span with Gauss' points, as many as make a polynomial of the degree exact."""
    if curve.weights:
        return None
    at, share = np.polynomial.legendre.leggauss(curve.degree)
    spans = np.unique(curve.knots)
    low, high = spans[:-1, None], spans[1:, None]
    u = (low + high) / 2 + (high - low) / 2 * at
    points, slopes = spline_points(curve, u.ravel()), spline_points(derivative(curve), u.ravel())
    turning = (points[:, 0] * slopes[:, 1] - points[:, 1] * slopes[:, 0]).reshape(u.shape)
    return float((turning * share * (high - low) / 2).sum() / 2)
