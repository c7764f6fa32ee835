"""Corners of a path: points that are kept exactly, with a bend, whatever is fitted between them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from app.model.motion import Floats

Ints = NDArray[np.int64]


def corners(points: Floats, angle: float, reach: float) -> Ints:
    """Return the numbers of the points at which a path turns by more than an angle, and the first and the last.

    A turn is looked at over a length, so that neither a crumb beside a long chord makes a corner of nothing, nor crumbs
    round a corner hide it: of several points about a corner the one with the largest turn is it. The turn must be there
    over twice the length, too: noise of a quarter of the reach to either side never turns by 30 degrees over that. Where both
    chords at a point are longer than half of the reach their own turn makes the corner, as at both ends of a step to the
    next row.

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
    steps = np.diff(points, axis=0)
    sizes = np.linalg.norm(steps, axis=1)
    cosines = np.einsum("ij,ij->i", steps[1:], steps[:-1]) / (sizes[1:] * sizes[:-1])
    kept[1:-1] |= (cosines < math.cos(angle)) & (np.minimum(sizes[1:], sizes[:-1]) >= 0.5 * reach * (1 - 1e-9))
    return np.flatnonzero(kept)
