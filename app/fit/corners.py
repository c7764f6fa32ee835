"""Corners of a path: points that are kept exactly, with a bend, whatever is fitted between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.model.motion import Floats

Ints = NDArray[np.int64]


def corners(points: Floats, angle: float, reach: float) -> Ints:
    """Return the numbers of the points at which a path turns by more than an angle, and the first and the last.

    A turn is looked at over a length, so that neither a crumb beside a long chord makes a corner of nothing, nor crumbs
    round a corner hide it: of several points about a corner the one with the largest turn is it. The turn must be there
    over twice the length, too: noise of a quarter of the reach to either side never turns by 30 degrees over that.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        angle: radians, in (0, pi].
        reach: over so much of the path before and behind, mm, > 0; over the chord where that is longer.
    """
    from app.fit import corner_kernels

    points = np.ascontiguousarray(points)
    along, turn, wide, kept = np.empty(len(points)), np.empty(len(points)), np.empty(len(points)), np.empty(len(points), np.bool_)
    corner_kernels.turns(points, 2 * reach, along, wide)
    corner_kernels.turns(points, reach, along, turn)
    turn[wide <= angle] = 0.0
    corner_kernels.peaks(turn, along, angle, reach, kept)
    return np.flatnonzero(kept)
