"""Splines in NC programs as curves: G5, G5.1, G5.2 with G5.3 (LinuxCNC), G6.2 (Fanuc). Lengths in mm, program
coordinates.

Behaviour: LinuxCNC's G code reference and the points that its interpreter (2.9.0~pre1) drives through; the Fanuc 30i
operator's manual, chapter on NURBS interpolation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...model.motion import Nurbs, Plane
from .program import BlockFault

Point = tuple[float, float, float]
Offset = tuple[float, float]

MOST_ORDER = 20
"""Controls know orders up to 4 (Fanuc), or do not say (LinuxCNC)."""
WEIGHTS = (1e-6, 1e6)
"""Weights outside of this range are a slip of the pen: the curve would hug a single point."""
NEAR_ENOUGH = 0.01
"""The first control point of G6.2 may lie this far from where the tool is, mm: digits of a post."""


def check_plane(plane: Plane) -> None:
    """Refuse a G5, G5.1 or G5.2 outside of the XY plane.

    Raises:
        Fault: the plane is another one.
    """
    if plane is not Plane.XY:
        raise BlockFault("splines lie in the XY plane; G17 was expected before.")


def cubic(start: Point, end: Point, first: Offset, second: Offset) -> Nurbs:
    """Return the curve of G5.

    Args:
        first: I, J, from the start to the first control point. Where the block has neither, the end of the last G5 goes
            on smoothly: minus its P, Q, also over other motions; (0, 0) where there was none.
        second: P, Q, from the end to the second control point.
    """
    return _bezier([start, _beside(start, first), _beside(end, second), end])


def quadratic(start: Point, end: Point, middle: Offset) -> Nurbs:
    """Return the curve of G5.1.

    Args:
        middle: I, J, from the start to the control point; a word that is missing counts as 0.
    """
    return _bezier([start, _beside(start, middle), end])


def first_offset(i: float | None, j: float | None, before: Offset) -> Offset:
    """Return I, J of a G5: its own, or those that go on from the G5 before.

    Args:
        before: P, Q of the last G5; (0, 0) where there was none.

    Raises:
        Fault: only one of them is given.
    """
    if i is None and j is None:
        return -before[0], -before[1]
    return _both(i, j, "IJ")


def second_offset(p: float | None, q: float | None) -> Offset:
    """Return P, Q of a G5.

    Raises:
        Fault: one of them is missing.
    """
    return _both(p, q, "PQ")


def _both(one: float | None, other: float | None, letters: str) -> Offset:
    if one is None or other is None:
        missing = letters[0] if one is None else letters[1]
        raise BlockFault(f"the spline has no {missing} word; {letters[0]} and {letters[1]} go together.", missing)
    return one, other


def _beside(point: Point, offset: Offset) -> Point:
    return point[0] + offset[0], point[1] + offset[1], point[2]


def _bezier(points: Sequence[Point]) -> Nurbs:
    return _clamped(points, [1.0] * len(points), len(points))


def _clamped(points: Sequence[Point], weights: Sequence[float], order: int) -> Nurbs:
    """Return the curve with knots at equal distances, those at the ends as often as the order."""
    last = len(points) - order + 1
    knots = [0.0] * order + [float(k) for k in range(1, last)] + [float(last)] * order
    return Nurbs(np.array(points), np.array(weights), np.array(knots), order - 1)


def _checked_weight(weight: float, letter: str) -> float:
    if not WEIGHTS[0] <= weight <= WEIGHTS[1]:
        raise BlockFault(f"a weight of {weight:g}; expected one from {WEIGHTS[0]:g} to {WEIGHTS[1]:g}.", letter)
    return weight


def _checked_order(order: int, letter: str) -> int:
    if order > MOST_ORDER:
        raise BlockFault(f"a spline of order {order}; orders up to {MOST_ORDER} are read.", letter)
    return order


class OpenNurbs:
    """The control points of G5.2, from its first block to G5.3; another motion word in between drops them.

    The first is where the tool stands; X and Y of G91 count from there for all of them, and Z is taken for none.
    """

    def __init__(self, start: Point) -> None:
        """Begin at where the tool stands."""
        self._points, self._weights = [start], [1.0]
        self._order = 3
        self._begun = False

    def add(self, x: float | None, y: float | None, weight: float | None, order: int | None = None) -> None:
        """Take a block: P alone in the first one is the weight of the start.

        Args:
            x, y: the control point.
            weight: P.
            order: L; the largest of all blocks counts, and 3 at least.

        Raises:
            Fault: a coordinate or the weight is missing or out of range.
        """
        first, self._begun = not self._begun, True
        self._order = max(self._order, _checked_order(order or 0, "L"))
        if first and x is None and y is None:
            self._weights[0] = 1.0 if weight is None else _checked_weight(weight, "P")
            return
        if x is None or y is None:
            raise BlockFault("a control point of a spline needs both X and Y.", "X" if x is None else "Y")
        if weight is None:
            raise BlockFault("the control point has no weight; a P word above 0 was expected.", "P")
        self._points.append((x, y, self._points[0][2]))
        self._weights.append(_checked_weight(weight, "P"))

    def closed(self) -> Nurbs:
        """Return the curve at G5.3.

        Raises:
            Fault: there are fewer control points than the order.
        """
        if len(self._points) < self._order:
            raise BlockFault(
                f"a spline of order {self._order} needs as many control points, and has {len(self._points)}."
            )
        return _clamped(self._points, self._weights, self._order)


class OpenFanucNurbs:
    """The control points and knots of G6.2: every block has a knot; the last ones, as many as the order, only a
    knot.
    """

    def __init__(self, start: Point, order: int | None = None) -> None:
        """Begin at where the tool stands.

        Args:
            order: P; 4 where it is missing.

        Raises:
            Fault: the order is out of range.
        """
        self._start, self._order = start, _checked_order(4 if order is None else order, "P")
        if self._order < 2:
            raise BlockFault(f"a spline of order {self._order}; P counts from 2.", "P")
        self._points: list[Point] = []
        self._weights: list[float] = []
        self._knots: list[float] = []

    @property
    def place(self) -> Point:
        """The last control point: what axes that a block leaves out stay at."""
        return self._points[-1] if self._points else self._start

    @property
    def complete(self) -> bool:
        """Whether all knots are there, so that the curve can be had."""
        return len(self._knots) > len(self._points) and len(self._knots) == len(self._points) + self._order

    def add(self, point: Point | None, knot: float | None, weight: float | None = None) -> None:
        """Take a block.

        Args:
            point: the control point, None in a block that has no axis word (but for the first: the tool's own place).
            knot: K.
            weight: R; 1 where it is missing.

        Raises:
            Fault: the knot is missing or falls, the weight is out of range, a point comes after a block with a knot
                alone, or the first point is not where the tool stands.
        """
        if knot is None:
            raise BlockFault("every block of the spline needs a knot (K).", "K")
        if not math.isfinite(knot) or (self._knots and knot < self._knots[-1]):
            raise BlockFault(f"the knots of a spline never fall; {knot:g} comes after {self._knots[-1]:g}.", "K")
        if point is None and not self._knots:
            point = self._start
        if point is not None:
            self._take(point, 1.0 if weight is None else _checked_weight(weight, "R"))
        self._knots.append(knot)

    def _take(self, point: Point, weight: float) -> None:
        if len(self._knots) > len(self._points):
            raise BlockFault("a control point comes after blocks with a knot alone, which end the spline.")
        if not self._points and math.dist(point, self._start) > NEAR_ENOUGH:
            raise BlockFault("the first control point of the spline is not where the tool is.")
        self._points.append(point)
        self._weights.append(weight)

    def closed(self) -> Nurbs:
        """Return the curve.

        Raises:
            Fault: points or knots are missing, the ends are not clamped, or a knot comes more often than the order
                allows.
        """
        count, order = len(self._points), self._order
        if not self.complete or count < order:
            raise BlockFault(
                f"the spline of order {order} has {count} control points and {len(self._knots)} knots; expected "
                f"{order} points or more, and {order} knots more than points."
            )
        knots = np.array(self._knots)
        if knots[0] != knots[order - 1] or knots[-1] != knots[count]:
            raise BlockFault(
                f"the first {order} knots of the spline, and the last {order}, must be alike: it begins and ends at a "
                "point.",
                "K",
            )
        if np.any(knots[1:count] == knots[order : count + order - 1]):
            raise BlockFault(f"a knot comes more than {order - 1} times within the spline, which would break it.", "K")
        points = [self._start, *self._points[1:]]
        return Nurbs(np.array(points), np.array(self._weights), knots, order - 1)
