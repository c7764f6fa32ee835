"""Shapes of surfaces: what each is given by. Lengths in mm; angles in degrees, as they are entered."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from enum import Enum
from typing import ClassVar

from ..core.errors import ParameterError
from .scene_curves import MOST_DEGREE, Point2, Point3, SectionCurve, said

MOST_LENGTH = 1e6
"""mm; no shape is larger, or farther away."""

Turn = Point2
"""From and to, degrees, counter-clockwise about the axis; up to a full turn. 0 is the upper side of an axis that is not
upright, else the side towards +X.
"""


class ProfileOrientation(Enum):
    """How a profile goes along a guide: parallel to itself, or turning with it, but not about it."""

    PARALLEL = "parallel"
    FOLLOW = "follow"


class _CheckedShape:
    """Numbers of a shape are finite, turns are up to a full one."""

    kind: ClassVar[str] = ""

    def __post_init__(self) -> None:
        for each in fields(self):  # type: ignore[arg-type]
            value = getattr(self, each.name)
            if each.name == "turn_deg":
                _check_turn(value)
            elif not all(abs(number) < MOST_LENGTH for number in _numbers(value)):
                raise self._wrong(f"{each.name} holds a number that is too large", f"stay within {MOST_LENGTH:g} mm")
        self._check()

    def _check(self) -> None:
        """Refuse what else is wrong."""

    def _wrong(self, what: str, do: str) -> ParameterError:
        return ParameterError(f"A {self.kind}'s {what}; {do}.")

    def _positive(self, name: str) -> None:
        if not getattr(self, name) > 0:
            raise self._wrong(f"{name} is {getattr(self, name):g} mm", "it must be greater than 0")

    def _apart(self, start: Point3, end: Point3) -> None:
        if start == end:
            raise self._wrong(f"axis begins and ends at {said(start)}", "give two places")

    def _direction(self, axis: Point3) -> None:
        if not math.hypot(*axis) > 0:
            raise self._wrong("axis has no length", "give it as a direction such as [0, 0, 1]")


def _numbers(value: object) -> list[float]:
    if isinstance(value, tuple):
        return [number for part in value for number in _numbers(part)]
    return [float(value)] if isinstance(value, (int, float)) else []


def _check_turn(turn: Turn) -> None:
    start, end = turn
    if not (abs(start) <= 720 and 0 < end - start <= 360):
        raise ParameterError(f"A turn goes from {start:g} to {end:g} degrees; it must go up, by 360 degrees at most.")


@dataclass(frozen=True)
class PlaneShape(_CheckedShape):
    """A parallelogram: a corner, and the edges from there."""

    kind: ClassVar[str] = "plane"
    corner: Point3
    along: Point3
    across: Point3

    def _check(self) -> None:
        a, b = self.along, self.across
        normal = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        if not math.hypot(*normal) > 1e-12 * math.hypot(*a) * math.hypot(*b):
            raise self._wrong(f"edges {said(a)} and {said(b)} are parallel or have no length", "change one of them")


@dataclass(frozen=True)
class SphereShape(_CheckedShape):
    """A whole sphere, centre and radius in mm; its poles lie along Z."""

    kind: ClassVar[str] = "sphere"
    centre: Point3
    radius: float

    def _check(self) -> None:
        self._positive("radius")


@dataclass(frozen=True)
class CylinderShape(_CheckedShape):
    """A cylinder without its ends, or a part of its turn."""

    kind: ClassVar[str] = "cylinder"
    start: Point3
    end: Point3
    radius: float
    turn_deg: Turn = (0.0, 360.0)

    def _check(self) -> None:
        self._positive("radius")
        self._apart(self.start, self.end)


@dataclass(frozen=True)
class ConeShape(_CheckedShape):
    """A cone or a frustum without its ends; a radius of 0 is a tip."""

    kind: ClassVar[str] = "cone"
    start: Point3
    end: Point3
    start_radius: float
    end_radius: float
    turn_deg: Turn = (0.0, 360.0)

    def _check(self) -> None:
        self._apart(self.start, self.end)
        if min(self.start_radius, self.end_radius) < 0 or max(self.start_radius, self.end_radius) == 0:
            raise self._wrong(
                f"radii are {self.start_radius:g} and {self.end_radius:g} mm", "use 0 or more, and not 0 for both"
            )


@dataclass(frozen=True)
class TorusShape(_CheckedShape):
    """A torus: the centre line's radius is `major`, that of the tube `minor`, less than it."""

    kind: ClassVar[str] = "torus"
    centre: Point3
    major: float
    minor: float
    axis: Point3 = (0.0, 0.0, 1.0)

    def _check(self) -> None:
        self._positive("minor")
        self._direction(self.axis)
        if not self.minor < self.major:
            raise self._wrong(
                f"minor radius is {self.minor:g} mm", f"it must be less than the major one, {self.major:g} mm"
            )


@dataclass(frozen=True)
class BilinearShape(_CheckedShape):
    """The surface that two pairs of straight lines span: four corners, in order round it."""

    kind: ClassVar[str] = "bilinear"
    corners: tuple[Point3, ...]

    def _check(self) -> None:
        if len(self.corners) != 4:
            raise self._wrong(f"corners are {len(self.corners)}", "give 4, in order round it")


@dataclass(frozen=True)
class BicubicShape(_CheckedShape):
    """A bicubic Bézier patch: 4 rows of 4 control points."""

    kind: ClassVar[str] = "bicubic"
    points: tuple[tuple[Point3, ...], ...]

    def _check(self) -> None:
        if [len(row) for row in self.points] != [4, 4, 4, 4]:
            raise self._wrong(f"rows have {', '.join(str(len(row)) for row in self.points)} points", "give 4 rows of 4")


@dataclass(frozen=True)
class BsplineShape(_CheckedShape):
    """A B-spline surface: rows along u of control points along v; knots are spread evenly, and weights alike, where not
    given.
    """

    kind: ClassVar[str] = "bspline"
    points: tuple[tuple[Point3, ...], ...]
    degree_u: int = 3
    degree_v: int = 3
    knots_u: tuple[float, ...] = ()
    knots_v: tuple[float, ...] = ()
    weights: tuple[tuple[float, ...], ...] = ()

    def _check(self) -> None:
        widths = {len(row) for row in self.points}
        if len(widths) != 1:
            raise self._wrong("rows have different numbers of points", "give each as many as the first")
        for way, count in (("u", len(self.points)), ("v", widths.pop())):
            degree, knots = getattr(self, f"degree_{way}"), getattr(self, f"knots_{way}")
            if not 1 <= degree <= min(MOST_DEGREE, count - 1):
                raise self._wrong(
                    f"degree_{way} is {degree} with {count} points",
                    f"use 1 to {min(MOST_DEGREE, count - 1)}, or more points",
                )
            if knots and (len(knots) != count + degree + 1 or list(knots) != sorted(knots)):
                raise self._wrong(
                    f"knots_{way} are {len(knots)}", f"give {count + degree + 1} that do not fall, or none"
                )
            if knots and not (knots[0] == knots[degree] < knots[count] == knots[-1]):
                raise self._wrong(
                    f"knots_{way} are not clamped", f"repeat the first and the last one {degree + 1} times"
                )
        if self.weights and [len(row) for row in self.weights] != [len(row) for row in self.points]:
            raise self._wrong("weights are not as many as the points", "give one for each, or none")
        if not all(weight > 0 for row in self.weights for weight in row):
            raise self._wrong("weights are not all greater than 0", "correct them")


@dataclass(frozen=True)
class LoftShape(_CheckedShape):
    """A smooth surface through section curves, in their order.

    Attributes:
        degree: across them, less with few of them. closed: from the last on to the first.
    """

    kind: ClassVar[str] = "loft"
    sections: tuple[SectionCurve, ...]
    degree: int = 3
    closed: bool = False

    def _check(self) -> None:
        least = 3 if self.closed else 2
        if len(self.sections) < least:
            raise self._wrong(f"sections are {len(self.sections)}", f"give {least} or more")
        if not 1 <= self.degree <= MOST_DEGREE:
            raise self._wrong(f"degree is {self.degree}", f"use 1 to {MOST_DEGREE}")


@dataclass(frozen=True)
class RuledShape(_CheckedShape):
    """Straight lines from one curve to another, between like parameters."""

    kind: ClassVar[str] = "ruled"
    first: SectionCurve
    second: SectionCurve


@dataclass(frozen=True)
class RevolvedShape(_CheckedShape):
    """A profile turned about an axis; the turn begins at the profile."""

    kind: ClassVar[str] = "revolved"
    profile: SectionCurve
    centre: Point3 = (0.0, 0.0, 0.0)
    axis: Point3 = (0.0, 0.0, 1.0)
    turn_deg: Turn = (0.0, 360.0)

    def _check(self) -> None:
        self._direction(self.axis)


@dataclass(frozen=True)
class SweptShape(_CheckedShape):
    """A profile moved along a guide; where the profile is drawn is where it is at the guide's start."""

    kind: ClassVar[str] = "swept"
    profile: SectionCurve
    guide: SectionCurve
    keep: ProfileOrientation = ProfileOrientation.PARALLEL


@dataclass(frozen=True)
class MeshShape(_CheckedShape):
    """Triangles of an STL, OBJ, PLY or 3MF file; `scale` is mm for each of its units, of 3MF for each mm."""

    kind: ClassVar[str] = "mesh"
    file: str
    scale: float = 1.0

    def _check(self) -> None:
        self._positive("scale")
        if not self.file.lower().endswith((".stl", ".obj", ".ply", ".3mf")):
            raise self._wrong(f"file is {self.file!r}", "it must be an .stl, .obj, .ply or .3mf file")


@dataclass(frozen=True)
class StepShape(_CheckedShape):
    """Faces of a STEP file, in mm whatever its units.

    Attributes:
        faces: their numbers, from 1 on, in the order of the file; (): all of them.
        tolerance: how far the triangles that stand for them may be off, mm.
    """

    kind: ClassVar[str] = "step"
    file: str
    faces: tuple[int, ...] = ()
    tolerance: float = 0.005

    def _check(self) -> None:
        if not 1e-4 <= self.tolerance <= 1.0:
            raise self._wrong(f"tolerance is {self.tolerance:g} mm", "use 0.0001 to 1 mm")
        if not self.file.lower().endswith((".step", ".stp")):
            raise self._wrong(f"file is {self.file!r}", "it must be a .step or .stp file")


Shape = (
    PlaneShape
    | SphereShape
    | CylinderShape
    | ConeShape
    | TorusShape
    | BilinearShape
    | BicubicShape
    | BsplineShape
    | LoftShape
    | RuledShape
    | RevolvedShape
    | SweptShape
    | MeshShape
    | StepShape
)
"""Everything that a surface can be given as."""
