# mypy: allow-untyped-defs
"""A plain trim, to measure others by: one thread, every cell of each move's box, branches, float64: what anybody would
write first.
"""

from __future__ import annotations

import math

from ...core.jit import kernel


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, float64)")
def plain_trim(heights, start, end, radius, pitch):
    """Lower heights over [0, n pitch]² under a ball.

    Args:
        heights: (rows, cols) mm.
        start, end: (n, 3) places of the tip, mm. radius: of the ball, mm. pitch: of the cells, mm.
    """
    rows, cols = heights.shape
    for k in range(len(start)):
        x0, y0, z0 = start[k]
        x1, y1, z1 = end[k]
        dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
        length2 = dx * dx + dy * dy
        length = math.sqrt(length2)
        slope = dz / length if length > 0 else 0.0
        lean = slope / math.sqrt(1 + slope * slope)
        first_row, last_row = (
            max(0, int((min(y0, y1) - radius) / pitch)),
            min(rows - 1, int((max(y0, y1) + radius) / pitch)),
        )
        first_col, last_col = (
            max(0, int((min(x0, x1) - radius) / pitch)),
            min(cols - 1, int((max(x0, x1) + radius) / pitch)),
        )
        for row in range(first_row, last_row + 1):
            y = (row + 0.5) * pitch - y0
            for col in range(first_col, last_col + 1):
                x = (col + 0.5) * pitch - x0
                along = (x * dx + y * dy) / length if length > 0 else 0.0
                square = x * x + y * y - along * along
                if square >= radius * radius:
                    continue
                # the circle in which the vertical through the cell cuts the swept sphere's plane
                reach = math.sqrt(radius * radius - square)
                # r s / sqrt(1 + s²) before the foot the sphere touches; clamped to the move's ends
                at = along - reach * lean
                if at < 0:
                    at = 0.0
                elif at > length:
                    at = length
                under = reach * reach - (along - at) * (along - at)
                if under < 0:
                    continue
                z = z0 + slope * at + radius - math.sqrt(under)
                if z < heights[row, col]:
                    heights[row, col] = z
