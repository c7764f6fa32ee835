"""Compiled inner loops of the exact offset: pieces of a level to rings, and what these measure."""

from __future__ import annotations

import math

import numpy as np

from app.geometry.kernels import nearest
from app.jit import kernel


@kernel("void(float64[:, ::1], int64[::1], float64, int64[::1])")
def follow(rows, by_x, tolerance, following):
    """Write for each row the row that starts nearest to its end, each used once; -1 where none is within tolerance.

    by_x: rows in order of their start's x. Nearest pairs are matched first.
    """
    m = len(rows)
    xs = rows[by_x, 0]
    taken = np.zeros(m, np.bool_)
    following[:] = -1
    reach = 1e-9
    while reach < 1e3 * tolerance:  # nearest pairs first: ever wider circles
        radius = min(reach, tolerance)
        for i in range(m):
            if following[i] >= 0:
                continue
            best, chosen = radius, -1
            k = np.searchsorted(xs, rows[i, 2] - radius)
            while k < m and xs[k] <= rows[i, 2] + radius:
                j = by_x[k]
                d = math.hypot(rows[j, 0] - rows[i, 2], rows[j, 1] - rows[i, 3])
                if not taken[j] and d <= best:
                    best, chosen = d, j
                k += 1
            if chosen >= 0:
                following[i], taken[chosen] = chosen, True
        if radius == tolerance:
            return
        reach *= 10.0


@kernel("int64(float64[:, ::1], int64[::1], float64[:, ::1], int64[::1], int64[::1])")
def assemble(rows, following, out, order, starts):
    """Write the rows ring after ring, each beginning exactly where the one before ends; return how many rings there are.

    Args:
        following: (m,) row that comes after each row; a permutation.
        out: (m, 8) the rows in the order of rings. order: (m,) where each of them came from.
        starts: (m + 1,) first row of each ring, and the end of the last one.
    """
    for i in range(len(rows)):
        j = following[i]
        x, y = (rows[i, 2] + rows[j, 0]) / 2, (rows[i, 3] + rows[j, 1]) / 2
        rows[i, 2], rows[i, 3], rows[j, 0], rows[j, 1] = x, y, x, y
    seen = np.zeros(len(rows), np.bool_)
    count = rings = 0
    for first in range(len(rows)):
        if seen[first]:
            continue
        starts[rings] = count
        rings += 1
        at = first
        while not seen[at]:
            seen[at] = True
            out[count], order[count] = rows[at], at
            count += 1
            at = following[at]
    starts[rings] = count
    return rings


@kernel("float64(float64[:, ::1], int64)")
def _sweep(rows, i):
    """Return the signed sweep of row i, in (-2 pi, 2 pi)."""
    if rows[i, 7] == 0.0:
        return 0.0
    a = math.atan2(rows[i, 1] - rows[i, 5], rows[i, 0] - rows[i, 4])
    b = math.atan2(rows[i, 3] - rows[i, 5], rows[i, 2] - rows[i, 4])
    return ((b - a) * rows[i, 7]) % (2 * math.pi) * rows[i, 7]


@kernel("void(float64[:, ::1], int64[::1], int64, float64[:, ::1])")
def sums(rows, starts, rings, out):
    """Write (signed area, length) of each ring (rings, 2): Green's theorem, exact for arcs."""
    for k in range(rings):
        area = length = 0.0
        x, y = rows[starts[k], 0], rows[starts[k], 1]
        for i in range(starts[k], starts[k + 1]):
            sweep = _sweep(rows, i)
            area += ((rows[i, 0] - x) * (rows[i, 3] - y) - (rows[i, 2] - x) * (rows[i, 1] - y)) / 2
            area += rows[i, 6] * rows[i, 6] * (sweep - math.sin(sweep)) / 2
            length += math.hypot(rows[i, 2] - rows[i, 0], rows[i, 3] - rows[i, 1]) if rows[i, 7] == 0.0 else rows[i, 6] * abs(sweep)
        out[k, 0], out[k, 1] = area, length


@kernel("float64(float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64, float64)")
def worst_error(rows, drawing, order, nodes, distance, limit):
    """Return the largest |measured - distance| over all joints and middles of rows, mm; stops at the first above `limit`.

    Args:
        drawing, order, nodes: all rows of the drawing and their tree.
    """
    worst = 0.0
    for i in range(len(rows)):
        x, y = (rows[i, 0] + rows[i, 2]) / 2, (rows[i, 1] + rows[i, 3]) / 2
        if rows[i, 7] != 0.0:
            angle = math.atan2(rows[i, 1] - rows[i, 5], rows[i, 0] - rows[i, 4]) + _sweep(rows, i) / 2
            x, y = rows[i, 4] + rows[i, 6] * math.cos(angle), rows[i, 5] + rows[i, 6] * math.sin(angle)
        middle = nearest(drawing, order, nodes, x, y, distance + 2 * limit)[0]
        joint = nearest(drawing, order, nodes, rows[i, 0], rows[i, 1], distance + 2 * limit)[0]
        worst = max(worst, abs(middle - distance), abs(joint - distance))
        if worst > limit:
            break
    return worst
