"""Surfaces of a scene, made: exact B-spline surfaces or triangles, placed, with the regions that trim them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError, HitofudeError, InputError
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.outlines import nest, polygon_contour
from ...model.curves import Circle
from ...model.part import Contour, Region
from ...model.scene import KeptSide, Scene, SceneOutline, Surface
from ...model.scene_curves import SceneFiles
from ...model.scene_shapes import (
    BicubicShape,
    BilinearShape,
    BsplineShape,
    ConeShape,
    CylinderShape,
    LoftShape,
    MeshShape,
    PlaneShape,
    ProfileOrientation,
    RevolvedShape,
    RuledShape,
    SphereShape,
    StepShape,
    SweptShape,
    TorusShape,
)
from ..meshes.read import read_mesh
from . import shapes
from .loft import lofted, ruled
from .patch import BsplineSurface
from .revolve import revolved
from .section_curve import ResolvedCurve, contours_of, resolve, resolve_all
from .step_faces import step_triangles
from .sweep import TOLERANCE, following_sweep, parallel_sweep

Floats = NDArray[np.float64]
_PART = 1 << 16
"""Triangles that are placed together."""

_ANALYTIC = {
    PlaneShape: shapes.plane,
    SphereShape: shapes.sphere,
    CylinderShape: shapes.cylinder,
    ConeShape: shapes.cone,
    TorusShape: shapes.torus,
    BilinearShape: shapes.bilinear,
    BicubicShape: shapes.bicubic,
    BsplineShape: shapes.bspline,
}


@dataclass(frozen=True, eq=False)
class BuiltTrim:
    """Regions in XY, and which side of them a surface keeps."""

    regions: tuple[Region, ...]
    keep: KeptSide


@dataclass(frozen=True, eq=False)
class BuiltSurface:
    """A surface as engines take it: either B-spline surfaces, or triangles.

    Attributes:
        surface: of the scene. splines: that it is made of, placed.
        triangles: (n, 3, 3) mm, placed, of a mesh; else none.
        trims: all of them count.
        deviation: how far it may be off what was entered, mm: 0 is exact but for rounding.
    """

    surface: Surface
    splines: tuple[BsplineSurface, ...] = ()
    triangles: Floats | None = None
    trims: tuple[BuiltTrim, ...] = ()
    deviation: float = 0.0


def build(scene: Scene, sources: SceneFiles, progress: Progress = NO_PROGRESS) -> tuple[BuiltSurface, ...]:
    """Return every surface of a scene, in its order.

    Raises:
        InputError: a file cannot be read. GeometryError: a surface cannot be made; its name is said. Cancelled.
    """
    made = []
    for number, surface in enumerate(scene.surfaces):
        progress.step(number / len(scene.surfaces), f"Making {surface.name}")
        made.append(build_surface(surface, sources))
    return tuple(made)


def build_surface(surface: Surface, sources: SceneFiles) -> BuiltSurface:
    """Return one surface.

    Raises:
        InputError, GeometryError: as `build`.
    """
    try:
        built = _shaped(surface, sources)
        turn, move = rotation(surface.rotate_deg), np.array(surface.move)
        splines = tuple(replace(each, points=each.points @ turn.T + move) for each in built.splines)
        triangles = None if built.triangles is None else _placed(built.triangles, turn, move)
        trims = tuple(BuiltTrim(regions_of(trim, sources), trim.keep) for trim in surface.trims)
    except InputError:
        raise
    except HitofudeError as error:
        raise GeometryError(f"Surface {surface.name}: {error}") from error
    return replace(built, splines=splines, triangles=triangles, trims=trims)


def _placed(triangles: Floats, turn: Floats, move: Floats) -> Floats:
    """Return triangles (n, 3, 3), turned and moved, part by part."""
    placed = np.empty(triangles.shape)
    for first in range(0, len(triangles), _PART):
        placed[first : first + _PART] = triangles[first : first + _PART] @ turn.T + move
    return placed


def rotation(angles_deg: tuple[float, float, float]) -> Floats:
    """Return the matrix (3, 3) of turns about X, then Y, then Z, degrees; quarter turns are exact."""
    made = np.eye(3)
    for axis, angle in enumerate(angles_deg):
        c, s = _quarters(angle) if angle % 90 == 0 else (math.cos(math.radians(angle)), math.sin(math.radians(angle)))
        turn = np.eye(3)
        j, k = (axis + 1) % 3, (axis + 2) % 3
        turn[j, j], turn[j, k], turn[k, j], turn[k, k] = c, -s, s, c
        made = turn @ made
    return made


def _quarters(angle: float) -> tuple[float, float]:
    return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(angle / 90) % 4]


def _shaped(surface: Surface, sources: SceneFiles) -> BuiltSurface:
    """Return a surface before it is placed, without its trims."""
    shape = surface.shape
    if make := _ANALYTIC.get(type(shape)):
        return BuiltSurface(surface, (make(shape),))  # type: ignore[operator]
    if isinstance(shape, LoftShape):
        sections = resolve_all(shape.sections, sources)
        return _of(surface, (lofted([each.curve for each in sections], shape.degree, shape.closed),), *sections)
    if isinstance(shape, RuledShape):
        first, second = resolve_all((shape.first, shape.second), sources)
        return _of(surface, (ruled(first.curve, second.curve),), first, second)
    if isinstance(shape, RevolvedShape):
        profile = resolve(shape.profile, sources)
        turn = math.radians(shape.turn_deg[0]), math.radians(shape.turn_deg[1])
        return _of(surface, (revolved(profile.curve, np.array(shape.centre), np.array(shape.axis), turn),), profile)
    if isinstance(shape, SweptShape):
        profile, guide = resolve(shape.profile, sources), resolve(shape.guide, sources)
        if shape.keep is ProfileOrientation.PARALLEL:
            return _of(surface, (parallel_sweep(profile.curve, guide.curve),), profile, guide)
        built = _of(surface, following_sweep(profile.curve, guide.curve), profile, guide)
        return replace(built, deviation=built.deviation + TOLERANCE)
    if isinstance(shape, StepShape):
        triangles = step_triangles(shape.file, sources.data(shape.file), shape.faces, shape.tolerance)
        return BuiltSurface(surface, triangles=triangles, deviation=shape.tolerance)
    assert isinstance(shape, MeshShape)
    return BuiltSurface(surface, triangles=triangles_of(shape, sources))


def _of(surface: Surface, splines: tuple[BsplineSurface, ...], *sections: ResolvedCurve) -> BuiltSurface:
    return BuiltSurface(surface, splines, deviation=sum(each.deviation for each in sections))


def triangles_of(shape: MeshShape, sources: SceneFiles) -> Floats:
    """Return the triangles (n, 3, 3) of a mesh's file, mm.

    Raises:
        InputError: the file cannot be read, or there are none in it.
    """
    triangles = read_mesh(shape.file, sources.data(shape.file))
    triangles *= shape.scale
    return triangles


def regions_of(outline: SceneOutline, sources: SceneFiles) -> tuple[Region, ...]:
    """Return the regions of an outline; arcs and circles stay exact.

    Raises:
        InputError: its drawing cannot be read. GeometryError: it has no closed contour there.
    """
    regions = nest(_contours(outline, sources))
    if not regions:
        raise GeometryError("An outline holds no area; give it some.")
    return regions


def _contours(outline: SceneOutline, sources: SceneFiles) -> tuple[Contour, ...]:
    """Return the closed contours of an outline."""
    if outline.circle:
        x, y, radius = outline.circle
        return (Contour((Circle((x, y), radius),)),)
    if outline.rectangle:
        x0, y0, x1, y1 = outline.rectangle
        return (polygon_contour(((x0, y0), (x1, y0), (x1, y1), (x0, y1))),)
    if outline.outline:
        return (polygon_contour(outline.outline),)
    found = contours_of(sources.part(outline.drawing), outline.layer, outline.drawing)
    closed = tuple(contour for contour in found if contour.closed)
    if not closed:
        raise GeometryError(f"{outline.drawing} has no closed contour there; close one, or name another layer.")
    return closed
