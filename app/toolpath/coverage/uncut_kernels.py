"""Compiled inner loops for what paths leave: squares of a quad tree, each decided by exact distances from its
centre.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import INF, LEAF, box_distance, crossings, enlarged, nearest, point_distance

OUTSIDE, INSIDE, UNKNOWN = 0.0, 1.0, 2.0


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
        if box_distance(nodes, k, x, y) - wide[k] >= best:
            continue
        if k < leaves - 1:
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


_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"


@kernel(f"float64({_TREE}, {_TREE}, float64[::1], float64[::1])")
def _beyond_reach(rows, order, nodes, frame, frame_order, frame_nodes, limits, square):
    """Return how far a square's centre is beyond the reach, mm: negative = within; INF when all of the square is beyond
    it.

    limits: distance of the frame from the walls, radius. square: x, y, half side, side of the walls (written when
    found).
    """
    x, y = square[0], square[1]
    far = square[2] * math.sqrt(2.0)
    wall = nearest(rows, order, nodes, x, y, INF)[0]
    if wall + far < limits[0] - limits[1]:
        return INF
    side = square[3]
    if side == UNKNOWN:
        side = INSIDE if crossings(rows, x, y) % 2 == 1 else OUTSIDE
        if wall > far:
            square[3] = side
    if side == OUTSIDE and wall > far:
        return INF
    if side == INSIDE and wall >= limits[0]:
        return -limits[1]
    return nearest(frame, frame_order, frame_nodes, x, y, limits[1] + far + 1e-9)[0] - limits[1]


@kernel(
    f"Tuple((float64[:, ::1], int64))({_TREE}, {_TREE}, {_TREE}, float64[::1], float64[::1], float64[::1], float64[:, "
    "::1])"
)
def undecided(
    rows, order, nodes, frame, frame_order, frame_nodes, path, path_order, path_nodes, radii, wide, limits, squares
):
    """Return (squares (n, 5): x, y, half side, beyond the cut, beyond the reach; how many) that may hold what is left.

    Args:
        rows, order, nodes: the walls. frame...: the frame of the tool's centre. path...: what is cut.
        radii, wide: of the paths' cutters, by row and by node.
        limits: distance of the frame from the walls, radius, half side of the smallest squares.
        squares: (m, 3) to begin with.
    """
    found, count = np.empty((256, 5)), 0
    stack = np.empty((len(squares) + 256, 4))
    for k in range(len(squares)):
        stack[k, 0], stack[k, 1], stack[k, 2], stack[k, 3] = squares[k, 0], squares[k, 1], squares[k, 2], UNKNOWN
    top = len(squares)
    while top > 0:
        top -= 1
        x, y, half = stack[top, 0], stack[top, 1], stack[top, 2]
        far = half * math.sqrt(2.0)
        reach = _beyond_reach(rows, order, nodes, frame, frame_order, frame_nodes, limits, stack[top])
        if reach > far:
            continue
        cut = beyond(path, radii, path_order, path_nodes, wide, x, y, (-far, INF))
        if cut <= -far:
            continue
        if half <= limits[2] or (cut > far and reach <= -far):
            if count == len(found):
                found = enlarged(found, count, 2 * count)
            found[count, 0], found[count, 1], found[count, 2], found[count, 3], found[count, 4] = x, y, half, cut, reach
            count += 1
            continue
        side = stack[top, 3]
        if top + 4 > len(stack):
            stack = enlarged(stack, top, 2 * len(stack))
        for k in range(4):
            stack[top, 0] = x + half * (k % 2 - 0.5)
            stack[top, 1] = y + half * (k // 2 - 0.5)
            stack[top, 2], stack[top, 3] = half / 2, side
            top += 1
    return found, count
