"""What is drawn to help and to tell, and never machined: points, construction lines, dimensions."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from .curves import Line, Point

_FAR = 2e4
"""Half the length of a construction line where it is cut with curves, mm: far longer than any drawing, and digits are
left.
"""


@dataclass(frozen=True, slots=True)
class Mark:
    """A point, mm."""

    at: Point


@dataclass(frozen=True, slots=True)
class Guide:
    """A construction line: without end in both directions.

    Attributes:
        through: a point of it, mm.
        angle: its direction from +X, rad, in [0, pi).
    """

    through: Point
    angle: float

    @property
    def line(self) -> Line:
        """A line along it that is far longer than any drawing."""
        (x, y), dx, dy = self.through, _FAR * math.cos(self.angle), _FAR * math.sin(self.angle)
        dx, dy = (0.0 if abs(dx) < 1e-9 else dx), (0.0 if abs(dy) < 1e-9 else dy)
        return Line((x - dx, y - dy), (x + dx, y + dy))


class DimensionKind(Enum):
    """What a dimension measures."""

    ALIGNED = "aligned"
    ACROSS = "across"
    UP = "up"
    RADIUS = "radius"
    DIAMETER = "diameter"
    ANGLE = "angle"


@dataclass(frozen=True, slots=True)
class Dimension:
    """A measure that is shown in the drawing.

    Attributes:
        measure: ALIGNED, ACROSS (along X) and UP (along Y) measure between two points; RADIUS and DIAMETER from a
            centre to a point on the curve; ANGLE at the first point between the directions to the second and the third,
            ccw.
        points: those points, mm: two, or three for ANGLE.
        place: where the figure stands, mm; the dimension line goes through it.
    """

    measure: DimensionKind
    points: tuple[Point, ...]
    place: Point


Shape = Mark | Guide | Dimension


@dataclass(frozen=True, slots=True)
class Note:
    """One of them in a drawing.

    Attributes:
        id: shares the numbers of the part's entities, > 0.
        layer: name of its layer.
    """

    id: int
    shape: Shape
    layer: str = "0"
