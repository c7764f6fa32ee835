"""Compiled loop that tells of places one by one, each so far from all told before it."""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel


@kernel("int64(float64[:, ::1], int64[::1], int64[:, ::1], float64, int64[::1])")
def told_apart(places, own, around, apart, told):
    """Write which places are farther than `apart` from all that are told before them; return how many.

    Args:
        places: (m, 2), those to be told first in front.
        own: (m,) number of the square of side `apart` that each lies in.
        around: (n, 9) of each square itself and of those that touch it, -1: no place lies in it.
        apart: mm.
        told: (m,) numbers of the places.
    """
    last, before = np.full(len(around), -1, np.int64), np.empty(len(places), np.int64)
    count = 0
    for k in range(len(places)):
        alone = True
        # Squares are as wide as the distance: what is nearer lies in the same square or in one that touches it.
        for c in range(9):
            square = around[own[k], c]
            other = last[square] if square >= 0 else -1
            while other >= 0 and alone:
                alone = math.hypot(places[k, 0] - places[other, 0], places[k, 1] - places[other, 1]) > apart
                other = before[other]
        if alone:
            before[k], last[own[k]] = last[own[k]], k
            told[count] = k
            count += 1
    return count
