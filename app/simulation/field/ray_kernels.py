# mypy: allow-untyped-defs
"""Compiled: where upright lines meet triangles in a tree of boxes."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..box_tree import LEAF
from .solid_kernels import holds, side

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_STACK = 128
"""Nodes that wait, at most: one a level of the tree, and no tree is so deep."""


@kernel(f"UniTuple(float64, 2)({_R}, float64, float64)", counts=False)
def meeting(t, x, y):
    """Return where the upright line through a place meets a triangle (9,), and 1 where that looks up, -1 down, 0 where
    it does not.

    An edge belongs to one of its two triangles, as for `solid_kernels.drop`; upright triangles are met by none.
    """
    area = side(t[0], t[1], t[3], t[4], t[6], t[7])
    if area == 0.0:
        return 0.0, 0.0
    turn = 1.0 if area > 0.0 else -1.0
    # the same bits as `drop` has, so that grid and probe agree on which triangle owns an edge
    u, v, w = side(t[3], t[4], t[6], t[7], x, y), side(t[6], t[7], t[0], t[1], x, y), side(t[0], t[1], t[3], t[4], x, y)
    if not (
        holds(u * turn, (t[6] - t[3]) * turn, (t[7] - t[4]) * turn)
        and holds(v * turn, (t[0] - t[6]) * turn, (t[1] - t[7]) * turn)
        and holds(w * turn, (t[3] - t[0]) * turn, (t[4] - t[1]) * turn)
    ):
        return 0.0, 0.0
    return (u * t[2] + v * t[5] + w * t[8]) / (u + v + w), turn


@kernel(f"boolean({_MANY}, int64, float64, float64)", counts=False)
def over(boxes, k, x, y):
    """Return whether an upright line goes through a node's box."""
    return boxes[k, 0] <= x <= boxes[k, 3] and boxes[k, 1] <= y <= boxes[k, 4]


@kernel(f"void({_MANY}, {_MANY}, {_MANY}, {_R})")
def tops(boxes, triangles, points, out):
    """Write the highest place where the upright line through each point (m, 2) meets a triangle, -infinite where it
    meets none.
    """
    leaves, stack = (len(boxes) + 1) // 2, np.empty(_STACK, np.int64)
    for j in range(len(points)):
        x, y, best = points[j, 0], points[j, 1], -math.inf
        stack[0], depth = 0, 1
        while depth > 0:
            depth -= 1
            k = stack[depth]
            if boxes[k, 5] <= best or not over(boxes, k, x, y):
                continue
            if k >= leaves - 1:
                first = (k - leaves + 1) * LEAF
                for n in range(first, min(first + LEAF, len(triangles))):
                    z, turn = meeting(triangles[n], x, y)
                    if turn != 0.0:
                        best = max(best, z)
                continue
            high, low = 2 * k + 1, 2 * k + 2
            # the higher child is opened first: it closes the lower one
            if boxes[high, 5] < boxes[low, 5]:
                high, low = low, high
            stack[depth], stack[depth + 1] = low, high
            depth += 2
        out[j] = best


@kernel(f"void({_MANY}, {_MANY}, {_MANY}, int64[::1], {_MANY})")
def met(boxes, triangles, points, counts, found):
    """Write how often the upright line through each point (m, 2) meets a triangle, and where there is room for it,
    where.

    Args:
        boxes, triangles: of a `TriangleTree`.
        counts: (m,). found: (n, 2) height, mm, and 1 = it looks up, -1 = down; point by point; no rows: not wanted.
    """
    leaves, stack, row = (len(boxes) + 1) // 2, np.empty(_STACK, np.int64), 0
    for j in range(len(points)):
        x, y, before = points[j, 0], points[j, 1], row
        stack[0], depth = 0, 1
        while depth > 0:
            depth -= 1
            k = stack[depth]
            # every meeting counts here, so no box can be closed by a higher one as in `tops`
            if not over(boxes, k, x, y):
                continue
            if k < leaves - 1:
                stack[depth], stack[depth + 1] = 2 * k + 1, 2 * k + 2
                depth += 2
                continue
            first = (k - leaves + 1) * LEAF
            for n in range(first, min(first + LEAF, len(triangles))):
                z, turn = meeting(triangles[n], x, y)
                if turn != 0.0:
                    if len(found) > 0:
                        found[row, 0], found[row, 1] = z, turn
                    row += 1
        counts[j] = row - before
