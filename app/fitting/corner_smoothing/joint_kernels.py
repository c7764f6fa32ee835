# mypy: allow-untyped-defs
"""Compiled joining of fitted lines and circles: tangents where they nearly touch, corners where they cross (step 404).

A carrier is a row of five numbers: of a line a point, its unit direction along the path and 0; of an arc its centre,
radius, turn (+1 counter-clockwise, -1 clockwise) and 1. Carriers follow one another along the path; `ends` has one
number more than there are carriers: the indices of the points where segments begin and end.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

CROSSING, TANGENT, PINNED = 0, 1, 2
"""How a carrier begins: where it crosses the one before, where the two touch, at the joint that the points have."""

NEAR = 6
"""Steps from a joint within which a point is near it."""

FAR = 6.0
"""Times the tolerance; a crossing farther than this from the points' own joint is no corner of the path."""


ALMOST_ONE = 1e-6
"""Of two circles' radii: with their centres nearer than this the place where they touch is any."""


@kernel("float64(float64[::1], float64, float64)")
def _side(line, x, y):
    """Return how far a point lies to the left of a line."""
    return line[2] * (y - line[1]) - line[3] * (x - line[0])


@kernel("UniTuple(float64, 2)(float64[::1], float64, float64)")
def _foot(carrier, x, y):
    """Return the carrier's point nearest to a point."""
    if carrier[4] == 0.0:
        along = carrier[2] * (x - carrier[0]) + carrier[3] * (y - carrier[1])
        return carrier[0] + along * carrier[2], carrier[1] + along * carrier[3]
    dx, dy = x - carrier[0], y - carrier[1]
    length = math.hypot(dx, dy)
    if length == 0.0:
        return carrier[0] + carrier[2], carrier[1]
    return carrier[0] + dx / length * carrier[2], carrier[1] + dy / length * carrier[2]


@kernel("boolean(float64[::1], float64[::1], float64)")
def _nearly_tangent(line, arc, tolerance):
    """Tell whether a line touches an arc's circle within tolerance, on the side to which the arc turns away."""
    return abs(_side(line, arc[0], arc[1]) * arc[3] - arc[2]) <= tolerance


@kernel("float64(float64[:, ::1], int64, int64, float64[::1])")
def _worst(points, a, b, arc):
    worst = 0.0
    for k in range(a, b + 1):
        worst = max(worst, abs(math.hypot(points[k, 0] - arc[0], points[k, 1] - arc[1]) - arc[2]))
    return worst


@kernel("boolean(float64[:, ::1], int64, int64, float64[::1], float64[:, ::1])")
def _between(points, a, b, arc, lines):
    """Make an arc tangent to the lines before and after it, by the radius that fits its points best; tell whether it
    can be.
    """
    first, last = lines[0], lines[1]
    cross = first[2] * last[3] - first[3] * last[2]
    # lines that nearly follow one another (within 1.1 degrees) leave the centre undetermined
    if abs(cross) < 0.02:
        return False
    # the centre lies at turn * r to the left of both: it moves along a line as r grows, c = c0 + r k
    c0x = c0y = kx = ky = 0.0
    for r in range(2):
        s1 = arc[3] * r + first[2] * first[1] - first[3] * first[0]
        s2 = arc[3] * r + last[2] * last[1] - last[3] * last[0]
        x, y = (last[2] * s1 - first[2] * s2) / cross, (last[3] * s1 - first[3] * s2) / cross
        if r == 0:
            c0x, c0y = x, y
        else:
            kx, ky = x - c0x, y - c0y
    r = arc[2]
    for _ in range(8):
        # Gauss-Newton in the one unknown: the residual of a point is |p - c(r)| - r, its derivative by r the slope
        top = bottom = 0.0
        for k in range(a, b + 1):
            dx, dy = points[k, 0] - c0x - r * kx, points[k, 1] - c0y - r * ky
            length = max(math.hypot(dx, dy), 1e-12)
            slope = -(dx * kx + dy * ky) / length - 1.0
            top += slope * (length - r)
            bottom += slope * slope
        if bottom == 0.0:
            return False
        r -= top / bottom
    if r <= 0.0:
        return False
    arc[0], arc[1], arc[2] = c0x + r * kx, c0y + r * ky, r
    return True


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], uint8[::1], float64)")
def make_tangent(points, ends, carriers, joined, tolerance):
    """Move arcs so that they touch the lines next to them where they nearly do.

    Args:
        points, ends: what the carriers were fitted to.
        carriers: (n, 5) of a closed path, changed in place.
        joined: (n,) how each carrier begins; gets TANGENT where it is made so. PINNED ones stay.
        tolerance: an arc is left alone where its points would be farther off than this.
    """
    n = len(carriers)
    lines = carriers[:2].copy()
    for k in range(n):
        arc, before, after = carriers[k], carriers[k - 1], carriers[(k + 1) % n]
        if arc[4] == 0.0 or n < 3:
            continue
        one = before[4] == 0.0 and joined[k] != PINNED and _nearly_tangent(before, arc, tolerance)
        two = after[4] == 0.0 and joined[(k + 1) % n] != PINNED and _nearly_tangent(after, arc, tolerance)
        kept = arc.copy()
        done = False
        if one and two:
            lines[0], lines[1] = before, after
            done = (
                _between(points, ends[k], ends[k + 1], arc, lines)
                and _worst(points, ends[k], ends[k + 1], arc) <= tolerance
            )
            if not done:
                arc[:] = kept
                two = False
        if not done and (one or two):
            line = before if one else after
            # one line alone: the centre moves square to it until it is a radius away, the radius stays
            off = arc[3] * arc[2] - _side(line, arc[0], arc[1])
            arc[0], arc[1] = arc[0] - off * line[3], arc[1] + off * line[2]
            if _worst(points, ends[k], ends[k + 1], arc) > 1.5 * tolerance:
                arc[:] = kept
                one = two = False
        if one:
            joined[k] = TANGENT
        if two:
            joined[(k + 1) % n] = TANGENT


@kernel("boolean(float64[::1], float64[::1], float64[::1], boolean)")
def _slide(arc, fixed, line, along):
    """Move an arc until it touches another from outside: straight away from it, or along a line; tell whether it
    can.
    """
    dx, dy = arc[0] - fixed[0], arc[1] - fixed[1]
    length = math.hypot(dx, dy)
    if length == 0.0:
        return False
    ux, uy = (line[2], line[3]) if along else (dx / length, dy / length)
    lean, reach = dx * ux + dy * uy, arc[2] + fixed[2]
    # |d + step u| = reach, solved for the step; of its two roots the one on the side where the arc is now
    square = lean * lean + reach * reach - length * length
    if square < 0.0:
        return False
    step = math.copysign(math.sqrt(square), lean) - lean
    arc[0], arc[1] = arc[0] + step * ux, arc[1] + step * uy
    return True


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], uint8[::1], float64)")
def let_arcs_touch(points, ends, carriers, joined, tolerance):
    """Move arcs so that they touch the one next to them that turns the other way, where they nearly do.

    Args: those of `make_tangent`, whose lines arcs go on touching.
    """
    n = len(carriers)
    for k in range(n):
        a, b = k - 1 if k > 0 else n - 1, k
        first, last = carriers[a], carriers[b]
        if n < 3 or joined[k] != CROSSING or first[4] == 0.0 or last[4] == 0.0 or first[3] == last[3]:
            continue
        if abs(math.hypot(last[0] - first[0], last[1] - first[1]) - first[2] - last[2]) > tolerance:
            continue
        for side in range(2):
            moves, stays, other, far_joint = (b, a, (b + 1) % n, (b + 1) % n) if side == 0 else (a, b, a - 1, a)
            bound = joined[far_joint] == TANGENT
            if bound and carriers[other][4] == 1.0:
                continue
            kept = carriers[moves].copy()
            slid = _slide(carriers[moves], carriers[stays], carriers[other], bound)
            if slid and _worst(points, ends[moves], ends[moves + 1], carriers[moves]) <= 1.5 * tolerance:
                joined[k] = TANGENT
                break
            carriers[moves] = kept


@kernel("UniTuple(float64, 2)(float64[::1], float64[::1], float64, float64, float64)")
def _crossing(a, b, x, y, far):
    """Return where two carriers cross, nearest to a point; between the feet of the point where they do not, or far
    away.
    """
    ax, ay = _foot(a, x, y)
    bx, by = _foot(b, x, y)
    px, py = (ax + bx) / 2, (ay + by) / 2
    if a[4] == 0.0 and b[4] == 0.0:
        cross = a[2] * b[3] - a[3] * b[2]
        if abs(cross) > 1e-9:
            t = ((b[0] - a[0]) * b[3] - (b[1] - a[1]) * b[2]) / cross
            px, py = a[0] + t * a[2], a[1] + t * a[3]
    else:
        # the chord that both share: along a line, or across the line between two centres
        if a[4] == 0.0 or b[4] == 0.0:
            line, arc = (a, b) if a[4] == 0.0 else (b, a)
            fx, fy = _foot(line, arc[0], arc[1])
            ux, uy = line[2], line[3]
            half = arc[2] * arc[2] - (fx - arc[0]) ** 2 - (fy - arc[1]) ** 2
        else:
            vx, vy = b[0] - a[0], b[1] - a[1]
            d = max(math.hypot(vx, vy), 1e-12)
            along = (d * d + a[2] * a[2] - b[2] * b[2]) / (2 * d)
            fx, fy = a[0] + along * vx / d, a[1] + along * vy / d
            ux, uy = -vy / d, vx / d
            half = a[2] * a[2] - along * along
        if half >= 0.0:
            way = math.copysign(math.sqrt(half), (x - fx) * ux + (y - fy) * uy)
            px, py = fx + way * ux, fy + way * uy
    if math.hypot(px - x, py - y) > far:
        px, py = (ax + bx) / 2, (ay + by) / 2
    return px, py


@kernel("UniTuple(float64, 2)(float64[::1], float64[::1], float64, float64)")
def _touching(a, b, x, y):
    """Return where two carriers touch; of two that are nearly one, the place nearest to a point."""
    if a[4] != b[4]:
        line, arc = (a, b) if a[4] == 0.0 else (b, a)
        return _foot(line, arc[0], arc[1])
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = math.hypot(dx, dy)
    if a[4] == 0.0 or length < ALMOST_ONE * (a[2] + b[2]):
        ax, ay = _foot(a, x, y)
        bx, by = _foot(b, x, y)
        return (ax + bx) / 2, (ay + by) / 2
    # circles touch on the line of centres: from inside on the smaller one's far side, else between them
    way = -1.0 if a[3] == b[3] and a[2] < b[2] else 1.0
    return a[0] + way * a[2] * dx / length, a[1] + way * a[2] * dy / length


@kernel("void(float64[:, ::1], float64[:, ::1], uint8[::1], float64, float64[:, ::1])")
def join(near, carriers, joined, tolerance, joints):
    """Find where each carrier of a closed path begins.

    Args:
        near: (n, 2) the points' own joints; of two crossings the nearer one counts.
        carriers: (n, 5).
        joined: (n,) how each carrier begins: CROSSING, TANGENT or PINNED, which is at the points' own joint.
        tolerance: see FAR.
        joints: (n, 2) gets them.
    """
    n = len(carriers)
    for k in range(n):
        a, b = carriers[k - 1], carriers[k]
        if joined[k] == PINNED:
            joints[k, 0], joints[k, 1] = near[k, 0], near[k, 1]
        elif joined[k] == TANGENT:
            joints[k, 0], joints[k, 1] = _touching(a, b, near[k, 0], near[k, 1])
        else:
            joints[k, 0], joints[k, 1] = _crossing(a, b, near[k, 0], near[k, 1], FAR * tolerance)


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1])")
def rows_between(carriers, joints, rows):
    """Write the lines and arcs of a closed path, from joint to joint, as rows (n, 8) of `app.geometry.primitives`.

    An arc's centre moves onto the bisector of its ends, so that both radii are one number. Arcs may sweep more than pi.
    """
    n = len(carriers)
    for k in range(n):
        ax, ay, bx, by = joints[k, 0], joints[k, 1], joints[(k + 1) % n, 0], joints[(k + 1) % n, 1]
        rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3] = ax, ay, bx, by
        rows[k, 4] = rows[k, 5] = rows[k, 6] = rows[k, 7] = 0.0
        dx, dy = bx - ax, by - ay
        chord = dx * dx + dy * dy
        if carriers[k, 4] == 0.0 or chord == 0.0:
            continue
        # as much of (centre - chord's middle) as lies along the chord goes: the bisector is what is left
        along = ((carriers[k, 0] - (ax + bx) / 2) * dx + (carriers[k, 1] - (ay + by) / 2) * dy) / chord
        cx, cy = carriers[k, 0] - along * dx, carriers[k, 1] - along * dy
        rows[k, 4], rows[k, 5], rows[k, 6], rows[k, 7] = cx, cy, math.hypot(ax - cx, ay - cy), carriers[k, 3]


@kernel("boolean(float64[::1], float64, float64)", counts=False)
def _within(row, x, y):
    """Tell whether a point lies in the sector of an arc, which may sweep up to a full turn."""
    ax, ay, bx, by, vx, vy = row[0] - row[4], row[1] - row[5], row[2] - row[4], row[3] - row[5], x - row[4], y - row[5]
    # after the beginning and before the end, by cross products; of more than half a turn either one is enough
    behind, ahead = row[7] * (ax * vy - ay * vx) >= 0.0, row[7] * (vx * by - vy * bx) >= 0.0
    return (behind and ahead) if row[7] * (ax * by - ay * bx) >= 0.0 else (behind or ahead)


@kernel("float64(float64[::1], float64, float64)", counts=False)
def _distance(row, x, y):
    """Return the distance of a point from a row, which may sweep up to a full turn."""
    if row[7] == 0.0:
        dx, dy = row[2] - row[0], row[3] - row[1]
        square = dx * dx + dy * dy
        if 0.0 < (x - row[0]) * dx + (y - row[1]) * dy < square:
            return abs((x - row[0]) * dy - (y - row[1]) * dx) / math.sqrt(square)
    elif _within(row, x, y):
        return abs(math.sqrt((x - row[4]) ** 2 + (y - row[5]) ** 2) - row[6])
    return math.sqrt(min((x - row[0]) ** 2 + (y - row[1]) ** 2, (x - row[2]) ** 2 + (y - row[3]) ** 2))


@kernel("boolean(float64[::1], float64[::1], float64, float64)", counts=False)
def _runs_back(row, carrier, x, y):
    """Tell whether a row runs against its carrier, or the other way round; (x, y) is a point in its middle."""
    if carrier[4] == 0.0:
        return (row[2] - row[0]) * carrier[2] + (row[3] - row[1]) * carrier[3] <= 0.0
    return row[7] != 0.0 and not _within(row, x, y)


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1])", counts=False)
def deviations(points, ends, carriers, rows, worst):
    """Write for each row the greatest distance of its points from the path, and whether that is too far, as a number.

    A point is measured from its own row and from the ones next to it: near a joint it may belong to either. The number
    is the greatest distance too, but points near a joint count half, since pixels fill sharp corners, and it is
    infinite where a row runs the other way round.

    Args:
        points, ends: what the rows replace.
        carriers: (n, 5) with the sense in which each row has to run.
        rows: (n, 8) of a closed path.
        worst: (n, 2) gets distances and numbers.
    """
    n = len(rows)
    for k in range(n):
        a, b = ends[k], ends[k + 1]
        m = (a + b) // 2
        worst[k, 0] = 0.0
        worst[k, 1] = math.inf if _runs_back(rows[k], carriers[k], points[m, 0], points[m, 1]) else 0.0
        for i in range(a, b + 1):
            x, y = points[i, 0], points[i, 1]
            off = _distance(rows[k], x, y)
            # neighbours are asked only where the point would count, as few do
            if off > worst[k, 0] or off > worst[k, 1]:
                off = min(off, _distance(rows[k - 1], x, y), _distance(rows[(k + 1) % n], x, y))
                worst[k, 0] = max(worst[k, 0], off)
                worst[k, 1] = max(worst[k, 1], off / 2 if i - a < NEAR or b - i < NEAR else off)
