"""How a cutter gets into the metal and along a wall: entries, leads, tabs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from ..core.errors import ParameterError
from .curves import Point

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


@dataclass(frozen=True, slots=True)
class Entry:
    """The way down into metal. Where a helix does not fit a ramp along the path is taken, and where none fits a plunge; each is told.

    Attributes:
        kind: what is tried first; PREDRILLED = straight down into holes that operations before it have drilled, or that are there.
        angle: of helix and ramp against the plane, radians, in [0.001, pi / 4].
    """

    kind: EntryKind = EntryKind.HELIX
    angle: float = math.radians(3)

    def __post_init__(self) -> None:
        if not 1e-3 <= self.angle <= STEEPEST + 1e-9:
            raise ParameterError(f"Entry angle is {math.degrees(self.angle):g} degrees; use 0.06 to 45 degrees.")

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
    """The way to a wall and away from it, over ground where no wall is near. What does not fit is made smaller, then left out, and told.

    Attributes:
        kind: a quarter turn that is tangent to the path, a straight way at a right angle to it, or nothing.
        radius: of the arc, or length of the line, mm, in (0, 1000]; None = half the tool's diameter.
        overlap: how far the path goes on over its beginning before it leaves, mm, in [0, 50].
    """

    kind: LeadKind = LeadKind.ARC
    radius: float | None = None
    overlap: float = 0.5

    def __post_init__(self) -> None:
        if self.radius is not None and not 1e-3 <= self.radius <= LONGEST_LEAD:
            raise ParameterError(f"Lead radius is {self.radius:g} mm; use 0.001 to {LONGEST_LEAD:g} mm.")
        if not 0 <= self.overlap <= MOST_OVERLAP:
            raise ParameterError(f"Lead overlap is {self.overlap:g} mm; use 0 to {MOST_OVERLAP:g} mm.")

    @property
    def wanted(self) -> bool:
        """True when there is any."""
        return self.kind is not LeadKind.NONE


@dataclass(frozen=True, slots=True)
class Tabs:
    """Bridges of metal that hold a part that is cut out.

    Attributes:
        count: spread evenly along each contour, away from corners; 0 = none but those by hand. At most 100.
        width: of the metal that stands, mm, in [0.1, 1000].
        height: above the floor, mm, in [0.01, 1000]; no tab is higher than the stock's top.
        places: points near which a tab is put by hand, mm; each goes to the nearest contour.
    """

    count: int = 0
    width: float = 5.0
    height: float = 1.0
    places: tuple[Point, ...] = ()

    def __post_init__(self) -> None:
        if not 0 <= self.count <= 100:
            raise ParameterError(f"{self.count} tabs a contour are asked for; use 0 to 100.")
        if not 0.1 <= self.width <= 1000:
            raise ParameterError(f"Tab width is {self.width:g} mm; use 0.1 to 1000 mm.")
        if not 0.01 <= self.height <= 1000:
            raise ParameterError(f"Tab height is {self.height:g} mm; use 0.01 to 1000 mm.")
        if not all(math.isfinite(value) and abs(value) < 1e6 for place in self.places for value in place):
            raise ParameterError("A tab's place is no point of the plane; give X and Y in mm.")

    @property
    def wanted(self) -> bool:
        """True when there is any."""
        return self.count > 0 or bool(self.places)
