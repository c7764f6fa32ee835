"""3MF files: a ZIP archive with an XML model of meshes, components and a list of what is built, in a unit of its own.

References:
    3MF Core Specification 1.3: build items and components place objects by matrices of 12 numbers; a row of points
    times the matrix is the placed row. Its production extension 1.1: what they place may lie in another model, whose
    path is an attribute of theirs.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Iterator
from typing import NamedTuple
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


_BROKEN = (
    ElementTree.ParseError,
    ValueError,
    KeyError,
    IndexError,
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    OSError,
    RuntimeError,
    NotImplementedError,
)
"""What reading damaged bytes raises."""

_ROOT = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
"""The kind of relation that leads to the model to build."""
_SET_ASIDE = "0"
"""What slicers say of whether an item is printed, where it is not."""
_NO_PART = ("support", "solidsupport", "other")
"""Types of objects that hold a part while it is printed, or nothing of it."""


def three_mf_triangles(name: str, data: bytes) -> Floats:
    """Return the triangles (n, 3, 3) of everything that a file builds, mm.

    Args:
        name: of the file, for errors.
        data: its bytes.

    Raises:
        InputError: it is no 3MF file, or it is damaged.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            package = _Package(name, archive)
            built = (each for each in _all(package.root(), "item") if each.get("printable") != _SET_ASIDE)
            items = [(package.target(each, package.main), _matrix(each)) for each in built]
            parts = [triangles for target, matrix in items for triangles in _placed(package, target, matrix, 0)]
    except _BROKEN as error:
        raise _damaged(name) from error
    return package.unit() * np.concatenate(parts) if parts else np.zeros((0, 3, 3))


class _Target(NamedTuple):
    """An object: the model that holds it, and its number there."""

    model: str
    key: str


class _Package:
    """The models of a file; objects of one may be parts of those of another (the production extension).

    Attributes:
        main: path of the model that tells what is built.
    """

    def __init__(self, name: str, archive: zipfile.ZipFile) -> None:
        """Find the main model.

        Args:
            name: of the file, for errors.

        Raises:
            InputError: there is none.
        """
        self.name, self._archive = name, archive
        self._paths = {each.filename.lower(): each for each in archive.infolist()}
        self._roots: dict[str, Element] = {}
        self._objects: dict[str, dict[str, Element]] = {}
        self._unpacked = 0
        self.main = self._found_main()

    def _found_main(self) -> str:
        relations = self._paths.get("_rels/.rels")
        if relations is not None:
            for each in _all(ElementTree.fromstring(self._archive.read(relations)), "Relationship"):
                if each.get("Type") == _ROOT:
                    return _plain(each.get("Target", ""))
        models = [path for path in self._paths if path.endswith(".model")]
        if not models:
            raise InputError(f"{self.name}: there is no model in this 3MF file; export it again.")
        return next((path for path in models if path.endswith("3dmodel.model")), models[0])

    def root(self, path: str = "") -> Element:
        """Return the XML of a model, that of the main one without a path.

        Raises:
            InputError: all models together are too large.
        """
        path = path or self.main
        if path not in self._roots:
            packed = self._paths[path]
            self._unpacked += packed.file_size
            if self._unpacked > _MOST_BYTES:
                raise InputError(
                    f"{self.name}: its model takes {self._unpacked:,} bytes; export it with fewer triangles."
                )
            self._roots[path] = ElementTree.fromstring(self._archive.read(packed))
        return self._roots[path]

    def target(self, element: Element, model: str) -> _Target:
        """Return the object that an item or a component of a model places."""
        path = next((value for key, value in element.attrib.items() if key.endswith("}path")), None)
        return _Target(model if path is None else _plain(path), element.get("objectid", ""))

    def object(self, target: _Target) -> Element:
        """Return an object's XML."""
        if target.model not in self._objects:
            found = {each.get("id", ""): each for each in _all(self.root(target.model), "object")}
            self._objects[target.model] = found
        return self._objects[target.model][target.key]

    def unit(self) -> float:
        """Return the millimetres of a unit of the models that were read.

        Raises:
            InputError: it is not known, or they have several.
        """
        units = {root.get("unit", "millimeter") for root in self._roots.values()}
        if len(units) > 1:
            raise InputError(f"{self.name}: its models have different units; export it in millimetres.")
        (unit,) = units
        if unit not in _MM:
            raise InputError(f"{self.name}: its unit {unit!r} is not known; export it in millimetres.")
        return _MM[unit]


def _plain(path: str) -> str:
    """Return a path within the archive as `_Package` looks for it."""
    return path.lstrip("/").lower()


def _placed(package: _Package, target: _Target, matrix: Floats, depth: int) -> list[Floats]:
    """Return the triangles of an object where a matrix (4, 3) puts it, and those of its components."""
    if depth > _DEEPEST:
        raise InputError(f"{package.name}: its objects hold one another in a circle; export it again.")
    one, found = package.object(target), list[Floats]()
    if one.get("type") in _NO_PART:
        return found
    mesh = next(_all(one, "mesh"), None)
    if mesh is not None:
        found.append(_mesh_triangles(mesh, matrix))
    for each in _all(one, "component"):
        inner = _matrix(each)
        both = np.vstack([inner[:3] @ matrix[:3], inner[3] @ matrix[:3] + matrix[3]])
        found += _placed(package, package.target(each, target.model), both, depth + 1)
    return found


def _mesh_triangles(mesh: Element, matrix: Floats) -> Floats:
    """Return the triangles (n, 3, 3) of a mesh where a matrix (4, 3) puts it."""
    rows = [[each.get(axis, "") for axis in "xyz"] for each in _all(mesh, "vertex")]
    corners = [[each.get(corner, "") for corner in ("v1", "v2", "v3")] for each in _all(mesh, "triangle")]
    points = np.array(rows, np.float64).reshape(-1, 3) @ matrix[:3] + matrix[3]
    numbers = np.array(corners, np.int64).reshape(-1, 3)
    if len(numbers) and numbers.min() < 0:
        raise IndexError(numbers.min())
    return np.asarray(points[numbers])


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
