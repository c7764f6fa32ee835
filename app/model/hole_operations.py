"""What is done to holes: drilled, reamed, tapped, countersunk, bored, threaded by a mill."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..core.errors import ParameterError
from ..core.options import option
from .fields import Condition, Unit, check_ranges, parameter
from .operation import ALIKE, DWELL, LEAST_LENGTH, STRAIGHT_DOWN, THROUGH, Operation, Side
from .thread_sizes import ThreadSize
from .tool import Tool

_DIAMETER = (
    "diameter",
    "Diameter",
    "of what is made at each circle's centre, in the place of the circle's own",
    Unit.LENGTH,
)
_THREAD = ("thread", "Thread", "its name in drawings, such as M6, 1/4-20 UNC or G1/4", Unit.CHOICE)
LEFT_HAND = (
    "left_hand",
    "Left-handed",
    "the thread turns to the left: it goes down as a helix that is turned counter-clockwise",
    Unit.FLAG,
)
_SAME = 1e-6
"""mm of rounding, beside ALIKE."""


@dataclass(frozen=True, slots=True)
class HoleOperation(Operation):
    """Work on the circles of the drawing, each by itself."""

    least: float | None = parameter(
        None,
        "least",
        "Holes from",
        "least diameter of the circles that it works on",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        auto="those that the tool is for",
    )
    most: float | None = parameter(
        None,
        "most",
        "Holes to",
        "largest diameter of the circles that it works on",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        auto="those that the tool is for",
    )

    HOLES = True
    LEVELS = False

    def __post_init__(self) -> None:
        check_ranges(self)
        if self.least is not None and self.most is not None and self.least > self.most:
            raise ParameterError(
                f"Holes from {self.least:g} to {self.most:g} mm are asked for; "
                "the least diameter must not be more than the most."
            )

    @property
    def wall_side(self) -> Side | None:
        """None: it knows no walls but those of its holes."""
        return None

    @property
    def on_bosses(self) -> bool:
        """Whether its circles are bosses, round which its tool goes."""
        return False

    def around(self, tool: Tool) -> float:
        """Return how far beyond what it makes the tool needs room, mm."""
        return 0.0

    def is_for(self, drawn: float, tool: Tool) -> bool:
        """Tell whether a circle of a diameter, mm, is one for the tool, where nobody names diameters."""
        return abs(drawn - tool.diameter) <= ALIKE + _SAME

    def takes(self, drawn: float, tool: Tool) -> bool:
        """Tell whether a circle of a diameter, mm, is wide enough for the tool."""
        return tool.diameter <= drawn + ALIKE + _SAME

    def made(self, drawn: float, tool: Tool) -> float:
        """Return how wide the hole is that it makes in a circle of a diameter, mm."""
        return tool.diameter


@dataclass(frozen=True, slots=True)
class DrillOperation(HoleOperation):
    """Drill the circles of the drawing at their centres."""

    peck: float | None = parameter(
        None,
        "peck",
        "Peck",
        "depth of one stroke before the drill comes out of the hole",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        option=True,
        auto="in one go",
    )
    chip_break: bool = parameter(
        False,
        "chip_break",
        "Break chips",
        "after each peck the drill goes up a little, so that the chip breaks, and not out of the hole",
        Unit.FLAG,
        option=True,
        choices=("Out of the hole", "Break the chip"),
        short="Between pecks",
        needs=Condition(
            lambda operation: operation.peck is not None,
            "pecks",
            "add peck = 2",
            lambda: f"{option('peck')} gives them",
        ),
    )
    dwell: float = parameter(0.0, *DWELL, high=60.0, option=True)
    through: float = parameter(0.0, *THROUGH, high=1000.0, option=True)

    points: bool = parameter(
        False,
        "points",
        "Points too",
        "drawn points are holes, too, as if they were circles as wide as the drill",
        Unit.FLAG,
        option=True,
    )

    WORD = "drill"
    DRILLS = True
    UNUSED = STRAIGHT_DOWN

    @property
    def beyond(self) -> float:
        """How far the drill goes on below the depth, mm."""
        return self.through

    @property
    def dwell_s(self) -> float:
        """How long the drill turns at the bottom, s."""
        return self.dwell

    @property
    def takes_points(self) -> bool:
        """Whether it drills drawn points."""
        return self.points


@dataclass(frozen=True, slots=True)
class ReamOperation(HoleOperation):
    """Ream holes that were drilled a little narrower: down at feed, and out at feed."""

    through: float = parameter(0.0, *THROUGH, high=1000.0, option=True)

    WORD = "ream"
    TOOL = "reamer"
    DRILLS = True
    UNUSED = STRAIGHT_DOWN

    @property
    def beyond(self) -> float:
        """How far the reamer goes on below the depth, mm."""
        return self.through


@dataclass(frozen=True, slots=True)
class TapOperation(HoleOperation):
    """Tap holes: down by one pitch a turn, and out with the spindle turning back; `depth` is the tap's tip's."""

    thread: ThreadSize = parameter(ThreadSize.M6, *_THREAD, option=True)
    through: float = parameter(0.0, *THROUGH, high=1000.0, option=True)

    left_hand: bool = parameter(False, *LEFT_HAND, option=True, choices=("Right", "Left"), short="Hand")

    WORD = "tap"
    TOOL = "tap"
    DRILLS = True
    TAPS = True
    UNUSED = STRAIGHT_DOWN

    @property
    def turns_left(self) -> bool:
        """Whether its tool turns counter-clockwise on its way in."""
        return self.left_hand

    @property
    def beyond(self) -> float:
        """How far the tap goes on below the depth, mm."""
        return self.through

    def is_for(self, drawn: float, tool: Tool) -> bool:
        """Tell whether a circle is as wide as the thread, or as the hole before it is tapped."""
        return any(
            abs(drawn - each) <= ALIKE + _SAME
            for each in (self.thread.major, self.thread.tap_drill, self.thread.nut_core)
        )

    def takes(self, drawn: float, tool: Tool) -> bool:
        """Tell whether a circle is as wide as the thread's core."""
        return drawn + ALIKE + _SAME >= self.thread.nut_core

    def made(self, drawn: float, tool: Tool) -> float:
        """Return the thread's own diameter, mm."""
        return self.thread.major


@dataclass(frozen=True, slots=True)
class CountersinkOperation(HoleOperation):
    """Sink a cone into the circles' edges, as wide at the surface as they are drawn, or as `diameter` says; a narrow
    one spots.
    """

    diameter: float | None = parameter(None, *_DIAMETER, low=LEAST_LENGTH, option=True, auto="the circle's own")
    dwell: float = parameter(0.0, *DWELL, high=60.0, option=True)

    WORD = "countersink"
    DRILLS = True
    CARVES = True
    UNUSED = STRAIGHT_DOWN | {"depth"}

    @property
    def dwell_s(self) -> float:
        """How long the tool turns at the bottom, s."""
        return self.dwell

    def is_for(self, drawn: float, tool: Tool) -> bool:
        """Tell whether the cone is as wide as what is to be made."""
        return self.made(drawn, tool) <= tool.diameter + _SAME

    def takes(self, drawn: float, tool: Tool) -> bool:
        """Tell whether the cone is as wide as what is to be made, and its tip no wider."""
        return tool.tip_diameter - _SAME <= self.made(drawn, tool) <= tool.diameter + _SAME

    def made(self, drawn: float, tool: Tool) -> float:
        """Return the diameter at the surface, mm."""
        return drawn if self.diameter is None else self.diameter

    def deepest(self, tool: Tool) -> float:
        """Return how deep the tip may go, mm: as deep as the cone is high; how wide it may be at the surface says the
        rest.
        """
        return (tool.radius - tool.tip_diameter / 2) * tool.profile.cone

    def tip_depth(self, drawn: float, tool: Tool) -> float:
        """Return how deep the tip goes in a circle of a diameter, mm."""
        return (self.made(drawn, tool) - tool.tip_diameter) / 2 / math.tan(tool.tip_angle / 2)


@dataclass(frozen=True, slots=True)
class BoreOperation(HoleOperation):
    """Bore circles with a mill on a helix of the entry's slope, and once round at the floor; with `diameter` a
    counterbore.
    """

    diameter: float | None = parameter(None, *_DIAMETER, low=LEAST_LENGTH, option=True, auto="the circle's own")
    finish_width: float = parameter(
        0.2,
        "finish_width",
        "Finish width",
        "metal that the passes leave on walls for a finish pass; 0: none",
        Unit.LENGTH,
        high=100.0,
        option=True,
        group="Walls",
    )
    through: float = parameter(0.0, *THROUGH, high=1000.0, option=True)

    WORD = "bore"
    CLEARS = True
    LEVELS = True
    UNUSED = frozenset({"finish_depth", "floor_to_leave", "entry"})

    @property
    def beyond(self) -> float:
        """How far the mill goes on below the depth, mm."""
        return self.through

    def is_for(self, drawn: float, tool: Tool) -> bool:
        """Tell whether the mill moves at all in what is to be made."""
        return self.takes(drawn, tool)

    def takes(self, drawn: float, tool: Tool) -> bool:
        """Tell whether what is to be made is wider than the mill."""
        return self.made(drawn, tool) - 2 * self.cut.stock_to_leave >= tool.diameter + 2 * LEAST_LENGTH

    def made(self, drawn: float, tool: Tool) -> float:
        """Return the diameter of the bore, mm."""
        return drawn if self.diameter is None else self.diameter


@dataclass(frozen=True, slots=True)
class ThreadOperation(HoleOperation):
    """Mill a thread on a helix, in holes that are as wide as its core, or round bosses as wide as the thread."""

    thread: ThreadSize = parameter(ThreadSize.M6, *_THREAD, option=True)
    external: bool = parameter(
        False,
        "external",
        "On the boss",
        "the circle is a boss, and its outside gets the thread",
        Unit.FLAG,
        option=True,
        choices=("In the hole", "On the boss"),
        short="Where",
    )

    left_hand: bool = parameter(False, *LEFT_HAND, option=True, choices=("Right", "Left"), short="Hand")

    WORD = "thread"
    TOOL = "thread-mill"
    UNUSED = STRAIGHT_DOWN - {"direction"}

    @property
    def on_bosses(self) -> bool:
        """Whether its circles are bosses, round which its tool goes."""
        return self.external

    def lead(self, tool: Tool) -> float:
        """Return the radius of the half circle that leads the mill to a boss, mm."""
        return max(tool.radius / 2, self.thread.pitch)

    def around(self, tool: Tool) -> float:
        """Return how far round a boss the mill needs room, mm."""
        return tool.diameter + 2 * self.lead(tool) if self.external else 0.0

    @property
    def core(self) -> float:
        """Diameter at the roots of the thread's teeth, mm: of the hole before it is threaded, or of what is left of a
        boss.
        """
        return self.thread.bolt_core if self.external else self.thread.nut_core

    def is_for(self, drawn: float, tool: Tool) -> bool:
        """Tell whether a circle is as wide as the thread, or as the hole before it is cut."""
        sizes = [self.thread.major]
        if not self.external:
            sizes += [self.thread.nut_core, self.thread.tap_drill]
        return any(abs(drawn - each) <= ALIKE + _SAME for each in sizes)

    def takes(self, drawn: float, tool: Tool) -> bool:
        """Tell whether the mill fits into the core; outside it always does."""
        return self.external or tool.diameter < self.core

    def made(self, drawn: float, tool: Tool) -> float:
        """Return the thread's own diameter, mm."""
        return self.thread.major
