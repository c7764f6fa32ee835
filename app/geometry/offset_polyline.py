"""The last resort of the exact offset: a ring as a fine polyline that still measures right."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from app import tolerances
from app.geometry.distance import DistanceField
from app.geometry.primitives import Primitives, Rows, sample

_STEP = 0.05  # mm between points; the chord of a 0.3 mm arc then sags by 1 um
_CHORD = 1e-4


def polyline_loops(field: DistanceField, rows: Rows, primitives: Primitives, distance: float) -> list[tuple[NDArray[np.float64], int]]:
    """Return (points (m, 2), region number) of the rings at a distance, found by buffering polygons with shapely.

    Every point is then moved along the line from its nearest point on the drawing until it measures `distance`; a
    ring of which any point or middle still comes nearer than the tolerance is left out, and so shows as metal left.
    """
    loops = []
    for number in np.unique(primitives.region):
        area = _area(rows, primitives, int(number)).buffer(-distance, quad_segs=32)
        for polygon in getattr(area, "geoms", [area]):
            for line in (polygon.exterior, *polygon.interiors) if not polygon.is_empty else ():
                points = _on_level(field, shapely.get_coordinates(shapely.segmentize(line, _STEP))[:-1], distance)
                if len(points) > 2 and _measures_right(field, points, distance):
                    loops.append((points if shapely.LinearRing(points).is_ccw == (line is polygon.exterior) else points[::-1], int(number)))
    return loops


def _area(rows: Rows, primitives: Primitives, number: int) -> shapely.Geometry:
    """Return one region as a polygon, by even-odd overlay of its contours."""
    area: shapely.Geometry = shapely.Polygon()
    used = primitives.forward & (primitives.region == number)
    starts = np.flatnonzero(used & (primitives.previous > np.arange(len(rows))) | used & (primitives.previous == np.arange(len(rows))))
    for first in starts:
        last = int(primitives.previous[first])
        area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(sample(rows[first:last + 1], _CHORD))))
    return area


def _on_level(field: DistanceField, points: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Move points (m, 2) to the given distance from the drawing by Newton steps along the field's slope."""
    for _ in range(3):
        found, _ = field.nearest(points)
        small = 1e-6
        slope = np.stack([field.nearest(points + [small, 0])[0] - found, field.nearest(points + [0, small])[0] - found], 1) / small
        size = np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 0.5)
        points = points + slope / size[:, None] ** 2 * (distance - found)[:, None]
    return points


def _measures_right(field: DistanceField, points: NDArray[np.float64], distance: float) -> bool:
    both = np.concatenate([points, (points + np.roll(points, -1, axis=0)) / 2])
    return bool(np.all(field.nearest(both)[0] >= distance - tolerances.LEVEL))
