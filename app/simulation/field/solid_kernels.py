# mypy: allow-untyped-defs
"""Heights of a solid of triangles at the cells of a grid."""

from __future__ import annotations

import math

from ...core.jit import kernel


@kernel("float64(float64, float64, float64, float64, float64, float64)")
def side(ax, ay, bx, by, x, y):
    """Return twice the signed area of (a, b, point); to the bit the negative of the same with a and b exchanged."""
    if ax < bx or (ax == bx and ay < by):
        return (bx - ax) * (y - ay) - (by - ay) * (x - ax)
    return -((ax - bx) * (y - by) - (ay - by) * (x - bx))


@kernel("boolean(float64, float64, float64)")
def holds(area, dx, dy):
    """Return whether a point is on the inner side of a counter-clockwise edge; on the edge itself one of both sides has
    it.
    """
    # the top-left rule: of two triangles with one edge, exactly one has the places on it, so crossings stay even
    return area > 0.0 or (area == 0.0 and (dy < 0.0 or (dy == 0.0 and dx > 0.0)))


@kernel("void(float64[:, :, ::1], UniTuple(float64, 3), int64, int64, float32[:, ::1], int32[:, ::1])")
def drop(triangles, grid, first, last, heights, crossings):
    """Raise heights to the triangles first … last - 1, and count how often the vertical through each cell's centre
    meets them.

    Args:
        triangles: (n, 3, 3) corners, mm. Vertical ones are met by none; an edge belongs to one of its two triangles.
        grid: x and y of the lower left corner, pitch, mm.
        first, last: of the triangles.
        heights, crossings: of the grid.
    """
    x0, y0, pitch = grid
    rows, cols = heights.shape
    for k in range(first, last):
        ax, ay, az = triangles[k, 0, 0], triangles[k, 0, 1], triangles[k, 0, 2]
        bx, by, bz = triangles[k, 1, 0], triangles[k, 1, 1], triangles[k, 1, 2]
        cx, cy, cz = triangles[k, 2, 0], triangles[k, 2, 1], triangles[k, 2, 2]
        area = side(ax, ay, bx, by, cx, cy)
        if area < 0.0:
            bx, by, bz, cx, cy, cz = cx, cy, cz, bx, by, bz
        area = abs(area)
        if area == 0.0:
            continue
        low, high = (
            math.ceil((min(ay, by, cy) - y0) / pitch - 0.501),
            math.floor((max(ay, by, cy) - y0) / pitch - 0.499),
        )
        # cells whose centres may lie in it: half a cell, and a thousandth for rounding
        left, right = (
            math.ceil((min(ax, bx, cx) - x0) / pitch - 0.501),
            math.floor((max(ax, bx, cx) - x0) / pitch - 0.499),
        )
        for row in range(max(int(low), 0), min(int(high), rows - 1) + 1):
            y = y0 + (row + 0.5) * pitch
            for col in range(max(int(left), 0), min(int(right), cols - 1) + 1):
                x = x0 + (col + 0.5) * pitch
                # barycentric coordinates times twice the area; the shared edge of two triangles gives both the same
                # bits
                u, v, w = side(bx, by, cx, cy, x, y), side(cx, cy, ax, ay, x, y), side(ax, ay, bx, by, x, y)
                if holds(u, cx - bx, cy - by) and holds(v, ax - cx, ay - cy) and holds(w, bx - ax, by - ay):
                    z = (u * az + v * bz + w * cz) / (u + v + w)
                    crossings[row, col] += 1
                    heights[row, col] = max(heights[row, col], z)
