"""How much of a cutter's rim may be in metal, bounded from above along whole lines and arcs, not looked at in places.

What is clear of metal is known as convex shapes, a row each: a disc, cut by up to two half planes: (cx, cy, radius, nx,
ny, h, mx, my, k), points p with |p - c| <= radius, n.p <= h and m.p <= k, mm; a half plane that is none has n = 0, h =
inf. Every circle crosses the border of such a shape at no more than six places, in closed form, so at one place of a
cutter the rim that no shape covers is known exactly. Along a line or an arc every point of the rim goes along a line,
or an arc about the same centre, which leaves its chord by no more than the outermost does. So what of the rim a shape
that is so much smaller holds at both ends of a piece, it holds all along, as it is convex: the rest is a bound. A piece
of which the bound is too large is halved.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.sort_kernels import order_of

_SHAPES = "float64[:, ::1]"
_HALF, _TURN = math.pi / 2, 2 * math.pi
_STACK = 64
_ROUNDING = 1e-12  # radians between stretches that end and begin at one place
_ALIKE = 1e-3  # radians by which a bound may grow from piece to piece without a closer look


@kernel(f"boolean({_SHAPES}, int64, float64, float64, float64)", counts=False)
def _holds(shapes, k, x, y, less):
    """Tell whether shape k, smaller by `less` mm all round, holds a point."""
    reach = shapes[k, 2] - less
    dx, dy = x - shapes[k, 0], y - shapes[k, 1]
    if reach < 0.0 or dx * dx + dy * dy > reach * reach:
        return False
    # a half plane that is none has n = 0 and h = inf, so it holds whatever comes
    return (
        shapes[k, 3] * x + shapes[k, 4] * y <= shapes[k, 5] - less
        and shapes[k, 6] * x + shapes[k, 7] * y <= shapes[k, 8] - less
    )


@kernel(f"int64({_SHAPES}, int64, UniTuple(float64, 3), float64, float64[::1])", counts=False)
def _borders(shapes, k, circle, less, out):
    """Put the angles at which a circle (x, y, radius) crosses the border of shape k into `out`; return how many."""
    x, y, radius = circle
    count, reach = 0, shapes[k, 2] - less
    dx, dy = shapes[k, 0] - x, shapes[k, 1] - y
    far = math.sqrt(dx * dx + dy * dy)
    # circles that only touch have their place as well, twice: else one look there would stand for the whole circle
    if reach > 0.0 and far > 0.0 and reach - radius < far < reach + radius:
        ahead = math.atan2(dy, dx)
        half = math.acos(max(-1.0, min(1.0, (far * far + radius * radius - reach * reach) / (2.0 * far * radius))))
        out[0], out[1] = ahead - half, ahead + half
        count = 2
    for j in (3, 6):
        nx, ny = shapes[k, j], shapes[k, j + 1]
        if nx == 0.0 and ny == 0.0:
            continue
        share = (shapes[k, j + 2] - less - nx * x - ny * y) / radius
        if share < 1.0:
            ahead, half = math.atan2(ny, nx), math.acos(max(-1.0, share))
            out[count], out[count + 1] = ahead - half, ahead + half
            count += 2
    return count


@kernel(f"int64({_SHAPES}, int64, UniTuple(float64, 3), float64, UniTuple(float64, 2), float64[:, ::1])", counts=False)
def _stretches(shapes, k, circle, less, window, out):
    """Put the stretches (begin, end) of a part of a circle that shape k covers into `out`; return how many."""
    first, size = window
    own = out[6]
    found, count = _borders(shapes, k, circle, less, own), 0
    for i in range(1, found):
        j = i
        while j > 0 and (own[j] - first) % _TURN < (own[j - 1] - first) % _TURN:
            own[j - 1], own[j] = own[j], own[j - 1]
            j -= 1
    for i in range(max(found, 1)):
        begin = (own[i] - first) % _TURN if found else 0.0
        end = (own[i + 1] - first) % _TURN if i + 1 < found else begin + _TURN
        if found and i + 1 == found:
            end = (own[0] - first) % _TURN + _TURN
        # between two neighbouring crossings no border is met, so the middle speaks for all of the stretch
        middle = first + (begin + end) / 2
        if not _holds(
            shapes, k, circle[0] + circle[2] * math.cos(middle), circle[1] + circle[2] * math.sin(middle), less
        ):
            continue
        if begin < size:
            out[count, 0], out[count, 1] = begin, min(end, size)
            count += 1
        if end > _TURN:
            out[count, 0], out[count, 1] = 0.0, min(end - _TURN, size)
            count += 1
    return count


@kernel("float64[:, ::1](float64[:, ::1], int64)")
def _in_order(found, count):
    """Return the first stretches (count, 2) by where they begin."""
    # by the beginnings alone: `_bare` takes the farthest end so far, so the order among equal ones is all the same
    starts, ordered = np.empty(count), np.empty((count, 2))
    for k in range(count):
        starts[k] = found[k, 0]
    order = order_of(starts)
    for k in range(count):
        ordered[k, 0], ordered[k, 1] = found[order[k], 0], found[order[k], 1]
    return ordered


@kernel(f"float64[:, ::1]({_SHAPES}, UniTuple(float64, 3), float64, UniTuple(float64, 2))")
def _covered(shapes, circle, less, window):
    """Return the stretches (n, 2) of a part of a circle that shapes cover, by where they begin, radians from the part's
    beginning.
    """
    own, count = np.empty((8, 6)), 0
    found = np.empty((7 * len(shapes), 2))
    for k in range(len(shapes)):
        for j in range(_stretches(shapes, k, circle, less, window, own)):
            found[count, 0], found[count, 1] = own[j, 0], own[j, 1]
            count += 1
    return _in_order(found, count)


@kernel("float64(float64[:, ::1], float64)", counts=False)
def _bare(covered, size):
    """Return how much of a part of a circle stretches leave, which are in order."""
    bare, reached = 0.0, 0.0
    for k in range(len(covered)):
        if covered[k, 0] - reached > _ROUNDING:
            bare += covered[k, 0] - reached
        reached = max(reached, covered[k, 1])
    return bare + size - reached if size - reached > _ROUNDING else bare


@kernel(f"float64({_SHAPES}, UniTuple(float64, 3), float64, UniTuple(float64, 2))")
def uncovered(shapes, circle, less, window):
    """Return how much of a part of a circle no shape covers, radians.

    Args:
        circle: x, y, radius, mm.
        less: so much smaller are all shapes taken to be, mm.
        window: angle at which the part begins, and its size, at most a full turn, radians.
    """
    return _bare(_covered(shapes, circle, less, window), window[1])


@kernel(f"float64({_SHAPES}, UniTuple(float64, 3), UniTuple(float64, 2), float64)")
def last_uncovered(shapes, circle, window, least):
    """Return where the last stretch of a part of a circle that no shape covers ends, radians from the part's beginning;
    -1 where there is none.

    Args:
        circle, window: as of `uncovered`.
        least: radians; a stretch that is no longer is none.
    """
    covered, found, reached = _covered(shapes, circle, 0.0, window), -1.0, 0.0
    for k in range(len(covered)):
        if covered[k, 0] - reached > least:
            found = covered[k, 0]
        reached = max(reached, covered[k, 1])
    return window[1] if window[1] - reached > least else found


@kernel("UniTuple(float64, 3)(float64[::1], float64, float64)", counts=False)
def _pose(row, sweep, share):
    """Return a place of a row, and the direction of travel there."""
    if row[7] == 0.0:
        dx, dy = row[2] - row[0], row[3] - row[1]
        return row[0] + dx * share, row[1] + dy * share, math.atan2(dy, dx)
    angle = math.atan2(row[1] - row[5], row[0] - row[4]) + sweep * share
    ahead = angle + (_HALF if sweep > 0.0 else -_HALF)
    return row[4] + row[6] * math.cos(angle), row[5] + row[6] * math.sin(angle), ahead


@kernel(f"float64({_SHAPES}, float64[::1], float64, UniTuple(float64, 2), UniTuple(float64, 2))")
def _piece(shapes, row, radius, sweep, span):
    """Return a bound of the engaged angle along a piece of a row; `sweep`: of the row, signed, and its length.

    What one shape covers of the rim's front half at both ends of the piece, it covers all along.
    """
    turned = min(abs(sweep[0]) * (span[1] - span[0]) / 2, math.pi)
    bulge = (row[6] + radius) * (1.0 - math.cos(turned))
    x, y, ahead = _pose(row, sweep[0], span[0])
    first, before = (x, y, radius), (ahead - _HALF, math.pi)
    x, y, ahead = _pose(row, sweep[0], span[1])
    last, after = (x, y, radius), (ahead - _HALF, math.pi)
    own, other, count = np.empty((8, 6)), np.empty((8, 6)), 0
    found = np.empty((14 * len(shapes), 2))
    for k in range(len(shapes)):
        many = _stretches(shapes, k, first, bulge, before, own)
        if many == 0:
            continue
        for j in range(_stretches(shapes, k, last, bulge, after, other)):
            for i in range(many):
                begin, end = max(own[i, 0], other[j, 0]), min(own[i, 1], other[j, 1])
                if begin < end:
                    found[count, 0], found[count, 1] = begin, end
                    count += 1
    return _bare(_in_order(found, count), math.pi)


@kernel(f"UniTuple(float64, 2)({_SHAPES}, float64[::1], float64, UniTuple(float64, 2), UniTuple(float64, 4))")
def bound_along(shapes, row, radius, sweep, limits):
    """Return a bound of the engaged angle all along a row (8,), radians, and the fraction of it where it is that large.

    Args:
        shapes: (n, 9) what is clear, see the module.
        radius: of the cutter, mm.
        sweep: signed sweep of an arc, radians, 0 for lines, and the length of the row, mm.
        limits: an angle that is small enough, radians; lengths of the first pieces, and of pieces that are not halved,
            mm: whatever bound these have is the answer; an angle, radians: where one of these has more, the rest of the
            row is not looked at.
    """
    enough, coarse, finest, hopeless = limits
    most, where = 0.0, 0.0
    count = max(1, math.ceil(sweep[1] / coarse))
    low, high = np.empty(_STACK), np.empty(_STACK)
    for piece in range(count):
        low[0], high[0], depth = piece / count, (piece + 1) / count, 1
        while depth > 0:
            depth -= 1
            a, b = low[depth], high[depth]
            found = _piece(shapes, row, radius, sweep, (a, b))
            if found <= max(enough, most + _ALIKE) or (b - a) * sweep[1] <= finest or depth + 2 > _STACK:
                if found > most:
                    most, where = found, (a + b) / 2
                if found > hopeless:
                    return most, where
                continue
            middle = (a + b) / 2
            low[depth], high[depth] = middle, b
            low[depth + 1], high[depth + 1] = a, middle
            depth += 2
    return most, where


@kernel(f"float64({_SHAPES}, UniTuple(float64, 3))")
def clear_radius(shapes, place):
    """Return the radius of a disc round a place that is surely clear, mm, at most `place[2]`; 0 where there is none.

    Only shapes that hold the place count: seen from it each reaches from there to its border without a gap, so a circle
    that is covered all round has nothing but clear ground within.
    """
    x, y, most = place
    inner, count = np.empty_like(shapes), 0
    for k in range(len(shapes)):
        if _holds(shapes, k, x, y, 0.0):
            inner[count] = shapes[k]
            count += 1
    if count == 0:
        return 0.0
    held = inner[:count]
    low = 0.0
    for k in range(count):
        dx, dy = x - held[k, 0], y - held[k, 1]
        gap = held[k, 2] - math.sqrt(dx * dx + dy * dy)
        for j in (3, 6):
            if held[k, j] != 0.0 or held[k, j + 1] != 0.0:
                gap = min(gap, held[k, j + 2] - held[k, j] * x - held[k, j + 1] * y)
        low = max(low, gap)
    high = most
    if low >= high:
        return high
    if uncovered(held, (x, y, high), 0.0, (0.0, _TURN)) == 0.0:
        return high
    while high - low > 1e-9:
        middle = (low + high) / 2
        if uncovered(held, (x, y, middle), 0.0, (0.0, _TURN)) == 0.0:
            low = middle
        else:
            high = middle
    return low
