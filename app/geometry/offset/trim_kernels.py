# mypy: allow-untyped-defs
"""Compiled inner loops of the exact offset: the parts of elements that nothing comes nearer to than the level.

A feature that is not the nearest one of some point at a level is never again nearest beyond it, so the fractions that
are left at one level bound those of every higher one.

What can block is found by a bound that is exact to the second order. The distance from a box is a convex function, so
along a piece it lies above its tangent at the piece's middle; only rows that this bound does not rule out are cut
with, a handful where walls run side by side, however many are within reach.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import DEPTH, LEAF, enlarged, point_distance
from .offset_kernels import SHORTEST, block, cut, element, length_of, push
from .tree_kernels import tree_over

ROWS = "float64[:, ::1], float64[:, ::1]"
TREE = "int64[::1], float64[:, ::1], float64[:, ::1]"
MANY = 24  # rows that may block; with more the piece is halved
SHORT = 1e-3  # mm; a piece this short is not halved


@kernel("void(float64[::1], float64, float64, float64[::1])", counts=False)
def probe_piece(shape, u0, u1, probe):
    """Write what `misses` asks of the piece [u0, u1] of an element.

    probe: middle x, y; direction x, y; outward normal x, y (0 for a line); how far the piece goes along the direction,
    against the normal, and from the middle; [9] is the level, which the caller sets.
    """
    u = (u0 + u1) / 2
    if shape[0] == 0.0:
        dx, dy, half = (shape[3] - shape[1]), (shape[4] - shape[2]), shape[5] * (u1 - u0) / 2
        probe[0], probe[1] = shape[1] + u * dx, shape[2] + u * dy
        probe[2], probe[3] = dx / shape[5], dy / shape[5]
        probe[4], probe[5], probe[6], probe[7], probe[8] = 0.0, 0.0, half, 0.0, half
        return
    angle, r = shape[4] + u * shape[5], shape[3]
    half = min(abs(shape[5]) * (u1 - u0) / 2, math.pi)
    c, s = math.cos(angle), math.sin(angle)
    probe[0], probe[1] = shape[1] + r * c, shape[2] + r * s
    probe[2], probe[3], probe[4], probe[5] = -s, c, c, s
    sine = math.sin(half / 2)
    probe[6] = r * (math.sin(half) if half < math.pi / 2 else 1.0)
    probe[7], probe[8] = 2 * r * sine * sine, 2 * r * sine


@kernel("boolean(float64, float64, float64[::1])", counts=False)
def _clear(dx, dy, probe):
    """Return whether a convex thing whose point nearest to the piece's middle lies at (dx, dy) from it stays as far as
    the level.
    """
    d2, level = dx * dx + dy * dy, probe[9]
    if d2 >= (level + probe[8]) * (level + probe[8]):
        return True
    if d2 <= level * level:
        return False
    # the tangent of the distance at the middle, times the farthest that the piece goes each way: d2 and level are both
    # times d
    fall = abs(dx * probe[2] + dy * probe[3]) * probe[6] + max(-(dx * probe[4] + dy * probe[5]), 0.0) * probe[7]
    return d2 - fall >= level * math.sqrt(d2)


@kernel("boolean(float64[:, ::1], int64, float64[::1])", counts=False)
def misses(boxes, k, probe):
    """Return whether all of box k is at least as far from all of a piece as the level."""
    x, y = probe[0], probe[1]
    dx = boxes[k, 0] - x if x < boxes[k, 0] else min(boxes[k, 2] - x, 0.0)
    dy = boxes[k, 1] - y if y < boxes[k, 1] else min(boxes[k, 3] - y, 0.0)
    return _clear(dx, dy, probe)


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, float64, float64)", counts=False)
def _to_line(rows, j, x, y):
    """Return the way from a point to the nearest point of the line that row j's first four numbers tell."""
    ax, ay = rows[j, 0] - x, rows[j, 1] - y
    ux, uy = rows[j, 2] - rows[j, 0], rows[j, 3] - rows[j, 1]
    length2, along = ux * ux + uy * uy, -(ax * ux + ay * uy)
    t = 0.0 if along <= 0.0 else (1.0 if along >= length2 else along / length2)
    return ax + t * ux, ay + t * uy


@kernel("boolean(float64[:, ::1], int64, float64[::1])", counts=False)
def misses_capsule(capsules, leaf, probe):
    """Return whether all rows of a leaf are at least as far from all of a piece as the level."""
    dx, dy = _to_line(capsules, leaf, probe[0], probe[1])
    d = math.sqrt(dx * dx + dy * dy)
    left = d - capsules[leaf, 4]
    if left <= probe[9]:
        return False
    if left >= probe[9] + probe[8]:
        return True
    fall = abs(dx * probe[2] + dy * probe[3]) * probe[6] + max(-(dx * probe[4] + dy * probe[5]), 0.0) * probe[7]
    return left - fall / d >= probe[9]


@kernel("boolean(float64[:, ::1], float64[:, ::1], int64, float64[::1])", counts=False)
def misses_row(rows, boxes, j, probe):
    """Return whether row j is at least as far from all of a piece as the level, as far as its nearest point tells, or
    its box.
    """
    if rows[j, 7] != 0.0:
        return misses(boxes, j, probe)
    dx, dy = _to_line(rows, j, probe[0], probe[1])
    return _clear(dx, dy, probe)


@kernel("int64(float64[:, ::1], int64, float64[::1])", counts=False)
def _blocks_middle(rows, j, probe):
    """Return -1 - 2 j when row j comes nearer than the level all along a piece, -2 - 2 j when at its middle at least,
    else 0.
    """
    d = point_distance(rows, j, probe[0], probe[1])
    if d >= probe[9]:
        return 0
    return -1 - 2 * j if d < probe[9] - probe[8] else -2 - 2 * j


@kernel(f"int64({ROWS}, {TREE}, int64, float64[::1], int64[::1], int64[::1], int64)", counts=False)
def candidates(rows, boxes, order, nodes, capsules, own, probe, near, stack, first_guess):
    """Write the rows that may come nearer to a piece than the level; return how many.

    As soon as one row j is found that does so at the piece's middle, -1 - 2 j or -2 - 2 j is returned, see
    `_blocks_middle`. The row that blocked the last piece is a good first guess (-1: none), as neighbours come one after
    the other.
    """
    leaves, count = (len(nodes) + 1) // 2, 0
    if first_guess >= 0 and first_guess != own:
        answer = _blocks_middle(rows, first_guess, probe)
        if answer < 0:
            return answer
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if misses(nodes, k, probe):
            continue
        if k < leaves - 1:
            # the child whose middle is nearer first: what blocks is found soon, and ends the search
            x, y = 2 * probe[0], 2 * probe[1]
            left = abs(nodes[2 * k + 1, 0] + nodes[2 * k + 1, 2] - x) + abs(
                nodes[2 * k + 1, 1] + nodes[2 * k + 1, 3] - y
            )
            right = abs(nodes[2 * k + 2, 0] + nodes[2 * k + 2, 2] - x) + abs(
                nodes[2 * k + 2, 1] + nodes[2 * k + 2, 3] - y
            )
            nearer = 1 if left < right else 2
            stack[top], stack[top + 1] = 2 * k + 3 - nearer, 2 * k + nearer
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        if misses_capsule(capsules, k - leaves + 1, probe):
            continue
        for at in range(first, first + LEAF):
            j = order[at]
            if j < 0:
                break
            if j == own or misses_row(rows, boxes, j, probe):
                continue
            answer = _blocks_middle(rows, j, probe)
            if answer < 0:
                return answer
            near[count] = j
            count += 1
    return count


@kernel("int64(float64[::1], float64[:, ::1], int64, float64[::1], float64[::1], float64[:, ::1], int64)", counts=False)
def _split_off(shape, rows, j, span, cuts, spans, top):
    """Push what lies before and after the part about the piece's middle to which row j comes nearer; set the span to
    that part.
    """
    middle = (span[0] + span[1]) / 2
    m = cut(shape, rows, j, span[2], span[0], span[1], cuts)
    k = 0
    while k < m - 2 and cuts[k + 1] <= middle:
        k += 1
    # the shorter one comes next, so there is never more than half left of each
    before = cuts[k] - span[0] < span[1] - cuts[k + 1]
    for c in range(2):
        a, b = (span[0], cuts[k]) if before == (c == 1) else (cuts[k + 1], span[1])
        if b > a:
            spans[top, 0], spans[top, 1] = a, b
            top += 1
    span[0], span[1] = cuts[k], cuts[k + 1]
    return top


@kernel("Tuple((float64[:, ::1], int64))(float64[:, ::1], int64, int64, float64[::1], float64[:, ::1], int64)")
def _keep_rest(blocked, blocks, e, limits, pieces, count):
    """Append what is left of an element's piece after taking the blocked parts out. limits: u0, u1, shortest
    fraction.
    """
    at = limits[0]
    for k in range(blocks + 1):
        # parts come sorted and may overlap: what lies before the next one and behind all so far is free
        begin, end = (blocked[k, 0], blocked[k, 1]) if k < blocks else (limits[1], limits[1])
        if begin - at > limits[2]:
            if count == len(pieces):
                pieces = enlarged(pieces, count, 2 * count)
            pieces[count, 0], pieces[count, 1], pieces[count, 2] = e, at, begin
            count += 1
        at = max(at, end)
    return pieces, count


@kernel(f"float64[:, ::1]({ROWS}, {TREE}, float64[:, ::1], float64[:, ::1], float64, float64)")
def trim(rows, boxes, order, nodes, capsules, angles, active, level, slack):
    """Return the pieces (m, 3; element, u0, u1) of a level that no row comes nearer to than the level - slack.

    Args:
        boxes: of all rows. order, nodes, capsules: the tree of those that may block.
        active: (k, 3) pieces of a lower level, in which those of this one lie.
    """
    pieces, count, blocker = np.empty((len(active) + 16, 3)), 0, -1
    shape, probe, limits, span, cuts = np.empty(6), np.empty(10), np.empty(3), np.empty(4), np.empty(16)
    near, stack = np.empty(len(order), np.int64), np.empty(DEPTH, np.int64)
    spans, blocked = np.empty((2 * DEPTH, 2)), np.empty((16, 2))
    probe[9] = span[3] = level - slack
    span[2] = level
    for a in range(len(active)):
        e, limits[0], limits[1] = int(active[a, 0]), active[a, 1], active[a, 2]
        if not element(rows, angles, e, level, shape):
            continue
        length = length_of(shape)
        limits[2] = SHORTEST / max(length, SHORTEST)
        spans[0, 0], spans[0, 1], top, blocks = limits[0], limits[1], 1, 0
        while top > 0:
            top -= 1
            span[0], span[1] = spans[top, 0], spans[top, 1]
            probe_piece(shape, span[0], span[1], probe)
            found = candidates(rows, boxes, order, nodes, capsules, e, probe, near, stack, blocker)
            if found < 0:
                blocker = (-1 - found) // 2
                if found == -2 - 2 * blocker:
                    top = _split_off(shape, rows, blocker, span, cuts, spans, top)
                blocked, blocks = push(blocked, blocks, span[0], span[1])
            elif found > MANY and (span[1] - span[0]) * length > SHORT:
                middle = (span[0] + span[1]) / 2
                spans[top, 0], spans[top, 1], spans[top + 1, 0], spans[top + 1, 1] = middle, span[1], span[0], middle
                top += 2
            else:
                for c in range(found):
                    blocked, blocks = block(blocked, blocks, shape, rows, near[c], span, cuts)
        pieces, count = _keep_rest(blocked, blocks, e, limits, pieces, count)
    return pieces[:count]


@kernel(f"Tuple(({TREE}))({ROWS}, {TREE}, float64[::1], float64)")
def blockers(rows, boxes, order, nodes, capsules, live, level):
    """Return a tree of those rows of a tree that are live at a level; the tree itself while that is most of its leaves.

    live: (n,) the highest level at which each row is known to be nearest to some point, mm.
    """
    left, count = np.empty(len(order), np.int64), 0
    for first in range(0, len(order), LEAF):
        at = count
        for j in order[first : first + LEAF]:
            if j >= 0 and live[j] >= level:
                left[at] = j
                at += 1
        if at > count:
            left[at : count + LEAF] = -1
            count += LEAF
    if 4 * count > 3 * len(order):
        return order, nodes, capsules
    nodes, capsules = tree_over(rows, boxes, left[:count])
    return left[:count], nodes, capsules
