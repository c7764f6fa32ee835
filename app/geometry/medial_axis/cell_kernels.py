# mypy: allow-untyped-defs
"""Compiled: the cell of each element, the part of a region that is nearest to it, as pieces of the medial axis.

Along the feet of an element the disc is as large as the site lets it that gives the greatest curvature: a cell is an
envelope of closed forms, found by dividing the element until its sites are the same at both ends.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import enlarged
from ..offset.offset_kernels import vertex_turn
from .site_kernels import SMOOTH, common_vertex, curvature, foot, governs, never_bounds, spans, touches

_DEEPEST = 4000  # parts of one element that wait
_EDGE = 1e-9  # of an element; at its very end the disc of growing neighbours is degenerate

_GIVEN = "float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1], int64[:, ::1]"


@kernel("void(float64[:, ::1], int64[:, ::1], float64[::1])")
def vertex_turns(rows, links, turns):
    """Write by how much the boundary turns where each row starts, radians, left positive, into turns (n,)."""
    for i in range(len(rows)):
        turns[i] = vertex_turn(rows, links[0, i], i)


@kernel(f"Tuple((int64, float64))({_GIVEN}, float64, int64, float64, int64, int64)", counts=False)
def largest_disc(rows, boxes, angles, turns, links, crack, e, u, hint, other):
    """Return (site, curvature) of the largest empty disc that touches element e at u; site -1 where nothing bounds it.

    All discs at a foot lie one in the other, so rows that are clear of one can never matter again; two hints (or -1)
    are tried first.
    """
    n = len(rows)
    px, py, nx, ny = foot(rows, angles, e, u)
    best, site = 1e-9, -1
    if e < n and rows[e, 7] > 0.0:
        best, site = 1.0 / rows[e, 6], e
    x, y, radius = px + nx / best, py + ny / best, 1.0 / best
    for q in range(-2, n):
        k = q
        if q < 0:
            k = hint if q == -2 else other
            if k < 0:
                continue
            k = k - n if k >= n else k
        else:
            dx, dy = max(boxes[k, 0] - x, x - boxes[k, 2], 0.0), max(boxes[k, 1] - y, y - boxes[k, 3], 0.0)
            if dx * dx + dy * dy >= radius * radius:
                continue
        if not never_bounds(rows, links, turns, e, k):
            v = curvature(rows, e, k, px, py, nx, ny)
            own_joint = e < n and (
                (k == links[0, e] and turns[e] <= 0.0) or (k == links[1, e] and turns[links[1, e]] <= 0.0)
            )
            if v > best and not (v > 1e10 and own_joint) and spans(rows, k, px + nx / v, py + ny / v, crack):
                best, site = v, k
                x, y, radius = px + nx / v, py + ny / v, 1.0 / v
        for i in (k, links[1, k]):
            if turns[i] > -SMOOTH or never_bounds(rows, links, turns, e, n + i):
                continue
            v = curvature(rows, e, n + i, px, py, nx, ny)
            if v > best * (1.0 + 1e-14):
                best, site = v, n + i
                x, y, radius = px + nx / v, py + ny / v, 1.0 / v
    return site, best


@kernel(
    "float64(float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], int64, int64, float64, float64)",
    counts=False,
)
def _island_between(rows, angles, contours, places, e, s, low, high):
    """Return a fraction at which a whole other contour lies in the discs of e and s, which hold no part of one; -1 for
    none. `contours` (n,) is the number of each row's, `places` (c, 2) a point of each.
    """
    n = len(rows)
    for c in range(len(places)):
        if c in (contours[e % n], contours[s % n]):
            continue
        a, b, best, deepest = low, high, low, math.inf
        # nine samples, then nine about the deepest one, twice
        for _ in range(3):
            for z in range(9):
                u = a + (b - a) * (z + 0.5) / 9
                px, py, nx, ny = foot(rows, angles, e, u)
                k = curvature(rows, e, s, px, py, nx, ny)
                if k <= 0.0:
                    continue
                depth = math.hypot(places[c, 0] - px - nx / k, places[c, 1] - py - ny / k) - 1.0 / k
                if depth < deepest:
                    deepest, best = depth, u
            if deepest < -1e-9:
                return best
            step = (b - a) / 9
            a, b = max(low, best - step), min(high, best + step)
    return -1.0


@kernel(
    "UniTuple(float64, 3)(float64[:, ::1], float64[:, ::1], int64, int64, int64, int64, float64, float64, float64, "
    "float64)",
    counts=False,
)
def _change(rows, angles, e, a, b, vertex, low, high, at_low, at_high):
    """Return (low, high, middle) of the fractions between which site b takes over from a: false position, halving."""
    side, x = 0, 0.5 * (low + high)
    for k in range(80):
        x = (high * at_low - low * at_high) / (at_low - at_high) if k < 50 else 0.5 * (low + high)
        if not low < x < high:
            x = 0.5 * (low + high)
        value = governs(rows, angles, e, a, b, vertex, x)
        if value > 0.0:
            low, at_low = x, value
            # Illinois' rule: an end that stays twice in a row counts half, so that false position does not creep
            at_high = 0.5 * at_high if side == 1 else at_high
            side = 1
        elif value < 0.0:
            high, at_high = x, value
            at_low = 0.5 * at_low if side == -1 else at_low
            side = -1
        else:
            return x, x, x
        if high - low < 1e-15:
            break
    return low, high, 0.5 * (low + high)


@kernel(f"UniTuple(float64, 3)({_GIVEN}, float64, int64, int64, int64, float64, float64)", counts=False)
def _divide(rows, boxes, angles, turns, links, crack, e, a, b, low, high):
    """Return (fraction, site before it, site behind it) at which a part with different sites at its ends is divided."""
    vertex = common_vertex(links, len(rows), a, b)
    if vertex >= 0 and turns[vertex] >= SMOOTH:
        vertex = -1
    first, last = governs(rows, angles, e, a, b, vertex, low), governs(rows, angles, e, a, b, vertex, high)
    if -1e-11 < first <= 0.0 and last < 0.0 and touches(rows, angles, e, b, low):
        return low, b, b
    if 0.0 <= last < 1e-11 and first > 0.0 and touches(rows, angles, e, a, high):
        return high, a, a
    lower, upper, middle = low, high, 0.5 * (low + high)
    changes = first >= 0.0 and last <= 0.0 and first - last > 0.0
    if changes:
        lower, upper, middle = _change(rows, angles, e, a, b, vertex, low, high, first, last)
    site, k = largest_disc(rows, boxes, angles, turns, links, crack, e, middle, a, b)
    if changes and upper - lower < 1e-9:
        px, py, nx, ny = foot(rows, angles, e, middle)
        known = max(curvature(rows, e, a, px, py, nx, ny), curvature(rows, e, b, px, py, nx, ny))
        if k <= known * (1.0 + 1e-10):
            if touches(rows, angles, e, a, middle) and touches(rows, angles, e, b, middle):
                return middle, a, b
            middle = low  # curves as they are extended meet there, they themselves do not
    if middle <= low or middle >= high:
        middle = 0.5 * (low + high)
        site, k = largest_disc(rows, boxes, angles, turns, links, crack, e, middle, a, b)
    return middle, site, site


@kernel(f"Tuple((float64[:, ::1], int64))({_GIVEN}, float64, int64[::1], float64[:, ::1])")
def cells(rows, boxes, angles, turns, links, crack, contours, places):
    """Return the pieces (m, 4) of all cells: element, site, from and to as fractions of the element; and how many
    elements could not be done. Rows are taken as longer by a `crack`, mm, at both ends.
    """
    n, count, failed = len(rows), 0, 0
    pieces, waiting = np.empty((16 * n + 64, 4)), np.empty((_DEEPEST + 2, 4))
    for e in range(2 * n):
        if e >= n and turns[e - n] > -SMOOTH:
            continue
        if e < n and turns[e] >= SMOOTH:
            a = links[0, e]
        else:
            a, _ = largest_disc(rows, boxes, angles, turns, links, crack, e, _EDGE, -1, -1)
        if e < n and turns[links[1, e]] >= SMOOTH:
            b = links[1, e]
        else:
            b, _ = largest_disc(rows, boxes, angles, turns, links, crack, e, 1.0 - _EDGE, a, -1)
        waiting[0, 0], waiting[0, 1], waiting[0, 2], waiting[0, 3] = 0.0, a, 1.0, b
        top = 1
        while top > 0:
            top -= 1
            low, high = waiting[top, 0], waiting[top, 2]
            a, b = int(waiting[top, 1]), int(waiting[top, 3])
            if a < 0 or b < 0 or top >= _DEEPEST:
                failed += 1
                break
            if a == b or high - low < 1e-12:
                middle = -1.0
                if len(places) > 1 and high - low > 1e-9:
                    middle = _island_between(rows, angles, contours, places, e, a, low, high)
                if middle < 0.0:
                    if count == len(pieces):
                        pieces = enlarged(pieces, count, 2 * count)
                    pieces[count, 0], pieces[count, 1], pieces[count, 2], pieces[count, 3] = e, a, low, high
                    count += 1
                    continue
                before, _ = largest_disc(rows, boxes, angles, turns, links, crack, e, middle, a, -1)
                behind = before
            else:
                middle, p, q = _divide(rows, boxes, angles, turns, links, crack, e, a, b, low, high)
                before, behind = int(p), int(q)
            if middle < high:
                waiting[top, 0], waiting[top, 1], waiting[top, 2], waiting[top, 3] = middle, behind, high, b
                top += 1
            if middle > low:
                waiting[top, 0], waiting[top, 1], waiting[top, 2], waiting[top, 3] = low, a, middle, before
                top += 1
    return pieces[:count].copy(), failed


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1], float64[:, :, ::1])")
def centres(rows, angles, pieces, fractions, found):
    """Write (x, y, radius) of the disc at each fraction of each piece into found (m, k, 3)."""
    for i in range(len(pieces)):
        e, s = int(pieces[i, 0]), int(pieces[i, 1])
        for j in range(len(fractions)):
            px, py, nx, ny = foot(rows, angles, e, pieces[i, 2] + (pieces[i, 3] - pieces[i, 2]) * fractions[j])
            k = curvature(rows, e, s, px, py, nx, ny)
            radius = 1.0 / k if k > 0.0 else 0.0
            found[i, j, 0], found[i, j, 1], found[i, j, 2] = px + nx * radius, py + ny * radius, radius
