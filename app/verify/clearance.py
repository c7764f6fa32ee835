"""Exact distance between tool path and walls in closed form: a second opinion that shares no code with the path makers.

Two plane curves that do not cross are nearest at an end of one of them, or where both have the same normal: at the
foot of an arc's centre on a line, or on the line through two arcs' centres. Where they cross, the distance is 0. So a
few candidate points on the first curve, measured against the second, hold the exact minimum. Rows of curves are
those of `app.geometry.primitives`, of any sweep.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import clearance_kernels as kernels

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


def curve_distance(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return the least distance of each pair of curves, and where on the first curve it is.

    Args:
        first, second: (n, 8) rows; line k of one belongs to line k of the other.

    Returns:
        Distances (n,), mm, and points (n, 2), mm.
    """
    each = np.arange(len(first))
    return pair_distance(first, second, each, each)


def pair_distance(first: Floats, second: Floats, one: Indices, other: Indices) -> tuple[Floats, Floats]:
    """Return the least distance of some pairs of curves, and where on the first curve it is.

    Args:
        first, second: (n, 8) and (m, 8) rows.
        one, other: (k,) rows of both that make a pair.

    Returns:
        Distances (k,), mm, and points (k, 2), mm.
    """
    distances, places = np.empty(len(one)), np.empty((len(one), 2))
    rows = (np.ascontiguousarray(each, np.float64) for each in (first, second))
    pairs = (np.ascontiguousarray(each, np.int64) for each in (one, other))
    kernels.pair_distances(*rows, *pairs, distances, places)
    return distances, places
