"""Chamfers along contours, by the flank of a cone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core.errors import ParameterError
from .fields import Unit, check_ranges, parameter
from .operation import SIDE, Operation, Side
from .tool import Tool


@dataclass(frozen=True, slots=True)
class ChamferOperation(Operation):
    """Break the edges along contours with the flank of a V cutter; a narrow one deburrs."""

    side: Side = parameter(
        Side.OUTSIDE, *SIDE, option=True, choices=("Inside", "Outside", "On line"), not_taken=(Side.ON,)
    )
    width: float = parameter(
        0.5,
        "width",
        "Width",
        "how far the chamfer reaches into the top, beside the lines",
        Unit.LENGTH,
        low=0.01,
        high=100.0,
        option=True,
    )
    tip_offset: float = parameter(
        0.3,
        "tip_offset",
        "Tip offset",
        "how far the tip goes below the chamfer's lower edge, so that the flank cuts, and not the tip",
        Unit.LENGTH,
        low=0.01,
        high=100.0,
        option=True,
    )

    WORD = "chamfer"
    CARVES = True
    LEVELS = False
    UNUSED = frozenset(
        {"depth", "stepdown", "stock_to_leave", "finish_depth", "floor_to_leave", "entry", "entry_angle"}
    )

    def __post_init__(self) -> None:
        check_ranges(self)
        if self.side is Side.ON:
            raise ParameterError("A chamfer lies beside the line, not on it; use inside or outside, or engrave.")

    @property
    def wall_side(self) -> Side | None:
        """On which side of the drawn lines its cutter is."""
        return self.side

    @property
    def over_edge(self) -> float:
        """How far its cutter reaches beyond the drawn lines at the surface, mm."""
        return self.width

    def deepest(self, tool: Tool) -> float:
        """Return how deep the tip goes, mm."""
        return self.width / math.tan(tool.tip_angle / 2) + self.tip_offset
