"""Closed contours to regions by even-odd nesting."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core import tolerances
from ..model.curves import Line, Primitive, reversed_curve
from ..model.part import Contour, Region
from .distance import DistanceField
from .outlines import Outlines, polygons
from .primitives import lengths, points_at
from .tree_queries import near

Floats = NDArray[np.float64]

_CHORD = 0.01
"""mm; an inner point of each contour is found with it, and then proven exactly. Thin contours are sampled more
finely.
"""

_ASIDE = (1.0, 0.5, 0.2, 0.05)
"""Half widths beside a curve at which an inner point is looked for where chords give none."""


@dataclass(frozen=True)
class NestingResult:
    """What closed contours bound.

    Attributes:
        regions: in the order of the drawing, boundaries counter-clockwise, islands clockwise.
        thin: boundaries of areas that are thinner than 1 um and no regions.
    """

    regions: tuple[Region, ...] = ()
    thin: tuple[Contour, ...] = ()


def nest(contours: Sequence[Contour]) -> tuple[Region, ...]:
    """Return the regions that closed contours bound by the even-odd rule; see `nested`."""
    return nested(contours).regions


def nested(contours: Sequence[Contour]) -> NestingResult:
    """Return the regions that closed contours bound by the even-odd rule.

    A contour inside an even number of others bounds an area, one inside an odd number is an island of the
    smallest contour round it; what lies in an island is an area again. Open contours bound nothing, nor do areas
    thinner than 1 um, which are left over where contours meet.

    Args:
        contours: closed ones may touch one another, but neither cross one another nor pass a point twice.
    """
    closed = [c for c in contours if c.closed]
    if not closed:
        return NestingResult()
    outlines = Outlines.of(closed)
    areas = outlines.areas
    holders = _holders(outlines)
    turned = [
        c if (area > 0) == (len(h) % 2 == 0) else reversed_contour(c)
        for c, area, h in zip(closed, areas.tolist(), holders, strict=True)
    ]
    islands: dict[int, list[Contour]] = {}
    for contour, held in zip(turned, holders, strict=True):
        if len(held) % 2 == 1:
            islands.setdefault(min(held, key=lambda i: abs(areas[i])), []).append(contour)
    outer = [i for i, held in enumerate(holders) if len(held) % 2 == 0]
    thick = _thicknesses(outlines) > tolerances.LEVEL / 2
    regions = tuple(
        Region(number, turned[i], tuple(islands.get(i, ())))
        for number, i in enumerate((i for i in outer if thick[i]), 1)
    )
    return NestingResult(regions, tuple(turned[i] for i in outer if not thick[i]))


def holders(contours: Sequence[Contour]) -> list[list[int]]:
    """Return for each closed contour which larger ones hold an inner point of it, by their indices.

    Of contours that cross, the smaller one may lie in the larger one or not, as that point of it does.
    """
    return _holders(Outlines.of(contours)) if contours else []


def _thicknesses(outlines: Outlines) -> Floats:
    """Return area / length (m,), mm: half the width of something long and thin."""
    thickness: Floats = np.abs(outlines.areas) / np.maximum(outlines.lengths, tolerances.WELD)
    return thickness


def _holders(outlines: Outlines) -> list[list[int]]:
    """Return for each contour the larger ones that hold an inner point of it: exactly, arcs as arcs."""
    points, areas = _inner_points(outlines), np.abs(outlines.areas)
    holder, held = near(shapely.STRtree(shapely.points(points)), shapely.box(*outlines.boxes.T))
    larger = areas[held] < areas[holder]
    holder, held = holder[larger], held[larger]
    order = np.lexsort((held, holder))
    found: list[list[int]] = [[] for _ in areas]
    for some in np.split(order, np.flatnonzero(np.diff(holder[order])) + 1) if len(order) else ():
        j = int(holder[some[0]])
        inside = DistanceField.of(outlines.rows[outlines.first[j] : outlines.first[j + 1]]).inside(points[held[some]])
        for i in held[some[inside]].tolist():
            found[i].append(j)
    return found


def _inner_points(outlines: Outlines) -> Floats:
    """Return a point (m, 2) that each closed contour holds."""
    chord = np.minimum(_CHORD, np.maximum(_thicknesses(outlines) / 8, tolerances.WELD))
    number, shapes = polygons(outlines, np.arange(len(outlines)), chord)
    found = np.full((len(outlines), 2), np.inf)
    found[number] = shapely.get_coordinates(shapely.point_on_surface(shapes))
    for k in np.flatnonzero(~outlines.enclose(found)).tolist():
        found[k] = _beside(Outlines.joined([outlines.rows[outlines.first[k] : outlines.first[k + 1]]]))
    return found


def _beside(outline: Outlines) -> Floats:
    """Return a point within a closed contour, close beside the middle of one of its curves; that middle itself where
    none is found.
    """
    rows, thickness = outline.rows, float(_thicknesses(outline)[0])
    middle = points_at(rows, np.full(len(rows), 0.5))
    ahead = points_at(rows, np.full(len(rows), 0.51)) - middle
    normal = np.stack([-ahead[:, 1], ahead[:, 0]], 1) / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None]
    field = DistanceField.of(rows)
    for share in _ASIDE:
        aside = thickness * share * (1 if outline.areas[0] > 0 else -1)
        places = middle + normal * aside
        held = field.inside(places)
        if held.any():
            inner: Floats = places[np.argmax(np.where(held, lengths(rows), -1.0))]
            return inner
    start: Floats = middle[0]
    return start


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
