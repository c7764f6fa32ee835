"""The tools that a proposal chooses from: long enough for a depth, of the size of a hole, fit for a region."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ...core.errors import ParameterError
from ...geometry.primitives import pack
from ...model.part import Region
from ...model.tool import Tool
from ...model.tool_kind import ToolKind
from ...toolpath.advice.reach import FITS
from ...toolpath.advice.width import Walls, widths

_EXACT = 0.01
"""mm by which a drill may be wider or narrower than the holes that it is proposed for."""

_LONGEST = 6.0
"""Times its diameter that a mill's flutes can be long, as they are sold."""

_HELIX = 0.75
"""Of a hole's diameter; a mill up to this wide has room to go down in it on a helix."""

_FINE_ANGLE = 1.1
"""Radians; V tools up to this full angle, 63 degrees, engrave."""


@dataclass
class Rack:
    """Tools to choose from, and which of them were taken.

    Attributes:
        tools: of a library.
        taken: in the order in which they were; a program of few tools is soon set up, so these are preferred.
    """

    tools: Sequence[Tool]
    taken: list[Tool] = field(default_factory=list)

    def take(self, tool: Tool) -> Tool:
        """Note that a tool is used; return it."""
        if tool not in self.taken:
            self.taken.append(tool)
        return tool

    def mills(self, depth: float) -> list[Tool]:
        """Return flat mills that reach a depth, mm, the thinnest first.

        Where the library's is too short, but one of its diameter can be had that is not, that is among them, under a
        number of its own.

        Raises:
            ParameterError: there is no flat mill.
        """
        flat = sorted((tool for tool in self.tools if tool.kind is ToolKind.FLAT), key=lambda tool: tool.diameter)
        if not flat:
            raise ParameterError(
                "Operations are proposed with flat mills, and there is none among the tools; add one to the library."
            )
        found = [self._long(tool, depth) for tool in flat if depth <= max(tool.flute_length, _LONGEST * tool.diameter)]
        return found or [self._long(flat[-1], depth)]

    def _long(self, tool: Tool, depth: float) -> Tool:
        if tool.flute_length == 0 or tool.flute_length >= depth - 1e-9:
            return tool
        number = max(each.number for each in self.tools) + tool.number
        return replace(
            tool,
            number=number,
            name=f"Long flat {tool.diameter:g} mm",
            flute_length=0.0,
            overall_length=0.0,
            stick_out=0.0,
            shank_diameter=0.0,
            holder=(),
        )

    def is_long(self, tool: Tool) -> bool:
        """Tell whether a tool is a longer one than the library has."""
        return tool not in self.tools

    def drill(self, diameter: float) -> Tool | None:
        """Return the drill of a hole's size, mm; None where there is none."""
        drills = (tool for tool in self.tools if tool.kind is ToolKind.DRILL)
        return next((tool for tool in drills if abs(tool.diameter - diameter) <= _EXACT), None)

    def engraver(self) -> Tool:
        """Return the tool for lines: the most pointed V tool, else the thinnest flat mill."""
        pointed = [tool for tool in self.tools if tool.kind is ToolKind.V and 0 < tool.tip_angle <= _FINE_ANGLE]
        return max(pointed, key=lambda tool: tool.tip_angle) if pointed else self.mills(0.0)[0]

    def cone(self, diameter: float) -> Tool:
        """Return the V cutter for edges: as wide as so many mm, its angle the nearest to a right one, then the
        narrowest.

        Raises:
            ParameterError: there is none.
        """
        wide = [tool for tool in self.tools if tool.kind is ToolKind.V and tool.tip_angle and tool.diameter >= diameter]
        if not wide:
            raise ParameterError(
                f"Edges are broken by a V cutter at least {diameter:g} mm wide, and there is none among the tools; "
                "add one to the library."
            )
        return min(wide, key=lambda tool: (abs(tool.tip_angle - math.pi / 2), tool.diameter))

    def boring(self, diameter: float, depth: float) -> Tool:
        """Return the mill for a round hole, mm: with room to go down on a helix, and so wide that nothing falls out of
        the middle if there is one, else the widest.
        """
        mills = self.mills(depth)
        fit = [tool for tool in mills if tool.diameter <= _HELIX * diameter] or mills[:1]
        wide = [tool for tool in fit if 2 * tool.diameter >= diameter]
        used = [tool for tool in wide if tool in self.taken]
        return used[-1] if used else wide[0] if wide else fit[-1]

    def fitting(self, least: float, most: float, depth: float) -> Tool:
        """Return the mill for places that have room for a diameter: the widest that fits, one that is used already
        where that is half as wide or more.

        Args:
            least: diameter that the tightest place has room for, mm.
            most: widest tool that is wanted, mm.
            depth: that it has to reach, mm.
        """
        mills = self.mills(depth)
        fit = [tool for tool in mills if tool.diameter <= min(least, most) + FITS] or mills[:1]
        used = [tool for tool in fit if tool in self.taken and 2 * tool.diameter >= fit[-1].diameter]
        return used[-1] if used else fit[-1]


def room(regions: Sequence[Region]) -> float:
    """Return the diameter of the widest cutter, mm, that leaves nothing of some regions but sharp corners."""
    return float(widths(Walls.of(pack(regions))).clearing.min())
