# mypy: allow-untyped-defs
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
"""Radians: from the way ahead to the rim beside, and all round."""
_STACK = 64
"""Stretches that wait, at most: what is halved more often is taken as it is."""
_RIM = "UniTuple(float64, 7)"  # at both ends of a piece its centre and where its front half begins; its radius
_A_HAIR = 1e-10  # radians
_ROUNDING = 1e-12  # radians between stretches that end and begin at one place
_ALIKE = 1e-3  # radians that bounds may be above one that cannot be made better, without a closer look


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


@kernel(f"boolean({_SHAPES}, int64, UniTuple(float64, 3))", counts=False)
def _is_near(shapes, k, disc):
    """Tell whether no bound of shape k says that it is farther from a disc (x, y, radius)."""
    x, y, reach = disc
    far = shapes[k, 2] + reach
    dx, dy = x - shapes[k, 0], y - shapes[k, 1]
    return (
        dx * dx + dy * dy < far * far
        and shapes[k, 3] * x + shapes[k, 4] * y - shapes[k, 5] < reach
        and shapes[k, 6] * x + shapes[k, 7] * y - shapes[k, 8] < reach
    )


@kernel(f"float64[:, ::1]({_SHAPES}, UniTuple(float64, 3))")
def shapes_near(shapes, disc):
    """Return the shapes (m, 9) that may reach into a disc (x, y, radius), mm."""
    found, count = np.empty_like(shapes), 0
    for k in range(len(shapes)):
        if _is_near(shapes, k, disc):
            found[count] = shapes[k]
            count += 1
    return found[:count].copy()


@kernel(
    f"float64({_SHAPES}, int64, UniTuple(float64, 3), float64, UniTuple(float64, 2), float64[:, ::1])", counts=False
)
def _begin_of(shapes, k, circle, less, window, out):
    """Return where the stretch of a part of a circle begins that shape k covers, and in which the end of the part
    lies, which the shape holds.
    """
    begin = window[1]
    for j in range(_stretches(shapes, k, circle, less, window, out)):
        if out[j, 1] >= window[1] - _ROUNDING:
            begin = min(begin, out[j, 0])
    return begin


@kernel("UniTuple(float64, 2)(UniTuple(float64, 3), float64)", counts=False)
def _on_circle(circle, angle):
    return circle[0] + circle[2] * math.cos(angle), circle[1] + circle[2] * math.sin(angle)


@kernel(f"float64({_SHAPES}, UniTuple(float64, 3), UniTuple(float64, 2), float64[:, ::1])", counts=False)
def _reached_from(shapes, circle, window, out):
    """Return where the first of those stretches of a part of a circle begins that shapes cover up to the part's end;
    the end itself where no shape holds it.
    """
    best = window[1]
    x, y = _on_circle(circle, window[0] + best)
    bx, by, held = x, y, False
    for k in range(len(shapes)):
        # what does not hold where the best one so far begins, begins no sooner
        if not _holds(shapes, k, x, y, 0.0) or (held and not _holds(shapes, k, bx, by, 0.0)):
            continue
        begin, held = _begin_of(shapes, k, circle, 0.0, window, out), True
        if begin < best:
            best = begin
            bx, by = _on_circle(circle, window[0] + best)
    return best


@kernel(f"float64({_SHAPES}, UniTuple(float64, 3), UniTuple(float64, 2), float64)")
def last_uncovered(shapes, circle, window, least):
    """Return where the last stretch of a part of a circle that no shape covers ends, radians from the part's beginning;
    -1 where there is none.

    From the part's end backwards, from where a shape begins on to another one that holds a place just before: so
    borders are met of few shapes, not of all.

    Args:
        circle, window: as of `uncovered`.
        least: radians; a stretch that is no longer is none. Places so far on, and in parts of it, are looked at.
    """
    own, reached = np.empty((8, 6)), window[1]
    while reached > least:
        on = reached
        for share in (1.0, 0.7, 0.4):
            place = reached - share * least
            on = _reached_from(shapes, circle, (window[0], place), own)
            if on < place:
                break
            on = reached
        if on == reached:
            return reached
        reached = on
    return -1.0


@kernel(f"UniTuple(float64, 2)({_SHAPES}, UniTuple(float64, 4), float64, UniTuple(float64, 3))")
def last_on_arc(shapes, arc, radius, scan):
    """Return the greatest of what `last_uncovered` tells of the front half of a cutter's rim on an arc to the left, and
    the direction of travel there, radians; (-1, first direction) where nothing is uncovered.

    Args:
        arc: centre and radius of the arc, mm, and the direction of travel at its beginning, radians.
        radius: of the cutter, mm.
        scan: radians between places and how far they go, radians; `least` of `last_uncovered`.
    """
    cx, cy, turn, first = arc
    step, sweep, least = scan
    most, where = -1.0, first
    for k in range(int(sweep / step + 1.5)):
        ahead = first + k * step
        circle = (cx + turn * math.sin(ahead), cy - turn * math.cos(ahead), radius)
        found = last_uncovered(shapes, circle, (ahead - _HALF, math.pi), least)
        if found > most:
            most, where = found, ahead
    return most, where


@kernel("UniTuple(float64, 3)(float64[::1], float64, float64)", counts=False)
def _pose(row, sweep, share):
    """Return a place of a row, and the direction of travel there."""
    if row[7] == 0.0:
        dx, dy = row[2] - row[0], row[3] - row[1]
        return row[0] + dx * share, row[1] + dy * share, math.atan2(dy, dx)
    angle = math.atan2(row[1] - row[5], row[0] - row[4]) + sweep * share
    ahead = angle + (_HALF if sweep > 0.0 else -_HALF)
    return row[4] + row[6] * math.cos(angle), row[5] + row[6] * math.sin(angle), ahead


@kernel(f"boolean({_SHAPES}, int64, {_RIM}, float64, float64)", counts=False)
def _holds_both(shapes, k, rim, place, less):
    """Tell whether shape k holds a place of the rim at both ends of a piece."""
    radius = rim[6]
    return _holds(
        shapes, k, rim[0] + radius * math.cos(rim[2] + place), rim[1] + radius * math.sin(rim[2] + place), less
    ) and _holds(
        shapes, k, rim[3] + radius * math.cos(rim[5] + place), rim[4] + radius * math.sin(rim[5] + place), less
    )


@kernel(f"float64({_SHAPES}, int64, {_RIM}, float64, UniTuple(float64, 2), float64[:, :, ::1])", counts=False)
def _end_below(shapes, k, rim, less, span, out):
    """Return where the last stretch ends that shape k covers at both ends of a piece; `span[0]` where none is later.

    Args:
        span: what is known already, and where the looked at part of the rim ends, radians.
    """
    last, own, other = span[0], out[0], out[1]
    many = _stretches(shapes, k, (rim[0], rim[1], rim[6]), less, (rim[2], span[1]), own)
    if many == 0:
        return last
    for j in range(_stretches(shapes, k, (rim[3], rim[4], rim[6]), less, (rim[5], span[1]), other)):
        for i in range(many):
            end = min(own[i, 1], other[j, 1])
            if end > max(own[i, 0], other[j, 0]):
                last = max(last, end)
    return last


@kernel(f"float64({_SHAPES}, {_RIM}, float64, float64, float64[:, :, ::1])", counts=False)
def _gap_end(shapes, rim, less, reached, out):
    """Return down to where no shape covers the rim at both ends of a piece, below a place that none covers."""
    low, radius = 0.0, rim[6]
    middle = rim[2] + reached / 2
    disc = rim[0] + radius * math.cos(middle), rim[1] + radius * math.sin(middle), 2 * radius * math.sin(reached / 4)
    for k in range(len(shapes)):
        if _is_near(shapes, k, disc):
            low = _end_below(shapes, k, rim, less, (low, reached), out)
    return low


@kernel(f"float64({_SHAPES}, {_RIM}, float64, float64, float64[:, :, ::1])", counts=False)
def _covered_from(shapes, rim, less, place, out):
    """Return from where on one shape covers the rim up to a place at both ends of a piece; the place if none does."""
    best, held = place, False
    for k in range(len(shapes)):
        # what does not hold where the best one so far begins, begins no sooner
        if not _holds_both(shapes, k, rim, place, less) or (held and not _holds_both(shapes, k, rim, best, less)):
            continue
        held = True
        begin = max(
            _begin_of(shapes, k, (rim[0], rim[1], rim[6]), less, (rim[2], place), out[0]),
            _begin_of(shapes, k, (rim[3], rim[4], rim[6]), less, (rim[5], place), out[1]),
        )
        best = min(best, begin)
    return best


@kernel(f"float64({_SHAPES}, float64[::1], float64, UniTuple(float64, 2), UniTuple(float64, 2))")
def _piece(shapes, row, radius, sweep, span):
    """Return a bound of the engaged angle along a piece of a row; `sweep`: of the row, signed, and its length.

    What one shape covers of the rim's front half at both ends of the piece, it covers all along. From the rim's left
    end to its right one, so that borders are met of few shapes, not of all.
    """
    turned = min(abs(sweep[0]) * (span[1] - span[0]) / 2, math.pi)
    bulge = (row[6] + radius) * (1.0 - math.cos(turned))
    x, y, ahead = _pose(row, sweep[0], span[0])
    to_x, to_y, on = _pose(row, sweep[0], span[1])
    rim = (x, y, ahead - _HALF, to_x, to_y, on - _HALF, radius)
    out, bare, reached = np.empty((2, 8, 6)), 0.0, math.pi
    while reached > 0.0:
        # a hair before: stretches end and begin at one place, but for rounding; it counts as bare
        begin = _covered_from(shapes, rim, bulge, reached - _A_HAIR, out)
        if begin < reached - _A_HAIR:
            bare += _A_HAIR
        else:
            begin = _gap_end(shapes, rim, bulge, reached - _A_HAIR, out)
            bare += reached - begin
        reached = begin
    return bare


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
    most, where, settled = 0.0, 0.0, 0.0
    count = max(1, math.ceil(sweep[1] / coarse))
    low, high = np.empty(_STACK), np.empty(_STACK)
    for piece in range(count):
        low[0], high[0], depth = piece / count, (piece + 1) / count, 1
        while depth > 0:
            depth -= 1
            a, b = low[depth], high[depth]
            found = _piece(shapes, row, radius, sweep, (a, b))
            last = (b - a) * sweep[1] <= finest or depth + 2 > _STACK
            if last or found <= max(enough, settled + _ALIKE):
                if last:
                    settled = max(settled, found)
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


@kernel(f"boolean({_SHAPES}, int64, float64, float64, float64)", counts=False)
def _holds_square(shapes, k, x, y, half):
    """Tell whether shape k, which is convex, holds a square."""
    return (
        _holds(shapes, k, x - half, y - half, 0.0)
        and _holds(shapes, k, x + half, y - half, 0.0)
        and _holds(shapes, k, x - half, y + half, 0.0)
        and _holds(shapes, k, x + half, y + half, 0.0)
    )


@kernel(f"int64({_SHAPES}, int64, float64, float64, float64)", counts=False)
def _holding(shapes, known, x, y, half):
    """Return a shape that holds a square, `known` if it does; -1 where none does."""
    if known >= 0 and _holds_square(shapes, known, x, y, half):
        return known
    for k in range(len(shapes)):
        if _holds_square(shapes, k, x, y, half):
            return k
    return -1


@kernel(f"boolean({_SHAPES}, UniTuple(float64, 3), float64)")
def covers_disc(shapes, disc, finest):
    """Tell whether shapes surely cover a disc (x, y, radius), mm: squares that no shape holds are divided.

    Args:
        finest: mm, half the side of a square that is not divided.
    """
    x, y, reach = disc
    stack, count, known = np.empty((4 * _STACK, 3)), 1, -1
    stack[0] = x, y, reach
    while count > 0:
        count -= 1
        at_x, at_y, half = stack[count]
        off_x, off_y = max(abs(at_x - x) - half, 0.0), max(abs(at_y - y) - half, 0.0)
        if off_x * off_x + off_y * off_y >= reach * reach:
            continue
        known = _holding(shapes, known, at_x, at_y, half)
        if known >= 0:
            continue
        half /= 2
        if half < finest or count + 4 > len(stack):
            return False
        for k in range(4):
            stack[count] = at_x + (half if k % 2 else -half), at_y + (half if k // 2 else -half), half
            count += 1
    return True
