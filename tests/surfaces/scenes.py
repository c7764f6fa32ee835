"""Scenes for tests, from shapes to facets."""

import math

import numpy as np

from app.formats.scene.toml import sources_of
from app.model.scene import Scene, Surface
from app.model.scene_shapes import CylinderShape, PlaneShape, Shape, SphereShape
from app.surfaces.cutter_contact.scene_facets import scene_facets
from app.surfaces.patches.build import build
from app.surfaces.patches.facets import SurfaceFacets
from app.surfaces.sections.compound import CuttingPlanes
from tests.surfaces.surface_places import no_data


def facets_of(*shapes: Shape | Surface, tolerance: float | None = None) -> SurfaceFacets:
    """Return surfaces as facets; shapes are named by their number."""
    surfaces = tuple(each if isinstance(each, Surface) else Surface(f"s{n}", each) for n, each in enumerate(shapes))
    return scene_facets(build(Scene(surfaces=surfaces), sources_of(no_data)), tolerance).facets


def plane(x0: float, y0: float, x1: float, y1: float, z: float = 0.0, rise: float = 0.0) -> PlaneShape:
    """Return an upright seen rectangle; `rise`: how much higher it is at x1."""
    return PlaneShape((x0, y0, z), (x1 - x0, 0.0, rise), (0.0, y1 - y0, 0.0))


def ball(x: float, y: float, z: float, radius: float) -> SphereShape:
    return SphereShape((x, y, z), radius)


def half_cylinder(start: tuple[float, float, float], end: tuple[float, float, float], radius: float) -> CylinderShape:
    """Return the upper half of a lying cylinder."""
    return CylinderShape(start, end, radius, (-90.0, 90.0))


def along_x(*offsets: float) -> CuttingPlanes:
    return CuttingPlanes((0.0, 0.0), 0.0, offsets)


def turned(places: np.ndarray, degrees: float) -> np.ndarray:
    """Return places turned about Z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = places[..., 0], places[..., 1]
    return np.stack([c * x - s * y, s * x + c * y, places[..., 2]], axis=-1)
