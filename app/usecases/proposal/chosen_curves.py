"""Operations for curves that somebody chose, with a word for what they are to become: the tool is proposed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import in_plane
from ...geometry.as_circle import as_circle
from ...geometry.primitives import contour_rows, lengths
from ...model.chamfer_operation import ChamferOperation
from ...model.contour_operation import ContourOperation
from ...model.curve_selectors import CurveNumber, Selector
from ...model.entry import Tabs
from ...model.hole_operations import BoreOperation, CountersinkOperation
from ...model.job import Copies, Job
from ...model.operation import CutParameters, Operation, Order, Side
from ...model.part import Contour
from ...model.slot_operation import SlotOperation
from ...model.tool import Tool
from ...model.tool_kind import ToolKind
from ...model.vcarve_operation import VcarveOperation
from ...toolpath.drawn_contours import DrawnContours, drawn_contours
from .contour_sorts import SortedContours, by_diameter
from .propose import WIDEST, ProposalWork, ProposedOperation, regions_within, shipped_tools, tabs_for
from .rack import Rack, room

LINE_TOOL = 3.0
"""mm; the widest mill that is proposed to follow a line, whose slot is as wide."""


class CurvePurpose(Enum):
    """What curves are to become."""

    POCKET = "pocket"
    OUTSIDE = "contour outside"
    INSIDE = "contour inside"
    ON = "contour on line"
    SLOT = "slot"
    DRILL = "drill"
    BORE = "bore"
    COUNTERSINK = "countersink"
    CHAMFER = "chamfer"
    ENGRAVE = "engrave"
    VCARVE = "V-carve"


_OF_CIRCLES = (CurvePurpose.DRILL, CurvePurpose.BORE, CurvePurpose.COUNTERSINK)


@dataclass(frozen=True)
class ChosenOperations:
    """A job with operations for chosen curves.

    Attributes:
        job: with the operations, their tools, and the stock that they need.
        index: of the first of the new operations.
        added: these, one after the other in the job; several where holes have several sizes.
        others: how many operations that are switched on machine all curves of the job besides.
    """

    job: Job
    index: int
    added: tuple[ProposedOperation, ...]
    others: int


def with_chosen(
    job: Job, numbers: Iterable[int], way: CurvePurpose, progress: Progress = NO_PROGRESS
) -> ChosenOperations:
    """Return the job with an operation for curves of its drawing.

    What cuts parts out goes last, holes first, all else before what cuts parts out.

    Args:
        job: to add to. numbers: of curves. way: what they are to become.
        progress: to tell and to be cancelled by.

    Raises:
        GeometryError: they cannot become that.
        ParameterError: no tool can be had.
        Cancelled: by progress.
    """
    progress.step(0.0, "Sorting contours")
    seen, requested = drawn_contours(replace(job, copies=Copies())), frozenset(numbers)
    contours = _touched(seen, requested)
    _check(contours, way)
    thickness = job.stock.thickness
    rack = Rack(_tools(job), list(job.tools))
    work = ProposalWork(seen, SortedContours(), rack, thickness, min(CutParameters(1).depth, thickness))
    made = [
        replace(each, operation=_of(each.operation, some, requested))
        for some in _groups(work, contours, way)
        for each in _made(work, some, way, progress.part(0.1, 1.0))
    ]
    place = _place(job, way)
    own = [each.operation for each in made]
    operations = (*job.operations[:place], *own, *job.operations[place:])
    used = {each.cut.tool for each in own} - {tool.number for tool in job.tools}
    new = tuple(tool for tool in rack.taken if tool.number in used)
    rack.taken = [tool for tool in rack.taken if tool.number in {each.cut.tool for each in own}]
    progress.step(1.0)
    return ChosenOperations(
        replace(
            job,
            tools=(*job.tools, *new),
            operations=operations,
            stock=work.stock(job.stock),
            order=Order.POCKET_FIRST,  # cut as listed
        ),
        place,
        tuple(made),
        sum(each.cut.enabled and not each.cut.curves for each in job.operations),
    )


def numbers_of(job: Job, numbers: Iterable[int]) -> tuple[Selector, ...]:
    """Return the selectors of the contours that some curves are of, one a contour, by the lowest of these numbers.

    Raises:
        GeometryError: the job machines none of them.
    """
    requested = frozenset(numbers)
    contours = _touched(drawn_contours(replace(job, copies=Copies())), requested)
    _check(contours, CurvePurpose.ON)
    return _numbers(contours, requested)


def refusals(seen: DrawnContours, numbers: Iterable[int]) -> dict[CurvePurpose, str]:
    """Return what curves cannot become, with a sentence that says why; what no tool can be had for is not looked at.

    Args:
        seen: the contours of their drawing, without copies. numbers: of the curves.
    """
    contours = _touched(seen, frozenset(numbers))
    said = {way: _refusal(contours, way) for way in CurvePurpose}
    return {way: why for way, why in said.items() if why}


def _touched(seen: DrawnContours, requested: frozenset[int]) -> list[Contour]:
    """Return the contours that some curves, by their numbers, are of."""
    return [each for each in (*seen.closed, *seen.open) if requested.intersection(each.entity_ids)]


def _numbers(contours: Sequence[Contour], requested: frozenset[int]) -> tuple[Selector, ...]:
    return tuple(
        CurveNumber(number) for number in sorted(min(requested.intersection(each.entity_ids)) for each in contours)
    )


def _of(operation: Operation, contours: Sequence[Contour], requested: frozenset[int]) -> Operation:
    return replace(operation, cut=replace(operation.cut, curves=_numbers(contours, requested)))


def _check(contours: Sequence[Contour], way: CurvePurpose) -> None:
    """Refuse curves that cannot become what they are to."""
    why = _refusal(contours, way)
    if why:
        raise GeometryError(why)


def _refusal(contours: Sequence[Contour], way: CurvePurpose) -> str:
    """Return why curves cannot become something; "" = they can."""
    if not contours:
        return "No selected curve is machined by this job; select a curve of a layer that is shown."
    if way in (CurvePurpose.ON, CurvePurpose.SLOT, CurvePurpose.ENGRAVE):
        return ""
    return next(filter(None, (_refusal_of_one(each, way) for each in contours)), "")


def _refusal_of_one(contour: Contour, way: CurvePurpose) -> str:
    """Return why a contour cannot bound an area, or be a hole, where that is asked for."""
    x, y = contour.primitives[-1].end
    if not contour.closed:
        return (
            f"A selected curve is open at {in_plane(x, y)}, so it bounds nothing; close it, or choose contour on "
            "line, slot or engrave."
        )
    if way in _OF_CIRCLES and as_circle(contour) is None:
        done = {CurvePurpose.DRILL: "drilled", CurvePurpose.BORE: "bored"}.get(way, "countersunk")
        return (
            f"The selected curve through {in_plane(x, y)} is no circle, so it cannot be {done}; choose pocket "
            "or contour inside."
        )
    return ""


def _tools(job: Job) -> tuple[Tool, ...]:
    """Return the tools of a job, then those of the library that are none of them, each with a number of its own."""

    def shape(tool: Tool) -> tuple[object, ...]:
        return tool.kind, tool.diameter, tool.tip_angle, tool.corner_radius

    found, shapes = list(job.tools), {shape(tool) for tool in job.tools}
    for tool in shipped_tools():
        taken = {each.number for each in found}
        if shape(tool) not in shapes:
            found.append(tool if tool.number not in taken else replace(tool, number=max(taken) + 1))
    return tuple(found)


def _groups(work: ProposalWork, contours: Sequence[Contour], way: CurvePurpose) -> list[Sequence[Contour]]:
    """Return what goes into an operation each: circles of one diameter, of all diameters that one mill bores."""
    if way not in _OF_CIRCLES:
        return [contours]
    sizes = by_diameter(contours)
    if way is not CurvePurpose.BORE:
        return [some for _, some in sizes]
    by_tool: dict[int, list[Contour]] = {}
    for size, some in sizes:
        by_tool.setdefault(work.rack.take(work.rack.boring(size, work.thickness)).number, []).extend(some)
    return list(by_tool.values())


def _made(
    work: ProposalWork, contours: Sequence[Contour], way: CurvePurpose, progress: Progress
) -> list[ProposedOperation]:
    """Return the operation for contours that can become this."""
    mine = tuple(contours)
    match way:
        case CurvePurpose.POCKET:
            work.found = SortedContours(pockets=mine)
            return work.pockets(progress)[:1]
        case CurvePurpose.OUTSIDE:
            work.found = SortedContours(outlines=mine)
            return work.outlines()
        case CurvePurpose.ENGRAVE:
            work.found = SortedContours(lines=mine)
            return [replace(each, why=f"engraved {each.operation.cut.depth:g} mm deep") for each in work.lines()]
        case CurvePurpose.DRILL:
            work.found = SortedContours(holes=by_diameter(mine))
            made = work.drills()
            if not made:
                (size, _), *_ = work.found.holes
                raise GeometryError(
                    f"There is no drill of {size:g} mm in the library; choose contour inside, which mills the hole, or "
                    "add a drill."
                )
            return made
        case CurvePurpose.INSIDE:
            return [_inside(work, mine)]
        case CurvePurpose.VCARVE:
            return [_carved(work)]
        case CurvePurpose.BORE:
            return [_bored(work, mine)]
        case CurvePurpose.COUNTERSINK | CurvePurpose.CHAMFER:
            return [_edged(work, mine, way)]
        case _:
            tool = work.rack.fitting(LINE_TOOL, LINE_TOOL, work.depth)
            cut = work.cut(tool, work.depth, ())
            if way is CurvePurpose.SLOT:
                return [ProposedOperation(SlotOperation(cut), f"a slot along the lines, {work.depth:g} mm deep")]
            return [ProposedOperation(ContourOperation(cut, Side.ON), f"along the lines, {work.depth:g} mm deep")]


def _carved(work: ProposalWork) -> ProposedOperation:
    """Return what carves the area between contours with a V cutter, no deeper than its cone is high."""
    pointed = [tool for tool in work.rack.tools if tool.kind is ToolKind.V and tool.tip_angle]
    if not pointed:
        raise GeometryError("There is no V cutter among the tools, which carving needs; add one to the library.")
    used = [tool for tool in pointed if tool in work.rack.taken]
    tool = used[0] if used else work.rack.engraver()
    cone = (tool.diameter - tool.tip_diameter) / 2 / math.tan(tool.tip_angle / 2)
    depth = min(work.depth, cone)
    cut = CutParameters(work.rack.take(tool).number, depth, depth)
    return ProposedOperation(
        VcarveOperation(cut), f"carved from wall to wall, {depth:g} mm at the deepest, with {tool.label}"
    )


def _bored(work: ProposalWork, contours: Sequence[Contour]) -> ProposedOperation:
    """Return a bore through the stock, of holes that one mill bores."""
    sizes = [size for size, _ in by_diameter(contours)]
    tool = work.rack.boring(sizes[0], work.thickness)
    operation = BoreOperation(work.cut(tool, work.thickness, ()))
    if not operation.takes(sizes[0], tool):
        raise GeometryError(
            f"There is no mill for a bore of {sizes[0]:g} mm in the library: the thinnest is {tool.diameter:g} mm; "
            "choose drill, or add a mill."
        )
    many = f"{len(contours)} holes" if len(contours) > 1 else "hole"
    wide = f"{sizes[0]:g}" if len(sizes) == 1 else f"{sizes[0]:g} to {sizes[-1]:g}"
    return ProposedOperation(operation, f"{many} of {wide} mm bored on a helix, through, with {tool.diameter:g} mm")


def _edged(work: ProposalWork, contours: Sequence[Contour], way: CurvePurpose) -> ProposedOperation:
    """Return a cone at the edges of circles, or a chamfer along contours: inside of those that lie in others."""
    if way is CurvePurpose.COUNTERSINK:
        ((size, _), *_) = by_diameter(contours)
        tool = work.rack.take(work.rack.cone(size))
        cone = CountersinkOperation(CutParameters(tool.number))
        return ProposedOperation(cone, f"cones {size:g} mm wide at the top")
    wide = ChamferOperation(CutParameters(1))
    tool = work.rack.take(work.rack.cone(2 * (wide.width + wide.tip_offset)))
    inner = all(id(each) in work.seen.inner for each in contours)
    chamfer = ChamferOperation(CutParameters(tool.number), Side.INSIDE if inner else Side.OUTSIDE)
    return ProposedOperation(chamfer, f"edges broken {chamfer.width:g} mm wide")


def _inside(work: ProposalWork, contours: Sequence[Contour]) -> ProposedOperation:
    """Return a contour along the inside, with tabs where something could fall out."""
    tool = work.rack.fitting(room(regions_within(contours)), WIDEST, work.thickness)
    shortest = min(float(lengths(contour_rows(each)).sum()) for each in contours)
    around = math.pi * tool.diameter
    tabs = tabs_for(contours, around) if shortest > 2 * around else Tabs()
    tabs = replace(tabs, height=min(Tabs().height, work.thickness / 2))
    cut = work.cut(tool, work.thickness, ())
    held = f", with {tabs.count} tabs to hold what falls out" if tabs.count else ""
    return ProposedOperation(ContourOperation(cut, Side.INSIDE, tabs=tabs), f"along the inside, through{held}")


def _place(job: Job, way: CurvePurpose) -> int:
    """Return where in the list an operation goes."""
    if way is CurvePurpose.DRILL:
        return 0
    outlines = [k for k, each in enumerate(job.operations) if each.wall_side is Side.OUTSIDE]
    return outlines[0] if outlines and way is not CurvePurpose.OUTSIDE else len(job.operations)
