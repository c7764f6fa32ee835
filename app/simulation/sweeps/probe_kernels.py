# mypy: allow-untyped-defs
"""Compiled: how low a cutter gets over single places on its pieces of path, in float64."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..box_tree import LEAF
from ..field.ray_kernels import over

_SHAPE = "UniTuple(float64, 6)"
"""Of a cutter: radius, flat, fillet, span of the fillet, slope of the cone (0 = none), lift over the tip, mm."""

_R, _MANY = "float64[::1]", "float64[:, ::1]"
_STACK = 128
"""Nodes that wait, at most: one a level of the tree, and no tree is so deep."""
_GOLDEN = 0.6180339887498949
"""(sqrt 5 - 1) / 2 of a stretch is left by a golden section."""
_NARROWED = 60
"""Times that the interval in which a cutter is lowest is made shorter: to the twelfth digit."""

_UPRIGHT, _RIM = 1e-18, 1e-12
"""Square of a way, mm2, that goes nowhere sideways; and the part of a radius that rounding may take a place beyond the
rim.
"""


@kernel(f"float64({_SHAPE}, float64)")
def profile(shape, r):
    """Return how high a cutter is over its path at a distance from its axis, at most its radius."""
    radius, flat, fillet, span, slope, lift = shape
    beyond = max(min(r, radius) - flat, 0.0)
    rounded = min(beyond, span)
    return lift + fillet - math.sqrt(max(fillet * fillet - rounded * rounded, 0.0)) + slope * (beyond - rounded)


@kernel(f"float64({_SHAPE}, UniTuple(float64, 2), float64, UniTuple(float64, 2))")
def lowest_part(shape, span, rise, where):
    """Return the least of rise * t + profile at t along a level way.

    Args:
        span: from where to where along it, mm. rise: of the path, mm per mm.
        where: t of the foot of a place on the way, and how far the place is from it.
    """
    low, high = span
    foot, aside = where
    # a flat end: linear along the way, so the least is at an end
    if shape[2] == 0.0 and shape[4] == 0.0:
        return min(rise * low, rise * high) + shape[5]
    # a ball: the sphere touches where its slope is the path's, in closed form
    if shape[1] == 0.0 and shape[4] == 0.0:
        t = foot - rise * math.sqrt(max(shape[2] * shape[2] - aside * aside, 0.0) / (1.0 + rise * rise))
        t = min(max(t, low), high)
        return rise * t + profile(shape, math.sqrt((t - foot) * (t - foot) + aside * aside))
    if rise == 0.0:
        t = min(max(foot, low), high)
        return profile(shape, math.sqrt((t - foot) * (t - foot) + aside * aside))
    # everything else by golden section: convex (see `over_straight`), so no other valley is missed
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left = rise * left + profile(shape, math.sqrt((left - foot) * (left - foot) + aside * aside))
    at_right = rise * right + profile(shape, math.sqrt((right - foot) * (right - foot) + aside * aside))
    for _ in range(_NARROWED):
        if at_left > at_right:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = rise * right + profile(shape, math.sqrt((right - foot) * (right - foot) + aside * aside))
        else:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = rise * left + profile(shape, math.sqrt((left - foot) * (left - foot) + aside * aside))
    return min(at_left, at_right)


@kernel(f"float64({_SHAPE}, {_R}, float64, float64, float64)", counts=False)
def over_straight(shape, p, x, y, best):
    """Return the lowest height of a cutter over a place on a straight piece; infinite where it does not come, or surely
    not below best.

    The height along the way is convex where the cutter is over the place, so that it has one least value there.
    """
    dx, dy, dz, radius = p[3] - p[0], p[4] - p[1], p[5] - p[2], shape[0]
    square, ox, oy = dx * dx + dy * dy, x - p[0], y - p[1]
    if square <= _UPRIGHT:
        off = math.sqrt(ox * ox + oy * oy)
        return min(p[2], p[5]) + profile(shape, off) if off <= radius * (1.0 + _RIM) else math.inf
    length = math.sqrt(square)
    foot, aside = (ox * dx + oy * dy) / length, abs(ox * dy - oy * dx) / length
    if aside > radius * (1.0 + _RIM):
        return math.inf
    half = math.sqrt(max(radius * radius - aside * aside, 0.0))
    low, high = max(foot - half, 0.0), min(foot + half, length)
    if low > high + _RIM * radius:
        return math.inf
    low, high, rise = min(low, length), max(high, 0.0), dz / length
    # no height over the place is below path plus profile at the nearest approach
    if p[2] + min(rise * low, rise * high) + profile(shape, aside) > best:
        return math.inf
    return p[2] + lowest_part(shape, (low, max(low, high)), rise, (foot, aside))


@kernel(f"float64({_SHAPE}, {_R}, float64, float64)", counts=False)
def over_arc(shape, p, x, y):
    """Return the height of a cutter over a place on a level arc of at most a quarter turn; infinite where it does not
    come over it.
    """
    cx, cy, size = p[6], p[7], p[8]
    ox, oy = x - cx, y - cy
    off = abs(math.sqrt(ox * ox + oy * oy) - size)
    # signs of cross products: before the start, or behind the end, of at most a quarter turn
    ahead, behind = (p[0] - cx) * oy - (p[1] - cy) * ox, ox * (p[4] - cy) - oy * (p[3] - cx)
    if ahead < 0.0 or behind < 0.0:
        off = min(math.sqrt((x - p[0]) ** 2 + (y - p[1]) ** 2), math.sqrt((x - p[3]) ** 2 + (y - p[4]) ** 2))
    return p[2] + profile(shape, off) if off <= shape[0] * (1.0 + _RIM) else math.inf


@kernel(f"void({_MANY}, {_MANY}, int64[:, ::1], {_MANY}, {_MANY}, {_R}, int64[::1])")
def lowest(boxes, pieces, owners, shapes, points, heights, motions):
    """Write the lowest height that is reached over each point (m, 2), infinite where nothing comes, and the first
    motion that does.

    Args:
        boxes: of the pieces' `box_tree`, a cutter's radius wider on each side, from the lowest height on.
        pieces: (n, 9) start, end; of a level arc also its centre and radius, else a radius of 0.
        owners: (n, 2) row of the motion, row of the cutter. shapes: (c, 6).
        heights, motions: (m,); -1 = none.
    """
    leaves, stack = (len(boxes) + 1) // 2, np.empty(_STACK, np.int64)
    for j in range(len(points)):
        x, y, best, who = points[j, 0], points[j, 1], math.inf, -1
        stack[0], depth = 0, 1
        while depth > 0:
            depth -= 1
            k = stack[depth]
            if boxes[k, 2] > best or not over(boxes, k, x, y):
                continue
            if k < leaves - 1:
                deep, shallow = 2 * k + 1, 2 * k + 2
                # the deeper child first: what it finds lets the other be skipped
                if boxes[deep, 2] > boxes[shallow, 2]:
                    deep, shallow = shallow, deep
                stack[depth], stack[depth + 1] = shallow, deep
                depth += 2
                continue
            first = (k - leaves + 1) * LEAF
            for n in range(first, min(first + LEAF, len(pieces))):
                c = owners[n, 1]
                shape = (shapes[c, 0], shapes[c, 1], shapes[c, 2], shapes[c, 3], shapes[c, 4], shapes[c, 5])
                piece = pieces[n]
                z = over_arc(shape, piece, x, y) if piece[8] > 0.0 else over_straight(shape, piece, x, y, best)
                if z < best or (z == best and z < math.inf and owners[n, 0] < who):
                    best, who = z, owners[n, 0]
        heights[j], motions[j] = best, who
