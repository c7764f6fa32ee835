"""Faces of STEP files as triangles, by Open CASCADE: an extra, since most scenes need none of it."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.atomic import waiting_prefix
from ...core.errors import GeometryError, InputError

Floats = NDArray[np.float64]

EXTRA = (
    "STEP files are read by Open CASCADE, which is not installed here; install it with: {} -m pip install "
    "'cadquery-ocp>=8,<9'."
)
_ANGLE = 0.3
"""radians; triangles of one face lean no more from one to the next, whatever the tolerance."""
_TIMES, _FINER = 6, 0.4
"""So often triangles are asked for, each time for so much finer ones: they are measured, as what was asked for is no
promise.
"""
_MOST = 3_000_000
"""Triangles; more fill the memory."""
_SAMPLES = ((1 / 3, 1 / 3, 1 / 3), (0.5, 0.5, 0.0), (0.0, 0.5, 0.5), (0.5, 0.0, 0.5))
"""Where triangles are measured, as shares of their corners: in the middle, and in that of each side, where a curve is
farthest.
"""


def step_triangles(name: str, data: bytes, numbers: tuple[int, ...], tolerance: float) -> Floats:
    """Return faces of a STEP file as triangles (n, 3, 3), mm, whatever units the file has.

    Args:
        name: of the file, for errors. data: its bytes.
        numbers: of the faces, from 1 on, in the order of the file; (): all of them.
        tolerance: how far the faces are from the triangles at most, mm; that is looked at, in the middle of every
            triangle and side, and where it is more the face is divided anew, more finely.

    Raises:
        InputError: Open CASCADE is not installed, or cannot read the file, or it has no such face.
        GeometryError: a face cannot be brought as near.
    """
    shape, faces = _faces(name, data)
    missing = [number for number in numbers if not 1 <= number <= len(faces)]
    if missing:
        raise InputError(f"{name} has {len(faces)} faces, so none with number {missing[0]}; use 1 to {len(faces)}.")
    chosen = [faces[number - 1] for number in numbers] or faces
    requested = tolerance
    for _ in range(_TIMES):
        found, off = _meshed(shape, chosen, requested)
        if off <= tolerance:
            return found
        requested *= _FINER
    raise GeometryError(
        f"{name}: a face stays {off:.4g} mm from its triangles, more than {tolerance:g} mm; make tolerance larger."
    )


def _faces(name: str, data: bytes) -> tuple[Any, list[Any]]:
    """Return everything in a file, and its faces in their order."""
    try:
        from OCP.IFSelect import IFSelect_ReturnStatus
        from OCP.STEPControl import STEPControl_Reader
        from OCP.TopAbs import TopAbs_ShapeEnum
        from OCP.TopExp import TopExp_Explorer
        from OCP.TopoDS import TopoDS
    except ImportError as error:
        raise InputError(f"{name}: {EXTRA.format(sys.executable)}") from error
    with tempfile.TemporaryDirectory(prefix=waiting_prefix("step"), suffix=".part") as folder:
        path = Path(folder) / "scene.step"
        path.write_bytes(data)
        reader = STEPControl_Reader()
        if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone or not reader.TransferRoots():
            raise InputError(f"{name}: this STEP file cannot be read; export it again, as AP203, AP214 or AP242.")
    shape = reader.OneShape()
    faces, explorer = [], TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE)
    while explorer.More():
        faces.append(TopoDS.Face(explorer.Current()))
        explorer.Next()
    if not faces:
        raise InputError(f"{name}: there is no face in this STEP file; export surfaces or solids.")
    return shape, faces


def _meshed(shape: Any, faces: list[Any], tolerance: float) -> tuple[Floats, float]:
    """Return triangles of faces, and how far they were found to be off, mm."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools

    BRepTools.Clean_s(shape)
    BRepMesh_IncrementalMesh(shape, tolerance, False, _ANGLE, True)
    found, worst, count = [], 0.0, 0
    for triangles, off in map(_of_face, faces):
        found.append(triangles)
        worst, count = max(worst, off), count + len(triangles)
        if count > _MOST:
            raise GeometryError(f"More than {_MOST} triangles are needed for {tolerance:g} mm; make tolerance larger.")
    return np.concatenate(found), worst


def _of_face(face: Any) -> tuple[Floats, float]:
    """Return a face's triangles (n, 3, 3), and how far it was found to be from them, mm."""
    from OCP.BRep import BRep_Tool
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.TopLoc import TopLoc_Location

    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, place)
    if mesh is None or not mesh.NbTriangles():
        return np.zeros((0, 3, 3)), 0.0
    move, nodes = place.Transformation(), range(1, mesh.NbNodes() + 1)
    corners = np.array([_xyz(mesh.Node(k).Transformed(move)) for k in nodes])
    rows = np.array([mesh.Triangle(k).Get() for k in range(1, mesh.NbTriangles() + 1)]) - 1
    triangles = corners[rows]
    if not mesh.HasUVNodes():
        return triangles, 0.0
    uv = np.array([(node.X(), node.Y()) for node in map(mesh.UVNode, nodes)])[rows]
    surface = BRepAdaptor_Surface(face)
    off = max(float(_off(list(_places(surface, np.array(shares) @ uv)), triangles).max()) for shares in _SAMPLES)
    return triangles, off


def _places(surface: Any, parameters: Floats) -> Iterator[tuple[float, float, float]]:
    for u, v in parameters.tolist():
        yield _xyz(surface.Value(u, v))


def _off(places: list[tuple[float, float, float]], triangles: Floats) -> Floats:
    """Return how far places (n,) are from their triangles' planes; of slivers, which have none, from a corner's reach:
    0.
    """
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    off: Floats = np.abs(np.einsum("nc,nc->n", np.array(places) - a, normal)) / np.where(size > 1e-9, size, np.inf)
    return off


def _xyz(point: Any) -> tuple[float, float, float]:
    return point.X(), point.Y(), point.Z()
