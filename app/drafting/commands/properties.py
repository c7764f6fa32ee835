"""What can be read of a curve or a note and set to another value, and what stays the same when it is."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

from ...core.errors import InputError
from ...geometry.transform import scaling, shift, transformed, turn
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ...model.notes import Dimension, Guide, Mark, Shape
from ..curves.shapes import arc_about, circle, ellipse, lines_through

Value = float | Point


class PropertyKind(Enum):
    """What a property is: a point or a length in mm, an angle in degrees."""

    POINT = "point"
    LENGTH = "length"
    ANGLE = "angle"


@dataclass(frozen=True, slots=True)
class Property:
    """One thing to read and to set.

    Attributes:
        read: gives its value for a shape. written: gives the shape that has a value.
        about: what stays the same when it is set.
    """

    kind: PropertyKind
    read: Callable[[Any], Value]
    written: Callable[[Any, Any], Any]
    about: str


def properties_of(shape: Curve | Shape) -> Mapping[str, Property]:
    """Return what can be set of a curve or a note, by the word that the language has for it."""
    return _PROPERTIES[type(shape)]


def with_property(shape: Curve | Shape, word: str, value: Value) -> Any:
    """Return a curve or note whose property has another value: mm, or degrees.

    Raises:
        InputError: the shape has no such property, or would be none with this value.
    """
    known = _PROPERTIES[type(shape)]
    if word not in known:
        raise InputError(f"{article(shape)} has no {word}; it has {', '.join((*known, 'layer'))}.")
    return known[word].written(shape, value)


def article(shape: Curve | Shape) -> str:
    """Return what a curve or note is called, with its article."""
    word = kind_name(shape)
    return f"{'An' if word[0] in 'aeiou' else 'A'} {word}"


def kind_name(shape: Curve | Shape) -> str:
    """Return what a curve or note is called."""
    names: dict[type, str] = {Mark: "point", Guide: "construction line", Dimension: "dimension"}
    return names.get(type(shape), type(shape).__name__.lower())


def _away(base: Point, length: float, angle: float) -> Point:
    """Return the point at a length, mm, and an angle, degrees, from another; exact straight across and up."""
    x, y = turn((0.0, 0.0), angle)((length, 0.0))
    return (base[0] + x, base[1] + y)


def _angle(base: Point, to: Point) -> float:
    return math.degrees(math.atan2(to[1] - base[1], to[0] - base[0])) % 360


def _positive(value: float, name: str) -> float:
    if not value > 0:
        raise InputError(f"The {name} is {value:.3f} mm; it must be greater than 0.")
    return value


def _line(start: Point, end: Point) -> Line:
    return lines_through([start, end])[0]


def _moved(curve: Curve, place: Point, to: Point) -> Curve:
    return transformed(curve, shift((to[0] - place[0], to[1] - place[1])))


def _middle(line: Line) -> Point:
    return ((line.start[0] + line.end[0]) / 2, (line.start[1] + line.end[1]) / 2)


def _lengthened(line: Line, length: float) -> Line:
    share = _positive(length, "length") / math.dist(line.start, line.end)
    (x, y), (ex, ey) = line.start, line.end
    return _line(line.start, (x + (ex - x) * share, y + (ey - y) * share))


def _bent(arc: Arc, start: Point, end: Point) -> Arc:
    """Return the arc of the same sweep between other ends."""
    old, new = complex(*arc.end) - complex(*arc.start), complex(*end) - complex(*start)
    _line(start, end)  # refuses ends that are the same
    if old == 0:
        raise InputError("This arc is a whole turn, whose ends cannot be parted; break it at two points first.")
    centre = complex(*start) + (complex(*arc.centre) - complex(*arc.start)) * new / old
    return arc_about(start, end, (centre.real, centre.imag), arc.ccw)


def _round(arc: Arc, radius: float) -> Arc:
    grown = transformed(arc, scaling(arc.centre, _positive(radius, "radius") / arc.radius))
    assert isinstance(grown, Arc)
    return replace(grown, centre=arc.centre)


def _swept(arc: Arc, sweep: float) -> Arc:
    if not 0 < sweep < 360:
        raise InputError(f"The sweep is {sweep:.2f}\u00b0; an arc turns by more than 0\u00b0 and less than 360\u00b0.")
    end = _away(arc.centre, arc.radius, math.degrees(arc.start_angle) + (sweep if arc.ccw else -sweep))
    return arc_about(arc.start, end, arc.centre, arc.ccw)


def _arc_length(arc: Arc, length: float) -> Arc:
    around = math.tau * arc.radius
    if not 0 < length < around:
        raise InputError(
            f"The length is {length:.3f} mm; on this radius it must be greater than 0 and less than {around:.3f} mm."
        )
    return _swept(arc, math.degrees(length / arc.radius))


def _sized(round_: Circle, radius: float) -> Circle:
    return replace(round_, radius=circle(round_.centre, radius).radius)


def _half_axes(curve: Ellipse) -> tuple[float, float]:
    major = math.hypot(*curve.major)
    return major, major * curve.ratio


def _with_half_axes(curve: Ellipse, major: float, minor: float) -> Ellipse:
    was = math.hypot(*curve.major)
    end = (curve.centre[0] + curve.major[0] / was * major, curve.centre[1] + curve.major[1] / was * major)
    return ellipse(curve.centre, end, minor, (curve.start_parameter, curve.end_parameter), curve.ccw)


def _turned(curve: Ellipse, angle: float) -> Ellipse:
    return replace(curve, major=_away((0.0, 0.0), math.hypot(*curve.major), angle))


def _direction(guide: Guide, angle: float) -> Guide:
    return replace(guide, angle=math.radians(angle % 180))


_P, _L, _A = PropertyKind.POINT, PropertyKind.LENGTH, PropertyKind.ANGLE
_PROPERTIES: Mapping[type, Mapping[str, Property]] = {
    Line: {
        "start": Property(_P, lambda c: c.start, lambda c, p: _line(p, c.end), "The end stays."),
        "end": Property(_P, lambda c: c.end, lambda c, p: _line(c.start, p), "The start stays."),
        "middle": Property(_P, _middle, lambda c, p: _moved(c, _middle(c), p), "The whole line moves."),
        "length": Property(_L, lambda c: math.dist(c.start, c.end), _lengthened, "Start and direction stay."),
        "angle": Property(
            _A,
            lambda c: _angle(c.start, c.end),
            lambda c, a: _line(c.start, _away(c.start, math.dist(c.start, c.end), a)),
            "The line turns about its start.",
        ),
    },
    Arc: {
        "start": Property(_P, lambda c: c.start, lambda c, p: _bent(c, p, c.end), "End and sweep stay."),
        "end": Property(_P, lambda c: c.end, lambda c, p: _bent(c, c.start, p), "Start and sweep stay."),
        "centre": Property(_P, lambda c: c.centre, lambda c, p: _moved(c, c.centre, p), "The whole arc moves."),
        "radius": Property(_L, lambda c: c.radius, _round, "Centre and sweep stay."),
        "diameter": Property(_L, lambda c: 2 * c.radius, lambda c, d: _round(c, d / 2), "Centre and sweep stay."),
        "sweep": Property(_A, lambda c: abs(math.degrees(c.sweep)), _swept, "Start, centre and radius stay."),
        "length": Property(_L, lambda c: c.radius * abs(c.sweep), _arc_length, "Start, centre and radius stay."),
    },
    Circle: {
        "centre": Property(_P, lambda c: c.centre, lambda c, p: replace(c, centre=p), "The radius stays."),
        "radius": Property(_L, lambda c: c.radius, _sized, "The centre stays."),
        "diameter": Property(_L, lambda c: 2 * c.radius, lambda c, d: _sized(c, d / 2), "The centre stays."),
        "length": Property(
            _L, lambda c: math.tau * c.radius, lambda c, v: _sized(c, v / math.tau), "The centre stays."
        ),
    },
    Ellipse: {
        "centre": Property(_P, lambda c: c.centre, lambda c, p: _moved(c, c.centre, p), "The whole ellipse moves."),
        "major": Property(
            _L,
            lambda c: _half_axes(c)[0],
            lambda c, v: _with_half_axes(c, v, _half_axes(c)[1]),
            "Centre, direction and the other half axis stay.",
        ),
        "minor": Property(
            _L,
            lambda c: _half_axes(c)[1],
            lambda c, v: _with_half_axes(c, _half_axes(c)[0], v),
            "Centre, direction and the other half axis stay.",
        ),
        "angle": Property(_A, lambda c: _angle((0.0, 0.0), c.major), _turned, "The ellipse turns about its centre."),
    },
    Spline: {
        "start": Property(
            _P,
            lambda c: c.start,
            lambda c, p: replace(c, control_points=(p, *c.control_points[1:])),
            "The other control points stay.",
        ),
        "end": Property(
            _P,
            lambda c: c.end,
            lambda c, p: replace(c, control_points=(*c.control_points[:-1], p)),
            "The other control points stay.",
        ),
    },
    Mark: {"place": Property(_P, lambda n: n.at, lambda n, p: replace(n, at=p), "The point moves.")},
    Guide: {
        "place": Property(_P, lambda n: n.through, lambda n, p: replace(n, through=p), "The direction stays."),
        "angle": Property(_A, lambda n: math.degrees(n.angle), _direction, "It turns about the point it goes through."),
    },
    Dimension: {"place": Property(_P, lambda n: n.place, lambda n, p: replace(n, place=p), "What it measures stays.")},
}

WORDS: Mapping[str, PropertyKind] = {word: each.kind for known in _PROPERTIES.values() for word, each in known.items()}
"""Every property that some shape has, and what it is."""
