# mypy: allow-untyped-defs
"""Compiled: heights of bicubic B-splines over even knots, and the normal equations of one by scattered places."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel


@kernel("int64(float64, float64[::1], float64[::1])")
def _cubic(at, knots, basis):
    """Write the four cubic B-splines (4,) that are not 0 at a place, or at the end that it is beyond; return the number
    of the first.
    """
    spans = len(knots) - 7
    low, high = knots[3], knots[3 + spans]
    place = min(max(at, low), high)
    # the last knot is of the last span, in which t is 1 there
    first = max(0, min(int((place - low) / (high - low) * spans), spans - 1))
    t = (place - knots[3 + first]) / (knots[4 + first] - knots[3 + first])
    s = 1.0 - t
    # uniform cubic B-splines in closed form: their sum is 1 at every t
    basis[0] = s * s * s / 6
    basis[1] = (3 * t * t * t - 6 * t * t + 4) / 6
    basis[2] = (3 * s * s * s - 6 * s * s + 4) / 6
    basis[3] = t * t * t / 6
    return first


@kernel("void(float64[:, ::1], float64[::1], float64[::1], float64[:, ::1], float64[::1])")
def heights(places, knots_u, knots_v, control, found):
    """Write the heights (k,) at places (k, 2)."""
    along, across = np.empty(4), np.empty(4)
    for k in range(len(places)):
        i, j = _cubic(places[k, 0], knots_u, along), _cubic(places[k, 1], knots_v, across)
        height = 0.0
        for a in range(4):
            for b in range(4):
                height += along[a] * across[b] * control[i + a, j + b]
        found[k] = height


@kernel("void(float64[:, ::1], float64[::1], float64[::1], float64[::1], float64[:, :, :, ::1], float64[:, ::1])")
def add_places(places, weights, knots_u, knots_v, off, right):
    """Add the squares of how far a surface is off places (k, 3), times weights (k,): to off (m, n, 7, 7), by control
    point and by how far the other control point is from it along u and v, less 3; and to right (m, n).
    """
    along, across = np.empty(4), np.empty(4)
    for k in range(len(places)):
        i, j = _cubic(places[k, 0], knots_u, along), _cubic(places[k, 1], knots_v, across)
        for a in range(4):
            for b in range(4):
                own = weights[k] * along[a] * across[b]
                right[i + a, j + b] += own * places[k, 2]
                # both halves of the symmetric matrix: columns are handed on as they are
                for c in range(4):
                    for d in range(4):
                        off[i + a, j + b, 3 + c - a, 3 + d - b] += own * along[c] * across[d]
