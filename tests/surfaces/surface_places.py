"""Places of B-spline surfaces, evaluated by scipy rather than by the program."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from app.core.errors import InputError
from app.model.motion import Nurbs
from app.model.part import Part
from app.model.scene import Surface
from app.model.scene_curves import Point3, SceneFiles, SectionCurve
from app.model.scene_shapes import Shape
from app.surfaces.patches.build import BuiltSurface, build_surface
from app.surfaces.patches.patch import BsplineSurface

Floats = NDArray[np.float64]


def places(surface: BsplineSurface, u: Floats, v: Floats) -> Floats:
    """Return places (m, 3) at parameters (m,) of a surface whose knots go from 0 to 1."""
    rows = np.concatenate([surface.points * surface.weights[..., None], surface.weights[..., None]], axis=2)
    along = BSpline(surface.knots_u, rows, surface.degree_u)(u)
    made = np.array([BSpline(surface.knots_v, row, surface.degree_v)(at) for row, at in zip(along, v, strict=True)])
    return made[:, :3] / made[:, 3:]


def anywhere(surface: BsplineSurface, count: int = 300) -> Floats:
    """Return places at random parameters, and at the corners."""
    u, v = np.random.default_rng(1986).random((2, count))
    return places(surface, np.concatenate([u, [0, 0, 1, 1]]), np.concatenate([v, [0, 1, 0, 1]]))


def curve_places(curve: Nurbs, at: Floats) -> Floats:
    made = BSpline(curve.knots, np.column_stack([curve.points * curve.weights[:, None], curve.weights]), curve.degree)(
        at
    )
    return made[:, :3] / made[:, 3:]


def no_data(name: str) -> bytes:
    raise InputError(f"{name}: there is no such file.")


def no_part(name: str) -> Part:
    raise InputError(f"{name}: there is no such file.")


NO_FILES = SceneFiles(no_data, no_part)


def built(
    shape: Shape, turn: Point3 = (0.0, 0.0, 0.0), move: Point3 = (0.0, 0.0, 0.0), sources: SceneFiles = NO_FILES
) -> BuiltSurface:
    return build_surface(Surface("one", shape, rotate_deg=turn, move=move), sources)


def spline_of(shape: Shape) -> BsplineSurface:
    (made,) = built(shape).splines
    return made


def curve(*points: tuple[float, ...], **rest: object) -> SectionCurve:
    return SectionCurve(tuple(points), **rest)  # type: ignore[arg-type]
