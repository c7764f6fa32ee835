"""Similarities of the plane: shifting, turning, scaling, mirroring. Every curve stays what it is."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ..core.errors import InputError
from ..core.tolerances import WELD
from ..model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from ..model.notes import DimensionKind, Guide, Mark, Shape

_FARTHEST = 1e9
"""From zero, mm: beyond it a double knows no micrometre, and repeated scaling would end in no number at all."""


@dataclass(frozen=True, slots=True)
class Similarity:
    """The map z -> a z + b of the plane taken as complex numbers; mirrored ones take the conjugate of z first.

    Attributes:
        a: size and turn. b: shift, mm.
    """

    a: complex = 1 + 0j
    b: complex = 0j
    mirrored: bool = False

    def __call__(self, point: Point) -> Point:
        """Return where a point goes.

        Raises:
            InputError: farther away than a drawing reaches.
        """
        z = complex(point[0], -point[1] if self.mirrored else point[1])
        to = self.a * z + self.b
        if not abs(to) <= _FARTHEST:
            raise InputError(f"This would lead {abs(to):g} mm away from zero; a drawing reaches {_FARTHEST:g} mm.")
        return (to.real, to.imag)

    def then(self, after: Similarity) -> Similarity:
        """Return this map and then another as one."""
        a, b = (self.a.conjugate(), self.b.conjugate()) if after.mirrored else (self.a, self.b)
        return Similarity(after.a * a, after.a * b + after.b, self.mirrored != after.mirrored)

    @property
    def scale(self) -> float:
        """How much larger everything becomes."""
        return abs(self.a)


def shift(by: Point) -> Similarity:
    """Return the shift by a vector, mm."""
    return Similarity(b=complex(*by))


def turn(centre: Point, angle: float) -> Similarity:
    """Return the turn about a centre by an angle in degrees; quarter turns are exact."""
    quarters, rest = divmod(angle, 90)
    turned = math.radians(angle)
    a = (1 + 0j, 1j, -1 + 0j, -1j)[int(quarters) % 4] if rest == 0 else complex(math.cos(turned), math.sin(turned))
    z = complex(*centre)
    return Similarity(a, z - a * z)


def scaling(centre: Point, factor: float) -> Similarity:
    """Return the enlargement about a centre.

    Raises:
        InputError: the factor is not greater than 0.
    """
    if factor <= 0:
        raise InputError(f"The factor is {factor:g}; it must be greater than 0. Mirror with mirror.")
    return Similarity(complex(factor), complex(*centre) * (1 - factor))


def mirroring(a: Point, b: Point) -> Similarity:
    """Return the mirroring about the line through two points.

    Raises:
        InputError: both points are the same.
    """
    if math.dist(a, b) < WELD:
        raise InputError("A mirror line needs two different points.")
    z, along = complex(*a), complex(b[0] - a[0], b[1] - a[1])
    square = along * along / abs(along) ** 2
    return Similarity(square, z - square * z.conjugate(), mirrored=True)


def transformed(curve: Curve, to: Similarity) -> Curve:
    """Return a curve where the map takes it, in the same direction of travel."""
    if isinstance(curve, Line):
        return Line(to(curve.start), to(curve.end))
    if isinstance(curve, Arc):
        return Arc(to(curve.start), to(curve.end), to(curve.centre), curve.ccw != to.mirrored)
    if isinstance(curve, Circle):
        to((curve.centre[0] + curve.radius, curve.centre[1]))  # refuses what reaches too far
        return Circle(to(curve.centre), curve.radius * to.scale, curve.ccw != to.mirrored)
    if isinstance(curve, Ellipse):
        return _ellipse(curve, to)
    return replace(curve, control_points=tuple(map(to, curve.control_points)))


def transformed_note(shape: Shape, to: Similarity) -> Shape:
    """Return a note where the map takes it; measures across and up change places where it turns by more than 45
    degrees.
    """
    if isinstance(shape, Mark):
        return Mark(to(shape.at))
    if isinstance(shape, Guide):
        x, y = replace(to, b=0j)((math.cos(shape.angle), math.sin(shape.angle)))
        angle = math.atan2(y, x) % math.pi
        return Guide(to(shape.through), angle if angle < math.pi else 0.0)
    points, measure = tuple(map(to, shape.points)), shape.measure
    if measure is DimensionKind.ANGLE and to.mirrored:
        points = (points[0], points[2], points[1])
    if measure in (DimensionKind.ACROSS, DimensionKind.UP) and abs(to.a.imag) > abs(to.a.real):
        measure = DimensionKind.UP if measure is DimensionKind.ACROSS else DimensionKind.ACROSS
    return replace(shape, measure=measure, points=points, place=to(shape.place))


def _ellipse(curve: Ellipse, to: Similarity) -> Ellipse:
    major = replace(to, b=0j)(curve.major)
    if major == (0.0, 0.0):
        raise InputError("An ellipse would shrink to nothing.")
    if not to.mirrored:
        return replace(curve, centre=to(curve.centre), major=major)
    return replace(
        curve,
        centre=to(curve.centre),
        major=major,
        start_parameter=-curve.end_parameter,
        end_parameter=-curve.start_parameter,
        ccw=not curve.ccw,
    )
