"""Carving with the cone of a V cutter."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .fields import Unit, check_ranges, parameter
from .operation import CutParameters, Operation, PocketOperation
from .tool import Tool


@dataclass(frozen=True, slots=True)
class VcarveOperation(Operation):
    """Carve the area inside with a V cutter that touches both walls at the surface; `depth` is the greatest."""

    flat_tool: int | None = parameter(
        None,
        "flat_tool",
        "Flat tool",
        "the flat mill, by its T number, that clears the floor first, where the area is wider than the cone",
        Unit.COUNT,
        low=1,
        high=9999,
        option=True,
        auto="none",
    )

    WORD = "vcarve"
    NAME = "V-carve"
    CARVES = True
    LEVELS = False
    UNUSED = frozenset({"stock_to_leave", "direction", "finish_depth", "floor_to_leave", "entry", "entry_angle"})

    def __post_init__(self) -> None:
        check_ranges(self)

    def prepared_by(self, tool: Tool) -> tuple[Operation, ...]:
        """Return the pocket that clears the flat floor: all that lies deeper than the slanted walls."""
        if self.flat_tool is None:
            return ()
        cut = CutParameters(
            self.flat_tool,
            self.cut.depth,
            self.cut.stepdown,
            self.cut.depth * math.tan(tool.tip_angle / 2),
            enabled=self.cut.enabled,
            curves=self.cut.curves,
        )
        return (PocketOperation(cut),)
