# mypy: allow-untyped-defs
"""Compiled fits of lines and circles to runs of points, from running sums of their moments about a local origin.

A row of sums after k points holds the sums of x, y, x^2, x y, y^2, x w, y w, w^2 with w = x^2 + y^2, of coordinates
relative to one of the points: sums about a far origin would cancel away the curvature of a short run.
"""

from __future__ import annotations

import math

from ...core.jit import kernel


@kernel("void(float64[:, ::1], int64, int64, int64, float64[:, ::1])")
def add_up(points, origin, first, stop, sums):
    """Continue running sums: sums[k + 1] is over points[origin : origin + k + 1], for first <= k < stop.

    Args:
        points: (n, 2).
        origin: the point that coordinates are relative to, and the first one of the sums.
        first, stop: which rows to write; row `first` must be there, but for sums[0], which is 0.
        sums: (m, 8), m > stop.
    """
    if first == 0:
        sums[0, :] = 0.0
    x0, y0 = points[origin, 0], points[origin, 1]
    for k in range(first, stop):
        x, y = points[origin + k, 0] - x0, points[origin + k, 1] - y0
        w = x * x + y * y
        sums[k + 1, 0] = sums[k, 0] + x
        sums[k + 1, 1] = sums[k, 1] + y
        sums[k + 1, 2] = sums[k, 2] + x * x
        sums[k + 1, 3] = sums[k, 3] + x * y
        sums[k + 1, 4] = sums[k, 4] + y * y
        sums[k + 1, 5] = sums[k, 5] + x * w
        sums[k + 1, 6] = sums[k, 6] + y * w
        sums[k + 1, 7] = sums[k, 7] + w * w


@kernel("UniTuple(float64, 5)(float64[:, ::1], int64, int64)", counts=False)
def _spread(sums, first, stop):
    """Return the mean (x, y) of points first ... stop - 1 and the means of x^2, x y and y^2 about it."""
    n = stop - first
    mx, my = (sums[stop, 0] - sums[first, 0]) / n, (sums[stop, 1] - sums[first, 1]) / n
    xx = (sums[stop, 2] - sums[first, 2]) / n - mx * mx
    xy = (sums[stop, 3] - sums[first, 3]) / n - mx * my
    yy = (sums[stop, 4] - sums[first, 4]) / n - my * my
    return mx, my, xx, xy, yy


@kernel("UniTuple(float64, 4)(float64[:, ::1], int64, int64)", counts=False)
def fit_line(sums, first, stop):
    """Return the line nearest to points first ... stop - 1 (total least squares): a point and a unit vector.

    Coordinates are relative to the sums' origin; the vector's sense is arbitrary.
    """
    mx, my, xx, xy, yy = _spread(sums, first, stop)
    # the principal axis of the scatter: the direction in which it is largest
    angle = math.atan2(2 * xy, xx - yy) / 2
    return mx, my, math.cos(angle), math.sin(angle)


@kernel("float64(float64[:, ::1], int64, int64)", counts=False)
def line_residual(sums, first, stop):
    """Return the mean square residual of points first ... stop - 1 from the line nearest to them."""
    _, _, xx, xy, yy = _spread(sums, first, stop)
    return max((xx + yy) / 2 - math.hypot((xx - yy) / 2, xy), 0.0)


@kernel("UniTuple(float64, 4)(float64[:, ::1], int64, int64)")
def fit_circle(sums, first, stop):
    """Return centre, radius and mean square residual of the circle nearest to points first ... stop - 1; radius 0:
    none.

    Coordinates are relative to the sums' origin.

    References:
        G. Taubin, Estimation of planar curves, surfaces and nonplanar space curves, 1991; its smallest root by Newton's
        method: N. Chernov, Circular and linear regression, 2010.
    """
    n = stop - first
    mx, my = (sums[stop, 0] - sums[first, 0]) / n, (sums[stop, 1] - sums[first, 1]) / n
    sxx, sxy, syy = (
        (sums[stop, 2] - sums[first, 2]) / n,
        (sums[stop, 3] - sums[first, 3]) / n,
        (sums[stop, 4] - sums[first, 4]) / n,
    )
    sxw, syw, sww = (
        (sums[stop, 5] - sums[first, 5]) / n,
        (sums[stop, 6] - sums[first, 6]) / n,
        (sums[stop, 7] - sums[first, 7]) / n,
    )
    q, sw = mx * mx + my * my, sxx + syy
    xx, xy, yy = sxx - mx * mx, sxy - mx * my, syy - my * my
    z = xx + yy
    xz = sxw - 2 * mx * sxx - 2 * my * sxy + q * mx - mx * z
    yz = syw - 2 * mx * sxy - 2 * my * syy + q * my - my * z
    zz = (
        sww
        + 4 * (mx * mx * sxx + my * my * syy)
        + q * q
        - 4 * (mx * sxw + my * syw)
        + 2 * q * sw
        + 8 * mx * my * sxy
        - 4 * q * q
    )
    # coefficients of Taubin's characteristic polynomial in eta, about the mean
    spread, area = zz - z * z, xx * yy - xy * xy
    a1 = spread * z + 4 * area * z - xz * xz - yz * yz
    a0 = xz * (xz * yy - yz * xy) + yz * (yz * xx - xz * xy) - spread * area
    a2, a3 = -3 * z * z - zz, 4 * z
    # Newton's method from 0 climbs to the smallest root, which no other root lies before
    eta, before = 0.0, math.inf
    for _ in range(12):
        value = a0 + eta * (a1 + eta * (a2 + eta * a3))
        slope = a1 + eta * (2 * a2 + 3 * a3 * eta)
        if slope == 0.0 or abs(value) >= before:
            break
        before = abs(value)
        after = eta - value / slope
        if abs(after - eta) <= 1e-14 * abs(after):
            break
        eta = after
    eta = max(eta, 0.0)
    det = eta * eta - eta * z + area
    if det <= 1e-14 * z * z:
        return 0.0, 0.0, 0.0, math.inf
    cx, cy = (xz * (yy - eta) - yz * xy) / det / 2, (yz * (xx - eta) - xz * xy) / det / 2
    return mx + cx, my + cy, math.sqrt(cx * cx + cy * cy + z), eta
