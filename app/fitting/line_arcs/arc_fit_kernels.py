# mypy: allow-untyped-defs
"""Compiled: the longest line or arc that stands for points from one of them on. A path is (n, 3): two axes of a plane
and its normal.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

LINE, ARC = 0, 1
"""Kinds of what stands for points from one of them on."""
_LEAST_CHORDS = 3
"""An arc stands for so many chords at least: two points and a bend between them are no evidence of one."""
_WIDEST = 4.0
"""Largest sweep of one arc, radians: well below a full turn, which an arc with nearly the same ends may be taken
for.
"""
_HIGHEST = 2.0
"""Tangent of a quarter of a sweep, a little more than the widest has."""
_LAG = 0.02
"""Along a chord and along its arc the normal rises alike but for so much, times its rise and the squared angle."""
_PLACES, _SURE = 16, 0.98
"""Where on a chord a circle is held to a region that is wider between points, and how much of the squared distance it
may use there.
"""
_PATIENCE = 8
"""Arcs are tried up to so many times as far as a line goes, though none shorter holds: noise hides what short pieces
are.
"""


@kernel("boolean(float64[:, ::1], int64, int64, float64)", counts=False)
def line_holds(points, i, j, limit):
    """Tell whether points i to j keep within a limit of the chord from i to j, in order."""
    dx, dy, dz = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1], points[j, 2] - points[i, 2]
    size = dx * dx + dy * dy + dz * dz
    if size == 0.0:
        return False
    farthest, square = 0.0, limit * limit
    for k in range(i + 1, j):
        px, py, pz = points[k, 0] - points[i, 0], points[k, 1] - points[i, 1], points[k, 2] - points[i, 2]
        share = (px * dx + py * dy + pz * dz) / size
        farthest = min(max(farthest, share), 1.0)  # the foot never goes back
        px, py, pz = px - farthest * dx, py - farthest * dy, pz - farthest * dz
        if px * px + py * py + pz * pz > square:
            return False
    return True


@kernel("UniTuple(float64, 2)(float64, float64, float64)", counts=False)
def _heights(x, y, off):
    """Return between which heights an arc over the chord from (-1, 0) to (1, 0) passes a point within `off` of it.

    A circle of height t has the centre (0, (t - 1 / t) / 2) and the radius (t + 1 / t) / 2. The point is `off` above or
    below it where (y +- off) t^2 + (1 + off^2 - x^2 - y^2) t - (y -+ off) = 0: two equations of one discriminant.
    """
    if (abs(x) - 1.0) ** 2 + y * y <= off * off:
        return -_HIGHEST, _HIGHEST
    b = 1.0 + off * off - x * x - y * y
    square = b * b + 4.0 * (y * y - off * off)
    if square < 0.0 or (b <= 0.0 and abs(y) <= off):  # beside an end: what is found is measured
        return -_HIGHEST, _HIGHEST
    root = b + math.sqrt(square)
    return 2.0 * (y - off) / root, 2.0 * (y + off) / root


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _nearest(points, k, cx, cy):
    """Return how near the chord behind point k comes to a centre."""
    dx, dy = points[k + 1, 0] - points[k, 0], points[k + 1, 1] - points[k, 1]
    px, py = cx - points[k, 0], cy - points[k, 1]
    size = dx * dx + dy * dy
    share = min(max((px * dx + py * dy) / size, 0.0), 1.0) if size > 0.0 else 0.0
    return math.sqrt((px - share * dx) ** 2 + (py - share * dy) ** 2)


@kernel("boolean(float64[:, ::1], int64, float64, float64, float64, float64, float64, float64)", counts=False)
def _bulges(points, k, cx, cy, radius, limit, swell, lag):
    """Tell whether a circle leaves the region round the chord behind point k to its other side."""
    if swell == 0.0:
        bulge = max(radius - _nearest(points, k, cx, cy), 0.0)
        return bulge * bulge + lag * lag > limit * limit
    for n in range(1, _PLACES):
        share = n / _PLACES
        px = points[k, 0] + share * (points[k + 1, 0] - points[k, 0]) - cx
        py = points[k, 1] + share * (points[k + 1, 1] - points[k, 1]) - cy
        bulge = max(radius - math.sqrt(px * px + py * py), 0.0)
        if bulge * bulge + lag * lag > _SURE * limit * limit * (1.0 + 4.0 * swell * share * (1.0 - share)):
            return True
    return False


@kernel("boolean(float64[:, ::1], int64, int64, float64, float64, float64, float64, float64[::1])", counts=False)
def _holds(points, i, j, limit, swell, largest, height, found):
    """Tell whether the arc of a height keeps within a limit of the path, both ways and in order, its normal in step."""
    dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
    chord = math.sqrt(dx * dx + dy * dy)
    if height == 0.0:
        return False
    # from the centre to the chord, along its left normal
    up = (0.25 * chord * chord - height * height) / (2.0 * height)
    radius = math.sqrt(0.25 * chord * chord + up * up)
    if radius > largest or radius < limit:
        return False
    cx = 0.5 * (points[i, 0] + points[j, 0]) + up * dy / chord
    cy = 0.5 * (points[i, 1] + points[j, 1]) - up * dx / chord
    turn = -1.0 if height > 0.0 else 1.0  # an arc left of its chord runs clockwise
    sweep = 4.0 * math.atan(abs(height) / (0.5 * chord))
    if sweep > _WIDEST:
        return False
    ax, ay = points[i, 0] - cx, points[i, 1] - cy
    before, rise = 0.0, points[j, 2] - points[i, 2]
    beside = 0.0
    for k in range(i + 1, j + 1):
        px, py = points[k, 0] - cx, points[k, 1] - cy
        angle = turn * math.atan2(ax * py - ay * px, ax * px + ay * py)
        if angle < -0.1:
            angle += 2.0 * math.pi
        here = min(max(angle, before), sweep) if k < j else sweep
        fx = cx + math.cos(turn * here) * ax - math.sin(turn * here) * ay
        fy = cy + math.sin(turn * here) * ax + math.cos(turn * here) * ay
        ox, oy, oz = points[k, 0] - fx, points[k, 1] - fy, points[k, 2] - points[i, 2] - rise * here / sweep
        if ox * ox + oy * oy + oz * oz > limit * limit:
            return False
        lag = max(beside, abs(oz)) + _LAG * (here - before) ** 2 * abs(points[k, 2] - points[k - 1, 2])
        if _bulges(points, k - 1, cx, cy, radius, limit, swell, lag):
            return False
        before, beside = here, abs(oz)
    found[0] = height
    return True


@kernel("boolean(float64[:, ::1], int64, int64, float64, float64, float64, float64[::1])", counts=False)
def arc_holds(points, i, j, limit, swell, largest, found):
    """Tell whether an arc from point i to point j keeps within a limit of the path between; write its height over the
    chord.

    Every point and every middle of a chord allows heights between two values; one between all of them is tried.

    Args:
        swell: the squared limit half way between two points exceeds that at them by so many times that.
        largest: radius, mm.
        found: (1,) out: signed height of the arc over its chord, left of it positive, mm.
    """
    dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
    half = 0.5 * math.sqrt(dx * dx + dy * dy)
    if j - i < _LEAST_CHORDS or half == 0.0:
        return False
    ux, uy = 0.5 * dx / half, 0.5 * dy / half
    mx, my = 0.5 * (points[i, 0] + points[j, 0]), 0.5 * (points[i, 1] + points[j, 1])
    low, high = -_HIGHEST, _HIGHEST  # of tan(sweep / 4), signed
    wide = limit * math.sqrt(1.0 + swell)
    for k in range(2 * (i + 1), 2 * j):
        a, b = k // 2, k // 2 + k % 2
        px = 0.5 * (points[a, 0] + points[b, 0]) - mx
        py = 0.5 * (points[a, 1] + points[b, 1]) - my
        x, y = (px * ux + py * uy) / half, (py * ux - px * uy) / half
        first, last = _heights(x, y, (limit if a == b else wide) / half)
        low, high = max(low, first), min(high, last)
        if low > high:
            return False
    return _holds(points, i, j, limit, swell, largest, 0.5 * (low + high) * half, found)


@kernel("boolean(float64[:, ::1], int64, int64, int64, float64, float64, float64, float64[::1])", counts=False)
def holds(points, i, j, kind, limit, swell, largest, found):
    """Tell whether a line, or an arc in the points' plane, stands for points i to j."""
    if kind == LINE:
        return line_holds(points, i, j, limit)
    return arc_holds(points, i, j, limit, swell, largest, found)


@kernel("int64(float64[:, ::1], int64, int64, int64, int64, float64, float64, float64, float64[::1])", counts=False)
def _reach(points, i, stop, least, kind, limit, swell, largest, found):
    """Return the last point beyond `least` that one line or arc from point i can end at, or `least`; an arc's height to
    `found[1]`.

    Looked for all the way first: noise may hide from shorter pieces what holds for all. Then in doubled steps, then by
    halving.
    """
    if least < stop and holds(points, i, stop, kind, limit, swell, largest, found):
        found[1] = found[0]
        return stop
    good, bad = least, stop
    step = 2 if kind == LINE else max(_LEAST_CHORDS, least - i)
    patience = _PATIENCE * step
    while i + step < stop:
        j = i + step
        if holds(points, i, j, kind, limit, swell, largest, found):
            good, found[1] = j, found[0]
        elif kind == LINE or good > least or step >= patience:
            bad = j
            break
        step *= 2
    while bad - good > 1:
        j = (good + bad) // 2
        if holds(points, i, j, kind, limit, swell, largest, found):
            good, found[1] = j, found[0]
        else:
            bad = j
    return good


@kernel(
    "UniTuple(int64, 3)(float64[:, :, ::1], int64, int64, float64, float64, float64, int64, float64[::1])", counts=False
)
def farthest(planes, i, stop, limit, swell, largest, kinds, found):
    """Return the last point that one line (or, with kinds 1, arc) from point i can end at, its kind and plane; its
    height to `found[1]`.
    """
    best, kind, plane, height = _reach(planes[0], i, stop, i + 1, LINE, limit, swell, largest, found), LINE, 0, 0.0
    for p in range(kinds * len(planes)):
        j = _reach(planes[p], i, stop, best, ARC, limit, swell, largest, found)
        if j > best:
            best, kind, plane, height = j, ARC, p, found[1]
    found[1] = height
    return best, kind, plane


@kernel("int64(float64[:, :, ::1], int64, int64, float64, float64, float64, int64, int64[:, ::1], float64[::1])")
def greedy(planes, first, stop, limit, swell, largest, kinds, rows, heights):
    """Cover points first to stop with the longest lines and arcs, one after the other; return how many.

    Args:
        planes: (p, n, 3) the points, seen in so many planes.
        rows: (n, 3) out: the last point, kind and plane of each. heights: (n,) out: of the arcs over their chords.
    """
    count, i, found = 0, first, np.zeros(2)
    while i < stop:
        i, kind, plane = farthest(planes, i, stop, limit, swell, largest, kinds, found)
        rows[count, 0], rows[count, 1], rows[count, 2], heights[count] = i, kind, plane, found[1]
        count += 1
    return count
