# mypy: allow-untyped-defs
"""Compiled inner loops on ground that is cut: how far a place is from it, whether all of a straight way lies on it; and
walls along a way.

Cut ground is a forest: rows of all paths, one tree of boxes after the other, as `app.geometry.kernels` builds them.
Each row knows how deep it was cut and how far the cutter reached beside it; each node the deepest and the farthest of
its rows. The last tree may have no leaves: its rows are looked at one by one. A tree's line says: its first row, how
many rows, its first node, its leaves.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from ..geometry.kernels import INF, LEAF, box_distance, enlarged, nearest_from, point_distance

_ROUNDING = 1e-9
"""mm; more than a distance is off by."""

_FOREST = "float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], int64[:, ::1]"


@kernel("float64[:, ::1](float64[:, ::1], int64[::1], int64)")
def bounds(reach, order, leaves):
    """Return (2 leaves - 1, 2) the lowest height and the largest radius of the rows below each node of a tree."""
    best = np.empty((2 * leaves - 1, 2))
    best[:, 0], best[:, 1] = INF, -INF
    for place in range(len(order)):
        k, i = leaves - 1 + place // LEAF, order[place]
        best[k, 0], best[k, 1] = min(best[k, 0], reach[i, 0]), max(best[k, 1], reach[i, 1])
    for k in range(leaves - 2, -1, -1):
        best[k, 0] = min(best[2 * k + 1, 0], best[2 * k + 2, 0])
        best[k, 1] = max(best[2 * k + 1, 1], best[2 * k + 2, 1])
    return best


@kernel(f"Tuple((float64, int64))({_FOREST}, float64, float64, float64, float64, float64)")
def beyond(rows, reach, order, nodes, best, trees, x, y, z, enough, limit):
    """Return how far a place is from ground cut down to z or deeper, mm, negative within it, and by which row; (limit,
    -1): no nearer.

    It is looked for no longer when something at or below `enough` is found.
    """
    least, row = limit, -1
    stack = np.empty(64, np.int64)
    for t in range(len(trees)):
        first, count, node, leaves = trees[t]
        if leaves == 0:
            for j in range(first, first + count):
                if reach[j, 0] <= z:
                    gap = point_distance(rows, j, x, y) - reach[j, 1]
                    if gap < least:
                        least, row = gap, j
            if least <= enough:
                return least, row
            continue
        stack[0], top = 0, 1
        while top > 0:
            top -= 1
            k = stack[top]
            if best[node + k, 0] > z or box_distance(nodes, node + k, x, y) - best[node + k, 1] >= least:
                continue
            if k < leaves - 1:
                left, right = 2 * k + 1, 2 * k + 2
                if box_distance(nodes, node + left, x, y) > box_distance(nodes, node + right, x, y):
                    left, right = right, left
                stack[top], stack[top + 1] = right, left
                top += 2
                continue
            begin = (k - leaves + 1) * LEAF
            for place in range(begin, min(begin + LEAF, count)):
                j = first + order[first + place]
                if reach[j, 0] <= z:
                    gap = point_distance(rows, j, x, y) - reach[j, 1]
                    if gap < least:
                        least, row = gap, j
            if least <= enough:
                return least, row
    return least, row


@kernel(f"boolean({_FOREST}, float64[::1], float64, float64, float64, int64, float64[::1])")
def covers(rows, reach, order, nodes, best, trees, way, radius, z, slack, budget, witness):
    """Return whether a disc that goes straight from (way[0], way[1]) to (way[2], way[3]) stays on ground cut down to z,
    within `slack`.

    Squares along the way: one whose centre is farther inside than its corners are away is on it; what is not decided is
    divided in four. Behind an end at which the disc lies within one cut's reach all is on it, however the edges touch.

    Args:
        radius: of the disc, mm, > 0.
        budget: squares that are looked at before it is taken not to be.
        witness: (2,) where a place is written that is not cut and on the disc's way, if one is found.
    """
    ax, ay = way[0], way[1]
    length = math.hypot(way[2] - ax, way[3] - ay)
    ux, uy = ((way[2] - ax) / length, (way[3] - ay) / length) if length > 0.0 else (1.0, 0.0)
    inside = slack - radius
    at_start = beyond(rows, reach, order, nodes, best, trees, ax, ay, z, inside, inside + 1e-9)[0] <= inside
    if length == 0.0 and at_start:
        return True
    at_end = beyond(rows, reach, order, nodes, best, trees, way[2], way[3], z, inside, inside + 1e-9)[0] <= inside
    first, last = 0, math.ceil(length / (2.0 * radius)) + 1
    squares = np.empty((last + 64, 3))  # large ones first: the first place that is not cut decides
    for k in range(last):
        squares[k, 0], squares[k, 1], squares[k, 2] = 2.0 * radius * k, 0.0, radius
    while first < last:
        u, v, half = squares[first]
        first += 1
        # half a diagonal: no point of the square is farther from its centre
        q = half * 1.4142135623730951
        off = math.hypot(max(0.0, -u, u - length), v)
        if off - q >= radius or (at_start and u + half <= 0.0) or (at_end and u - half >= length):
            continue
        budget -= 1
        if budget < 0:
            return False
        x, y = ax + ux * u - uy * v, ay + uy * u + ux * v
        gap = beyond(rows, reach, order, nodes, best, trees, x, y, z, slack - q, slack + 1e-9)[0]
        # distance changes by no more than the way gone, so all of the square is cut
        if gap + q <= slack:
            continue
        if gap > slack and off < radius:
            witness[0], witness[1] = x, y
            return False
        if q <= slack / 2.0:
            return False
        half /= 2.0
        if last + 4 > len(squares):
            squares = enlarged(squares, last, 2 * len(squares))
        for c in range(4):
            squares[last, 0] = u + (half if c % 2 else -half)
            squares[last, 1] = v + (half if c // 2 else -half)
            squares[last, 2] = half
            last += 1
    return True


@kernel(f"int64({_FOREST}, float64[:, ::1], int64, float64, float64, float64, int64)")
def covered_after(rows, reach, order, nodes, best, trees, places, begin, radius, z, slack, budget):
    """Return the first of some places (m, 2) from number `begin` on at which a disc stays on cut ground, as `covers`;
    -1: at none.

    A place that was found not to be cut is under the disc at many of the next places too: these are not looked at.
    """
    way, witness = np.empty(4), np.full(2, INF)
    for k in range(begin, len(places)):
        if math.hypot(places[k, 0] - witness[0], places[k, 1] - witness[1]) < radius - _ROUNDING:
            continue
        way[0] = way[2] = places[k, 0]
        way[1] = way[3] = places[k, 1]
        if covers(rows, reach, order, nodes, best, trees, way, radius, z, slack, budget, witness):
            return k
    return -1


@kernel("boolean(float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64, float64, int64)")
def keeps_off(rows, order, nodes, way, distance, slack, budget):
    """Return whether a straight way keeps `distance` - `slack` from all rows of a tree.

    Distance changes by no more than the length gone, so a step as long as there is to spare passes nothing unseen.

    Args:
        budget: steps after which it is taken not to.
    """
    ax, ay = way[0], way[1]
    dx, dy = way[2] - ax, way[3] - ay
    length = math.hypot(dx, dy)
    at, limit, near = 0.0, distance + length + _ROUNDING, -1  # with as much to spare one step goes all the way
    for _ in range(budget):
        part = at / length if length > 0.0 else 0.0
        away, near = nearest_from(rows, order, nodes, ax + dx * part, ay + dy * part, -1.0, limit, near)
        spare = away - (distance - slack)
        if spare < slack / 2.0:
            return False
        if at >= length:
            return True
        step = min(spare, length - at)
        limit = spare + (distance - slack) + step + _ROUNDING
        at = min(at + spare, length)
    return False
