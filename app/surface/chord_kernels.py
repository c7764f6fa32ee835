"""Compiled: proof that a cutter on its way along a chord goes nowhere deeper into surfaces than allowed.

A cutter that is pared by what is allowed must not reach the surfaces, all along the chord. Over one facet, with a skin for how far
it may be from what it stands for, the tip's height over the chord is concave along it: from three places it is bounded
everywhere. Facets of which that is not enough are quartered, until they are nearer to the surface than a part of what is allowed.
"""

from __future__ import annotations

import math

import numpy as np

from app.jit import kernel
from app.surface.contact_kernels import CONE, DISC, RADIUS, over_triangle, thicken
from app.surface.desk_kernels import (
    BOXES,
    CONTROL,
    DESK,
    ERROR,
    LAST,
    LEAF,
    NODES,
    OFF,
    PATCH,
    SHAPES,
    TREE,
    TRIANGLES,
    WORK,
    lay,
    new_desk,
)  # fmt: skip
from app.surface.distance_kernels import square_from_triangle
from app.surface.drop_kernels import bound
from app.surface.patch_kernels import copy_row, quarter

_R, _MANY = "float64[::1]", "float64[:, ::1]"
CLEAR = -1.0
_FINEST = 0.125
"""Of what is allowed: facets as near to the surface are taken for it."""
_TIMES = 32
_MOST = 200_000
"""Facets that are looked at for one chord; then it counts as not proven."""


@kernel(f"float64({_R}, {_R}, {_R}, {_R}, float64, float64)", counts=False)
def _along(triangle, chord, tool, shape, skin, length):  # type: ignore[no-untyped-def]
    """Return where on a chord a cutter with a skin goes into a triangle, CLEAR if it is proven to go nowhere into it.

    Args:
        chord: (6,) its ends, and how long it is. tool: the cutter's shape. shape: that of the cutter with its skin; changed.
    """
    ax, ay, az, bx, by, bz = chord[0], chord[1], chord[2], chord[3], chord[4], chord[5]
    low, middle, high = 0.0, 0.5, 1.0
    at_low = over_triangle(triangle, ax, ay, shape, -math.inf) + skin - az
    at_high = over_triangle(triangle, bx, by, shape, -math.inf) + skin - bz
    at = over_triangle(triangle, 0.5 * (ax + bx), 0.5 * (ay + by), shape, -math.inf) + skin - 0.5 * (az + bz)
    if max(at_low, at, at_high) > 0.0:
        return 0.0 if at_low > 0.0 else (1.0 if at_high > 0.0 else 0.5)
    if at_low == -math.inf and at == -math.inf and at_high == -math.inf:
        return CLEAR  # in reach nowhere, or by less than a chord of that length can be off
    for _ in range(_TIMES):
        left = at + (at - at_high) * (middle - low) / (high - middle) if at > -math.inf else math.inf
        right = at + (at - at_low) * (high - middle) / (middle - low) if at > -math.inf else math.inf
        if at == -math.inf:  # out of reach here: it is in reach on one side only
            left, right = (math.inf, -math.inf) if at_low > -math.inf else (-math.inf, math.inf)
        if left <= 0.0 and right <= 0.0:
            return CLEAR
        first, stop = low if left > 0.0 else middle, high if right > 0.0 else middle
        if (stop - first) * length <= -skin:  # what is open is so short that a skin of half of it is enough
            more = skin + 0.5 * (stop - first) * length
            thicken(tool, more, shape)
            new = 0.5 * (first + stop)
            over = over_triangle(triangle, ax + new * (bx - ax), ay + new * (by - ay), shape, -math.inf) + more
            return CLEAR if over <= az + new * (bz - az) else new
        leftwards = left > right or (left == right and middle - low > high - middle)
        new = 0.5 * (low + middle) if leftwards else 0.5 * (middle + high)
        at_new = over_triangle(triangle, ax + new * (bx - ax), ay + new * (by - ay), shape, -math.inf) + skin
        at_new -= az + new * (bz - az)
        if at_new > 0.0:
            return new
        if leftwards:
            if at_new >= at:  # the highest is on this side
                middle, at, high, at_high = new, at_new, middle, at
            else:
                low, at_low = new, at_new
        elif at_new >= at:
            middle, at, low, at_low = new, at_new, middle, at
        else:
            high, at_high = new, at_new
    return middle


@kernel(f"float64({_R}, float64, {_R}, {_R}, float64, {DESK})", counts=False)
def _part_clear(part, off, shape, chord, allowed, desk):  # type: ignore[no-untyped-def]
    """Return where on a chord a cutter may go too deep into what a facet (9,) stands for, CLEAR if it is proven: nowhere.

    Args:
        off: how far the facet may be off it, mm.
    """
    radius = shape[RADIUS]
    if shape[DISC] == 0.0 and shape[CONE] == 0.0 and max(part[2], part[5], part[8]) <= min(chord[2], chord[5]) + radius:
        from_centre = radius + off - allowed  # a ball above all of it: its centre keeps away
        away = square_from_triangle(part, chord[0], chord[1], chord[2] + radius, chord[3], chord[4], chord[5] + radius)
        return CLEAR if away >= from_centre * from_centre else 0.5
    x, y, z = 0.5 * (chord[0] + chord[3]), 0.5 * (chord[1] + chord[4]), 0.5 * (chord[2] + chord[5])
    dx, dy, dz = chord[3] - chord[0], chord[4] - chord[1], chord[5] - chord[2]
    length, wide = math.sqrt(dx * dx + dy * dy + dz * dz), desk[SHAPES][1]
    skin = 0.5 * length + off - allowed
    thicken(shape, skin, wide)
    if over_triangle(part, x, y, wide, z - skin) <= z - skin:
        return CLEAR
    thicken(shape, off - allowed, wide)
    return _along(part, chord, shape, wide, off - allowed, length)


@kernel(f"Tuple((float64, int64))({TREE}, int64, {_R}, {_R}, float64, int64, {DESK})", counts=False)
def _facet_clear(tree, n, shape, chord, allowed, looked, desk):  # type: ignore[no-untyped-def]
    """Return what `clear` does of one facet, quartered as far as it takes, and how many facets have been looked at by then."""
    work = desk[WORK]
    at = _part_clear(tree[TRIANGLES][n], tree[ERROR][n], shape, chord, allowed, desk)
    if at == CLEAR or tree[ERROR][n] <= _FINEST * allowed:
        return at, looked + 1
    lay(tree, n, work)
    waiting = 1
    while True:
        copy_row(work, waiting, LAST)
        quarter(tree[CONTROL], tree[PATCH][n], work, LAST, waiting)
        for k in range(waiting, waiting + 4):
            work[k, OFF] = 0.25 * work[LAST, OFF]
        waiting += 4
        while True:  # down to the next that is not clear
            waiting -= 1
            looked += 1
            if waiting == 0:
                return CLEAR, looked
            at = _part_clear(work[waiting, :9], work[waiting, OFF], shape, chord, allowed, desk)
            if at != CLEAR:
                break
        if work[waiting, OFF] <= _FINEST * allowed or looked > _MOST:
            return at, looked


@kernel(f"float64({TREE}, {_R}, {_R}, float64, {DESK})", counts=False)
def clear(tree, shape, chord, allowed, desk):  # type: ignore[no-untyped-def]
    """Return where on a chord a cutter goes deeper into surfaces than allowed, or may, CLEAR if it is proven to do so nowhere.

    Args:
        chord: (6,) the tip's places at its ends, mm. allowed: mm, > 0.
    """
    boxes, nodes, wide = tree[BOXES], desk[NODES], desk[SHAPES][0]
    x, y, z = 0.5 * (chord[0] + chord[3]), 0.5 * (chord[1] + chord[4]), 0.5 * (chord[2] + chord[5])
    dx, dy, dz = chord[3] - chord[0], chord[4] - chord[1], chord[5] - chord[2]
    skin = 0.5 * math.sqrt(dx * dx + dy * dy + dz * dz) - allowed
    inner, depth, looked = len(boxes) // 2, 1, 0
    thicken(shape, skin, wide)
    nodes[0] = 0
    while depth > 0:
        depth -= 1
        node = nodes[depth]
        if node < inner:
            for child in (2 * node + 1, 2 * node + 2):
                if bound(boxes, child, x, y, wide, z - skin) > -math.inf:
                    nodes[depth] = child
                    depth += 1
            continue
        start = (node - inner) * tree[LEAF]
        for n in range(start, min(start + tree[LEAF], len(tree[TRIANGLES]))):
            at, looked = _facet_clear(tree, n, shape, chord, allowed, looked, desk)
            if at != CLEAR:
                return at
    return CLEAR


@kernel(f"void({TREE}, {_R}, {_MANY}, int64, int64, float64, boolean[::1])")
def clear_all(tree, shape, chords, first, stop, allowed, found):  # type: ignore[no-untyped-def]
    """Set which of chords first to stop - 1 (m, 6) are proven, see `clear`; a long one in parts of a length that goes quickly."""
    desk, part = new_desk(), np.empty(6)
    for k in range(first, stop):
        dx, dy, dz = chords[k, 3] - chords[k, 0], chords[k, 4] - chords[k, 1], chords[k, 5] - chords[k, 2]
        times = 1 + int(math.sqrt(dx * dx + dy * dy + dz * dz) / (0.25 * shape[RADIUS]))
        found[k] = True
        for n in range(times):
            for c in range(3):
                step = (chords[k, 3 + c] - chords[k, c]) / times
                part[c], part[3 + c] = chords[k, c] + n * step, chords[k, c] + (n + 1) * step
            if clear(tree, shape, part, allowed, desk) != CLEAR:
                found[k] = False
                break
