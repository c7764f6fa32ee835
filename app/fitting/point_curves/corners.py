"""Corners of a path: points that are kept exactly, with a bend, whatever is fitted between them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats

Ints = NDArray[np.int64]

LEAST_LEG = 0.5
"""Of the reach: a point whose chords turn by more than the angle, and are both so long or longer, is a corner whatever
is beside.
"""


def bends(points: Floats, angle: float) -> tuple[Ints, Floats]:
    """Return the numbers of the points whose two chords turn by more than an angle, and the length of the shorter one,
    mm.

    Args:
        points: (n, 3) mm, no two in a row alike.
        angle: radians, in (0, pi].
    """
    steps = np.diff(points, axis=0)
    sizes = np.linalg.norm(steps, axis=1)
    cosines = np.einsum("ij,ij->i", steps[1:], steps[:-1]) / (sizes[1:] * sizes[:-1])
    inner = np.flatnonzero(cosines < math.cos(angle))
    return inner + 1, np.minimum(sizes[1:], sizes[:-1])[inner]


def corners(points: Floats, angle: float, reach: float) -> Ints:
    """Return the numbers of the points at which a path turns by more than an angle, and the first and the last.

    A turn is looked at over a length, so that neither a crumb beside a long chord makes a corner of nothing, nor crumbs
    round a corner hide it: of several points about a corner the one with the largest turn is it. The turn must be there
    over twice the length, too: noise of a quarter of the reach to either side never turns by 30 degrees over that.
    Where both chords at a point are `LEAST_LEG` of the reach or longer their own turn makes the corner, as at both ends
    of a step to the next row.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        angle: radians, in (0, pi].
        reach: over so much of the path before and behind, mm, > 0; over the chord where that is longer.
    """
    from . import corner_kernels

    points = np.ascontiguousarray(points)
    along, turn, wide, kept = (
        np.empty(len(points)),
        np.empty(len(points)),
        np.empty(len(points)),
        np.empty(len(points), np.bool_),
    )
    corner_kernels.turns(points, 2 * reach, along, wide)
    corner_kernels.turns(points, reach, along, turn)
    turn[wide <= angle] = 0.0
    corner_kernels.peaks(turn, along, angle, reach, kept)
    sharp, legs = bends(points, angle)
    kept[sharp[legs >= LEAST_LEG * reach * (1 - 1e-9)]] = True
    return np.flatnonzero(kept)
