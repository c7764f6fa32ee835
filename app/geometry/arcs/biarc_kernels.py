# mypy: allow-untyped-defs
"""Compiled biarcs: two arcs that meet smoothly between two points with given directions."""

from __future__ import annotations

import math

from ...core import tolerances
from ...core.jit import kernel

_POINT = "UniTuple(float64, 2)"
NONE, LINE, ARC = 0, 1, 2
"""What there is from a tangent to a place."""
_STRAIGHT = tolerances.WELD / 2
"""mm; an arc that is no higher over its chord is a line."""


@kernel(f"Tuple((boolean, float64, float64))({_POINT}, {_POINT}, {_POINT}, {_POINT})")
def meeting(start, leaving, end, arriving):
    """Return whether there is a biarc, and where its arcs meet: in the middle between the tips of two tangents of one
    length.

    Args:
        start, end: points.
        leaving, arriving: unit directions there.

    References:
        Bolton (1975), "Biarc curves".
    """
    vx, vy = end[0] - start[0], end[1] - start[1]
    # Tangents of one length d from both ends have tips 2 d apart, as both tangents of an arc are equally long:
    # |v - d (t1 + t2)|^2 = 4 d^2, that is d^2 spread + 2 d lean - |v|^2 = 0. Its positive root is reach, written as
    # |v|^2 / (lean + sqrt(...)), where nothing cancels.
    chord2 = vx * vx + vy * vy
    lean = vx * (leaving[0] + arriving[0]) + vy * (leaving[1] + arriving[1])
    spread = 2 * (1 - leaving[0] * arriving[0] - leaving[1] * arriving[1])
    root = lean + math.sqrt(lean * lean + spread * chord2)
    if root <= 0.0 or chord2 == 0.0:
        return False, 0.0, 0.0
    reach = chord2 / root
    return (
        True,
        (start[0] + end[0] + reach * (leaving[0] - arriving[0])) / 2,
        (start[1] + end[1] + reach * (leaving[1] - arriving[1])) / 2,
    )


@kernel(f"Tuple((int64, float64, float64, float64))({_POINT}, {_POINT}, {_POINT})")
def from_tangent(start, direction, end):
    """Return what leaves start in a unit direction and ends at end: its kind, and an arc's centre and turn (+1 or -1).

    NONE where an arc would turn by half a circle or more; LINE where its sagitta is below half of WELD.
    """
    vx, vy = end[0] - start[0], end[1] - start[1]
    side, ahead = direction[0] * vy - direction[1] * vx, direction[0] * vx + direction[1] * vy
    if ahead <= 0.0:
        return NONE, 0.0, 0.0, 0.0
    if abs(side) / 4 < _STRAIGHT:
        return LINE, 0.0, 0.0, 0.0
    # The centre lies on the chord's bisector, where the radius is square to the direction: half the chord times the
    # cotangent of the angle between chord and direction.
    height = ahead / side / 2
    return ARC, (start[0] + end[0]) / 2 - vy * height, (start[1] + end[1]) / 2 + vx * height, math.copysign(1.0, side)
