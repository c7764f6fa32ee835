# mypy: allow-untyped-defs
"""Compiled segmentation of a sequence of points into lines and arcs (steps 401-406); see `smooth`.

The points of a closed path are given three times over, so that a run may pass its beginning. A segment from a to b
holds the points a ... b, both ends included; neighbours share an end. Kinds: 0 line, 1 arc.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from .moment_kernels import add_up, fit_circle, fit_line, line_residual

LINE, ARC = 0, 1
"""Kinds of a segment."""
LEAST_ARC = 4
"""Steps; three points lie on every circle."""
SHORT = 3
"""Steps; a segment of no more than these may be but a corner that was cut."""


@kernel("boolean(float64[:, ::1], int64, int64, float64[:, ::1], float64)")
def _line_holds(points, a, steps, sums, tolerance):
    """Tell whether points a ... a + steps lie within tolerance of their line and go along it, never back."""
    mx, my, dx, dy = fit_line(sums, 0, steps + 1)
    if dx * (points[a + steps, 0] - points[a, 0]) + dy * (points[a + steps, 1] - points[a, 1]) < 0.0:
        dx, dy = -dx, -dy
    mx, my = mx + points[a, 0], my + points[a, 1]
    for k in range(a, a + steps + 1):
        if abs((points[k, 0] - mx) * dy - (points[k, 1] - my) * dx) > tolerance:
            return False
        if k > a and (points[k, 0] - points[k - 1, 0]) * dx + (points[k, 1] - points[k - 1, 1]) * dy <= 0.0:
            return False
    return True


@kernel("boolean(float64[:, ::1], int64, int64, float64[:, ::1], float64)")
def _arc_holds(points, a, steps, sums, tolerance):
    """Tell whether points a ... a + steps lie within tolerance of their circle, go along it one way, at most once
    round.

    An arc whose sagitta is below twice the tolerance is none (it would be a line of the same points).
    """
    cx, cy, r, _ = fit_circle(sums, 0, steps + 1)
    if r <= tolerance:
        return False
    cx, cy = cx + points[a, 0], cy + points[a, 1]
    # squares are compared, so that no point needs a root
    low, high = (r - tolerance) ** 2, (r + tolerance) ** 2
    px, py = points[a, 0] - cx, points[a, 1] - cy
    if not low <= px * px + py * py <= high:
        return False
    gone, way = 0.0, 0.0
    for k in range(a + 1, a + steps + 1):
        x, y = points[k, 0] - cx, points[k, 1] - cy
        step = px * y - py * x
        if not low <= x * x + y * y <= high or step * way < 0.0 or step == 0.0:
            return False
        way = step
        # r^2 times the sine of the step's angle; angles are small, so the sum over r^2 is nearly the sweep
        gone += abs(step)
        px, py = x, y
    sweep = gone / (r * r)
    # once round is 2 pi, a closed path's last step may reach a little beyond; the sagitta of a sweep s is r (1 - cos
    # s/2)
    return sweep < 6.5 and (sweep > math.pi or r * (1 - math.cos(sweep / 2)) > 2 * tolerance)


@kernel("int64(float64[:, ::1], int64, int64, int64, float64[:, ::1], float64)")
def _longest_line(points, a, most, filled, sums, tolerance):
    """Return how many steps from point a the longest run takes that one line holds: doubling, then halving.

    Args:
        most: steps at most.
        filled: sums are there for so many points from a on.
    """
    good, steps, bad = 1, min(8, most), most + 1
    # doubling keeps the work in proportion to the run that is found, wherever it ends
    while steps > good:
        if steps + 1 > filled:
            add_up(points, a, filled, steps + 1, sums)
            filled = steps + 1
        if not _line_holds(points, a, steps, sums, tolerance):
            bad = steps
            break
        good = steps
        steps = min(2 * steps, most)
    while bad - good > 1:
        steps = (good + bad) // 2
        if _line_holds(points, a, steps, sums, tolerance):
            good = steps
        else:
            bad = steps
    return good


@kernel("int64(float64[:, ::1], int64, int64, int64, float64[:, ::1], float64)")
def _longest_arc(points, a, most, least, sums, tolerance):
    """Return how many steps from point a the longest run takes that one arc holds; 0 where none of `least` steps
    does.
    """
    if least > most:
        return 0
    good, steps, bad, filled = 0, least, most + 1, 0
    while steps > good:
        add_up(points, a, filled, steps + 1, sums)
        filled = steps + 1
        if not _arc_holds(points, a, steps, sums, tolerance):
            if good > 0 or steps >= 2 * least:
                bad = steps
                break
        else:
            good = steps
        if steps == most:
            break
        steps = min(2 * steps, most)
    if good == 0:
        return 0
    while bad - good > 1:
        steps = (good + bad) // 2
        if _arc_holds(points, a, steps, sums, tolerance):
            good = steps
        else:
            bad = steps
    return good


@kernel("int64(float64[:, ::1], int64, int64, float64, int64[::1], int64[::1])")
def segment(points, start, count, tolerance, breaks, kinds):
    """Cover points start ... start + count by the longest line or arc from each segment's end to the next.

    Lines come first: an arc is taken only where it is 1.3 times as long as the line.

    Args:
        points: (n, 2), n > start + count.
        tolerance: greatest distance of a point from its line or circle.
        breaks: (count + 1,) gets the segments' ends, `start` first.
        kinds: (count,) gets their kinds.

    Returns:
        Number of segments.
    """
    sums = np.empty((count + 2, 8))
    at, found = start, 0
    breaks[0] = start
    while at < start + count:
        most = start + count - at
        line = _longest_line(points, at, most, 0, sums, tolerance)
        arc = _longest_arc(points, at, most, max(LEAST_ARC, int(1.3 * line) + 1), sums, tolerance)
        kinds[found] = ARC if arc > 0 else LINE
        at += max(arc, line)
        found += 1
        breaks[found] = at
    return found


@kernel("float64(float64[:, ::1], int64, int64, int64)")
def _cost(sums, first, stop, kind):
    """Return the sum of squared residuals of points first ... stop - 1."""
    n = stop - first
    if kind == LINE:
        return line_residual(sums, first, stop) * n if n > 2 else 0.0
    return fit_circle(sums, first, stop)[3] * n if n > 3 else math.inf


@kernel("int64(float64[:, ::1], UniTuple(int64, 3), UniTuple(int64, 2), float64[:, ::1])")
def _settled(points, ends, kinds, sums):
    """Return where two segments a ... m and m ... c best part, ends = (a, m, c), for both to fit their kinds."""
    a, m, c = ends
    add_up(points, a, 0, c - a + 1, sums)
    first, last = kinds
    low, high = a + (LEAST_ARC if first == ARC else 1), c - (LEAST_ARC if last == ARC else 1)
    best = _cost(sums, 0, m - a + 1, first) + _cost(sums, m - a, c - a + 1, last)
    # a search in steps of 8, 4, 2, 1: the sum of squares has one valley wherever both kinds fit
    step = 8
    while step > 0:
        moved = False
        for side in (-step, step):
            trial = m + side
            if low <= trial <= high:
                cost = _cost(sums, 0, trial - a + 1, first) + _cost(sums, trial - a, c - a + 1, last)
                if cost < best * (1 - 1e-9):
                    m, best, moved = trial, cost, True
                    break
        if not moved:
            step //= 2
    return m


@kernel("void(int64[::1], int64, int64)")
def _within(breaks, count, period):
    """Shift ends by whole rounds so that the first is one of the first round's points."""
    shift = -period if breaks[0] >= period else period if breaks[0] < 0 else 0
    for k in range(count + 1):
        breaks[k] += shift


@kernel("void(float64[:, ::1], int64[::1], int64[::1], int64)")
def settle(points, breaks, kinds, count):
    """Move the ends of a closed path's segments, in two sweeps, to where the points on either side fit best.

    Args:
        points: the path three times.
        breaks, kinds: of `count` segments, changed in place.
    """
    if count < 2:
        return
    period = breaks[count] - breaks[0]
    sums = np.empty((16, 8))
    for _ in range(2):
        for k in range(count):
            if k + 1 < count:
                ends, pair = (breaks[k], breaks[k + 1], breaks[k + 2]), (kinds[k], kinds[k + 1])
            else:
                ends, pair = (breaks[k], breaks[k + 1], breaks[1] + period), (kinds[k], kinds[0])
            if ends[2] - ends[0] + 2 > len(sums):
                sums = np.empty((2 * (ends[2] - ends[0]) + 2, 8))
            breaks[k + 1] = _settled(points, ends, pair, sums)
        breaks[0] = breaks[count] - period
    _within(breaks, count, period)


@kernel("int64(float64[:, ::1], int64[::1], int64[::1], int64, float64)")
def merge(points, breaks, kinds, count, tolerance):
    """Join neighbours that one line or arc holds, but for a step at corners; return how many segments are left."""
    sums = np.empty((16, 8))
    kept = 0
    for k in range(1, count):
        last = breaks[k + 1]
        # the outermost points stand at corners that the pixels round; they tell neither neighbour's shape
        spare = 1 if last - breaks[kept] > 12 else 0
        a, c = breaks[kept] + spare, last - spare
        if c - a + 2 > len(sums):
            sums = np.empty((2 * (c - a) + 2, 8))
        add_up(points, a, 0, c - a + 1, sums)
        if _line_holds(points, a, c - a, sums, tolerance):
            kinds[kept] = LINE
        elif (kinds[kept] == ARC or kinds[k] == ARC) and _arc_holds(points, a, c - a, sums, tolerance):
            kinds[kept] = ARC
        else:
            kept += 1
            kinds[kept] = kinds[k]
        breaks[kept + 1] = last
    return kept + 1


@kernel("boolean(float64[:, ::1], int64, int64, float64[:, ::1])")
def _goes_round(points, a, steps, sums):
    """Tell whether points a ... a + steps go round the centre of their circle one way."""
    cx, cy, _, _ = fit_circle(sums, 0, steps + 1)
    cx, cy = cx + points[a, 0], cy + points[a, 1]
    way = 0.0
    for k in range(a + 1, a + steps + 1):
        step = (points[k - 1, 0] - cx) * (points[k, 1] - cy) - (points[k - 1, 1] - cy) * (points[k, 0] - cx)
        if step * way < 0.0:
            return False
        way = step
    return True


@kernel("void(float64[:, ::1], int64[::1], int64[::1], int64, float64)")
def straighten(points, breaks, kinds, count, tolerance):
    """Make lines of the arcs that a line holds as well, or that are none, now that their ends have moved."""
    sums = np.empty((16, 8))
    for k in range(count):
        a, b = breaks[k], breaks[k + 1]
        if kinds[k] == ARC:
            if b - a + 2 > len(sums):
                sums = np.empty((2 * (b - a) + 2, 8))
            add_up(points, a, 0, b - a + 1, sums)
            if _line_holds(points, a, b - a, sums, tolerance) or not _goes_round(points, a, b - a, sums):
                kinds[k] = LINE


@kernel("void(float64[:, ::1], int64[::1], int64[::1], int64, float64[:, ::1])")
def carriers(points, breaks, kinds, count, found):
    """Fit every segment's line or circle to its inner points.

    Args:
        found: (count, 5) gets of a line a point, its unit direction along the path and 0; of an arc centre, radius,
            turn (+1 counter-clockwise, -1 clockwise) and 1.
    """
    longest = 0
    for k in range(count):
        longest = max(longest, breaks[k + 1] - breaks[k])
    sums = np.empty((longest + 2, 8))
    for k in range(count):
        a, b = breaks[k], breaks[k + 1]
        # as in `merge`: the ends of long runs lie in rounded corners
        trim = 2 if b - a > 12 else 1 if b - a > 6 else 0
        a, b = a + trim, b - trim
        add_up(points, a, 0, b - a + 1, sums)
        if kinds[k] == ARC:
            cx, cy, r, _ = fit_circle(sums, 0, b - a + 1)
            cx, cy = cx + points[a, 0], cy + points[a, 1]
            m = (a + b) // 2
            ux, uy = points[m, 0] - points[a, 0], points[m, 1] - points[a, 1]
            turn = ux * (points[b, 1] - points[m, 1]) - uy * (points[b, 0] - points[m, 0])
            found[k, 0], found[k, 1], found[k, 2], found[k, 3], found[k, 4] = (
                cx,
                cy,
                r,
                (1.0 if turn > 0 else -1.0),
                1.0,
            )
            continue
        mx, my, dx, dy = fit_line(sums, 0, b - a + 1)
        if dx * (points[b, 0] - points[a, 0]) + dy * (points[b, 1] - points[a, 1]) < 0.0:
            dx, dy = -dx, -dy
        found[k, 0], found[k, 1], found[k, 2], found[k, 3], found[k, 4] = (
            mx + points[a, 0],
            my + points[a, 1],
            dx,
            dy,
            0.0,
        )


@kernel("boolean(float64[:, ::1], int64, int64, float64[:, ::1], float64)")
def _held_by_neighbours(points, a, b, pair, tolerance):
    """Tell whether each of points a ... b lies on one of two carriers, or in the corner between them."""
    for k in range(a, b + 1):
        best = math.inf
        for m in range(2):
            x, y = points[k, 0] - pair[m, 0], points[k, 1] - pair[m, 1]
            off = abs(x * pair[m, 3] - y * pair[m, 2]) if pair[m, 4] == 0.0 else abs(math.hypot(x, y) - pair[m, 2])
            best = min(best, off)
        if best > tolerance:
            return False
    return True


@kernel("int64(float64[:, ::1], int64[::1], int64[::1], float64[:, ::1], float64)")
def absorb(points, breaks, kinds, found, tolerance):
    """Give the points of short segments, such as the step that cuts a corner, to their neighbours; return how many are
    left.

    Args:
        breaks, kinds: of the segments of a closed path, changed in place; the first, which is long, stays.
        found: (count, 5) their carriers, changed in place.
    """
    count, kept = len(found), 0
    period = breaks[count] - breaks[0]
    for k in range(1, count):
        a, b = breaks[k], breaks[k + 1]
        length_after = breaks[k + 2] - b if k + 1 < count else breaks[1] - breaks[0]
        pair = np.stack((found[kept], found[(k + 1) % count]))
        between_longer = b - a <= SHORT < min(breaks[kept + 1] - breaks[kept], length_after)
        if between_longer and _held_by_neighbours(points, a, b, pair, tolerance):
            breaks[kept + 1] = (a + b) // 2
            continue
        kept += 1
        kinds[kept], found[kept] = kinds[k], found[k]
        breaks[kept + 1] = b
    breaks[0] = breaks[kept + 1] - period
    _within(breaks, kept + 1, period)
    return kept + 1


@kernel("int64(float64[:, ::1], int64, float64, int64[::1], int64[::1], int64)")
def _turned(points, count, tolerance, breaks, kinds, found):
    """Let a closed path's segments begin with the longest, and make those anew that met at the path's first point."""
    first = 1
    for k in range(1, found - 1):
        if breaks[k + 1] - breaks[k] > breaks[first + 1] - breaks[first]:
            first = k
    old_breaks, old_kinds = breaks[: found + 1].copy(), kinds[:found].copy()
    made = 0
    for k in range(first, found - 1):
        breaks[made], kinds[made] = old_breaks[k], old_kinds[k]
        made += 1
    # the last run and the first were cut by where the path happens to begin: they are looked for anew as one
    last = old_breaks[found - 1]
    made += segment(points, last, count + old_breaks[1] - last, tolerance, breaks[made:], kinds[made:])
    for k in range(1, first):
        breaks[made], kinds[made] = old_breaks[k] + count, old_kinds[k]
        made += 1
    breaks[made] = old_breaks[first] + count
    return made


@kernel("int64(float64[:, ::1], int64, float64, int64[::1], int64[::1])")
def segment_closed(points, count, tolerance, breaks, kinds):
    """Cover a closed path by lines and arcs, beginning where the longest of them begins, and settle their ends.

    Args:
        points: (3 count, 2) the path three times.
        count: points of the path, >= 3.
        tolerance: greatest distance of a point from its line or circle.
        breaks, kinds: (2 count + 1,) and (2 count,) get the segments' ends and kinds.

    Returns:
        Number of segments; 1 when one circle (or line) holds them all.
    """
    sums = np.empty((count + 2, 8))
    add_up(points, 0, 0, count + 1, sums)
    breaks[0], breaks[1], kinds[0] = 0, count, ARC
    if _arc_holds(points, 0, count, sums, tolerance):
        return 1
    found = segment(points, 0, count, tolerance, breaks, kinds)
    if found > 3:
        found = _turned(points, count, tolerance, breaks, kinds, found)
    for _ in range(2):
        found = merge(points, breaks, kinds, found, tolerance)
        settle(points, breaks, kinds, found)
        straighten(points, breaks, kinds, found, tolerance)
    return found
