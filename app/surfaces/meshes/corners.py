"""Corners of triangles that are at the same place get one number: what neighbours are told by."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_PART = 1 << 16
"""Triangles that are looked at together: what is needed meanwhile stays small."""


def numbered(places: Floats) -> Ints:
    """Return the number of each place (n, 3), from 0 in the order in which they come; equal ones have one, and there is
    one zero only.
    """
    return numbered_rows((places + 0.0).view(np.int64))


def numbered_rows(rows: Ints) -> Ints:
    """Return the number of each row (n, m) of whole numbers, from 0 in the order in which they come; equal ones have
    the same.
    """
    from .corner_kernels import number_rows

    number, size = np.empty(len(rows), np.int64), 2 << max(4, len(rows).bit_length())
    number_rows(np.ascontiguousarray(rows).view(np.uint64), np.full(size, -1, np.int32), number)
    return number


def doubled_areas(triangles: Floats) -> Floats:
    """Return twice the area of each triangle (n, 3, 3), mm2."""
    doubled = np.empty(len(triangles))
    for first in range(0, len(triangles), _PART):
        some = triangles[first : first + _PART]
        doubled[first : first + _PART] = np.linalg.norm(
            np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0]), axis=1
        )
    return doubled
