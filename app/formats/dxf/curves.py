"""One DXF entity to the curves that it draws, seen from above."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise
from typing import Any

from ...geometry.affine import IDENTITY, Affine, ellipse, transformed
from ...geometry.sample import bounds
from ...model.curves import Arc, Circle, Curve, Line, Point, Spline
from ..drawing_account import LEVEL_ZERO, CurveHeights
from .splines import spline_curve

_STRAIGHT = 1e-9
"""A bulge below this bends a segment by less than its length's rounding."""
_EDGE_ON = 1e-9
"""Cosine between a plane's normal and Z below which nothing of the plane is seen from above."""
_UNBROKEN = ("", "continuous", "bylayer", "byblock")
_NEEDED = {
    "LINE": ("start", "end"),
    "CIRCLE": ("center", "radius"),
    "ARC": ("center", "radius", "start_angle", "end_angle"),
    "ELLIPSE": ("center", "major_axis", "ratio"),
    "TEXT": ("insert", "height"),
    "ATTRIB": ("insert", "height"),
    "MTEXT": ("insert",),
    "SOLID": ("vtx0", "vtx1", "vtx2"),
    "TRACE": ("vtx0", "vtx1", "vtx2"),
}
"""What each kind has to tell, its place first."""
_SOLID = ("LINE", "SPLINE", "HELIX")
"""Kinds whose curves have a height at each of their points, and are drawn in no plane."""
_SPLINE_FRAME = 16
"""Flag of a POLYLINE vertex that only steers the curve and is not on it."""


class NoLengthError(Exception):
    """An entity draws nothing: zero length or radius, or numbers that are none. The argument is its place or None."""


class DamagedCurveError(Exception):
    """What an entity says of its curve contradicts itself. Its place, or None, is the argument."""


class NegativeRadiusError(Exception):
    """A circle or an arc has a radius below 0, so nobody knows what is meant. Its place and the radius are the
    arguments.
    """


def curves_of(entity: Any) -> list[Curve] | None:
    """Return the curves of a DXF entity in drawing units, projected along Z; None for a type that is no curve.

    Raises:
        NoLengthError: the entity is of a known type but draws nothing.
        DamagedCurveError: it cannot be drawn.
        NegativeRadiusError: its radius is below 0.
    """
    reader = _READERS.get(entity.dxftype())
    return None if reader is None else reader(entity)


def ensure_whole(entity: Any) -> None:
    """Refuse an entity that lacks a number: the library would take one of its own.

    Raises:
        DamagedCurveError: it does.
    """
    needed = _NEEDED.get(entity.dxftype(), ())
    if not all(map(entity.dxf.hasattr, needed)):
        raise DamagedCurveError(_flat(entity.dxf.get(needed[0])) if entity.dxf.hasattr(needed[0]) else None)


def heights_of(entity: Any) -> Iterable[float]:
    """Return Z of some points of the entity, drawing units, to tell a flat drawing from a solid one."""
    kind = entity.dxftype()
    if kind == "LINE":
        return entity.dxf.start.z, entity.dxf.end.z
    if kind == "LWPOLYLINE":
        if is_edge_on(entity):
            return [float(place.z) for place in entity.vertices_in_wcs()]
        return (entity.dxf.elevation * entity.dxf.extrusion.z,)
    if kind == "POLYLINE":
        if entity.is_2d_polyline and is_edge_on(entity):
            return [float(place.z) for place in entity.points_in_wcs()]
        return [v.dxf.location.z for v in entity.vertices] if entity.is_3d_polyline else (entity.dxf.elevation.z,)
    if kind in ("SPLINE", "HELIX"):
        return [p[2] for p in (entity.control_points or entity.fit_points)]
    if kind == "MLINE":
        return (entity.dxf.start_location.z,)
    if kind == "HATCH":
        return (entity.dxf.elevation.z * entity.dxf.extrusion.z,)
    if kind in ("TEXT", "ATTRIB", "ATTDEF", "MTEXT"):
        return (entity.dxf.insert.z * (1.0 if kind == "MTEXT" else entity.dxf.extrusion.z),)
    if kind in ("SOLID", "TRACE"):
        return (entity.dxf.vtx0.z * entity.dxf.extrusion.z,)
    return (entity.dxf.center.z * entity.dxf.extrusion.z,) if kind in ("ARC", "CIRCLE") else (entity.dxf.center.z,)


def drawn_heights(entity: Any) -> CurveHeights:
    """Return where along Z a curve lies, and how far it is drawn out, drawing units."""
    heights = [float(z) for z in heights_of(entity)]
    if entity.dxftype() == "ELLIPSE":  # a leaning one has no height of its own
        heights += [float(entity.dxf.center.z + entity.dxf.major_axis.z)]
    thickness = float(entity.dxf.thickness) if entity.dxf.hasattr("thickness") else 0.0
    up = float(entity.dxf.extrusion.z) if entity.dxf.hasattr("extrusion") else 1.0
    return CurveHeights(min(heights), max(heights), thickness * up) if heights else LEVEL_ZERO


def line_type_of(entity: Any) -> str:
    """Return the line type that an entity itself is drawn in; "" where that is unbroken, or its layer's."""
    line_type = str(entity.dxf.get("linetype", ""))
    return "" if is_unbroken(line_type) else line_type


def is_unbroken(line_type: str) -> bool:
    """Tell whether a line type of a layer has no gaps."""
    return line_type.casefold() in _UNBROKEN


def widths_of(entity: Any) -> tuple[float, ...]:
    """Return the widths of the bands that CAD programs show for a polyline, drawing units, each as often as it is
    told; empty for a line without any.
    """
    kind = entity.dxftype()
    if kind == "LWPOLYLINE":
        if not entity.has_width:
            return ()
        if entity.dxf.hasattr("const_width"):  # CAD programs take it before the widths of segments
            told = [float(entity.dxf.const_width)]
        else:
            told = [float(width) for pair in entity.get_points("se") for width in pair]
    elif kind == "POLYLINE" and entity.is_2d_polyline:
        own = [entity.dxf.get(f"default_{end}_width", 0.0) for end in ("start", "end")]
        ends = (("start_width", own[0]), ("end_width", own[1]))
        told = [float(vertex.dxf.get(key, default)) for vertex in entity.vertices for key, default in ends]
    else:
        return ()
    return tuple(told) if any(width > 0 and math.isfinite(width) for width in told) else ()


def plane_of(entity: Any, height: float) -> Affine:
    """Return the map from the plane in which a flat entity is drawn (its OCS) to the drawing, seen from above."""
    extrusion = entity.dxf.extrusion
    if extrusion.x == 0 and extrusion.y == 0 and extrusion.z > 0:
        return IDENTITY
    ocs = entity.ocs()
    return Affine(ocs.ux.x, ocs.uy.x, ocs.ux.y, ocs.uy.y, ocs.uz.x * height, ocs.uz.y * height)


def _line(entity: Any) -> list[Curve]:
    return [Line(_flat(entity.dxf.start), _flat(entity.dxf.end))]


def _circle(entity: Any) -> list[Curve]:
    centre, radius = entity.dxf.center, _radius(entity)
    return placed_in(entity, centre.z, [Circle(_flat(centre), radius)])


def _radius(entity: Any) -> float:
    radius, centre = float(entity.dxf.radius), _flat(entity.dxf.center)
    if radius < 0:
        raise NegativeRadiusError(centre, radius)
    if not radius > 0:
        raise NoLengthError(centre)
    return radius


def _arc(entity: Any) -> list[Curve]:
    centre, radius = entity.dxf.center, _radius(entity)
    return placed_in(entity, centre.z, [arc_of(_flat(centre), radius, entity.dxf.start_angle, entity.dxf.end_angle)])


def arc_of(centre: Point, radius: float, first: float, last: float) -> Arc | Circle:
    """Return the arc counter-clockwise from one angle to another, degrees; a circle where it is a full turn."""
    sweep = (last - first) % 360.0
    if sweep < 1e-9 or sweep > 360.0 - 1e-9:
        return Circle(centre, radius)
    return Arc(polar(centre, radius, first), polar(centre, radius, last), centre)


def _ellipse(entity: Any) -> list[Curve]:
    """The minor axis lies across the major one in the plane of the entity, which need not be level."""
    first, last = entity.dxf.start_param, entity.dxf.end_param
    sweep = (last - first) % math.tau
    if sweep < 1e-9 or sweep > math.tau - 1e-9:
        sweep = math.tau
    minor = entity.dxf.extrusion.normalize().cross(entity.dxf.major_axis) * entity.dxf.ratio
    made = ellipse((_flat(entity.dxf.center), _flat(entity.dxf.major_axis), _flat(minor)), first, first + sweep)
    if made is None:
        raise NoLengthError(_flat(entity.dxf.center))
    return [made]


def _lwpolyline(entity: Any) -> list[Curve]:
    vertices = [((float(x), float(y)), float(bulge)) for x, y, bulge in entity.get_points("xyb")]
    if not vertices:
        raise DamagedCurveError(None)
    return placed_in(entity, entity.dxf.elevation, segments_of(vertices, entity.closed))


def _polyline(entity: Any) -> list[Curve] | None:
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        return None
    shown = [v.dxf for v in entity.vertices if not v.dxf.flags & _SPLINE_FRAME]
    if not shown and len(entity.vertices) > 1:  # the curve that its frame steers is not in the file
        raise DamagedCurveError(_flat(entity.vertices[0].dxf.location))
    flat = entity.is_2d_polyline
    vertices = [(_flat(v.get("location")), float(v.bulge) if flat else 0.0) for v in shown]
    segments = segments_of(vertices, entity.is_closed)
    return placed_in(entity, entity.dxf.elevation.z, segments) if flat else segments


def _spline(entity: Any) -> list[Curve]:
    made = spline_curve(entity)
    if made is None:
        points = [(float(point[0]), float(point[1])) for point in entity.control_points or entity.fit_points]
        nothing = len(set(points)) == 1
        raise (NoLengthError if nothing else DamagedCurveError)(points[0] if points else None)
    return [made]


def _mline(entity: Any) -> list[Curve]:
    """The lines of a multiple line, their joints and ends; what fills it is none."""
    parts = [part for part in entity.virtual_entities() if part.dxftype() in ("LINE", "ARC")]
    curves = [curve for part in parts for curve in (_line(part) if part.dxftype() == "LINE" else _arc(part))]
    found = [curve for curve in curves if not isinstance(curve, Line) or curve.start != curve.end]
    if not found:
        raise NoLengthError(_flat(entity.dxf.start_location))
    return found


def segments_of(vertices: list[tuple[Point, float]], closed: bool) -> list[Curve]:
    """Return lines and arcs between vertices; repeated vertices are passed over."""
    if not vertices:
        raise NoLengthError(None)
    ring = [*vertices, vertices[0]] if closed else vertices
    found = [_bulged(a, b, bulge) for (a, bulge), (b, _) in pairwise(ring) if a != b]
    if not found:
        raise NoLengthError(vertices[0][0])
    return found


def _bulged(a: Point, b: Point, bulge: float) -> Curve:
    """Return the segment from a to b; the bulge is the tangent of a quarter of its sweep, positive
    counter-clockwise.
    """
    if abs(bulge) < _STRAIGHT:
        return Line(a, b)
    height = (1 / bulge - bulge) / 4
    centre = ((a[0] + b[0]) / 2 - (b[1] - a[1]) * height, (a[1] + b[1]) / 2 + (b[0] - a[0]) * height)
    return Arc(a, b, centre, bulge > 0)


def placed_in(entity: Any, height: float, curves: list[Curve]) -> list[Curve]:
    """Return curves that are drawn in the plane of an entity, at some height, as they are seen from above."""
    plane = plane_of(entity, height)
    return curves if plane is IDENTITY else list(_seen(curves, plane))


def _seen(curves: list[Curve], plane: Affine) -> Iterator[Curve]:
    for curve in curves:
        seen = transformed(curve, plane)
        if seen is None:
            raise NoLengthError(plane.point(curve.start))
        yield seen


def _flat(v: Any) -> Point:
    return float(v.x), float(v.y)


def polar(centre: Point, radius: float, degrees: float) -> Point:
    """Return the point at an angle on a circle."""
    angle = math.radians(degrees)
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def is_edge_on(entity: Any) -> bool:
    """Tell whether the plane that an entity is drawn in is seen edge-on from above; a line has none."""
    if entity.dxftype() == "LINE" or not entity.dxf.hasattr("extrusion"):
        return False
    extrusion = entity.dxf.extrusion
    return bool(abs(extrusion.z) < _EDGE_ON * extrusion.magnitude)


def stands_upright(entity: Any) -> bool:
    """Tell whether an entity that has no length from above has one when it is seen from the side."""
    return is_edge_on(entity) or rise_of(entity) > 0


def rise_of(entity: Any) -> float:
    """Return how far an entity climbs, drawing units."""
    heights = [float(z) for z in heights_of(entity)]
    return max(heights) - min(heights) if heights else 0.0


def seen_from_above(entity: Any, curves: list[Curve]) -> list[Curve]:
    """Return the curves of an entity without those that are seen end-on, as a line along Z is."""
    if entity.dxftype() not in _SOLID and not is_edge_on(entity):
        return curves
    least = _EDGE_ON * rise_of(entity)
    return curves if not 0 < least < math.inf else [each for each in curves if not _span(each) <= least]


def is_lost(curve: Curve, seen: Curve) -> bool:
    """Tell whether nothing is left of a curve that has a length, as it is seen in a plane edge-on from above."""
    span = _span(curve)
    return span > 0 and _span(seen) <= _EDGE_ON * span


def _span(curve: Curve) -> float:
    """Return the longer side of the box round what holds a curve, drawing units."""
    points = held_by(curve)
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return max(max(xs) - min(xs), max(ys) - min(ys))


def held_by(curve: Curve) -> tuple[Point, ...]:
    """Return points whose hull holds a curve, drawing units; none is worked out for a spline, which may have any."""
    if isinstance(curve, Line | Spline):
        return (curve.start, curve.end) if isinstance(curve, Line) else curve.control_points
    x0, y0, x1, y1 = bounds(curve)
    return (x0, y0), (x1, y0), (x0, y1), (x1, y1)


_READERS: dict[str, Callable[[Any], list[Curve] | None]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "HELIX": _spline,
    "MLINE": _mline,
}
