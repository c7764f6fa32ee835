# mypy: allow-untyped-defs
"""Compiled: two arcs that meet smoothly, by least squares of the distances of points (Levenberg and Marquardt)."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_ROUNDS = 60
"""Steps at most, helpful or not."""
_STILL = 1e-13
"""Facets: a step so small is none."""
_FLAT = 1e-300
"""Below all that is meant: it keeps a root and a division defined where a number is 0."""


@kernel("void(float64[:, ::1], int64, float64[::1], float64[::1], float64[:, ::1])", counts=False)
def _distances(flat, count, guess, off, slope):
    """Write how far points are to the left of the arcs of a guess, and by how much more with each of its numbers.

    Of an arc of curvature k that leaves 0, 0 along X a point x, y is (2 y - k (x² + y²)) / (1 + w) to the left, where
    w = sqrt(1 - 2 k y + k² (x² + y²)); that needs no middle, so that a line is an arc, too.
    """
    c, s = math.cos(guess[2]), math.sin(guess[2])
    for i in range(len(flat)):
        side = 3 if i < count else 4
        bent = guess[side]
        u, v = flat[i, 0] - guess[0], flat[i, 1] - guess[1]
        x, y = c * u + s * v, c * v - s * u
        square = x * x + y * y
        spoke = math.sqrt(max(1.0 - 2.0 * bent * y + bent * bent * square, _FLAT))
        off[i] = (2.0 * y - bent * square) / (1.0 + spoke)
        # The unit normal of the circle round the same centre through the point: by it, what moves the frame counts.
        along, left = -bent * x / spoke, (1.0 - bent * y) / spoke
        slope[i, 0] = -(c * along - s * left)
        slope[i, 1] = -(s * along + c * left)
        slope[i, 2] = along * y - left * x
        slope[i, 3], slope[i, 4] = 0.0, 0.0
        slope[i, side] = (-square - off[i] * (bent * square - y) / spoke) / (1.0 + spoke)


@kernel("void(float64[::1], float64[:, ::1], float64, float64[:, ::1], float64[::1])", counts=False)
def _step(off, slope, damping, normal, step):
    """Write the step that makes the squared distances least if they go on as they do here, damped; the matrix of the
    normal equations is positive then, and needs no choice of rows.
    """
    size = len(step)
    for k in range(size):
        step[k] = 0.0
        for m in range(size):
            normal[k, m] = 0.0
            for i in range(len(off)):
                normal[k, m] += slope[i, k] * slope[i, m]
        for i in range(len(off)):
            step[k] -= slope[i, k] * off[i]
        # Marquardt: each number is damped by its own measure, so that mm and 1 / mm are treated alike.
        normal[k, k] = normal[k, k] * (1.0 + damping) + _FLAT
    for k in range(size):
        for row in range(k + 1, size):
            share = normal[row, k] / normal[k, k]
            step[row] -= share * step[k]
            for m in range(k, size):
                normal[row, m] -= share * normal[k, m]
    for k in range(size - 1, -1, -1):
        for m in range(k + 1, size):
            step[k] -= normal[k, m] * step[m]
        step[k] /= normal[k, k]


@kernel("float64(float64[:, ::1], int64, float64[::1])")
def two_arcs(flat, count, joint):
    """Improve a joint (x, y, angle, curvature before it, behind it) of arcs by points (n, 2), the first `count` of
    which lie before it; return how far they are from the arcs at most.
    """
    off, slope = np.empty(len(flat)), np.empty((len(flat), 5))
    normal, step, trial = np.empty((5, 5)), np.empty(5), np.empty(5)
    _distances(flat, count, joint, off, slope)
    least, damping = (off * off).sum(), 1e-3
    for _ in range(_ROUNDS):
        _step(off, slope, damping, normal, step)
        trial[:] = joint + step
        _distances(flat, count, trial, off, slope)
        squares = (off * off).sum()
        if squares < least:
            # A step that helps is taken and the next one is bolder; one that does not is tried shorter and steeper.
            joint[:], least, damping = trial, squares, damping * 0.1
        else:
            _distances(flat, count, joint, off, slope)
            damping *= 10.0
        if np.abs(step).max() < _STILL:
            break
    _distances(flat, count, joint, off, slope)
    return np.abs(off).max()
