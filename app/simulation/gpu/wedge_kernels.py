# mypy: allow-untyped-defs
"""Facets of what a ball sweeps along chains of moves: a cylinder a move, and of each corner's sphere a wedge.

A circle has an even number of corners, the same for all of a ball's cylinders and wedges. Where two moves meet, the
circles of both begin at the same pole, which is square to both moves, so that the corners of the cylinders' ends are
those of the wedge's edges. A cylinder's two ends begin at different poles; its strips join each corner to the nearest
of the other end, and bend along the shorter diagonal: that is the hull of both ends, nowhere deeper under the cylinder
than a strip that is not twisted.

Cylinders reach over their ends by an overlap, and keep within the spheres there: where two parts meet no crack is left
open by a drawing whose places are rounded.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

TUBE, WEDGE, END = range(3)
"""Kinds of facets: of a cylinder, of a wedge, of the half sphere at an end of a chain."""

STRAIGHT = 1e-9
"""A turn by less, radians, leaves no wedge."""

SPECK = 1e-12
"""A facet that is seen as no more than this, mm², twice, stands on edge."""

STEEPEST = 1.0 / 16.0
"""A cosine of the slope of a move below this counts as this where the overlap is made longer for it."""

_V = "UniTuple(float64, 3)"
_OUT = "float32[:, :, ::1], uint8[::1], int64, int64"
_VIEW = "UniTuple(float64, 5)"
_SHAPE = "UniTuple(float64, 3)"
_FRAME = f"UniTuple({_V}, 3)"
_TABLE = "float64[:, ::1]"


@kernel(f"{_V}({_V}, {_V})", counts=False)
def cross(a, b):
    """Return the vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel(f"float64({_V}, {_V})", counts=False)
def dot(a, b):
    """Return the scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel(f"{_V}({_V}, float64, {_V}, float64, {_V})", counts=False)
def off(place, first, a, second, b):
    """Return place + first a + second b."""
    return (
        place[0] + first * a[0] + second * b[0],
        place[1] + first * a[1] + second * b[1],
        place[2] + first * a[2] + second * b[2],
    )


@kernel(f"{_V}({_TABLE}, int64)", counts=False)
def row_of(table, k):
    """Return row k of a table (n, 3): a place, or a direction."""
    return table[k, 0], table[k, 1], table[k, 2]


@kernel(f"int64({_OUT}, UniTuple({_V}, 4), {_VIEW})", counts=False)
def put(quads, kinds, at, kind, corners, view):
    """Keep a quad, two triangles 0 1 2 and 0 2 3 that run counter-clockwise as seen from inside; return how many there
    are then.

    Args:
        at: how many there are.
        view: low x, low y, high x, high y of what is looked at, and which facets are kept: 1 those that look down in
            one of their triangles, -1 up, 0 all.
    """
    a, b, c, d = corners
    if max(max(a[0], b[0]), max(c[0], d[0])) < view[0] or min(min(a[0], b[0]), min(c[0], d[0])) > view[2]:
        return at
    if max(max(a[1], b[1]), max(c[1], d[1])) < view[1] or min(min(a[1], b[1]), min(c[1], d[1])) > view[3]:
        return at
    x, y = c[0] - a[0], c[1] - a[1]
    first = (b[0] - a[0]) * y - (b[1] - a[1]) * x
    second = x * (d[1] - a[1]) - y * (d[0] - a[0])
    # first, second: twice the area of each triangle as seen from above, > 0 where it looks down.
    side = view[4]
    if side != 0.0 and max(side * first, side * second) <= SPECK:
        return at
    for k in range(3):
        quads[at, 0, k], quads[at, 1, k], quads[at, 2, k], quads[at, 3, k] = a[k], b[k], c[k], d[k]
    kinds[at] = kind
    return at + 1


@kernel(f"{_V}({_V})", counts=False)
def level_pole(u):
    """Return the level unit vector square to a direction; X if that is upright."""
    size = math.hypot(u[0], u[1])
    # an upright way has all level directions square to it; any will do, as long as it is always the same
    if size < 1e-12:
        return 1.0, 0.0, 0.0
    return -u[1] / size, u[0] / size, 0.0


@kernel(f"{_V}({_V}, {_V})", counts=False)
def pole_of(u, v):
    """Return the pole of the corner between two unit directions: square to both."""
    pole = cross(u, v)
    size = math.sqrt(dot(pole, pole))
    if size < STRAIGHT:
        return level_pole(u)
    return pole[0] / size, pole[1] / size, pole[2] / size


@kernel(f"float64({_V}, {_V})", counts=False)
def turn_of(u, v):
    """Return the angle between two unit directions, [0, pi]."""
    pole = cross(u, v)
    return math.atan2(math.sqrt(dot(pole, pole)), dot(u, v))


@kernel(f"{_FRAME}({_V}, {_V})", counts=False)
def frame_of(pole, u):
    """Return the pole, the direction in which the wedge at the end of a move along u begins, and u."""
    out = cross(u, pole)
    return pole, out, u


@kernel(f"int64({_OUT}, {_V}, {_FRAME}, UniTuple(float64, 2), float64, {_TABLE}, {_VIEW})", counts=False)
def strip(quads, kinds, at, kind, centre, frame, span, radius, table, view):
    """Add a strip of a sphere from pole to pole; return how many quads there are then.

    Args:
        span: its azimuths, from the second direction of the frame towards the third.
        table: cosine and sine of the corners of a circle.
    """
    pole, out, ahead = frame
    half = len(table) // 2
    c0, s0, c1, s1 = math.cos(span[0]), math.sin(span[0]), math.cos(span[1]), math.sin(span[1])
    zero = (0.0, 0.0, 0.0)
    left, right = off(zero, c0, out, s0, ahead), off(zero, c1, out, s1, ahead)
    a = off(centre, radius, pole, 0.0, pole)
    b = a
    for k in range(1, half + 1):
        along, across = radius * table[k, 0], radius * table[k, 1]
        d, c = off(centre, along, pole, across, left), off(centre, along, pole, across, right)
        at = put(quads, kinds, at, kind, (a, b, c, d), view)
        a, b = d, c
    return at


@kernel(f"int64({_OUT}, UniTuple({_V}, 3), UniTuple({_V}, 2), float64, {_TABLE}, {_VIEW})", counts=False)
def tube(quads, kinds, at, kind, axis, poles, radius, table, view):
    """Add the strips of a cylinder; return how many quads there are then.

    Args:
        axis: its two ends and its unit direction.
        poles: of both ends, square to the direction.
    """
    start, end, u = axis
    p, q = poles[0], cross(poles[0], u)
    r, s = poles[1], cross(poles[1], u)
    count = len(table)
    step = 2.0 * math.pi / count
    # Both circles have the same corners, but the second begins at its own pole, `angle` further. So the corner nearest
    # to this end's first one lies `shift` whole steps back; what is left twists the strips by half a step at most.
    angle = math.atan2(dot(r, q), dot(r, p))
    shift = math.floor(angle / step + 0.5)
    ahead = angle >= shift * step
    other = int(count - shift) % count
    a = off(start, radius * table[0, 0], p, radius * table[0, 1], q)
    b = off(end, radius * table[other, 0], r, radius * table[other, 1], s)
    for k in range(1, count + 1):
        mine = k if k < count else 0
        other = other + 1 if other + 1 < count else 0
        c = off(start, radius * table[mine, 0], p, radius * table[mine, 1], q)
        d = off(end, radius * table[other, 0], r, radius * table[other, 1], s)
        at = put(quads, kinds, at, kind, (c, d, b, a) if ahead else (a, c, d, b), view)
        a, b = c, d
    return at


@kernel(f"float64({_V}, {_SHAPE})", counts=False)
def overlap_of(u, shape):
    """Return how far the cylinder of a move reaches over its ends: steep ones farther, as less of it is seen from
    below.
    """
    return min(shape[2] / max(math.hypot(u[0], u[1]), STEEPEST), shape[0] / 4.0)


@kernel(f"boolean({_V}, {_V}, float64, {_VIEW})", counts=False)
def unseen(a, b, radius, view):
    """Return whether what is within a radius of a line from a to b is off the view."""
    return (
        max(a[0], b[0]) + radius < view[0]
        or max(a[1], b[1]) + radius < view[1]
        or min(a[0], b[0]) - radius > view[2]
        or min(a[1], b[1]) - radius > view[3]
    )


@kernel(f"UniTuple(int64, 2)(int64, {_TABLE}, uint8[::1], {_SHAPE}, int64, boolean)", counts=False)
def strips_of(piece, way, joins, shape, half, wedges):
    """Return how many strips of a sphere are due at the start and at the end of a move."""
    at_start = 0 if joins[piece] else half
    u = row_of(way, piece)
    if dot(u, u) == 0.0:
        return at_start, 0
    if piece + 1 >= len(joins) or not joins[piece + 1]:
        return at_start, half
    turn = turn_of(u, row_of(way, piece + 1))
    # Between two cylinders the sphere shows in a wedge as wide as the turn; its strips are no wider than a facet.
    return at_start, math.ceil(turn * shape[0] / shape[1] - 1e-9) if wedges and turn > STRAIGHT else 0


@kernel(f"int64({_OUT}, {_TABLE}, {_TABLE}, {_TABLE}, uint8[::1], {_SHAPE}, {_TABLE}, {_VIEW})", counts=False)
def cylinder(quads, kinds, at, piece, start, end, way, joins, shape, table, view):
    """Add a move's cylinder, out to its overlaps; return how many quads there are then."""
    a, b, u = row_of(start, piece), row_of(end, piece), row_of(way, piece)
    if dot(u, u) == 0.0 or unseen(a, b, shape[0], view):
        return at
    over = overlap_of(u, shape)
    # A circle of this radius, `over` beyond the end, lies on the sphere of the end: longer, and nowhere outside.
    radius = math.sqrt(shape[0] * shape[0] - over * over)
    first = pole_of(row_of(way, piece - 1), u) if joins[piece] else level_pole(u)
    last = pole_of(u, row_of(way, piece + 1)) if piece + 1 < len(joins) and joins[piece + 1] else level_pole(u)
    axis = (off(a, -over, u, 0.0, u), off(b, over, u, 0.0, u), u)
    return tube(quads, kinds, at, TUBE, axis, (first, last), radius, table, view)


@kernel(f"int64({_OUT}, int64, int64, {_TABLE}, {_TABLE}, uint8[::1], {_SHAPE}, {_TABLE}, {_VIEW})", counts=False)
def sphere_strip(quads, kinds, at, piece, k, count, place, way, joins, shape, table, view):
    """Add one of the strips at a move's end, or at its start (count < 0); return how many quads there are then.

    Args:
        k: which of them. count: of how many.
    """
    u, centre = row_of(way, piece), row_of(place, piece)
    if unseen(centre, centre, shape[0], view):
        return at
    kind, pole, turn = END, level_pole(u), math.pi
    if dot(u, u) == 0.0:
        u = (0.0, 0.0, -1.0)
    elif count < 0:
        u = (-u[0], -u[1], -u[2])
    elif piece + 1 < len(joins) and joins[piece + 1]:
        v = row_of(way, piece + 1)
        kind, pole, turn = WEDGE, pole_of(u, v), turn_of(u, v)
    step = turn / abs(count)
    return strip(quads, kinds, at, kind, centre, frame_of(pole, u), (k * step, (k + 1) * step), shape[0], table, view)


@kernel(
    f"UniTuple(int64, 3)({_TABLE}, {_TABLE}, {_TABLE}, uint8[::1], {_SHAPE}, {_TABLE}, boolean, {_VIEW}, "
    "UniTuple(int64, 2), float32[:, :, ::1], uint8[::1])",
    counts=False,
)
def ball_facets(start, end, way, joins, shape, table, wedges, view, begin, quads, kinds):
    """Make facets until there is no room for more; return where to go on (move and part), and how many there are.

    Args:
        start, end: (n, 3) places of the ball's centre.
        way: (n, 3) unit directions; 0 where the ball only stands.
        joins: (n,) whether each goes on where the one before it ended.
        shape: radius, size of a facet, overlap.
        table: (count, 2) cosine and sine of the corners of a circle; an even number.
        wedges: whether corners have any.
        view: as for `put`.
        begin: move and part to begin with.
        quads, kinds: room for at least `count`.
    """
    room, at = len(quads) - len(table), 0
    piece, part = begin
    half = len(table) // 2
    while piece < len(start):
        first, last = strips_of(piece, way, joins, shape, half, wedges)
        while part <= first + last:
            if at > room:
                return piece, part, at
            if part < first:
                at = sphere_strip(quads, kinds, at, piece, part, -first, start, way, joins, shape, table, view)
            elif part == first:
                at = cylinder(quads, kinds, at, piece, start, end, way, joins, shape, table, view)
            else:
                at = sphere_strip(quads, kinds, at, piece, part - first - 1, last, end, way, joins, shape, table, view)
            part += 1
        piece, part = piece + 1, 0
    return piece, part, at
