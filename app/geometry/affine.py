"""Move, turn, mirror and scale curves; circles under unequal scales become ellipses."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline

_EDGE_ON = 1e-9
"""A circle flattened below this ratio of its axes is seen edge-on and has no area left."""

_MANY = 50
"""Points from which on they are worth an array."""


@dataclass(frozen=True, slots=True)
class Affine:
    """The map x' = xx x + xy y + x0, y' = yx x + yy y + y0."""

    xx: float = 1.0
    xy: float = 0.0
    yx: float = 0.0
    yy: float = 1.0
    x0: float = 0.0
    y0: float = 0.0

    def point(self, p: Point) -> Point:
        """Return where a point goes."""
        return self.xx * p[0] + self.xy * p[1] + self.x0, self.yx * p[0] + self.yy * p[1] + self.y0

    def points(self, points: tuple[Point, ...]) -> tuple[Point, ...]:
        """Return where points go; of many, to the same bit, in a tenth of the time."""
        if len(points) < _MANY:
            return tuple(map(self.point, points))
        x, y = np.array(points).T
        with np.errstate(all="ignore"):
            moved = (self.xx * x + self.xy * y + self.x0).tolist(), (self.yx * x + self.yy * y + self.y0).tolist()
        return tuple(zip(*moved, strict=True))

    def vector(self, v: Point) -> Point:
        """Return where a difference of points goes."""
        return self.xx * v[0] + self.xy * v[1], self.yx * v[0] + self.yy * v[1]

    def after(self, first: Affine) -> Affine:
        """Return the map that applies `first` and then this one."""
        x0, y0 = self.point((first.x0, first.y0))
        return Affine(
            self.xx * first.xx + self.xy * first.yx,
            self.xx * first.xy + self.xy * first.yy,
            self.yx * first.xx + self.yy * first.yx,
            self.yx * first.xy + self.yy * first.yy,
            x0,
            y0,
        )

    @property
    def mirrors(self) -> bool:
        """True when counter-clockwise becomes clockwise."""
        return self.xx * self.yy - self.xy * self.yx < 0

    @property
    def keeps_circles(self) -> bool:
        """True when lengths in all directions grow alike."""
        slack = 1e-12 * max(abs(self.xx), abs(self.xy), abs(self.yx), abs(self.yy))
        same = abs(self.xx - self.yy) <= slack and abs(self.xy + self.yx) <= slack
        return same or (abs(self.xx + self.yy) <= slack and abs(self.xy - self.yx) <= slack)


IDENTITY = Affine()


def scaled(factor: float) -> Affine:
    """Return the map that multiplies all lengths by a factor."""
    return Affine(factor, 0.0, 0.0, factor)


def transformed(curve: Curve, to: Affine) -> Curve | None:
    """Return the curve under the map; None for a circle or an ellipse that is seen edge-on."""
    if isinstance(curve, Line):
        return Line(to.point(curve.start), to.point(curve.end))
    if isinstance(curve, Spline):
        return Spline(curve.degree, to.points(curve.control_points), curve.knots, curve.weights)
    if isinstance(curve, Ellipse):
        minor = (-curve.major[1] * curve.ratio, curve.major[0] * curve.ratio)
        axes = to.point(curve.centre), to.vector(curve.major), to.vector(minor)
        return ellipse(axes, curve.start_parameter, curve.end_parameter, curve.ccw)
    if to.keeps_circles:
        ccw = curve.ccw != to.mirrors
        if isinstance(curve, Arc):
            return Arc(to.point(curve.start), to.point(curve.end), to.point(curve.centre), ccw)
        return Circle(to.point(curve.centre), curve.radius * math.hypot(to.xx, to.yx), ccw)
    axes = to.point(curve.centre), to.vector((curve.radius, 0.0)), to.vector((0.0, curve.radius))
    if isinstance(curve, Circle):
        return ellipse(axes, 0.0, math.tau, curve.ccw)
    first, last = sorted((curve.start_angle, curve.start_angle + curve.sweep))
    return ellipse(axes, first, last, curve.ccw)


def ellipse(axes: tuple[Point, Point, Point], first: float, last: float, ccw: bool = True) -> Ellipse | None:
    """Return the ellipse centre + cos(t) u + sin(t) v for t from first to last.

    Args:
        axes: centre and two conjugate half-diameters u and v, mm, not square to one another in general.
        first, last: range of t, radians, first < last.
        ccw: travelled from first to last.
    """
    centre, (ux, uy), (vx, vy) = axes
    turn = math.atan2(2 * (ux * vx + uy * vy), ux * ux + uy * uy - vx * vx - vy * vy) / 2
    c, s = math.cos(turn), math.sin(turn)
    major, minor = (c * ux + s * vx, c * uy + s * vy), (c * vx - s * ux, c * vy - s * uy)
    long = math.hypot(*major)
    if not long > 0 or not math.hypot(*minor) > _EDGE_ON * long:
        return None
    ratio = min(math.hypot(*minor) / long, 1.0)
    first, last = first - turn, last - turn
    if major[0] * minor[1] - major[1] * minor[0] < 0:
        first, last, ccw = -last, -first, not ccw
    return Ellipse(centre, major, ratio, first, last, ccw)
