"""Compiled exact Euclidean distances of pixels, told only as the number of thresholds that each one reaches.

Two passes: down and up every column, then along every row the lower envelope of parabolas. Squares of distances are whole
numbers, so every comparison is exact.
"""

from __future__ import annotations

import math

import numpy as np

from app.jit import kernel

EXACT = 1e-6
"""More than the rounding of a product below 2^31 and less than half of 1 / 2^16, by which quotients miss whole numbers."""


@kernel("void(uint8[:, ::1], uint16[:, ::1], int64, int64)")
def columns(inner, height, first, stop):
    """Write how far each pixel's column is free up or down, in columns first ... stop - 1; 0 where it is not free itself.

    Args:
        inner: (r, c) 1 = free; beyond the picture nothing is free.
        height: (r, c), r < 65535.
    """
    rows = inner.shape[0]
    for c in range(first, stop):
        height[0, c] = inner[0, c]
    for r in range(1, rows):
        for c in range(first, stop):
            height[r, c] = np.uint16((height[r - 1, c] + 1) * inner[r, c])
    for c in range(first, stop):
        height[rows - 1, c] = min(height[rows - 1, c], np.uint16(1))
    for r in range(rows - 2, -1, -1):
        for c in range(first, stop):
            height[r, c] = min(height[r, c], height[r + 1, c] + np.uint16(1))


@kernel("int64(uint16[::1], int64, int64, int64[:, ::1], float64[::1])")
def _envelope(height, first, stop, nearest, halves):
    """Find which columns of a free run are nearest to which of its pixels; return how many columns that are.

    The run's free pixels are first ... stop - 1; the pixels beside it, which are not free, belong to it, as nothing beyond
    them can be nearer.

    Args:
        nearest: (3, m) gets the columns, rising, the squares of their heights, and the first pixel that each is nearest to.
        halves: (m,) 1 / (2 n): quotients are whole numbers of 30 bits over at most 2^16, so that the nearest whole number
            below is told from the product, as long as EXACT is added.
    """
    place, squares, begins = nearest[0], nearest[1], nearest[2]
    place[0], squares[0], begins[0] = first - 1, 0, first
    top = 0
    for c in range(first, stop + 1):
        square = np.int64(height[c]) * np.int64(height[c]) if c < stop else 0
        at = first
        while top >= 0:
            # c is nearer than p from the first whole x on with (x - c)^2 + square < (x - p)^2 + its square
            p = place[top]
            at = math.floor((c * c + square - p * p - squares[top]) * halves[c - p] + EXACT) + 1
            if at > begins[top]:
                break
            top -= 1
            at = first
        if at < stop:
            top += 1
            place[top], squares[top], begins[top] = c, square, at
    return top + 1


@kernel("void(uint16[::1], int64, int64, int64[::1], int64[:, ::1], float64[::1])")
def _count(row, first, stop, thresholds, nearest, halves):
    """Put in place of the heights of a free run how many thresholds its pixels' distances reach."""
    found = _envelope(row, first, stop, nearest, halves)
    count = 0
    for k in range(found):
        p, square = nearest[0, k], nearest[1, k]
        end = nearest[2, k + 1] if k + 1 < found else stop
        for x in range(nearest[2, k], end):
            d = (x - p) * (x - p) + square
            while d >= thresholds[count]:
                count += 1
            while count > 0 and d < thresholds[count - 1]:
                count -= 1
            row[x] = count


@kernel("void(uint16[:, ::1], int64[::1], int64, int64)")
def reached(height, thresholds, first, stop):
    """Put in place of the columns' heights, in rows first ... stop - 1, how many thresholds each pixel's distance reaches.

    Args:
        height: (r, c) as `columns` writes it.
        thresholds: (n,) squares of distances from the nearest pixel that is not free, rising; the last is never reached.

    References:
        P. Felzenszwalb and D. Huttenlocher, Distance transforms of sampled functions, 2012; here in whole numbers.
    """
    cols = height.shape[1]
    nearest, halves = np.empty((3, cols + 2), np.int64), 0.5 / np.maximum(np.arange(cols + 2.0), 1.0)
    for r in range(first, stop):
        row = height[r]
        a = 0
        while a < cols:
            if row[a] == 0:
                a += 1
                continue
            b = a + 1
            while b < cols and row[b] != 0:
                b += 1
            _count(row, a, b, thresholds, nearest, halves)
            a = b
