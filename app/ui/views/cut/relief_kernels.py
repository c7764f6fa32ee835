"""Compiled loop that turns heights into normals for the light."""

from __future__ import annotations

from math import sqrt

import numpy as np

from ....core.jit import kernel

ONE, HALF, MIDDLE, SPREAD = np.float32(1.0), np.float32(0.5), np.float32(128.5), np.float32(127.0)
ZERO, LEAST = np.float32(0.0), np.float32(1e-6)


@kernel("void(float32[:, ::1], float32[:, ::1], float32[::1], uint8[::1], float32, float32, uint32[::1])")
def _relief_row(slopes, smooth, steep, light, gain, limit, out):
    """Write one row; slopes are (right - left) and (up - down), at walls in the direction of the smoothed heights'."""
    left, right, down, up = slopes[0], slopes[1], slopes[2], slopes[3]
    left_s, right_s, down_s, up_s = smooth[0], smooth[1], smooth[2], smooth[3]
    for j in range(len(out)):
        gx, gy = right[j] - left[j], up[j] - down[j]
        sx, sy = right_s[j] - left_s[j], up_s[j] - down_s[j]
        wall = steep[j] > ZERO
        along = steep[j] / max(sqrt(sx * sx + sy * sy), LEAST)
        gx = sx * along if wall else gx
        gy = sy * along if wall else gy
        square = gx * gx + gy * gy
        k = ONE + (gain - ONE) / (ONE + square / (limit * limit))
        k = k / sqrt(ONE + k * k * square)
        x, y = k * gx, k * gy
        rx, ry = SPREAD * sqrt(abs(x)), SPREAD * sqrt(abs(y))
        # 128 + 127 sign sqrt: most of the 256 steps for the small slopes of cusps
        a = np.uint32(np.int32(MIDDLE - rx if x > 0 else MIDDLE + rx))
        b = np.uint32(np.int32(MIDDLE - ry if y > 0 else MIDDLE + ry))
        out[j] = a | (b << np.uint32(8)) | (np.uint32(light[j]) << np.uint32(16)) | np.uint32(0xFF000000)


@kernel("void(float32[:, ::1], int64, float32, float32[:, ::1])")
def _slopes(heights, i, pitch, out):
    """Write what the slopes of a row are differences of: left, right, down, up, each (m,)."""
    n, m = heights.shape
    below, above = max(i - 1, 0), min(i + 1, n - 1)
    half, rise = HALF / pitch, ONE / (np.float32(max(above - below, 1)) * pitch)
    row = heights[i]
    out[0, 1:], out[1, :-1] = row[:-1] * half, row[1:] * half
    out[0, 0] = row[0] * half
    out[1, m - 1] = row[m - 1] * half
    if m > 1:
        out[0, 0], out[1, m - 1] = (row[0] + row[0] - row[1]) * half, (row[m - 1] + row[m - 1] - row[m - 2]) * half
    out[2], out[3] = heights[below] * rise, heights[above] * rise


@kernel(
    "void(float32[:, ::1], float32[:, ::1], float32[:, ::1], uint8[:, ::1], float32, float32, float32, uint32[:, ::1])"
)
def relief_map(heights, smooth, steep, light, pitch, gain, limit, out):
    """Write the relief of heights.

    A slope g is made 1 + (gain - 1) / (1 + g^2 / limit^2) times as steep, so that cusps show and walls stay as they
    are. The normal's x and y are written as 128 + 127 sign sqrt: fine where the metal is nearly flat.

    Args:
        heights, smooth: (n, m) mm, as they are and smoothed. steep: (n, m) slope at walls, where smooth tells its
            direction, else 0.
        light: (n, m) share of the light that reaches a cell, 255 = all.
        pitch: mm. gain, limit: see above. out: (n, m) x, y, light, 255, from the lowest byte up.
    """
    n, m = heights.shape
    raw, soft = np.empty((4, m), np.float32), np.empty((4, m), np.float32)
    for i in range(n):
        _slopes(heights, i, pitch, raw)
        _slopes(smooth, i, pitch, soft)
        _relief_row(raw, soft, steep[i], light[i], gain, limit, out[i])
