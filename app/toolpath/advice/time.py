"""How long a pocket tool and a contour tool need for a drawing, from areas and lengths alone, before there is any path.

Rings a stepover s apart in an area A whose outermost one is L long are A / s + L / 2 long in all (what one ring more or
less makes is evened out), and L at least. What the pocket tool cannot reach and the contour tool's pass along the walls
does not take with it is cleared by the contour tool, at its own stepover. Feeds are taken to be reached at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import shapely
from shapely import Geometry as Shape

from ...core.errors import ParameterError
from ...model.entry import Entry, EntryKind
from ...model.tool import Tool
from .reach import FITS, CentreArea, covered


@dataclass(frozen=True)
class CuttingPlan:
    """What is to be cut, and how fast the machine is.

    Attributes:
        depth, stepdown: of the floor and of one pass at most, mm, > 0.
        stepover: between rings, as a share of the diameter, in (0, 1].
        safe_z, retract_z: clearance height and where plunges begin, mm above the stock.
        rapid: mm/min.
        tool_change: s.
        entry: how each stroke goes into the metal at each depth.
    """

    depth: float = 2.0
    stepdown: float = 2.0
    stepover: float = 0.5
    safe_z: float = 5.0
    retract_z: float = 1.0
    rapid: float = 3000.0
    tool_change: float = 0.0
    entry: Entry = Entry()

    def __post_init__(self) -> None:
        if not (self.depth > 0 and self.stepdown > 0 and 0 < self.stepover <= 1 and self.rapid > 0):
            raise ParameterError(
                f"Depth {self.depth:g} mm, stepdown {self.stepdown:g} mm, stepover {self.stepover:g} of the diameter "
                f"and rapids {self.rapid:g} mm/min must be greater than 0, and the stepover 1 at most."
            )

    @property
    def passes(self) -> int:
        """Depth passes."""
        return max(1, math.ceil(self.depth / self.stepdown - 1e-9))


@dataclass(frozen=True)
class CuttingTimes:
    """Seconds that a pair of tools needs.

    Attributes:
        pocket: of the pocket tool.
        contour: of the contour tool along the walls.
        rest: of the contour tool where the pocket tool does not reach.
        change: of the tool change.
    """

    pocket: float
    contour: float
    rest: float = 0.0
    change: float = 0.0

    @property
    def total(self) -> float:
        """All of it."""
        return self.pocket + self.contour + self.rest + self.change


def distances(pocket: Tool, contour: Tool) -> tuple[float, float, float]:
    """Return the distances from the walls, mm, that `times` asks of two tools.

    They are those of the contour tool's centre, of the pocket tool's outermost frame, and of the far side of the
    contour pass.
    """
    return contour.radius - FITS, contour.radius + pocket.radius - FITS, contour.diameter - FITS


def times(pocket: Tool, contour: Tool, where: Mapping[float, CentreArea], plan: CuttingPlan) -> CuttingTimes:
    """Return how long two tools need.

    Args:
        pocket: clears what lies farther from the walls than the contour tool's centre.
        contour: follows the walls and clears the rest.
        where: centres at the `distances` of the two.
    """
    along, frame, beyond = (where[distance] for distance in distances(pocket, contour))
    clearing = max(frame.length, frame.area / (plan.stepover * pocket.diameter) + frame.length / 2)
    seconds = _cutting(pocket, clearing, _Strokes(_areas(frame), 1.0), plan)
    cleared = {region: covered(shape, pocket.radius) for region, shape in frame.shapes.items()}
    metal = 1.0 - min(1.0, sum(shape.area for shape in cleared.values()) / along.area) if along.area > 0 else 1.0
    wall = _cutting(contour, along.length, _Strokes(along.rings, metal), plan)
    rest = 0.0
    if pocket.diameter > contour.diameter:
        left = _rest(beyond, cleared, contour)
        rest = _cutting(contour, left.area / (plan.stepover * contour.diameter), left.strokes, plan)
    return CuttingTimes(seconds, wall, rest, plan.tool_change if pocket.number != contour.number else 0.0)


def _areas(centres: CentreArea) -> int:
    """Return how many connected areas there are."""
    return sum(shapely.get_num_geometries(shape) for shape in centres.shapes.values())


class _Strokes(NamedTuple):
    """How many strokes there are, and the share of them that goes down into metal."""

    number: int
    into_metal: float


class _Rest(NamedTuple):
    """What two tools leave: its area, mm2, and the strokes for its pieces; those by themselves begin in metal."""

    area: float
    strokes: _Strokes


def _rest(beyond: CentreArea, cleared: Mapping[int, Shape], contour: Tool) -> _Rest:
    """Return what neither the pocket tool nor the contour pass takes."""
    area, pieces, alone = 0.0, 0, 0
    for region, shape in beyond.shapes.items():
        left = shapely.get_parts(shapely.difference(shape, cleared[region]) if region in cleared else shape)
        left = left[shapely.area(left) > contour.diameter * FITS]
        area, pieces = area + float(shapely.area(left).sum()), pieces + len(left)
        if region in cleared:
            shapely.prepare(cleared[region])
            left = left[~shapely.dwithin(cleared[region], left, contour.radius)]
        alone += len(left)
    return _Rest(area, _Strokes(pieces, alone / max(pieces, 1)))


def _cutting(tool: Tool, length: float, strokes: _Strokes, plan: CuttingPlan) -> float:
    """Return the seconds for so many mm at each depth in so many strokes, of which a share goes down into metal."""
    if length <= 0:
        return 0.0
    count, metal = strokes
    step = plan.depth / plan.passes
    # down to the metal of a pass, in the mean
    above = plan.retract_z + plan.depth * (plan.passes - 1) / (2 * plan.passes)
    fast = 2 * plan.safe_z - plan.retract_z + step + above
    down = above / tool.plunge_rate + metal * _entry(tool, step, plan.entry) + (1 - metal) * step / tool.feed_rate
    return plan.passes * 60 * (length / tool.feed_rate + count * (down + fast / plan.rapid))


def _entry(tool: Tool, step: float, entry: Entry) -> float:
    """Return the minutes in which a tool goes down into metal by a step, mm."""
    if entry.kind not in (EntryKind.HELIX, EntryKind.RAMP):
        return step / tool.plunge_rate
    slope = math.sin(entry.angle)
    return step / slope / min(max(tool.feed_rate / 2, min(tool.plunge_rate, tool.feed_rate)), tool.plunge_rate / slope)
