# mypy: allow-untyped-defs
"""A body that does not cut, led straight over metal that stays as it is: how deep it goes, found in a pyramid of
maxima.

Level 0 of the pyramid are the cells, a node of level k + 1 is the highest of the four of level k below it, up to one
node. Nodes whose highest metal stays below the lowest that the body can be over them are not opened, so few cells are
looked at.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

SHORT = 1e-9
"""mm sideways, up to which a way counts as upright."""

SLACK = 1e-6
"""mm; a node that promises no more than this over what is found is not opened."""

STACK = 128
"""Nodes that wait, at most: three of each level, and the root."""

_SHAPE, _WAY = "UniTuple(float64, 4)", "UniTuple(float64, 6)"


@kernel(f"float64({_SHAPE}, float64)")
def rise(shape, aside):
    """Return how high over its middle a body is at a distance from its axis, mm; shape: radius, flat, slope, lift."""
    return shape[2] * max(aside - shape[1], 0.0)


@kernel(f"float64({_SHAPE}, {_WAY}, float64, float64)")
def lowest_over(shape, way, x, y):
    """Return how low a body gets over a place on its way, mm; infinite where it does not get there.

    Over a place the body's height is convex along the way, so its least is where it enters or leaves, where the flat's
    rim passes, or where the cone falls as the way rises.
    """
    px, py, dx, dy, dz = x - way[0], y - way[1], way[3] - way[0], way[4] - way[1], way[5] - way[2]
    size, radius = math.sqrt(dx * dx + dy * dy), shape[0]
    if size <= SHORT:
        aside = math.sqrt(px * px + py * py)
        return math.inf if aside > radius else min(way[2], way[5]) + shape[3] + rise(shape, aside)
    along, aside = (px * dx + py * dy) / size, (px * dy - py * dx) / size
    q2 = aside * aside
    if q2 > radius * radius:
        return math.inf
    half, s = math.sqrt(radius * radius - q2), dz / size
    low, high = max(along - half, 0.0), min(along + half, size)
    if low > high:
        return math.inf
    rim = math.sqrt(max(shape[1] * shape[1] - q2, 0.0))
    best = math.inf
    for k in range(6):
        # the places where the least can be: abreast, in, out, both rims of the flat, and the cone's own
        u = 0.0 if k == 0 else -half if k == 1 else half if k == 2 else -rim if k == 3 else rim
        if k == 5:
            if abs(s) >= shape[2]:
                break
            u = -s * abs(aside) / math.sqrt(shape[2] * shape[2] - s * s)
        t = min(max(along + u, low), high)
        best = min(best, s * t + rise(shape, math.sqrt(q2 + (t - along) * (t - along))))
    return way[2] + shape[3] + best


@kernel(f"float64({_SHAPE}, {_WAY}, float64, float64, float64)")
def bound_over(shape, way, x, y, half):
    """Return a height that a body nowhere gets below over a disc round a place, mm; infinite where it gets nowhere over
    it.
    """
    px, py, dx, dy, dz = x - way[0], y - way[1], way[3] - way[0], way[4] - way[1], way[5] - way[2]
    size, near = math.sqrt(dx * dx + dy * dy), shape[0] + half
    if size <= SHORT:
        aside, low = math.sqrt(px * px + py * py), min(dz, 0.0)
    else:
        along = (px * dx + py * dy) / size
        t = min(max(along, 0.0), size)
        ex, ey = px - t * dx / size, py - t * dy / size
        aside = math.sqrt(ex * ex + ey * ey)
        # the way's lowest place while any of the disc is under the body
        at = min(max(along - near if dz > 0.0 else along + near, 0.0), size)
        low = dz * at / size
    return math.inf if aside > near + SLACK else way[2] + low + shape[3] + rise(shape, max(aside - half, 0.0)) - SLACK


@kernel(
    f"Tuple((float64, int64))(float32[::1], int64[:, ::1], UniTuple(float64, 3), {_SHAPE}, {_WAY}, float64, int64[:, "
    "::1], float64[::1])",
    counts=False,
)
def deepest(heights, levels, grid, shape, way, least, nodes, bounds):
    """Return how deep a body goes into metal on its way, and in which cell, if deeper than `least`; else `least` and
    -1.

    Args:
        heights: of all levels, one after the other. levels: (n, 3) where each begins, its rows and columns.
        grid: x and y of the lower left corner, pitch, mm.
        nodes, bounds: room for STACK nodes: level, row, column; how deep they may be.
    """
    best, cell, waiting, cols = least, -1, 1, levels[0, 2]
    nodes[0, 0], nodes[0, 1], nodes[0, 2], bounds[0] = levels.shape[0] - 1, 0, 0, math.inf
    while waiting > 0:
        waiting -= 1
        if bounds[waiting] <= best + SLACK:
            continue
        level, row, col = nodes[waiting, 0] - 1, 2 * nodes[waiting, 1], 2 * nodes[waiting, 2]
        first, side = waiting, 1 << level
        for k in range(4):
            r, c = row + k // 2, col + k % 2
            if r >= levels[level, 1] or c >= levels[level, 2]:
                continue
            height = float(heights[levels[level, 0] + r * levels[level, 2] + c])
            x, y = grid[0] + (c + 0.5) * side * grid[2], grid[1] + (r + 0.5) * side * grid[2]
            if level == 0:
                depth = height - lowest_over(shape, way, x, y)
                if depth > best:
                    best, cell = depth, r * cols + c
                continue
            # a node's cells lie at centres: half the diagonal of what they span
            depth = height - bound_over(shape, way, x, y, 0.70711 * (side - 1) * grid[2])
            if depth > best + SLACK:
                at = waiting
                # kept sorted: the most promising node is opened first, and closes most others
                while at > first and bounds[at - 1] > depth:
                    bounds[at] = bounds[at - 1]
                    for j in range(3):
                        nodes[at, j] = nodes[at - 1, j]
                    at -= 1
                bounds[at], nodes[at, 0], nodes[at, 1], nodes[at, 2] = depth, level, r, c
                waiting += 1
    return best, cell


@kernel(
    "void(float32[::1], int64[:, ::1], UniTuple(float64, 3), float64[:, ::1], float64[:, ::1], int64[::1], "
    "int64[::1], float64[::1], float64[::1], boolean, float64[::1], int64[::1], int64, int64)"
)
def ask(heights, levels, grid, ways, shapes, way, shape, low, least, shared, depth, cell, first, last):
    """Write how deep bodies go into metal, items first … last - 1.

    Args:
        heights, levels, grid: as for `deepest`.
        ways: (n, 6) x, y, z of start and end. shapes: (m, 4) radius, flat, slope, lift.
        way, shape: of each item. low: what is added to its body's lift, mm.
        least: by item what it must be deeper than; or, `shared`, by shape, and raised to what is found.
        depth, cell: of each item; cell -1: it is not that deep.
    """
    nodes, bounds = np.empty((STACK, 3), np.int64), np.empty(STACK)
    for k in range(first, last):
        w, s = way[k], shape[k]
        body = (shapes[s, 0], shapes[s, 1], shapes[s, 2], shapes[s, 3] + low[k])
        led = (ways[w, 0], ways[w, 1], ways[w, 2], ways[w, 3], ways[w, 4], ways[w, 5])
        need = least[s] if shared else least[k]
        depth[k], cell[k] = deepest(heights, levels, grid, body, led, need, nodes, bounds)
        if shared and depth[k] > least[s]:
            least[s] = depth[k]
