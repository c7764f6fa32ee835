# mypy: allow-untyped-defs
"""Compiled inner loops of the exact offset: a tree whose leaves are runs of rows.

As the tree of `kernels`, but up to four rows to a leaf that follow one another where they can (-1 where there are
fewer), the leaves in Morton order. A leaf has a capsule as well, a line and a radius, which fits a slanting run of rows
much closer than its box.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import INF, LEAF, spread
from ..sort_kernels import sort_integers


@kernel("void(float64[:, ::1], int64[::1], int64, float64[:, ::1])", counts=False)
def _capsule(rows, order, leaf, capsules):
    """Write the thick line x0, y0, x1, y1, radius that holds the rows of a leaf: from where the first starts to where
    the last ends.
    """
    first = leaf * LEAF
    last = first
    while last + 1 < first + LEAF and order[last + 1] >= 0:
        last += 1
    i, k = order[first], order[last]
    x, y, ux, uy = rows[i, 0], rows[i, 1], rows[k, 2] - rows[i, 0], rows[k, 3] - rows[i, 1]
    length2, radius = ux * ux + uy * uy, 0.0
    for place in range(first, last + 1):
        j, sag = order[place], 0.0
        if rows[j, 7] != 0.0:  # an arc is within its height of its chord
            mx, my = (rows[j, 0] + rows[j, 2]) / 2 - rows[j, 4], (rows[j, 1] + rows[j, 3]) / 2 - rows[j, 5]
            sag = rows[j, 6] - math.sqrt(mx * mx + my * my)
            if rows[j, 7] * (mx * (rows[j, 3] - rows[j, 1]) - my * (rows[j, 2] - rows[j, 0])) < 0.0:
                # of more than half a turn: the centre lies on the arc's side of the chord
                sag = 2 * rows[j, 6] - sag
        for c in (0, 2):
            vx, vy = rows[j, c] - x, rows[j, c + 1] - y
            t = min(max((vx * ux + vy * uy) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
            wx, wy = vx - t * ux, vy - t * uy
            radius = max(radius, math.sqrt(wx * wx + wy * wy) + sag)
    capsules[leaf, 0], capsules[leaf, 1], capsules[leaf, 2], capsules[leaf, 3] = x, y, x + ux, y + uy
    capsules[leaf, 4] = radius + 1e-12 * (abs(x) + abs(y) + radius)


@kernel("Tuple((float64[:, ::1], float64[:, ::1]))(float64[:, ::1], float64[:, ::1], int64[::1])")
def tree_over(rows, boxes, order):
    """Return (boxes of the nodes, capsules of the leaves) of a tree whose leaves are given."""
    used, leaves = len(order) // LEAF, 1
    while leaves < used:
        leaves *= 2
    nodes, capsules = np.empty((2 * leaves - 1, 4)), np.empty((used, 5))
    for k in range(len(nodes)):
        nodes[k, 0], nodes[k, 1], nodes[k, 2], nodes[k, 3] = INF, INF, -INF, -INF
    for place in range(len(order)):
        k, i = leaves - 1 + place // LEAF, order[place]
        if i >= 0:
            nodes[k, 0], nodes[k, 1] = min(nodes[k, 0], boxes[i, 0]), min(nodes[k, 1], boxes[i, 1])
            nodes[k, 2], nodes[k, 3] = max(nodes[k, 2], boxes[i, 2]), max(nodes[k, 3], boxes[i, 3])
    for leaf in range(used):
        _capsule(rows, order, leaf, capsules)
    for k in range(leaves - 2, -1, -1):
        for c in range(2):
            nodes[k, c] = min(nodes[2 * k + 1, c], nodes[2 * k + 2, c])
            nodes[k, c + 2] = max(nodes[2 * k + 1, c + 2], nodes[2 * k + 2, c + 2])
    return nodes, capsules


@kernel("int64(float64[:, ::1], int64[::1])", counts=False)
def _runs(rows, starts):
    """Write where runs of at most LEAF rows begin that follow one another, and the end of the last; return how many
    there are.
    """
    count = size = 0
    for i in range(len(rows)):
        joined = i > 0 and abs(rows[i, 0] - rows[i - 1, 2]) < 1e-6 and abs(rows[i, 1] - rows[i - 1, 3]) < 1e-6
        if not joined or size == LEAF:
            starts[count] = i
            count, size = count + 1, 0
        size += 1
    starts[count] = len(rows)
    return count


@kernel("Tuple((int64[::1], float64[:, ::1], float64[:, ::1]))(float64[:, ::1], float64[:, ::1])")
def build_runs(rows, boxes):
    """Return (rows of the leaves, boxes of the nodes, capsules of the leaves), for n > 0 rows and their boxes."""
    starts = np.empty(len(rows) + 1, np.int64)
    runs = _runs(rows, starts)
    x0, y0, x1, y1 = INF, INF, -INF, -INF
    for i in range(len(boxes)):
        x0, y0, x1, y1 = min(x0, boxes[i, 0]), min(y0, boxes[i, 1]), max(x1, boxes[i, 2]), max(y1, boxes[i, 3])
    scale = 65535 / max(x1 - x0, y1 - y0, 1e-12)
    keys = np.empty(runs, np.int64)
    for k in range(runs):
        i, j = starts[k], starts[k + 1] - 1
        u = int(((boxes[i, 0] + boxes[j, 2]) / 2 - x0) * scale)
        v = int(((boxes[i, 1] + boxes[j, 3]) / 2 - y0) * scale)
        # the run's number in the low half: sorting needs no second array, and ties keep their order
        keys[k] = ((spread(u) | (spread(v) << 1)) << 32) | k
    sort_integers(keys)
    order = np.full(runs * LEAF, -1)
    for place in range(runs):
        k = keys[place] & 0xFFFFFFFF
        for i in range(starts[k], starts[k + 1]):
            order[place * LEAF + i - starts[k]] = i
    nodes, capsules = tree_over(rows, boxes, order)
    return order, nodes, capsules
