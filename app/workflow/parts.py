"""What is to come out of the metal: a drawing milled to depths, or a solid. What a cut is judged against."""

from __future__ import annotations

from dataclasses import dataclass

from app.dexel.solid import SolidStock
from app.model.job import Job
from app.model.part import Region

TOLERANCE = 0.01
"""mm; metal within this of the part is neither gouged nor left."""


@dataclass(frozen=True, eq=False)
class FlatPart:
    """Regions of a drawing, sunk into the metal.

    Attributes:
        job: whose operations say how deep, how much stock is left on walls, and which tools are there; its part is the drawing.
        regions: that are machined, part coordinates; their walls are upright, and Z 0 is the part's top.
        origin: the program's zero, mm, part coordinates: program = part - origin.
        wall_tolerance: within which a wall counts as met, mm: what path and writing may be off.
        tolerance: of heights, mm.
    """

    job: Job
    regions: tuple[Region, ...]
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wall_tolerance: float = 0.002
    tolerance: float = TOLERANCE


@dataclass(frozen=True, eq=False)
class SolidPart:
    """A solid, program coordinates.

    Attributes:
        solid: closed.
        leave: stock to be left on all of its surface, mm, >= 0.
        tolerance: within which its surface counts as met, mm.
    """

    solid: SolidStock
    leave: float = 0.0
    tolerance: float = TOLERANCE


Part = FlatPart | SolidPart
