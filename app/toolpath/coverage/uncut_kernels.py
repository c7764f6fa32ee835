# mypy: allow-untyped-defs
"""Compiled inner loops for how far points are from what paths sweep, whose cutters differ in radius."""

from __future__ import annotations

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import LEAF, box_distance, point_distance


@kernel("float64[::1](float64[::1], int64[::1], int64)")
def widest(radii, order, count):
    """Return the largest radius (count,) of a cutter within each node of a tree over rows with radii (n,)."""
    leaves = (count + 1) // 2
    wide = np.zeros(count)
    for place in range(len(order)):
        k = leaves - 1 + place // LEAF
        wide[k] = max(wide[k], radii[order[place]])
    for k in range(leaves - 2, -1, -1):
        wide[k] = max(wide[2 * k + 1], wide[2 * k + 2])
    return wide


@kernel(
    "float64(float64[:, ::1], float64[::1], int64[::1], float64[:, ::1], float64[::1], float64, float64, "
    "UniTuple(float64, 2))"
)
def beyond(rows, radii, order, nodes, wide, x, y, limits):
    """Return how far a point is from what cutters sweep along rows, mm: negative = that deep within.

    Args:
        limits: at or below the first it may stop, and beyond the second it is not looked for: that is returned.
    """
    leaves = (len(nodes) + 1) // 2
    enough, best = limits
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0 and best > enough:
        top -= 1
        k = stack[top]
        # no cutter within the node reaches farther than the widest of them
        if box_distance(nodes, k, x, y) - wide[k] >= best:
            continue
        if k < leaves - 1:
            # the nearer child first: it closes the farther one sooner
            left, right = 2 * k + 1, 2 * k + 2
            if box_distance(nodes, left, x, y) - wide[left] > box_distance(nodes, right, x, y) - wide[right]:
                left, right = right, left
            stack[top], stack[top + 1] = right, left
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            best = min(best, point_distance(rows, order[place], x, y) - radii[order[place]])
    return best
