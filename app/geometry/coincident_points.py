"""Which places lie at others, and which rows of numbers are alike: many take no longer than to sort them."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..model.motion import Floats

_CELL = 2.5
"""Reaches that a cell is wide; with two alone rounding might put the ends of a reach two cells apart, and what is
between in neither.
"""

_MIX = np.uint64(0x9E3779B97F4A7C15)
"""An odd number that spreads what it multiplies over 64 bits."""


def near(places: Floats, others: Floats, reach: float) -> NDArray[np.bool_]:
    """Tell which places (n, 3) have one of some others (m, 3) within a reach, mm.

    Cells are wider than twice the reach, so that what is within it lies in one of at most eight: those that the corners
    of the box of the reach round a place lie in.

    Args:
        reach: > 0; others nearer together than that are many in one cell, which costs.
    """
    found = np.zeros(len(places), np.bool_)
    if not len(places) or not len(others):
        return found
    others = np.unique(others, axis=0)
    width = _CELL * reach
    keys = row_keys(np.floor(others / width))  # different cells that are alike only cost a distance more
    order = np.argsort(keys, kind="stable")
    others, keys = others[order], keys[order]
    for side in product((-reach, reach), repeat=3):
        requested = row_keys(np.floor((places + np.array(side)) / width))
        at, stop = np.searchsorted(keys, requested), np.searchsorted(keys, requested, side="right")
        open_ = np.flatnonzero(~found & (at < stop))
        while len(open_):
            found[open_] = np.linalg.norm(places[open_] - others[at[open_]], axis=1) <= reach
            at[open_] += 1
            open_ = open_[~found[open_] & (at[open_] < stop[open_])]
    return found


def row_keys(rows: Floats) -> NDArray[np.uint64]:
    """Return 64 bits mixed from the numbers of each row (n, k), alike where rows are; few of different rows are alike.

    They sort many times faster than rows, and without stopping every thread, as numpy's own way through rows does.
    """
    mixed = np.zeros(len(rows), np.uint64)
    for column in (rows + 0.0).T:  # 0 and -0 are one number
        mixed = (mixed ^ np.ascontiguousarray(column).view(np.uint64)) * _MIX
        mixed ^= mixed >> np.uint64(29)
    return mixed
