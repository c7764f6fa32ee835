"""A sheet of paper with a drawing on it, in mm from its lower left corner, y up: what every plot format and the screen
are made from.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry.arcs.arcs import lines_and_arcs
from ...geometry.arcs.bezier import pieces_of
from ...geometry.transform import Similarity
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline

Box = tuple[float, float, float, float]
"""x0, y0, x1, y1, mm."""

_SIXTH = 1.82e-5
"""A cubic along an arc leaves it by this much of the radius, times the arc's angle (radians) to the sixth."""


class Paper(Enum):
    """Sizes of paper; the value is the short and the long side, mm."""

    A4 = (210.0, 297.0)
    A3 = (297.0, 420.0)
    A2 = (420.0, 594.0)
    A1 = (594.0, 841.0)
    A0 = (841.0, 1189.0)
    LETTER = (215.9, 279.4)
    TABLOID = (279.4, 431.8)


@dataclass(frozen=True, slots=True)
class Pen:
    """How a line is drawn.

    Attributes:
        number: of a plotter's pen, >= 1.
        colour: "#rrggbb". width: mm on paper. dash: lengths of dash and gap, mm on paper; none: solid.
    """

    number: int = 1
    colour: str = "#000000"
    width: float = 0.35
    dash: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class PenStroke:
    """Curves drawn with one pen; one that begins where the one before ends is joined to it."""

    pen: Pen
    curves: tuple[Curve, ...]


@dataclass(frozen=True, slots=True, eq=False)
class TracedPolyline:
    """One polyline without a gap, (n, 2) points, n >= 2; the dashes run on along all of it."""

    pen: Pen
    points: NDArray[np.float64]

    def placed(self, place: Similarity) -> NDArray[np.float64]:
        """Return its points where a map that does not mirror takes them."""
        z = (self.points[:, 0] + 1j * self.points[:, 1]) * place.a + place.b
        return np.stack([z.real, z.imag], axis=1)


@dataclass(frozen=True, slots=True)
class FilledPolygon:
    """An area inside a polygon, in the colour of a pen and without an outline."""

    pen: Pen
    corners: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class TextLine:
    """One line of text.

    Attributes:
        at: where its foot begins, has its middle or ends, by `anchor` 0, 0.5 or 1. bold: in heavier letters.
        height: of the letters' body, mm on paper. angle: radians. lift: how far the foot stands above `at`, mm on
            paper.
    """

    text: str
    at: Point
    height: float
    anchor: float = 0.0
    angle: float = 0.0
    lift: float = 0.0
    pen: Pen = Pen()
    bold: bool = False


@dataclass(frozen=True)
class PageContent:
    """What is on a sheet: lines, filled polygons, text, and under them traces, in the order in which they are drawn."""

    strokes: tuple[PenStroke, ...] = ()
    patches: tuple[FilledPolygon, ...] = ()
    words: tuple[TextLine, ...] = ()
    traces: tuple[TracedPolyline, ...] = ()

    def __add__(self, other: PageContent) -> PageContent:
        return PageContent(
            self.strokes + other.strokes,
            self.patches + other.patches,
            self.words + other.words,
            self.traces + other.traces,
        )


@dataclass(frozen=True)
class PlotPage:
    """One sheet.

    Attributes:
        width, height: mm.
        window: what of the paper the drawing may cover; it is clipped there.
        place: takes the drawing's mm to the paper's.
        drawing: in the drawing's mm. frame: in the paper's, never clipped.
    """

    width: float
    height: float
    window: Box
    place: Similarity
    drawing: PageContent
    frame: PageContent = field(default_factory=PageContent)


def fitted(text: str, height: float, room: float) -> str:
    """Return as much of a text as surely fits, taking a letter to be at most as wide as 0.62 of its height, others as
    high.
    """
    used, kept = 0.0, ""
    for letter in text:
        used += height * (0.62 if ord(letter) < 0x1100 else 1.0)
        if used > room:
            return f"{kept[:-1]}…"
        kept += letter
    return kept


def segments(curve: Curve, tolerance: float) -> Iterator[tuple[Point, ...]]:
    """Yield a curve as (end,) of a straight line or (handle, handle, end) of a cubic, within `tolerance`, mm, each
    going on from the last.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    if isinstance(curve, Line):
        yield (curve.end,)
    elif isinstance(curve, Spline):
        yield from _along_spline(curve, tolerance)
    else:
        yield from _along_round(curve, tolerance)


def chains(curves: Iterable[Curve]) -> Iterator[list[Curve]]:
    """Yield runs of curves each of which begins where the one before ends."""
    run: list[Curve] = []
    for curve in curves:
        if run and run[-1].end != curve.start:
            yield run
            run = []
        run.append(curve)
    if run:
        yield run


def _along_round(curve: Arc | Circle | Ellipse, tolerance: float) -> Iterator[tuple[Point, ...]]:
    centre, x, y, begin, sweep = _frame(curve)
    size = math.hypot(*x)
    count = max(
        1, math.ceil(abs(sweep) / (math.pi / 2)), math.ceil(abs(sweep) * (_SIXTH * size / tolerance) ** (1 / 6))
    )
    step = sweep / count
    handle = 4 / 3 * math.tan(step / 4)

    def place(c: float, s: float) -> Point:
        return (centre[0] + c * x[0] + s * y[0], centre[1] + c * x[1] + s * y[1])

    for k in range(count):
        a, b = begin + step * k, begin + step * (k + 1)
        end = curve.end if k == count - 1 else place(math.cos(b), math.sin(b))
        yield (
            place(math.cos(a) - handle * math.sin(a), math.sin(a) + handle * math.cos(a)),
            place(math.cos(b) + handle * math.sin(b), math.sin(b) - handle * math.cos(b)),
            end,
        )


class _RoundFrame(NamedTuple):
    """A round curve: its centre, both half axes, the angle that it begins at and how far it goes, radians."""

    centre: Point
    x: Point
    y: Point
    begin: float
    sweep: float


def _frame(curve: Arc | Circle | Ellipse) -> _RoundFrame:
    """Return what a round curve is drawn by."""
    if isinstance(curve, Arc):
        return _RoundFrame(curve.centre, (curve.radius, 0.0), (0.0, curve.radius), curve.start_angle, curve.sweep)
    if isinstance(curve, Circle):
        turn = math.tau if curve.ccw else -math.tau
        return _RoundFrame(curve.centre, (curve.radius, 0.0), (0.0, curve.radius), 0.0, turn)
    (a, b), span = curve.major, curve.end_parameter - curve.start_parameter
    first, sweep = (curve.start_parameter, span) if curve.ccw else (curve.end_parameter, -span)
    return _RoundFrame(curve.centre, curve.major, (-b * curve.ratio, a * curve.ratio), first, sweep)


def _along_spline(curve: Spline, tolerance: float) -> Iterator[tuple[Point, ...]]:
    if curve.weights or curve.degree > 3:
        for primitive in lines_and_arcs(curve, tolerance / 2).primitives:
            yield from segments(primitive, tolerance / 2)
        return
    for row in pieces_of(curve).polygon:
        points: list[Point] = [(float(x), float(y)) for x, y in row]
        if len(points) == 3:
            a, b, c = points
            points = [a, _between(a, b, 2 / 3), _between(c, b, 2 / 3), c]
        yield tuple(points[1:])


def _between(a: Point, b: Point, part: float) -> Point:
    return (a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part)
