"""3MF files: a ZIP archive with an XML model of meshes, components and a list of what is built, in a unit of its own.

References:
    3MF Core Specification 1.3: build items and components place objects by matrices of 12 numbers; a row of points
    times the matrix is the placed row.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError

Floats = NDArray[np.float64]
Element = ElementTree.Element

_MM = {"micron": 0.001, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0}
_MOST_BYTES = 1 << 30
"""Of the model once it is unpacked; more is no part that anybody mills."""

_DEEPEST = 32
"""Components within components; more of them turn in a circle."""


def three_mf_triangles(name: str, data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of everything that a file builds, mm.

    Args:
        name: of the file, for errors.
        data: its bytes.

    Raises:
        InputError: it is no 3MF file, or it is damaged.
    """
    try:
        root = ElementTree.fromstring(_model(name, data))
        objects = {each.get("id", ""): each for each in _all(root, "object")}
        items = [(each.get("objectid", ""), _matrix(each)) for each in _all(root, "item")]
        parts = [triangles for key, matrix in items for triangles in _placed(name, objects, key, matrix, 0)]
    except (ElementTree.ParseError, ValueError, KeyError, IndexError) as error:
        raise _damaged(name) from error
    scale = _MM.get(root.get("unit", "millimeter"))
    if scale is None:
        raise InputError(f"{name}: its unit {root.get('unit')!r} is not known; export it in millimetres.")
    return scale * np.concatenate(parts) if parts else np.zeros((0, 3, 3))


def _model(name: str, data: bytes) -> bytes:
    """Return the XML of the model."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            models = [each for each in archive.infolist() if each.filename.lower().endswith(".model")]
            if not models:
                raise InputError(f"{name}: there is no model in this 3MF file; export it again.")
            main = next((each for each in models if each.filename.lower().endswith("3dmodel.model")), models[0])
            if main.file_size > _MOST_BYTES:
                raise InputError(f"{name}: its model takes {main.file_size:,} bytes; export it with fewer triangles.")
            return archive.read(main)
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, NotImplementedError) as error:
        raise _damaged(name) from error


def _placed(name: str, objects: Mapping[str, Element], key: str, matrix: Floats, depth: int) -> list[Floats]:
    """Return the triangles of an object where a matrix (4, 3) puts it, and those of its components."""
    if depth > _DEEPEST:
        raise InputError(f"{name}: its objects hold one another in a circle; export it again.")
    one, found = objects[key], []
    mesh = next(_all(one, "mesh"), None)
    if mesh is not None:
        rows = [[each.get(axis, "") for axis in "xyz"] for each in _all(mesh, "vertex")]
        corners = [[each.get(corner, "") for corner in ("v1", "v2", "v3")] for each in _all(mesh, "triangle")]
        points = np.array(rows, np.float64).reshape(-1, 3) @ matrix[:3] + matrix[3]
        numbers = np.array(corners, np.int64).reshape(-1, 3)
        if len(numbers) and numbers.min() < 0:
            raise IndexError(numbers.min())
        found.append(points[numbers])
    for each in _all(one, "component"):
        inner = _matrix(each)
        both = np.vstack([inner[:3] @ matrix[:3], inner[3] @ matrix[:3] + matrix[3]])
        found += _placed(name, objects, each.get("objectid", ""), both, depth + 1)
    return found


def _matrix(element: Element) -> Floats:
    """Return the placement (4, 3) of an item or a component."""
    text = element.get("transform")
    if text is None:
        return np.vstack([np.eye(3), np.zeros(3)])
    return np.array(text.split(), np.float64).reshape(4, 3)


def _all(root: Element, tag: str) -> Iterator[Element]:
    """Yield every element of a name, whatever its namespace."""
    return (each for each in root.iter() if each.tag.rpartition("}")[2] == tag)


def _damaged(name: str) -> InputError:
    return InputError(f"{name}: this is no 3MF file, or it is damaged; export it again.")
