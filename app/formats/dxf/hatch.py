"""Boundaries of hatches: to curves, and without those that lie on what is drawn anyway."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core import tolerances
from ...geometry.affine import Affine, ellipse, transformed
from ...geometry.chaining.pieces import pieces_from, rows_of
from ...geometry.primitives import points_at
from ...geometry.sample import bounds, union
from ...model.curves import Curve, Line
from ...model.part import Entity
from ..drawing_account import has_place
from .curves import NoLengthError, arc_of, placed_in, segments_of
from .splines import spline_of_edge

_OF_TEXT = 8
"""Flag of a boundary that is the box round a text, which is read itself."""
_SHARES = tuple((k + 0.37) / 16 for k in range(16))
"""Where each line and arc of a boundary is looked at."""
_POLYLINE, _EDGES = 1, 2
"""Sorts of boundary paths, as the DXF library numbers them."""
_LINE, _ARC, _ELLIPSE = 1, 2, 3
"""Sorts of edges, as the DXF library numbers them."""


@dataclass(frozen=True, slots=True)
class Hatch:
    """The boundaries of a hatch, or of another filled area, each a ring of curves, drawing units; `kind`: its type."""

    boundaries: tuple[tuple[Curve, ...], ...]
    layer: str = "0"
    kind: str = "HATCH"

    @property
    def size(self) -> int:
        """How many curves there are."""
        return sum(map(len, self.boundaries))

    def drawn(self) -> Iterator[Curve]:
        """Yield its curves."""
        return (curve for ring in self.boundaries for curve in ring)

    def moved(self, to: Affine, layer: str = "") -> Hatch:
        """Return it under a map; what is on layer 0 goes to `layer`, where one is named."""
        rings = (
            tuple(curve for each in ring if (curve := transformed(each, to)) is not None) for ring in self.boundaries
        )
        return replace(self, boundaries=tuple(rings), layer=layer if layer and self.layer == "0" else self.layer)


def hatch_of(entity: Any) -> Hatch:
    """Return the boundaries of a HATCH, seen from above.

    Raises:
        NoLengthError: it has none.
        InputError: a spline of it has too many points.
    """
    layer, rings = entity.dxf.layer, []
    for path in entity.paths:
        if not path.path_type_flags & _OF_TEXT:
            found = _ring(path) if path.type == _POLYLINE else _closed_best(path, layer)
            rings.append(tuple(placed_in(entity, entity.dxf.elevation.z, found)))
    if not any(rings):
        raise NoLengthError(None)
    return Hatch(tuple(ring for ring in rings if ring), layer)


def solid_of(entity: Any) -> Hatch:
    """Return the outline of a SOLID or a TRACE, a filled area whose last two corners stand in each other's place.

    Raises:
        NoLengthError: all its corners are one.
    """
    places = [entity.dxf.get(f"vtx{k}", entity.dxf.vtx2) for k in (0, 1, 3, 2)]
    outline = segments_of([((float(place.x), float(place.y)), 0.0) for place in places], closed=True)
    ring = placed_in(entity, float(entity.dxf.vtx0.z), outline)
    return Hatch((tuple(ring),), entity.dxf.layer, entity.dxftype())


def _ring(path: Any) -> list[Curve]:
    try:
        return segments_of([((float(x), float(y)), float(bulge)) for x, y, bulge in path.vertices], closed=True)
    except NoLengthError:
        return []


def _closed_best(path: Any, layer: str) -> list[Curve]:
    """Return the edges of a boundary.

    Some programs tell where a piece of an ellipse begins and ends by angles seen from its centre, others by its
    parameters: what the edges beside it meet is meant.
    """
    by_angles = [curve for edge in path.edges for curve in _edge(edge, layer)]
    if len(by_angles) < 2 or not any(edge.type == _ELLIPSE for edge in path.edges):
        return by_angles
    by_parameters = [curve for edge in path.edges for curve in _edge(edge, layer, _told_parameters)]
    return min(by_angles, by_parameters, key=_gaps)


def _gaps(ring: list[Curve]) -> float:
    """Return how far the ends of curves are from those of their neighbours, together; curves may run either way.

    It is rounded, so that the first of equals is taken.
    """
    before, after = ring[-1:] + ring[:-1], ring[1:] + ring[:1]
    return round(sum(map(_to_neighbours, ring, before, after)), 6)


def _to_neighbours(curve: Curve, before: Curve, after: Curve) -> float:
    ends = [end for each in (before, after) for end in (each.start, each.end)]
    return sum(min(math.dist(own, end) for end in ends) for own in (curve.start, curve.end))


def _seen_parameters(edge: Any) -> tuple[float, float]:
    """Return the parameters of an edge of an ellipse whose angles are seen from its centre, radians."""
    return edge.start_param, edge.end_param


def _told_parameters(edge: Any) -> tuple[float, float]:
    """Return the parameters of an edge of an ellipse that are told as such, radians."""
    return math.radians(edge.start_angle), math.radians(edge.end_angle)


def _edge(
    edge: Any, layer: str, parameters: Callable[[Any], tuple[float, float]] = _seen_parameters
) -> Iterator[Curve]:
    """Yield the curve of an edge, if it has any length. Clockwise ones are counter-clockwise here: a ring has no
    direction.
    """
    made: Curve | None
    if edge.type == _LINE:
        start, end = (float(edge.start.x), float(edge.start.y)), (float(edge.end.x), float(edge.end.y))
        made = Line(start, end) if start != end else None
    elif edge.type == _ARC:
        radius = float(edge.radius)
        made = (
            arc_of((float(edge.center.x), float(edge.center.y)), radius, edge.start_angle, edge.end_angle)
            if radius > 0
            else None
        )
    elif edge.type == _ELLIPSE:
        x, y = float(edge.major_axis.x), float(edge.major_axis.y)
        first, last = parameters(edge)
        sweep = (last - first) % (2 * np.pi)
        whole = sweep < 1e-9 or sweep > 2 * np.pi - 1e-9
        axes = (float(edge.center.x), float(edge.center.y)), (x, y), (-y * edge.ratio, x * edge.ratio)
        made = ellipse(axes, first, first + (2 * np.pi if whole else sweep))
    else:
        made = spline_of_edge(edge, layer)
    if made is not None:
        yield made


def bounding_alone(rings: Sequence[tuple[Curve, ...]], drawn: Sequence[Curve], size: float) -> list[bool]:
    """Return for each boundary whether it bounds something that nothing drawn bounds.

    One that lies on drawn curves all along, within the distance at which loose ends are joined, adds nothing: taken
    twice, the two would be one outline that is drawn twice, or, where it is made of stretches of several, lines that
    overlap.

    Args:
        rings: boundaries, drawing units. drawn: curves that are machined, drawing units. size: of the unit, mm.
    """
    from ...geometry.distance import DistanceField

    around = union([bounds(curve) for ring in rings for curve in ring if has_place(curve)])
    if around is None:
        return [True] * len(rings)
    spare = tolerances.JOIN / size
    x0, y0, x1, y1 = around[0] - spare, around[1] - spare, around[2] + spare, around[3] + spare
    boxed = ((curve, bounds(curve)) for curve in drawn if has_place(curve))
    near = [curve for curve, box in boxed if box[0] <= x1 and box[2] >= x0 and box[1] <= y1 and box[3] >= y0]
    to = Affine(size, 0.0, 0.0, size, -x0 * size, -y0 * size)
    rows = _rows(near, to)
    if not len(rows):
        return [True] * len(rings)
    field, found = DistanceField.of(rows), []
    for ring in rings:
        mine = _rows(ring, to)
        points = [points_at(mine, np.full(len(mine), share)) for share in _SHARES] if len(mine) else []
        found.append(not points or bool((field.nearest(np.concatenate(points))[0] > tolerances.JOIN).any()))
    return found


def _rows(curves: Sequence[Curve], to: Affine) -> Any:
    """Return curves as rows of lines and arcs, mm."""
    placed = (transformed(curve, to) for curve in curves)
    pieces, _ = pieces_from([Entity(number, curve) for number, curve in enumerate(placed, 1) if curve is not None])
    return rows_of(pieces)[0]
