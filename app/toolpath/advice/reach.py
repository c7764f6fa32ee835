"""What a cutter of some diameter reaches of each region: the opening by its disc, and what that leaves.

Where the cutter's centre can be is an exact level of the drawing; what it covers from there and what is left are
polygons whose chords stay within 1 um of the arcs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.offset.offset import OffsetLevel, Ring, offset_levels
from ...geometry.primitives import Primitives, sample
from ..coverage.areas import grown

FITS = 2e-3
"""mm by which a gap may be narrower than a cutter that still counts as fitting."""

_CHORD = 1e-3
"""mm by which chords may leave arcs."""

_BESIDE = 3e-3
"""mm from the edge of what is covered at which what is left begins: more than the chords' errors."""

_SHARE = 0.01
"""Of its radius by which the largest disc in what is left may be too small."""

_DISC = 0.01
"""mm; what is left in which no disc of this diameter fits is the chords' own error."""


@dataclass(frozen=True)
class RegionReach:
    """What one cutter reaches of one region.

    Attributes:
        diameter: of the cutter, mm.
        share: of the region's area that it covers without touching a wall, in [0, 1].
        parts: into how many the region falls, because the cutter does not pass between them; 0 = it fits nowhere.
        left_mm2: area that it leaves.
        left_disc: diameter of the largest disc in what it leaves, mm, within 1 % or 0.01 mm; 0 = nothing is left.
        x, y: centre of that disc, mm.
    """

    diameter: float
    share: float
    parts: int
    left_mm2: float
    left_disc: float
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class CentreArea:
    """Where a cutter's centre can be.

    Attributes:
        distance: from the walls, mm.
        shapes: polygons by the number of their region.
        area: mm2, exact.
        length: of all rings, mm, exact.
        rings: how many there are.
    """

    distance: float
    shapes: dict[int, Shape]
    area: float
    length: float
    rings: int


def centres(
    primitives: Primitives, distances: Sequence[float], progress: Progress = NO_PROGRESS
) -> dict[float, CentreArea]:
    """Return where centres can be that keep some distances, mm, > 0, from the walls.

    Raises:
        Cancelled: by progress.
    """
    requested = sorted(set(distances))
    levels = offset_levels(primitives, requested, progress)
    return {distance: _centres(level) for distance, level in zip(requested, levels, strict=True)}


def _centres(level: OffsetLevel) -> CentreArea:
    rings: dict[int, list[Ring]] = {}
    for ring in level.rings:
        rings.setdefault(ring.region, []).append(ring)
    shapes = {region: _shape(own) for region, own in rings.items()}
    return CentreArea(
        level.distance, shapes, sum(r.area for r in level.rings), sum(r.length for r in level.rings), len(level.rings)
    )


def _shape(rings: Sequence[Ring]) -> Shape:
    """Return the polygons that rings bound, those that turn left, with those that turn right as their holes."""
    outer = [points for ring in rings if ring.area > 0 and len(points := sample(ring.rows, _CHORD)) > 2]
    holes = [points for ring in rings if ring.area <= 0 and len(points := sample(ring.rows, _CHORD)) > 2]
    if len(outer) == 1:
        return shapely.make_valid(shapely.Polygon(outer[0], holes))
    polygons = shapely.polygons([shapely.linearrings(points) for points in outer])
    inner: list[list[NDArray[np.float64]]] = [[] for _ in outer]
    if holes and outer:
        found = shapely.STRtree(polygons).query(shapely.points([points[0] for points in holes]), predicate="within")
        for hole, polygon in found.T:
            inner[polygon].append(holes[hole])
    return shapely.make_valid(
        shapely.MultiPolygon([shapely.Polygon(points, own) for points, own in zip(outer, inner, strict=True)])
    )


def covered(centres: Shape, radius: float) -> Shape:
    """Return what a disc of a radius, mm, covers from some areas of its centre."""
    return grown(centres, radius, _CHORD)


def reach(region: Shape, diameter: float, centres: Shape) -> RegionReach:
    """Return what a cutter reaches of a region.

    Args:
        region: its polygons.
        diameter: of the cutter, mm.
        centres: where its centre can be: polygons, one at least.
    """
    area, cleared, parts = (
        float(region.area),
        covered(centres, diameter / 2 - FITS),
        int(shapely.get_num_geometries(centres)),
    )
    # walls that nearly coincide take the library very long
    beyond = grown(centres, diameter / 2 - FITS + _BESIDE, _CHORD)
    x, y, disc = largest_left(shapely.difference(region, beyond))
    if disc < _DISC:
        return RegionReach(diameter, 1.0, parts, 0.0, 0.0, math.nan, math.nan)
    done = min(float(cleared.area), area)
    return RegionReach(diameter, done / area, parts, area - done, disc, x, y)


def largest_left(left: Shape) -> tuple[float, float, float]:
    """Return (x, y, diameter), mm, of the largest disc in some polygons; (nan, nan, 0) when there is none."""
    pieces = shapely.get_parts(left)
    pieces = pieces[(shapely.get_type_id(pieces) == shapely.GeometryType.POLYGON) & (shapely.area(pieces) > 0)]
    most = 2 * np.sqrt(shapely.area(pieces) / math.pi)
    best = (math.nan, math.nan, 0.0)
    for k in np.argsort(-most):
        if most[k] <= max(best[2], _DISC / 2):
            break
        tolerance = max(_CHORD, _SHARE * pieces[k].area / pieces[k].length)  # area / length is less than the radius
        radius = shapely.maximum_inscribed_circle(pieces[k], tolerance=tolerance)
        if 2 * radius.length > best[2]:
            (x, y), _ = shapely.get_coordinates(radius)
            best = (float(x), float(y), 2 * float(radius.length))
    return best
