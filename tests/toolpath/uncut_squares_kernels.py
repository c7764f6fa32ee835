"""Compiled inner loop of `uncut_squares`: squares of a quad tree, each decided by exact distances from its centre."""

from __future__ import annotations

import math

import numpy as np

from app.core.jit import kernel
from app.geometry.kernels import INF, _crossings, enlarged, nearest
from app.toolpath.coverage.uncut_kernels import beyond

OUTSIDE, INSIDE, UNKNOWN = 0.0, 1.0, 2.0


@kernel("int64(float64[:, ::1], float64, float64)", counts=False)
def crossings(rows, x, y):
    """Return how often the rows cross the ray from a point towards -X, see `_crossings`."""
    count = 0
    for j in range(len(rows)):
        count += _crossings(rows, j, x, y)
    return count


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
