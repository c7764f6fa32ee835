# mypy: allow-untyped-defs
"""Compiled: ranges of points along one segment of a polygon (S111-S117), in one go over the points.

Directions from a range's first point that pass every point between within epsilon form a cone about each; one cone
within all of them is kept. A next point whose direction lies in it is let in at once; otherwise every point between is
looked at.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_HALF, _REACH = 3, 4
"""Numbers of a cone behind its axis: half its angle, radians, more than pi while any direction will do; the distance of
the farthest point that it was made by, mm.
"""
_ANY = 4.0
"""Radians; a half angle of which any direction is within."""
_GUARD = 1e-11
"""So much inside the cone a direction must be, rad: what rounding may add up to."""
_STRAIGHTER = 0.22
"""Of how far a range bends: both sides of the bend may be off by so much. Halves of an arc are off by a quarter."""
_EVIDENCE = 4
"""Chords of a range that may bend at one point, at least: fewer are straight on both sides of any of theirs."""
_PLAIN = 0.5
"""Of epsilon: a bend that is so far off is seen by its range alone."""
_CLEARLY = 2.5
"""Times the sum of squares: what rounding does to points of straight facets seldom makes so much."""
_CHANCE = 14.4
"""Times the mean square of points off their ranges: rounding to a last decimal d moves none farther off its chord than
1.42 d, while the mean square of that is 0.14 d².
"""
_NEAR = 8
"""Points to either side of an end among which it is looked for."""
_ROUNDS = 4
"""Of settling ends: an end that has moved lets its neighbours move."""
_MANY = 8
"""Chords of a range in which a smaller one is: so many points are straight on both sides of it by no chance."""


@kernel("float64(float64[:, ::1], int64, int64, int64)", counts=False)
def _off(points, i, j, k):
    """Return how far point j is from the segment from point i to point k."""
    along, size = 0.0, 0.0
    for axis in range(3):
        along += (points[k, axis] - points[i, axis]) * (points[j, axis] - points[i, axis])
        size += (points[k, axis] - points[i, axis]) ** 2
    share = min(max(along / size, 0.0), 1.0) if size > 0.0 else 0.0
    away = 0.0
    for axis in range(3):
        away += (points[j, axis] - points[i, axis] - share * (points[k, axis] - points[i, axis])) ** 2
    return math.sqrt(away)


@kernel("float64(float64[:, ::1], int64, int64, float64[::1])", counts=False)
def _angle(points, i, k, axis):
    """Return the angle between a unit direction and that from point i to point k."""
    x, y, z = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1], points[k, 2] - points[i, 2]
    cross = math.sqrt(
        (axis[1] * z - axis[2] * y) ** 2 + (axis[2] * x - axis[0] * z) ** 2 + (axis[0] * y - axis[1] * x) ** 2
    )
    return math.atan2(cross, axis[0] * x + axis[1] * y + axis[2] * z)


@kernel("float64(float64[:, ::1], int64, int64)", counts=False)
def _size(points, i, k):
    return math.sqrt(
        (points[k, 0] - points[i, 0]) ** 2 + (points[k, 1] - points[i, 1]) ** 2 + (points[k, 2] - points[i, 2]) ** 2
    )


@kernel("void(float64[:, ::1], int64, int64, float64, float64[::1])", counts=False)
def _narrow(points, i, k, epsilon, cone):
    """Keep of a cone (axis, half angle, reach) a cone of directions from point i that also pass point k."""
    size = _size(points, i, k)
    cone[_REACH] = max(cone[_REACH], size)
    # Every direction passes a ball that the first point lies in.
    if size <= epsilon or cone[_HALF] < 0.0:
        return
    half = math.asin(epsilon / size)
    turn = _angle(points, i, k, cone)
    if cone[_HALF] > math.pi or turn + half <= cone[_HALF]:  # any direction yet, or the new cone is within the old
        for axis in range(3):
            cone[axis] = (points[k, axis] - points[i, axis]) / size
        cone[_HALF] = half
    elif turn + cone[_HALF] > half:
        # What two cones share is a lens; the widest cone within it has its axis between theirs (spherical
        # interpolation).
        lean = (turn - half + cone[_HALF]) / 2
        cone[_HALF] = (half + cone[_HALF] - turn) / 2
        one, two = math.sin(turn - lean) / math.sin(turn), math.sin(lean) / math.sin(turn) / size
        for axis in range(3):
            cone[axis] = one * cone[axis] + two * (points[k, axis] - points[i, axis])


@kernel("boolean(float64[:, ::1], int64, int64, float64, float64[::1])", counts=False)
def _all_within(points, i, k, epsilon, cone):
    """Return whether all points between lie within epsilon of the segment; if so the cone is made anew about it."""
    for j in range(i + 1, k):
        if _off(points, i, j, k) > epsilon:
            return False
    length = _size(points, i, k)
    if length > 0.0:
        for axis in range(3):
            cone[axis] = (points[k, axis] - points[i, axis]) / length
        # More than any angle: the narrowest of what the points between leave round the new axis is kept.
        cone[_HALF] = _ANY
        for j in range(i + 1, k):
            size = _size(points, i, j)
            if size > epsilon:
                cone[_HALF] = min(cone[_HALF], math.asin(epsilon / size) - _angle(points, i, j, cone))
    return True


@kernel("int64(float64[:, ::1], int64, float64, boolean[::1], float64[::1])", counts=False)
def _reach(points, i, epsilon, stop, cone):
    """Return the last point of the range that begins at point i (S113-S116)."""
    cone[:] = 0.0
    cone[_HALF] = _ANY
    k = i + 1
    while k < len(points) - 1 and not stop[k]:
        _narrow(points, i, k, epsilon, cone)
        free = cone[_HALF] > math.pi  # all are about the first point
        clear = cone[_HALF] > 0.0 and _angle(points, i, k + 1, cone) <= cone[_HALF] * (1 - 1e-6) - _GUARD
        if not (
            free or (clear and _size(points, i, k + 1) >= cone[_REACH]) or _all_within(points, i, k + 1, epsilon, cone)
        ):
            break
        k += 1
    return k


@kernel("int64(float64[:, ::1], int64, int64, float64[::1])", counts=False)
def _farthest(points, i, k, off):
    """Return which point between i and k is the farthest off their segment, i if there is none; write how far."""
    at, off[0] = i, 0.0
    for j in range(i + 1, k):
        away = _off(points, i, j, k)
        if away > off[0]:
            at, off[0] = j, away
    return at


@kernel("int64(float64[:, ::1], int64, int64, float64[::1])", counts=False)
def _bend(points, i, k, off):
    """Return the one point at which a range from i to k bends, i if it does not; write how far it is off there.

    On both sides of it the range is far straighter than it is as a whole.
    """
    j = _farthest(points, i, k, off)
    if j == i:
        return i
    bent = off[0]
    _farthest(points, i, j, off)
    left = off[0]
    _farthest(points, j, k, off)
    straight = max(left, off[0]) <= _STRAIGHTER * bent
    off[0] = bent
    return j if straight else i


@kernel("int64(float64[:, ::1], float64, boolean[::1], boolean, int64[:, ::1])")
def ranges(points, epsilon, stop, at_bends, found):
    """Write first and last point of each range (n, 2), and return their number; no range goes beyond a stop.

    At bends a range that bends at one point ends there if the next one then reaches farther, so that it ended within a
    facet, or if the bend is plain.
    """
    n, count, i = len(points), 0, 0
    cone, off = np.empty(5), np.empty(1)
    while i < n - 1:
        k = _reach(points, i, epsilon, stop, cone)
        if at_bends and k - i >= _EVIDENCE:
            j = _bend(points, i, k, off)
            plain = j - i >= 2 and k - j >= 2 and (off[0] >= _PLAIN * epsilon or k - i >= _MANY)
            if j > i and (plain or _reach(points, j, epsilon, stop, cone) > k):
                k = j
        found[count, 0], found[count, 1] = i, k
        count += 1
        i = k
    return count


@kernel("float64(float64[:, ::1], int64, int64, float64)", counts=False)
def _bent(points, i, k, epsilon):
    """Return the sum of squares of how far the points between are off the segment; infinity if one is beyond it."""
    total = 0.0
    for j in range(i + 1, k):
        away = _off(points, i, j, k)
        if away > epsilon:
            return math.inf
        total += away * away
    return total


@kernel("int64(float64[:, ::1], int64, int64, int64, float64, float64[::1])", counts=False)
def _straightest(points, i, e, k, epsilon, least):
    """Return the point near e at which ranges from i and to k are straightest together; write how bent they are."""
    at, least[0] = e, _bent(points, i, e, epsilon) + _bent(points, e, k, epsilon)
    for j in range(max(i + 1, e - _NEAR), min(k, e + _NEAR + 1)):
        both = _bent(points, i, j, epsilon) + _bent(points, j, k, epsilon)
        if both < least[0]:
            at, least[0] = j, both
    return at


@kernel("float64(float64[:, ::1], int64[::1], float64)", counts=False)
def _scatter(points, ends, epsilon):
    """Return the mean square of how far the points between ends of ranges are off their segments."""
    total, inner = 0.0, 0
    for m in range(len(ends) - 1):
        total += _bent(points, ends[m], ends[m + 1], epsilon)
        inner += ends[m + 1] - ends[m] - 1
    return total / max(inner, 1)


@kernel("int64(float64[:, ::1], float64, boolean[::1], int64[::1])")
def settle(points, epsilon, stop, ends):
    """Move ends of ranges (m,), in place, to where both ranges beside are clearly straighter, and take out those
    without which one range is as straight; return how many are left. No stop is moved.

    Of few points some are straight by chance: one range is as straight, too, where it is as straight as all are.
    """
    count, least, off = len(ends), np.empty(1), np.empty(1)
    for _ in range(_ROUNDS):
        kept, changed, scatter = 1, False, _scatter(points, ends[:count], epsilon)
        for m in range(1, count - 1):
            i, e, k = ends[kept - 1], ends[m], ends[m + 1]
            if not stop[e]:
                at = _straightest(points, i, e, k, epsilon, least)
                chance = max(least[0], scatter * (k - i - 1))
                _farthest(points, i, k, off)
                rounded = off[0] ** 2 <= _CHANCE * scatter and off[0] <= epsilon
                straight = rounded or _bent(points, i, k, epsilon) <= _CLEARLY * chance
                if k - i >= _EVIDENCE and straight:
                    changed = True
                    continue
                if _bent(points, i, e, epsilon) + _bent(points, e, k, epsilon) > _CLEARLY * least[0]:
                    e, changed = at, True
            ends[kept] = e
            kept += 1
        ends[kept] = ends[count - 1]
        count = kept + 1
        if not changed:
            break
    return count
