"""Splines that a translation brings onto one another, as equal letters are: their lines and arcs are found once."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import NamedTuple

from ...core import tolerances
from ...model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline
from .arcs import LinesAndArcs, equally_far, lines_and_arcs

_DIGITS = 9
"""Of mm, to which control points are alike: far below what curves are drawn with, far above what a sum rounds off."""

_APART = 2 * 10.0**-_DIGITS
"""mm; how much farther a curve may be from the moved arcs than the first one was from its own."""


class _FirstSpline(NamedTuple):
    begin: Point
    made: LinesAndArcs


class ArcsByShape:
    """The lines and arcs of curves. What was found for one spline is moved for those that are alike."""

    def __init__(self) -> None:
        """Know none yet."""
        self._known: dict[Hashable, _FirstSpline] = {}

    def of(self, curve: Ellipse | Spline) -> LinesAndArcs:
        """Return lines and arcs near a curve, and how near; see `lines_and_arcs`.

        Raises:
            GeometryError: the curve has values that are not finite, or cannot be followed.
        """
        if isinstance(curve, Ellipse):
            return lines_and_arcs(curve)
        x, y = curve.start
        points = tuple((round(px - x, _DIGITS), round(py - y, _DIGITS)) for px, py in curve.control_points)
        shape = (curve.degree, curve.knots, curve.weights, points)
        if (known := self._known.get(shape)) is not None:
            return _moved(known, curve)
        made = lines_and_arcs(curve)
        self._known[shape] = _FirstSpline(curve.start, made)
        return made


def _moved(first: _FirstSpline, curve: Spline) -> LinesAndArcs:
    """Return what was made of one spline where another one is, with the ends that this one has."""
    dx, dy = curve.start[0] - first.begin[0], curve.start[1] - first.begin[1]
    closed = math.dist(curve.start, curve.end) < tolerances.WELD
    last = curve.start if closed else curve.end
    made, at = list[Primitive](), curve.start
    for k, each in enumerate(first.made.primitives):
        if isinstance(each, Circle):
            made.append(Circle((each.centre[0] + dx, each.centre[1] + dy), each.radius, each.ccw))
            continue
        end = last if k == len(first.made.primitives) - 1 else (each.end[0] + dx, each.end[1] + dy)
        if isinstance(each, Arc):
            centre = equally_far(at, end, (each.centre[0] + dx, each.centre[1] + dy))
            made.append(Arc(at, end, centre, each.ccw))
        else:
            made.append(Line(at, end))
        at = end
    return LinesAndArcs(tuple(made), first.made.deviation + _APART)
