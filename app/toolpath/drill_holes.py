"""Which circles of a drawing a drill operation drills, and which it leaves out."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import shapely

from ..core.tolerances import CURVE
from ..geometry.as_circle import as_circle
from ..model.curves import Circle
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.operation import DrillOperation
from ..model.part import Contour, Region
from ..model.tool import Tool
from .coverage.flat import region_shapes
from .drawn_contours import DrawnContours
from .selected import selected

ALIKE = 0.1
"""mm; circles whose diameter is this near to a drill's are its own."""

_CHORD = 1e-3


@dataclass(frozen=True, slots=True)
class CircleHole:
    """A circle of the drawing.

    Attributes:
        x, y: its centre, mm.
        diameter: mm.
    """

    x: float
    y: float
    diameter: float


@dataclass(frozen=True)
class DrillHoles:
    """The circles of a drill operation.

    Attributes:
        drilled: one a place.
        narrow: circles that were asked for and are narrower than the drill.
        held: circles over which clamps lie, or so near to one that drill or holder would touch it.
        others: circles of other diameters.
    """

    drilled: tuple[CircleHole, ...] = ()
    narrow: tuple[CircleHole, ...] = ()
    held: tuple[CircleHole, ...] = ()
    others: tuple[CircleHole, ...] = ()


def circle_of(contour: Contour) -> CircleHole | None:
    """Return the hole that a closed contour is where it is a circle, by whatever it is drawn; None where it is none."""
    circle = as_circle(contour)
    return None if circle is None else CircleHole(*circle.centre, 2 * circle.radius)


def holes_of(job: Job, drawn: DrawnContours, operation: DrillOperation) -> DrillHoles:
    """Return the circles of a drill operation, in the order of the drawing."""
    tool = job.tool(operation.cut.tool)
    circles = [
        hole for contour in selected(drawn, operation.cut.curves).closed if (hole := circle_of(contour)) is not None
    ]
    least, most = _asked(operation, tool)
    requested = [hole for hole in circles if least - 1e-6 <= hole.diameter <= most + 1e-6]
    others = tuple(hole for hole in circles if not least - 1e-6 <= hole.diameter <= most + 1e-6)
    fit = [hole for hole in requested if tool.diameter <= hole.diameter + ALIKE + 1e-6]
    narrow = tuple(hole for hole in requested if tool.diameter > hole.diameter + ALIKE + 1e-6)
    free, held = _free(_once_a_place(fit), job, drawn, operation)
    return DrillHoles(tuple(free), narrow, tuple(held), others)


def _asked(operation: DrillOperation, tool: Tool) -> tuple[float, float]:
    """Return the least and the largest diameter of an operation's circles, mm."""
    if operation.least is None and operation.most is None:
        return tool.diameter - ALIKE, tool.diameter + ALIKE
    return operation.least or 0.0, math.inf if operation.most is None else operation.most


def _once_a_place(holes: Iterable[CircleHole]) -> list[CircleHole]:
    """Return of holes round one centre the widest."""
    widest: dict[tuple[int, int], CircleHole] = {}
    for hole in holes:
        place = round(hole.x / CURVE), round(hole.y / CURVE)
        key = next(
            (key for dx in (-1, 0, 1) for dy in (-1, 0, 1) if (key := (place[0] + dx, place[1] + dy)) in widest), place
        )
        if key not in widest or hole.diameter > widest[key].diameter:
            widest[key] = hole
    return list(widest.values())


def _free(
    holes: list[CircleHole], job: Job, drawn: DrawnContours, operation: DrillOperation
) -> tuple[list[CircleHole], list[CircleHole]]:
    """Return the holes that no clamp is in the way of, and the others."""
    if not drawn.clamps or not holes:
        return holes, []
    clamps = shapely.union_all(region_shapes(drawn.clamps, _CHORD))
    far = shapely.distance(shapely.points([(hole.x, hole.y) for hole in holes]), clamps)
    reach = _reach(job.tool(operation.cut.tool), tip_depth(job, operation), job.keep_out_height) + _CHORD
    return (
        [hole for hole, room in zip(holes, far.tolist(), strict=True) if room >= reach],
        [hole for hole, room in zip(holes, far.tolist(), strict=True) if room < reach],
    )


def _reach(tool: Tool, depth: float, height: float) -> float:
    """Return how far from the hole's centre there must be no clamp, mm: for the drill, and for a holder that comes as
    low as clamps.
    """
    low = tool.holder and tool.stick_out and tool.stick_out - depth < height
    return max([tool.radius, *(radius for _, radius in tool.holder)]) if low else tool.radius


def tip_depth(job: Job, operation: DrillOperation) -> float:
    """Return how deep the drill's tip goes, mm: its full width goes to the depth where its angle is known, else the tip
    does.
    """
    return operation.cut.floor + operation.through + tip_length(job.tool(operation.cut.tool))


def tip_length(tool: Tool) -> float:
    """Return the length of a drill's point, mm; 0 of other tools, and where its angle is not known."""
    return tool.radius / math.tan(tool.tip_angle / 2) if tool.kind.drills and tool.tip_angle else 0.0


def hole_regions(job: Job, drawn: DrawnContours, operation: DrillOperation) -> tuple[Region, ...]:
    """Return the discs that a drill operation's cutter stays in: its circles, or its own width where it is wider by up
    to `ALIKE`.
    """
    radius = job.tool(operation.cut.tool).radius
    return tuple(
        Region(number, Contour((Circle((hole.x, hole.y), max(hole.diameter / 2, radius)),)))
        for number, hole in enumerate(holes_of(job, drawn, operation).drilled, 1)
    )


def made_by_drills(job: Job, drawn: DrawnContours) -> frozenset[CircleHole]:
    """Return the circles that drill operations make as wide as they are drawn: for mills these are no walls, and no
    lines to follow.
    """
    drills = [each for each in job.operations if isinstance(each, DrillOperation) and each.cut.enabled]
    return frozenset(
        hole
        for each in drills
        for hole in holes_of(job, drawn, each).drilled
        if hole.diameter <= job.tool(each.cut.tool).diameter + ALIKE + 1e-6
    )


def across_holes(findings: Iterable[Finding], job: Job, drawn: DrawnContours) -> list[Finding]:
    """Return findings about a drawing, of which those do not count that tell that something crosses a circle which
    drills make.
    """
    findings = list(findings)
    made = (
        made_by_drills(job, drawn)
        if any(each.kind is FindingKind.SELF_INTERSECTION for each in findings)
        else frozenset()
    )
    ids = {number for contour in drawn.closed if made and circle_of(contour) in made for number in contour.entity_ids}
    return [
        replace(each, counts=False)
        if each.kind is FindingKind.SELF_INTERSECTION and not ids.isdisjoint(each.entity_ids)
        else each
        for each in findings
    ]
