"""Compiled inner loop: which of many points are nearest to places, in the tree of boxes of `kernels`."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from .kernels import DEPTH, LEAF, box_distance


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], int64[:, ::1])")
def nearest_points(points, order, nodes, places, away, which):
    """Write for each place (k, 2) how far the points nearest to it are and which these are, (k, count) each; the
    nearest first, of those as far the one of the lower number, but where all lie at the place itself any of them.

    Args:
        points: (n, 2), n >= count. order, nodes: their tree.
    """
    leaves, stack, count = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), away.shape[1]
    for p in range(len(places)):
        x, y, known, top = places[p, 0], places[p, 1], 0, 1
        stack[0] = 0
        while top > 0:
            top -= 1
            k = stack[top]
            if known == count:
                far = box_distance(nodes, k, x, y)
                # what is as far as the last one may have a lower number; of points at one place there may be very many
                if far > away[p, count - 1] or away[p, count - 1] == 0.0:
                    continue
            if k < leaves - 1:
                nearer = 2 * k + 1
                if box_distance(nodes, nearer + 1, x, y) < box_distance(nodes, nearer, x, y):
                    nearer += 1
                stack[top], stack[top + 1] = 4 * k + 3 - nearer, nearer
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                i = order[place]
                dx, dy = x - points[i, 0], y - points[i, 1]
                d = math.sqrt(dx * dx + dy * dy)
                if known == count:
                    if d > away[p, count - 1] or (d == away[p, count - 1] and i > which[p, count - 1]):
                        continue
                else:
                    known += 1
                at = known - 1
                while at > 0 and (d < away[p, at - 1] or (d == away[p, at - 1] and i < which[p, at - 1])):
                    away[p, at], which[p, at] = away[p, at - 1], which[p, at - 1]
                    at -= 1
                away[p, at], which[p, at] = d, i
