"""Which circles of a drawing an operation on holes works on, and which it leaves out."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core.tolerances import CURVE
from ..geometry.as_circle import as_circle
from ..model.curve_selectors import CirclesOf, CurveNumber
from ..model.curves import Circle
from ..model.finding import Finding, FindingKind
from ..model.hole_operations import HoleOperation
from ..model.job import Job
from ..model.operation import ALIKE
from ..model.part import Contour, Region
from ..model.tool import Tool
from .coverage.areas import region_shapes
from .drawn_contours import DrawnContours, selected

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm by which chords may leave the arcs of clamps; drills keep off by so much more."""


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
    """The circles of an operation on holes.

    Attributes:
        drilled: what it works on, one a place.
        narrow: circles that were asked for and that its tool does not fit.
        held: circles over which clamps lie, or so near to one that tool or holder would touch it.
        others: circles of other diameters.
        outlines: circles that hold other closed contours and so are no holes; nobody has named them.
        emptied: circles that hold other closed contours, worked on because somebody has named them.
    """

    drilled: tuple[CircleHole, ...] = ()
    narrow: tuple[CircleHole, ...] = ()
    held: tuple[CircleHole, ...] = ()
    others: tuple[CircleHole, ...] = ()
    outlines: tuple[CircleHole, ...] = ()
    emptied: tuple[CircleHole, ...] = ()


def circle_of(contour: Contour) -> CircleHole | None:
    """Return the hole that a closed contour is where it is a circle, by whatever it is drawn; None where it is none."""
    circle = as_circle(contour)
    return None if circle is None else CircleHole(*circle.centre, 2 * circle.radius)


def holes_of(job: Job, drawn: DrawnContours, operation: HoleOperation) -> DrillHoles:
    """Return the circles of an operation on holes, in the order of the drawing."""
    tool = job.tool(operation.cut.tool)
    circles = [
        hole for contour in selected(drawn, operation.cut.curves).closed if (hole := circle_of(contour)) is not None
    ]
    wanted = [_asked(operation, tool, hole.diameter) for hole in circles]
    requested = [hole for hole, wants in zip(circles, wanted, strict=True) if wants]
    full = frozenset[CircleHole]() if operation.on_bosses else _full(requested, drawn)
    named = bool(operation.cut.curves) or operation.least is not None or operation.most is not None
    outlines = () if named else tuple(hole for hole in requested if hole in full)
    requested = [hole for hole in requested if named or hole not in full]
    others = tuple(hole for hole, wants in zip(circles, wanted, strict=True) if not wants)
    fit = [hole for hole in requested if operation.takes(hole.diameter, tool)]
    narrow = tuple(hole for hole in requested if not operation.takes(hole.diameter, tool))
    free, held = _free(_once_a_place(fit), job, drawn, operation)
    emptied = tuple(hole for hole in free if hole in full)
    return DrillHoles(tuple(free), narrow, tuple(held), others, outlines, emptied)


def _full(circles: Sequence[CircleHole], drawn: DrawnContours) -> frozenset[CircleHole]:
    """Return the circles inside of which other closed contours lie whole, but for circles about the same centre."""
    if not circles:
        return frozenset()
    from scipy.spatial import cKDTree  # takes longer to import than most drawings to read

    points = [_corners(contour) for contour in drawn.closed]
    centres = np.array([(hole.x, hole.y) for hole in circles])
    radii = np.array([hole.diameter / 2 for hole in circles]) - CURVE
    near = cKDTree([each[0] for each in points]).query_ball_point(centres, radii)
    return frozenset(
        hole
        for hole, centre, radius, found in zip(circles, centres, radii, near, strict=True)
        if any(_lies_in(points[k], centre, radius) and not _about(drawn.closed[k], hole) for k in found)
    )


def _corners(contour: Contour) -> Floats:
    """Return (n, 2) where the primitives of a contour begin; the middle and four points of a circle."""
    if len(contour.primitives) == 1 and isinstance(circle := contour.primitives[0], Circle):
        (x, y), r = circle.centre, circle.radius
        return np.array([(x, y), (x + r, y), (x, y + r), (x - r, y), (x, y - r)])
    return np.array([each.start for each in contour.primitives])


def _lies_in(points: Floats, centre: Floats, radius: float) -> bool:
    return bool(np.hypot(*(points - centre).T).max() < radius)


def _about(contour: Contour, hole: CircleHole) -> bool:
    """Tell whether a contour is a circle about the centre of another."""
    circle = circle_of(contour)
    return circle is not None and math.dist((circle.x, circle.y), (hole.x, hole.y)) <= CURVE


def names_circles(operation: HoleOperation) -> bool:
    """Tell whether an operation names the very circles that it works on, and none by where they lie."""
    curves = operation.cut.curves
    return bool(curves) and all(isinstance(each, CurveNumber | CirclesOf) for each in curves)


def _asked(operation: HoleOperation, tool: Tool, diameter: float) -> bool:
    """Tell whether an operation is to work on circles of a diameter, mm, of those that it selects: whoever names them,
    or diameters, means them, as wide as they may be; else they are those that the tool is for.
    """
    if operation.least is None and operation.most is None:
        return names_circles(operation) or operation.is_for(diameter, tool)
    most = math.inf if operation.most is None else operation.most
    return (operation.least or 0.0) - 1e-6 <= diameter <= most + 1e-6


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
    holes: list[CircleHole], job: Job, drawn: DrawnContours, operation: HoleOperation
) -> tuple[list[CircleHole], list[CircleHole]]:
    """Return the holes that no clamp is in the way of, and the others."""
    if not drawn.clamps or not holes:
        return holes, []
    clamps = shapely.union_all(region_shapes(drawn.clamps, _CHORD))
    far = shapely.distance(shapely.points([(hole.x, hole.y) for hole in holes]), clamps).tolist()
    tool, height = job.tool(operation.cut.tool), job.keep_out_height
    free = [
        room >= max(_reach(tool, tip_depth(job, operation), height), _half(operation, tool, hole)) + _CHORD
        for hole, room in zip(holes, far, strict=True)
    ]
    return (
        [hole for hole, stays in zip(holes, free, strict=True) if stays],
        [hole for hole, stays in zip(holes, free, strict=True) if not stays],
    )


def _reach(tool: Tool, depth: float, height: float) -> float:
    """Return how far from the hole's centre there must be no clamp, mm: for the tool, and for a holder that comes as
    low as clamps.
    """
    low = tool.holder and tool.stick_out and tool.stick_out - depth < height
    return max([tool.radius, *(radius for _, radius in tool.holder)]) if low else tool.radius


def _half(operation: HoleOperation, tool: Tool, hole: CircleHole) -> float:
    """Return the radius of what an operation makes at a hole, mm, with all of a tool that goes round it."""
    return operation.made(hole.diameter, tool) / 2 + operation.around(tool)


def tip_depth(job: Job, operation: HoleOperation) -> float:
    """Return how deep the tool's tip goes, mm: a drill's full width goes to the depth where its angle is known, else
    the tip does.
    """
    length = tip_length(job.tool(operation.cut.tool)) if operation.DRILLS else 0.0
    return operation.cut.floor + operation.beyond + length


def tip_length(tool: Tool) -> float:
    """Return the length of a drill's point, mm; 0 of other tools, and where its angle is not known."""
    return tool.radius / math.tan(tool.tip_angle / 2) if tool.kind.drills and tool.tip_angle else 0.0


def hole_regions(job: Job, drawn: DrawnContours, operation: HoleOperation) -> tuple[Region, ...]:
    """Return the discs that the cutter of an operation on holes stays in: what it makes, or the circle where that is
    wider by up to `ALIKE`.
    """
    tool = job.tool(operation.cut.tool)
    return tuple(
        Region(number, Contour((Circle((hole.x, hole.y), _room(operation, tool, hole)),)))
        for number, hole in enumerate(holes_of(job, drawn, operation).drilled, 1)
    )


def _room(operation: HoleOperation, tool: Tool, hole: CircleHole) -> float:
    """Return the radius that the cutter stays in at a hole, mm."""
    half = _half(operation, tool, hole)
    return max(half, hole.diameter / 2) if operation.DRILLS and not operation.CARVES else half


def made_by_drills(job: Job, drawn: DrawnContours) -> frozenset[CircleHole]:
    """Return the circles that operations on holes make as wide as they are drawn: for mills these are no walls, and no
    lines to follow.
    """
    works = [each for each in job.operations if isinstance(each, HoleOperation) and each.cut.enabled]
    return frozenset(
        hole
        for each in works
        if not each.on_bosses
        for hole in holes_of(job, drawn, each).drilled
        if hole.diameter <= each.made(hole.diameter, job.tool(each.cut.tool)) + ALIKE + 1e-6
    )


def without_drilled(contours: Iterable[Contour], made: Collection[CircleHole | None]) -> list[Contour]:
    """Return contours without the circles that drills make, see `made_by_drills`."""
    return [each for each in contours if circle_of(each) not in made] if made else list(contours)


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
