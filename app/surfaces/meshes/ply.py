"""PLY files: the places and faces of a text or of bytes in either order; faces may have any number of corners.

References:
    Turk, The PLY polygon file format, 1994: a header of elements with their properties, and their rows in that order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .polygons import triangulated

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")
"""What programs call the corners of a face."""


@dataclass(frozen=True, slots=True)
class _Property:
    """A column; `counted` is the type of a list's length, "" where it is no list."""

    name: str
    kind: str
    counted: str = ""


@dataclass(frozen=True, slots=True)
class _Element:
    """A table of the file."""

    name: str
    count: int
    properties: tuple[_Property, ...]

    @property
    def lists(self) -> bool:
        """Whether its rows may be of different lengths."""
        return any(each.counted for each in self.properties)


Columns = NDArray[np.generic] | list[Floats]
"""Of a property: one row, or list, for each; (n, length) where all lists are as long."""
Rows = Callable[[_Element], dict[str, Columns]]


def ply_triangles(data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of a file, in its own units.

    Raises:
        ValueError, KeyError, IndexError: it is none, or it is damaged.
    """
    head, end, body = data.partition(b"end_header")
    if not end or not head.startswith(b"ply"):
        raise ValueError("no header")
    order, elements = _header(head.decode("latin-1"))
    body = body[2:] if body.startswith(b"\r\n") else body[1:]
    points, faces = np.zeros((0, 3)), list[Ints]()
    rows = _text_rows(body) if not order else _binary_rows(body, order)
    for element in elements:
        columns = rows(element)
        if element.name == "vertex":
            points = np.stack([np.asarray(columns[axis], np.float64) for axis in "xyz"], axis=1)
        elif element.name == "face":
            faces = _faces(next(columns[name] for name in _CORNERS if name in columns))
    if any(len(group) and (group.min() < 0 or group.max() >= len(points)) for group in faces):
        raise IndexError("a corner that is no place")
    return points[triangulated(points, faces)]


def _header(text: str) -> tuple[str, list[_Element]]:
    """Return the order of bytes, "" of a text, and the tables."""
    order, found = None, list[_Element]()
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            order = _ORDERS[words[1]]
        elif words[:1] == ["element"]:
            found.append(_Element(words[1], int(words[2]), ()))
        elif words[:2] == ["property", "list"]:
            found[-1] = _with(found[-1], _Property(words[4], _TYPES[words[3]], _TYPES[words[2]]))
        elif words[:1] == ["property"]:
            found[-1] = _with(found[-1], _Property(words[2], _TYPES[words[1]]))
    if order is None or any(each.count < 0 for each in found):
        raise ValueError("no format")
    return order, found


def _with(element: _Element, column: _Property) -> _Element:
    return _Element(element.name, element.count, (*element.properties, column))


def _faces(lists: Columns) -> list[Ints]:
    """Return faces by their length, (k, length), of three corners at least."""
    if isinstance(lists, np.ndarray):
        return [np.asarray(lists, np.int64)] if lists.ndim == 2 and lists.shape[1] >= 3 else []
    by_length: dict[int, list[Floats]] = {}
    for each in lists:
        by_length.setdefault(len(each), []).append(each)
    return [np.array(group).astype(np.int64) for length, group in by_length.items() if length >= 3]


def _text_rows(body: bytes) -> Rows:
    """Return what reads one table after the other of a text."""
    words, at = body.split(), 0

    def rows(element: _Element) -> dict[str, Columns]:
        nonlocal at
        if not element.lists:
            width = len(element.properties)
            taken = words[at : at + element.count * width]
            at += element.count * width
            table = np.array(taken, np.bytes_).astype(np.float64).reshape(element.count, width)
            return {each.name: table[:, k] for k, each in enumerate(element.properties)}
        found: dict[str, list[Floats]] = {each.name: [] for each in element.properties}
        for _ in range(element.count):
            for each in element.properties:
                length = int(words[at]) if each.counted else 1
                at += bool(each.counted)
                if length < 0 or at + length > len(words):
                    raise ValueError("cut off")
                found[each.name].append(np.array([float(word) for word in words[at : at + length]]))
                at += length
        return dict(found)

    return rows


def _binary_rows(body: bytes, order: str) -> Rows:
    """Return what reads one table after the other of bytes."""
    at = 0

    def rows(element: _Element) -> dict[str, Columns]:
        nonlocal at
        found, at = _alike(body, at, order, element) or _one_by_one(body, at, order, element)
        return found

    return rows


def _alike(body: bytes, at: int, order: str, element: _Element) -> tuple[dict[str, Columns], int] | None:
    """Return a table and its end, where all its lists are as long as those of its first row; else None."""
    lengths, here = [], at
    for each in element.properties:
        length = 1
        if each.counted:
            length = int(np.frombuffer(body, order + each.counted, 1, here)[0]) if element.count else 0
            here += np.dtype(each.counted).itemsize
        lengths.append(length)
        here += length * np.dtype(each.kind).itemsize
    fields: list[tuple[str, str] | tuple[str, str, tuple[int, ...]]] = []
    for k, (each, length) in enumerate(zip(element.properties, lengths, strict=True)):
        fields += [(f"count{k}", order + each.counted)] if each.counted else []
        fields.append((f"value{k}", order + each.kind, (length,) if each.counted else ()))
    row = np.dtype(fields)
    if at + row.itemsize * element.count > len(body):
        return None
    table = np.frombuffer(body, row, element.count, at)
    for k, (each, length) in enumerate(zip(element.properties, lengths, strict=True)):
        if each.counted and (table[f"count{k}"] != length).any():
            return None
    return {each.name: table[f"value{k}"] for k, each in enumerate(element.properties)}, at + table.nbytes


def _one_by_one(body: bytes, at: int, order: str, element: _Element) -> tuple[dict[str, Columns], int]:
    """Return a table and its end, row by row."""
    found: dict[str, list[Floats]] = {each.name: [] for each in element.properties}
    for _ in range(element.count):
        for each in element.properties:
            length = 1
            if each.counted:
                length = int(np.frombuffer(body, order + each.counted, 1, at)[0])
                at += np.dtype(each.counted).itemsize
            if length:
                found[each.name].append(np.frombuffer(body, order + each.kind, length, at).astype(np.float64))
            at += length * np.dtype(each.kind).itemsize
    return dict(found), at
