"""Splines that a translation brings onto one another, as equal letters are: their lines and arcs are found once."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.errors import GeometryError
from ...core.pool import in_bands
from ...model.curves import Arc, Circle, Ellipse, Line, Point, Primitive, Spline
from .arcs import LinesAndArcs, lines_and_arcs

_DIGITS = 9
"""Of mm, to which control points are alike: far below what curves are drawn with, far above what a sum rounds off."""

_APART = 2 * 10.0**-_DIGITS
"""mm; how much farther a curve may be from the moved arcs than the first one was from its own."""


_WORTH_TWO_CORES = 64
"""Curves from which a second core is worth its start: half of the time of each is compiled code."""

Bent = Ellipse | Spline

Floats = NDArray[np.float64]


def arcs_of_all(curves: Sequence[Bent]) -> list[LinesAndArcs | GeometryError]:
    """Return for each curve lines and arcs near it, and how near, or why there are none; see `lines_and_arcs`.

    What was found for one spline is moved for those that are alike. Many curves are worked on by all cores.
    """
    first: dict[Hashable, int] = {}
    like = [first.setdefault(_shape(curve, k), k) for k, curve in enumerate(curves)]
    alone = list(first.values())
    bands = in_bands(lambda band: [_made(curves[k]) for k in alone[band]], len(alone), _WORTH_TWO_CORES)
    made = dict(zip(alone, chain.from_iterable(bands), strict=True))
    for k, others in _followers(like).items():
        made.update(zip(others, _like(curves[k], made[k], [curves[mine] for mine in others]), strict=True))
    return [made[k] for k in range(len(curves))]


def _followers(like: Sequence[int]) -> dict[int, list[int]]:
    """Return which others are like each curve that some are like, by their numbers."""
    found: dict[int, list[int]] = {}
    for mine, k in enumerate(like):
        if k != mine:
            found.setdefault(k, []).append(mine)
    return found


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


def _like(
    first: Bent, made: LinesAndArcs | GeometryError, curves: Sequence[Bent]
) -> Sequence[LinesAndArcs | GeometryError]:
    """Return what was made of one spline for others that are alike; an error speaks of its own curve."""
    if isinstance(made, GeometryError):
        return [_made(curve) for curve in curves]
    return _moved(first.start, made, curves)


def _moved(begin: Point, first: LinesAndArcs, curves: Sequence[Bent]) -> list[LinesAndArcs]:
    """Return what was made of one spline where others are, with the ends that these have."""
    starts = np.array([curve.start for curve in curves])
    shift = (starts - np.array(begin))[:, None]
    ends = np.array([each.end for each in first.primitives]) + shift
    ends[:, -1] = [
        curve.start if math.dist(curve.start, curve.end) < tolerances.WELD else curve.end for curve in curves
    ]
    begins = np.concatenate([starts[:, None], ends[:, :-1]], axis=1)
    centres = np.array([each.start if isinstance(each, Line) else each.centre for each in first.primitives]) + shift
    between = [isinstance(each, Arc) for each in first.primitives]
    centres[:, between] = _equally_far(begins[:, between], ends[:, between], centres[:, between])
    deviation = first.deviation + _APART
    return [
        LinesAndArcs(tuple(map(_between, first.primitives, *places)), deviation)
        for places in zip(begins.tolist(), ends.tolist(), centres.tolist(), strict=True)
    ]


def _equally_far(starts: Floats, ends: Floats, centres: Floats) -> Floats:
    """Return `equally_far` of many places (..., 2) at once, to the last digit."""
    chord, off = ends - starts, centres - (starts + ends) / 2
    dx, dy = chord[..., 0], chord[..., 1]
    along = (off[..., 0] * dx + off[..., 1] * dy) / (dx * dx + dy * dy)
    moved: Floats = centres - along[..., None] * chord
    return moved


def _between(each: Primitive, start: list[float], end: list[float], centre: list[float]) -> Primitive:
    """Return a primitive from one place to another, about a centre where it is no line."""
    (ax, ay), (bx, by), (x, y) = start, end, centre
    if isinstance(each, Line):
        return Line((ax, ay), (bx, by))
    if isinstance(each, Circle):
        return Circle((x, y), each.radius, each.ccw)
    return Arc((ax, ay), (bx, by), (x, y), each.ccw)
