"""What of a tool does not cut, as convex bodies: its shank, and the holder that it stands in.

The shank begins where the flutes end and has its own diameter; of the neck between them nobody tells, so it is taken to
be as wide as the shank. Metal that stands higher than the flutes in the shank's way is not cut but rubbed, whatever the
shank's diameter is; a shank as wide as the cutter fits into a wall that the cutter has cut. The holder stands on the
tip at its stick-out. Both are taken to go on upwards for ever: over a field of heights, what is above metal that they
meet is met as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from itertools import pairwise

from ...model.tool import Tool
from ..cutter import Cutter


class HolderPart(Enum):
    """What of a tool does not cut; the value is the word for it."""

    SHANK = "shank"
    HOLDER = "holder"


@dataclass(frozen=True, slots=True)
class Body:
    """A convex body that does not cut; `shape.lift` is its height over the tool's tip, mm."""

    part: HolderPart
    shape: Cutter

    def lifted(self, by: float) -> Body:
        """Return the body, mm higher over the tip."""
        return replace(self, shape=replace(self.shape, lift=self.shape.lift + by))


def bodies_of(tool: Tool) -> tuple[Body, ...]:
    """Return what of a tool does not cut, the shank first.

    A shank is known where its diameter and the length of the flutes are, a holder where its outline and the stick-out
    are.
    """
    return (*_shank(tool), *(each.lifted(tool.stick_out) for each in holder_of(tool)))


def holder_of(tool: Tool) -> tuple[Body, ...]:
    """Return the holder of a tool as if it stood on the tip: frustums that widen, and a disc under each that does not.

    Empty where the outline or the stick-out is not known. What stands over something as wide is left out.
    """
    if not (tool.holder and tool.stick_out):
        return ()
    made: list[Cutter] = []
    widest = 0.0
    for (height, radius), (above, wider) in pairwise(tool.holder):
        widens = wider > max(widest, radius)
        if radius > widest and not (widens and above > height):
            made.append(Cutter(radius, radius, lift=height))
            widest = radius
        if widens:
            made.append(
                Cutter(wider, radius, slope=(above - height) / (wider - radius), lift=height)
                if above > height
                else Cutter(wider, wider, lift=height)
            )
            widest = wider
    return tuple(Body(HolderPart.HOLDER, shape) for shape in made)


def _shank(tool: Tool) -> tuple[Body, ...]:
    if not (tool.shank_diameter and tool.flute_length):
        return ()
    radius = tool.shank_diameter / 2
    return (Body(HolderPart.SHANK, Cutter(radius, radius, lift=tool.flute_length)),)
