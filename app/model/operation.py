"""What is to be done with a tool: one frozen parameter set a kind of operation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from app.errors import ParameterError

LEAST_LENGTH = 1e-3
"""mm; a smaller depth, step or height would vanish in the digits of an NC program."""

MOST_PASSES = 10_000
"""Depth passes of one operation; more are a slip of the pen."""


class Direction(Enum):
    """Side of the standing metal, spindle clockwise (M3): climb = metal on the right of travel."""

    CLIMB = "climb"
    CONVENTIONAL = "conventional"


class Order(Enum):
    """Which tool cuts first."""

    POCKET_FIRST = "pocket-first"
    PATENT_1986 = "1986"


@dataclass(frozen=True, slots=True)
class Cut:
    """Parameters that every milling operation has.

    Attributes:
        tool: T number of a tool of the job.
        depth: down from Z 0 = top of stock to the floor, mm, in [0.001, 1e5).
        stepdown: largest depth of one pass, mm, in [0.001, 1e5); passes are made equal, at most 10,000 of them.
        stock_to_leave: metal left on walls on purpose, mm, in [0, 1e4).
        direction: climb or conventional.
        enabled: switched-off operations stay in the list and make no moves.
    """

    tool: int
    depth: float = 2.0
    stepdown: float = 2.0
    stock_to_leave: float = 0.0
    direction: Direction = Direction.CLIMB
    enabled: bool = True

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


@dataclass(frozen=True, slots=True)
class ContourOperation:
    """Follow the walls with the contour tool (step 120)."""

    cut: Cut


@dataclass(frozen=True, slots=True)
class PocketOperation:
    """Clear the area inside with the pocket tool (steps 141-148).

    Attributes:
        stepover: distance between rings, mm, in [0.001, tool diameter); None = half the diameter, the largest
            that covers everything by itself. Overlap (the 1986 text's parameter) = diameter - stepover.
    """

    cut: Cut
    stepover: float | None = None

    def __post_init__(self) -> None:
        if self.stepover is not None and not LEAST_LENGTH <= self.stepover < 1e4:
            raise ParameterError(f"Stepover is {self.stepover:g} mm; it must be {LEAST_LENGTH:g} mm or more and less than 10000 mm.")


Operation = ContourOperation | PocketOperation
