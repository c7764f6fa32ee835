# mypy: allow-untyped-defs
"""Compiled: which points lie near which rows."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel
from ..kernels import DEPTH, LEAF, point_distance


@kernel("int64[:, ::1](float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64)")
def near_points(rows, order, nodes, points, reach):
    """Return (row, point) (m, 2) of all rows within `reach` of points (k, 2), by point."""
    leaves, count = (len(nodes) + 1) // 2, 0
    found = np.empty((4 * len(points) + 64, 2), np.int64)
    stack = np.empty(DEPTH, np.int64)
    for p in range(len(points)):
        x, y = points[p, 0], points[p, 1]
        stack[0], top = 0, 1
        while top > 0:
            top -= 1
            k = stack[top]
            if nodes[k, 0] - reach > x or nodes[k, 2] + reach < x or nodes[k, 1] - reach > y or nodes[k, 3] + reach < y:
                continue
            if k < leaves - 1:
                stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                if point_distance(rows, order[place], x, y) > reach:
                    continue
                if count == len(found):
                    more = np.empty((2 * count, 2), np.int64)
                    for j in range(count):  # not slice by slice: see `enlarged`
                        more[j, 0], more[j, 1] = found[j, 0], found[j, 1]
                    found = more
                found[count, 0], found[count, 1] = order[place], p
                count += 1
    return found[:count].copy()
