"""Files of triangles by their formats; STL, which tells a file that was cut off, is read here."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from .obj import obj_triangles
from .ply import ply_triangles
from .three_mf import three_mf_triangles

Floats = NDArray[np.float64]

HEADER, TRIANGLE = 84, 50
"""Bytes of a binary STL file: its header with the number of triangles, and each triangle."""

_SANE = 1e12
"""No corner of a part lies so far out; one that does is no number that anybody has written."""

_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
"""A triangle of a binary STL file, 50 bytes, little-endian: its normal, its corners, and a number that nobody agrees
on.
"""
_LINE_END = re.compile(rb"[\r\n]+")
_MARK = b"\xef\xbb\xbf"
"""Before a text that some editor has saved."""
_LOOP_END = re.compile(rb"\bendloop\b", re.IGNORECASE)
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_mesh(name: str, data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of a file, n > 0, in its own units; of 3MF, which names them, mm.

    Args:
        name: of the file, for errors; its suffix tells the format: .stl, .obj, .ply or .3mf.
        data: the file.

    Raises:
        InputError: it cannot be read, was cut off, or holds no triangle.
    """
    suffix = name.lower().rpartition(".")[2]
    if suffix == "stl":
        return stl_triangles(name, data)
    triangles = three_mf_triangles(name, data) if suffix == "3mf" else _faces(name, data, suffix)
    return _sound(name, triangles, suffix)


def stl_triangles(name: str, data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of an STL file, text or binary, n > 0, in its own units.

    Raises:
        InputError: it is none, was cut off, or holds no triangle.
    """
    return _sound(name, _stl(name, data), "stl")


def _sound(name: str, triangles: Floats, suffix: str) -> Floats:
    """Return triangles that a part may have.

    Raises:
        InputError: there is none, or a corner is no place of a part.
    """
    if not len(triangles):
        raise InputError(f"{name}: there is no triangle in this {suffix.upper()} file; export it again.")
    if not (max(float(triangles.max()), -float(triangles.min())) < _SANE):
        raise InputError(f"{name}: a corner of a triangle is no number, or far out of range; export it again.")
    return triangles


def _stl(name: str, data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of an STL file, text or binary.

    Raises:
        InputError: it is none, or was cut off.
    """
    data = data.removeprefix(_MARK)
    count = int.from_bytes(data[HEADER - 4 : HEADER], "little")
    whole = HEADER + TRIANGLE * count
    if data.lstrip()[:5].lower() == b"solid" and len(data) != whole and b"\0" not in data[:HEADER]:
        return _text(name, data)
    if len(data) < whole:
        here = _records(data, (len(data) - HEADER) // TRIANGLE)
        if len(data) > HEADER and np.isfinite(here).all() and (np.abs(here) < _SANE).all():
            raise InputError(
                f"{name}: this STL file was cut off: it has {len(data):,} bytes of the {whole:,} that its {count:,} "
                "triangles take; copy or export it again."
            )
        raise _no_stl(name)
    if len(data) < HEADER:
        raise _no_stl(name)
    _check_count(name, data, count)
    return _records(data, count)


def _check_count(name: str, data: bytes, count: int) -> None:
    """Refuse a binary file with whole triangles behind those that its header counts; other bytes there are colours.

    Raises:
        InputError: it has some.
    """
    more, rest = divmod(len(data) - HEADER - TRIANGLE * count, TRIANGLE)
    if not more or rest:
        return
    there = _records(data, count + more)
    if np.isfinite(there).all() and (np.abs(there) < _SANE).all():
        raise InputError(
            f"{name}: the header of this STL file counts {count:,} triangles, and it holds {count + more:,}; export it "
            "again."
        )


def _no_stl(name: str) -> InputError:
    return InputError(f"{name}: this is no STL file, or it is damaged; export the solid again, as binary STL.")


def _records(data: bytes, count: int) -> Floats:
    """Return the triangles of a binary file."""
    return np.frombuffer(data, _RECORD, max(count, 0), HEADER if count > 0 else 0)["corners"].astype(np.float64)


def _text(name: str, data: bytes) -> Floats:
    """Return the triangles of a text; its first line is a name, in any code page. Lines may end in any way, or not."""
    rest = _LINE_END.split(data.lstrip(), maxsplit=1)[-1]
    try:
        facets = [_VERTEX.findall(each) for each in _LOOP_END.split(rest)]
        words = [word for each in facets for word in each]
        corners = np.array([[float(word) for word in each] for each in words[: len(words) // 3 * 3]]).reshape(-1, 3, 3)
    except ValueError as error:
        raise _no_stl(name) from error
    if b"endsolid" not in rest[-1000:].lower():
        raise InputError(
            f"{name}: this STL file was cut off after {len(corners):,} triangles, as its end, endsolid, is missing; "
            "copy or export it again."
        )
    if any(len(each) != 3 for each in facets[:-1]):
        raise InputError(f"{name}: a facet of this STL file has other than three corners; export the solid again.")
    return corners


def _faces(name: str, data: bytes, suffix: str) -> Floats:
    """Return the triangles of an OBJ or PLY file."""
    try:
        return obj_triangles(data) if suffix == "obj" else ply_triangles(data)
    except (ValueError, IndexError, KeyError, StopIteration, OverflowError, MemoryError) as error:
        raise InputError(f"{name}: this is no {suffix.upper()} file, or it is damaged; export it again.") from error
