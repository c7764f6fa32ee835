"""Section curves: tables of points, or contours of a drawing, from which surfaces are made."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from .part import Part

Point2 = tuple[float, float]
Point3 = tuple[float, float, float]

MOST_DEGREE = 9
"""Of a curve through points, at most."""


class CurveForm(Enum):
    """What the points of a table are."""

    THROUGH = "through"
    CONTROL = "control"


class Spacing(Enum):
    """How the parameters of points that a curve goes through are spaced."""

    CENTRIPETAL = "centripetal"
    CHORD_LENGTH = "chord-length"


@dataclass(frozen=True)
class SceneFiles:
    """Where the files come from that a scene names; relative names are the caller's to resolve.

    Attributes:
        data: the bytes of a file. part: the drawing in one. Both raise InputError where they cannot.
    """

    data: Callable[[str], bytes]
    part: Callable[[str], Part]


@dataclass(frozen=True)
class SectionCurve:
    """A curve in space: points of its own, or a contour of a drawing; exactly one of them.

    Attributes:
        points: (x, y, z) mm each, or (x, y) each in the placed plane.
        form: the curve goes through the points, or they are its control points.
        degree: 1 (a polyline) to MOST_DEGREE; fewer points make it lower.
        closed: back to the first point, which is not repeated; smooth there, but a polyline.
        spacing: of the parameters of points that it goes through.
        weights: one > 0 for each control point, or none: all alike.
        knots: of an open curve's control points, as many as they and degree + 1 more, or none: even ones.
        drawing: name of a file; its lines, arcs and circles are taken exactly.
        layer: the contour is on this layer, or "": on any.
        number: of the contour, from 1 on, in the order of the drawing.
        origin, x_axis, y_axis: the plane in which a plane curve lies; the axes are at right angles, of any length.
    """

    points: tuple[tuple[float, ...], ...] = ()
    form: CurveForm = CurveForm.THROUGH
    degree: int = 3
    closed: bool = False
    spacing: Spacing = Spacing.CENTRIPETAL
    weights: tuple[float, ...] = ()
    knots: tuple[float, ...] = ()
    drawing: str = ""
    layer: str = ""
    number: int = 1
    origin: Point3 = (0.0, 0.0, 0.0)
    x_axis: Point3 = (1.0, 0.0, 0.0)
    y_axis: Point3 = (0.0, 1.0, 0.0)

    def __post_init__(self) -> None:
        if bool(self.points) == bool(self.drawing):
            raise ParameterError("A section curve needs either points or a drawing, and not both; give one of them.")
        if self.points:
            self._check_points()
        if self.number < 1:
            raise ParameterError(f"Contour number is {self.number}; use 1 for the first one.")
        if not 1 <= self.degree <= MOST_DEGREE:
            raise ParameterError(f"The degree of a section curve is {self.degree}; use 1 to {MOST_DEGREE}.")
        if self.weights and (
            self.form is CurveForm.THROUGH or len(self.weights) != len(self.points) or min(self.weights) <= 0
        ):
            raise ParameterError(
                'Weights belong to control points, one greater than 0 each; set form = "control", or take them out.'
            )
        if self.knots:
            self._check_knots()
        check_axes(self.x_axis, self.y_axis)

    def _check_knots(self) -> None:
        knots, degree, count = self.knots, self.degree, len(self.points)
        if self.form is CurveForm.THROUGH or self.closed or count <= degree:
            raise ParameterError(
                'Knots belong to more control points than the degree, of an open curve; set form = "control", '
                "or take them out."
            )
        if (
            len(knots) != count + degree + 1
            or list(knots) != sorted(knots)
            or not all(abs(knot) < 1e9 for knot in knots)
        ):
            raise ParameterError(
                f"Knots of a section curve are {len(knots)}; give {count + degree + 1} that do not fall, or none."
            )
        if not knots[0] == knots[degree] < knots[count] == knots[-1]:
            raise ParameterError(
                f"Knots of a section curve are not clamped; repeat the first and the last one {degree + 1} times."
            )

    def _check_points(self) -> None:
        sizes = {len(point) for point in self.points}
        if sizes not in ({2}, {3}) or not all(abs(value) < 1e9 for point in self.points for value in point):
            raise ParameterError(
                "Points of a section curve must all have two coordinates, or all three, each less than 1000000000 mm."
            )
        least = 3 if self.closed else 2
        if len(self.points) < least:
            raise ParameterError(
                f"{'A closed' if self.closed else 'An open'} section curve has {len(self.points)} points; "
                f"it needs {least} or more."
            )
        if self.form is CurveForm.THROUGH:
            after = (*self.points[1:], self.points[0]) if self.closed else self.points[1:]
            for one, other in zip(self.points, after, strict=False):
                if one == other:
                    raise ParameterError(
                        f"Two neighbouring points of a section curve are alike, {said(one)}; take one out."
                    )


def said(point: tuple[float, ...]) -> str:
    """Return a point in words."""
    return ", ".join(f"{value:g}" for value in point)


def check_axes(x_axis: Point3, y_axis: Point3) -> None:
    """Refuse axes that are not at right angles.

    Raises:
        ParameterError: they are not, or one has no length.
    """
    long, wide = math.hypot(*x_axis), math.hypot(*y_axis)
    if not (0 < long < 1e9 and 0 < wide < 1e9):
        raise ParameterError("An axis has no length; give it as a direction such as [1, 0, 0].")
    if abs(sum(a * b for a, b in zip(x_axis, y_axis, strict=True))) > 1e-9 * long * wide:
        raise ParameterError(
            f"The axes {said(x_axis)} and {said(y_axis)} are not at right angles; correct one of them."
        )
