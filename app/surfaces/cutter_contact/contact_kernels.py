# mypy: allow-untyped-defs
"""Compiled: how low a cutter comes over a triangle, exactly: the contact with its face, edges and corners in closed
form.

A cutter's lower side is h(r), the height over its tip at a distance from its axis: flat up to `disc`, then a corner of
a radius, then a cone, up to the cutter's radius. It rises ever more steeply, so what a cutter's tip may be at, the
height of a place of the mesh less h there, has one maximum over a triangle: within it, or on one of its edges.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

_R = "float64[::1]"
DISC, CORNER, CONE, RADIUS, BEND = 0, 1, 2, 3, 4
"""Of a cutter's shape: radius of the flat, radius of the corner, rise of the cone (0: none), its own, and where the
corner ends.
"""
_STEPS, _NEAR = 80, 1e-14
"""Steps at most, and of the radius: a step so small is none."""
_SLIVER = 1e-22
"""mm2: the square of how high a triangle is, seen from above, that has a slope."""


@kernel("float64(float64, float64)", counts=False)
def length(x, y):
    """Return how long a vector is; `math.hypot` guards against overflow, and takes several times as long."""
    return math.sqrt(x * x + y * y)


@kernel(f"float64(float64, {_R})", counts=False)
def height(r, shape):
    """Return h at a distance from the axis, no more than the radius."""
    if r <= shape[DISC]:
        return 0.0
    corner, out = shape[CORNER], min(r, shape[BEND]) - shape[DISC]
    up = corner - math.sqrt(max(corner * corner - out * out, 0.0))
    return up + shape[CONE] * max(r - shape[BEND], 0.0)


@kernel(f"float64(float64, {_R})", counts=False)
def rise(r, shape):
    """Return how steeply h rises there."""
    if r <= shape[DISC]:
        return 0.0
    if r > shape[BEND]:
        return shape[CONE] if shape[CONE] > 0.0 else math.inf  # a hair beyond the radius
    corner, out = shape[CORNER], r - shape[DISC]
    square = corner * corner - out * out
    return out / math.sqrt(square) if square > 0.0 else math.inf


@kernel(f"float64(float64, {_R})", counts=False)
def contact(steepness, shape):
    """Return how far from the axis a plane of some steepness is touched."""
    if steepness == 0.0:
        return 0.0
    if shape[CORNER] > 0.0:
        at = shape[DISC] + shape[CORNER] * steepness / math.sqrt(1.0 + steepness * steepness)
        if at <= shape[BEND]:
            return at
    return shape[RADIUS] if steepness > shape[CONE] or shape[CONE] == 0.0 else max(shape[DISC], shape[BEND])


@kernel(f"float64(float64, float64, {_R})", counts=False)
def _falls(off, at, shape):
    """Return how steeply h rises along a line, `off` from the axis."""
    r = length(off, at)
    return rise(r, shape) * at / r if r > 0.0 else 0.0


@kernel(f"float64(float64, float64, {_R})", counts=False)
def _bends(off, at, shape):
    """Return how much steeper it gets there."""
    r = length(off, at)
    steep, bend = rise(r, shape), 0.0
    if shape[DISC] < r <= shape[BEND]:
        out = r - shape[DISC]
        bend = shape[CORNER] ** 2 / max(shape[CORNER] ** 2 - out * out, 1e-300) ** 1.5
    return (bend * at * at + steep * off * off / max(r, 1e-300)) / max(r * r, 1e-300) + 1e-300


@kernel(f"float64(float64, float64, float64, float64, {_R})", counts=False)
def _along(slope, off, low, high, shape):
    """Return where on a line, `off` from the axis, slope t - h has its maximum between two places."""
    if shape[DISC] == 0.0 and shape[CONE] == 0.0:  # a ball
        corner = shape[CORNER]
        return min(
            max(slope * math.sqrt(max(corner * corner - off * off, 0.0)) / math.sqrt(1.0 + slope * slope), low), high
        )
    if shape[CORNER] == 0.0 and shape[CONE] == 0.0:  # a flat
        return high if slope > 0.0 else low
    if _falls(off, low, shape) >= slope:
        return low
    if _falls(off, high, shape) <= slope:
        return high
    at, last = 0.5 * (low + high), high - low
    for _ in range(_STEPS):  # Newton's, or a halving where that leads out or, round a bend, to and fro
        over = _falls(off, at, shape) - slope
        if over < 0.0:
            low = at
        else:
            high = at
        new = at - over / _bends(off, at, shape)
        if not low < new < high or abs(new - at) > 0.5 * last:
            new = 0.5 * (low + high)
        last = abs(new - at)
        if last <= _NEAR * shape[RADIUS]:
            return new
        at = new
    return at


@kernel(f"float64(float64, float64, float64, float64, float64, float64, {_R}, float64)", counts=False)
def over_edge(ax, ay, az, bx, by, bz, shape, known):
    """Return how low the tip comes over an edge, its ends told from the axis; `known` where that is not less."""
    radius = shape[RADIUS]
    dx, dy = bx - ax, by - ay
    size = length(dx, dy)
    if size <= 1e-12 * radius:
        r = min(length(ax, ay), length(bx, by))
        return max(known, max(az, bz) - height(r, shape)) if r <= radius else known
    ux, uy = dx / size, dy / size
    off, start = ax * uy - ay * ux, ax * ux + ay * uy
    square = radius * radius - off * off
    if square < 0.0 or max(az, bz) - height(abs(off), shape) <= known:
        return known
    half = math.sqrt(square)
    low, high = max(start, -half), min(start + size, half)
    if low > high:
        return known
    slope = (bz - az) / size
    at = _along(slope, off, low, high, shape)
    return max(known, az + slope * (at - start) - height(min(length(off, at), radius), shape))


@kernel(f"float64({_R}, float64, float64, {_R}, float64)", counts=False)
def over_triangle(t, x, y, shape, known):
    """Return how low the tip comes at (x, y) over a triangle (9,); `known` where that is not less."""
    ax, ay, bx, by, cx, cy = t[0] - x, t[1] - y, t[3] - x, t[4] - y, t[6] - x, t[7] - y
    az, bz, cz = t[2], t[5], t[8]
    twice = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    longest = max((bx - ax) ** 2 + (by - ay) ** 2, (cx - ax) ** 2 + (cy - ay) ** 2, (cx - bx) ** 2 + (cy - by) ** 2)
    if twice * twice > _SLIVER * longest:  # of a narrower one, rounding would tell the slope; its edges say all
        east = ((bz - az) * (cy - ay) - (cz - az) * (by - ay)) / twice
        north = ((cz - az) * (bx - ax) - (bz - az) * (cx - ax)) / twice
        steep = length(east, north)
        r = contact(steep, shape)
        px, py = (r * east / steep, r * north / steep) if steep > 0.0 else (0.0, 0.0)
        s = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / twice
        u = ((bx - ax) * (py - ay) - (by - ay) * (px - ax)) / twice
        if s >= 0.0 and u >= 0.0 and s + u <= 1.0:
            return max(known, az + s * (bz - az) + u * (cz - az) - height(r, shape))
    known = over_edge(ax, ay, az, bx, by, bz, shape, known)
    known = over_edge(bx, by, bz, cx, cy, cz, shape, known)
    return over_edge(cx, cy, cz, ax, ay, az, shape, known)


@kernel(f"void({_R}, float64, {_R})", counts=False)
def thicken(shape, skin, out):
    """Set `out` to a cutter with a skin, mm, or, if that is less than 0, pared by as much; measured from its own lowest
    place.

    A pared one is never slimmer than the cutter less the skin.
    """
    cone = shape[CONE]
    corner = shape[CORNER] + skin
    disc = shape[DISC]
    if corner < 0.0:  # no corner is left: the flat and the cone are moved inwards
        disc = max(disc + (corner if cone == 0.0 else corner * (math.sqrt(1.0 + cone * cone) - 1.0) / cone), 0.0)
        corner = 0.0
    out[DISC], out[CORNER], out[CONE], out[RADIUS] = disc, corner, cone, shape[RADIUS] + skin
    out[BEND] = disc + (corner * cone / math.sqrt(1.0 + cone * cone) if cone > 0.0 else corner)
