# mypy: allow-untyped-defs
"""Compiled: can a cutter's centre be near a place? See `app.toolpath.coverage.areas`."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import DEPTH, inside, nearest

_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"
_WAITING = 256
"""Squares that wait at most: three of each size, of which there are some 40."""
_ROUNDING = 1e-9
"""mm; more than a distance is off by."""


@kernel("float64(float64[:, ::1], float64, float64)", counts=False)
def _from_nearest(points, x, y):
    """Return how far a place is from the nearest of some points."""
    square = math.inf
    for k in range(len(points)):
        dx, dy = points[k, 0] - x, points[k, 1] - y
        square = min(square, dx * dx + dy * dy)
    return math.sqrt(square)


@kernel(f"boolean({_TREE}, float64[:, ::1], float64, float64, float64, int64)")
def within_reach(rows, order, nodes, points, radius, wall, finest, most):
    """Return whether some place within a radius of one of some points (n, 2), n > 0, lies inside of closed rows and at
    least `wall` from them; True also where that stays in doubt.

    Squares are divided, where distances in their middles do not decide. A square that no row comes into is inside as
    its middle is, and so are its quarters, and none of these is farther from a row than it and the way to it.

    Args:
        finest: half a diagonal of a square, mm, below which it is in doubt for good.
        most: squares after which it is in doubt.
    """
    waiting, stack = np.empty((_WAITING, 5)), np.empty(DEPTH, np.int64)
    x0, y0, x1, y1 = points[0, 0], points[0, 1], points[0, 0], points[0, 1]
    for k in range(1, len(points)):
        x0, y0, x1, y1 = min(x0, points[k, 0]), min(y0, points[k, 1]), max(x1, points[k, 0]), max(y1, points[k, 1])
    waiting[0, 0], waiting[0, 1], waiting[0, 2] = (x0 + x1) / 2.0, (y0 + y1) / 2.0, max(x1 - x0, y1 - y0) / 2.0 + radius
    waiting[0, 3], waiting[0, 4] = np.inf, 0.0
    top, looked = 1, 0
    while top > 0:
        top -= 1
        looked += 1
        px, py, half, known, within = waiting[top]
        # no point of the square is farther than `off` from its middle
        off, away = half * math.sqrt(2.0), _from_nearest(points, px, py)
        if away > radius + off:
            continue
        limit = min(max(wall, off) + _ROUNDING, known + _ROUNDING)
        distance, row = nearest(rows, order, nodes, px, py, limit)
        if distance + off < wall:
            continue
        # even-odd is the dearest question, so it is put only where its answer decides
        asked = within == 0.0 and (distance > off or (distance >= wall and away <= radius))
        it_is = within != 0.0 or (asked and inside(rows, order, nodes, px, py, stack))
        if distance > off and not it_is:
            continue
        if it_is and distance >= wall and away <= radius:
            return True
        if off < finest or looked > most or top + 4 > _WAITING:
            return True
        half /= 2.0
        # a quarter's middle is half its parent's diagonal away: no row near it can be farther than this
        known = distance + half * math.sqrt(2.0) if row >= 0 else np.inf
        within = 1.0 if distance > off else 0.0
        for corner in range(4):
            waiting[top, 0] = px + (half if corner % 2 else -half)
            waiting[top, 1] = py + (half if corner > 1 else -half)
            waiting[top, 2], waiting[top, 3], waiting[top, 4] = half, known, within
            top += 1
    return False
