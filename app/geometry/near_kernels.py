# mypy: allow-untyped-defs
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
                # the nearer child goes on the stack last, so that it is looked at first and rules out most of the other
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


@kernel("boolean(float64[:, ::1], int64, float64[:, ::1], int64)", counts=False)
def _apart(boxes, i, others, j):
    """Tell whether box i of the one and box j of the others neither meet nor touch."""
    beside = boxes[i, 0] > others[j, 2] or boxes[i, 2] < others[j, 0]
    return beside or boxes[i, 1] > others[j, 3] or boxes[i, 3] < others[j, 1]


@kernel("Tuple((int64[::1], int64[::1]))(int64[::1], int64, int64[::1])")
def _node_contents(order, count, owner):
    """Return for each of `count` nodes the place in the order that its last box comes before, and whose all its boxes
    are: -1 where they are of several owners, or where there are none.
    """
    leaves, last, single = (count + 1) // 2, np.empty(count, np.int64), np.full(count, -1)
    # children have higher numbers than their node, so that from the last one on they are always known
    for k in range(count - 1, -1, -1):
        if k < leaves - 1:
            last[k] = last[2 * k + 2]
            if single[2 * k + 1] == single[2 * k + 2]:
                single[k] = single[2 * k + 1]
            continue
        first = (k - leaves + 1) * LEAF
        last[k] = min(first + LEAF, len(order))
        if first < len(order):
            single[k] = owner[order[first]]
            for place in range(first + 1, last[k]):
                if owner[order[place]] != single[k]:
                    single[k] = -1
    return last, single


@kernel("Tuple((int64[:, ::1], int64))(int64[::1], float64[:, ::1], float64[:, ::1], int64[::1])")
def meeting_boxes(order, nodes, boxes, owner):
    """Return (pairs (m, 2) of owners a < b of boxes that meet or touch, by chance more than once; how many).

    The tree is walked once a leaf, not once a box, and only where it holds boxes later in its order, so that each pair
    is found once. What belongs to the leaf's only owner is left out as a whole: along a contour most neighbours are its
    own.

    Args:
        order, nodes: tree of boxes (n, 4). owner: (n,) of each, >= 0.
    """
    leaves, stack, found, count = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty((256, 2), np.int64), 0
    last, single = _node_contents(order, len(nodes), owner)
    for begin in range(0, len(order), LEAF):
        here, top = leaves - 1 + begin // LEAF, 1
        stack[0] = 0
        while top > 0:
            top -= 1
            k = stack[top]
            # what ends before the leaf's second box was paired with it when that node's own leaf was walked
            if last[k] <= begin + 1 or (single[here] >= 0 and single[k] == single[here]):
                continue
            if _apart(nodes, here, nodes, k):
                continue
            if k < leaves - 1:
                stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for at in range(begin, last[here]):
                i = order[at]
                if _apart(boxes, i, nodes, k):
                    continue
                for place in range(max(first, at + 1), last[k]):
                    j = order[place]
                    if owner[j] == owner[i] or _apart(boxes, i, boxes, j):
                        continue
                    if count == len(found):
                        larger = np.empty((2 * count, 2), np.int64)
                        for n in range(count):
                            larger[n, 0], larger[n, 1] = found[n, 0], found[n, 1]
                        found = larger
                    found[count, 0], found[count, 1] = min(owner[i], owner[j]), max(owner[i], owner[j])
                    count += 1
    return found, count
