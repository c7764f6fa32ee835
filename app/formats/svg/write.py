"""SVG out: the part at true size, one user unit to the millimetre, its layers as Inkscape's; every curve as exact as
SVG can be.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

from ...core import tolerances
from ...geometry.arcs.bezier import pieces_of
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from ...model.part import Entity, Layer, Part
from ..drawing import WrittenDrawing
from ..drawing_conversions import Conversions, box_round
from .joined import joined
from .svg import HITOFUDE
from .walk import BLACK
from .xml import INKSCAPE, SODIPODI, SVG

_WIDEST = math.tau / 3
"""Arcs are drawn in parts no wider than this: from the ends and radii of a wider one its centre comes back less
exact.
"""
_THIN = 0.01
"""A part of an ellipse flatter than this is drawn on the unit circle and stretched: its ends alone tell its centre too
badly.
"""
_MARGIN = 1.0
"""Paper round the part, mm."""
_EMPTY = (0.0, 0.0, 100.0, 100.0)
_UNFIT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""What XML cannot hold in any form."""


def svg_bytes(part: Part, tolerance: float = tolerances.CURVE) -> WrittenDrawing:
    """Return the part as SVG.

    Lines, circles, arcs, ellipses and polynomial splines up to degree 3 are kept to the last digit; other splines
    become lines and arcs within `tolerance`, mm. The page holds the whole part; where the part's zero lies on it is
    written too, so that `read_svg` gives back the same coordinates. Curves that follow one another on a layer are one
    path. Entities keep their order within a layer. Ink of no colour of its own is black.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    part, conversions = part.with_entities(part.entities), Conversions(tolerance)
    box = box_round(part.entities) or _EMPTY
    left, low = math.floor(box[0] - _MARGIN), math.floor(box[1] - _MARGIN)
    width, height = math.ceil(box[2] + _MARGIN) - left, math.ceil(box[3] + _MARGIN) - low
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="{SVG}" xmlns:inkscape="{INKSCAPE}" xmlns:sodipodi="{SODIPODI}" xmlns:hitofude="{HITOFUDE}"',
        f'     width="{width}mm" height="{height}mm" viewBox="{left} {-low - height} {width} {height}" '
        'hitofude:zero="0 0">',
        f"  <title>{escape(_UNFIT.sub('_', part.name))}</title>",
    ]
    for number, layer in enumerate(part.layers, 1):
        lines += [_group(number, layer)]
        lines += [
            f"    {element}" for element in _elements((e for e in part.entities if e.layer == layer.name), conversions)
        ]
        lines += ["  </g>"]
    return WrittenDrawing(
        "\n".join([*lines, "</svg>", ""]).encode(), conversions.converted, notes_left_out=len(part.notes)
    )


def _group(number: int, layer: Layer) -> str:
    shown = "inline" if layer.visible else "none"
    locked = ' sodipodi:insensitive="true"' if layer.locked else ""
    return (
        f'  <g id="layer{number}" inkscape:groupmode="layer" '
        f"inkscape:label={quoteattr(_UNFIT.sub('_', layer.name))}{locked} "
        f'style="display:{shown}" fill="none" stroke="{layer.colour or BLACK}" stroke-width="0.1" '
        'stroke-linecap="round">'
    )


def _elements(entities: Iterable[Entity], conversions: Conversions) -> Iterator[str]:
    """Yield an element for each whole circle and ellipse, and a path for each run of curves that follow one another."""
    run: list[Curve] = []
    for curve in (piece for entity in entities for piece in _held(entity.curve, conversions)):
        if run and (_is_whole(curve) or run[-1].end != curve.start or len(joined([run[-1], curve])) == 1):
            yield _path(run)
            run = []
        if _is_whole(curve):
            yield _whole(curve)
        else:
            run.append(curve)
    if run:
        yield _path(run)


def _held(curve: Curve, conversions: Conversions) -> tuple[Curve, ...]:
    """Return the curve itself where SVG can hold it, else lines and arcs."""
    if isinstance(curve, Spline) and curve.degree > 1 and (curve.degree > 3 or curve.weights):
        return conversions.primitives(curve)
    return (curve,)


def _is_whole(curve: Curve) -> bool:
    """True for what has an element of its own; a clockwise circle is a path, for that alone has a direction."""
    return (isinstance(curve, Circle) and curve.ccw) or (
        isinstance(curve, Ellipse) and (_turns(curve) or curve.ratio < _THIN)
    )


def _turns(curve: Ellipse) -> bool:
    return curve.end_parameter - curve.start_parameter >= math.tau - 1e-12


def _stretched(curve: Ellipse) -> str:
    """Return a part of an ellipse as one of the unit circle under a matrix."""
    (a, b), ratio = curve.major, curve.ratio
    matrix = " ".join(map(_number, (a, -b, -b * ratio, -a * ratio, curve.centre[0], -curve.centre[1])))
    unit = Ellipse((0.0, 0.0), (1.0, 0.0), 1.0, -curve.end_parameter, -curve.start_parameter, not curve.ccw)
    arcs = _arcs(_along_ellipse(unit), (1.0, 1.0, 0.0), unit.ccw)
    return (
        f'<path transform="matrix({matrix})" d="M {_place(unit.start)} {" ".join(arcs)}" '
        'vector-effect="non-scaling-stroke"/>'
    )


def _whole(curve: Curve) -> str:
    if isinstance(curve, Circle):
        return f'<circle cx="{_number(curve.centre[0])}" cy="{_number(-curve.centre[1])}" r="{_number(curve.radius)}"/>'
    assert isinstance(curve, Ellipse)
    if not _turns(curve):
        return _stretched(curve)
    x, y, long = _number(curve.centre[0]), _number(-curve.centre[1]), math.hypot(*curve.major)
    turn = f' transform="rotate({_number(_degrees(curve))} {x} {y})"' if curve.major[1] else ""
    return f'<ellipse cx="{x}" cy="{y}" rx="{_number(long)}" ry="{_number(long * curve.ratio)}"{turn}/>'


def _path(run: list[Curve]) -> str:
    commands = [f"M {_place(run[0].start)}", *(command for curve in run for command in _commands(curve))]
    if run[-1].end == run[0].start:
        commands.append("Z")
    return f'<path d="{" ".join(commands)}"/>'


def _commands(curve: Curve) -> list[str]:
    if isinstance(curve, Line):
        return [f"L {_place(curve.end)}"]
    if isinstance(curve, Arc):
        return _arcs(_along_arc(curve), (curve.radius, curve.radius, 0.0), curve.ccw)
    if isinstance(curve, Circle):
        thirds = Arc(curve.start, _on(curve.centre, curve.radius, -_WIDEST), curve.centre, False)
        back = Arc(thirds.end, curve.end, curve.centre, False)
        return [*_commands(thirds), *_commands(back)]
    if isinstance(curve, Ellipse):
        long = math.hypot(*curve.major)
        return _arcs(_along_ellipse(curve), (long, long * curve.ratio, _degrees(curve)), curve.ccw)
    return _beziers(curve)


def _along_arc(arc: Arc) -> list[Point]:
    count = math.ceil(abs(arc.sweep) / _WIDEST)
    angles = [arc.start_angle + arc.sweep * k / count for k in range(1, count)]
    return [*(_on(arc.centre, arc.radius, angle) for angle in angles), arc.end]


def _along_ellipse(curve: Ellipse) -> list[Point]:
    first, last = curve.start_parameter, curve.end_parameter
    count = math.ceil((last - first) / _WIDEST)
    inner = [curve.at(first + (last - first) * k / count) for k in range(1, count)]
    return [*(inner if curve.ccw else inner[::-1]), curve.end]


def _arcs(ends: list[Point], shape: tuple[float, float, float], ccw: bool) -> list[str]:
    """Return arcs one after another; `shape` is both radii and the turn, degrees."""
    rx, ry, turn = map(_number, shape)
    return [f"A {rx} {ry} {turn} 0 {0 if ccw else 1} {_place(end)}" for end in ends]


def _beziers(curve: Spline) -> list[str]:
    letter = {1: "L", 2: "Q", 3: "C"}[curve.degree]
    rows = [[(float(x), float(y)) for x, y in points[1:]] for points in pieces_of(curve).polygon]
    if rows:
        rows[-1][-1] = curve.end
    return [f"{letter} {' '.join(map(_place, row))}" for row in rows]


def _degrees(curve: Ellipse) -> float:
    return -math.degrees(math.atan2(curve.major[1], curve.major[0]))


def _on(centre: Point, radius: float, angle: float) -> Point:
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def _place(p: Point) -> str:
    return f"{_number(p[0])} {_number(-p[1])}"


def _number(value: float) -> str:
    """Return the shortest text that reads back as the same number."""
    return repr(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value)
