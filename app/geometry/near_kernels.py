"""Compiled inner loops: which points are nearest to places, and which boxes meet, in the tree of boxes of `kernels`."""

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


@kernel("Tuple((int64[:, ::1], int64))(int64[::1], float64[:, ::1], float64[:, ::1], int64[::1])")
def meeting_boxes(order, nodes, boxes, owner):
    """Return (pairs (m, 2) of owners a < b of boxes that meet or touch, by chance more than once; how many).

    Each pair is found from the box that stands first in the tree's order, so that half of the tree need not be walked.

    Args:
        order, nodes: tree of boxes (n, 4). owner: (n,) of each.
    """
    leaves, stack, found, count = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty((256, 2), np.int64), 0
    last = np.empty(len(nodes), np.int64)  # place in the order that a node's last box comes before
    for k in range(len(nodes) - 1, -1, -1):
        last[k] = min((k - leaves + 2) * LEAF, len(order)) if k >= leaves - 1 else last[2 * k + 2]
    for at in range(len(order)):
        i = order[at]
        x0, y0, x1, y1, mine, top = boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3], owner[i], 1
        stack[0] = 0
        while top > 0:
            top -= 1
            k = stack[top]
            if last[k] <= at + 1 or nodes[k, 0] > x1 or nodes[k, 2] < x0 or nodes[k, 1] > y1 or nodes[k, 3] < y0:
                continue
            if k < leaves - 1:
                stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
                top += 2
                continue
            for place in range(max((k - leaves + 1) * LEAF, at + 1), last[k]):
                j = order[place]
                if owner[j] == mine or boxes[j, 0] > x1 or boxes[j, 2] < x0 or boxes[j, 1] > y1 or boxes[j, 3] < y0:
                    continue
                if count == len(found):
                    larger = np.empty((2 * count, 2), np.int64)
                    for n in range(count):
                        larger[n, 0], larger[n, 1] = found[n, 0], found[n, 1]
                    found = larger
                found[count, 0], found[count, 1] = min(mine, owner[j]), max(mine, owner[j])
                count += 1
    return found, count
