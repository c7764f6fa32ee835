# mypy: allow-untyped-defs
"""Compiled exact Euclidean distances of pixels, told only as the number of thresholds that each one reaches.

How far every column is free up and down, then along every row the lower envelope of parabolas. Squares of distances are
whole numbers, so every comparison is exact. The picture is gone through in bands of rows whose heights stay in the
processor's cache: what bands know of one another is the free pixels that lie above and below each.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from .row_kernels import end_of_run, first_zero

EXACT = 1e-6
"""More than the rounding of a product below 2^31 and less than half of 1 / 2^16, by which quotients miss whole
numbers.
"""

BAND = 32
"""Rows of a band."""


@kernel("void(uint8[:, ::1], boolean, uint16[:, ::1])")
def beside_bands(inner, downwards, free):
    """Write how many free pixels follow one another right above every band in each column, or right below it.

    Args:
        inner: (r, c) 1 = free, r < 65535; beyond the picture nothing is free.
        downwards: count from the top down, for the pixels above.
        free: (bands, c) gets the numbers.
    """
    rows, running = inner.shape[0], np.zeros(inner.shape[1], np.uint16)
    for k in range(rows):
        r = k if downwards else rows - 1 - k
        if k == 0 or (r % BAND == 0 if downwards else (r + 1) % BAND == 0):
            free[r // BAND] = running
        row = inner[r]
        for c in range(len(row)):
            running[c] = np.uint16((running[c] + 1) * row[c])


@kernel("int64(uint16[::1], int64, int64, int64[:, ::1], float64[::1])", counts=False)
def _envelope(height, first, stop, nearest, halves):
    """Find which columns of a free run are nearest to which of its pixels; return how many columns that are.

    The run's free pixels are first ... stop - 1; the pixels beside it, which are not free, belong to it, as nothing
    beyond them can be nearer.

    Args:
        nearest: (3, m) gets the columns c, rising, c^2 + height^2, and the first pixel that each is nearest to, then
            `stop`.
        halves: (m,) 1 / (2 n): quotients are whole numbers of 30 bits over at most 2^16, so that the nearest whole
            number below is told from the product, as long as EXACT is added.
    """
    place, key, begins = nearest[0], nearest[1], nearest[2]
    place[0], key[0], begins[0] = first - 1, (first - 1) * (first - 1), first
    top = 0
    for c in range(first, stop + 1):
        own = c * c + (np.int64(height[c]) * np.int64(height[c]) if c < stop else 0)
        # c is nearer than p where 2 x (c - p) > own - key of p
        while top >= 0 and own - key[top] < 2 * begins[top] * (c - place[top]):
            top -= 1
        # the first whole x at which c wins: x > (own - key of p) / (2 (c - p))
        at = math.floor((own - key[top]) * halves[c - place[top]] + EXACT) + 1 if top >= 0 else first
        if at < stop:
            top += 1
            place[top], key[top], begins[top] = c, own, at
    begins[top + 1] = stop
    return top + 1


@kernel("void(uint16[::1], int64, int64[:, ::1], int64[::1])", counts=False)
def _count(index, found, nearest, thresholds):
    """Write how many thresholds the distances of a free run's pixels reach, given what `_envelope` has found."""
    done, count = nearest[2, 0], 0
    for k in range(found):
        p, key, first, stop = nearest[0, k], nearest[1, k], nearest[2, k], nearest[2, k + 1]
        a, b = key + first * (first - 2 * p), key + (stop - 1) * (stop - 1 - 2 * p)
        deepest = (stop - first) * (stop - first) >> 2  # the parabola between its ends is lower than both by no more
        if min(a, b) - deepest >= thresholds[count] and max(a, b) < thresholds[count + 1]:
            continue
        for x in range(first, stop):
            d, now = key + x * (x - 2 * p), count
            while d >= thresholds[now + 1]:
                now += 1
            while d < thresholds[now]:
                now -= 1
            if now != count:
                index[done:x] = count
                done, count = x, now
    index[done : nearest[2, found]] = count


@kernel("void(uint8[::1], uint16[::1], uint16[::1])", counts=False)
def _from_above(inner, above, height):
    """Write how far each pixel's column is free upwards, given that of the row above."""
    for c in range(len(inner)):
        height[c] = np.uint16((above[c] + 1) * inner[c])


@kernel("void(uint16[::1], uint16[::1])", counts=False)
def _from_below(below, height):
    """Lower the heights of a row to one more than those of the row below."""
    for c in range(len(below)):
        height[c] = min(height[c], np.uint16(below[c] + 1))


@kernel("void(uint8[:, ::1], uint16[:, :, ::1], int64[::1], uint16[:, ::1], UniTuple(int64, 2))")
def reached(inner, beside, thresholds, index, bands):
    """Write how many thresholds each pixel's distance from the nearest pixel that is not free reaches.

    Args:
        inner: (r, c) 1 = free; beyond the picture nothing is free.
        beside: (2, bands, c) free pixels above and below every band, as `beside_bands` writes them.
        thresholds: (n,) 0, squares of distances, rising, and a last one that is never reached.
        index: (r, c) zeros; gets the numbers.
        bands: the first band to do and the first not to do.

    References:
        P. Felzenszwalb and D. Huttenlocher, Distance transforms of sampled functions, 2012; here in whole numbers.
    """
    rows, cols = inner.shape
    nearest, halves = np.empty((3, cols + 3), np.int64), 0.5 / np.maximum(np.arange(cols + 2.0), 1.0)
    height = np.empty((BAND, cols), np.uint16)
    for band in range(bands[0], bands[1]):
        top, count = band * BAND, min(BAND, rows - band * BAND)
        for k in range(count):
            _from_above(inner[top + k], height[k - 1] if k > 0 else beside[0, band], height[k])
        for k in range(count - 1, -1, -1):
            _from_below(height[k + 1] if k + 1 < count else beside[1, band], height[k])
            c = end_of_run(height[k], 0, 0)
            while c < cols:
                stop = first_zero(height[k], c)
                _count(index[top + k], _envelope(height[k], c, stop, nearest, halves), nearest, thresholds)
                c = end_of_run(height[k], stop, 0)
