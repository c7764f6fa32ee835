"""The last resort of the exact offset: a ring as a fine polyline that still measures right."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core import tolerances
from ..distance import DistanceField
from ..primitives import Primitives, Rows, sample

_STEP = 0.05  # mm between points; the chord of a 0.3 mm arc then sags by 1 um
_CHORD = 1e-4
_SMALL = 1e-6  # mm; step of the numeric slope


def polyline_loops(
    field: DistanceField, rows: Rows, primitives: Primitives, distance: float
) -> list[tuple[NDArray[np.float64], int]]:
    """Return (points (m, 2), region number) of the rings at a distance, found by buffering polygons with shapely.

    Every point is then moved along the line from its nearest point on the drawing until it measures `distance`; a
    ring of which any point or middle still comes nearer than the tolerance is left out, and so shows as metal left.
    """
    loops = []
    for number in np.unique(primitives.region):
        area = _beyond(rows, primitives, int(number), distance)
        for polygon in getattr(area, "geoms", [area]):
            for hole, line in enumerate((polygon.exterior, *polygon.interiors) if not polygon.is_empty else ()):
                points = _on_level(field, shapely.get_coordinates(shapely.segmentize(line, _STEP))[:-1], distance)
                if len(points) > 2 and _measures_right(field, points, distance):
                    ahead = shapely.LinearRing(points).is_ccw == (hole == 0)
                    loops.append((points if ahead else points[::-1], int(number)))
    return loops


def _beyond(rows: Rows, primitives: Primitives, number: int, distance: float) -> shapely.Geometry:
    """Return what of one region is farther than a distance from its outlines, some of which may go there and back."""
    area: shapely.Geometry = shapely.Polygon()
    ways = []
    starts = np.flatnonzero((primitives.region == number) & (primitives.previous >= np.arange(len(rows))))
    for first in starts:
        last = int(primitives.previous[first])
        points = sample(rows[first : last + 1], _CHORD)
        ways.append(shapely.LineString(np.concatenate([points, points[:1]])))
        if len(points) > 2:  # else a line there and back, which has no area
            area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(points)))
    return shapely.difference(area, shapely.union_all(shapely.buffer(ways, distance, quad_segs=32)))


def _on_level(field: DistanceField, points: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Move points (m, 2) to the given distance from the drawing by Newton steps along the field's slope."""
    for _ in range(3):
        found, _ = field.nearest(points)
        right, up = (field.nearest(points + step)[0] for step in np.eye(2) * _SMALL)
        slope = np.stack([right - found, up - found], 1) / _SMALL
        size = np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 0.5)
        points = points + slope / size[:, None] ** 2 * (distance - found)[:, None]
    return points


def _measures_right(field: DistanceField, points: NDArray[np.float64], distance: float) -> bool:
    both = np.concatenate([points, (points + np.roll(points, -1, axis=0)) / 2])
    return bool(np.all(field.nearest(both)[0] >= distance - tolerances.LEVEL))
