"""Commands that draw what is never machined: points, construction lines, dimensions."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...geometry.dimension_lines import figure
from ...model.curves import Arc, Circle, Curve, Line, Point
from ...model.notes import Dimension, DimensionKind, Guide, Mark, Shape
from ..commands.command import DraftingSession
from ..curves.intersections import nearest_point
from ..curves.shapes import shown
from ..expressions.arguments import Arguments

_MEASURES = {measure.value: measure for measure in DimensionKind}


@dataclass(frozen=True, slots=True)
class DrawNote:
    """Add a note to the drawing.

    Attributes:
        last: the point that the next relative coordinates start from, mm.
    """

    name: str
    shape: Shape
    reply: str
    last: Point

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the note added, on a fresh id."""
        return replace(session, part=session.part.with_note(self.shape, session.layer), last=self.last)


def point(words: Arguments, session: DraftingSession) -> DrawNote:
    """A point to snap to."""
    at = words.point()
    return DrawNote("Point", Mark(at), f"Point {shown(at)}.", at)


def guide(words: Arguments, session: DraftingSession) -> DrawNote:
    """A construction line: through two points, at an angle, or only across or up."""
    way = words.accept("across", "up")
    through = words.point("a point of it")
    if way:
        angle = 0.0 if way == "across" else 90.0
    elif words.is_point():
        x, y = words.point("another point of it")
        if math.dist(through, (x, y)) < WELD:
            raise InputError("A construction line needs two different points, or a point and an angle.")
        angle = math.degrees(math.atan2(y - through[1], x - through[0]))
    else:
        angle = words.angle("another point of it, or its angle")
    turned = math.radians(angle % 180)
    return DrawNote(
        "Construction line",
        Guide(through, turned if turned < math.pi else 0.0),
        f"Construction line, {angle % 180:.2f}°.",
        through,
    )


def dimension(words: Arguments, session: DraftingSession) -> DrawNote:
    """A dimension of two points, of a curve, or of an angle at a point."""
    measure = _MEASURES.get(words.accept(*_MEASURES))
    curve: Curve | None = None
    points: tuple[Point, ...] = ()
    if measure is None and not words.is_point():
        _, curve = words.curve("two points, or a curve")
    else:
        points = tuple(words.point() for _ in range(3 if measure is DimensionKind.ANGLE else 2))
    if not words.accept("place"):
        raise words.wrong("Write place and the point where the figure stands.")
    place = words.point("where the figure stands")
    if curve is not None:
        made = _of_curve(curve, place)
    else:
        made = Dimension(measure or _MEASURES.get(words.accept("across", "up"), DimensionKind.ALIGNED), points, place)
    if any(math.dist(made.points[0], other) < WELD for other in made.points[1:]):
        raise InputError("A dimension needs different points.")
    return DrawNote("Dimension", made, f"Dimension, {figure(made)}.", place)


def _of_curve(curve: Curve, place: Point) -> Dimension:
    if isinstance(curve, Line):
        return Dimension(DimensionKind.ALIGNED, (curve.start, curve.end), place)
    if isinstance(curve, Circle):
        return Dimension(
            DimensionKind.DIAMETER, (curve.centre, (curve.centre[0] + curve.radius, curve.centre[1])), place
        )
    if isinstance(curve, Arc):
        return Dimension(DimensionKind.RADIUS, (curve.centre, nearest_point(curve, place)), place)
    raise InputError("A dimension of a curve is of a line, an arc or a circle; of others give two points.")
