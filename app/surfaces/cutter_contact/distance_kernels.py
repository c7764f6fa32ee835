# mypy: allow-untyped-defs
"""Compiled: how far a segment, or all that is above it, is from a triangle in space, in closed form."""

from __future__ import annotations

import math

from ...core.jit import kernel

_R = "float64[::1]"
_FLAT = 1e-300
"""mm2; a side whose square is less is a point."""
_SLIVER = 1e-22
"""mm2; a triangle whose height is less than the root of this is its edges: of what it faces only rounding would
tell.
"""


@kernel("float64(float64, float64, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _between(dx, dy, dz, ex, ey, ez, wx, wy, wz):
    """Return the square of the distance between segments along d and e, whose starts are apart by w (Eberly, closest
    points).
    """
    a, b, c = dx * dx + dy * dy + dz * dz, dx * ex + dy * ey + dz * ez, ex * ex + ey * ey + ez * ez
    d, e = dx * wx + dy * wy + dz * wz, ex * wx + ey * wy + ez * wz
    base = a * c - b * b
    s = min(max((b * e - c * d) / base, 0.0), 1.0) if base > 1e-14 * a * c else 0.0
    t = (b * s + e) / c if c > _FLAT else 0.0
    if t < 0.0 or t > 1.0:
        t = min(max(t, 0.0), 1.0)
        s = min(max((b * t - d) / a, 0.0), 1.0) if a > _FLAT else 0.0
    x, y, z = wx + s * dx - t * ex, wy + s * dy - t * ey, wz + s * dz - t * ez
    return x * x + y * y + z * z


@kernel(f"float64({_R}, float64, float64, float64, float64, float64, float64)", counts=False)
def square_from_triangle(t, ax, ay, az, bx, by, bz):
    """Return the square of the distance of the segment from a to b from a triangle (9,); 0 where it goes through."""
    dx, dy, dz = bx - ax, by - ay, bz - az
    ux, uy, uz, vx, vy, vz = t[3] - t[0], t[4] - t[1], t[5] - t[2], t[6] - t[0], t[7] - t[1], t[8] - t[2]
    px, py, pz = ax - t[0], ay - t[1], az - t[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    best, inside = math.inf, 0
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    if square > _SLIVER * max(uu, vv, uu - 2.0 * uv + vv) and square > _FLAT:
        start, end = nx * px + ny * py + nz * pz, nx * (px + dx) + ny * (py + dy) + nz * (pz + dz)
        # both ends, and where it goes through
        for share in (
            0.0,
            1.0,
            start / (start - end) if start * end < 0.0 else math.nan,
        ):
            if share == share:
                x, y, z = px + share * dx, py + share * dy, pz + share * dz
                du, dv = x * ux + y * uy + z * uz, x * vx + y * vy + z * vz
                s, r = vv * du - uv * dv, uu * dv - uv * du
                if s >= 0.0 and r >= 0.0 and s + r <= square:
                    off = nx * x + ny * y + nz * z
                    best = min(best, off * off / square)
                    inside += 1
    if inside >= 2:  # over its face, or through it, all along
        return best
    best = min(best, _between(dx, dy, dz, ux, uy, uz, px, py, pz))
    best = min(best, _between(dx, dy, dz, vx, vy, vz, px, py, pz))
    return min(best, _between(dx, dy, dz, vx - ux, vy - uy, vz - uz, px - ux, py - uy, pz - uz))


@kernel(f"float64({_R}, float64, float64, float64, float64, float64, float64)", counts=False)
def square_from_curtain(t, ax, ay, az, bx, by, bz):
    """Return the square of the distance of a triangle (9,) from all that is on or above the segment from a to b."""
    best = square_from_triangle(t, ax, ay, az, bx, by, bz)
    top = max(t[2], t[5], t[8])
    if top <= min(az, bz):
        return best
    best = min(best, square_from_triangle(t, ax, ay, az, ax, ay, max(az, top)))
    best = min(best, square_from_triangle(t, bx, by, bz, bx, by, max(bz, top)))
    dx, dy, dz = bx - ax, by - ay, bz - az
    square = dx * dx + dy * dy
    if square <= _FLAT:
        return best
    for k in range(3):  # corners in front of the curtain, and edges that go through it
        n = 3 * ((k + 1) % 3)
        x, y, z = t[3 * k] - ax, t[3 * k + 1] - ay, t[3 * k + 2] - az
        share, off = (x * dx + y * dy) / square, x * dy - y * dx
        if 0.0 <= share <= 1.0 and z >= share * dz:
            best = min(best, off * off / square)
        ex, ey, ez = t[n] - t[3 * k], t[n + 1] - t[3 * k + 1], t[n + 2] - t[3 * k + 2]
        end = off + ex * dy - ey * dx
        if off * end < 0.0:
            at = off / (off - end)
            share = ((x + at * ex) * dx + (y + at * ey) * dy) / square
            if 0.0 <= share <= 1.0 and z + at * ez >= share * dz:
                return 0.0
    return best
