"""The proof of method E: a whole curve lies in the tube round a polyline, and the polyline in that round the curve.

The region round a chord is a solid of revolution, its squared radius a parabola along it: a cylinder, or a barrel that
is narrow at the points and wide between them; at the points it holds a ball of its radius there, so that neighbours
overlap at every corner. The curve is cut at feet, one a point and in order; foot i lies in the ball of point i, and the
curve between feet i and i + 1 in the region of chord i. All of it is decided by the signs of polynomials in Bernstein
form on ever smaller stretches, never by samples. Then the polyline is near the curve, too: along a chord the curve
passes every place between its feet's, and what a chord has beyond those is nearer to the foot than the point itself.

The feet are the places that "Fréchet distance" asks for: the curve is inside if there are any such, wherever they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError, ParameterError
from .space_curve import SpaceCurve

Floats = NDArray[np.float64]

_SHARE = 1e-3
"""The stated bound exceeds the largest distance found by so much of it at most."""


class TubeAnswer(Enum):
    """What the judge says; undecided counts as outside."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    UNDECIDED = "undecided"


@dataclass(frozen=True, slots=True)
class ToleranceTube:
    """The region round a polyline.

    Attributes:
        radius: at the points, mm, > 0.
        middle: half way between two points, mm, >= radius; None: the same, a cylinder. A barrel's squared radius is a
            parabola along the chord, so its outline is an arc of an ellipse.
    """

    radius: float
    middle: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.radius) and self.radius > 0):
            raise ParameterError(f"a tube of radius {self.radius:g} mm; expected one above 0.")
        if self.middle is not None and not (math.isfinite(self.middle) and self.middle >= self.radius):
            raise ParameterError(
                f"a barrel of {self.middle:g} mm between points; expected {self.radius:g} mm, that at them, or more."
            )

    @property
    def widest(self) -> float:
        """Largest radius, mm."""
        return self.radius if self.middle is None else self.middle

    @property
    def swell(self) -> float:
        """By how many times that at the points the squared radius is more half way between them."""
        return (self.widest / self.radius) ** 2 - 1.0

    def narrower(self, by: float) -> ToleranceTube:
        """Return the tube with all radii less by something, mm."""
        return ToleranceTube(self.radius - by, None if self.middle is None else self.middle - by)

    def squares(self, slack: float) -> tuple[float, float]:
        """Return squared radius at the points and what the parabola adds (4 (middle^2 - radius^2)), with all radii less
        by a slack.
        """
        end = max(self.radius - slack, 0.0) ** 2
        return end, 4 * (max(self.widest - slack, 0.0) ** 2 - end)


@dataclass(frozen=True, eq=False)
class TubeJudgement:
    """What the judge found.

    Attributes:
        answer: INSIDE only with a proof.
        bound: of the distance between curve and polyline, both ways and in order, mm: proven; inf unless inside.
        from_curve: largest distance of a place of the curve from its chord that was found, mm. Outside: that of the
            witness from the chords about there, which is less than the radius where the curve is near enough but in
            another order; where the curve ends before it has come to all points, that of its end from the next one.
        from_points: largest distance of a point from its foot, mm; inf unless inside.
        parameter: where on the curve `from_curve` was found, in [0, m].
        place: that place, mm.
        chord: number of the chord that it belongs to.
        feet: (n,) places of the curve that answer to the points, never falling; None unless inside.
    """

    answer: TubeAnswer
    bound: float
    from_curve: float
    from_points: float
    parameter: float
    place: tuple[float, float, float]
    chord: int
    feet: Floats | None = None


def judge(curve: SpaceCurve, points: Floats, tube: ToleranceTube, feet: Floats | None = None) -> TubeJudgement:
    """Return whether a whole curve and a polyline keep within a tube of one another, in order.

    Args:
        curve: of any making.
        points: (n, 3) mm, n >= 2; it runs in the same sense.
        tube: region round the polyline.
        feet: (n,) places of the curve thought to answer to the points, never falling, 0 and m the outer ones; found
            where they are not given, and where these prove nothing.

    Raises:
        GeometryError: there are fewer than two points, or something is not finite.

    References:
        JP 2014-242013: a region of solids of revolution, decided from its surface's geometry and not by samples.
        Alt and Godau (1995), "Computing the Fréchet distance between two polygonal curves": feet in order.
    """
    from . import tube_feet_kernels as kernels
    from .tube_kernels import INSIDE

    points = _checked(curve, points)
    end, swell = tube.squares(curve.slack)
    if feet is None:
        feet = np.empty(len(points))
        kernels.guess(curve.control, points, 4 * tube.widest, feet)
        kernels.settle(curve.control, points, feet)
        kernels.settle(curve.control, points, feet)
    state, _ = kernels.proven(curve.control, points, feet, end, swell)
    if state != INSIDE:
        ways, counts, left = np.empty((len(points), kernels.MOST, 2)), np.zeros(len(points), np.int64), np.zeros(1)
        state, chord = kernels.reach(curve.control, points, end, swell, ways, counts, left)
        if state != INSIDE:
            return _refused(curve, points, (end, swell), chord, float(left[0]))
        feet = np.zeros(len(points))
        kernels.step_back(curve.control, points, end, swell, ways, counts, feet)
        if kernels.proven(curve.control, points, feet, end, swell)[0] != INSIDE:
            return _refused(curve, points, (end, swell), 0, 0.0)
    return _proven(curve, points, feet, tube.widest)


def _checked(curve: SpaceCurve, points: Floats) -> Floats:
    points = np.ascontiguousarray(points, np.float64)
    if len(points) < 2:
        raise GeometryError("a polyline of fewer than two points has no tube.")
    if not (np.isfinite(points).all() and np.isfinite(curve.control).all()):
        raise GeometryError("a curve or its points have coordinates that are not finite.")
    return points


def _proven(curve: SpaceCurve, points: Floats, feet: Floats, widest: float) -> TubeJudgement:
    from . import tube_feet_kernels as kernels

    found, at, back, worst = kernels.found_apart(curve.control, points, feet)
    bound, found, at = kernels.bound_apart(curve.control, points, feet, _SHARE, (found, at, back))
    if back > found:
        at = float(feet[int(worst)])
    chord = min(max(int(np.searchsorted(feet, at, side="right")) - 1, 0), len(points) - 2)
    bound = min(bound + curve.slack, widest)
    return TubeJudgement(
        answer=TubeAnswer.INSIDE,
        bound=bound,
        from_curve=found,
        from_points=back,
        parameter=at,
        place=_place(curve, at),
        chord=chord,
        feet=feet,
    )


def _refused(
    curve: SpaceCurve, points: Floats, squares: tuple[float, float], chord: int, until: float
) -> TubeJudgement:
    """Return the witness: where the curve is farthest from the chord whose region it leaves, before it comes back to
    it, at a parameter `until`.
    """
    from . import tube_feet_kernels as kernels

    for at, end in ((0.0, 0), (float(len(curve)), len(points) - 1)):
        off = math.dist(_place(curve, at), points[end])
        if off > math.sqrt(squares[0]):
            return TubeJudgement(
                TubeAnswer.OUTSIDE, math.inf, off, math.inf, at, _place(curve, at), min(end, len(points) - 2)
            )
    at, off, out = kernels.excursion(curve.control, until, points, chord, *squares)
    return TubeJudgement(
        TubeAnswer.OUTSIDE if out else TubeAnswer.UNDECIDED, math.inf, off, math.inf, at, _place(curve, at), chord
    )


def _place(curve: SpaceCurve, at: float) -> tuple[float, float, float]:
    x, y, z = curve.at(np.array([at]))[0].tolist()
    return x, y, z
