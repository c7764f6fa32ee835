# mypy: allow-untyped-defs
"""Compiled: as few points for a path as a tube above it lets through.

A path of many points is a function z(t) along its line. Another one that is nowhere below it keeps as clear of the
surfaces, and where it is nowhere higher than a length measured square to the path it is as near as asked. Its points
stand over points of the first one, so that between two of these both are straight, and what holds at the points holds
everywhere. From a point, the slopes that pass every point's interval up to some point are an interval too, which
shrinks from point to point: a chord goes on until that is empty. Round a convex bend chords touch the path in their
middles, and their ends stand out: of the tube's height h they are sqrt(8 h r) long, as chords are that may be h too
low.

References:
    Cones of slopes through intervals: Reumann and Witkam (1974), Tomek (1974); polygons within a tube: Imai and Iri
        (1988).
"""

from __future__ import annotations

import math

from ...core.jit import kernel

_R, _MANY, _INTS = "float64[::1]", "float64[:, ::1]", "int64[::1]"
T, Z, FIXED, BEGINS, ROOM = range(5)
"""Columns of a path's points: place along its line; the tip; whether it stays as it is; whether a run begins; how much
higher it may be.
"""
COLUMNS = 5


@kernel(f"float64({_MANY}, int64, int64, float64, float64, float64)", counts=False)
def _near_path(rows, n, step, most, found, enough):
    """Return how much higher than point n a place straight above it may be for the path to be within `most`, as far as
    one side of the path tells.

    Args:
        step: 1: the path on from there; -1: back from there. found: so much is known. enough: more is not asked for.
    """
    k = n
    while found < enough:
        other = k + step
        if other < 0 or other == len(rows) or rows[max(k, other), BEGINS] != 0.0:
            break
        near, far = abs(rows[k, T] - rows[n, T]), abs(rows[other, T] - rows[n, T])
        if near >= most:
            break
        at, high = near, max(rows[k, Z], rows[other, Z])
        if far > near:  # from the place above, the chord's nearest one is square to it, or one of its ends
            slope = (rows[other, Z] - rows[k, Z]) / (far - near)
            at = min(max(most * slope / math.sqrt(1.0 + slope * slope), near), min(far, most))
            high = rows[k, Z] + slope * (at - near)
        found = max(found, high - rows[n, Z] + math.sqrt(most * most - at * at))
        k = other
    return min(found, enough)


@kernel(f"void({_MANY}, float64)")
def give_room(rows, most):
    """Set how much higher each point may be, straight up, for `most` square to both chords that meet there; 0 of fixed
    ones.

    Steep chords that are soon over, as beside an edge, are no reason to be higher than `most` from the path itself.
    """
    for n in range(len(rows)):
        least = math.inf
        for k in (n, n + 1):
            if 0 < k < len(rows) and rows[k, BEGINS] == 0.0:
                run, rise = rows[k, T] - rows[k - 1, T], rows[k, Z] - rows[k - 1, Z]
                least = min(least, math.sqrt(run * run + rise * rise) / run if run > 0.0 else math.inf)
        rows[n, ROOM] = 0.0
        if rows[n, FIXED] == 0.0 and least < math.inf:
            back = _near_path(rows, n, -1, most, most, most * least)
            rows[n, ROOM] = _near_path(rows, n, 1, most, back, most * least)


@kernel(f"int64({_MANY}, int64, int64, float64, {_R})", counts=False)
def _chord(rows, first, last, z, found):
    """Return the farthest point that a chord from height z over a point reaches, `last` at most; `found`: its height
    there.
    """
    low, high, best = -math.inf, math.inf, first
    for k in range(first + 1, last + 1):
        far = rows[k, T] - rows[first, T]
        at_least, at_most = (rows[k, Z] - z) / far, (rows[k, Z] + rows[k, ROOM] - z) / far
        # [low, high] are the slopes that pass all points so far. Once it is empty the chord ends at the last point
        # that it passed, as high (the path rises) or as low there as it may be.
        if max(at_least, low) > min(at_most, high):
            rising = at_least > high
            far = rows[best, T] - rows[first, T]
            found[0] = z + far * (high if rising else low)
            return best
        low, high, best = max(at_least, low), min(at_most, high), k
    found[0] = rows[last, Z]
    return best


@kernel(f"int64({_MANY}, float64, {_INTS}, {_R})")
def thin(rows, grid, kept, heights):
    """Set which points are kept and how high they are then; return how many.

    Args:
        rows: (n, COLUMNS); the first and the last point of each run are fixed. grid: heights are rounded up to it, mm,
            or 0.
        kept, heights: (n + 1,) to be set.
    """
    count, fixed = 0, 0
    while fixed < len(rows):
        kept[count], heights[count] = fixed, rows[fixed, Z]
        count += 1
        stop = fixed + 1
        while stop < len(rows) and rows[stop, FIXED] == 0.0:
            stop += 1
        first, z = fixed, rows[fixed, Z]
        while first < stop < len(rows) and rows[stop, BEGINS] == 0.0:
            # The first point's height is chosen by the chord before it, so that chords join without a step.
            first = _chord(rows, first, stop, z, heights[count:])
            if first == stop:
                break
            z = heights[count]
            if grid > 0.0:
                z = math.ceil(z / grid - 1e-6) * grid
            # Never below the path, whatever division has rounded.
            z = max(z, rows[first, Z])
            kept[count], heights[count] = first, z
            count += 1
        fixed = stop
    return count
