"""How a cutter gets into the metal and along a wall: entries, leads, tabs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from ..core.options import option
from .curves import Point
from .fields import Condition, Unit, check_ranges, parameter

SHALLOWEST = 1e-3
"""Radians; a ramp that hardly goes down would never arrive."""

STEEPEST = math.radians(45)
"""Radians; a steeper ramp is a plunge by another name."""

LONGEST_LEAD = 1000.0
"""mm."""

MOST_OVERLAP = 50.0
"""mm; no mark on a wall wants more, and most paths are too short for it."""


class EntryKind(Enum):
    """How a cutter goes down into metal."""

    HELIX = "helix"
    RAMP = "ramp"
    PLUNGE = "plunge"
    PREDRILLED = "predrilled"


_SLOPED = Condition(lambda operation: operation.cut.entry.sloped, "a slope", 'write entry = "helix" or "ramp"')
_LED = Condition(lambda operation: operation.lead.enabled, "a lead", 'write lead = "arc" or "line"')
_HELD = Condition(
    lambda operation: operation.tabs.enabled,
    "tabs",
    "add tabs = 4 or tab_places",
    lambda: f"{option('tabs', 'N')} makes some",
)


@dataclass(frozen=True, slots=True)
class Entry:
    """The way down into metal. Where a helix does not fit a ramp along the path is taken, and where none fits a plunge;
    each is told.

    PREDRILLED is straight down into holes that operations before it have drilled, or that are there.
    """

    kind: EntryKind = parameter(
        EntryKind.HELIX,
        "entry",
        "Entry",
        "into the metal; what does not fit falls back to a ramp, then a plunge",
        Unit.CHOICE,
        option=True,
        group="Entry",
        short="Way down",
        on_pixels=True,
        choices=("Helix, else ramp", "Ramp along the path", "Straight down", "Into drilled holes"),
    )
    angle: float = parameter(
        math.radians(3),
        "entry_angle",
        "Entry angle",
        "of helix and ramp against the plane",
        Unit.ANGLE,
        low=SHALLOWEST,
        high=STEEPEST,
        option="ramp-angle",
        group="Entry",
        short="Angle",
        needs=_SLOPED,
        on_pixels=True,
    )

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def sloped(self) -> bool:
        """True when the way down has an angle."""
        return self.kind in (EntryKind.HELIX, EntryKind.RAMP)


class LeadKind(Enum):
    """How a contour path comes to its wall and leaves it."""

    ARC = "arc"
    LINE = "line"
    NONE = "none"


@dataclass(frozen=True, slots=True)
class Lead:
    """The way to a wall and away from it, over ground where no wall is near. What does not fit is made smaller, then
    left out, and told.

    An arc is a quarter turn that is tangent to the path, a line a straight way at a right angle to it.
    """

    kind: LeadKind = parameter(
        LeadKind.ARC,
        "lead",
        "Lead",
        "to a wall and away from it",
        Unit.CHOICE,
        option=True,
        group="Lead in and out",
        choices=("Arc", "Line", "None"),
    )
    radius: float | None = parameter(
        None,
        "lead_radius",
        "Lead radius",
        "of the arc, or length of the line",
        Unit.LENGTH,
        low=1e-3,
        high=LONGEST_LEAD,
        option=True,
        auto="half the tool's diameter",
        group="Lead in and out",
        short="Radius",
        needs=_LED,
    )
    overlap: float = parameter(
        0.5,
        "lead_overlap",
        "Lead overlap",
        "how far a contour goes on over its beginning before it leaves",
        Unit.LENGTH,
        high=MOST_OVERLAP,
        option=True,
        group="Lead in and out",
        short="Overlap",
        needs=_LED,
    )

    def __post_init__(self) -> None:
        check_ranges(self)

    @property
    def enabled(self) -> bool:
        """True when there is any."""
        return self.kind is not LeadKind.NONE


@dataclass(frozen=True, slots=True)
class Tabs:
    """Bridges of metal that hold a part that is cut out, away from corners; none is higher than the stock's top."""

    count: int = parameter(
        0,
        "tabs",
        "Tabs",
        "bridges of metal that hold what is cut out, spread evenly along each contour",
        Unit.COUNT,
        high=100,
        option=True,
        group="Tabs",
        short="Each contour",
    )
    width: float = parameter(
        5.0,
        "tab_width",
        "Tab width",
        "of the metal that stands",
        Unit.LENGTH,
        low=0.1,
        high=1000,
        option=True,
        group="Tabs",
        short="Width",
        needs=_HELD,
    )
    height: float = parameter(
        1.0,
        "tab_height",
        "Tab height",
        "of the metal that stands, above the floor",
        Unit.LENGTH,
        low=0.01,
        high=1000,
        option=True,
        group="Tabs",
        short="Height",
        needs=_HELD,
    )
    places: tuple[Point, ...] = parameter(
        (),
        "tab_places",
        "Tab places",
        "points near which a tab is put by hand; each goes to the nearest contour",
        Unit.POINTS,
        group="Tabs",
    )

    def __post_init__(self) -> None:
        check_ranges(self)
        if not all(math.isfinite(value) and abs(value) < 1e6 for place in self.places for value in place):
            raise ParameterError("A tab's place is no point of the plane; give X and Y in mm.")

    @property
    def enabled(self) -> bool:
        """True when there is any."""
        return self.count > 0 or bool(self.places)
