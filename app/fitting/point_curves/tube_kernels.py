# mypy: allow-untyped-defs
"""Compiled: whether a stretch of a curve lies within the region round one chord, by signs of Bernstein coefficients."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

P = 5
"""Degree of the pieces."""
INSIDE, OUTSIDE, UNDECIDED = 0, 1, 2
"""What is known of a curve: it lies within the regions, it leaves them, or signs have not decided."""
_FINEST = 1e-11
"""A stretch of so little parameter is not halved again; so near the edge of its region, nobody can decide."""
_ROUNDING = 1e-14
"""Of the numbers that a coefficient is a sum of: by so much rounding may have made it larger."""

_WEIGHTS = np.array(
    [[math.comb(P, i) * math.comb(P, j) / math.comb(2 * P, i + j) for j in range(P + 1)] for i in range(P + 1)]
)
"""What the product of coefficients i and j adds to coefficient i + j of a product in Bernstein form."""


@kernel("void(float64[:, :, ::1], float64, float64, float64[:, ::1])", counts=False)
def portion(control, a, b, out):
    """Write the control points (6, 3) of the curve between parameters a <= b of one piece."""
    k = min(int(a), len(control) - 1)
    if b <= k:
        k = max(k - 1, 0)
    t, rest = a - k, 1.0 - (a - k)
    s = (b - a) / rest if rest > 0.0 else 1.0
    for axis in range(3):
        for i in range(P + 1):
            out[i, axis] = control[k, i, axis]
        # De Casteljau twice: first what is behind t, then of that the share s.
        for r in range(1, P + 1):
            for i in range(P + 1 - r):
                out[i, axis] = (1.0 - t) * out[i, axis] + t * out[i + 1, axis]
        for r in range(1, P + 1):
            for i in range(P, r - 1, -1):
                out[i, axis] = (1.0 - s) * out[i - 1, axis] + s * out[i, axis]


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1])", counts=False)
def halved(b, left, right):
    """Write the two halves of a piece (6, 3)."""
    for axis in range(3):
        for i in range(P + 1):
            right[i, axis] = b[i, axis]
        for r in range(P + 1):
            left[r, axis] = right[0, axis]
            for i in range(P - r):
                right[i, axis] = 0.5 * (right[i, axis] + right[i + 1, axis])


@kernel("void(float64[:, :, ::1], float64, float64[::1])", counts=False)
def point_at(control, u, out):
    """Write the curve's point at a parameter."""
    k = min(int(u), len(control) - 1)
    t = u - k
    s = 1.0 - t
    for axis in range(3):
        c = control[k]
        value, power, choose = c[0, axis], 1.0, 1.0
        for i in range(1, P + 1):  # Horner in Bernstein form
            power *= t
            choose = choose * (P - i + 1) / i
            value = value * s + choose * power * c[i, axis]
        out[axis] = value


@kernel("float64(float64[::1], float64[::1], float64[::1])", counts=False)
def squared_off_chord(c, a, b):
    """Return the squared distance of a point from a chord."""
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    px, py, pz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    size = dx * dx + dy * dy + dz * dz
    share = (px * dx + py * dy + pz * dz) / size if size > 0.0 else 0.0
    share = min(max(share, 0.0), 1.0)
    px, py, pz = px - share * dx, py - share * dy, pz - share * dz
    return px * px + py * py + pz * pz


@kernel("boolean(float64[::1], float64[::1], float64[::1], float64, float64)", counts=False)
def holds_point(c, a, b, end, swell):
    """Tell whether the region round a chord holds a point.

    Args:
        end: squared radius at the chord's ends, and of the balls there.
        swell: 4 (middle^2 - end): what the squared radius gains in the middle, four times.
    """
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    px, py, pz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    size, here = dx * dx + dy * dy + dz * dz, px * px + py * py + pz * pz
    along = px * dx + py * dy + pz * dz
    if here <= end or size - 2 * along + here <= end:
        return True
    if size == 0.0 or along < 0.0 or along > size:
        return False
    share = along / size
    return here - share * along <= end + swell * share * (1.0 - share)


@kernel("boolean(float64[:, ::1], float64, float64, float64, float64)", counts=False)
def _signs(work, end, swell, size, guard):
    """Tell whether all coefficients of the body's inequality are above the rounding."""
    for k in range(2 * P + 1):
        value = end
        for i in range(max(0, k - P), min(k, P) + 1):
            j = k - i
            dot = work[i, 0] * work[j, 0] + work[i, 1] * work[j, 1] + work[i, 2] * work[j, 2]
            both = work[i, 3] * work[j, 3]
            # The share times 1, written evenly, is (share_i + share_j) / 2: so it has the products' degree. Bernstein
            # polynomials are positive, so a function whose coefficients all are is, too.
            value += _WEIGHTS[i, j] * (swell * (0.5 * (work[i, 3] + work[j, 3]) - both) - dot + size * both)
        if value < guard:
            return False
    return True


@kernel("boolean(float64[:, ::1], float64, float64, float64, float64, float64)", counts=False)
def _ball_signs(work, x, y, z, end, guard):
    """Tell whether all coefficients of a ball's inequality are above the rounding; its centre counts from the chord's
    start.
    """
    for i in (0, P):
        if (work[i, 0] - x) ** 2 + (work[i, 1] - y) ** 2 + (work[i, 2] - z) ** 2 > end:
            return False
    for k in range(2 * P + 1):
        value = end
        for i in range(max(0, k - P), min(k, P) + 1):
            j = k - i
            dot = (
                (work[i, 0] - x) * (work[j, 0] - x)
                + (work[i, 1] - y) * (work[j, 1] - y)
                + (work[i, 2] - z) * (work[j, 2] - z)
            )
            value -= _WEIGHTS[i, j] * dot
        if value < guard:
            return False
    return True


@kernel("boolean(float64[:, ::1], float64[::1], float64[::1], float64, float64, float64[:, ::1])", counts=False)
def holds_piece(piece, a, b, end, swell, work):
    """Tell whether Bernstein signs prove that the region round a chord holds a piece: True is a proof, False is none.

    The body holds it where 0 <= share <= 1 and end + swell share (1 - share) - off^2 >= 0 in all coefficients, a ball
    where end - distance^2 >= 0 in all.
    """
    dx, dy, dz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    size = dx * dx + dy * dy + dz * dz
    near, body, reach = True, size > 0.0, 0.0
    for i in range(P + 1):
        px, py, pz = piece[i, 0] - a[0], piece[i, 1] - a[1], piece[i, 2] - a[2]
        here = px * px + py * py + pz * pz
        share = (px * dx + py * dy + pz * dz) / size if size > 0.0 else 0.0
        work[i, 0], work[i, 1], work[i, 2], work[i, 3] = px, py, pz, share
        reach = max(reach, here)
        body = body and 0.0 <= share <= 1.0
        within = min(max(share, 0.0), 1.0)
        near = near and here + within * (within - 2.0 * share) * size <= end
    if near:  # the capsule is convex: it holds the piece if it holds its control points
        return True
    guard = _ROUNDING * (reach + end)
    if body:
        return _signs(work, end, swell, size, guard)
    return _ball_signs(work, 0.0, 0.0, 0.0, end, guard) or _ball_signs(work, dx, dy, dz, end, guard)


@kernel("boolean(float64[:, ::1], float64[::1], float64)", counts=False)
def _keeps_off(piece, centre, end):
    """Tell whether Bernstein signs prove that a piece has no point in a ball."""
    # Distance squared less the radius squared, in Bernstein form: positive where all coefficients are.
    for k in range(2 * P + 1):
        value = -end
        for i in range(max(0, k - P), min(k, P) + 1):
            j, dot = k - i, 0.0
            for axis in range(3):
                dot += (piece[i, axis] - centre[axis]) * (piece[j, axis] - centre[axis])
            value += _WEIGHTS[i, j] * dot
        if value <= 0.0:
            return False
    return True


@kernel("float64(float64[:, :, ::1], float64, float64, float64[::1], float64[::1], float64, float64)")
def first_exit(control, start, stop, a, b, end, swell):
    """Return up to where, from `start` on, the curve is proven to lie in the region round a chord; at most `stop`."""
    piece, work, stack = np.empty((P + 1, 3)), np.empty((P + 1, 4)), np.empty(64)
    low = start
    while low < stop:
        depth, stack[0] = 1, min(math.floor(low) + 1.0, stop)
        # Proven from start to low. The stack holds ends of stretches, the nearest on top, each tried from low on.
        while depth > 0:
            high = stack[depth - 1]
            portion(control, low, high, piece)
            if holds_piece(piece, a, b, end, swell, work):
                low, depth = high, depth - 1
            elif high - low < _FINEST or depth == 64 or not holds_point(piece[0], a, b, end, swell):
                return low
            else:
                stack[depth] = 0.5 * (low + high)
                depth += 1
    return stop


@kernel("float64(float64[:, :, ::1], float64, float64, float64[::1], float64)")
def first_entry(control, start, stop, centre, end):
    """Return where, from `start` on, the curve first lies in a ball; more than `stop` where it does not up to there."""
    piece, stack = np.empty((P + 1, 3)), np.empty(64)
    low = start
    while low < stop:
        depth, stack[0] = 1, min(math.floor(low) + 1.0, stop)
        # As in `first_exit`: from start to low the curve is proven to keep off, or stretches too short to halve were
        # passed.
        while depth > 0:
            high = stack[depth - 1]
            portion(control, low, high, piece)
            if holds_point(piece[0], centre, centre, end, 0.0):
                return low
            if _keeps_off(piece, centre, end) or depth == 64 or high - low < _FINEST:
                low, depth = high, depth - 1
            else:
                stack[depth] = 0.5 * (low + high)
                depth += 1
    point_at(control, stop, piece[0])
    return stop if holds_point(piece[0], centre, centre, end, 0.0) else stop + 1.0
