"""Compiled inner loops on rows of lines and arcs: distance, and a tree of boxes to find the near ones.

The tree is implicit: rows in Morton order, four to a leaf, the boxes of a complete binary tree in heap order
(children of node k are 2k + 1 and 2k + 2; the last `leaves` nodes are the leaves).
"""

from __future__ import annotations

import math

import numpy as np

from app.jit import kernel

LEAF = 4
INF = math.inf


@kernel("float64(float64[:, ::1], int64, float64, float64)")
def point_distance(rows, j, x, y):
    """Return the distance of a point from row j, mm."""
    ax, ay, bx, by = rows[j, 0], rows[j, 1], rows[j, 2], rows[j, 3]
    turn = rows[j, 7]
    if turn == 0.0:
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        t = ((x - ax) * dx + (y - ay) * dy) / length2 if length2 > 0.0 else 0.0
        if 0.0 < t < 1.0:
            return abs((x - ax) * dy - (y - ay) * dx) / math.sqrt(length2)
        return math.hypot(x - ax, y - ay) if t <= 0.0 else math.hypot(x - bx, y - by)
    cx, cy, r = rows[j, 4], rows[j, 5], rows[j, 6]
    vx, vy = x - cx, y - cy
    if turn * ((ax - cx) * vy - (ay - cy) * vx) >= 0.0 and turn * (vx * (by - cy) - vy * (bx - cx)) >= 0.0:
        return abs(math.hypot(vx, vy) - r)
    return min(math.hypot(x - ax, y - ay), math.hypot(x - bx, y - by))


@kernel("float64(float64[:, ::1], int64, float64, float64)")
def box_distance(nodes, k, x, y):
    """Return the distance of a point from the box of node k, mm (0 inside)."""
    dx = max(nodes[k, 0] - x, x - nodes[k, 2], 0.0)
    dy = max(nodes[k, 1] - y, y - nodes[k, 3], 0.0)
    return math.sqrt(dx * dx + dy * dy)


@kernel("int64(int64)")
def _spread(v):
    v = (v | (v << 8)) & 0x00FF00FF
    v = (v | (v << 4)) & 0x0F0F0F0F
    v = (v | (v << 2)) & 0x33333333
    return (v | (v << 1)) & 0x55555555


@kernel("Tuple((int64[::1], float64[:, ::1]))(float64[:, ::1])")
def build_tree(boxes):
    """Return (order of the rows, boxes of the nodes) for boxes (n, 4); n > 0."""
    n = len(boxes)
    x0, y0 = boxes[:, 0].min(), boxes[:, 1].min()
    size = max(boxes[:, 2].max() - x0, boxes[:, 3].max() - y0, 1e-12)
    codes = np.empty(n, np.int64)
    for i in range(n):
        u = int((boxes[i, 0] + boxes[i, 2] - 2 * x0) / 2 / size * 65535)
        v = int((boxes[i, 1] + boxes[i, 3] - 2 * y0) / 2 / size * 65535)
        codes[i] = _spread(u) | (_spread(v) << 1)
    order = np.argsort(codes)
    leaves = 1
    while leaves * LEAF < n:
        leaves *= 2
    nodes = np.empty((2 * leaves - 1, 4))
    nodes[:, :2] = INF
    nodes[:, 2:] = -INF
    for place in range(n):
        k, i = leaves - 1 + place // LEAF, order[place]
        nodes[k, 0], nodes[k, 1] = min(nodes[k, 0], boxes[i, 0]), min(nodes[k, 1], boxes[i, 1])
        nodes[k, 2], nodes[k, 3] = max(nodes[k, 2], boxes[i, 2]), max(nodes[k, 3], boxes[i, 3])
    for k in range(leaves - 2, -1, -1):
        for c in range(2):
            nodes[k, c] = min(nodes[2 * k + 1, c], nodes[2 * k + 2, c])
            nodes[k, c + 2] = max(nodes[2 * k + 1, c + 2], nodes[2 * k + 2, c + 2])
    return order, nodes


@kernel("int64(int64[::1], float64[:, ::1], float64[:, ::1], float64[::1], int64[::1])")
def query_box(order, nodes, boxes, box, found):
    """Write into `found` (room for every row) the rows whose boxes meet `box`; return how many."""
    leaves, count = (len(nodes) + 1) // 2, 0
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if nodes[k, 0] > box[2] or nodes[k, 2] < box[0] or nodes[k, 1] > box[3] or nodes[k, 3] < box[1]:
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            i = order[place]
            if boxes[i, 0] <= box[2] and boxes[i, 2] >= box[0] and boxes[i, 1] <= box[3] and boxes[i, 3] >= box[1]:
                found[count] = i
                count += 1
    return count


@kernel("Tuple((float64, int64))(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, float64)")
def nearest(rows, order, nodes, x, y, limit):
    """Return (distance, row) of the row nearest to a point; (limit, -1) when none is nearer than `limit`."""
    leaves = (len(nodes) + 1) // 2
    best, row = limit, -1
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if box_distance(nodes, k, x, y) >= best:
            continue
        if k < leaves - 1:
            left, right = 2 * k + 1, 2 * k + 2
            if box_distance(nodes, left, x, y) > box_distance(nodes, right, x, y):
                left, right = right, left
            stack[top], stack[top + 1] = right, left
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            d = point_distance(rows, order[place], x, y)
            if d < best:
                best, row = d, order[place]
    return best, row


@kernel("boolean(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, float64)")
def any_nearer(rows, order, nodes, x, y, limit):
    """Return whether some row is nearer to a point than `limit`; quicker than `nearest`, as any one will do."""
    leaves = (len(nodes) + 1) // 2
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if box_distance(nodes, k, x, y) >= limit:
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            if point_distance(rows, order[place], x, y) < limit:
                return True
    return False


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64, float64[::1], int64[::1])")
def nearest_many(rows, order, nodes, points, limit, distances, found):
    """Write the distance and the row nearest to each point (m, 2)."""
    for k in range(len(points)):
        distances[k], found[k] = nearest(rows, order, nodes, points[k, 0], points[k, 1], limit)


@kernel("int64(float64[:, ::1], float64, float64)")
def crossings(rows, x, y):
    """Return how often the rows cross the ray from a point towards -X (even-odd rule, half open in y).

    A row sweeps less than pi, so it has at most one y extremum; on a piece without one the circle's right side
    is the one where a counter-clockwise arc rises.
    """
    count = 0
    for j in range(len(rows)):
        ax, ay, bx, by, turn = rows[j, 0], rows[j, 1], rows[j, 2], rows[j, 3], rows[j, 7]
        if turn == 0.0:
            if (ay <= y) != (by <= y) and ax + (y - ay) / (by - ay) * (bx - ax) < x:
                count += 1
            continue
        cx, cy, r = rows[j, 4], rows[j, 5], rows[j, 6]
        if abs(y - cy) > r:
            continue
        h = math.sqrt(max(r * r - (y - cy) * (y - cy), 0.0))
        middle = by
        for end in (-r, r):
            if turn * (ax - cx) * end > 0.0 and turn * -end * (bx - cx) > 0.0:
                middle = cy + end
        if (ay <= y) != (middle <= y) and cx + math.copysign(h, turn * (middle - ay)) < x:
            count += 1
        if (middle <= y) != (by <= y) and cx + math.copysign(h, turn * (by - middle)) < x:
            count += 1
    return count


@kernel("void(float64[:, ::1], float64[:, ::1], boolean[::1])")
def inside_many(rows, points, inside):
    """Write for each point (m, 2) whether it is inside by the even-odd rule."""
    for k in range(len(points)):
        inside[k] = crossings(rows, points[k, 0], points[k, 1]) % 2 == 1
