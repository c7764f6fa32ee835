"""Corners of triangles that are at the same place get one number: what neighbours are told by."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MIX = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
"""Odd numbers that spread the bits of three coordinates over one word."""


def numbered(places: Floats) -> Ints:
    """Return the number of each place (n, 3): equal places have one, and numbers go up with X, then Y, then Z; there is one zero only.

    Places are sorted by one word that is mixed from their bits, a fifth of the work of sorting them by their three coordinates; those
    whose words are equal are compared, and in the unheard-of case that two places share a word, all are sorted by their coordinates.
    """
    plain = np.ascontiguousarray(places + 0.0)
    word = _words(plain)
    order = np.argsort(word, kind="stable")
    word = word[order]
    new = np.concatenate([[True], word[1:] != word[:-1]]) if len(word) else np.zeros(0, np.bool_)
    del word
    if not _same(plain, order, new):
        return np.asarray(np.unique(plain, axis=0, return_inverse=True)[1], np.int64).ravel()
    first = plain[order[new]]
    rank = np.empty(len(first), np.int64)
    rank[np.lexsort(first.T[::-1])] = np.arange(len(first))
    number = np.empty(len(plain), np.int64)
    number[order] = rank[np.cumsum(new) - 1]
    return number


def _words(places: Floats) -> NDArray[np.uint64]:
    bits = places.view(np.uint64)
    word = np.zeros(len(places), np.uint64)
    for axis in range(3):
        word ^= bits[:, axis]
        word *= _MIX[axis]
        word ^= word >> np.uint64(29)
    return word


def _same(places: Floats, order: Ints, new: NDArray[np.bool_]) -> bool:
    """Return whether places that follow one another in an order are equal, but where a new one begins."""
    for first in range(0, len(order), 1 << 18):
        there = places[order[max(first - 1, 0) : first + (1 << 18)]]
        equal = np.all(there[1:] == there[:-1], axis=1)
        if not (equal | new[max(first - 1, 0) + 1 : first + (1 << 18)]).all():
            return False
    return True


def crosses(triangles: Floats) -> Floats:
    """Return twice the area of each triangle (n, 3, 3), mm2."""
    doubled = np.empty(len(triangles))
    for first in range(0, len(triangles), 1 << 16):
        some = triangles[first : first + (1 << 16)]
        doubled[first : first + (1 << 16)] = np.linalg.norm(np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0]), axis=1)
    return doubled
