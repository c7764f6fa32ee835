"""Where a proven curve and its polyline are how far apart, and how much the curve bends: samples for people, no
proof.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .space_curve import DEGREE, SpaceCurve

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LEAST, _MOST = 4, 32
"""Samples between two feet."""
_SAMPLES = 200_000
"""Of a whole curve, about, unless it has very many feet."""


@dataclass(frozen=True, eq=False)
class Deviation:
    """k samples along a curve.

    Attributes:
        along: (k,) where they are, mm along the polyline, never falling.
        off: (k,) distance from the chord that answers to them, at feet from the point, mm.
        place: (k, 3) on the curve, mm.
        chord: (k,) number of that chord.
    """

    along: Floats
    off: Floats
    place: Floats
    chord: Ints


def deviation(curve: SpaceCurve, points: Floats, feet: Floats) -> Deviation:
    """Return how far a curve is from a polyline all along.

    Args:
        curve: what was judged.
        points: (n, 3) mm, n >= 2, no two in a row alike.
        feet: (n,) places of the curve that answer to the points, as the judgement has them.
    """
    count = len(points) - 1
    per = int(np.clip(_SAMPLES // count, _LEAST, _MOST))
    at = np.append((feet[:-1, None] + np.diff(feet)[:, None] * (np.arange(per) / per)).ravel(), feet[-1])
    chord = np.minimum(np.arange(len(at)) // per, count - 1)
    place = curve.at(at)
    step = np.diff(points, axis=0)
    size = np.linalg.norm(step, axis=1)
    share = np.clip(np.einsum("ij,ij->i", place - points[chord], step[chord]) / size[chord] ** 2, 0.0, 1.0)
    off = np.linalg.norm(points[chord] + share[:, None] * step[chord] - place, axis=1)
    off[::per] = np.linalg.norm(points - place[::per], axis=1)
    begin = np.concatenate([[0.0], np.cumsum(size)])
    return Deviation(np.maximum.accumulate(begin[chord] + share * size[chord]), off, place, chord)


def curvature(curve: SpaceCurve, per_piece: int) -> tuple[Floats, Floats]:
    """Return places (k, 3) along a curve, mm, and its curvature there as vectors (k, 3) towards the centre, 1/mm.

    Args:
        curve: of m pieces; where it stands still it has none.
        per_piece: places in each of them, the last one of the curve besides.
    """
    at = np.append((np.arange(len(curve))[:, None] + np.arange(per_piece) / per_piece).ravel(), float(len(curve)))
    piece = np.minimum(at.astype(np.int64), len(curve) - 1)
    first = DEGREE * np.diff(curve.control, axis=1)
    second = (DEGREE - 1) * np.diff(first, axis=1)
    speed, bend = (_valued(control[piece], at - piece) for control in (first, second))
    square = np.einsum("ij,ij->i", speed, speed)[:, None]
    safe = np.where(square > 0, square, np.inf)
    across: Floats = (bend - speed * (np.einsum("ij,ij->i", bend, speed)[:, None] / safe)) / safe
    return curve.at(at), across


def _valued(control: Floats, t: Floats) -> Floats:
    """Return the values (k, 3) of Bézier pieces (k, p + 1, 3), one each."""
    share = t[:, None, None]
    while control.shape[1] > 1:
        control = control[:, :-1] * (1 - share) + control[:, 1:] * share
    values: Floats = control[:, 0]
    return values
