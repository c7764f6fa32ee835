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
from .primitives import Rows, boxes, contour_rows, lengths, points_at, sample, signed_area

_CHORD = 0.01
"""mm; an inner point of each contour is found with it, and then proven exactly. Thin contours are sampled more finely."""

_ASIDE = (1.0, 0.5, 0.2, 0.05)
"""Half widths beside a curve at which an inner point is looked for where chords give none."""


@dataclass(frozen=True)
class Nesting:
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


def nested(contours: Sequence[Contour]) -> Nesting:
    """Return the regions that closed contours bound by the even-odd rule.

    A contour inside an even number of others bounds an area, one inside an odd number is an island of the
    smallest contour round it; what lies in an island is an area again. Open contours bound nothing, nor do areas
    thinner than 1 um, which are left over where contours meet.

    Args:
        contours: closed ones may touch one another, but neither cross one another nor pass a point twice.
    """
    closed = [c for c in contours if c.closed]
    if not closed:
        return Nesting()
    rows = [contour_rows(c) for c in closed]
    areas = np.array([signed_area(r) for r in rows])
    holders = _holders(rows, np.abs(areas))
    turned = [c if (area > 0) == (len(h) % 2 == 0) else reversed_contour(c) for c, area, h in zip(closed, areas, holders, strict=True)]
    islands: dict[int, list[Contour]] = {}
    for contour, held in zip(turned, holders, strict=True):
        if len(held) % 2 == 1:
            islands.setdefault(min(held, key=lambda i: abs(areas[i])), []).append(contour)
    outer = [i for i, held in enumerate(holders) if len(held) % 2 == 0]
    thick = [i for i in outer if _thickness(rows[i]) > tolerances.LEVEL / 2]
    regions = tuple(Region(number, turned[i], tuple(islands.get(i, ()))) for number, i in enumerate(thick, 1))
    return Nesting(regions, tuple(turned[i] for i in sorted(set(outer).difference(thick))))


def _thickness(rows: Rows) -> float:
    """Return area / length, mm: half the width of something long and thin."""
    return abs(signed_area(rows)) / max(float(lengths(rows).sum()), tolerances.WELD)


def _holders(rows: list[Rows], areas: NDArray[np.float64]) -> list[list[int]]:
    """Return for each contour the larger ones that hold an inner point of it: exactly, arcs as arcs."""
    points = _inner_points(rows)
    found: list[list[int]] = [[] for _ in rows]
    for j, each in enumerate(rows):
        around = boxes(each)
        low, high = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
        near = np.flatnonzero((areas < areas[j]) & ((points >= low) & (points <= high)).all(axis=1))
        if len(near):
            for i in near[DistanceField.of(each).inside(points[near])].tolist():
                found[i].append(j)
    return found


def _inner_points(rows: list[Rows]) -> NDArray[np.float64]:
    """Return a point (n, 2) that each closed contour holds."""
    polygons = [shapely.make_valid(shapely.Polygon(p)) if len(p := _ring(r)) > 2 else shapely.Polygon() for r in rows]
    points = shapely.point_on_surface(np.array(polygons, dtype=object))
    there = ~shapely.is_empty(points)
    found = np.zeros((len(rows), 2))
    found[there] = shapely.get_coordinates(points[there])
    for k, each in enumerate(rows):
        if not (there[k] and DistanceField.of(each).inside(found[k : k + 1])[0]):
            found[k] = _beside(each)
    return found


def _ring(rows: Rows) -> NDArray[np.float64]:
    return sample(rows, min(_CHORD, max(_thickness(rows) / 8, tolerances.WELD)))


def _beside(rows: Rows) -> NDArray[np.float64]:
    """Return a point within a closed contour, close beside the middle of one of its curves; that middle itself where none is found."""
    middle = points_at(rows, np.full(len(rows), 0.5))
    ahead = points_at(rows, np.full(len(rows), 0.51)) - middle
    normal = np.stack([-ahead[:, 1], ahead[:, 0]], 1) / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None]
    field = DistanceField.of(rows)
    for share in _ASIDE:
        aside = _thickness(rows) * share * (1 if signed_area(rows) > 0 else -1)
        places = middle + normal * aside
        held = field.inside(places)
        if held.any():
            inner: NDArray[np.float64] = places[np.argmax(np.where(held, lengths(rows), -1.0))]
            return inner
    start: NDArray[np.float64] = middle[0]
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
