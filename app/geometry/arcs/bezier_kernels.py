# mypy: allow-untyped-defs
"""Compiled: places, tangents and bounds of plane curves of rational Bézier pieces, see
`app.geometry.arcs.bezier.BezierCurve`.

A curve is its control points (n, p + 1, 3), homogeneous: w x, w y, w; its parameter u runs from 0 to n.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_CONTROL, _PIECE, _FOUND = "float64[:, :, ::1]", "float64[:, ::1]", "float64[::1]"
_NEAR = 1e-5
"""Of a piece: so far on a curve that stands still at a place is looked at for where it goes."""
_FLAT = 1e-6
"""Twice the area of three places, shared by their greatest distance squared, below which they lie in a line."""
_ROUNDING = 1e-3
"""mm; far more than rounding makes of the radius to a place."""


@kernel(f"void({_CONTROL}, float64, {_PIECE}, {_FOUND})", counts=False)
def place(control, u, work, found):
    """Write the place at a parameter, mm, and a vector along the tangent there, of any length.

    Args:
        work: (p + 1, 3) is written over. found: (4,) out.
    """
    k, degree = min(max(int(u), 0), len(control) - 1), control.shape[1] - 1
    t = u - k
    for j in range(degree + 1):
        for axis in range(3):
            work[j, axis] = control[k, j, axis]
    # De Casteljau without its last step: the last two points give the place and the tangent.
    for level in range(degree, 1, -1):
        for j in range(level):
            for axis in range(3):
                work[j, axis] += (work[j + 1, axis] - work[j, axis]) * t
    w = work[0, 2] + (work[1, 2] - work[0, 2]) * t
    for axis in range(2):
        along = work[1, axis] - work[0, axis]
        found[axis] = (work[0, axis] + along * t) / w
        # The slope of (w x) / w is ((w x)' - x w') / w; neither the 1 / w nor the degree turns it.
        found[2 + axis] = along - found[axis] * (work[1, 2] - work[0, 2])


@kernel(f"UniTuple(float64, 2)({_CONTROL}, float64, boolean, float64, {_PIECE}, {_FOUND})", counts=False)
def direction(control, u, forward, still, work, found):
    """Return the unit tangent just after (forward) or just before a parameter; (0, 0) where the curve stands still.

    Args:
        still: a chord no longer than this, mm, has no direction.
    """
    sign = 1.0 if forward else -1.0
    if u == math.floor(u):
        k, degree = int(u), control.shape[1] - 1
        k = min(k, len(control) - 1) if forward else max(k - 1, 0)
        # At a piece's end the tangent is towards the first control point that stands apart, also where the slope is
        # 0.
        here = 0 if forward else degree
        for j in range(1, degree + 1):
            other = j if forward else degree - j
            dx = sign * (control[k, other, 0] / control[k, other, 2] - control[k, here, 0] / control[k, here, 2])
            dy = sign * (control[k, other, 1] / control[k, other, 2] - control[k, here, 1] / control[k, here, 2])
            size = math.hypot(dx, dy)
            if size > still:
                return dx / size, dy / size
        return 0.0, 0.0
    place(control, u, work, found)
    x, y, dx, dy = found[0], found[1], found[2], found[3]
    size = math.hypot(dx, dy)
    if not size > still:
        place(control, u + sign * _NEAR, work, found)
        dx, dy = sign * (found[0] - x), sign * (found[1] - y)
        size = math.hypot(dx, dy)
    return (dx / size, dy / size) if size > still else (0.0, 0.0)


@kernel(f"void({_CONTROL}, float64, float64, {_PIECE}, {_PIECE})", counts=False)
def cut(control, first, last, work, piece):
    """Write the stretch between two parameters of one piece: control point j is the blossom of its ends, taken p - j
    and j times.
    """
    # Its middle names the piece: an end may lie on the joint to a neighbour.
    k, degree = min(max(int((first + last) / 2), 0), len(control) - 1), control.shape[1] - 1
    for j in range(degree + 1):
        for i in range(degree + 1):
            for axis in range(3):
                work[i, axis] = control[k, i, axis]
        for level in range(degree):
            t = (last if level < j else first) - k
            for i in range(degree - level):
                for axis in range(3):
                    work[i, axis] = work[i, axis] * (1.0 - t) + work[i + 1, axis] * t
        for axis in range(3):
            piece[j, axis] = work[0, axis]


@kernel(f"float64({_PIECE}, float64, float64, float64, float64)", counts=False)
def off_line(piece, ax, ay, bx, by):
    """Return a bound of how far a piece is from the line from a to b, mm: that of its control points, each way by
    itself.
    """
    dx, dy = bx - ax, by - ay
    length = math.hypot(dx, dy)
    aside, beyond, still = 0.0, 0.0, 0.0
    for j in range(len(piece)):
        x, y = piece[j, 0] / piece[j, 2] - ax, piece[j, 1] / piece[j, 2] - ay
        still = max(still, math.hypot(x, y))
        if length > 0.0:
            along = (x * dx + y * dy) / length
            aside, beyond = max(aside, abs(y * dx - x * dy) / length), max(beyond, -along, along - length)
    return math.hypot(aside, beyond) if length > 0.0 else still


@kernel(f"float64({_PIECE}, float64, float64, float64, float64, {_CONTROL})", counts=False)
def off_circle(piece, x, y, cx, cy, products):
    """Return a bound of how far a piece is from the circle round a centre c through a place, mm.

    The squared distance from the centre is a polynomial over the squared weight; its Bernstein coefficients enclose it,
    so nothing between samples can escape. What it is more than the squared radius is reckoned from the place on the
    circle, where it is small.

    Args:
        products: (p + 1, p + 1, 2 p + 1) the table that multiplies two polynomials in Bernstein form.
    """
    count, rx, ry = len(piece), x - cx, y - cy
    radius, least, worst = math.hypot(rx, ry), math.inf, 0.0
    for j in range(count):
        least = min(least, piece[j, 2])
    for k in range(2 * count - 1):
        gap = 0.0
        for i in range(max(0, k - count + 1), min(k, count - 1) + 1):
            j = k - i
            ix, iy = piece[i, 0] - piece[i, 2] * x, piece[i, 1] - piece[i, 2] * y
            jx, jy = piece[j, 0] - piece[j, 2] * x, piece[j, 1] - piece[j, 2] * y
            # |p - c|² - r² = |p - q|² + 2 (p - q)·(q - c) with q on the circle: no difference of large squares.
            gap += products[i, j, k] * (ix * jx + iy * jy + 2.0 * piece[i, 2] * (jx * rx + jy * ry))
        gap /= least * least
        # sqrt(r² + gap) - r, without the difference.
        worst = max(worst, abs(gap / (math.sqrt(max(radius * radius + gap, 0.0)) + radius)))
    return worst


@kernel(f"void({_PIECE}, {_FOUND}, int64[::1], {_CONTROL})")
def blossoms(points, knots, spans, result):
    """Write the control points of a B-spline's Bézier pieces: j of a span is the blossom at its ends, taken p - j and j
    times.

    Args:
        points: (k, d) control points. knots: (k + p + 1,). spans: (n,) index of the knot that each piece begins at.
        result: (n, p + 1, d) out.
    """
    p = result.shape[1] - 1
    work = np.empty((p + 1, points.shape[1]))
    for n in range(len(spans)):
        span = spans[n]
        for j in range(p + 1):
            for i in range(p + 1):
                for axis in range(points.shape[1]):
                    work[i, axis] = points[span - p + i, axis]
            for level in range(1, p + 1):
                t = knots[span + 1] if level <= j else knots[span]
                for i in range(p - level + 1):
                    low = knots[span - p + level + i]
                    share = (t - low) / (knots[span + 1 + i] - low)
                    for axis in range(points.shape[1]):
                        work[i, axis] = work[i, axis] * (1.0 - share) + work[i + 1, axis] * share
            for axis in range(points.shape[1]):
                result[n, j, axis] = work[0, axis]


@kernel(f"boolean({_CONTROL}, boolean, float64, float64, float64)")
def surely_not_round(control, given, cx, cy, tolerance):
    """Tell whether places on a curve show that it is no circle round a centre, or through three of them; False where
    they do not.

    Args:
        given: whether the centre is, else it is that of the circle through the curve's thirds.
        tolerance: by how much the curve may be off a circle, mm.
    """
    count = 8 * len(control) + 1
    work, found = np.empty((control.shape[1], 3)), np.empty(4)
    place(control, 0.0, work, found)
    x, y = found[0], found[1]
    if not given:
        place(control, (count // 3) / 8, work, found)
        ux, uy = found[0] - x, found[1] - y
        place(control, (2 * count // 3) / 8, work, found)
        vx, vy = found[0] - x, found[1] - y
        double, u, v = 2.0 * (ux * vy - uy * vx), ux * ux + uy * uy, vx * vx + vy * vy
        if abs(double) < _FLAT * max(u, v):
            return abs(double) < 0.9 * _FLAT * max(u, v)
        cx, cy = x + (vy * u - uy * v) / double, y + (ux * v - vx * u) / double
    least = most = math.hypot(x - cx, y - cy)
    for k in range(1, count):
        place(control, k / 8, work, found)
        radius = math.hypot(found[0] - cx, found[1] - cy)
        least, most = min(least, radius), max(most, radius)
        # Whatever is within the tolerance of a circle is at radii that differ by twice as much at most.
        if most - least > 2.0 * tolerance + _ROUNDING:
            return True
    return False
