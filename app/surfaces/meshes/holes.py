"""Holes in a mesh as a tool sees them that comes from above: rings of open edges round which the surface goes on
outside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from .edges import MeshEdges, doubled_areas

Floats = NDArray[np.float64]

_UPRIGHT = 1e-6
"""Sine of the angle to the vertical up to which a triangle stands upright on its open edge."""

_LEAST_OUTSIDE = 0.1
"""Share of a ring that has to have its triangles outside, so that a flaw in the rim of a cup makes no hole of it."""

_FLAT = 1e-12
"""mm; edges that are no longer than that, seen from above, stand upright."""


@dataclass(frozen=True, slots=True)
class MeshHole:
    """A hole.

    Attributes:
        x, y: the middle of the largest disc in it, mm. z: of its lowest open edge, mm.
        radius: of that disc, mm. wide, long: extent along X and Y, mm.
        edges: how many are open round it.
    """

    x: float
    y: float
    z: float
    radius: float
    wide: float
    long: float
    edges: int


def holes(triangles: Floats) -> tuple[MeshHole, ...]:
    """Return the holes in the surface of triangles (n, 3, 3), the largest first.

    A ring of open edges is a hole where more of its length has its triangles outside of the ring than inside. Those
    upright above it are outside, as where a pocket's floor is missing; those upright below it are on neither side, as
    at the rim of a cup, and where a hole comes to the edge of a block. The rim of a sheet has them inside.
    """
    some = doubled_areas(triangles) > 0
    corners = triangles if some.all() else triangles[some]
    uses = MeshEdges.of(corners).open_uses() if len(corners) else np.zeros(0, np.int64)
    if not len(uses):
        return ()
    face, k = np.divmod(uses, 3)
    a, b, c = corners[face, k], corners[face, (k + 1) % 3], corners[face, (k + 2) % 3]
    some = np.hypot(*(b - a)[:, :2].T) > _FLAT
    a, b, c = a[some], b[some], c[some]
    side = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    flat = np.abs(side) <= _UPRIGHT * np.hypot(*(b - a)[:, :2].T) * np.linalg.norm(c - a, axis=1)
    above = flat & (c[:, 2] > np.maximum(a[:, 2], b[:, 2]))
    turns = np.where(flat, 0.0, np.sign(side))
    sides: dict[tuple[float, ...], float] = {}
    low: dict[tuple[float, ...], float] = {}
    columns = (a[:, :2], b[:, :2], np.minimum(a[:, 2], b[:, 2]), turns, above)
    for p, q, z, turn, up in zip(*(column.tolist() for column in columns), strict=True):
        for key, to_left in (((*p, *q), turn), ((*q, *p), -turn)):
            sides[key], low[key] = -1.0 if up else to_left, min(z, low.get(key, np.inf))
    rings = shapely.get_parts(
        shapely.polygonize([shapely.LineString(line) for line in np.stack([a[:, :2], b[:, :2]], axis=1)])
    )
    found = [hole for ring in rings if (hole := _hole(ring, sides, low)) is not None]
    return tuple(sorted(found, key=lambda hole: -hole.radius))


def _hole(
    ring: shapely.Polygon, sides: dict[tuple[float, ...], float], low: dict[tuple[float, ...], float]
) -> MeshHole | None:
    """Return what a ring of open edges is, None where it is the rim of a surface.

    Args:
        sides: by the ends of an edge, whether its triangle is to the left, 1, to the right or above, -1, or neither, 0.
            low: its lower end.
    """
    places = shapely.get_coordinates(shapely.orient_polygons(ring).exterior)
    keys = [(*p, *q) for p, q in zip(places[:-1].tolist(), places[1:].tolist(), strict=True)]
    long = np.hypot(*np.diff(places, axis=0).T)
    side = np.array([sides.get(key, 0.0) for key in keys])
    outside, inside = float(long[side < 0].sum()), float(long[side > 0].sum())
    if not (outside > inside and outside > _LEAST_OUTSIDE * float(long.sum())):
        return None
    disc = shapely.maximum_inscribed_circle(ring, tolerance=max(1e-6, 1e-3 * float(long.max())))
    x, y = shapely.get_coordinates(disc)[0].tolist()
    x0, y0, x1, y1 = ring.bounds
    return MeshHole(x, y, min(low.get(key, np.inf) for key in keys), float(disc.length), x1 - x0, y1 - y0, len(keys))
