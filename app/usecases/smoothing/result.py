"""What is asked of smoothing a program, and what it gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.wording import together
from ...fitting.fitted import SplineRefusal
from ...fitting.line_arcs.arc_fit import BEND
from ...fitting.point_curves.bspline import FitRound
from ...fitting.point_curves.corners import LEAST_LEG
from ...fitting.point_curves.effective_method import EffectiveMethod, PointClasses
from ...fitting.point_curves.region_profile import RegionProfile
from ...fitting.point_curves.smoothness import Smoothness
from ...fitting.point_curves.space_curve import SpaceCurve
from ...fitting.point_curves.tube import TubeJudgement
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts import Post
from ...gcode.rework.stretches import FeedStretch, FoundStretches
from ...model.motion import Floats
from ...model.part import Units

TOLERANCES = (1e-4, 10.0)
"""mm; what a tolerance may be."""

REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""


class OutputForm(Enum):
    """What stretches are written as."""

    LINES = "lines"
    ARCS = "arcs"
    NURBS = "nurbs"


@dataclass(frozen=True)
class SmoothOptions:
    """How to smooth.

    Attributes:
        tolerance: by how much curve and moves may be apart, both ways, mm.
        form: what is written.
        middle: half way between two points the curve may be so far away, mm; None: no farther than at them.
        degree: of splines, 3 or 5; no control knows degree 5, which goes out as cubics that take up part of the
            tolerance.
        corner: bends of more than this are kept exactly, radians.
        post: in whose words all of the program is written; None = those of the control that it is for.
        dialect: how the program is read; None = as the text looks, whatever the post.
        effective: method D; None: the curve goes by all points.
        bend: lines and arcs may turn by so much where they meet, where that saves blocks, radians; or as much as the
            moves do there.
        profile: the region's outline, r = f(z), where it is neither a cylinder nor a barrel; it then tells the
            tolerance, its radius at the points, and there is no middle.
        units: of a program that names none; None = mm.
        insist: splines all along, however many blocks they take, smooth of the second order from corner to corner.
    """

    tolerance: float = 0.01
    form: OutputForm = OutputForm.ARCS
    middle: float | None = None
    degree: int = 3
    corner: float = math.radians(30.0)
    post: Post | None = None
    dialect: Dialect | None = None
    effective: EffectiveMethod | None = None
    bend: float = BEND
    insist: bool = False
    profile: RegionProfile | None = None
    units: Units | None = None

    @property
    def widest(self) -> float:
        """How far curve and moves may be apart anywhere, mm."""
        return max(self.tolerance, self.middle or 0.0, self.profile.widest if self.profile is not None else 0.0)

    @property
    def rounds(self) -> float:
        """By how much the curve may round off what is no corner, mm.

        Of the tolerance method D has that only to leave facets; it stays nearer to its points than that.
        """
        method = self.effective
        return self.widest if method is None else min(self.widest, max(method.choose.epsilon, method.nearness or 0.0))

    @property
    def least_leg(self) -> float:
        """Bends above `corner` whose legs are both so long or longer are kept exactly, whatever is beside them, mm."""
        return LEAST_LEG * REACH * self.rounds

    def __post_init__(self) -> None:
        if self.profile is not None and (self.middle is not None or self.tolerance != self.profile.radius):
            raise ParameterError("a region by its outline has no other tolerance and no middle; leave these out.")
        if not TOLERANCES[0] <= self.tolerance <= TOLERANCES[1]:
            raise ParameterError(
                f"the tolerance is {self.tolerance:g} mm; use {TOLERANCES[0]:g} to {TOLERANCES[1]:g} mm."
            )
        if self.degree not in (3, 5):
            raise ParameterError(f"a spline of degree {self.degree}; use 3 or 5.")
        if not 0 < self.corner <= math.pi:
            raise ParameterError(
                f"a corner of {math.degrees(self.corner):g} degrees; use more than 0 and not more than 180."
            )
        if not 0 < self.bend <= math.pi:
            raise ParameterError(
                f"a bend of {math.degrees(self.bend):g} degrees; use more than 0 and not more than 180."
            )
        if self.insist and self.form is not OutputForm.NURBS:
            raise ParameterError(f"insisting on splines, written as {self.form.value}; write nurbs, or do not insist.")


@dataclass(frozen=True, slots=True)
class WrittenKinds:
    """How many lines, arcs and splines stand in a written text; one block of a spline's words is none of its own."""

    lines: int = 0
    arcs: int = 0
    splines: int = 0

    def __add__(self, other: WrittenKinds) -> WrittenKinds:
        """Return those of both together."""
        return WrittenKinds(self.lines + other.lines, self.arcs + other.arcs, self.splines + other.splines)

    @property
    def words(self) -> str:
        """As people are told: "10 arcs and 3 lines"."""
        named = ((self.splines, "spline"), (self.arcs, "arc"), (self.lines, "line"))
        told = [f"{count} {name}" + ("" if count == 1 else "s") for count, name in named if count]
        return together(told) or "nothing"


@dataclass(frozen=True, slots=True)
class RoundFigures:
    """What a round of fitting a spline came to.

    Attributes:
        control_points: how many it had.
        farthest: distance of a point from the curve, mm, the largest.
        outside: points farther than the region is wide at them.
        unproven: chords whose stretch of curve was not proven to be in its region.
        spread: whether it was a try with fewer control points, behind one that was proven.
    """

    control_points: int
    farthest: float
    outside: int
    unproven: int
    spread: bool


def figures_of(seen: FitRound) -> RoundFigures:
    """Return the figures of a round, without its curve."""
    return RoundFigures(len(seen.control), seen.farthest, seen.outside, len(seen.unproven), seen.spread)


@dataclass(frozen=True, eq=False)
class SmoothedStretch:
    """One stretch, before and after.

    Attributes:
        stretch: of the program that came in.
        points: its places, none twice in a row, mm.
        blocks: that it had and has.
        curve: what the written text drives along; None where the stretch stayed as it was.
        judgement: of that curve against the points; None where it stayed.
        kept: why it stayed, or "".
        before, after: how smooth it is.
        corners: numbers of its points that are kept exactly, the outer ones among them.
        classes: what its points are by method D; None without it, and of a stretch that is too short.
        near: of the curve against the points that method D goes by; None without it.
        lines: its first and last one in the text that came in, 1-based.
        rounded: how many bends above the corner's angle, beside shorter legs than corners have, are kept no more.
        kinds: what its written text holds, as it is read back.
        refusals: where splines were asked for and something else stands.
        rounds: of the splines that were tried (figure 4 of method E).
    """

    stretch: FeedStretch
    points: Floats
    blocks: tuple[int, int]
    curve: SpaceCurve | None
    judgement: TubeJudgement | None
    kept: str
    before: Smoothness
    after: Smoothness
    corners: NDArray[np.int64]
    classes: PointClasses | None = None
    near: TubeJudgement | None = None
    lines: tuple[int, int] = (0, 0)
    rounded: int = 0
    kinds: WrittenKinds = WrittenKinds()
    refusals: tuple[SplineRefusal, ...] = ()
    rounds: tuple[RoundFigures, ...] = ()


@dataclass(frozen=True, eq=False)
class SmoothedProgram:
    """A program, smoothed.

    Attributes:
        name: of the file that came in.
        options: what was asked.
        source: the program as its own control reads it.
        before, after: the same in the words that it is written in, before and after smoothing, both as the control of
            those reads them.
        data: the new text.
        pieces: every stretch, in the order of the text.
        found: stretches, and what is in none.
        dialects: of the control that the program came for, and of the one that it is written for.
        off: how far from the source all else may be in the other control's words, mm; 0 where it is the same control.
        nearness: how far from the points of method D curves may be, mm; None without it.
    """

    name: str
    options: SmoothOptions
    source: NcProgram
    before: NcProgram
    after: NcProgram
    data: bytes
    pieces: tuple[SmoothedStretch, ...]
    found: FoundStretches
    dialects: tuple[Dialect, Dialect]
    off: float = 0.0
    nearness: float | None = None

    @property
    def kinds(self) -> WrittenKinds:
        """What stands for all stretches that were written anew."""
        return sum((piece.kinds for piece in self.pieces), WrittenKinds())

    @property
    def refusals(self) -> tuple[SplineRefusal, ...]:
        """Where splines were asked for and something else stands, of all stretches that were written anew."""
        return tuple(each for piece in self.pieces if piece.judgement for each in piece.refusals)

    @property
    def farthest_point(self) -> float:
        """How far from the curve a point of method D was found at most, mm."""
        return max((piece.near.from_points for piece in self.pieces if piece.near), default=0.0)

    @property
    def bound(self) -> float:
        """Proven: nowhere are curve and moves farther apart than this, mm."""
        return max((piece.judgement.bound for piece in self.pieces if piece.judgement), default=0.0)
