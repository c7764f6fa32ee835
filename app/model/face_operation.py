"""Facing: what stands above Z 0 is taken off the whole stock."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .fields import Unit, check_ranges, parameter
from .operation import LEAST_LENGTH, STEPOVER, Operation, Side
from .tool import Tool


class FacePattern(Enum):
    """In which way the top is gone over."""

    ZIGZAG = "zigzag"
    ONE_WAY = "one-way"
    SPIRAL = "spiral"


@dataclass(frozen=True, slots=True)
class FaceOperation(Operation):
    """Take off the whole stock what stands above Z 0."""

    pattern: FacePattern = parameter(
        FacePattern.ZIGZAG,
        "pattern",
        "Pattern",
        "in which way the top is gone over",
        Unit.CHOICE,
        option=True,
        choices=("Zigzag", "One way", "Spiral"),
    )
    stepover: float | None = parameter(None, *STEPOVER, low=LEAST_LENGTH, high=9_999.0, auto="automatic")

    WORD = "face"
    LEVELS = False
    FACES = True
    UNUSED = frozenset(
        {"depth", "stock_to_leave", "finish_depth", "floor_to_leave", "entry", "entry_angle", "curves", "direction"}
    )

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def wall_side(self) -> Side | None:
        """None: it knows no walls."""
        return None

    def deepest(self, tool: Tool) -> float:
        """Return how deep the tool goes below Z 0, mm: not at all."""
        return 0.0
