# mypy: allow-untyped-defs
"""Compiled: squares of a wanted area that one stretch of a path covers all over.

A cutter of radius R along a line covers all within R of it, along an arc of radius A all within R of that: in the
sector of the arc what is between A - R and A + R from its centre. The first is convex, and so is the second but for its
inner bound, which is asked apart. So what of an area lies within a square is covered if all its corners are: those of
the area, those of the square, and where the two cross.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import DEPTH, LEAF, nearest, point_distance

OUTSIDE, COVERED, OPEN, UNCUT = range(4)
"""What of a square is wanted: nothing; all of that is covered; some of that may be uncut; some of that is."""

ROOM = 512
"""Corners that a square may have; with more it stays open."""

_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"
_BOX = "UniTuple(float64, 4)"


@kernel("UniTuple(float64, 2)(float64, float64, float64, float64)", counts=False)
def _between(start, way, low, high):
    """Return from which part of a way to which a coordinate is between two others; the first is more than the second
    where it never is.
    """
    if way == 0.0:
        return (0.0, 1.0) if low <= start <= high else (1.0, 0.0)
    a, b = (low - start) / way, (high - start) / way
    return max(0.0, min(a, b)), min(1.0, max(a, b))


@kernel(f"UniTuple(int64, 3)({_TREE}, {_BOX}, float64[:, ::1], int64[::1])", counts=False)
def _cut_edges(edges, order, nodes, box, corners, stack):
    """Write the ends of what of each edge lies within a box into the corners.

    Returns:
        How many; -1: there is no room. How often edges cross the box's lower side, and its upper one: as
        `kernels.inside` counts.
    """
    leaves, count, below, above = (len(nodes) + 1) // 2, 0, 0, 0
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
            if i < 0:  # a leaf that is not full
                break
            below += _crosses_between(edges, i, box[1], box[0], box[2])
            above += _crosses_between(edges, i, box[3], box[0], box[2])
            x, y = edges[i, 0], edges[i, 1]
            dx, dy = edges[i, 2] - x, edges[i, 3] - y
            a, b = _between(x, dx, box[0], box[2])
            c, d = _between(y, dy, box[1], box[3])
            # the part of the edge within both strips, across and upright: Liang and Barsky's clipping
            a, b = max(a, c), min(b, d)
            if a > b:
                continue
            if count + 2 > ROOM:
                return -1, 0, 0
            corners[count, 0], corners[count, 1] = x + a * dx, y + a * dy
            corners[count + 1, 0], corners[count + 1, 1] = x + b * dx, y + b * dy
            count += 2
    return count, below, above


@kernel("int64(float64[:, ::1], int64, float64, float64, float64)", counts=False)
def _crosses_between(edges, i, y, low, high):
    """Return 1 where an edge crosses a height between two places, the first included, else 0: half open, as rays are
    counted.
    """
    a, b = edges[i, 1], edges[i, 3]
    if (a <= y) == (b <= y):
        return 0
    x = edges[i, 0] + (y - a) / (b - a) * (edges[i, 2] - edges[i, 0])
    return 1 if low <= x < high else 0


@kernel(f"UniTuple(int64, 2)({_TREE}, {_BOX}, boolean, boolean[::1], float64[:, ::1], int64[::1])", counts=False)
def corners_of(edges, order, nodes, box, within, inside, corners, stack):
    """Write the corners of what of an area lies within a box.

    Only where edges are near has a corner to be asked by itself, and of two at one height only one: the other differs
    from it by how often edges cross the side between them.

    Args:
        edges, order, nodes: tree of the area's edges, even-odd.
        within: the box is known to lie in the area.
        inside: (2,) whether the lower and the upper corner on the left do, else: all edges on one line are asked at
            once, for all boxes that begin there.
        corners: (ROOM + 4, 2) room for them. stack: room for DEPTH nodes.

    Returns:
        How many; 0: nothing does, -1: there is no room. And 1 where the whole box lies in the area, else 0.
    """
    count, below, above = (0, 0, 0) if within else _cut_edges(edges, order, nodes, box, corners, stack)
    if count < 0:
        return -1, 0
    whole = count == 0
    if whole and not within and not inside[0]:
        return 0, 0
    for side in range(2):
        y, across = box[1 + 2 * side], above if side else below
        left = whole or inside[side]
        for k in range(2):
            # going from left to right along a side, each edge that is crossed changes in and out
            if left != (k == 1 and across % 2 == 1):
                corners[count, 0], corners[count, 1] = box[2 * k], y
                count += 1
    return count, int(whole)


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _nearest_between(corners, count, x, y):
    """Return how near to a place outside what lies between corners comes: the least of the ways from corner to
    corner.
    """
    least = math.inf
    for k in range(count):
        ax, ay = corners[k, 0] - x, corners[k, 1] - y
        least = min(least, ax * ax + ay * ay)
        for i in range(k):
            dx, dy = corners[i, 0] - corners[k, 0], corners[i, 1] - corners[k, 1]
            square, along = dx * dx + dy * dy, -(ax * dx + ay * dy)
            # the foot lies between both corners, so the line between them comes nearer than either
            if 0.0 < along < square:
                cross = ax * dy - ay * dx
                least = min(least, cross * cross / square)
    return math.sqrt(least)


@kernel("boolean(float64[:, ::1], int64, float64, float64, float64)", counts=False)
def _in_disc(corners, count, x, y, reach):
    """Return whether all corners lie within `reach` of a place: so do all between them."""
    for k in range(count):
        dx, dy = corners[k, 0] - x, corners[k, 1] - y
        if dx * dx + dy * dy > reach * reach:
            return False
    return True


@kernel(
    "boolean(float64[:, ::1], float64[:, ::1], int64, float64, float64[:, ::1], int64, UniTuple(float64, 4))",
    counts=False,
)
def _holds(rows, sectors, j, reach, corners, count, box):
    """Return whether a cutter along row j covers all corners, and what lies between them."""
    if rows[j, 7] == 0.0:
        farthest = 0.0
        for k in range(count):
            farthest = max(farthest, point_distance(rows, j, corners[k, 0], corners[k, 1]))
        return farthest <= reach
    if _in_disc(corners, count, rows[j, 0], rows[j, 1], reach) or _in_disc(
        corners, count, rows[j, 2], rows[j, 3], reach
    ):
        return True
    cx, cy, radius = rows[j, 4], rows[j, 5], rows[j, 6]
    dx, dy = max(box[0] - cx, cx - box[2], 0.0), max(box[1] - cy, cy - box[3], 0.0)
    inner = max(radius - reach, 0.0)
    if dx * dx + dy * dy < inner * inner and _nearest_between(corners, count, cx, cy) < inner:
        return False
    whole = sectors[j, 1] >= math.tau
    if not whole and dx == 0.0 and dy == 0.0:  # in what direction the square lies is not to be said
        return False
    first = math.atan2(corners[0, 1] - cy, corners[0, 0] - cx)
    low = high = 0.0
    for k in range(count):
        x, y = corners[k, 0] - cx, corners[k, 1] - cy
        if x * x + y * y > (radius + reach) * (radius + reach):
            return False
        if not whole:
            off = (math.atan2(y, x) - first + math.pi) % math.tau - math.pi
            low, high = min(low, off), max(high, off)
    start = (first + low - sectors[j, 0]) % math.tau
    return whole or start + high - low <= sectors[j, 1]


@kernel(
    f"void({_TREE}, {_TREE}, float64[:, ::1], float64, float64[:, ::1], float64, int64[::1], float64[::1], "
    "boolean[::1], boolean[:, ::1], uint8[::1])"
)
def judge(
    edges, edge_order, edge_nodes, rows, order, nodes, sectors, reach, centres, half, near, far, within, left, states
):
    """Write what of squares is wanted and covered.

    Args:
        edges, edge_order, edge_nodes: tree of the wanted area's edges, even-odd.
        rows, order, nodes: tree of a path's rows; arcs sweep less than pi.
        sectors: (m, 2) of the rows: from which angle, and how far round, circles are covered by them and their
            neighbours, radians.
        reach: how far from the path counts as covered, mm.
        centres: (n, 2) of the squares. half: their half side, mm.
        near, far: (n,) the row nearest to each centre, -1 for none, and how far it is, mm.
        within: (n,) True for squares that are known to be wanted as a whole; written for those that are found to be.
        left: (n, 2) of the others, whether their lower and their upper corner on the left lie in the area.
        states: (n,) OUTSIDE, COVERED, OPEN or UNCUT.
    """
    corners, stack = np.empty((ROOM + 4, 2)), np.empty(DEPTH, np.int64)
    for i in range(len(centres)):
        x, y = centres[i, 0], centres[i, 1]
        box = (x - half, y - half, x + half, y + half)
        count, whole = corners_of(edges, edge_order, edge_nodes, box, within[i], left[i], corners, stack)
        within[i] = whole == 1
        if count == 0:
            states[i] = OUTSIDE
            continue
        row = near[i] if far[i] < reach + 2.0 * half else -1
        states[i] = OPEN if row >= 0 else UNCUT
        if count < 0 or row < 0:
            continue
        for j in range(max(row - 1, 0), min(row + 2, len(rows))):
            if _holds(rows, sectors, j, reach, corners, count, box):
                states[i] = COVERED
                break
        for k in range(count):
            if (
                states[i] == OPEN
                and point_distance(rows, row, corners[k, 0], corners[k, 1]) >= reach
                and nearest(rows, order, nodes, corners[k, 0], corners[k, 1], reach)[1] < 0
            ):
                states[i] = UNCUT
