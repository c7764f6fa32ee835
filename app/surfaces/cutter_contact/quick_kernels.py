# mypy: allow-untyped-defs
"""Compiled: how low a cutter comes over surfaces, quickly: exact where it touches, but other places are looked at by
their facets.

A facet's own height is taken for about that of what it stands for. What that could miss is less than facets are off;
whoever needs certainty asks `chord_kernels`, which bound what the true surfaces can do.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..patches.patch_kernels import copy_row, quarter
from .contact_kernels import CONE, DISC, over_triangle
from .drop_kernels import bound, open_node
from .facet_tree_kernels import (
    ANY,
    BOUNDS,
    BOXES,
    CONTROL,
    CORNERS,
    DESK,
    ERROR,
    HEIGHTS,
    HIGHEST,
    LAST,
    LEAF,
    LIKELY,
    NODES,
    NONE,
    OFF,
    OWNER,
    PATCH,
    QUARTERS,
    ROOM,
    TREE,
    TRIANGLES,
    WHICH,
    WORK,
    lay,
    put_quarters,
)
from .touch_kernels import touch

_R = "float64[::1]"
_TIMES, _MANY_FACETS = 40, 8
"""So often is a facet quartered, and so many facets are, for one place."""
_LEAN = 50.0
"""Steeper triangles count as of so much: what an upright one stands for is off upwards by any length."""
_AROUND = 2.5
"""Facets within so many of their sizes of a touched place have nothing else to say."""


@kernel(f"float64({_R})", counts=False)
def _lean(t):
    """Return how much more a triangle (9,) is off upwards than across, at most _LEAN."""
    ux, uy, uz, vx, vy, vz = t[3] - t[0], t[4] - t[1], t[5] - t[2], t[6] - t[0], t[7] - t[1], t[8] - t[2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    size = math.sqrt(x * x + y * y + z * z)
    # What is off by e square to a triangle is off by e / cos(slope) upwards, and nz / size is that cosine.
    return size / max(abs(z), size / _LEAN) if size > 0.0 else _LEAN


@kernel(f"UniTuple(float64, 3)({TREE}, int64, float64, float64, {_R}, float64, float64, float64, {DESK})", counts=False)
def _refined(tree, n, x, y, shape, known, fine, care, desk):
    """Return the tip's height over what a facet stands for, `known` where that is not less, and where it touches."""
    work = desk[WORK]
    lay(tree, n, work)
    depth, best, times, best_u, best_v = 2, known, 0, math.nan, math.nan
    while depth > 1 and times < _TIMES:
        depth -= 1
        if work[depth, HIGHEST] <= best:
            continue
        copy_row(work, depth, LAST)
        times += 1
        error = 0.25 * work[LAST, OFF]
        quarter(tree[CONTROL], tree[PATCH][n], work, LAST, QUARTERS)
        for k in range(QUARTERS, ROOM):
            low = over_triangle(work[k, :9], x, y, shape, -math.inf)
            if low > best and error <= fine:
                best = low
                best_u = (work[k, 9] + work[k, 11] + work[k, 13]) / 3.0
                best_v = (work[k, 10] + work[k, 12] + work[k, 14]) / 3.0
            # By its own facet, so probably and not surely: `care` is `_lean`, which holds for the facet as a whole.
            work[k, OFF], work[k, HIGHEST] = error, low + care * error
        if error > fine:
            depth = put_quarters(work, depth, best)
    return best, best_u, best_v


@kernel(f"float64({TREE}, int64)", counts=False)
def _off(tree, n):
    """Return how far the tip over a facet may be from that over what it stands for."""
    return tree[ERROR][n] * _lean(tree[TRIANGLES][n]) if tree[PATCH][n] >= 0 else 0.0


@kernel(f"int64({DESK}, int64, int64, float64)", counts=False)
def _remember(desk, count, n, low):
    """Put a facet among those that may be touched, the highest first; return how many they are."""
    which, heights = desk[WHICH], desk[HEIGHTS]
    at = min(count, LIKELY - 1)
    if at < count and heights[at] >= low:
        return count
    # Sorted by insertion, since there are few; when all places are taken the lowest falls out.
    while at > 0 and heights[at - 1] < low:
        heights[at], which[at] = heights[at - 1], which[at - 1]
        at -= 1
    heights[at], which[at] = low, n
    return min(count + 1, LIKELY)


@kernel(f"int64({TREE}, {_R}, float64, float64, int64, float64, float64, {DESK})", counts=False)
def _likely(tree, shape, x, y, whose, slack, known, desk):
    """Set the facets that may be touched and their own heights, the highest first; return how many."""
    boxes, triangles, nodes, bounds = tree[BOXES], tree[TRIANGLES], desk[NODES], desk[BOUNDS]
    inner = len(boxes) // 2
    best, depth, count = known, 1, 0
    nodes[0], bounds[0] = 0, bound(boxes, 0, x, y, shape, known - slack)
    while depth > 0:
        depth -= 1
        node = nodes[depth]
        lean = slack * math.sqrt(1.0 + boxes[node, 5] * boxes[node, 5] + boxes[node, 6] * boxes[node, 6])
        if bounds[depth] <= best - lean:
            continue
        if node < inner:
            depth = open_node(boxes, node, x, y, shape, best - lean, nodes, bounds, depth)
            continue
        start = (node - inner) * tree[LEAF]
        for n in range(start, min(start + tree[LEAF], len(triangles))):
            if whose != ANY and tree[OWNER][n] != whose:
                continue
            low = over_triangle(triangles[n], x, y, shape, best - lean)
            if low == -math.inf:
                continue
            off = _off(tree, n)
            # `best` is what a facet gives at least; one that cannot come up to it is not touched.
            if low + off <= best:
                continue
            best = max(best, low - off)
            count = _remember(desk, count, n, low)
            while count > 1 and desk[HEIGHTS][count - 1] + _off(tree, desk[WHICH][count - 1]) < best:
                count -= 1
    return count


@kernel(f"UniTuple(float64, 2)({TREE}, int64)", counts=False)
def _middle(tree, n):
    """Return the parameters in the middle of a facet."""
    c = tree[CORNERS][n]
    return (c[0] + c[2] + c[4]) / 3.0, (c[1] + c[3] + c[5]) / 3.0


@kernel(f"boolean({TREE}, int64, float64, float64)", counts=False)
def _around(tree, n, u, v):
    """Return whether a facet lies round a place of its patch."""
    c, (mid_u, mid_v) = tree[CORNERS][n], _middle(tree, n)
    wide = abs(c[0] - mid_u) + abs(c[2] - mid_u) + abs(c[4] - mid_u)
    high = abs(c[1] - mid_v) + abs(c[3] - mid_v) + abs(c[5] - mid_v)
    return abs(mid_u - u) <= _AROUND * wide and abs(mid_v - v) <= _AROUND * high


@kernel(f"void({TREE}, {_R}, int64, float64, float64, {_R}, {DESK})", counts=False)
def quick_one(tree, shape, whose, slack, fine, found, desk):
    """Drop a cutter at one place.

    Args:
        whose: owner of the facets that count, or ANY. slack: no facet is farther off than this, mm.
        found: (6,) x and y; out: the tip's height, -inf where nothing is in reach; the facet that it touches, NONE
            where none, and the place on its patch. A facet and a place that go in are touched nearby, which makes it
            quicker.
    """
    x, y = found[0], found[1]
    best, touched, best_u, best_v = -math.inf, NONE, math.nan, math.nan
    # Not a number is unequal to itself: the comparison asks whether a place on the patch is known.
    if found[3] >= 0.0 and found[4] == found[4]:
        n = int(found[3])
        tip, u, v = touch(tree[CONTROL], tree[PATCH][n], found[4], found[5], x, y, shape)
        if tip > best:
            best, touched, best_u, best_v = tip, n, u, v
    count = _likely(tree, shape, x, y, whose, slack, best, desk)
    ball, refined = shape[DISC] == 0.0 and shape[CONE] == 0.0, 0
    for k in range(count):
        n, own = desk[WHICH][k], desk[HEIGHTS][k]
        most = _off(tree, n)
        if own + most <= best:
            continue
        if tree[PATCH][n] < 0 or (tree[ERROR][n] <= fine and not ball):
            if own > best:
                best, touched, best_u, best_v = own, n, math.nan, math.nan
            continue
        if ball:
            same = touched >= 0 and best_u == best_u and tree[PATCH][touched] == tree[PATCH][n]
            if same and best >= own - most and _around(tree, n, best_u, best_v):
                continue
            u, v = _middle(tree, n)
            tip, u, v = touch(tree[CONTROL], tree[PATCH][n], u, v, x, y, shape)
            # Lower than the facet is for sure, Newton has led astray, and the facet is quartered instead.
            if tip >= own - most:
                if tip > best:
                    best, touched, best_u, best_v = tip, n, u, v
                continue
        if refined == _MANY_FACETS:
            continue
        refined += 1
        tip, u, v = _refined(tree, n, x, y, shape, best, fine, _lean(tree[TRIANGLES][n]), desk)
        if tip > best:
            best, touched, best_u, best_v = tip, n, u, v
    # it may be touched beside a facet's own edges
    if not ball and shape[CONE] == 0.0 and refined > 0 and best_u == best_u:
        tip, u, v = touch(tree[CONTROL], tree[PATCH][touched], best_u, best_v, x, y, shape)
        if tip > best:
            best, best_u, best_v = tip, u, v
    found[2], found[3], found[4], found[5] = best, touched, best_u, best_v
