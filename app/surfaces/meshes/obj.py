"""OBJ files: places and faces; faces may have any number of corners, and count them from either end."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from .polygons import triangulated

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_CONTINUED = re.compile(rb"\\[ \t]*\r?\n")
_PLACE = re.compile(rb"^[ \t]*v[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", re.MULTILINE)
_FACE = re.compile(rb"^[ \t]*fo?[ \t]+([^#\r\n]*)", re.MULTILINE)
_APPEARANCE = re.compile(rb"/[-+\d/]*")
"""Numbers of textures and normals at the corners of faces."""


def obj_triangles(data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of a file, in its own units.

    Raises:
        ValueError: a number is none. IndexError: a corner is none of the places before it.
    """
    text = _APPEARANCE.sub(b"", _CONTINUED.sub(b" ", data).replace(b"\r", b"\n"))
    places = list(_PLACE.finditer(text))
    points = np.array([[float(word) for word in each.groups()] for each in places]).reshape(-1, 3)
    begun = np.array([each.start() for each in places], np.int64)
    by_length: dict[int, tuple[list[list[bytes]], list[int]]] = {}
    for each in _FACE.finditer(text):
        words = each[1].split()
        corners, offsets = by_length.setdefault(len(words), ([], []))
        corners.append(words)
        offsets.append(each.start())
    faces = [
        _numbers(corners, np.searchsorted(begun, offsets))
        for length, (corners, offsets) in by_length.items()
        if length >= 3
    ]
    return points[triangulated(points, faces)]


def _numbers(corners: list[list[bytes]], known: Ints) -> Ints:
    """Return the numbers (k, length), from 0, of the corners of faces.

    Args:
        known: how many places stand before each face.

    Raises:
        IndexError: one is none of them.
    """
    said = np.array(corners).astype(np.int64)
    found = np.where(said < 0, known[:, None] + said, said - 1)
    if (found < 0).any() or (said == 0).any():
        raise IndexError("a corner that is no place")
    return np.asarray(found)
