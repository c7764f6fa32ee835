"""What is to be done with a tool: one frozen parameter set a kind of operation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from ..core.errors import ParameterError
from .curve_selectors import Selector
from .entry import Entry, Lead
from .fields import Unit, check_ranges, parameter, part, required, required_part
from .tool import Tool

OPEN_EDGES = (
    "open_edges",
    "Open edges",
    "walls that lie on the stock's edge are none: the tool comes in from outside there and goes past the edge",
    Unit.FLAG,
)
"""Declared alike by all kinds that clear an area from its walls or its middle."""

LEAST_LENGTH = 1e-3
"""mm; a smaller depth, step or height would vanish in the digits of an NC program."""

MOST_PASSES = 1_000
"""Depth passes of one operation; more are a slip of the pen."""

MOST_SPRING_PASSES = 10
"""Times, at most; more are a slip of the keyboard."""
LEAST_ENGAGED = 0.05
"""Share of the diameter; a feed that follows less would never be reached."""


class Direction(Enum):
    """Side of the standing metal, spindle clockwise (M3): climb = metal on the right of travel."""

    CLIMB = "climb"
    CONVENTIONAL = "conventional"


class Side(Enum):
    """Where a contour path runs: inside the areas that the drawing bounds, round them, or with the tool's centre on the
    lines.
    """

    INSIDE = "inside"
    OUTSIDE = "outside"
    ON = "on"


@dataclass(frozen=True, slots=True)
class SideStrip:
    """An area along open lines.

    Attributes:
        left: it lies on their left, as they are drawn; else on their right.
        reach: how far it goes, mm.
    """

    left: bool
    reach: float


class CutterCompensation(Enum):
    """Who offsets a contour to its side: the program alone, also the control by the wear in the tool's register, or
    the control alone, by the tool's whole radius.
    """

    COMPUTER = "computer"
    WEAR = "wear"
    CONTROL = "control"


class Order(Enum):
    """Which tool cuts first: the list's order, or all contours before the rest, as in 1986."""

    POCKET_FIRST = "pocket-first"
    PATENT_1986 = "1986"


@dataclass(frozen=True, slots=True)
class CutParameters:
    """Parameters that every operation has. Depths go down from Z 0 = top of stock, in at most 1,000 passes."""

    tool: int = required("tool", "Tool", "T number of a tool of the job", Unit.COUNT, high=1e9)
    depth: float = parameter(
        2.0, "depth", "Depth", "from the stock's top down to the floor", Unit.LENGTH, low=LEAST_LENGTH, option=True
    )
    stepdown: float = parameter(
        2.0,
        "stepdown",
        "Stepdown",
        "largest depth of one pass; passes are made equal",
        Unit.LENGTH,
        low=LEAST_LENGTH,
        option=True,
        short="Step down",
    )
    stock_to_leave: float = parameter(
        0.0,
        "stock_to_leave",
        "Stock to leave",
        "metal left on the walls on purpose",
        Unit.LENGTH,
        high=9_999.0,
        option=True,
        group="Walls",
    )
    direction: Direction = parameter(
        Direction.CLIMB,
        "direction",
        "Direction",
        "side of the standing metal: climb = right of travel",
        Unit.CHOICE,
        choices=("Climb", "Conventional"),
    )
    enabled: bool = parameter(
        True, "enabled", "Enabled", "off: the operation stays in the list and makes no moves", Unit.FLAG
    )
    finish_depth: float = parameter(
        0.0,
        "finish_depth",
        "Finish pass",
        "thickness of a last pass on the floor; 0: none",
        Unit.LENGTH,
        high=1000.0,
        option=True,
        group="Floor",
        on_pixels=True,
    )
    floor_to_leave: float = parameter(
        0.0,
        "floor_to_leave",
        "Floor to leave",
        "metal left on the floor on purpose",
        Unit.LENGTH,
        high=1000.0,
        option=True,
        group="Floor",
        on_pixels=True,
    )
    entry: Entry = part(Entry)
    curves: tuple[Selector, ...] = parameter(
        (),
        "curves",
        "Curves",
        "that it machines; none named: all that the job does",
        Unit.CURVES,
        option=True,
        group="Feed and layers",
    )

    def __post_init__(self) -> None:
        check_ranges(self)
        passes = math.ceil(self.depth / self.stepdown - 1e-9)
        if passes > MOST_PASSES:
            raise ParameterError(
                f"Depth {self.depth:g} mm in steps of {self.stepdown:g} mm makes {passes} passes; "
                f"{MOST_PASSES} are the most, so take a larger stepdown."
            )
        if not 0 <= self.floor_to_leave <= self.depth - LEAST_LENGTH:
            raise ParameterError(
                f"Floor to leave is {self.floor_to_leave:g} mm; it must be 0 or more and less than the depth, "
                f"{self.depth:g} mm."
            )
        if not 0 <= self.finish_depth <= self.floor - LEAST_LENGTH:
            raise ParameterError(
                f"The finish pass is {self.finish_depth:g} mm thick; it must be 0 (none) or more and less than "
                f"what is cut, {self.floor:g} mm."
            )

    @property
    def floor(self) -> float:
        """How deep the tool goes: depth - floor to leave, mm."""
        return self.depth - self.floor_to_leave


ENGAGED = (
    "most_engaged",
    "Limit of engagement",
    "of the diameter: where the cutter is engaged over more, the feed is slowed; 100 %: never",
    Unit.SHARE,
)
"""Declared alike by all kinds whose feed may follow what is engaged."""

MOST_ENGAGED = (
    "most_engaged_deg",
    "Engaged at most",
    "angle of the cutter's rim that may be in metal, anywhere; 90: half of the diameter, 60: a quarter",
    Unit.ANGLE,
)
LIFT = (
    "lift",
    "Lift",
    "how high the tool goes on its way back over ground that is cut; 0: it stays down",
    Unit.LENGTH,
)
"""Declared alike, as the angle above, by all kinds that go in arcs."""

THROUGH = (
    "through",
    "Through",
    "how far the tool goes on below the depth, so that its full width comes through",
    Unit.LENGTH,
)
"""Declared alike by all kinds that go through."""

DWELL = ("dwell", "Dwell", "how long the tool turns at the bottom of the hole", Unit.TIME)
"""Declared alike by all kinds that may wait there."""


SIDE = (
    "side",
    "Side",
    "where the contour tool runs: inside the areas, outside, or on the lines",
    Unit.CHOICE,
)
"""Declared alike by all kinds that follow contours on one of their sides."""

STRAIGHT_DOWN = frozenset(
    {"stepdown", "stock_to_leave", "direction", "finish_depth", "floor_to_leave", "entry", "entry_angle"}
)
"""Keys of parameters that have no effect on a tool that goes straight down."""

ALIKE = 0.1
"""mm; circles whose diameter is this near to a drill's are its own."""

STEPOVER = (
    "stepover",
    "Stepover",
    "distance between rings: a length, or per cent of the diameter; every stepover clears everything",
    Unit.LENGTH,
)


@dataclass(frozen=True, slots=True)
class CarvingCone:
    """A cone all of which a cutter cuts, with which what is left of slanted walls is proven.

    Attributes:
        tip: radius of the flat at its end, mm; less by as much as it reaches over edges on purpose.
        rate: mm of radius per mm of height.
        greatest: how deep its tip goes at most, mm.
        lifted: how much higher its tip is than the cutter's, mm.
        flat: radius of the flat at the cutter's own end, mm: in places that are narrower it leaves metal at the walls.
    """

    tip: float
    rate: float
    greatest: float
    lifted: float
    flat: float


@dataclass(frozen=True, slots=True)
class Operation:
    """What is to be done with one tool. A kind of operation is a subclass with parameters of its own, which `register`
    makes known.

    Attributes:
        WORD: the kind in job files, reports, NC headers, and in words.
        NAME: what it is called in the window where that is not its word; "" = its word.
        TOOL: the word of the one kind of tool that can do it; "" = any that mills, or drills where it does.
        UNUSED: keys of parameters of the parts that have no effect on this kind.
        HOLES: whether it works on circles, each by itself, and on nothing else.
        DRILLS: whether its tool goes straight down and never sideways, so that it may be a drill.
        TAPS: whether the spindle turns back for the way out, which a control does in a cycle alone.
        LEVELS: whether it leaves a level floor within its area that is to be free of metal.
        CLEARS: whether it clears the whole floor of its area, in rings.
        COARSE: whether its tool is the wide one, that goes over the area before others follow.
        FOLLOWS_WALLS: whether its path runs along the walls, or on the lines, and not over an area.
        CARVES: whether its cutter's cone makes slanted walls that end at the drawn lines, and no floor.
        CARVES_ROUND: whether a ball makes such walls, too, hollow ones.
        FACES: whether it works on all of the stock's top, whatever is drawn.
    """

    cut: CutParameters = required_part(CutParameters)

    WORD: ClassVar[str]
    NAME: ClassVar[str] = ""
    TOOL: ClassVar[str] = ""
    UNUSED: ClassVar[frozenset[str]] = frozenset()
    HOLES: ClassVar[bool] = False
    DRILLS: ClassVar[bool] = False
    TAPS: ClassVar[bool] = False
    LEVELS: ClassVar[bool] = True
    CLEARS: ClassVar[bool] = False
    COARSE: ClassVar[bool] = False
    FOLLOWS_WALLS: ClassVar[bool] = False
    CARVES: ClassVar[bool] = False
    CARVES_ROUND: ClassVar[bool] = False
    FACES: ClassVar[bool] = False

    @property
    def wall_side(self) -> Side | None:
        """On which side of the drawn lines its cutter is; None where these are no walls to it."""
        return Side.INSIDE

    @property
    def takes_open(self) -> bool:
        """Whether it machines open lines."""
        return self.wall_side is Side.ON

    def beside_open(self, tool: Tool) -> SideStrip | None:
        """Return the area beside open lines that it machines; None where closed contours bound its areas."""
        return None

    @property
    def follows_lines(self) -> bool:
        """Whether it has its tool's centre on the lines, or drills, so that it bounds no area."""
        return self.wall_side in (None, Side.ON)

    def line_width(self, tool: Tool) -> float | None:
        """Return how wide the slots along the drawn lines are that bound its area, mm; None where the lines do."""
        return None

    @property
    def beyond(self) -> float:
        """How far below its floor its tool goes on purpose, mm."""
        return 0.0

    def deepest(self, tool: Tool) -> float:
        """Return how deep its tool goes, mm, without the point of a drill."""
        return self.cut.floor + self.beyond

    def prepared_by(self, tool: Tool) -> tuple[Operation, ...]:
        """Return the operations, with other tools, that it asks to come right before it; `tool`: its own."""
        return ()

    @property
    def over_edge(self) -> float:
        """How far its cutter reaches beyond the drawn lines at the surface on purpose, mm."""
        return 0.0

    @property
    def dwell_s(self) -> float:
        """How long its tool waits at the bottom of a hole, s."""
        return 0.0

    @property
    def turns_left(self) -> bool:
        """Whether its tool turns counter-clockwise on its way in (M4)."""
        return False

    @property
    def takes_points(self) -> bool:
        """Whether drawn points are holes for it, as wide as its tool."""
        return False

    @property
    def engagement_limit(self) -> float:
        """Share of the diameter in (0, 1] beyond which the feed is slowed; 1 = never."""
        return 1.0

    @property
    def proven_angle(self) -> float | None:
        """Engaged angle, radians, that the written program must not exceed anywhere; None = there is no such limit."""
        return None

    @property
    def fastest_cut(self) -> float:
        """Times the feed rate at which its tool goes at most, where less is engaged than at such an angle."""
        return 1.0

    @property
    def lift_between(self) -> float:
        """How high its tool goes between passes that keep to such an angle, over ground that is cut, mm."""
        return 0.0

    def carved_by(self, tool: Tool) -> CarvingCone:
        """Return the cone that its carving is proven with: that of its tool, narrower by what it reaches over edges."""
        flat = tool.tip_diameter / 2
        return CarvingCone(flat - self.over_edge, math.tan(tool.tip_angle / 2), self.deepest(tool), 0.0, flat)

    @property
    def wear(self) -> float:
        """How far the operator may offset its paths in the control, mm, either way; 0 = there is no word for it."""
        return 0.0

    @property
    def offset_by_control(self) -> bool:
        """Whether its drawn contour is written, for the control to offset by the tool's whole radius."""
        return False

    @property
    def outer_lead(self) -> Lead | None:
        """How its paths round the outside of the drawing come to the walls; None where it has none there."""
        return None

    @property
    def opens_edges(self) -> bool:
        """Whether its area goes on past the stock's edges, where walls lie on them."""
        return False

    @property
    def roughed_allowance(self) -> float:
        """Metal that its first passes leave on the walls, mm: what stays there, and what its last pass takes."""
        return self.cut.stock_to_leave

    @property
    def ring_stepover(self) -> float | None:
        """Distance between its rings as it was asked for, mm; None = automatic, or it has no rings."""
        return None

    @property
    def on_pixels(self) -> bool:
        """Whether the way of 1986, on pixels alone, makes its paths too."""
        return False


@dataclass(frozen=True, slots=True)
class PocketOperation(Operation):
    """Clear the area inside with the pocket tool (steps 141-148). Overlap (the 1986 text's parameter) = diameter -
    stepover.
    """

    stepover: float | None = parameter(None, *STEPOVER, low=LEAST_LENGTH, high=9_999.0, auto="automatic")
    outside_in: bool = parameter(
        False,
        "outside_in",
        "Beginning",
        "begin at the walls (steps 141-148), and not inside, so that more of the path is a slot",
        Unit.FLAG,
        option=True,
        choices=("Inside", "At the walls"),
        short="Begin",
    )
    most_engaged: float = parameter(
        1.0, *ENGAGED, low=LEAST_ENGAGED, high=1.0, option=True, group="Feed and layers", short="Slow beyond"
    )

    open_edges: bool = parameter(False, *OPEN_EDGES, option=True)

    WORD = "pocket"
    CLEARS = True
    COARSE = True

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def engagement_limit(self) -> float:
        """Share of the diameter beyond which the feed is slowed."""
        return self.most_engaged

    @property
    def ring_stepover(self) -> float | None:
        """Distance between its rings as it was asked for, mm; None = automatic."""
        return self.stepover

    @property
    def opens_edges(self) -> bool:
        """Whether its area goes on past the stock's edges, where walls lie on them."""
        return self.open_edges

    @property
    def on_pixels(self) -> bool:
        """Pockets are what the way of 1986 was made for."""
        return True


@dataclass(frozen=True, slots=True)
class RestOperation(Operation):
    """Clear what the operations before it in the list have left within reach of its tool."""

    stepover: float | None = parameter(None, *STEPOVER, low=LEAST_LENGTH, high=9_999.0, auto="automatic")
    most_engaged: float = parameter(
        1.0, *ENGAGED, low=LEAST_ENGAGED, high=1.0, option=True, group="Feed and layers", short="Slow beyond"
    )

    WORD = "rest"
    CLEARS = True

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def ring_stepover(self) -> float | None:
        """Distance between its rings as it was asked for, mm; None = automatic."""
        return self.stepover

    @property
    def engagement_limit(self) -> float:
        """Share of the diameter beyond which the feed is slowed."""
        return self.most_engaged
