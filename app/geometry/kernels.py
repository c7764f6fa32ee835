# mypy: allow-untyped-defs
"""Compiled inner loops on rows of lines and arcs: distance, and a tree of boxes to find the near ones.

The tree is implicit: rows in Morton order, four to a leaf, the boxes of a complete binary tree in heap order
(children of node k are 2k + 1 and 2k + 2; the last `leaves` nodes are the leaves).
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from .sort_kernels import order_of, sort_numbers

LEAF = 4
"""Rows a leaf of the tree of boxes: fewer make the tree larger, more are looked at in vain."""
INF = math.inf
DEPTH = 64
"""Nodes that wait at most while a tree is walked."""


@kernel("float64[:, ::1](float64[:, ::1], int64, int64)")
def enlarged(table, count, room):
    """Return a table with room for so many rows, which begins with the first `count` rows of another.

    Row by row and number by number: assigning one slice to another has the compiler bring along the message for slices
    that do not fit, and text with it, which takes two seconds to compile.
    """
    larger = np.empty((room, table.shape[1]))
    for k in range(count):
        for c in range(table.shape[1]):
            larger[k, c] = table[k, c]
    return larger


@kernel("float64(float64[:, ::1], int64)", counts=False)
def row_sweep(rows, j):
    """Return the signed sweep of row j, radians; 0 for a line; a row that ends where it starts is a full turn."""
    turn = rows[j, 7]
    if turn == 0.0:
        return 0.0
    if rows[j, 0] == rows[j, 2] and rows[j, 1] == rows[j, 3]:
        return 2.0 * math.pi * turn
    a = math.atan2(rows[j, 1] - rows[j, 5], rows[j, 0] - rows[j, 4])
    b = math.atan2(rows[j, 3] - rows[j, 5], rows[j, 2] - rows[j, 4])
    return ((b - a) if turn > 0.0 else (a - b)) % (2.0 * math.pi) * turn


@kernel("void(float64[:, ::1], float64[::1])")
def row_sweeps(rows, found):
    """Write the signed sweep of each row, see `row_sweep`."""
    for j in range(len(rows)):
        found[j] = row_sweep(rows, j)


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, float64)", counts=False)
def place_on(rows, j, fraction):
    """Return the place at a fraction in [0, 1] of the length of row j."""
    x, y = rows[j, 0], rows[j, 1]
    if rows[j, 7] == 0.0:
        return x + (rows[j, 2] - x) * fraction, y + (rows[j, 3] - y) * fraction
    if fraction == 0.0:
        return x, y
    angle = math.atan2(y - rows[j, 5], x - rows[j, 4]) + row_sweep(rows, j) * fraction
    return rows[j, 4] + rows[j, 6] * math.cos(angle), rows[j, 5] + rows[j, 6] * math.sin(angle)


@kernel("void(float64[:, ::1], int64[::1], float64[::1], float64[:, ::1])")
def places_on(rows, which, fractions, found):
    """Write the place (m, 2) at a fraction in [0, 1] of the length of the row that each of m numbers names."""
    for k in range(len(which)):
        found[k, 0], found[k, 1] = place_on(rows, which[k], fractions[k])


@kernel("boolean(float64[:, ::1], int64, float64, float64)", counts=False)
def in_sector(rows, j, x, y):
    """Return whether the centre of arc j sees a point in a direction in which it sees the arc."""
    ax, ay, bx, by = rows[j, 0] - rows[j, 4], rows[j, 1] - rows[j, 5], rows[j, 2] - rows[j, 4], rows[j, 3] - rows[j, 5]
    vx, vy, turn = x - rows[j, 4], y - rows[j, 5], rows[j, 7]
    return turn * (ax * vy - ay * vx) >= 0.0 and turn * (vx * by - vy * bx) >= 0.0


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def point_distance(rows, j, x, y):
    """Return the distance of a point from row j, mm."""
    ax, ay, bx, by = x - rows[j, 0], y - rows[j, 1], x - rows[j, 2], y - rows[j, 3]
    if rows[j, 7] == 0.0:
        dx, dy = rows[j, 2] - rows[j, 0], rows[j, 3] - rows[j, 1]
        length2, along = dx * dx + dy * dy, ax * dx + ay * dy
        if 0.0 < along < length2:
            return abs(ax * dy - ay * dx) / math.sqrt(length2)
        return math.sqrt(ax * ax + ay * ay) if along <= 0.0 else math.sqrt(bx * bx + by * by)
    if in_sector(rows, j, x, y):
        vx, vy = x - rows[j, 4], y - rows[j, 5]
        return abs(math.sqrt(vx * vx + vy * vy) - rows[j, 6])
    return math.sqrt(min(ax * ax + ay * ay, bx * bx + by * by))


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def box_distance(nodes, k, x, y):
    """Return the distance of a point from the box of node k, mm (0 inside)."""
    dx = max(nodes[k, 0] - x, x - nodes[k, 2], 0.0)
    dy = max(nodes[k, 1] - y, y - nodes[k, 3], 0.0)
    return math.sqrt(dx * dx + dy * dy)


@kernel("void(float64[:, ::1], float64[:, ::1])")
def row_boxes(rows, boxes):
    """Write the boxes x0, y0, x1, y1 that hold each row exactly; arcs up to a full turn, which ends where it starts."""
    for i in range(len(rows)):
        boxes[i, 0], boxes[i, 1] = min(rows[i, 0], rows[i, 2]), min(rows[i, 1], rows[i, 3])
        boxes[i, 2], boxes[i, 3] = max(rows[i, 0], rows[i, 2]), max(rows[i, 1], rows[i, 3])
        if rows[i, 7] == 0.0:
            continue
        cx, cy, r = rows[i, 4], rows[i, 5], rows[i, 6]
        start = math.atan2(rows[i, 1] - cy, rows[i, 0] - cx)
        sweep = ((math.atan2(rows[i, 3] - cy, rows[i, 2] - cx) - start) * rows[i, 7]) % (2 * math.pi)
        if rows[i, 0] == rows[i, 2] and rows[i, 1] == rows[i, 3]:
            sweep = 2 * math.pi
        for k in range(4):
            if ((k * math.pi / 2 - start) * rows[i, 7]) % (2 * math.pi) > sweep:
                continue
            if k == 0:
                boxes[i, 2] = max(boxes[i, 2], cx + r)
            elif k == 1:
                boxes[i, 3] = max(boxes[i, 3], cy + r)
            elif k == 2:
                boxes[i, 0] = min(boxes[i, 0], cx - r)
            else:
                boxes[i, 1] = min(boxes[i, 1], cy - r)


@kernel("int64(int64)")
def spread(v):
    """Return the sixteen bits of v with a gap before each, for Morton codes."""
    v = (v | (v << 8)) & 0x00FF00FF
    v = (v | (v << 4)) & 0x0F0F0F0F
    v = (v | (v << 2)) & 0x33333333
    return (v | (v << 1)) & 0x55555555


@kernel("Tuple((int64[::1], float64[:, ::1]))(float64[:, ::1])")
def build_tree(boxes):
    """Return (order of the rows, boxes of the nodes) for boxes (n, 4); n > 0."""
    n = len(boxes)
    x0, y0, x1, y1 = boxes[0, 0], boxes[0, 1], boxes[0, 2], boxes[0, 3]
    for i in range(1, n):
        x0, y0, x1, y1 = min(x0, boxes[i, 0]), min(y0, boxes[i, 1]), max(x1, boxes[i, 2]), max(y1, boxes[i, 3])
    size = max(x1 - x0, y1 - y0, 1e-12)
    codes = np.empty(n)
    for i in range(n):
        u = int((boxes[i, 0] + boxes[i, 2] - 2 * x0) / 2 / size * 65535)
        v = int((boxes[i, 1] + boxes[i, 3] - 2 * y0) / 2 / size * 65535)
        codes[i] = spread(u) | (spread(v) << 1)
    # Morton order: rows that follow one another in it lie near one another, so leaves are small
    order = order_of(codes)
    leaves = 1
    while leaves * LEAF < n:
        leaves *= 2
    nodes = np.empty((2 * leaves - 1, 4))
    for k in range(len(nodes)):
        nodes[k, 0], nodes[k, 1], nodes[k, 2], nodes[k, 3] = INF, INF, -INF, -INF
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


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _box_square(nodes, k, x, y):
    """Return the square of `box_distance`."""
    dx = max(nodes[k, 0] - x, x - nodes[k, 2], 0.0)
    dy = max(nodes[k, 1] - y, y - nodes[k, 3], 0.0)
    return dx * dx + dy * dy


@kernel(
    "Tuple((float64, int64))(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, float64, float64, int64)",
    counts=False,
)
def nearest_from(rows, order, nodes, x, y, enough, limit, guess):
    """Return `nearest_between`, the sooner the nearer row `guess` is; -1 = none is known.

    Where a node stands is told by its number, and by a bit for each level whether its sibling was looked at already.
    """
    leaves, best, row = (len(nodes) + 1) // 2, limit, -1
    if guess >= 0:
        d = point_distance(rows, guess, x, y)
        if d <= enough:
            return d, guess
        # a little more, so that of rows as near the same one is found as without it
        best = min(best, d * (1 + 1e-12) + 1e-300)
    k, depth, both = 0, 0, 0
    if math.sqrt(_box_square(nodes, 0, x, y)) >= best:
        return best, row
    while True:
        if k < leaves - 1:
            left, right = _box_square(nodes, 2 * k + 1, x, y), _box_square(nodes, 2 * k + 2, x, y)
            # of boxes that are as far to the last digit the left one is first
            swapped = left > right and (left > right * (1 + 1e-15) or math.sqrt(left) > math.sqrt(right))
            if math.sqrt(right if swapped else left) < best:
                k, depth = 2 * k + (2 if swapped else 1), depth + 1
                both &= ~(1 << depth)
                continue
        else:
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                d = point_distance(rows, order[place], x, y)
                if d < best:
                    best, row = d, order[place]
                    if best <= enough:
                        return best, row
        while depth > 0:
            if both >> depth & 1 == 0:
                both |= 1 << depth
                # to the sibling, which was not looked at yet; its box may be out of reach by now
                k = k + 1 if k % 2 == 1 else k - 1
                if math.sqrt(_box_square(nodes, k, x, y)) < best:
                    break
            k, depth = (k - 1) // 2, depth - 1
        if depth == 0:
            return best, row


@kernel("Tuple((float64, int64))(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, float64, float64)")
def nearest_between(rows, order, nodes, x, y, enough, limit):
    """Return (distance, row) of the row nearest to a point, or of the first one found no farther than `enough`; (limit,
    -1) when none is nearer than `limit`.
    """
    return nearest_from(rows, order, nodes, x, y, enough, limit, -1)


@kernel("int64(int64[::1], int64)", counts=False)
def _head(group, k):
    """Return the lowest of what k is joined with, and make the way there shorter."""
    while group[k] != k:
        group[k] = group[group[k]]
        k = group[k]
    return k


@kernel("void(int64[:, ::1], int64[::1])")
def merge(pairs, group):
    """Write for each thing the lowest of those that it is joined with by pairs (m, 2)."""
    for k in range(len(group)):
        group[k] = k
    for i in range(len(pairs)):
        a, b = _head(group, pairs[i, 0]), _head(group, pairs[i, 1])
        group[max(a, b)] = min(a, b)
    for k in range(len(group)):
        group[k] = _head(group, k)


@kernel("void(float64[:, ::1], int64[::1], int64[::1], int64, float64, int64[::1])")
def merge_within(points, owner, cell, columns, reach, group):
    """Write for each owner of points the lowest of those that it is joined with by points within a distance.

    Args:
        points: (n, 2) by their cell. owner: (n,) whose each one is.
        cell: (n,) row * columns + column of a grid of squares as wide as the distance, whose first and last columns
            are empty.
        reach: mm.
    """
    for k in range(len(group)):
        group[k] = k
    most, first, last = reach * reach * (1 + 1e-12), 0, 0
    for i in range(len(points)):
        x, y, a = points[i, 0], points[i, 1], owner[i]
        # of a row of cells the neighbours ahead are the same row's next cell and three cells of the next row
        while first < len(points) and cell[first] < cell[i] + columns - 1:
            first += 1
        last = max(last, first)
        while last < len(points) and cell[last] <= cell[i] + columns + 1:
            last += 1
        j = i + 1
        while j < last:
            if j < first and cell[j] > cell[i] + 1:  # on to the next row
                j = first
                continue
            if owner[j] != a:
                dx, dy = points[j, 0] - x, points[j, 1] - y
                square = dx * dx + dy * dy
                if square <= most and math.sqrt(square) <= reach:
                    one, other = _head(group, a), _head(group, owner[j])
                    group[max(one, other)] = min(one, other)
            j += 1
    for k in range(len(group)):
        group[k] = _head(group, k)


@kernel("Tuple((float64, int64))(float64[:, ::1], float64, float64)")
def nearest_of_few(rows, x, y):
    """Return (distance, row) of the row nearest to a point, without a tree."""
    best, row = INF, -1
    for j in range(len(rows)):
        d = point_distance(rows, j, x, y)
        if d < best:
            best, row = d, j
    return best, row


@kernel(
    "void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64, float64, float64[::1], int64[::1])"
)
def nearest_many(rows, order, nodes, points, enough, limit, distances, found):
    """Write the distance and the row nearest to each point (m, 2), see `nearest_between`: what is nearest to a point is
    near the next one, too, where they were made one beside the other.
    """
    known = -1
    for k in range(len(points)):
        distances[k], found[k] = nearest_from(rows, order, nodes, points[k, 0], points[k, 1], enough, limit, known)
        if found[k] >= 0:
            known = found[k]


@kernel("float64(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1])")
def farthest(rows, order, nodes, points):
    """Return the distance of the point (m, 2) that is farthest from all rows, 0 of none; others are asked no more than
    whether they are nearer.
    """
    most, known = 0.0, -1
    for k in range(len(points)):
        # what is nearest to a point is near the next one, too: mostly it alone tells that this is no farther
        away, known = nearest_from(rows, order, nodes, points[k, 0], points[k, 1], most, INF, known)
        most = max(most, away)
    return most


@kernel("boolean(float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64, float64)")
def stays_clear(rows, order, nodes, way, distance, level):
    """Return whether the straight way x0, y0, x1, y1 stays at least `distance` - `level` / 2 from all rows, mm.

    Distance changes by no more than the length gone, so a step of (measured - needed) passes no wall unseen; steps are
    `level` at least.
    """
    ahead_x, ahead_y = way[2] - way[0], way[3] - way[1]
    length, at, row = math.hypot(ahead_x, ahead_y), 0.0, -1
    while at < length:
        x, y = way[0] + ahead_x * (at / length), way[1] + ahead_y * (at / length)
        away, row = nearest_from(rows, order, nodes, x, y, -1.0, INF, row)
        spare = away - distance
        if spare < -level / 2:
            return False
        at += max(spare, level)
    return True


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, float64)", counts=False)
def _crossing_places(rows, j, y):
    """Return where row j crosses a height, infinity where it does not (half open in y).

    A row sweeps less than pi, so it has at most one y extremum; on a piece without one the circle's right side
    is the one where a counter-clockwise arc rises. Whether a row crosses is told by its ends alone, by which its
    neighbours tell it too: where one begins at its top, the circle's may be a rounding lower than the end.
    """
    ax, ay, bx, by, turn = rows[j, 0], rows[j, 1], rows[j, 2], rows[j, 3], rows[j, 7]
    if turn == 0.0:
        return (ax + (y - ay) / (by - ay) * (bx - ax) if (ay <= y) != (by <= y) else INF), INF
    cx, cy, r = rows[j, 4], rows[j, 5], rows[j, 6]
    if abs(y - cy) > r and (ay <= y) == (by <= y):
        return INF, INF
    h = math.sqrt(max(r * r - (y - cy) * (y - cy), 0.0))
    middle = by
    for end in (-r, r):
        # the arc passes the extremum where it goes towards it at its beginning and away from it at its end
        if turn * (ax - cx) * end > 0.0 and turn * -end * (bx - cx) > 0.0:
            middle = cy + end
    first = cx + math.copysign(h, turn * (middle - ay)) if (ay <= y) != (middle <= y) else INF
    return first, (cx + math.copysign(h, turn * (by - middle)) if (middle <= y) != (by <= y) else INF)


@kernel("int64(float64[:, ::1], int64, float64, float64)", counts=False)
def _crossings(rows, j, x, y):
    """Return how often row j crosses the ray from a point towards -X (even-odd rule)."""
    first, second = _crossing_places(rows, j, y)
    return int(first < x) + int(second < x)


@kernel("Tuple((float64, int64))(float64[:, ::1], int64[::1], float64[:, ::1], float64, float64, float64)")
def nearest(rows, order, nodes, x, y, limit):
    """Return (distance, row) of the row nearest to a point; (limit, -1) when none is nearer than `limit`."""
    return nearest_between(rows, order, nodes, x, y, -1.0, limit)


_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"


@kernel(f"boolean({_TREE}, float64, float64, int64[::1])", counts=False)
def inside(rows, order, nodes, x, y, stack):
    """Return whether the closed rows enclose a point by the even-odd rule; `stack` is room for DEPTH nodes."""
    leaves, count = (len(nodes) + 1) // 2, 0
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if y < nodes[k, 1] or y > nodes[k, 3] or x < nodes[k, 0]:
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 1, 2 * k + 2
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            if order[place] < 0:  # a leaf that is not full
                break
            count += _crossings(rows, order[place], x, y)
    return count % 2 == 1


@kernel(f"void({_TREE}, float64[:, ::1], boolean[::1])")
def inside_many(rows, order, nodes, points, result):
    """Write for each point (m, 2) whether it is inside by the even-odd rule."""
    stack = np.empty(DEPTH, np.int64)
    for k in range(len(points)):
        result[k] = inside(rows, order, nodes, points[k, 0], points[k, 1], stack)


@kernel(f"void({_TREE}, float64[::1], int64[::1], float64[::1], boolean[::1])")
def inside_on_lines(rows, order, nodes, heights, first, places, result):
    """Write for points on lines along X whether they are inside by the even-odd rule.

    A line is crossed once for all its points: asked one by one, each is held against all that lies to its left, which
    grows with the drawing.

    Args:
        heights: (n,) Y of the lines. first: (n + 1,) number of each one's first point. places: (m,) X of the points.
    """
    leaves, stack, found = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty(2 * len(order))
    for line in range(len(heights)):
        y, count, top = heights[line], 0, 1
        stack[0] = 0
        while top > 0:
            top -= 1
            k = stack[top]
            if y < nodes[k, 1] or y > nodes[k, 3]:
                continue
            if k < leaves - 1:
                stack[top], stack[top + 1] = 2 * k + 1, 2 * k + 2
                top += 2
                continue
            begin = (k - leaves + 1) * LEAF
            for place in range(begin, min(begin + LEAF, len(order))):
                if order[place] < 0:  # a leaf that is not full
                    break
                for x in _crossing_places(rows, order[place], y):
                    if x < INF:
                        found[count] = x
                        count += 1
        crossed = found[:count]
        sort_numbers(crossed)
        for i in range(first[line], first[line + 1]):
            low, high = 0, count  # how many lie before the point
            while low < high:
                middle = (low + high) // 2
                if crossed[middle] < places[i]:
                    low = middle + 1
                else:
                    high = middle
            result[i] = low % 2 == 1


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], boolean[::1])")
def inside_own(rows, first, points, result):
    """Write for each run of closed rows, from first[k] up to first[k + 1], whether it encloses its own point by the
    even-odd rule.
    """
    for k in range(len(points)):
        count = 0
        for j in range(first[k], first[k + 1]):
            count += _crossings(rows, j, points[k, 0], points[k, 1])
        result[k] = count % 2 == 1
