"""Closed contours to regions by even-odd nesting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from app import tolerances
from app.geometry.primitives import Rows, contour_rows, lengths, sample, signed_area
from app.model.curves import Line, Primitive, reversed_curve
from app.model.part import Contour, Region

_CHORD = 0.01
"""mm; only who lies in whom depends on it. Thin contours are sampled as finely as they are thin."""


def nest(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return the regions that closed contours bound by the even-odd rule.

    A contour inside an even number of others bounds an area, one inside an odd number is an island of the
    smallest contour round it; what lies in an island is an area again. Open contours bound nothing, nor do areas
    thinner than 1 um, which are left over where contours meet.

    Args:
        contours: closed ones may touch, but should not cross one another.

    Returns:
        Regions in the order of the drawing, boundaries counter-clockwise, islands clockwise.
    """
    closed = [c for c in contours if c.closed]
    if not closed:
        return ()
    rows = [contour_rows(c) for c in closed]
    areas = np.array([signed_area(r) for r in rows])
    polygons = [shapely.make_valid(shapely.Polygon(p)) if len(p := _ring(r)) > 2 else shapely.Polygon() for r in rows]
    holders = _holders(polygons, np.abs(areas))
    turned = [c if (area > 0) == (len(h) % 2 == 0) else reversed_contour(c) for c, area, h in zip(closed, areas, holders, strict=True)]
    islands: dict[int, list[Contour]] = {}
    for contour, held in zip(turned, holders, strict=True):
        if len(held) % 2 == 1:
            islands.setdefault(min(held, key=lambda i: abs(areas[i])), []).append(contour)
    outer = [i for i, held in enumerate(holders) if len(held) % 2 == 0 and _thickness(rows[i]) > tolerances.LEVEL / 2]
    return tuple(Region(number, turned[i], tuple(islands.get(i, ()))) for number, i in enumerate(outer, 1))


def _ring(rows: Rows) -> NDArray[np.float64]:
    return sample(rows, min(_CHORD, max(_thickness(rows) / 8, tolerances.WELD)))


def _thickness(rows: Rows) -> float:
    """Return area / length, mm: half the width of something long and thin."""
    return abs(signed_area(rows)) / max(float(lengths(rows).sum()), tolerances.WELD)


def _holders(polygons: list[shapely.Geometry], areas: NDArray[np.float64]) -> list[list[int]]:
    """Return for each polygon the larger ones that hold an inner point of it."""
    inner = shapely.point_on_surface(np.array(polygons, dtype=object))
    found: list[list[int]] = [[] for _ in polygons]
    for i, j in shapely.STRtree(polygons).query(inner, predicate="within").T:
        if i != j and areas[j] > areas[i]:
            found[i].append(int(j))
    return found


def reversed_contour(contour: Contour) -> Contour:
    """Return the contour travelled the other way."""
    back: list[Primitive] = []
    for curve in reversed(contour.primitives):
        turned = reversed_curve(curve)
        assert not isinstance(turned, type(None))
        back.append(turned)  # type: ignore[arg-type]  # a primitive turned round is a primitive
    return replace(contour, primitives=tuple(back), entity_ids=contour.entity_ids[::-1])


def polygon_contour(points: Sequence[tuple[float, float]]) -> Contour:
    """Return the closed contour of straight lines through some points."""
    pairs = zip(points, (*points[1:], points[0]), strict=True)
    return Contour(tuple(Line((float(a[0]), float(a[1])), (float(b[0]), float(b[1]))) for a, b in pairs))
