"""Chamfers along contours, by the flank of a cone or the round of a ball."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from .fields import Unit, check_ranges, parameter
from .operation import SIDE, CarvingCone, Operation, Side, SideStrip
from .tool import Tool
from .tool_kind import ToolKind

_AS_DEEP = 1e-6
"""mm; a chamfer that a cone makes is as deep as told when it differs by less."""

_BESIDE = 1.0
"""mm that the area beside an open line is wider than the cutter is at the surface."""

_TOUCHING = 1e-4
"""mm; walls that a ball is nearer to than its distance from them by less are touched by it."""


@dataclass(frozen=True, slots=True)
class ChamferBall:
    """Where a ball is that breaks an edge: on both ends of the chamfer, which it hollows between them.

    Attributes:
        radius: of the ball, mm.
        off: how far its axis keeps off the wall, mm.
        above: height of its centre above the top, mm.
    """

    radius: float
    off: float
    above: float

    @staticmethod
    def of(radius: float, width: float, down: float) -> ChamferBall:
        """Return where a ball breaks an edge so wide on the top and so deep on the wall, mm.

        Its centre is as far from the ends of the chamfer, on the side of the air, as its radius: on the perpendicular
        bisector of the chord between them.

        Raises:
            ParameterError: it would undercut the top or the wall, as its centre would lie below the one or behind the
                other.
        """
        chord = math.hypot(width, down)
        out = math.sqrt(max(radius**2 - chord**2 / 4, 0.0))
        off, above = down / chord * out - width / 2, width / chord * out - down / 2
        if chord > 2 * radius or min(off, above) < 0:
            raise ParameterError(
                f"A ball of {2 * radius:g} mm cannot break an edge {width:g} mm wide and {down:g} mm deep: it would "
                "undercut the edge; take a larger ball, or a smaller chamfer whose sides are more alike."
            )
        return ChamferBall(radius, off, above)

    @property
    def depth(self) -> float:
        """How deep its lowest point goes, mm."""
        return self.radius - self.above


class OpenSide(Enum):
    """On which side of open lines, as they are drawn, the cutter is; the edge that it breaks is on the other side."""

    NONE = "none"
    LEFT = "left"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class ChamferOperation(Operation):
    """Break the edges along contours with the flank of a V cutter or with a ball; a narrow one deburrs."""

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
        "how far the tip goes below the chamfer's lower edge, so that the flank cuts, and not the tip; a ball's is "
        "where it has to be",
        Unit.LENGTH,
        low=0.01,
        high=100.0,
        option=True,
    )
    down: float | None = parameter(
        None,
        "chamfer_depth",
        "Chamfer depth",
        "how far the chamfer reaches down the wall; of a cone that follows from its angle and the width",
        Unit.LENGTH,
        low=0.01,
        high=100.0,
        option=True,
        auto="as wide, or by the cone",
    )
    open_side: OpenSide = parameter(
        OpenSide.NONE,
        "open_side",
        "Side of open lines",
        "break the edges of open lines, and of no closed contours, with the cutter on this side of them, seen in the "
        "direction in which they are drawn",
        Unit.CHOICE,
        option=True,
        choices=("Closed contours", "Left", "Right"),
    )

    WORD = "chamfer"
    CARVES = True
    CARVES_ROUND = True
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
        """On which side of what bounds its area its cutter is."""
        return Side.INSIDE if self.takes_open else self.side

    @property
    def takes_open(self) -> bool:
        """Whether it breaks the edges of open lines, and of these alone."""
        return self.open_side is not OpenSide.NONE

    def beside_open(self, tool: Tool) -> SideStrip | None:
        """Return the area beside open lines that it machines: so wide that nothing else bounds its way."""
        if not self.takes_open:
            return None
        ball = self.ball(tool)
        off = tool.tip_diameter / 2 + self.tip_offset * math.tan(tool.tip_angle / 2) if ball is None else ball.off
        return SideStrip(self.open_side is OpenSide.LEFT, 2 * (off + self.width) + _BESIDE)

    @property
    def over_edge(self) -> float:
        """How far its cutter reaches beyond the drawn lines at the surface, mm."""
        return self.width

    def ball(self, tool: Tool) -> ChamferBall | None:
        """Return where its ball is; None of a cone.

        Raises:
            ParameterError: the chamfer is too large for the ball, or another than its cone makes.
        """
        if tool.kind is ToolKind.BALL:
            return ChamferBall.of(tool.radius, self.width, self.width if self.down is None else self.down)
        made = self.width / math.tan(tool.tip_angle / 2)
        if self.down is not None and abs(self.down - made) > _AS_DEEP:
            raise ParameterError(
                f"T{tool.number} {tool.label} makes chamfers of {self.width:g} mm {made:.4f} mm deep, not "
                f"{self.down:g} mm; leave chamfer_depth out, take a width of "
                f"{self.down * math.tan(tool.tip_angle / 2):.4f} mm, or a ball."
            )
        return None

    def deepest(self, tool: Tool) -> float:
        """Return how deep the tip goes, mm."""
        ball = self.ball(tool)
        return self.width / math.tan(tool.tip_angle / 2) + self.tip_offset if ball is None else ball.depth

    def carved_by(self, tool: Tool) -> CarvingCone:
        """Return the cone that the chamfer is proven with.

        Of a ball it is the frustum within it that ends where the ball touches the wall, and whose flank is the chord
        from there to the top; that touches walls as far off as the ball, and no others.
        """
        ball = self.ball(tool)
        if ball is None:
            return Operation.carved_by(self, tool)
        rate = self.width / (self.width if self.down is None else self.down)
        tip = ball.off - _TOUCHING
        return CarvingCone(tip, rate, _TOUCHING / rate, ball.depth, tip)
