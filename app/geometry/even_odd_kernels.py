# mypy: allow-untyped-defs
"""Compiled: areas by lines that sweep over curves which rise all along.

A curve is a row: its low and high end (y), x at both, centre and radius of an arc; the radius is negative on the left
half of the circle and 0 for a line. Its owner is -1 for contours that count even-odd, else the number of an outline.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel

LOW, HIGH, X_LOW, X_HIGH, CX, CY, R = range(7)
"""Columns of a curve that rises all along: Y where it begins and ends, X there, and of an arc its centre and radius,
whose sign tells on which side of the centre it lies; mm.
"""


@kernel("float64(float64[:, ::1], int64, float64)", counts=False)
def _across(curves, k, y):
    """Return x of curve k at height y."""
    r = curves[k, R]
    if r == 0.0:
        share = (y - curves[k, LOW]) / (curves[k, HIGH] - curves[k, LOW])
        return curves[k, X_LOW] + share * (curves[k, X_HIGH] - curves[k, X_LOW])
    u = y - curves[k, CY]
    return curves[k, CX] + math.copysign(math.sqrt(max((abs(r) - u) * (abs(r) + u), 0.0)), r)


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _beneath(curves, k, a, b):
    """Return the integral of x over heights a to b of curve k: a trapezium and the segment over its chord."""
    xa, xb, r = _across(curves, k, a), _across(curves, k, b), curves[k, R]
    area = (xa + xb) / 2 * (b - a)
    if r == 0.0:
        return area
    t = 2 * math.asin(min(math.hypot(xb - xa, b - a) / (2 * abs(r)), 1.0))
    # The segment over a chord of angle t is r^2 / 2 (t - sin t). Of a small t that difference has no digits left, and
    # its series has: the next term is 2e-11 of the first one at 0.1.
    over = t**3 / 6 * (1 - t * t / 20 * (1 - t * t / 42)) if t < 0.1 else t - math.sin(t)
    return area + math.copysign(r * r / 2 * over, r)


@kernel("int64(float64[:, ::1], int64, int64, float64[::1])", counts=False)
def _meet(curves, i, j, heights):
    """Write the heights at which the carriers of two curves meet; return how many."""
    ri, rj = abs(curves[i, R]), abs(curves[j, R])
    if ri == 0.0 and rj == 0.0:
        si = (curves[i, X_HIGH] - curves[i, X_LOW]) / (curves[i, HIGH] - curves[i, LOW])
        sj = (curves[j, X_HIGH] - curves[j, X_LOW]) / (curves[j, HIGH] - curves[j, LOW])
        if si == sj:
            return 0
        y = curves[i, LOW]
        heights[0] = y + (_across(curves, j, y) - curves[i, X_LOW]) / (si - sj)
        return 1
    if ri == 0.0:
        i, j, ri, rj = j, i, rj, ri
    if rj == 0.0:
        ux, uy = curves[j, X_HIGH] - curves[j, X_LOW], curves[j, HIGH] - curves[j, LOW]
        size = math.hypot(ux, uy)
        ux, uy = ux / size, uy / size
        ax, ay = curves[i, CX] - curves[j, X_LOW], curves[i, CY] - curves[j, LOW]
        off, along, foot_y = abs(ux * ay - uy * ax), ax * ux + ay * uy, curves[j, LOW]
        h2 = (ri - off) * (ri + off)
        if h2 < 0.0:
            return 0
        h = math.sqrt(h2)
        heights[0], heights[1] = foot_y + uy * (along - h), foot_y + uy * (along + h)
        return 2
    dx, dy = curves[j, CX] - curves[i, CX], curves[j, CY] - curves[i, CY]
    gap = math.hypot(dx, dy)
    if gap == 0.0:
        return 0
    reach = (gap + (ri - rj) * (ri + rj) / gap) / 2
    # reach: from the first centre to the line through both meetings, (g^2 + ri^2 - rj^2) / 2 g, so written that nothing
    # cancels. h2: the square of half their chord.
    h2 = (ri - reach) * (ri + reach)
    if h2 < 0.0:
        return 0
    h = math.sqrt(h2)
    heights[0], heights[1] = curves[i, CY] + (dy * reach - dx * h) / gap, curves[i, CY] + (dy * reach + dx * h) / gap
    return 2


@kernel("float64[::1](float64[:, ::1], float64[:, ::1])")
def meeting_heights(curves, sides):
    """Return the heights at which curves may change places; they are in the order of their low ends.

    Args:
        sides: (n, 2) least and greatest x of each.
    """
    found, count = np.empty(4 * len(curves) + 64), 0
    active, busy = np.empty(len(curves), np.int64), 0
    two = np.empty(2)
    for k in range(len(curves)):
        kept = 0
        for place in range(busy):
            j = active[place]
            if curves[j, HIGH] <= curves[k, LOW]:
                continue
            active[kept] = j
            kept += 1
            if sides[j, 0] > sides[k, 1] or sides[j, 1] < sides[k, 0]:
                continue
            top = min(curves[j, HIGH], curves[k, HIGH])
            for n in range(_meet(curves, k, j, two)):
                if curves[k, LOW] < two[n] < top:
                    if count == len(found):
                        more = np.empty(2 * count)
                        # number by number: see `kernels.enlarged`
                        for c in range(count):
                            more[c] = found[c]
                        found = more
                    found[count] = two[n]
                    count += 1
        active[kept] = k
        busy = kept + 1
    return found[:count].copy()


@kernel("int64(float64[:, ::1], float64[::1], int64[::1], int64, float64)", counts=False)
def _sort(curves, x, active, busy, y):
    """Sort the first curves that are active by their x at a height; they were in order before, but for a few."""
    for place in range(busy):
        k, at = active[place], _across(curves, active[place], y)
        spot = place
        while spot > 0 and x[spot - 1] > at:
            x[spot], active[spot] = x[spot - 1], active[spot - 1]
            spot -= 1
        x[spot], active[spot] = at, k
    return busy


@kernel("boolean(int64[::1], int64[::1], int64, boolean[::1], int64[::1])", counts=False)
def _signs(owner, active, busy, within, new):
    """Write the sign of each active curve: 1 where the area lies to its left, -1 where to its right; return whether all
    go in pairs.
    """
    odd, held = False, 0
    for place in range(busy):
        before = odd and held == 0
        o = owner[active[place]]
        if o < 0:
            odd = not odd
        else:
            within[o] = not within[o]
            held += 1 if within[o] else -1
        new[place] = int(before) - int(odd and held == 0)
    if odd or held != 0:
        within[:] = False
        new[:busy] = 0
        return False
    return True


@kernel("Tuple((float64, float64))(float64[:, ::1], int64[::1], int64, float64[::1])")
def swept_area(curves, owner, outlines, heights):
    """Return (area, height over which some curve has no other to go with) of what lies between curves.

    A place counts where an odd number of contours and no outline goes round it. Sorting makes it indifferent to curves
    that lie on one another. The sign of a curve is kept until it changes, so most of them are integrated in one piece.

    Args:
        curves, owner: in the order of their low ends.
        outlines: how many there are.
        heights: rising; between two of them no curves change places, begin or end.
    """
    area, lost, busy, begun = 0.0, 0.0, 0, 0
    active, x = np.empty(len(curves), np.int64), np.empty(len(curves))
    sign, since = np.zeros(len(curves), np.int64), np.zeros(len(curves))
    new, within = np.empty(len(curves), np.int64), np.zeros(outlines, np.bool_)
    for slab in range(len(heights) - 1):
        a, b = heights[slab], heights[slab + 1]
        kept = 0
        for place in range(busy):
            k = active[place]
            if curves[k, HIGH] > a:
                active[kept] = k
                kept += 1
            elif sign[k] != 0:
                area += sign[k] * _beneath(curves, k, since[k], curves[k, HIGH])
        busy = kept
        while begun < len(curves) and curves[begun, LOW] <= a:
            active[busy] = begun
            busy += 1
            begun += 1
        # Between two heights no curves change places, so their order half way between is that all along.
        _sort(curves, x, active, busy, (a + b) / 2)
        if not _signs(owner, active, busy, within, new):
            lost += b - a
        for place in range(busy):
            k = active[place]
            # A curve whose sign stays goes on: its integral is taken once, from where the sign began.
            if new[place] != sign[k]:
                if sign[k] != 0:
                    area += sign[k] * _beneath(curves, k, since[k], a)
                sign[k], since[k] = new[place], a
    for place in range(busy):
        k = active[place]
        if sign[k] != 0:
            area += sign[k] * _beneath(curves, k, since[k], curves[k, HIGH])
    return area, lost
