# mypy: allow-untyped-defs
"""Compiled loops that tell which pixels lie wholly inside a drawing, in image coordinates (see `kernels`)."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from .kernels import _centre_lines, _other, _quadrant_ends

CORNER = 1e-9
"""Pixels; a contour that passes a pixel's corner nearer than this goes from this pixel to the one across."""


@kernel("UniTuple(int64, 2)(float64, float64, int64)")
def _grid_lines(a, b, count):
    """Return the range [first, stop) of grid lines i with min < i < max that have pixels of the picture on a side."""
    first = math.floor(max(min(a, b), -1.0)) + 1
    stop = math.ceil(min(max(a, b), count + 1.0))
    return int(first), max(int(first), int(stop))


@kernel("void(uint8[:, ::1], float64, float64)")
def _mark(touched, u, v):
    if 0.0 <= u < touched.shape[1] and 0.0 <= v < touched.shape[0]:
        touched[int(v), int(u)] = 1


@kernel("void(uint8[:, ::1], int64, float64)")
def _flip(flips, row, u):
    """Note a crossing of a row's centre line: every pixel whose centre lies right of it changes sides."""
    # pixel i has its centre at i + 0.5, so the first one right of u is the least i >= u - 0.5
    first = math.ceil(min(max(u, 0.0), flips.shape[1] + 1.0) - 0.5)
    if first < flips.shape[1]:
        flips[row, int(first)] ^= 1


@kernel("float64(float64[::1], float64[::1], float64[::1], float64)")
def _u_at(circle, a, b, v):
    """Return u where the monotone piece from a to b, of a circle (cu, cv, r) or straight for r = 0, has this v."""
    if circle[2] == 0.0:
        u = a[0] + (v - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        return min(max(u, min(a[0], b[0])), max(a[0], b[0]))
    return _other(v - circle[1], circle[2], circle[0], a[0], b[0])


@kernel("float64(float64[::1], float64[::1], float64[::1], float64)")
def _v_at(circle, a, b, u):
    """Return v where the piece has this u; see `_u_at`."""
    if circle[2] == 0.0:
        v = a[1] + (u - a[0]) / (b[0] - a[0]) * (b[1] - a[1])
        return min(max(v, min(a[1], b[1])), max(a[1], b[1]))
    return _other(u - circle[0], circle[2], circle[1], a[1], b[1])


@kernel("boolean(float64[::1], float64[::1])")
def _on_grid(a, b):
    """Tell whether a straight piece runs along a grid line: it then lies between pixels, in none of them."""
    return (a[0] == b[0] and a[0] == math.floor(a[0])) or (a[1] == b[1] and a[1] == math.floor(a[1]))


@kernel("void(uint8[:, ::1], uint8[:, ::1], float64[::1], float64[::1], float64[::1])")
def _cover_piece(touched, flips, circle, a, b):
    first, stop = _centre_lines(a[1], b[1], touched.shape[0])
    for j in range(first, stop):
        _flip(flips, j, _u_at(circle, a, b, j + 0.5))
    if circle[2] == 0.0 and _on_grid(a, b):
        return
    first, stop = _grid_lines(a[1], b[1], touched.shape[0])
    crossings = stop - first
    # through a corner the piece goes from one pixel to the one across, by the sense in which it rises
    lean = math.copysign(CORNER, (b[0] - a[0]) * (b[1] - a[1]))
    for j in range(first, stop):
        u = _u_at(circle, a, b, float(j))
        _mark(touched, u - lean, j - 0.5)
        _mark(touched, u + lean, j + 0.5)
    first, stop = _grid_lines(a[0], b[0], touched.shape[1])
    for i in range(first, stop):
        v = _v_at(circle, a, b, float(i))
        _mark(touched, i - 0.5, v - lean)
        _mark(touched, i + 0.5, v + lean)
    # a piece that crosses no grid line lies within one pixel
    if crossings + stop - first == 0:
        _mark(touched, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2)


@kernel("void(float64[:, ::1], uint8[:, ::1], uint8[:, ::1])")
def cover(rows, touched, flips):
    """Mark every pixel whose open square closed contours pass, and note on which sides of them pixel centres lie.

    Args:
        rows: (n, 8) lines and arcs in image coordinates; coordinates that are meant to be whole must be whole.
        touched: (r, c) zeros; gets 1. Lines along the grid's own lines touch no pixel.
        flips: (r, c) zeros; even-odd along a row: a centre is inside by the parity of flips[row, : column + 1].
    """
    ends, straight = np.empty((6, 2)), np.zeros(3)
    for n in range(len(rows)):
        row = rows[n]
        if row[7] == 0.0:
            _cover_piece(touched, flips, straight, row[0:2], row[2:4])
            continue
        count = _quadrant_ends(row, ends)
        for k in range(1, count):
            _cover_piece(touched, flips, row[4:7], ends[k - 1], ends[k])


@kernel("void(float64[:, ::1], uint8[:, ::1])")
def close_seams(rows, free):
    """Take out of `free` one of two pixels that only a line along the grid parts."""
    for n in range(len(rows)):
        a, b = rows[n, 0:2], rows[n, 2:4]
        if rows[n, 7] != 0.0 or not _on_grid(a, b):
            continue
        if a[0] == b[0] and 0 < a[0] < free.shape[1]:
            i = int(a[0])
            for j in range(
                int(max(math.floor(min(a[1], b[1])), 0)), int(min(math.ceil(max(a[1], b[1])), free.shape[0]))
            ):
                # of two free pixels the right one goes; of those above one another, the lower one
                if free[j, i - 1] == 1:
                    free[j, i] = 0
        elif a[1] == b[1] and 0 < a[1] < free.shape[0]:
            j = int(a[1])
            for i in range(
                int(max(math.floor(min(a[0], b[0])), 0)), int(min(math.ceil(max(a[0], b[0])), free.shape[1]))
            ):
                if free[j - 1, i] == 1:
                    free[j, i] = 0
