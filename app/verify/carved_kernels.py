# mypy: allow-untyped-defs
"""Compiled: the largest empty discs behind places of walls, and what the best motion of a cone leaves of each."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from ..geometry.kernels import DEPTH, INF, LEAF, box_distance, in_sector, nearest_from

_SHRINKS = 12
"""How often a disc is made smaller by the wall that reaches into it, before it is bisected."""
_HALVINGS = 44
"""Of a radius: to the last digits of the largest one."""
_TREE = "int64[::1], float64[:, ::1]"


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, float64, float64)", counts=False)
def _nearest_place(rows, j, x, y):
    """Return the place of row j that is nearest to a point."""
    ax, ay = x - rows[j, 0], y - rows[j, 1]
    if rows[j, 7] == 0.0:
        dx, dy = rows[j, 2] - rows[j, 0], rows[j, 3] - rows[j, 1]
        square = dx * dx + dy * dy
        share = min(max((ax * dx + ay * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
        return rows[j, 0] + dx * share, rows[j, 1] + dy * share
    vx, vy = x - rows[j, 4], y - rows[j, 5]
    far = math.sqrt(vx * vx + vy * vy)
    if far > 0.0 and in_sector(rows, j, x, y):
        return rows[j, 4] + vx / far * rows[j, 6], rows[j, 5] + vy / far * rows[j, 6]
    bx, by = x - rows[j, 2], y - rows[j, 3]
    if ax * ax + ay * ay <= bx * bx + by * by:
        return rows[j, 0], rows[j, 1]
    return rows[j, 2], rows[j, 3]


@kernel("float64(float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _through(px, py, nx, ny, x, y, most):
    """Return the radius of the disc that touches a wall at p, its normal n, and goes through a place; `most` where
    that is behind the wall, or where the disc is larger.
    """
    dx, dy = x - px, y - py
    ahead = dx * nx + dy * ny
    # |p + r n - q| = r, solved for r
    return min((dx * dx + dy * dy) / (2.0 * ahead), most) if ahead > 0.0 else most


@kernel(f"void(float64[:, ::1], {_TREE}, float64[:, ::1], float64[:, ::1], float64, float64, float64[::1])")
def largest_empty(rows, order, nodes, feet, normals, most, slack, found):
    """Write the radius of the largest disc behind each foot that holds no wall, up to so many mm.

    None that is empty is larger than the one through the foot and any place of a wall. So the place that is nearest to
    a disc's centre makes it smaller until it is empty; the first such place is the one that held the disc before, as
    feet follow one another. What takes longer, as where a wall bends as much as the disc, is found by halving: a
    smaller disc in an empty one is empty.

    Args:
        feet, normals: (k, 2), the normals of length 1 and into the area. slack: mm that a wall may reach into a disc.
    """
    hint, hx, hy = -1, 0.0, 0.0
    for k in range(len(feet)):
        px, py, nx, ny = feet[k, 0], feet[k, 1], normals[k, 0], normals[k, 1]
        # any place of a wall gives a bound, the last disc's a good one to begin with
        radius, done = most, False
        if hint >= 0:
            radius = _through(px, py, nx, ny, hx, hy, most)
        for _ in range(_SHRINKS):
            x, y = px + nx * radius, py + ny * radius
            _, row = nearest_from(rows, order, nodes, x, y, -1.0, radius - slack, hint)
            if row < 0:
                done = True
                break
            hint = row
            hx, hy = _nearest_place(rows, row, x, y)
            radius = _through(px, py, nx, ny, hx, hy, radius)
        if not done:
            low, high = 0.0, radius
            for _ in range(_HALVINGS):
                radius = 0.5 * (low + high)
                _, row = nearest_from(
                    rows, order, nodes, px + nx * radius, py + ny * radius, -1.0, radius - slack, hint
                )
                if row < 0:
                    low = radius
                else:
                    high = radius
            radius = low
        found[k] = radius


@kernel("float64(float64[:, ::1], int64, float64, float64, float64)", counts=False)
def _left_by(motions, m, x, y, radius):
    """Return by how much the cone on motion m is too narrow for a disc, or too far from it, at its best place.

    Along the motion the distance is a root of a square and the width is linear, so the best place is where their slopes
    are alike.
    """
    ux, uy, size, first, growth = motions[m, 2], motions[m, 3], motions[m, 4], motions[m, 5], motions[m, 6]
    ox, oy = x - motions[m, 0], y - motions[m, 1]
    if size > 0.0:
        along, aside = ox * ux + oy * uy, abs(ox * uy - oy * ux)
        slope = min(max(growth / size, -1 + 1e-12), 1 - 1e-12)
        # where the slope of sqrt(along^2 + aside^2) is that of the cone's width
        share = min(max((along + aside * slope / math.sqrt(1 - slope * slope)) / size, 0.0), 1.0)
    else:
        share = 1.0 if growth > 0.0 else 0.0
    dx, dy = ox - ux * size * share, oy - uy * size * share
    return math.sqrt(dx * dx + dy * dy) + radius - first - growth * share


@kernel(f"void(float64[:, ::1], {_TREE}, float64[::1])")
def widest_below(motions, order, nodes, widest):
    """Write for each node of a tree of motions how wide the cone is at most on those below it, mm."""
    leaves = (len(nodes) + 1) // 2
    for k in range(len(nodes) - 1, -1, -1):
        if k < leaves - 1:
            widest[k] = max(widest[2 * k + 1], widest[2 * k + 2])
            continue
        widest[k] = -INF
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            m = order[place]
            widest[k] = max(widest[k], motions[m, 5], motions[m, 5] + motions[m, 6])


@kernel(
    f"void(float64[:, ::1], {_TREE}, float64[::1], float64[:, ::1], float64[::1], float64, float64, float64[::1])",
)
def least_left(motions, order, nodes, widest, centres, radius, enough, worst, left):
    """Write by how much cones are too narrow or too far from discs, mm, each by the motion that is best for it.

    A cone leaves at least the distance of its axis and the disc's radius, less its own at the surface: so much is known
    of all motions below a node. Exact for every disc of which more is left than `enough`, and for the one of which most
    is left, if that is more than `worst`; of others, of which something is found that leaves less than these, it is
    what that leaves.

    Args:
        motions: (n, 7) start x and y, direction x and y, length, width at the start and how much wider the end is, mm.
        widest: of `widest_below`. centres, radius: (m, 2) and (m,) of the discs; those that follow one another lie
            side by side, or it takes longer.
    """
    leaves, stack, bounds = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty(DEPTH)
    hint = 0
    for d in range(len(radius)):
        x, y, r = centres[d, 0], centres[d, 1], radius[d]
        stop, best = min(enough, worst), INF
        for m in range(max(hint - 1, 0), min(hint + 2, len(motions))):
            value = _left_by(motions, m, x, y, r)
            if value < best:
                best, hint = value, m
        stack[0], bounds[0], top = 0, -INF, 1
        while top > 0 and best > stop:
            top -= 1
            k = stack[top]
            if bounds[top] >= best:
                continue
            if k < leaves - 1:
                one, other = 2 * k + 1, 2 * k + 2
                by_one = r - widest[one] + box_distance(nodes, one, x, y)
                by_other = r - widest[other] + box_distance(nodes, other, x, y)
                # the one that may leave less comes on top and is looked at first: it closes the other one sooner
                if by_one < by_other:
                    one, other, by_one, by_other = other, one, by_other, by_one
                if by_one < best:
                    stack[top], bounds[top] = one, by_one
                    top += 1
                if by_other < best:
                    stack[top], bounds[top] = other, by_other
                    top += 1
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                value = _left_by(motions, order[place], x, y, r)
                if value < best:
                    best, hint = value, order[place]
        left[d] = best
        worst = max(worst, best)
