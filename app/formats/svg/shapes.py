"""SVG's basic shapes to curves, y downwards as in the file."""

from __future__ import annotations

import math
from collections.abc import Callable

from ...geometry.affine import ellipse
from ...model.curves import Arc, Circle, Curve, Line, Point
from .lengths import LengthBasis, length
from .numbers import UnreadableError, numbers
from .path import SvgPath, read_path
from .xml import Node


def shape(node: Node, basis: LengthBasis, most: int) -> SvgPath | None:
    """Return what an element draws, in its own coordinates; None for an element that is no shape.

    Args:
        most: curves of path data.

    Raises:
        UnreadableError: an attribute that it cannot do without is no number.
        ArithmeticError: numbers so large or small that nothing can be drawn.
    """
    if node.tag == "path":
        return read_path(node.attributes.get("d", ""), most)
    reader = _READERS.get(node.tag)
    return None if reader is None else reader(node, basis)


def measure(node: Node, key: str, basis: LengthBasis, default: float = 0.0) -> float:
    """Return a length of an element in user units; percentages are of the viewport's width, height or diagonal.

    Raises:
        UnreadableError: it is no length.
    """
    text = node.attributes.get(key)
    if text is None or text.strip() == "auto":
        return default
    return length(text).user(basis, _AXIS.get(key, ""))


_AXIS = {
    **dict.fromkeys(("x", "cx", "x1", "x2", "rx", "width"), "x"),
    **dict.fromkeys(("y", "cy", "y1", "y2", "ry", "height"), "y"),
}


LENGTHS = ("r", *_AXIS)
"""Attributes that are lengths."""


def _size(node: Node, key: str, basis: LengthBasis, default: float = 0.0) -> float:
    value = measure(node, key, basis, default)
    if value < 0:
        raise UnreadableError(node.attributes[key])
    return value


def _line(node: Node, basis: LengthBasis) -> SvgPath:
    x1, y1, x2, y2 = (measure(node, key, basis) for key in ("x1", "y1", "x2", "y2"))
    return _drawn([Line((x1, y1), (x2, y2))] if (x1, y1) != (x2, y2) else [], (x1, y1))


def _circle(node: Node, basis: LengthBasis) -> SvgPath:
    centre, radius = (measure(node, "cx", basis), measure(node, "cy", basis)), _size(node, "r", basis)
    return _drawn([Circle(centre, radius)] if radius > 0 else [], centre)


def _ellipse(node: Node, basis: LengthBasis) -> SvgPath:
    centre = measure(node, "cx", basis), measure(node, "cy", basis)
    rx, ry = _radii(node, basis)
    if rx == ry:
        return _drawn([Circle(centre, rx)] if rx > 0 else [], centre)
    made = ellipse((centre, (rx, 0.0), (0.0, ry)), 0.0, math.tau)
    return _drawn([made] if made is not None else [], centre)


def _radii(node: Node, basis: LengthBasis) -> tuple[float, float]:
    """Return rx and ry; one that is not given is as the other."""
    given = {key: _size(node, key, basis) for key in ("rx", "ry") if node.attributes.get(key, "auto").strip() != "auto"}
    return given.get("rx", given.get("ry", 0.0)), given.get("ry", given.get("rx", 0.0))


def _rect(node: Node, basis: LengthBasis) -> SvgPath:
    """A rectangle, from the end of its first corner round to the right, as SVG has it."""
    x, y = measure(node, "x", basis), measure(node, "y", basis)
    width, height = _size(node, "width", basis), _size(node, "height", basis)
    if not (width > 0 and height > 0):
        return _drawn([], (x, y))
    rx, ry = _radii(node, basis)
    rx, ry = min(rx, width / 2), min(ry, height / 2)
    right, low = x + width, y + height
    if not (rx > 0 and ry > 0):
        corners = [(x, y), (right, y), (right, low), (x, low)]
        return _drawn(_polygon(corners, closed=True), (x, y))
    centres = [(right - rx, y + ry), (right - rx, low - ry), (x + rx, low - ry), (x + rx, y + ry)]
    curves: list[Curve] = []
    at = (x + rx, y)
    for quarter, (cx, cy) in enumerate(centres):
        begin, end = [[(cx, y), (right, cy)], [(right, cy), (cx, low)], [(cx, low), (x, cy)], [(x, cy), (cx, y)]][
            quarter
        ]
        if begin != at:
            curves.append(Line(at, begin))
        curves.append(_corner((begin, end, (cx, cy)), (rx, ry), (quarter - 1) * math.pi / 2))
        at = end
    return _drawn(curves, (x, y))


def _corner(places: tuple[Point, Point, Point], radii: tuple[float, float], angle: float) -> Curve:
    """Return a quarter of an ellipse from begin to end round a centre."""
    begin, end, centre = places
    if radii[0] == radii[1]:
        return Arc(begin, end, centre)
    made = ellipse((centre, (radii[0], 0.0), (0.0, radii[1])), angle, angle + math.pi / 2)
    return made if made is not None else Line(begin, end)


def _poly(node: Node, _: LengthBasis) -> SvgPath:
    """Lines through points; as SVG asks, those before a fault are drawn."""
    path = SvgPath()
    try:
        values = numbers(node.attributes.get("points", ""))
    except UnreadableError as error:
        values, path.fault = error.args[1], 0
    if len(values) % 2:
        path.fault = 0
    points = list(zip(values[::2], values[1::2], strict=False))
    path.start = points[0] if points else None
    path.runs = [_polygon(points, closed=node.tag == "polygon")]
    return path


def _polygon(points: list[Point], closed: bool) -> list[Curve]:
    ends = points[1:] + points[:1] if closed else points[1:]
    return [Line(a, b) for a, b in zip(points, ends, strict=False) if a != b]


def _drawn(curves: list[Curve], start: Point) -> SvgPath:
    return SvgPath([curves] if curves else [], None, start)


_READERS: dict[str, Callable[[Node, LengthBasis], SvgPath]] = {
    "line": _line,
    "circle": _circle,
    "ellipse": _ellipse,
    "rect": _rect,
    "polyline": _poly,
    "polygon": _poly,
}
SHAPES = ("path", *_READERS)
"""Elements that draw curves."""
