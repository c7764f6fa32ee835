# mypy: allow-untyped-defs
"""Compiled: least-squares B-splines in space, their values, and places nearest to points. Cost rises with the points
alone.
"""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel
from ..band_kernels import factor
from .tube_feet_kernels import settle
from .tube_kernels import P, first_exit, holds_point, point_at

_STIFF = 1e-9
"""How much each control point wants to be between its neighbours, beside wanting the points near: it decides where no
point does.
"""


@kernel("void(float64[::1], int64, int64, float64, float64[::1])", counts=False)
def _basis(knots, degree, span, t, values):
    """Write the degree + 1 B-splines that are not 0 between knots span and span + 1 (de Boor and Cox)."""
    values[0] = 1.0
    for level in range(1, degree + 1):
        saved = 0.0
        for r in range(level):
            right, left = knots[span + r + 1] - t, t - knots[span + 1 - level + r]
            part = values[r] / (right + left)
            values[r], saved = saved + right * part, left * part
        values[level] = saved


@kernel("int64(float64[::1], int64, float64, int64)", counts=False)
def _span_of(knots, degree, t, span):
    """Return the span that holds a parameter, looked for from one before on."""
    last = len(knots) - degree - 2
    while span < last and t >= knots[span + 1]:
        span += 1
    return span


@kernel("boolean(float64[:, ::1], float64[:, ::1])", counts=False)
def _cholesky(band, right):
    """Solve a symmetric positive system, given by its lower band (k, p + 1), in place."""
    count, p = len(band), band.shape[1] - 1
    if not factor(band):
        return False
    for axis in range(3):
        for i in range(count):
            total = right[i, axis]
            for j in range(max(0, i - p), i):
                total -= band[i, i - j] * right[j, axis]
            right[i, axis] = total / band[i, 0]
        for i in range(count - 1, -1, -1):
            total = right[i, axis]
            for j in range(i + 1, min(count, i + p + 1)):
                total -= band[j, j - i] * right[j, axis]
            right[i, axis] = total / band[i, 0]
    return True


@kernel("boolean(float64[::1], int64, float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], float64[:, ::1])")
def solve(knots, degree, points, places, weights, lead, control):
    """Write the control points (k, 3) of least squares; the last is the last point. False: singular.

    Args:
        places: (n,) parameters of the points, never falling.
        lead: (h, 3) the first control points, which are given, h < k.
    """
    count, p = len(control), degree
    band, values = np.zeros((count, p + 1)), np.empty(p + 1)
    control[:] = 0.0
    span = p
    for i in range(len(points)):
        span = _span_of(knots, p, places[i], span)
        _basis(knots, p, span, places[i], values)
        for a in range(p + 1):
            row, share = span - p + a, weights[i] * values[a]
            for b in range(a + 1):
                band[row, a - b] += share * values[b]
            for axis in range(3):
                control[row, axis] += share * points[i, axis]
    mean = 0.0
    for row in range(count):
        mean += band[row, 0] / count
    stiff = _STIFF * mean
    for row in range(1, count - 1):
        # The square of c[row - 1] - 2 c[row] + c[row + 1], weighed.
        band[row, 0] += stiff * 4.0
        band[row - 1, 0] += stiff
        band[row + 1, 0] += stiff
        band[row, 1] -= stiff * 2.0
        band[row + 1, 1] -= stiff * 2.0
        band[row + 1, 2] += stiff
    held = len(lead)
    for number in range(held + 1):  # fixed: their columns go to the right side
        end = number if number < held else count - 1
        place = lead[number] if number < held else points[len(points) - 1]
        for other in range(max(0, end - p), min(count, end + p + 1)):
            low, off = max(end, other), abs(end - other)
            if other != end:
                for axis in range(3):
                    control[other, axis] -= band[low, off] * place[axis]
            band[low, off] = 0.0
        band[end, 0] = 1.0
        for axis in range(3):
            control[end, axis] = place[axis]
    return _cholesky(band, control)


@kernel("int64(float64[:, :, ::1], float64[:, ::1], float64[::1], float64, float64, boolean[::1])")
def failing(control, points, feet, end, swell, bad):
    """Mark the chords (n - 1,) whose stretch of the curve is not proven to be in their region; return how many."""
    here, count = np.empty(3), 0
    bad[:] = False
    for i in range(len(points)):
        point_at(control, feet[i], here)
        if not holds_point(here, points[i], points[i], end, 0.0):
            # A foot that is too far from its point spoils the chords on both sides; no proof has to be tried there.
            bad[min(i, len(bad) - 1)] = True
            bad[max(i - 1, 0)] = True
    for i in range(len(points) - 1):
        if not bad[i]:
            bad[i] = first_exit(control, feet[i], feet[i + 1], points[i], points[i + 1], end, swell) < feet[i + 1]
        count += bad[i]
    return count


@kernel("void(float64[::1], int64, float64[:, ::1], float64[:, :, ::1])")
def cut(knots, degree, control, pieces):
    """Write the Bézier pieces (m, 6, 3) of a spline with clamped ends and single knots within, raised to degree 5.

    Control point j of a span is the blossom at its ends, taken p - j and j times.
    """
    p, b = degree, np.empty((P + 1, 3))
    for k in range(len(pieces)):
        span = k + p
        low, high = knots[span], knots[span + 1]
        for j in range(p + 1):
            for i in range(p + 1):
                for axis in range(3):
                    b[i, axis] = control[span - p + i, axis]
            for level in range(1, p + 1):
                t = high if level <= j else low
                for i in range(p - level + 1):
                    first = knots[span - p + level + i]
                    share = (t - first) / (knots[span + 1 + i] - first)
                    for axis in range(3):
                        b[i, axis] = (1.0 - share) * b[i, axis] + share * b[i + 1, axis]
            for axis in range(3):
                pieces[k, j, axis] = b[0, axis]
        for raised in range(p, P):  # point i of one degree more is between points i - 1 and i
            for i in range(raised + 1, -1, -1):
                share = i / (raised + 1)
                for axis in range(3):
                    before = pieces[k, i - 1, axis] if i > 0 else 0.0
                    behind = pieces[k, i, axis] if i <= raised else 0.0
                    pieces[k, i, axis] = share * before + (1.0 - share) * behind


@kernel(
    "void(float64[::1], int64, float64[:, ::1], float64[::1], float64[::1], int64, float64, float64, "
    "float64[:, ::1], float64[:, ::1], float64[:, :, ::1], float64[::1], float64[::1], boolean[::1])"
)
def tried(breaks, degree, samples, places, weights, every, end, swell, lead, control, pieces, feet, moved, bad):
    """Fit a spline over breaks to samples and see where it is proven.

    Args:
        breaks: (m + 1,) between its spans. degree: p.
        samples: (s, 3). places, weights: of each.
        every: each so many samples is a point; what lies between is on chords.
        end, swell: region, as in `holds_point`.
        lead: (h, 3) the first control points, h < m + p.
        control: (m + p, 3) out. pieces: (m, 6, 3) out. feet: (n,) out: of the points, on the pieces.
        moved: (s,) out: places nearer to the samples. bad: (n - 1,) out: chords that are not proven.
    """
    count = len(breaks)
    knots = np.empty(count + 2 * degree)
    # Clamped: with the outer breaks themselves degree + 1 knots stand at each end, so the spline begins and ends at
    # its outer control points.
    knots[:degree], knots[degree + count :] = breaks[0], breaks[count - 1]
    knots[degree : degree + count] = breaks
    solve(knots, degree, samples, places, weights, lead, control)
    cut(knots, degree, control, pieces)
    on, span = np.empty(len(samples)), 0
    for i in range(len(samples)):
        while span < count - 2 and places[i] >= breaks[span + 1]:
            span += 1
        on[i] = span + (places[i] - breaks[span]) / (breaks[span + 1] - breaks[span])
    settle(pieces, samples, on)
    for i in range(len(samples)):
        span = min(int(on[i]), count - 2)
        # Back from places on pieces, which are all 1 long, to the spline's own parameter.
        moved[i] = breaks[span] + (on[i] - span) * (breaks[span + 1] - breaks[span])
    points = np.empty((len(feet), 3))
    for i in range(len(feet)):
        feet[i] = on[i * every]
        points[i] = samples[i * every]
    failing(pieces, points, feet, end, swell, bad)
