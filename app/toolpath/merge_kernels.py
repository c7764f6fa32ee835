# mypy: allow-untyped-defs
"""Compiled inner loop: which rows of a path begin a new line or arc."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel

_SAME_CENTRE = 1e-6  # mm
_WHOLE = 2 * math.pi - 1e-3
"""Arcs that follow one another become one as long as they turn less than this: a full turn would have no ends."""


@kernel("float64(float64[:, ::1], int64)", counts=False)
def _turn(rows, i):
    """Return how far row i turns, radians, >= 0."""
    if rows[i, 7] == 0.0:
        return 0.0
    if rows[i, 0] == rows[i, 2] and rows[i, 1] == rows[i, 3]:
        return 2 * math.pi
    start = math.atan2(rows[i, 1] - rows[i, 5], rows[i, 0] - rows[i, 4])
    end = math.atan2(rows[i, 3] - rows[i, 5], rows[i, 2] - rows[i, 4])
    return (end - start) * rows[i, 7] % (2 * math.pi)


@kernel("int64[::1](float64[:, ::1], uint8[::1], float64[::1])")
def beginnings(rows, purpose, heights):
    """Return the rows that do not go on with the arc before them.

    Args:
        rows: (n, 8), n > 0, each beginning where the one before ends. purpose: (n,) of each.
        heights: (n,) least height of each; none where it is one for all.
    """
    found, count, total = np.empty(len(rows), np.int64), 1, _turn(rows, 0)
    found[0] = 0
    for i in range(1, len(rows)):
        turn = _turn(rows, i)
        goes_on = (
            rows[i, 7] != 0.0
            and rows[i, 7] == rows[i - 1, 7]
            and purpose[i] == purpose[i - 1]
            and (len(heights) == 0 or heights[i] == heights[i - 1])
            and math.hypot(rows[i, 4] - rows[i - 1, 4], rows[i, 5] - rows[i - 1, 5]) < _SAME_CENTRE
            and abs(rows[i, 6] - rows[i - 1, 6]) < _SAME_CENTRE
            # an arc of a full turn begins where it ends, and controls read that as no move or as a whole circle
            and total + turn < _WHOLE
        )
        if goes_on:
            total += turn
            continue
        found[count] = i
        count += 1
        total = turn
    return found[:count].copy()
