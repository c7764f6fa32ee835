# mypy: allow-untyped-defs
"""Compiled: where exactly a cutter touches a patch, by Newton's method from a place near it.

Where a ball, or another cutter without a cone, touches a smooth surface that rises by the tangent of some angle, it
does so at a distance from its axis that its shape gives, uphill. So the place of the patch is known by its slope: two
equations for two parameters. Along a patch's side the one parameter is that at which the tip is highest. What comes out
is the tip over a true place of the surface: never too high.
"""

from __future__ import annotations

import math

from ...core.jit import kernel
from ..patches.patch_kernels import place
from .contact_kernels import RADIUS, contact, height, length

_R, _NETS = "float64[::1]", "float64[:, :, :, ::1]"
_SLOPE_STEP, _TURN_STEP = 1e-6, 1e-4
"""Steps of the parameters by which slopes, and how they change, are told."""
_TIMES, _SIDE_TIMES = 8, 24
"""Newton's steps at most, and those of a climb along a side."""
_SAME = 1e-11
"""Of a patch's parameters, both from 0 to 1: a place is found where steps are below a hundred of these."""
_OUTSIDE = 1e-9
"""Of a patch's parameters: what lies beyond a side by no more lies on it."""
_INSIDE = 1.0 - 1e-9
"""Touched so much nearer to the axis than it would be: rounding puts no place of a cutter's rim out of its reach."""


@kernel(f"float64({_NETS}, int64, float64, float64, float64, float64, {_R})", counts=False)
def tip_over(control, patch, u, v, x, y, shape):
    """Return how low the tip comes at (x, y) over one place of a patch; -inf where that is out of reach."""
    at_x, at_y, z = place(control, patch, u, v)
    r = length(at_x - x, at_y - y)
    return z - height(r, shape) if r <= shape[RADIUS] else -math.inf


@kernel(f"UniTuple(float64, 2)({_NETS}, int64, float64, float64, float64, float64, {_R})", counts=False)
def _off(control, patch, u, v, x, y, shape):
    """Return how far, in x and y, a place is from where it would be touched."""
    ax, ay, az = place(control, patch, u, v)
    bx, by, bz = place(control, patch, u + _SLOPE_STEP, v)
    cx, cy, cz = place(control, patch, u, v + _SLOPE_STEP)
    bx, by, bz, cx, cy, cz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    nx, ny, nz = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
    if nz == 0.0:
        return math.nan, math.nan
    # What is written of the surface as z(x, y): its slopes, from the normal. The touch lies uphill by `contact`.
    east, north = -nx / nz, -ny / nz
    steep = length(east, north)
    far = _INSIDE * contact(steep, shape) / steep if steep > 0.0 else 0.0
    return ax - x - far * east, ay - y - far * north


@kernel(f"UniTuple(float64, 3)({_NETS}, int64, float64, float64, float64, float64, {_R})", counts=False)
def touch_within(control, patch, u, v, x, y, shape):
    """Return the tip's height and where it touches, by Newton's method from (u, v); -inf and where it left a patch, or
    NaN.
    """
    off_x, off_y = _off(control, patch, u, v, x, y, shape)
    ux, uy = _off(control, patch, u + _TURN_STEP, v, x, y, shape)
    vx, vy = _off(control, patch, u, v + _TURN_STEP, x, y, shape)
    ux, uy, vx, vy = (
        (ux - off_x) / _TURN_STEP,
        (uy - off_y) / _TURN_STEP,
        (vx - off_x) / _TURN_STEP,
        (vy - off_y) / _TURN_STEP,
    )
    base = ux * vy - uy * vx
    for n in range(_TIMES):
        du, dv = (off_x * vy - off_y * vx) / base, (off_y * ux - off_x * uy) / base
        u, v = u - du, v - dv
        # So far beyond its patch a polynomial is no guide back.
        if not (-0.5 < u < 1.5 and -0.5 < v < 1.5):
            return -math.inf, u, v
        if abs(du) + abs(dv) <= _SAME * 100.0 or (n == _TIMES - 1 and abs(du) + abs(dv) <= 1e-8):
            if -_OUTSIDE <= u <= 1.0 + _OUTSIDE and -_OUTSIDE <= v <= 1.0 + _OUTSIDE:
                u, v = min(max(u, 0.0), 1.0), min(max(v, 0.0), 1.0)
                return tip_over(control, patch, u, v, x, y, shape), u, v
            return -math.inf, u, v
        if n == 1:  # the first step was a long one: tell anew how it changes
            ux, uy = _off(control, patch, u + _TURN_STEP, v, x, y, shape)
            vx, vy = _off(control, patch, u, v + _TURN_STEP, x, y, shape)
        off_x, off_y = _off(control, patch, u, v, x, y, shape)
        if n == 1:
            ux, uy, vx, vy = (
                (ux - off_x) / _TURN_STEP,
                (uy - off_y) / _TURN_STEP,
                (vx - off_x) / _TURN_STEP,
                (vy - off_y) / _TURN_STEP,
            )
            base = ux * vy - uy * vx
    return -math.inf, math.nan, math.nan


@kernel(f"UniTuple(float64, 3)({_NETS}, int64, float64, float64, float64, float64, {_R}, int64)", counts=False)
def _on_side(control, patch, u, v, x, y, shape, side):
    """Return the tip's height and where it touches a side of a patch (u = 0, 1 or v = 0, 1), climbing from (u, v)."""
    at, fixed = (v, float(side)) if side < 2 else (u, float(side - 2))
    at = min(max(at, 0.0), 1.0)
    step = 1e-2
    best = (
        tip_over(control, patch, fixed, at, x, y, shape)
        if side < 2
        else tip_over(control, patch, at, fixed, x, y, shape)
    )
    for _ in range(_SIDE_TIMES):
        low, high = max(at - step, 0.0), min(at + step, 1.0)
        if side < 2:
            below, above = (
                tip_over(control, patch, fixed, low, x, y, shape),
                tip_over(control, patch, fixed, high, x, y, shape),
            )
        else:
            below, above = (
                tip_over(control, patch, low, fixed, x, y, shape),
                tip_over(control, patch, high, fixed, x, y, shape),
            )
        if below > best:
            at, best = low, below
            continue
        if above > best:
            at, best = high, above
            continue
        new = at
        a, b = at - low, high - at
        bend = b * (below - best) + a * (above - best)
        if a > 0.0 and b > 0.0 and bend < 0.0 and below > -math.inf and above > -math.inf:  # the top of a parabola
            new = at - 0.5 * (a * a * (above - best) - b * b * (below - best)) / bend
        top = (
            tip_over(control, patch, fixed, new, x, y, shape)
            if side < 2
            else tip_over(control, patch, new, fixed, x, y, shape)
        )
        if top > best:
            at, best = new, top
        step *= 0.05 if top > -math.inf else 0.25
        if step < 1e-8:
            break
    return (best, fixed, at) if side < 2 else (best, at, fixed)


@kernel(f"UniTuple(float64, 3)({_NETS}, int64, float64, float64, float64, float64, {_R})", counts=False)
def touch(control, patch, u, v, x, y, shape):
    """Return the tip's height at (x, y) over a patch and the parameters of where it touches, near (u, v).

    -inf where Newton's method led nowhere. The height is that over a true place; another one may be higher.
    """
    best, best_u, best_v = touch_within(control, patch, u, v, x, y, shape)
    if best == -math.inf and best_u == best_u:
        out_u, out_v = max(-best_u, best_u - 1.0), max(-best_v, best_v - 1.0)
        if out_u >= out_v:
            best, best_u, best_v = _on_side(control, patch, u, v, x, y, shape, 0 if best_u < 0.5 else 1)
        else:
            best, best_u, best_v = _on_side(control, patch, u, v, x, y, shape, 2 if best_v < 0.5 else 3)
    return best, best_u, best_v
