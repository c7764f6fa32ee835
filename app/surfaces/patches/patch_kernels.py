# mypy: allow-untyped-defs
"""Compiled: places on rational Bézier patches, and facets that stand for ever smaller parts of them."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...model.scene_curves import MOST_DEGREE

_BINOMIALS = np.array([[math.comb(n, k) for k in range(MOST_DEGREE + 1)] for n in range(MOST_DEGREE + 1)], np.float64)
"""n over k in row n, column k: what weighs a control point of a degree."""
_MANY, _NETS = "float64[:, ::1]", "float64[:, :, :, ::1]"


@kernel(f"UniTuple(float64, 3)({_NETS}, int64, float64, float64)", counts=False)
def place(control, patch, u, v):
    """Return the place of a patch (of n, p + 1, q + 1, 4) at its parameters, by Horner's rule for Bernstein
    polynomials.
    """
    p, q = control.shape[1] - 1, control.shape[2] - 1
    s, t = 1.0 - u, 1.0 - v
    x = y = z = w = 0.0
    if p == 3 and q == 3:  # what nearly all are, in half the time
        low, near, far, high = t * t * t, 3.0 * t * t * v, 3.0 * t * v * v, v * v * v
        for i in range(4):
            share = s * s * s if i == 0 else (3.0 * s * s * u if i == 1 else (3.0 * s * u * u if i == 2 else u * u * u))
            a, b, c, d = share * low, share * near, share * far, share * high
            x += (
                a * control[patch, i, 0, 0]
                + b * control[patch, i, 1, 0]
                + c * control[patch, i, 2, 0]
                + d * control[patch, i, 3, 0]
            )
            y += (
                a * control[patch, i, 0, 1]
                + b * control[patch, i, 1, 1]
                + c * control[patch, i, 2, 1]
                + d * control[patch, i, 3, 1]
            )
            z += (
                a * control[patch, i, 0, 2]
                + b * control[patch, i, 1, 2]
                + c * control[patch, i, 2, 2]
                + d * control[patch, i, 3, 2]
            )
            w += (
                a * control[patch, i, 0, 3]
                + b * control[patch, i, 1, 3]
                + c * control[patch, i, 2, 3]
                + d * control[patch, i, 3, 3]
            )
        return x / w, y / w, z / w
    up = 1.0
    for i in range(p + 1):
        a, b, c, d = 0.0, 0.0, 0.0, 0.0
        power = 1.0
        for j in range(q + 1):
            share = power * _BINOMIALS[q, j]
            a, b = a * t + share * control[patch, i, j, 0], b * t + share * control[patch, i, j, 1]
            c, d = c * t + share * control[patch, i, j, 2], d * t + share * control[patch, i, j, 3]
            power *= v
        share = up * _BINOMIALS[p, i]
        x, y, z, w = x * s + share * a, y * s + share * b, z * s + share * c, w * s + share * d
        up *= u
    return x / w, y / w, z / w


@kernel(f"void({_NETS}, int64, {_MANY}, int64, int64)", counts=False)
def quarter(control, patch, rows, source, first):
    """Set rows `first` to first + 3 to the quarters of the facet in row `source`, their corners anew on the patch.

    No place of the patch is farther from a quarter than a quarter of how far it may be from the whole.

    Args:
        rows: (k, 15 or more) corners (9) and their parameters (6) of facets.
    """
    for k in range(3):  # corner k stays, and so is that of quarter k; the others and the middle one are made of middles
        n = (k + 1) % 3
        u, v = (
            0.5 * (rows[source, 9 + 2 * k] + rows[source, 9 + 2 * n]),
            0.5 * (rows[source, 10 + 2 * k] + rows[source, 10 + 2 * n]),
        )
        x, y, z = place(control, patch, u, v)
        for row, corner in ((first + k, n), (first + n, k), (first + 3, k)):
            rows[row, 3 * corner], rows[row, 3 * corner + 1], rows[row, 3 * corner + 2] = x, y, z
            rows[row, 9 + 2 * corner], rows[row, 10 + 2 * corner] = u, v
        for c in (3 * k, 3 * k + 1, 3 * k + 2, 9 + 2 * k, 10 + 2 * k):
            rows[first + k, c] = rows[source, c]


@kernel(f"void({_MANY}, int64, int64)", counts=False)
def copy_row(rows, source, target):
    """Copy a row onto another."""
    for c in range(rows.shape[1]):
        rows[target, c] = rows[source, c]
