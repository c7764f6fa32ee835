# mypy: allow-untyped-defs
"""Compiled: which place of a curve answers to which point of a polyline, and how far apart the two are."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .tube_kernels import (
    INSIDE,
    OUTSIDE,
    UNDECIDED,
    first_entry,
    first_exit,
    halved,
    holds_point,
    point_at,
    portion,
    squared_off_chord,
)

MOST = 4
"""Stretches of the curve from which one point can be reached that are kept; more come only where it goes to and fro
there.
"""
_GOLDEN = 0.3819660112501051
"""(3 - sqrt 5) / 2 of a stretch: where golden sections ask, from either end."""


@kernel("float64(float64[:, :, ::1], float64, float64, float64[::1], float64[::1])", counts=False)
def _nearest(control, low, high, point, here):
    """Return the place of a stretch that is nearest to a point: of five in it, and by golden sections from there."""
    step, best, least = (high - low) / 4, low, math.inf
    for k in range(5):
        point_at(control, low + k * step, here)
        off = squared_off_chord(here, point, point)
        if off < least:
            best, least = low + k * step, off
    # Between the neighbours of the best of five the distance is taken to have one least place.
    low, high = max(low, best - step), min(high, best + step)
    for _ in range(32):
        one, two = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        point_at(control, one, here)
        first = squared_off_chord(here, point, point)
        point_at(control, two, here)
        if first < squared_off_chord(here, point, point):
            high = two
        else:
            low = one
    middle = 0.5 * (low + high)
    point_at(control, middle, here)
    return middle if squared_off_chord(here, point, point) < least else best


@kernel("float64(float64[::1], float64[::1], float64[::1])", counts=False)
def _share(c, a, b):
    """Return where on a chord it is nearest to a point, as a part of it."""
    size, along = 0.0, 0.0
    for axis in range(3):
        size += (b[axis] - a[axis]) ** 2
        along += (b[axis] - a[axis]) * (c[axis] - a[axis])
    return min(max(along / size, 0.0), 1.0) if size > 0.0 else 0.0


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64, float64[::1])")
def guess(control, points, slack, feet):
    """Write a likely place (n,) for each point, never falling: the nearest of those about as far along.

    Args:
        slack: how much longer than the chord the way from one place to the next may be, mm.
    """
    per = max(4, len(points) // len(control) + 1)
    count = len(control) * per
    samples, along = np.empty((count + 1, 3)), np.zeros(count + 1)
    for k in range(count + 1):
        point_at(control, k / per, samples[k])
        if k > 0:
            along[k] = along[k - 1] + math.sqrt(squared_off_chord(samples[k], samples[k - 1], samples[k - 1]))
    feet[0], feet[-1] = 0.0, float(len(control))
    k, share = 0, 0.0
    for i in range(1, len(points) - 1):
        chord = math.sqrt(squared_off_chord(points[i], points[i - 1], points[i - 1]))
        # samples may be farther apart than that
        reach = along[k] + share * (along[min(k + 1, count)] - along[k]) + 1.2 * chord + slack
        best, nearest = k, squared_off_chord(points[i], samples[k], samples[min(k + 1, count)])
        j = k + 1
        while j < count and along[j] <= reach:
            off = squared_off_chord(points[i], samples[j], samples[j + 1])
            if off < nearest:
                best, nearest = j, off
            j += 1
        k, share = best, _share(points[i], samples[best], samples[min(best + 1, count)])
        feet[i] = max(feet[i - 1], (k + share) / per)


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64[::1])")
def settle(control, points, feet):
    """Move each foot nearer to its point, by a step of Newton's in its own piece; their order stays.

    Args:
        control: (m, 6, 3) pieces. feet: (n,) places in [0, m]; the outer ones stay.
    """
    c, d, e = np.empty((6, 3)), np.empty(3), np.empty(3)
    for i in range(1, len(points) - 1):
        k = min(int(feet[i]), len(control) - 1)
        t = feet[i] - k
        c[:] = control[k]
        for level in range(5):
            if level == 3:
                for axis in range(3):
                    # Three points left of six: second derivative, 5 * 4 times their second difference.
                    e[axis] = 20.0 * (c[2, axis] - 2 * c[1, axis] + c[0, axis])
            if level == 4:
                for axis in range(3):
                    d[axis] = 5.0 * (c[1, axis] - c[0, axis])
            for j in range(5 - level):
                for axis in range(3):
                    c[j, axis] = (1.0 - t) * c[j, axis] + t * c[j + 1, axis]
        slope, bend = 0.0, 0.0
        for axis in range(3):
            off = c[0, axis] - points[i, axis]
            slope += off * d[axis]
            bend += d[axis] * d[axis] + off * e[axis]
        # Slope and bend are halves of the derivatives of the squared distance; where it curves down Newton would
        # climb.
        if bend > 0.0:
            t = min(max(t - slope / bend, 0.0), 1.0)
        feet[i] = max(k + t, feet[i - 1])
    for i in range(len(points) - 2, 0, -1):
        # Order once more from behind: what was pushed on must not have gone beyond the end.
        feet[i] = min(feet[i], feet[i + 1])


@kernel("UniTuple(int64, 2)(float64[:, :, ::1], float64[:, ::1], float64[::1], float64, float64)")
def proven(control, points, feet, end, swell):
    """Return INSIDE, or what the first chord that is not proven gives, and its number.

    Args:
        feet: (n,) where on the curve each point is answered to, never falling, 0 first and all of the curve last.
    """
    here = np.empty(3)
    for i in range(len(points)):
        point_at(control, feet[i], here)
        if not holds_point(here, points[i], points[i], end, 0.0):
            return OUTSIDE, min(i, len(points) - 2)
    for i in range(len(points) - 1):
        until = first_exit(control, feet[i], feet[i + 1], points[i], points[i + 1], end, swell)
        if until < feet[i + 1]:
            return UNDECIDED, i
    return INSIDE, -1


@kernel(
    "UniTuple(int64, 2)(float64[:, :, ::1], float64[:, ::1], float64, float64, float64[:, :, ::1], int64[::1], "
    "float64[::1])"
)
def reach(control, points, end, swell, ways, counts, witness):
    """Find the places of the curve that can answer to each point, in order: INSIDE and -1 where the last one is
    reached.

    Args:
        ways: (n, MOST, 2) stretches of the curve, out. counts: (n,) how many, out.
        witness: (1,) out: where the curve leaves the region of the chord that is returned beside OUTSIDE.
    """
    stop = float(len(control))
    here = np.empty(3)
    point_at(control, 0.0, here)
    if not holds_point(here, points[0], points[0], end, 0.0):
        witness[0] = 0.0
        return OUTSIDE, 0
    ways[0, 0, 0], ways[0, 0, 1], counts[0] = 0.0, 0.0, 1
    for i in range(len(points) - 1):
        a, b = points[i], points[i + 1]
        found, until = 0, -1.0
        for w in range(counts[i]):
            start = ways[i, w, 0]
            # The last way has come by here within the region of this very chord: what it reached is all that is
            # reached.
            if start < until:
                continue
            until = first_exit(control, start, stop, a, b, end, swell)
            at = first_entry(control, start, until, b, end)
            while at <= until and found < MOST:
                # One stretch in which the point's ball is not left; the curve may come back to it farther on.
                left = first_exit(control, at, until, b, b, end, 0.0)
                ways[i + 1, found, 0], ways[i + 1, found, 1] = at, left
                found += 1
                if left >= until:
                    break
                at = first_entry(control, left + max(1e-9, 1e-9 * left), until, b, end)
        counts[i + 1] = found
        if found == 0:
            witness[0] = until
            return OUTSIDE, i
    last = counts[len(points) - 1] - 1
    if ways[len(points) - 1, last, 1] < stop:
        witness[0] = ways[len(points) - 1, last, 1]
        return OUTSIDE, len(points) - 2
    return INSIDE, -1


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64, float64, float64[:, :, ::1], int64[::1], float64[::1])")
def step_back(control, points, end, swell, ways, counts, feet):
    """Write a place (n,) for each point out of those that `reach` has found: the nearest from which the next is
    reached.
    """
    last, here = len(points) - 1, np.empty(3)
    feet[last] = float(len(control))
    for i in range(last - 1, -1, -1):
        # Each way was reached from one of the point before, so from behind no choice leads into a dead end.
        for w in range(counts[i] - 1, -1, -1):
            low, high = ways[i, w, 0], min(ways[i, w, 1], feet[i + 1])
            if (
                low <= high
                and first_exit(control, low, feet[i + 1], points[i], points[i + 1], end, swell) >= feet[i + 1]
            ):
                feet[i] = _nearest(control, low, high, points[i], here)
                break


@kernel("UniTuple(float64, 4)(float64[:, :, ::1], float64[:, ::1], float64[::1])")
def found_apart(control, points, feet):
    """Return the largest distance found from the curve and where, of three places a chord; and from a point and
    which.
    """
    here, back, which, found, where = np.empty(3), 0.0, 0.0, 0.0, 0.0
    for i in range(len(points)):
        point_at(control, feet[i], here)
        off = math.sqrt(squared_off_chord(here, points[i], points[i]))
        if off > back:
            back, which = off, float(i)
    for i in range(len(points) - 1):
        for k in range(1, 4):
            u = feet[i] + (feet[i + 1] - feet[i]) * k / 4
            point_at(control, u, here)
            off = math.sqrt(squared_off_chord(here, points[i], points[i + 1]))
            if off > found:
                found, where = off, u
    return found, where, back, which


@kernel("float64(float64[:, ::1], float64[::1], float64[::1])", counts=False)
def _most_off(piece, a, b):
    """Return a distance from a chord that no place of a piece exceeds: that of its farthest control point."""
    most = 0.0
    # The distance from a chord is convex, and a piece lies in the hull of its control points: none of its places is
    # farther than the farthest of these.
    for k in range(len(piece)):
        most = max(most, squared_off_chord(piece[k], a, b))
    return math.sqrt(most)


@kernel("UniTuple(float64, 3)(float64[:, :, ::1], float64[:, ::1], float64[::1], float64, UniTuple(float64, 3))")
def bound_apart(control, points, feet, share, start):
    """Return a proven bound of how far curve and polyline are apart, the largest distance found from the curve, and
    where.

    Args:
        share: the bound is not more than so much larger than the largest found, as a part of it.
        start: what was found before: from the curve and where, and from a point.
    """
    work, ends, level = np.empty((66, 6, 3)), np.empty((66, 2)), np.empty(66)
    found, where, back = start
    bound = max(found, back)
    for i in range(len(points) - 1):
        low = feet[i]
        while low < feet[i + 1]:
            high = min(math.floor(low) + 1.0, feet[i + 1])
            portion(control, low, high, work[0])
            ends[0, 0], ends[0, 1], level[0], depth = low, high, 0.0, 1
            while depth > 0:
                depth -= 1
                most = _most_off(work[depth], points[i], points[i + 1])
                # Halves of a piece have hulls four times as tight, so few are looked into: those where the hull says
                # more than what was found.
                if most <= max(found, back) * (1.0 + share) + 1e-12 or level[depth] >= 60.0:
                    bound = max(bound, most)
                    continue
                first, middle, last = ends[depth, 0], 0.5 * (ends[depth, 0] + ends[depth, 1]), ends[depth, 1]
                work[65] = work[depth]
                halved(work[65], work[depth], work[depth + 1])
                off = math.sqrt(squared_off_chord(work[depth + 1, 0], points[i], points[i + 1]))
                if off > found:
                    found, where = off, middle
                ends[depth, 0], ends[depth, 1], ends[depth + 1, 0], ends[depth + 1, 1] = first, middle, middle, last
                level[depth] += 1.0
                level[depth + 1] = level[depth]
                depth += 2
            low = high
    return max(bound, found), found, where


@kernel("float64(float64[::1], float64[:, ::1], int64)", counts=False)
def _off_near(here, points, chord):
    """Return the squared distance of a place from the chords up to 256 before and behind one."""
    least = math.inf
    for k in range(max(0, chord - 256), min(len(points) - 1, chord + 257)):
        least = min(least, squared_off_chord(here, points[k], points[k + 1]))
    return least


@kernel("UniTuple(float64, 3)(float64[:, :, ::1], float64, float64[:, ::1], int64, float64, float64)")
def excursion(control, left, points, chord, end, swell):
    """Return where a curve that leaves the region of a chord is farthest from the path before it comes back, and how
    far.

    Returns:
        Parameter, distance, mm, and 1 where a place outside of the region was found, or the curve ends there, else 0.
    """
    here, stop, step = np.empty(3), float(len(control)), 1e-9
    best, most, u, steps, out = left, -1.0, left, 0, 0.0
    if left >= stop:
        point_at(control, stop, here)
        return stop, math.sqrt(squared_off_chord(here, points[chord + 1], points[chord + 1])), 1.0
    while u <= stop and steps < 4000:
        point_at(control, u, here)
        held = holds_point(here, points[chord], points[chord + 1], end, swell)
        if held and out == 1.0 and steps > 60:
            break
        if not held:
            out = 1.0
        off = _off_near(here, points, chord)
        if off > most:
            best, most = u, off
        # Small steps near the exit, where the way out may be short; longer ones as it goes on.
        step = min(step * 1.3, 1.0 / 64)
        u, steps = (stop if u < stop < u + step else u + step), steps + 1
    low, high = max(left, best - step), min(stop, best + step)
    for _ in range(48):
        one, two = low + _GOLDEN * (high - low), high - _GOLDEN * (high - low)
        point_at(control, one, here)
        first = _off_near(here, points, chord)
        point_at(control, two, here)
        if first > _off_near(here, points, chord):
            high = two
        else:
            low = one
    point_at(control, low, here)
    off = _off_near(here, points, chord)
    return (low, math.sqrt(off), out) if off > most else (best, math.sqrt(most), out)


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64[::1], float64[::1])")
def off_chords(control, points, feet, off):
    """Write how far each piece is found from the chords that it answers to, at most, mm: at feet and half way
    between.
    """
    here, last = np.empty(3), len(control) - 1
    off[:] = 0.0
    for i in range(len(points) - 1):
        for u in (feet[i], 0.5 * (feet[i] + feet[i + 1])):
            point_at(control, u, here)
            k = min(int(u), last)
            end = i if u == feet[i] else i + 1
            off[k] = max(off[k], math.sqrt(squared_off_chord(here, points[i], points[end])))
