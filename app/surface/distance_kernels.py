"""Compiled: how far a segment is from a triangle in space, in closed form."""

from __future__ import annotations

import math

from app.jit import kernel

_R = "float64[::1]"
_FLAT = 1e-300
_SLIVER = 1e-22
"""mm2; a triangle whose height is less than the root of this is its edges: of what it faces only rounding would tell."""


@kernel("float64(float64, float64, float64, float64, float64, float64, float64, float64, float64)", counts=False)
def _between(dx, dy, dz, ex, ey, ez, wx, wy, wz):  # type: ignore[no-untyped-def]
    """Return the square of the distance between segments along d and e, whose starts are apart by w (Eberly, closest points)."""
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
def square_from_triangle(t, ax, ay, az, bx, by, bz):  # type: ignore[no-untyped-def]
    """Return the square of the distance of the segment from a to b from a triangle (9,); 0 where it goes through."""
    dx, dy, dz = bx - ax, by - ay, bz - az
    ux, uy, uz, vx, vy, vz = t[3] - t[0], t[4] - t[1], t[5] - t[2], t[6] - t[0], t[7] - t[1], t[8] - t[2]
    px, py, pz = ax - t[0], ay - t[1], az - t[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    square = nx * nx + ny * ny + nz * nz
    best = _between(dx, dy, dz, ux, uy, uz, px, py, pz)
    best = min(best, _between(dx, dy, dz, vx, vy, vz, px, py, pz))
    best = min(best, _between(dx, dy, dz, vx - ux, vy - uy, vz - uz, px - ux, py - uy, pz - uz))
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    if square <= _SLIVER * max(uu, vv, uu - 2.0 * uv + vv) or square <= _FLAT:
        return best
    start, end = nx * px + ny * py + nz * pz, nx * (px + dx) + ny * (py + dy) + nz * (pz + dz)
    for share in (0.0, 1.0, start / (start - end) if start * end < 0.0 else math.nan):  # both ends, and where it goes through
        if share == share:
            x, y, z = px + share * dx, py + share * dy, pz + share * dz
            du, dv = x * ux + y * uy + z * uz, x * vx + y * vy + z * vz
            s, r = (vv * du - uv * dv) / square, (uu * dv - uv * du) / square
            if s >= 0.0 and r >= 0.0 and s + r <= 1.0:
                off = nx * x + ny * y + nz * z
                best = min(best, off * off / square)
    return best
