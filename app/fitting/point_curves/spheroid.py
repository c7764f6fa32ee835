"""The region test for any outline: a stretch of curve that is shorter than every way by its region's surface cannot
leave it.

All places of a stretch from P to Q lie in the spheroid with foci P and Q whose strings are as long as the stretch. What
is known of that length is an upper bound: its control polygon's. The spheroid lies within half its width of the chord
PQ, and that is compared with the region's outline there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .space_curve import SpaceCurve
from .tube import TubeAnswer

Floats = NDArray[np.float64]

_DEEPEST = 40
"""Halvings of a stretch, at most; what is open then is not proven."""


@dataclass(frozen=True)
class RevolvedOutline:
    """A solid of revolution about a chord, r = f(z), with a ball of radius f at either end.

    Attributes:
        radius: of a share in [0, 1] of the chord's length: mm, > 0.
        least: of two shares, first <= last: a radius, mm, that f nowhere between them falls below. Where f is concave,
            as a cylinder's or a barrel's is, the lesser of its values at the two is that; None means so.
    """

    radius: Callable[[float], float]
    least: Callable[[float, float], float] | None = None

    def lowest(self, first: float, last: float) -> float:
        """Return a radius that the outline nowhere falls below between two shares."""
        return min(self.radius(first), self.radius(last)) if self.least is None else self.least(first, last)


def lies_within(curve: SpaceCurve, points: Floats, outline: RevolvedOutline, feet: Floats) -> tuple[TubeAnswer, float]:
    """Return whether each stretch of a curve lies in its chord's region, and where one does not, its parameter.

    Args:
        curve: of any making.
        points: (n, 3) mm.
        outline: of the region round every chord.
        feet: (n,) places of the curve that answer to the points, never falling.

    References:
        JP 2014-242013, figures 6 to 8: an interval P ... Q shorter than the shortest path P, X, Q by way of any point X
            of
        the region's surface.
    """
    for i in range(len(points) - 1):
        chord = _Chord(points[i], points[i + 1], outline, curve.slack)
        low = float(feet[i])
        while low < feet[i + 1]:
            high = min(math.floor(low) + 1.0, float(feet[i + 1]))
            answer, at = _stretch(curve, chord, low, high)
            if answer is not TubeAnswer.INSIDE:
                return answer, at
            low = high
    return TubeAnswer.INSIDE, 0.0


class _Chord:
    """A chord and the region round it."""

    def __init__(self, start: Floats, end: Floats, outline: RevolvedOutline, slack: float) -> None:
        self._start, self._outline, self._slack = start, outline, slack
        self._length = float(np.linalg.norm(end - start))
        self._axis = (end - start) / self._length if self._length > 0 else np.zeros(3)

    def holds(self, place: Floats) -> bool:
        return self._holds(place, place, 0.0)

    def holds_spheroid(self, p: Floats, q: Floats, length: float) -> bool:
        """Tell whether the region surely holds the spheroid with foci p and q and strings of a length."""
        span = float(np.linalg.norm(q - p))
        return self._holds(p, q, math.sqrt(max(length**2 - span**2, 0.0)) / 2)

    def _holds(self, p: Floats, q: Floats, width: float) -> bool:
        """Tell whether all places within a width of the chord pq are in the region's body, or in one of its balls."""
        along = [float((place - self._start) @ self._axis) for place in (p, q)]
        off = max(
            float(np.linalg.norm(place - self._start - z * self._axis)) for place, z in zip((p, q), along, strict=True)
        )
        low, high = min(along) - width, max(along) + width
        if low >= 0.0 and high <= self._length and self._length > 0:
            return off + width + self._slack <= self._outline.lowest(low / self._length, high / self._length)
        ends = ((0.0, self._outline.radius(0.0)), (self._length, self._outline.radius(1.0)))
        return any(max(math.hypot(z - end, off) for z in along) + width + self._slack <= radius for end, radius in ends)


def _stretch(curve: SpaceCurve, chord: _Chord, low: float, high: float) -> tuple[TubeAnswer, float]:
    waiting = [(low, high, 0)]
    while waiting:
        a, b, depth = waiting.pop()
        control = portion_of(curve, a, b)
        for at, place in ((a, control[0]), (b, control[-1])):
            if not chord.holds(place):
                return TubeAnswer.OUTSIDE, at
        length = float(np.sum(np.linalg.norm(np.diff(control, axis=0), axis=1)))
        if chord.holds_spheroid(control[0], control[-1], length):
            continue
        if depth == _DEEPEST:
            return TubeAnswer.UNDECIDED, a
        middle = (a + b) / 2
        waiting += [(middle, b, depth + 1), (a, middle, depth + 1)]
    return TubeAnswer.INSIDE, 0.0


def portion_of(curve: SpaceCurve, a: float, b: float) -> Floats:
    """Return the control points (6, 3) of the curve between parameters a <= b of one piece."""
    from . import tube_kernels

    out = np.empty((curve.control.shape[1], 3))
    tube_kernels.portion(np.ascontiguousarray(curve.control), a, b, out)
    return out
