"""Plane curves of a drawing: line, arc, circle, ellipse, spline. Lengths in mm, angles in radians."""

from __future__ import annotations

import math
from dataclasses import dataclass

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Line:
    """A straight line from `start` to `end`."""

    start: Point
    end: Point


@dataclass(frozen=True, slots=True)
class Arc:
    """A circular arc, less than a full turn, that keeps its end points exactly.

    Attributes:
        start, end: end points, mm; different from one another.
        centre: centre of the circle, mm, equally far from both ends.
        ccw: True when the arc runs counter-clockwise from start to end.
    """

    start: Point
    end: Point
    centre: Point
    ccw: bool = True

    @property
    def radius(self) -> float:
        """Mean distance of both ends from the centre, mm."""
        return (math.dist(self.start, self.centre) + math.dist(self.end, self.centre)) / 2

    @property
    def start_angle(self) -> float:
        """Angle of the start as seen from the centre, in (-pi, pi]."""
        return math.atan2(self.start[1] - self.centre[1], self.start[0] - self.centre[0])

    @property
    def sweep(self) -> float:
        """Signed angle from start to end: in (0, 2 pi) when ccw, in (-2 pi, 0) when not."""
        end = math.atan2(self.end[1] - self.centre[1], self.end[0] - self.centre[0])
        turn = (end - self.start_angle) % math.tau
        return turn if self.ccw else turn - math.tau


@dataclass(frozen=True, slots=True)
class Circle:
    """A full circle; it starts and ends at angle 0."""

    centre: Point
    radius: float
    ccw: bool = True

    @property
    def start(self) -> Point:
        """The point at angle 0."""
        return (self.centre[0] + self.radius, self.centre[1])

    @property
    def end(self) -> Point:
        """The point at angle 0."""
        return self.start


@dataclass(frozen=True, slots=True)
class Ellipse:
    """An ellipse or a part of it: centre + cos(t) major + ratio sin(t) perp(major).

    Attributes:
        centre: mm.
        major: vector from the centre to the end of the major axis, mm.
        ratio: minor / major axis, in (0, 1].
        start_parameter, end_parameter: range of t, radians; end > start; a full ellipse spans 2 pi.
        ccw: False when the direction of travel is from end_parameter to start_parameter.
    """

    centre: Point
    major: Point
    ratio: float
    start_parameter: float = 0.0
    end_parameter: float = math.tau
    ccw: bool = True

    def at(self, parameter: float) -> Point:
        """Return the point at parameter t, radians."""
        c, s = math.cos(parameter), math.sin(parameter) * self.ratio
        ax, ay = self.major
        return (self.centre[0] + c * ax - s * ay, self.centre[1] + c * ay + s * ax)

    @property
    def start(self) -> Point:
        """First point in the direction of travel."""
        return self.at(self.start_parameter if self.ccw else self.end_parameter)

    @property
    def end(self) -> Point:
        """Last point in the direction of travel."""
        return self.at(self.end_parameter if self.ccw else self.start_parameter)


@dataclass(frozen=True, slots=True)
class Spline:
    """A (rational) B-spline with a clamped knot vector.

    Attributes:
        degree: >= 1.
        control_points: at least degree + 1 points, mm.
        knots: len(control_points) + degree + 1 values, not decreasing.
        weights: one positive value a control point, or empty for a polynomial spline.
    """

    degree: int
    control_points: tuple[Point, ...]
    knots: tuple[float, ...]
    weights: tuple[float, ...] = ()

    @property
    def start(self) -> Point:
        """First control point, where a clamped spline begins."""
        return self.control_points[0]

    @property
    def end(self) -> Point:
        """Last control point, where a clamped spline ends."""
        return self.control_points[-1]


Curve = Line | Arc | Circle | Ellipse | Spline
"""Everything that can be drawn."""

Primitive = Line | Arc | Circle
"""What tool paths are computed from: ellipses and splines have become lines and arcs."""


def reversed_curve(curve: Curve) -> Curve:
    """Return the same curve, travelled the other way."""
    if isinstance(curve, Line):
        return Line(curve.end, curve.start)
    if isinstance(curve, Arc):
        return Arc(curve.end, curve.start, curve.centre, not curve.ccw)
    if isinstance(curve, Circle):
        return Circle(curve.centre, curve.radius, not curve.ccw)
    if isinstance(curve, Ellipse):
        return Ellipse(
            curve.centre, curve.major, curve.ratio, curve.start_parameter, curve.end_parameter, not curve.ccw
        )
    first, last = curve.knots[0], curve.knots[-1]
    knots = tuple(first + last - k for k in reversed(curve.knots))
    return Spline(curve.degree, curve.control_points[::-1], knots, curve.weights[::-1])
