"""Compiled: the longest line or arc that stands for points from one of them on. A path is (n, 3): two axes of a plane and its normal."""

from __future__ import annotations

import math

import numpy as np

from app.jit import kernel

LINE, ARC = 0, 1
_LEAST_CHORDS = 3
"""An arc stands for so many chords at least: two points and a bend between them are no evidence of one."""
_WIDEST = 4.0
"""Largest sweep of one arc, radians: well below a full turn, which an arc with nearly the same ends may be taken for."""
_HIGHEST = 2.0
"""Tangent of a quarter of a sweep, a little more than the widest has."""
_PATIENCE = 8
"""Arcs are tried up to so many times as far as a line goes, though none shorter holds: noise hides what short pieces are."""


@kernel("boolean(float64[:, ::1], int64, int64, float64)", counts=False)
def line_holds(points, i, j, limit):  # type: ignore[no-untyped-def]
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


@kernel("float64(float64, float64)", counts=False)
def _height_through(x, y):  # type: ignore[no-untyped-def]
    """Return the height of the arc over (-1, 0) to (1, 0) through a point: t with y t^2 + (1 - x^2 - y^2) t - y = 0."""
    b = 1.0 - x * x - y * y
    return 2.0 * y / (b + math.sqrt(b * b + 4.0 * y * y)) if b > 0.0 or y != 0.0 else 0.0


@kernel("UniTuple(float64, 2)(float64, float64, float64)", counts=False)
def _heights(x, y, off):  # type: ignore[no-untyped-def]
    """Return between which heights an arc over the chord from (-1, 0) to (1, 0) passes a point within `off` of it.

    The circle of height t passes (x, y) where x^2 + y^2 + y (1 / t - t) = 1; its distance from a point near it is that
    equation's error over its slope, which is near enough here: what is found is measured.
    """
    rest = 1.0 - x * x
    if rest <= 0.0:
        return -_HIGHEST, _HIGHEST
    low, high = y - off, y + off
    return _height_through(x, low), _height_through(x, high)


@kernel("float64(float64[:, ::1], int64, float64, float64)", counts=False)
def _nearest(points, k, cx, cy):  # type: ignore[no-untyped-def]
    """Return how near the chord behind point k comes to a centre."""
    dx, dy = points[k + 1, 0] - points[k, 0], points[k + 1, 1] - points[k, 1]
    px, py = cx - points[k, 0], cy - points[k, 1]
    size = dx * dx + dy * dy
    share = min(max((px * dx + py * dy) / size, 0.0), 1.0) if size > 0.0 else 0.0
    return math.sqrt((px - share * dx) ** 2 + (py - share * dy) ** 2)


@kernel("boolean(float64[:, ::1], int64, int64, float64, float64, float64, float64[::1])", counts=False)
def _holds(points, i, j, limit, largest, height, found):  # type: ignore[no-untyped-def]
    """Tell whether the arc of a height keeps within a limit of the path, both ways and in order, its normal in step."""
    dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
    chord = math.sqrt(dx * dx + dy * dy)
    if height == 0.0:
        return False
    up = (0.25 * chord * chord - height * height) / (2.0 * height)  # from the centre to the chord, along its left normal
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
    square, near = limit * limit, radius
    for k in range(i + 1, j + 1):
        px, py = points[k, 0] - cx, points[k, 1] - cy
        angle = turn * math.atan2(ax * py - ay * px, ax * px + ay * py)
        if angle < -0.1:
            angle += 2.0 * math.pi
        here = min(max(angle, before), sweep) if k < j else sweep
        fx = cx + math.cos(turn * here) * ax - math.sin(turn * here) * ay
        fy = cy + math.sin(turn * here) * ax + math.cos(turn * here) * ay
        ox, oy, oz = points[k, 0] - fx, points[k, 1] - fy, points[k, 2] - points[i, 2] - rise * here / sweep
        if ox * ox + oy * oy + oz * oz > square:
            return False
        near = _nearest(points, k - 1, cx, cy)
        rest = limit * limit - oz * oz
        if radius - near > math.sqrt(max(rest, 0.0)):
            return False
        before = here
    found[0] = height
    return True


@kernel("boolean(float64[:, ::1], int64, int64, float64, float64, float64[::1])", counts=False)
def arc_holds(points, i, j, limit, largest, found):  # type: ignore[no-untyped-def]
    """Tell whether an arc from point i to point j keeps within a limit of the path between; write its height over the chord.

    Every point and every middle of a chord allows heights between two values; one between all of them is tried.

    Args:
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
    for k in range(2 * (i + 1), 2 * j):
        a, b = k // 2, k // 2 + k % 2
        px = 0.5 * (points[a, 0] + points[b, 0]) - mx
        py = 0.5 * (points[a, 1] + points[b, 1]) - my
        x, y = (px * ux + py * uy) / half, (py * ux - px * uy) / half
        first, last = _heights(x, y, limit / half)
        low, high = max(low, first), min(high, last)
        if low > high:
            return False
    return _holds(points, i, j, limit, largest, 0.5 * (low + high) * half, found)


@kernel("UniTuple(int64, 2)(float64[:, ::1], int64, int64, float64, float64, int64, float64[::1])", counts=False)
def farthest(points, i, stop, limit, largest, kinds, found):  # type: ignore[no-untyped-def]
    """Return the last point that one line (or, with kinds 1, arc) from point i can end at, and which of both it is.

    Looked for in doubled steps, then by halving; the height of an arc is written to `found`.
    """
    best, kind, height = i + 1, LINE, 0.0
    for which in range(kinds + 1):
        good, bad = i + 1, stop + 1
        step = 2 if which == LINE else max(_LEAST_CHORDS, best - i)
        patience = _PATIENCE * step
        j = good
        while j < stop:
            j = min(i + step, stop)
            held = line_holds(points, i, j, limit) if which == LINE else arc_holds(points, i, j, limit, largest, found)
            if held:
                good, step = j, step * 2
                if which == ARC and j > best:
                    best, kind, height = j, ARC, found[0]
            elif which == ARC and good == i + 1 and step < patience:
                step *= 2
            else:
                bad = j
                break
        while bad - good > 1:
            j = (good + bad) // 2
            held = line_holds(points, i, j, limit) if which == LINE else arc_holds(points, i, j, limit, largest, found)
            if held:
                good = j
                if which == ARC and j > best:
                    best, kind, height = j, ARC, found[0]
            else:
                bad = j
        if which == LINE and good > best:
            best, kind = good, LINE
    found[0] = height
    return best, kind


@kernel("int64(float64[:, :, ::1], int64, int64, float64, float64, int64, int64[:, ::1], float64[::1])")
def greedy(planes, first, stop, limit, largest, kinds, rows, heights):  # type: ignore[no-untyped-def]
    """Cover points first to stop with the longest lines and arcs, one after the other; return how many.

    Args:
        planes: (p, n, 3) the points, seen in so many planes.
        rows: (n, 3) out: the last point, kind and plane of each. heights: (n,) out: of the arcs over their chords.
    """
    count, i, found = 0, first, np.empty(1)
    while i < stop:
        best = i
        for p in range(len(planes)):
            j, kind = farthest(planes[p], i, stop, limit, largest, kinds, found)
            if j > best:
                best = j
                rows[count, 0], rows[count, 1], rows[count, 2], heights[count] = j, kind, p, found[0]
        i = best
        count += 1
    return count
