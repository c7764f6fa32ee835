"""Splines that a translation brings onto one another, as equal letters are: their lines and arcs are found once."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from itertools import chain

from ...core import tolerances
from ...core.errors import GeometryError
from ...core.pool import in_bands
from ...model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline
from .arcs import LinesAndArcs, equally_far, lines_and_arcs

_DIGITS = 9
"""Of mm, to which control points are alike: far below what curves are drawn with, far above what a sum rounds off."""

_APART = 2 * 10.0**-_DIGITS
"""mm; how much farther a curve may be from the moved arcs than the first one was from its own."""


_WORTH_TWO_CORES = 64
"""Curves from which a second core is worth its start: half of the time of each is compiled code."""

Bent = Ellipse | Spline


def arcs_of_all(curves: Sequence[Bent]) -> list[LinesAndArcs | GeometryError]:
    """Return for each curve lines and arcs near it, and how near, or why there are none; see `lines_and_arcs`.

    What was found for one spline is moved for those that are alike. Many curves are worked on by all cores.
    """
    first: dict[Hashable, int] = {}
    like = [first.setdefault(_shape(curve, k), k) for k, curve in enumerate(curves)]
    alone = list(first.values())
    bands = in_bands(lambda band: [_made(curves[k]) for k in alone[band]], len(alone), _WORTH_TWO_CORES)
    made = dict(zip(alone, chain.from_iterable(bands), strict=True))
    return [made[k] if k == mine else _like(curves[k], made[k], curves[mine]) for mine, k in enumerate(like)]


def _shape(curve: Bent, number: int) -> Hashable:
    """Return what splines that are alike have in common; of any other curve its number."""
    if isinstance(curve, Ellipse):
        return number
    x, y = curve.start
    points = tuple((round(px - x, _DIGITS), round(py - y, _DIGITS)) for px, py in curve.control_points)
    return curve.degree, curve.knots, curve.weights, points


def _made(curve: Bent) -> LinesAndArcs | GeometryError:
    try:
        return lines_and_arcs(curve)
    except GeometryError as error:
        return error


def _like(first: Bent, made: LinesAndArcs | GeometryError, curve: Bent) -> LinesAndArcs | GeometryError:
    """Return what was made of one spline for another that is alike; an error speaks of its own curve."""
    if isinstance(made, GeometryError) or isinstance(curve, Ellipse):
        return _made(curve)
    return _moved(first.start, made, curve)


def _moved(begin: Point, first: LinesAndArcs, curve: Spline) -> LinesAndArcs:
    """Return what was made of one spline where another one is, with the ends that this one has."""
    dx, dy = curve.start[0] - begin[0], curve.start[1] - begin[1]
    closed = math.dist(curve.start, curve.end) < tolerances.WELD
    last = curve.start if closed else curve.end
    made, at = list[Primitive](), curve.start
    for k, each in enumerate(first.primitives):
        if isinstance(each, Circle):
            made.append(Circle((each.centre[0] + dx, each.centre[1] + dy), each.radius, each.ccw))
            continue
        end = last if k == len(first.primitives) - 1 else (each.end[0] + dx, each.end[1] + dy)
        if isinstance(each, Arc):
            centre = equally_far(at, end, (each.centre[0] + dx, each.centre[1] + dy))
            made.append(Arc(at, end, centre, each.ccw))
        else:
            made.append(Line(at, end))
        at = end
    return LinesAndArcs(tuple(made), first.deviation + _APART)
