# mypy: allow-untyped-defs
"""Compiled: correction curves through effective points (S21, S22), and the places on them that points move to (S23)."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_TRIES = 12
"""Places of a stretch looked at for the nearest."""
_HALVINGS = 50
"""Of a stretch, until it is as short as a number can tell."""


@kernel("void(float64[::1], float64[:, ::1], float64[:, ::1])")
def spline_slopes(at, value, slope):
    """Write the slopes (m, 3) of the cubic spline through values (m, 3), C2, the outer two pieces at each end one
    cubic.

    Two points make a line, three a parabola.
    """
    m = len(at)
    one, two = at[1] - at[0], at[m - 1] - at[m - 2]
    diagonal, upper = np.empty(m), np.empty(m)
    for axis in range(3):
        p, q = (value[1, axis] - value[0, axis]) / one, (value[m - 1, axis] - value[m - 2, axis]) / two
        if m == 2:
            slope[:, axis] = p
            continue
        if m == 3:
            # A parabola's slope in the middle is the mean of its chords' slopes, each weighed by the other's length.
            middle = (two * p + one * q) / (one + two)
            slope[0, axis], slope[1, axis], slope[2, axis] = 2 * p - middle, middle, 2 * q - middle
            continue
        for i in range(m - 1):  # rows of a tridiagonal system, each cleared of what is below its diagonal at once
            before = at[i] - at[i - 1] if i > 0 else 0.0
            behind = at[i + 1] - at[i]
            q = (value[i + 1, axis] - value[i, axis]) / behind
            if i == 0:
                # Not a knot: the third derivatives of the first two pieces agree, which takes the place of an end
                # condition.
                far = at[2] - at[0]
                diagonal[0], upper[0] = at[2] - at[1], far
                other = (value[2, axis] - value[1, axis]) / (at[2] - at[1])
                slope[0, axis] = ((behind + 2 * far) * (at[2] - at[1]) * q + behind**2 * other) / far
            else:
                factor = behind / diagonal[i - 1]
                diagonal[i], upper[i] = 2 * (before + behind) - factor * upper[i - 1], before
                slope[i, axis] = 3 * (behind * p + before * q) - factor * slope[i - 1, axis]
            p = q
        before, far = at[m - 2] - at[m - 3], at[m - 1] - at[m - 3]
        other = (value[m - 2, axis] - value[m - 3, axis]) / before
        last = (two**2 * other + (2 * far + two) * before * q) / far
        factor = far / diagonal[m - 2]
        slope[m - 1, axis] = (last - factor * slope[m - 2, axis]) / (before - factor * upper[m - 2])
        for i in range(m - 2, -1, -1):
            slope[i, axis] = (slope[i, axis] - upper[i] * slope[i + 1, axis]) / diagonal[i]


@kernel("void(float64[::1], float64[:, ::1], float64[:, ::1])")
def least_squares(at, value, slope):
    """Replace values (m, 3) by those of the cubic nearest to them, and write its slopes; by orthogonal polynomials.

    What is level stays so to the last bit: values are counted from the first.
    """
    m = len(at)
    fitted, basis, old = np.zeros((m, 3)), np.ones(m), np.zeros(m)
    steep, old_steep = np.zeros(m), np.zeros(m)
    fitted[:] = value[0]
    slope[:] = 0.0
    was = 1.0
    for degree in range(min(4, m)):
        size = np.dot(basis, basis)
        for axis in range(3):
            share = (basis * (value[:, axis] - value[0, axis])).sum() / size
            for i in range(m):
                fitted[i, axis] += share * basis[i]
                slope[i, axis] += share * steep[i]
        # The next orthogonal polynomial is (t - centre) times this one less `back` times the one before (Stieltjes,
        # Forsythe); so shares never have to be solved for together, which a cubic's plain powers would make
        # ill-conditioned.
        centre, back = np.dot(basis * basis, at) / size, size / was if degree > 0 else 0.0
        was = size
        for i in range(m):
            new, new_steep = (
                (at[i] - centre) * basis[i] - back * old[i],
                basis[i] + (at[i] - centre) * steep[i] - back * old_steep[i],
            )
            old[i], old_steep[i], basis[i], steep[i] = basis[i], steep[i], new, new_steep
    value[:] = fitted


@kernel(
    "float64(float64, float64[::1], float64[:, ::1], float64[:, ::1], float64[::1], float64[::1], float64[::1])",
    counts=False,
)
def _ahead(t, at, value, slope, point, along, place):
    """Write the place of the curve at t, and return how far it is ahead of a point: as seen along a direction, else its
    own (0).
    """
    i = 0
    while i < len(at) - 2 and t > at[i + 1]:
        i += 1
    size = at[i + 1] - at[i]
    u = (t - at[i]) / size
    fixed = along[0] != 0.0 or along[1] != 0.0 or along[2] != 0.0
    ahead = 0.0
    for axis in range(3):
        a, b = value[i, axis], value[i + 1, axis]
        p, q = slope[i, axis] * size, slope[i + 1, axis] * size
        # Hermite's form: values and slopes at both ends of the piece.
        bend, twist = 3 * (b - a) - 2 * p - q, 2 * (a - b) + p + q
        place[axis] = a + u * (p + u * (bend + u * twist))
        direction = along[axis] if fixed else (p + u * (2 * bend + 3 * u * twist)) / size
        ahead += direction * (place[axis] - point[axis])
    return ahead


@kernel("float64(float64[::1], float64[::1])", counts=False)
def _gap(a, b):
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@kernel(
    "void(float64, float64, float64[::1], float64[:, ::1], float64[:, ::1], float64[::1], float64[::1], float64[::1], "
    "float64[::1])",
    counts=False,
)
def _foot(low, high, at, value, slope, point, along, nothing, place):
    """Write the place of a stretch of the curve that is level with a point along a direction; the nearest if there is
    none.

    `nothing` is three zeros: no direction.
    """
    level = along[0] != 0.0 or along[1] != 0.0 or along[2] != 0.0
    if level and _ahead(low, at, value, slope, point, along, place) <= 0.0 <= _ahead(
        high, at, value, slope, point, along, place
    ):
        direction = along
    else:
        direction = nothing
        best, nearest, step = 0, math.inf, (high - low) / _TRIES
        for i in range(_TRIES + 1):
            _ahead(low + i * step, at, value, slope, point, direction, place)
            away = _gap(place, point)
            if away < nearest:
                nearest, best = away, i
        low, high = low + max(best - 1, 0) * step, low + min(best + 1, _TRIES) * step
    # Only signs are asked, so that no flat place of the curve leads astray; where an end of the stretch is nearest,
    # all signs are alike and it comes out.
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if _ahead(middle, at, value, slope, point, direction, place) > 0.0:
            high = middle
        else:
            low = middle


@kernel(
    "int64(float64[:, ::1], int64[::1], boolean[::1], int64, int64, int64, float64[::1], float64[:, ::1], int64[::1])",
    counts=False,
)
def choose(points, effective, kept, gap, before, after, at, value, chosen):
    """Write which effective points the correction curve of a gap goes by (S21), their places and the lengths up to
    them.

    Returns how many; none beyond a kept point, nor beyond two at one place. Before the first of the gap and after it.
    """
    first, last = gap, gap + 1
    while first > gap - before and first > 0 and not kept[first]:
        if _gap(points[effective[first - 1]], points[effective[first]]) == 0.0:
            break
        first -= 1
    while last < gap + after and last < len(effective) - 1 and not kept[last]:
        if _gap(points[effective[last]], points[effective[last + 1]]) == 0.0:
            break
        last += 1
    for i in range(first, last + 1):
        chosen[i - first] = i
        for axis in range(3):
            value[i - first, axis] = points[effective[i], axis]
        at[i - first] = at[i - first - 1] + _gap(points[effective[i - 1]], points[effective[i]]) if i > first else 0.0
    return last - first + 1


@kernel("float64(float64[:, ::1], int64[::1], int64, float64[:, ::1])", counts=False)
def _farthest(points, effective, first, value):
    """Return how far places of a curve (m, 3) are from the effective points from the `first` on, at most."""
    most = 0.0
    for i in range(len(value)):
        most = max(most, _gap(points[effective[first + i]], value[i]))
    return most


@kernel(
    "void(float64[:, ::1], int64[::1], int64, float64, float64[::1], float64[:, ::1], float64[:, ::1])", counts=False
)
def _curve(points, effective, first, stray, at, value, slope):
    """Write values (m, 3) and slopes of the correction curve by the effective points from the `first` on (S22).

    The cubic by least squares, where it strays from none of them by more than it may; else the spline through them.
    """
    if stray > 0.0:
        least_squares(at, value, slope)
        if _farthest(points, effective, first, value) <= stray:
            return
        for i in range(len(at)):
            for axis in range(3):
                value[i, axis] = points[effective[first + i], axis]
    spline_slopes(at, value, slope)


_SIGNATURE = "void(float64[:, ::1], int64[::1], boolean[::1], int64, int64, float64, boolean, float64[:, ::1])"


@kernel(_SIGNATURE)
def correct(points, effective, kept, before, after, stray, upright, places):
    """Write where every point of a path moves to (n, 3), were all to move; an effective one by the mean of its gaps'
    moves.

    Args:
        effective: (m,) numbers of points, rising, the outer ones among them.
        kept: (m,) which of these do not move.
        stray: how far curves by least squares may be from effective points, mm; where they were farther, and where
            this is 0, curves go through them.
        upright: move at right angles to the chord of the gap, else to the nearest place.
    """
    room = before + after + 1
    at, value, slope, chosen = np.empty(room), np.empty((room, 3)), np.empty((room, 3)), np.empty(room, np.int64)
    along, nothing, place = np.zeros(3), np.zeros(3), np.empty(3)
    places[:] = points
    for gap in range(len(effective) - 1):
        i, k = effective[gap], effective[gap + 1]
        if _gap(points[i], points[k]) == 0.0:
            continue
        m = choose(points, effective, kept, gap, before, after, at, value, chosen)
        _curve(points, effective, chosen[0], stray, at[:m], value[:m], slope[:m])
        if upright:
            along[:] = points[k] - points[i]
        here = gap - chosen[0]
        for j in range(i + 1, k):
            _foot(at[here], at[here + 1], at[:m], value[:m], slope[:m], points[j], along, nothing, place)
            places[j] = place
        for end in range(2):
            if not kept[gap + end]:
                low, high = at[max(here + end - 1, 0)], at[min(here + end + 1, m - 1)]
                _foot(low, high, at[:m], value[:m], slope[:m], points[effective[gap + end]], along, nothing, place)
                # Each of the two gaps that meet here adds half of its own move.
                places[effective[gap + end]] += (place - points[effective[gap + end]]) / 2
