# mypy: allow-untyped-defs
"""Compiled inner loop of the time estimate: look-ahead over the whole program, then a trapezoid of speed for each
motion.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

SERVO_PERIOD = 1e-3
"""s, in which an axis may change its velocity at a corner by acceleration x period; only the part of the speed that
goes on in the new direction is carried, so a right corner stops.
"""
FINE = 0.2
"""Largest tangent of half a corner's turn, 23 degrees in all, with which short lines count as standing for a curve."""
FAST = 6.0
"""Where the curve would allow more than so many times the speed there is, it is as good as straight."""
BETWEEN = 0.52
"""By how much a corner of a curve is slower, in tangents of half its turn: between two corners the speed rises, and the
whole must not be faster than the curve.
"""


@kernel("float64(float64[:, :, ::1], int64, float64[::1])")
def every_way(ways, i, limits):
    """Return what limits of the axes allow in every direction of the plane in which the path turns behind motion i."""
    a, b = ways[i, 1], ways[i + 1, 0]
    normal = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    squared = max(normal[0] ** 2 + normal[1] ** 2 + normal[2] ** 2, 1e-30)
    least = math.inf
    for axis in range(3):
        least = min(least, limits[axis] / math.sqrt(max(1.0 - normal[axis] ** 2 / squared, 1e-18)))
    return least


@kernel("void(float64[:, ::1], int64, int64, float64, float64)")
def slow_down(motions, first, stop, speed, acceleration):
    """Lower the limits of motions `first` to `stop`, `stop` excluded."""
    for i in range(first, stop):
        motions[i, 1] = min(motions[i, 1], speed)
        motions[i, 2] = min(motions[i, 2], acceleration)


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64[::1], float64[:, ::1], float64[::1])")
def corners(ways, motions, tolerance, limits, entry):
    """Write the greatest speed between each two of n motions by the tolerance of the corner, mm/s; 0 at both ends of
    all.

    Args:
        ways: (n, 2, 3) unit vectors in which each motion sets out and arrives.
        motions: (n, 3) of each, length, greatest speed and acceleration along it.
        tolerance: (n - 1,) how far the control leaves the corner behind each motion, mm; < 0: it stops there.
        limits: (2, 3) greatest velocity, mm/s, and acceleration, mm/s2, of the axes.
        entry: (n + 1,) the answer.
    """
    n = len(motions)
    entry[0] = entry[n] = 0.0
    for i in range(n - 1):
        entry[i + 1] = 0.0
        if tolerance[i] < 0.0:
            continue
        x, y, z = (
            ways[i + 1, 0, 0] - ways[i, 1, 0],
            ways[i + 1, 0, 1] - ways[i, 1, 1],
            ways[i + 1, 0, 2] - ways[i, 1, 2],
        )
        squared = x * x + y * y + z * z
        half = math.sqrt(max(0.0, 1.0 - 0.25 * squared))
        if half >= 1.0:
            entry[i + 1] = math.inf
        else:
            change = min(limits[1, 0] / abs(x), limits[1, 1] / abs(y), limits[1, 2] / abs(z))
            # the arc that touches both ways and passes the corner at the tolerance, at the acceleration of the weakest
            # axis
            blend = math.sqrt(change * math.sqrt(squared) * tolerance[i] * half / (1.0 - half))
            entry[i + 1] = max(blend, change * SERVO_PERIOD * max(0.0, 1.0 - 0.5 * squared))


@kernel("void(float64[:, :, ::1], float64[:, ::1], float64[:, ::1], float64[::1])")
def curves(ways, motions, limits, entry):
    """Lower the speeds to what a curve allows that short lines may stand for.

    How bent it is at a corner, the turn and the straight ways before and behind it tell: its radius is that of the arc
    that touches both in their middles. Straight ways are whole, however many motions they are written as. Where turns
    are small and the curve counts, speed and acceleration are those that the axes have in every direction of its plane,
    as on an arc.

    Args:
        ways, motions, limits: as for `corners`; speeds and accelerations of motions are lowered.
        entry: (n + 1,) what `corners` has found, lowered.
    """
    n = len(motions)
    first = corner = 0
    before = straight = tangent = 0.0
    for i in range(n):
        straight += motions[i, 0]
        turn = 0.0
        if i < n - 1:
            x, y, z = (
                ways[i + 1, 0, 0] - ways[i, 1, 0],
                ways[i + 1, 0, 1] - ways[i, 1, 1],
                ways[i + 1, 0, 2] - ways[i, 1, 2],
            )
            squared = 0.25 * (x * x + y * y + z * z)
            half = math.sqrt(max(0.0, 1.0 - squared))
            if half >= 1.0:
                continue
            turn = math.sqrt(squared) / max(half, 1e-9)
        if corner and entry[corner] > 0.0:
            a = every_way(ways, corner - 1, limits[1])
            # v² = a r, with r = half the mean of both straights over the tangent of half the turn
            bound = math.sqrt(0.25 * (before + straight) / tangent * a) / (1.0 + BETWEEN * tangent)
            entry[corner] = min(entry[corner], bound)
            if tangent < FINE and bound < FAST * max(motions[corner - 1, 1], motions[corner, 1]):
                slow_down(motions, first, i + 1, every_way(ways, corner - 1, limits[0]), a)
        first, corner, before, straight, tangent = corner, i + 1, straight, 0.0, turn


@kernel("void(float64[:, ::1], float64[::1], float64[::1])")
def run(motions, entry, seconds):
    """Write how long each motion takes.

    Args:
        motions: (n, 3) of each, length, mm, > 0; greatest speed in it, mm/s, > 0; acceleration along the path, mm/s2, >
            0.
        entry: (n + 1,) greatest speed at the beginning of each motion and at the end of the last, mm/s; it is lowered
            to what can be reached from one side and braked to from the other.
        seconds: (n,) the answer.
    """
    n = len(motions)
    # backward: from no motion can more be braked than its length allows
    for i in range(n - 1, -1, -1):
        entry[i] = min(entry[i], motions[i, 1], math.sqrt(entry[i + 1] ** 2 + 2.0 * motions[i, 2] * motions[i, 0]))
    for i in range(n):
        length, most, a = motions[i]
        entry[i + 1] = min(entry[i + 1], most, math.sqrt(entry[i] ** 2 + 2.0 * a * length))
        first, last = entry[i], entry[i + 1]
        # the speed at which speeding up and braking meet, v² = a l + (first² + last²) / 2
        top = min(most, math.sqrt(a * length + 0.5 * (first * first + last * last)))
        top = max(top, first, last)
        ramps = (top * top - first * first + top * top - last * last) / (2.0 * a)
        seconds[i] = (top - first + top - last) / a + max(0.0, length - ramps) / top
