# mypy: allow-untyped-defs
"""Where the centre of an arc is: one rule for the reader's core and for its lane, so that both give the same bits."""

from __future__ import annotations

import math

from ...core.jit import kernel


@kernel("UniTuple(float64, 2)(float64, float64, float64, float64, float64, float64, float64)")
def centre_by_radius(x0, y0, x1, y1, radius, turn, slack):
    """Return the centre of an arc that is given by its ends and its radius; (NaN, NaN) where there is none.

    Args:
        x0, y0, x1, y1: start and end in the arc's plane, mm. Alike: there is no arc, for its centre could be anywhere.
        radius: mm; negative = the arc of more than half a turn.
        turn: 1 counter-clockwise, -1 clockwise.
        slack: how much the radius may be too small to reach the end, mm; it is then half the distance of the ends.
    """
    dx, dy = x1 - x0, y1 - y0
    half = math.hypot(dx, dy) / 2.0
    size = abs(radius)
    if not half > 0.0 or not size > 0.0 or half - size > slack:
        return math.nan, math.nan
    # (size - half) (size + half) loses no digits where both are nearly alike, as size² - half² would
    rise = math.sqrt((size - half) * (size + half)) if size > half else 0.0
    side = math.copysign(rise / (2.0 * half), radius) * turn
    return (x0 + x1) / 2.0 - side * dy, (y0 + y1) / 2.0 + side * dx


@kernel("UniTuple(float64, 2)(float64, float64, float64, float64, float64, float64)")
def radii(x0, y0, x1, y1, cx, cy):
    """Return how far the centre of an arc is from its start and from its end, mm."""
    return math.hypot(x0 - cx, y0 - cy), math.hypot(x1 - cx, y1 - cy)
