"""Slots along drawn lines."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .fields import Condition, Unit, check_ranges, parameter
from .operation import ENGAGED, LEAST_ENGAGED, LEAST_LENGTH, LIFT, MOST_ENGAGED, STEPOVER, Operation, Side
from .tool import Tool

_IN_ARCS = Condition(lambda operation: operation.trochoidal, "a trochoidal way", "add trochoidal = true")
_IN_RINGS = Condition(lambda operation: not operation.trochoidal, "rings", "take trochoidal out")


@dataclass(frozen=True, slots=True)
class SlotOperation(Operation):
    """Cut slots along the drawn lines, open and closed: all that lies within half of the width of a line."""

    slot_width: float | None = parameter(
        None,
        "slot_width",
        "Slot width",
        "how wide the slot along the lines is; wider than the tool: the tool goes along its walls, and between",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        high=9_999.0,
        option=True,
        auto="as wide as the tool",
    )
    stepover: float | None = parameter(
        None, *STEPOVER, low=LEAST_LENGTH, high=9_999.0, auto="automatic", needs=_IN_RINGS
    )
    trochoidal: bool = parameter(
        False,
        "trochoidal",
        "Trochoidal",
        "in arcs that nowhere have more of the rim in metal than an angle; the slot has to be wider than the tool",
        Unit.FLAG,
        option=True,
    )
    most_engaged_deg: float = parameter(
        math.radians(60),
        *MOST_ENGAGED,
        low=math.radians(15),
        high=math.radians(90),
        option=True,
        short="Most engaged",
        needs=_IN_ARCS,
    )
    lift: float = parameter(0.2, *LIFT, high=100.0, option=True, needs=_IN_ARCS)
    most_engaged: float = parameter(
        1.0,
        *ENGAGED,
        low=LEAST_ENGAGED,
        high=1.0,
        option=True,
        group="Feed and layers",
        short="Slow beyond",
        needs=_IN_RINGS,
    )

    WORD = "slot"
    CLEARS = True
    UNUSED = frozenset({"stock_to_leave"})

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def wall_side(self) -> Side | None:
        """On the lines: they are the slot's middle, and no walls."""
        return Side.ON

    def line_width(self, tool: Tool) -> float | None:
        """Return how wide the slots are, mm."""
        return self.slot_width or tool.diameter

    @property
    def ring_stepover(self) -> float | None:
        """Distance between its rings as it was asked for, mm; None = automatic."""
        return self.stepover

    @property
    def engagement_limit(self) -> float:
        """Share of the diameter beyond which the feed is slowed."""
        return 1.0 if self.trochoidal else self.most_engaged

    @property
    def proven_angle(self) -> float | None:
        """Engaged angle, radians, that the written program must not exceed anywhere, where it goes in arcs."""
        return self.most_engaged_deg if self.trochoidal else None

    @property
    def lift_between(self) -> float:
        """How high the tool goes on its way back over ground that is cut, mm."""
        return self.lift
