# mypy: allow-untyped-defs
"""Compiled: proof that a cutter on its way along a chord goes nowhere deeper than allowed into what one facet stands
for.

A cutter that is pared by what is allowed must not reach it, all along the chord. Over one facet, with a skin for how
far it may be from what it stands for, the tip's height over the chord is concave along it: from three places it is
bounded everywhere.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..cutter_contact.contact_kernels import CONE, DISC, RADIUS, over_triangle, thicken
from ..cutter_contact.distance_kernels import square_from_curtain
from ..cutter_contact.facet_tree_kernels import DESK, SHAPES

_R = "float64[::1]"
APART, _TOGETHER, _OPEN = 0, 1, 2
"""What a triangle's middle tells of it and a cutter's way: too far apart to meet, surely in one another, or neither."""
_SHORT = 0.02
"""Of what is allowed: a stretch of a chord that is looked at in one."""


@kernel(f"float64({_R}, float64, float64, float64, float64)", counts=False)
def _nearest(t, ax, ay, bx, by):
    """Return where on a chord, from 0 to 1, it is nearest to a triangle (9,), both seen from above: beside a corner, or
    over a side.
    """
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    if square == 0.0:
        return 0.5
    best, nearest = 0.5, math.inf
    for k in range(3):
        x, y = t[3 * k] - ax, t[3 * k + 1] - ay
        at = min(max((x * dx + y * dy) / square, 0.0), 1.0)
        off = (x - at * dx) ** 2 + (y - at * dy) ** 2
        if off < nearest:
            best, nearest = at, off
        to_x, to_y = t[3 * (k + 1) % 9] - ax, t[(3 * (k + 1) + 1) % 9] - ay
        side, other = x * dy - y * dx, to_x * dy - to_y * dx
        if side * other < 0.0:  # the side crosses the chord's line
            share = side / (side - other)
            at = ((x + share * (to_x - x)) * dx + (y + share * (to_y - y)) * dy) / square
            if 0.0 <= at <= 1.0:
                return at
    return best


@kernel(f"boolean({_R}, {_R}, {_R}, {_R}, float64, float64, int64)", counts=False)
def _along(triangle, chord, tool, shape, skin, length, times):
    """Return whether a cutter with a skin is proven to go nowhere into a triangle along a chord.

    Args:
        chord: (6,) its ends, and how long it is. tool: the cutter's shape. shape: that of the cutter with its skin;
            changed.
    """
    ax, ay, az, bx, by, bz = chord[0], chord[1], chord[2], chord[3], chord[4], chord[5]
    low, middle, high = 0.0, 0.5, 1.0
    at_low = over_triangle(triangle, ax, ay, shape, -math.inf) + skin - az
    at_high = over_triangle(triangle, bx, by, shape, -math.inf) + skin - bz
    at = over_triangle(triangle, 0.5 * (ax + bx), 0.5 * (ay + by), shape, -math.inf) + skin - 0.5 * (az + bz)
    if max(at_low, at, at_high) > 0.0:
        return False
    if at_low == -math.inf and at == -math.inf and at_high == -math.inf:  # in reach nowhere, or between these places
        middle = _nearest(triangle, ax, ay, bx, by)
        at = (
            over_triangle(triangle, ax + middle * (bx - ax), ay + middle * (by - ay), shape, -math.inf)
            + skin
            - az
            - middle * (bz - az)
        )
        if at == -math.inf or at > 0.0:
            return at < 0.0
    for _ in range(times):
        left = at + (at - at_high) * (middle - low) / (high - middle) if at > -math.inf else math.inf
        right = at + (at - at_low) * (high - middle) / (middle - low) if at > -math.inf else math.inf
        if at == -math.inf:  # out of reach here: it is in reach on one side only
            left, right = (math.inf, -math.inf) if at_low > -math.inf else (-math.inf, math.inf)
        if left <= 0.0 and right <= 0.0:
            return True
        first, stop = low if left > 0.0 else middle, high if right > 0.0 else middle
        if (stop - first) * length <= -_SHORT * skin:  # what is open is so short that a skin of half of it is enough
            more = skin + 0.5 * (stop - first) * length
            thicken(tool, more, shape)
            new = 0.5 * (first + stop)
            over = over_triangle(triangle, ax + new * (bx - ax), ay + new * (by - ay), shape, -math.inf) + more
            return over <= az + new * (bz - az)
        leftwards = left > right or (left == right and middle - low > high - middle)
        # nothing is known of a slope there: both sides get shorter
        if at > -math.inf and min(at_low, at_high) == -math.inf:
            leftwards = middle - low > high - middle
        new = 0.5 * (low + middle) if leftwards else 0.5 * (middle + high)
        at_new = over_triangle(triangle, ax + new * (bx - ax), ay + new * (by - ay), shape, -math.inf) + skin
        at_new -= az + new * (bz - az)
        if at_new > 0.0:
            return False
        if leftwards:
            if at_new >= at:  # the highest is on this side
                middle, at, high, at_high = new, at_new, middle, at
            else:
                low, at_low = new, at_new
        elif at_new >= at:
            middle, at, low, at_low = new, at_new, middle, at
        else:
            high, at_high = new, at_new
    return False


@kernel(f"int64({_R}, {_R}, float64, float64)", counts=False)
def by_middle(t, chord, radius, away):
    """Return APART or _TOGETHER, as far as a triangle's middle tells: whether all of it is so far from a ball's way,
    with its shank.

    The square of the distance from what the ball's centre, and all above it, goes through is convex; so it is nowhere
    less than it is in the middle and rises from there as it begins to.
    """
    dx, dy, dz = chord[3] - chord[0], chord[4] - chord[1], chord[5] - chord[2]
    middle_x, middle_y, middle_z = (t[0] + t[3] + t[6]) / 3.0, (t[1] + t[4] + t[7]) / 3.0, (t[2] + t[5] + t[8]) / 3.0
    x, y, z = middle_x - chord[0], middle_y - chord[1], middle_z - chord[2] - radius
    along, square = x * dx + y * dy, dx * dx + dy * dy
    at = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
    if z < at * dz:  # below the centre's way
        square += dz * dz
        at = min(max((along + z * dz) / square, 0.0), 1.0) if square > 0.0 else 0.0
        z -= at * dz
    else:
        z = 0.0
    x, y = x - at * dx, y - at * dy
    spare = x * x + y * y + z * z - away * away
    if spare < 0.0:
        return _TOGETHER
    least = 0.0
    for k in range(3):
        least = min(least, x * (t[3 * k] - middle_x) + y * (t[3 * k + 1] - middle_y) + z * (t[3 * k + 2] - middle_z))
    return APART if spare + 2.0 * least >= 0.0 else _OPEN


@kernel(f"boolean({_R}, float64, {_R}, {_R}, float64, int64, {DESK})", counts=False)
def apart(part, off, shape, chord, allowed, times, desk):
    """Return whether a cutter is proven to go along a chord nowhere deeper than allowed into what a facet (9,) stands
    for.

    Args:
        off: how far the facet may be off it, or the cutter off the chord, mm. times: so often may the chord be divided.
    """
    if shape[DISC] == 0.0 and shape[CONE] == 0.0:  # a ball, and its shank above: its centre keeps away
        radius, away = shape[RADIUS], shape[RADIUS] + off - allowed
        told = by_middle(part, chord, radius, away)
        if told != _OPEN:
            return told == APART
        return (
            square_from_curtain(part, chord[0], chord[1], chord[2] + radius, chord[3], chord[4], chord[5] + radius)
            >= away * away
        )
    dx, dy, dz = chord[3] - chord[0], chord[4] - chord[1], chord[5] - chord[2]
    length, wide = math.sqrt(dx * dx + dy * dy + dz * dz), desk[SHAPES][1]
    skin, z = 0.5 * length + off - allowed, 0.5 * (chord[2] + chord[5])
    thicken(shape, skin, wide)
    if over_triangle(part, 0.5 * (chord[0] + chord[3]), 0.5 * (chord[1] + chord[4]), wide, z - skin) <= z - skin:
        return True
    thicken(shape, off - allowed, wide)
    return _along(part, chord, shape, wide, off - allowed, length, times)
