"""What is to be done with a tool: one frozen parameter set a kind of operation."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from app.errors import ParameterError


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
        depth: down from Z 0 = top of stock to the floor, mm, > 0.
        stepdown: largest depth of one pass, mm, > 0; passes are made equal.
        stock_to_leave: metal left on walls on purpose, mm, >= 0.
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
            if not 0 < getattr(self, name) < 1e5:
                raise ParameterError(f"{name.capitalize()} is {getattr(self, name):g} mm; it must be greater than 0.")
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
        stepover: distance between rings, mm, in (0, tool diameter); None = half the diameter, the largest
            that covers everything by itself. Overlap (the 1986 text's parameter) = diameter - stepover.
    """

    cut: Cut
    stepover: float | None = None

    def __post_init__(self) -> None:
        if self.stepover is not None and not 0 < self.stepover < 1e4:
            raise ParameterError(f"Stepover is {self.stepover:g} mm; it must be greater than 0.")


Operation = ContourOperation | PocketOperation
