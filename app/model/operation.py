"""What is to be done with a tool: one frozen parameter set a kind of operation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from .entry import Entry, Lead, Tabs

LEAST_LENGTH = 1e-3
"""mm; a smaller depth, step or height would vanish in the digits of an NC program."""

MOST_PASSES = 1_000
"""Depth passes of one operation; more are a slip of the pen."""

MOST_SPRING_PASSES = 10
LEAST_ENGAGED = 0.05
"""Share of the diameter; a feed that follows less would never be reached."""


class Direction(Enum):
    """Side of the standing metal, spindle clockwise (M3): climb = metal on the right of travel."""

    CLIMB = "climb"
    CONVENTIONAL = "conventional"


class Side(Enum):
    """Where a contour path runs: inside the areas that the drawing bounds, round them, or with the tool's centre on the lines."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    ON = "on"


class Order(Enum):
    """Which tool cuts first: the list's order, or all contours before the rest, as in 1986."""

    POCKET_FIRST = "pocket-first"
    PATENT_1986 = "1986"


@dataclass(frozen=True, slots=True)
class Cut:
    """Parameters that every operation has.

    Attributes:
        tool: T number of a tool of the job.
        depth: down from Z 0 = top of stock to the floor, mm, in [0.001, 1e5).
        stepdown: largest depth of one pass, mm, in [0.001, 1e5); passes are made equal, at most 1,000 of them.
        stock_to_leave: metal left on walls on purpose, mm, in [0, 1e4).
        direction: climb or conventional.
        enabled: switched-off operations stay in the list and make no moves.
        finish_depth: thickness of a last pass that finishes the floor, mm, in [0, depth); 0 = none.
        floor_to_leave: metal left on the floor on purpose, mm, in [0, depth).
        entry: the way down into metal.
        layers: that it machines; empty = all that the job does.
    """

    tool: int
    depth: float = 2.0
    stepdown: float = 2.0
    stock_to_leave: float = 0.0
    direction: Direction = Direction.CLIMB
    enabled: bool = True
    finish_depth: float = 0.0
    floor_to_leave: float = 0.0
    entry: Entry = Entry()
    layers: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("depth", "stepdown"):
            if not LEAST_LENGTH <= getattr(self, name) < 1e5:
                raise ParameterError(f"{name.capitalize()} is {getattr(self, name):g} mm; "
                                     f"it must be {LEAST_LENGTH:g} mm or more and less than 100000 mm.")
        passes = math.ceil(self.depth / self.stepdown - 1e-9)
        if passes > MOST_PASSES:
            raise ParameterError(f"Depth {self.depth:g} mm in steps of {self.stepdown:g} mm makes {passes} passes; "
                                 f"{MOST_PASSES} are the most, so take a larger stepdown.")
        if not 0 <= self.stock_to_leave < 1e4:
            raise ParameterError(f"Stock to leave is {self.stock_to_leave:g} mm; it must be 0 or more.")
        if not 0 <= self.floor_to_leave <= self.depth - LEAST_LENGTH:
            raise ParameterError(f"Floor to leave is {self.floor_to_leave:g} mm; it must be 0 or more and less than the depth, "
                                 f"{self.depth:g} mm.")
        if not 0 <= self.finish_depth <= self.floor - LEAST_LENGTH:
            raise ParameterError(f"The finish pass is {self.finish_depth:g} mm thick; it must be 0 (none) or more and less than "
                                 f"what is cut, {self.floor:g} mm.")

    @property
    def floor(self) -> float:
        """How deep the tool goes: depth - floor to leave, mm."""
        return self.depth - self.floor_to_leave


@dataclass(frozen=True, slots=True)
class ContourOperation:
    """Follow the walls with the contour tool (step 120).

    Attributes:
        side: where the path runs; ON also follows open lines (engraving, slots).
        lead: the way to the wall and away from it.
        tabs: bridges of metal that hold what is cut out.
        spring_passes: times the last pass is run again, in [0, 10].
        dog_bones: True: at inner corners the cutter goes on into the corner, and so into the walls, for a sharp counterpart to fit.
        finish_width: metal that passes leave on the wall for a finish pass, mm, in [0, 100]; 0 = no finish pass.
        finish_each_pass: True: the finish pass is run at every depth before going deeper; False: once, after all, at the floor.
        most_engaged: share of the diameter in (0, 1] beyond which the feed is slowed; 1 = never.
    """

    cut: Cut
    side: Side = Side.INSIDE
    lead: Lead = Lead()
    tabs: Tabs = Tabs()
    spring_passes: int = 0
    dog_bones: bool = False
    finish_width: float = 0.0
    finish_each_pass: bool = False
    most_engaged: float = 1.0

    def __post_init__(self) -> None:
        if not 0 <= self.spring_passes <= MOST_SPRING_PASSES:
            raise ParameterError(f"{self.spring_passes} spring passes are asked for; use 0 to {MOST_SPRING_PASSES}.")
        if not 0 <= self.finish_width <= 100:
            raise ParameterError(f"Finish width is {self.finish_width:g} mm; use 0 (no finish pass) to 100 mm.")
        _check_engaged(self.most_engaged)
        if self.side is Side.ON and (self.dog_bones or self.finish_width or self.cut.stock_to_leave):
            raise ParameterError("A path on the line has no wall: dog-bones, finish width and stock to leave do not go with it; "
                                 "take them out.")


@dataclass(frozen=True, slots=True)
class PocketOperation:
    """Clear the area inside with the pocket tool (steps 141-148).

    Attributes:
        stepover: distance between rings, mm, in [0.001, tool diameter]; None = the one with the least path. All of them clear
            everything; above half the diameter by runs between the rings. Overlap (the 1986 text's parameter) = diameter - stepover.
        outside_in: True: begin at the walls (141-148); False: begin inside and go outwards, so that only the beginning is a slot.
        most_engaged: share of the diameter in (0, 1] beyond which the feed is slowed; 1 = never.
    """

    cut: Cut
    stepover: float | None = None
    outside_in: bool = False
    most_engaged: float = 1.0

    def __post_init__(self) -> None:
        _check_stepover(self.stepover)
        _check_engaged(self.most_engaged)


@dataclass(frozen=True, slots=True)
class RestOperation:
    """Clear what the operations before it in the list have left within reach of its tool.

    Attributes:
        stepover: distance between its runs, mm, in [0.001, tool diameter]; None = as far apart as still clears everything.
        most_engaged: share of the diameter in (0, 1] beyond which the feed is slowed; 1 = never.
    """

    cut: Cut
    stepover: float | None = None
    most_engaged: float = 1.0

    def __post_init__(self) -> None:
        _check_stepover(self.stepover)
        _check_engaged(self.most_engaged)


@dataclass(frozen=True, slots=True)
class DrillOperation:
    """Drill the circles of the drawing at their centres.

    Attributes:
        peck: depth of one stroke before the drill comes out of the hole, mm, in [0.001, 1e5); None = in one go.
        least, most: diameters of the circles that are drilled, mm, 0 < least <= most; None = those as wide as the tool, within 0.1 mm.
        through: how far the drill goes on below the depth, mm, in [0, 1000], so that its full width comes through.
    """

    cut: Cut
    peck: float | None = None
    least: float | None = None
    most: float | None = None
    through: float = 0.0

    def __post_init__(self) -> None:
        if self.peck is not None and not LEAST_LENGTH <= self.peck < 1e5:
            raise ParameterError(f"Peck is {self.peck:g} mm; it must be {LEAST_LENGTH:g} mm or more.")
        if (self.least is not None and not self.least > 0) or (self.most is not None and not self.most > 0):
            raise ParameterError("Diameters of holes to drill must be greater than 0 mm.")
        if self.least is not None and self.most is not None and self.least > self.most:
            raise ParameterError(f"Holes from {self.least:g} to {self.most:g} mm are asked for; "
                                 "the least diameter must not be more than the most.")
        if not 0 <= self.through <= 1000:
            raise ParameterError(f"Going through by {self.through:g} mm is asked for; use 0 to 1000 mm.")


def _check_stepover(stepover: float | None) -> None:
    if stepover is not None and not LEAST_LENGTH <= stepover < 1e4:
        raise ParameterError(f"Stepover is {stepover:g} mm; it must be {LEAST_LENGTH:g} mm or more and less than 10000 mm.")


def _check_engaged(share: float) -> None:
    if not LEAST_ENGAGED <= share <= 1:
        raise ParameterError(f"The limit of engagement is {100 * share:g} % of the diameter; "
                             f"use {100 * LEAST_ENGAGED:g} to 100 % (100 = never slowed).")


Operation = ContourOperation | PocketOperation | RestOperation | DrillOperation

OPERATION_KINDS: dict[str, type[Operation]] = {
    "pocket": PocketOperation, "rest": RestOperation, "contour": ContourOperation, "drill": DrillOperation,
}
"""By the words of job files, reports and NC headers."""


def kind_word(operation: Operation) -> str:
    """Return the word for an operation's kind: pocket, rest, contour, drill."""
    return next(word for word, kind in OPERATION_KINDS.items() if isinstance(operation, kind))


def follows_lines(operation: Operation) -> bool:
    """Tell whether an operation has its tool's centre on the lines, or drills, so that it bounds no area."""
    return isinstance(operation, DrillOperation) or (isinstance(operation, ContourOperation) and operation.side is Side.ON)
