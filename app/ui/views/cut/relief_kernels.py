# mypy: allow-untyped-defs
"""Compiled loop that turns heights into normals for the light, and finds where between cells a wall stands."""

from __future__ import annotations

from math import exp, log, sqrt

import numpy as np

from ....core.jit import kernel

ONE, HALF, MIDDLE, SPREAD = np.float32(1.0), np.float32(0.5), np.float32(128.5), np.float32(127.0)
ZERO = np.float32(0.0)
ALPHA = np.uint64(0xFF000000)
SIDE_GAIN = 60.0
"""Steps of a byte in a distance of one cell."""

PROBIT, PROBIT_CUBIC = 0.6267, -0.0105
"""The normal distribution's quantile by the logarithm of p / (1 - p), within 0.001 for p from 0.2 to 0.8."""


@kernel("uint64(float32[:, ::1], int64, int64, float32, float32[:, ::1], float64)")
def _wall(heights, i, j, level, weights, width):
    """Return the wall that a cell stands beside: distance and direction as `relief_map` writes them.

    Of the cells round it, weighed by a bell, so large a share stands above the level as lies beyond a straight wall;
    the wall faces away from their centroid.
    """
    n, m = heights.shape
    r = weights.shape[0] // 2
    above, across, along = 0.0, 0.0, 0.0
    for k in range(-r, r + 1):
        row = heights[min(max(i + k, 0), n - 1)]
        for c in range(-r, r + 1):
            if row[min(max(j + c, 0), m - 1)] > level:
                weight = weights[k + r, c + r]
                above += weight
                across -= weight * c
                along -= weight * k
    # the quantile has no end at 0 and 1: beyond 2 % the wall is as good as out of sight
    above = min(max(above, 0.02), 0.98)
    odds = log((1.0 - above) / above)
    far = SIDE_GAIN * width * odds * (PROBIT + PROBIT_CUBIC * odds * odds)
    side = min(max(128.0 + far, 1.0), 127.0) if heights[i, j] > level else min(max(128.5 + far, 129.0), 255.0)
    size = max(sqrt(across * across + along * along), 1e-12)
    x, y = np.uint64(128.5 + 127.0 * across / size), np.uint64(128.5 + 127.0 * along / size)
    return np.uint64(side) | (x << np.uint64(8)) | (y << np.uint64(16))


@kernel("float32(float32, float32)")
def _milder(one, other):
    """Return the slope that is less steep: the one that does not reach over a wall."""
    return one if abs(one) < abs(other) else other


@kernel("float32(float32[:, :, ::1], float32[::1], float64, float64, float32)")
def _shade(around, gains, row, column, z):
    """Return how much higher the metal round a height is, for its distance, summed over the neighbourhoods.

    Args:
        around: (k, rows, columns) mean heights of k neighbourhoods, mm. gains: (k,) per mm.
        row, column: the place among them. z: mm.
    """
    i = min(max(int(np.floor(row)), 0), around.shape[1] - 2)
    j = min(max(int(np.floor(column)), 0), around.shape[2] - 2)
    v, u = np.float32(row - i), np.float32(column - j)
    shade = ZERO
    for k in range(around.shape[0]):
        low = (ONE - u) * around[k, i, j] + u * around[k, i, j + 1]
        high = (ONE - u) * around[k, i + 1, j] + u * around[k, i + 1, j + 1]
        shade += min(max((((ONE - v) * low + v * high) - z) * gains[k], ZERO), HALF)
    return shade


@kernel(
    "void(float32[:, ::1], float32[:, ::1], float32[:, ::1], float32[:, :, ::1], float32[::1], float64[::1], "
    "float32[:, ::1], float32[::1], uint64[:, ::1])"
)
def relief_map(heights, lowest, highest, around, gains, frame, weights, shape, out):
    """Write the relief of heights.

    A slope g is made 1 + (gain - 1) / (1 + g^2 / limit^2) times as steep, so that cusps show and walls stay as they
    are. The normal's x and y are written as 128 + 127 sign sqrt: fine where the metal is nearly flat.

    Args:
        heights: (n, m) mm. lowest, highest: (n, m) beside walls, of the cells next to each; alike elsewhere.
        around, gains: see `_shade`. frame: first row and first column of these cells, in cells of the whole; cells
            across a place in `around`.
        weights: (2 r + 1, 2 r + 1) a bell whose sum is 1.
        shape: pitch, mm; gain, limit, see above; width of the bell, cells; share that the darkest corner lacks.
        out: (n, m) x, y, light (255 = all), 255, and of walls distance, x, y, 0, from the lowest byte up. The distance
            is 128 + 60 d, d in cells, greater than 128 at a wall's foot, less on top of it, and 0 for cells beside
            none; the direction that it faces is 128 + 127 times a unit vector.
    """
    n, m = heights.shape
    pitch, gain, limit, width = shape[0], shape[1], shape[2], shape[3]
    for i in range(n):
        below, above = max(i - 1, 0), min(i + 1, n - 1)
        rise = ONE / (np.float32(max(above - below, 1)) * pitch)
        for j in range(m):
            left, right = max(j - 1, 0), min(j + 1, m - 1)
            z = heights[i, j]
            wall = np.uint64(0)
            if highest[i, j] > lowest[i, j]:
                gx = _milder((z - heights[i, left]) / pitch, (heights[i, right] - z) / pitch)
                gy = _milder((z - heights[below, j]) / pitch, (heights[above, j] - z) / pitch)
                level = HALF * (highest[i, j] + lowest[i, j])
                wall = _wall(heights, i, j, level, weights, width)
            else:
                gx = (heights[i, right] - heights[i, left]) / (np.float32(max(right - left, 1)) * pitch)
                gy = (heights[above, j] - heights[below, j]) * rise
            row, column = (frame[0] + i + 0.5) / frame[2] - 0.5, (frame[1] + j + 0.5) / frame[2] - 0.5
            shade = _shade(around, gains, row, column, z)
            light = np.uint64(255.5 - 255.0 * shape[4] * (1.0 - exp(-1.3 * shade)))
            square = gx * gx + gy * gy
            k = ONE + (gain - ONE) / (ONE + square / (limit * limit))
            # x and y of the unit normal of a surface that is k times as steep
            k = k / sqrt(ONE + k * k * square)
            x, y = k * gx, k * gy
            rx, ry = SPREAD * sqrt(abs(x)), SPREAD * sqrt(abs(y))
            # 128 + 127 sign sqrt: most of the 256 steps for the small slopes of cusps
            a = np.uint64(np.int32(MIDDLE - rx if x > 0 else MIDDLE + rx))
            b = np.uint64(np.int32(MIDDLE - ry if y > 0 else MIDDLE + ry))
            out[i, j] = a | (b << np.uint64(8)) | (light << np.uint64(16)) | ALPHA | (wall << np.uint64(32))
