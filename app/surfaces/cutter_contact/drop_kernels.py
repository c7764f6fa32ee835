# mypy: allow-untyped-defs
"""Compiled: how low a cutter comes over facets and over what they stand for.

No place of a surface is farther from its facet than the facet's error. So a cutter with a skin of that error, over the
facet, comes no lower than the cutter itself over the surface: that bounds what a facet can do. Where it could do
something, it is quartered, its corners taken anew on the surface, and each quarter is four times as near; the highest
first, so that the others are soon out of question.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..patches.patch_kernels import copy_row, quarter
from .contact_kernels import RADIUS, contact, height, length, over_triangle, rise, thicken
from .facet_tree_kernels import (
    ANY,
    BOUNDS,
    BOXES,
    CONTROL,
    DESK,
    ERROR,
    HIGHEST,
    LAST,
    LEAF,
    NODES,
    NONE,
    OFF,
    OWNER,
    PATCH,
    QUARTERS,
    ROOM,
    SHAPES,
    TREE,
    TRIANGLES,
    WORK,
    lay,
    new_desk,
    put_quarters,
)

_R, _MANY, _INTS = "float64[::1]", "float64[:, ::1]", "int64[::1]"
_MOST = 400
"""So often is one facet quartered for one place; where a cutter lies on a surface all along, there is no end to it."""
_RIM = 1.0 - 1e-9
"""Of the radius: farther out a profile may be too steep to be told by its slope."""


@kernel(f"float64({_MANY}, int64, float64, float64, {_R}, float64)", counts=False)
def bound(boxes, node, x, y, shape, known):
    """Return what the tip comes down to at most over what a node holds; -inf where that is out of reach or not above
    `known`.

    Under a node's plane the tip's height, as a function of the place that is touched, is concave. So from any place of
    the box it rises to no other by more than its slope at that place says: it is asked at the one that the plane would
    be touched at.
    """
    radius = shape[RADIUS]
    r = length(
        max(max(boxes[node, 0] - x, x - boxes[node, 2]), 0.0), max(max(boxes[node, 1] - y, y - boxes[node, 3]), 0.0)
    )
    # r: from the axis to the nearest place of the box seen from above.
    if r > radius:
        return -math.inf
    top = boxes[node, 4] - height(r, shape)
    if top <= known:
        return -math.inf
    east, north = boxes[node, 5], boxes[node, 6]
    steep = length(east, north)
    far = contact(steep, shape) / steep if steep > 0.0 else 0.0
    at_x = min(max(x + far * east, boxes[node, 0]), boxes[node, 2])
    at_y = min(max(y + far * north, boxes[node, 1]), boxes[node, 3])
    r = length(at_x - x, at_y - y)
    # At a ball's rim the profile stands upright and has no slope to bound by.
    if r >= radius * _RIM:
        return top
    over = boxes[node, 7] + east * at_x + north * at_y - height(r, shape)
    if r > 0.0:
        back = rise(r, shape) / r
        east, north = east - back * (at_x - x), north - back * (at_y - y)
    over += max(east * (boxes[node, 0] - at_x), east * (boxes[node, 2] - at_x))
    over += max(north * (boxes[node, 1] - at_y), north * (boxes[node, 3] - at_y))
    return min(top, over) if min(top, over) > known else -math.inf


@kernel(f"int64({_MANY}, int64, float64, float64, {_R}, float64, {_INTS}, {_R}, int64)", counts=False)
def open_node(boxes, node, x, y, shape, known, nodes, bounds, depth):
    """Put the children of a node that could be above `known` on the stack, the higher one last; return how deep it
    is.
    """
    one = bound(boxes, 2 * node + 1, x, y, shape, known)
    other = bound(boxes, 2 * node + 2, x, y, shape, known)
    near = 1 if one >= other else 2
    # The higher one is opened first: what it finds rules out most of what waits below it.
    if min(one, other) > known:
        nodes[depth], bounds[depth] = 2 * node + 3 - near, min(one, other)
        depth += 1
    if max(one, other) > known:
        nodes[depth], bounds[depth] = 2 * node + near, max(one, other)
        depth += 1
    return depth


@kernel(f"float64({TREE}, int64, float64, float64, {_R}, float64, float64, {DESK})", counts=False)
def over_facet(tree, n, x, y, shape, known, fine, desk):
    """Return how low the tip comes at (x, y) over what a facet stands for; `known` where that is not less.

    Args:
        fine: parts as near to their facets as this are taken for them, mm.
    """
    work, wide, error = desk[WORK], desk[SHAPES][1], tree[ERROR][n]
    thicken(shape, error, wide)
    if over_triangle(tree[TRIANGLES][n], x, y, wide, known - error) + error <= known:
        return known
    lay(tree, n, work)
    depth, best, times = 2, known, 0
    # `best` is reached, HIGHEST is never exceeded: a row whose HIGHEST is no more than `best` is done with.
    while depth > 1:
        depth -= 1
        if work[depth, HIGHEST] <= best:
            continue
        copy_row(work, depth, LAST)
        error = work[LAST, OFF]
        if error <= fine or times >= _MOST:
            best = max(best, over_triangle(work[LAST, :9], x, y, shape, best))
            continue
        times += 1
        quarter(tree[CONTROL], tree[PATCH][n], work, LAST, QUARTERS)
        # A smooth surface is off its chord by the square of the chord's length: half the length, a quarter of the
        # error.
        error *= 0.25
        thicken(shape, error, wide)
        for k in range(QUARTERS, ROOM):
            work[k, OFF] = error
            work[k, HIGHEST] = over_triangle(work[k, :9], x, y, wide, best - error) + error
        depth = put_quarters(work, depth, best)
    return best


@kernel(f"Tuple((float64, int64))({TREE}, {_R}, float64, float64, int64, float64, {DESK})", counts=False)
def drop_one(tree, shape, x, y, whose, fine, desk):
    """Return the tip's height at (x, y) and the facet that it touches, NONE and -inf where nothing is in reach.

    Args:
        whose: owner of the facets that count, or ANY. fine: see `over_facet`.
    """
    boxes, triangles, error, nodes, bounds = tree[BOXES], tree[TRIANGLES], tree[ERROR], desk[NODES], desk[BOUNDS]
    inner = len(boxes) // 2
    best, which, depth = -math.inf, NONE, 1
    nodes[0], bounds[0] = 0, bound(boxes, 0, x, y, shape, -math.inf)
    while depth > 0:
        depth -= 1
        node = nodes[depth]
        if bounds[depth] <= best:
            continue
        if node >= inner:
            start = (node - inner) * tree[LEAF]
            for n in range(start, min(start + tree[LEAF], len(triangles))):
                if whose != ANY and tree[OWNER][n] != whose:
                    continue
                if error[n] <= fine or tree[PATCH][n] < 0:
                    low = over_triangle(triangles[n], x, y, shape, best)
                else:
                    low = over_facet(tree, n, x, y, shape, best, fine, desk)
                if low > best:
                    best, which = low, n
            continue
        depth = open_node(boxes, node, x, y, shape, best, nodes, bounds, depth)
    return best, which


@kernel(f"void({TREE}, {_R}, {_MANY}, int64, int64, int64, float64, {_R}, {_INTS})")
def drop(tree, shape, places, first, stop, whose, fine, heights, touched):
    """Drop a cutter at places first to stop - 1; `heights` and `touched` (m,) come out, see `drop_one`."""
    desk = new_desk()
    for k in range(first, stop):
        heights[k], touched[k] = drop_one(tree, shape, places[k, 0], places[k, 1], whose, fine, desk)
