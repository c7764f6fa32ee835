"""How a dimension is drawn: extension lines, dimension line, arrow heads, the figure and where it stands."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from ..core.wording import trimmed
from ..model.curves import Arc, Line, Point
from ..model.notes import Dimension, DimensionKind

Head = tuple[Point, Point, Point]
"""An arrow head: its tip and the two corners behind it, mm."""

_GAP, _BEYOND, _HALF_WIDTH, _NARROW = 0.4, 0.6, 1 / 6, 2.5
"""In lengths of an arrow: from the point to its extension line, of that past the dimension line; half an arrow; least
room for two.
"""


@dataclass(frozen=True, slots=True)
class DimensionLines:
    """A dimension ready to be painted, mm.

    Attributes:
        figure: what is written.
        at: the middle of the figure's foot, on the dimension line.
        angle: of the figure, radians, in (-pi/2, pi/2]: it is read from below or from the right.
    """

    lines: tuple[Line, ...]
    arcs: tuple[Arc, ...]
    heads: tuple[Head, ...]
    figure: str
    at: Point
    angle: float


def measured(dimension: Dimension) -> float:
    """Return what a dimension measures: mm, or degrees in [0, 360) for an angle."""
    a, b = (complex(*point) for point in dimension.points[:2])
    if dimension.measure is DimensionKind.ANGLE:
        return math.degrees(cmath.phase((complex(*dimension.points[2]) - a) / (b - a)) % math.tau) if b != a else 0.0
    if dimension.measure is DimensionKind.ACROSS:
        return abs((b - a).real)
    if dimension.measure is DimensionKind.UP:
        return abs((b - a).imag)
    return abs(b - a) * (2 if dimension.measure is DimensionKind.DIAMETER else 1)


def figure(dimension: Dimension, mm_per_unit: float = 1.0) -> str:
    """Return what is written: at most 3 decimals for lengths and 2 for degrees, no zeros at the end."""
    angle = dimension.measure is DimensionKind.ANGLE
    value = trimmed(measured(dimension) / (1.0 if angle else mm_per_unit), 2 if angle else 3)
    sign = {DimensionKind.RADIUS: "R ", DimensionKind.DIAMETER: "\u2300 "}.get(dimension.measure, "")
    return f"{sign}{value}{'°' if angle else ''}"


def dimension_lines(dimension: Dimension, arrow: float, mm_per_unit: float = 1.0) -> DimensionLines:
    """Return the lines of a dimension.

    Args:
        dimension: what is measured, and where its figure stands.
        arrow: length of an arrow head, mm of the drawing, > 0.
        mm_per_unit: size of the unit that figures are written in.
    """
    words = figure(dimension, mm_per_unit)
    if dimension.measure is DimensionKind.ANGLE:
        return _angle(dimension, arrow, words)
    if dimension.measure in (DimensionKind.RADIUS, DimensionKind.DIAMETER):
        return _round(dimension, arrow, words)
    return _straight(dimension, arrow, words)


def _straight(dimension: Dimension, arrow: float, words: str) -> DimensionLines:
    a, b, place = (complex(*point) for point in (*dimension.points[:2], dimension.place))
    along = {DimensionKind.ACROSS: 1 + 0j, DimensionKind.UP: 1j}.get(dimension.measure, b - a)
    along = along / abs(along) if along else 1 + 0j
    feet = tuple(point + along * 1j * _dot(place - point, along * 1j) for point in (a, b))
    lines = [line for point, foot in zip((a, b), feet, strict=True) for line in _extension(point, foot, arrow)]
    heads, drawn = _between(feet[0], feet[1], along, arrow)
    return DimensionLines((*lines, *_through(drawn, place, along)), (), heads, words, _point(place), _upright(along))


def _round(dimension: Dimension, arrow: float, words: str) -> DimensionLines:
    centre, on, place = (complex(*point) for point in (*dimension.points[:2], dimension.place))
    radius, out = abs(on - centre), place - centre
    out = out / abs(out) if out else 1 + 0j
    tip = centre + radius * out
    if dimension.measure is DimensionKind.DIAMETER:
        heads, drawn = _between(centre - radius * out, tip, out, arrow)
    else:
        inside = abs(place - centre) <= radius
        heads, drawn = (_head(tip, out if inside else -out, arrow),), (centre if inside else tip, tip)
    return DimensionLines(_through(drawn, place, out), (), heads, words, _point(place), _upright(out))


def _angle(dimension: Dimension, arrow: float, words: str) -> DimensionLines:
    vertex, a, b, place = (complex(*point) for point in (*dimension.points[:3], dimension.place))
    radius = abs(place - vertex)
    if a == vertex or b == vertex or not radius:
        return DimensionLines((), (), (), words, dimension.place, 0.0)
    ways = tuple((point - vertex) / abs(point - vertex) for point in (a, b))
    ends = tuple(vertex + radius * way for way in ways)
    inner = [(point, end) for point, end in zip((a, b), ends, strict=True) if radius > abs(point - vertex)]
    lines = [line for point, end in inner for line in _extension(point, end, arrow)]
    arcs = (Arc(_point(ends[0]), _point(ends[1]), _point(vertex)),) if ends[0] != ends[1] else ()
    heads = (_head(ends[0], ways[0] * -1j, arrow), _head(ends[1], ways[1] * 1j, arrow))
    return DimensionLines(tuple(lines), arcs, heads, words, dimension.place, _upright((place - vertex) * 1j))


def _between(a: complex, b: complex, along: complex, arrow: float) -> tuple[tuple[Head, ...], tuple[complex, complex]]:
    """Return the arrow heads at both ends, from outside where there is no room between, and the ends of their line."""
    if _dot(b - a, along) < 0:
        a, b = b, a
    if abs(b - a) >= _NARROW * arrow:
        return (_head(a, -along, arrow), _head(b, along, arrow)), (a, b)
    reach = 2 * arrow * along
    return (_head(a, along, arrow), _head(b, -along, arrow)), (a - reach, b + reach)


def _through(ends: tuple[complex, complex], place: complex, along: complex) -> tuple[Line, ...]:
    """Return the line that goes from end to end and as far as the figure."""
    a, b = ends
    steps = (0.0, _dot(b - a, along), _dot(place - a, along))
    low, high = a + min(steps) * along, a + max(steps) * along
    return (Line(_point(low), _point(high)),) if low != high else ()


def _extension(point: complex, foot: complex, arrow: float) -> tuple[Line, ...]:
    way = foot - point
    if abs(way) <= _GAP * arrow:
        return ()
    unit = way / abs(way)
    return (Line(_point(point + _GAP * arrow * unit), _point(foot + _BEYOND * arrow * unit)),)


def _head(tip: complex, way: complex, arrow: float) -> Head:
    back, side = tip - arrow * way, arrow * _HALF_WIDTH * way * 1j
    return _point(tip), _point(back + side), _point(back - side)


def _upright(along: complex) -> float:
    angle = math.remainder(cmath.phase(along), math.pi)
    return angle + math.pi if angle <= -math.pi / 2 + 1e-9 else angle


def _dot(a: complex, b: complex) -> float:
    return a.real * b.real + a.imag * b.imag


def _point(z: complex) -> Point:
    return (z.real, z.imag)
