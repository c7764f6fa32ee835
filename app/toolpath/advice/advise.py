"""Which tool? What a drawing asks of its tools, and which of those at hand do it soonest, before there is any path."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import shapely
from shapely import Geometry as Shape

from ...core.errors import ParameterError
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import minutes_words
from ...geometry.near_points import places_of_each
from ...geometry.primitives import TURN, Indices, R, pack, points_at, signed_area
from ...model.entry import Entry, EntryKind
from ...model.part import Region
from ...model.tool import Tool
from ..coverage.areas import region_shapes
from .reach import FITS, CentreArea, RegionReach, centres, covered, reach
from .width import KINK, Floats, RegionWidths, Walls, widths

_CHORD = 1e-3
"""mm by which chords may leave arcs."""

SERIES = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0)
"""Diameters of end mills as they are sold, mm."""


@dataclass(frozen=True)
class SizedPlace:
    """A place and a size there, mm."""

    x: float
    y: float
    size: float


@dataclass(frozen=True)
class RegionAdvice:
    """What one region asks of its tools.

    Attributes:
        number: of the region.
        area_mm2: exact.
        passage: the narrowest passage: its width, and its middle. A cutter that is wider parts the region, misses a way
            round an island or does not get into a dead end. Without a narrower place it is the largest disc.
        disc: diameter and centre of the largest disc; no larger cutter fits anywhere.
        clearing: diameter of the largest cutter that leaves nothing but sharp inner corners, and where it only just
            fits.
        corners: how many sharp inner corners there are, and places where contours touch: every cutter leaves something
            in them. Bends below 5 degrees are none.
        corner: the sharpest inner corner; its size is the angle between the walls, radians; None = there is none.
        inner_radius: the smallest radius of an arc that a cutter has to follow from inside; None = there is none.
        reaches: what each tool reaches, in the order of the tools.
    """

    number: int
    area_mm2: float
    passage: SizedPlace
    disc: SizedPlace
    clearing: SizedPlace
    corners: int
    corner: SizedPlace | None
    inner_radius: SizedPlace | None
    reaches: tuple[RegionReach, ...]

    @property
    def smallest_radius(self) -> float:
        """Radius of the tightest inner corner, mm: 0 = a sharp one, inf = there is none."""
        if self.corners:
            return 0.0
        return self.inner_radius.size if self.inner_radius else math.inf


@dataclass(frozen=True)
class ToolChoice:
    """What one tool does in all regions together.

    Attributes:
        tool: the tool.
        share: of the whole area that it reaches, in [0, 1].
        parts: connected areas that it clears.
        left_mm2: what it leaves.
        left_disc: diameter of the largest disc in that, mm.
        times: when it clears and the advised contour tool does the rest; None for tools smaller than that.
    """

    tool: Tool
    share: float
    parts: int
    left_mm2: float
    left_disc: float
    times: CuttingTimes | None


@dataclass(frozen=True)
class Advice:
    """What a drawing asks of its tools, and which ones to take.

    Attributes:
        regions: each region.
        choices: each tool, the smallest first.
        pocket: the tool that clears, with which the estimated time is least.
        contour: the tool that follows the walls and clears what the pocket tool does not reach; both can be one.
        times: estimated for these two.
        why: the reasons, in a sentence or two.
    """

    regions: tuple[RegionAdvice, ...]
    choices: tuple[ToolChoice, ...]
    pocket: Tool
    contour: Tool
    times: CuttingTimes
    why: str


def standard_tools() -> tuple[Tool, ...]:
    """Return flat end mills of the usual diameters with the same feed each, when nobody says which tools there are."""
    return tuple(Tool(number, diameter) for number, diameter in enumerate(SERIES, 1))


def advise(
    regions: Sequence[Region],
    tools: Sequence[Tool] = (),
    plan: CuttingPlan | None = None,
    progress: Progress = NO_PROGRESS,
) -> Advice:
    """Return what some regions ask of their tools, and which of the tools to take.

    Args:
        regions: of a drawing; one at least.
        tools: to choose from, flat and bull-nose ones count; none = a standard series of 1 to 25 mm.
        plan: depth, stepover and the machine's rapids, for the estimate of time.

    Raises:
        ParameterError: there is no region, or none of the tools clears a flat floor.
        Cancelled: by progress.
    """
    if not regions:
        raise ParameterError("There is no closed contour to choose tools for; draw one, or choose other layers.")
    usable = [tool for tool in tools or standard_tools() if tool.kind.level]
    if not usable:
        raise ParameterError("None of the tools clears a flat floor; add a flat end mill to choose from.")
    usable.sort(key=lambda tool: (tool.diameter, tool.number))
    plan = plan or CuttingPlan()
    walls = Walls.of(pack(regions))
    found = widths(walls, progress.part(0.0, 0.3))
    numbers = [region.number for region in regions]
    least = float(found.clearing.min())
    contour = max(
        (tool for tool in usable if tool.diameter <= least + FITS), key=lambda tool: tool.diameter, default=usable[0]
    )
    clearing = [tool for tool in usable if tool.diameter >= contour.diameter]
    requested = {tool.radius - FITS for tool in usable} | {
        distance for tool in clearing for distance in distances(tool, contour)
    }
    where = centres(pack(regions), sorted(requested), progress.part(0.3, 0.6))
    shapes = [shapely.union_all(region_shapes([region], _CHORD)) for region in regions]
    own = places_of_each(walls.region, np.array(numbers))
    bare = [_region(walls, found, k, number, rows) for k, (number, rows) in enumerate(zip(numbers, own, strict=True))]
    advised = _with_reaches(
        bare, shapes, [_ToolCentres(tool, where[tool.radius - FITS]) for tool in usable], progress.part(0.6, 0.9)
    )
    taken: dict[int, CuttingTimes] = {}
    for done, tool in enumerate(clearing):
        progress.step(0.9 + 0.1 * done / len(clearing), f"Time with T{tool.number}")
        taken[tool.number] = times(tool, contour, where, plan)
    choices = tuple(_choice(tool, k, advised, taken) for k, tool in enumerate(usable))
    pocket = min(clearing, key=lambda tool: (taken[tool.number].total, tool.diameter))
    return Advice(advised, choices, pocket, contour, taken[pocket.number], _why((pocket, contour), advised, choices))


class _ToolCentres(NamedTuple):
    """A tool, and where its centre can be."""

    tool: Tool
    centres: CentreArea


def _with_reaches(
    regions: Sequence[RegionAdvice],
    shapes: Sequence[Shape],
    centres_of: Sequence[_ToolCentres],
    progress: Progress,
) -> tuple[RegionAdvice, ...]:
    """Return the regions with what each tool reaches of them."""
    found: list[list[RegionReach]] = [[] for _ in regions]
    for done, (tool, at) in enumerate(centres_of):
        for k, (region, shape) in enumerate(zip(regions, shapes, strict=True)):
            progress.step((done + k / len(regions)) / len(centres_of), f"What T{tool.number} reaches")
            if region.number in at.shapes:
                found[k].append(reach(shape, tool.diameter, at.shapes[region.number]))
            else:
                found[k].append(
                    RegionReach(tool.diameter, 0.0, 0, region.area_mm2, region.disc.size, region.disc.x, region.disc.y)
                )
    return tuple(replace(region, reaches=tuple(row)) for region, row in zip(regions, found, strict=True))


def _region(walls: Walls, found: RegionWidths, k: int, number: int, rows: Indices) -> RegionAdvice:
    """Return what the k-th region, of some rows of the walls, asks of its tools."""
    sharpest, corner = rows[np.argmax(walls.turn[rows])], None
    if walls.turn[sharpest] > KINK:
        corner = _spot(walls.rows[sharpest, :2], math.pi - walls.turn[sharpest])
    arcs = rows[walls.rows[rows, TURN] > 0]
    radius = None
    if len(arcs):
        tightest = walls.rows[arcs[np.argmin(walls.rows[arcs, R])]]
        radius = _spot(points_at(tightest[None], np.array([0.5]))[0], tightest[R])
    passage, disc = _spot(found.passage_at[k], found.passage[k]), _spot(found.disc_at[k], found.disc[k])
    clearing = _spot(found.clearing_at[k], found.clearing[k])
    return RegionAdvice(
        number=number,
        area_mm2=signed_area(walls.rows[rows]),
        passage=passage,
        disc=disc,
        clearing=clearing,
        corners=int(walls.sharp[rows].sum()),
        corner=corner,
        inner_radius=radius,
        reaches=(),
    )


def _spot(place: Floats, size: float) -> SizedPlace:
    return SizedPlace(float(place[0]), float(place[1]), float(size))


def _choice(tool: Tool, k: int, regions: Sequence[RegionAdvice], taken: Mapping[int, CuttingTimes]) -> ToolChoice:
    """Return what the k-th tool does in all regions."""
    reaches = [region.reaches[k] for region in regions]
    area, left = sum(region.area_mm2 for region in regions), sum(each.left_mm2 for each in reaches)
    return ToolChoice(
        tool,
        1 - left / area if area > 0 else 1.0,
        sum(each.parts for each in reaches),
        left,
        max(each.left_disc for each in reaches),
        taken.get(tool.number),
    )


def _why(tools: tuple[Tool, Tool], regions: Sequence[RegionAdvice], choices: Sequence[ToolChoice]) -> str:
    """Return why these two, pocket and contour tool, are advised."""
    pocket, contour = (next(choice for choice in choices if choice.tool is tool) for tool in tools)
    assert pocket.times is not None and contour.times is not None
    if contour.share == 0:
        widest = max((region.disc for region in regions), key=lambda disc: disc.size)
        return f"No tool fits: {_named(contour.tool)} is the smallest, and the largest disc is {_measured(widest)}."
    if pocket is contour:
        return (
            f"{_bounds(contour, regions)} It takes about {minutes_words(pocket.times.total)} min by itself; "
            "a larger one before it saves no time."
        )
    return (
        f"{_bounds(contour, regions)} {_named(pocket.tool)} reaches {100 * pocket.share:.0f} % of the area; with it "
        f"first the job takes about {minutes_words(pocket.times.total)} min, with {_named(contour.tool)} alone "
        f"{minutes_words(contour.times.total)} min."
    )


def _bounds(contour: ToolChoice, regions: Sequence[RegionAdvice]) -> str:
    """Return why this is the contour tool."""
    tightest = min((region.clearing for region in regions), key=lambda spot: spot.size)
    room = f"the tightest place has room for {_measured(tightest)}"
    corners = sum(region.corners for region in regions)
    but = "" if not corners else " but one sharp corner" if corners == 1 else f" but {corners} sharp corners"
    if contour.tool.diameter > tightest.size + FITS:
        return f"{_named(contour.tool)} is the smallest tool, and it leaves {contour.left_mm2:.2f} mm2: {room}."
    return f"{_named(contour.tool)} is the largest tool that leaves nothing{but}: {room}."


def _measured(spot: SizedPlace) -> str:
    return f"{spot.size:.3f} mm at ({spot.x:.3f}, {spot.y:.3f})"


def _named(tool: Tool) -> str:
    return tool.name or f"T{tool.number} {tool.label}"


# How long a pocket tool and a contour tool need for a drawing, from areas and lengths alone, before there is any path.
#
# Rings a stepover s apart in an area A whose outermost one is L long are A / s + L / 2 long in all (what one ring more
# or less makes is evened out), and L at least. What the pocket tool cannot reach and the contour tool's pass along the
# walls does not take with it is cleared by the contour tool, at its own stepover. Feeds are taken to be reached at
# once.


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
