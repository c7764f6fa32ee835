"""What all operations on holes share: which circles they take in which order, and what is said of the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.errors import ParameterError
from ..core.progress import Progress
from ..core.wording import in_plane, trimmed
from ..model.finding import Finding, FindingKind
from ..model.hole_operations import HoleOperation, TapOperation, ThreadOperation
from ..model.job import Job
from ..model.moves import Purpose
from ..model.operation import Operation
from ..model.tool import Tool
from ..toolpath.build import Stroke, StrokeLabel
from ..toolpath.drawn_contours import DrawnContours
from ..toolpath.drill_holes import CircleHole, DrillHoles, holes_of, names_circles
from ..toolpath.machining_areas import MachiningArea, MachiningAreas
from ..toolpath.operation_context import OperationContext
from ..toolpath.ordering.tour import in_short_order

_HERE = 1e-3
"""mm between the centres of holes that are one."""

_ROUNDING = 1e-9
"""mm that a hole may be less deep than what is done in it."""

_NAMED = 6
"""Diameters that a finding names."""


@dataclass(frozen=True)
class HoleVerb:
    """What an operation does to holes, in words.

    Attributes:
        base, third, done: "drill", "drills", "drilled".
        tool: what its tool is called.
        narrow: why a circle cannot be done, of one or several: "... is narrower than the drill".
    """

    base: str
    third: str
    done: str
    tool: str
    narrow: str


def holes_in_order(
    context: OperationContext, index: int, verb: HoleVerb, progress: Progress
) -> Iterator[tuple[CircleHole, StrokeLabel]]:
    """Yield the circles of an operation in an order of short ways, and say what there is to say of them.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, HoleOperation)
    progress.step(0.0, "Looking for circles")
    check_hole_depth(job, operation, verb)
    holes, tool = holes_of(job, context.areas.drawn, operation), job.tool(operation.cut.tool)
    context.findings.extend(circle_findings(holes, job, operation, verb))
    label = StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    by_place = {(hole.x, hole.y): hole for hole in holes.drilled}
    for stroke in in_short_order([_as_stroke(hole) for hole in holes.drilled], context.at, progress):
        yield by_place[stroke.start], label
        context.at = stroke.start


def check_hole_depth(job: Job, operation: HoleOperation, verb: HoleVerb) -> None:
    """Refuse a depth that the stock has not.

    Raises:
        ParameterError: it is deeper.
    """
    if not operation.CARVES and operation.cut.depth > job.stock.thickness + 1e-9:
        raise ParameterError(
            f"Depth is {operation.cut.depth:g} mm, but the stock is {job.stock.thickness:g} mm thick; "
            f"reduce the depth, or let the {verb.tool} go through below it."
        )


def _as_stroke(hole: CircleHole) -> Stroke:
    """Return a hole as a stroke without a length, for the tour."""
    return Stroke(
        np.array([[hole.x, hole.y, hole.x, hole.y, 0.0, 0.0, 0.0, 0.0]]), np.array([Purpose.DRILL], np.uint8), 0
    )


def over_hole(context: OperationContext, place: tuple[float, float], label: StrokeLabel) -> None:
    """Go over a place, and down to the retract height."""
    job, builder = context.job, context.builder
    builder.straight((*place, job.travel_z), Purpose.RAPID, label)
    if job.retract_z < job.travel_z:
        builder.straight((*place, job.retract_z), Purpose.RAPID, label)


def out_of_hole(context: OperationContext, label: StrokeLabel) -> None:
    """Go straight up to where the tool travels."""
    x, y, _ = context.builder.at
    context.builder.straight((x, y, context.job.travel_z), Purpose.RAPID, label)


def circle_findings(holes: DrillHoles, job: Job, operation: HoleOperation, verb: HoleVerb) -> Iterator[Finding]:
    """Yield which circles an operation does not work on, and why."""
    tool = job.tool(operation.cut.tool)
    who = f"T{tool.number} {tool.label}"
    yield from _about_others(holes, tool, operation, verb)
    for kept, why in ((holes.narrow, verb.narrow), (holes.held, "under a clamp or too near to one")):
        if kept:
            first = f"({kept[0].x:.3f}, {kept[0].y:.3f})"
            where = f"the circle at {first} is" if len(kept) == 1 else f"{len(kept)} circles, the first at {first}, are"
            text, x, y = f"{who}: {where} {why} and not {verb.done}.", kept[0].x, kept[0].y
            yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(len(kept)))
    outline = f"not {verb.done}, as other contours lie inside; to have that done, name it in curves, or its diameter"
    for kept, why in ((holes.outlines, outline), (holes.emptied, f"{verb.done} with the contours that lie inside")):
        if kept:
            one = f"{_counted(kept)}, {'' if len(kept) == 1 else 'the first '}at ({kept[0].x:.3f}, {kept[0].y:.3f}),"
            text = f"{who}: {one} {'is' if len(kept) == 1 else 'are'} {why}."
            x, y = kept[0].x, kept[0].y
            yield Finding(FindingKind.LEFT_OUT, text, x, y, counts=False, amount=float(len(kept)))


def _about_others(holes: DrillHoles, tool: Tool, operation: HoleOperation, verb: HoleVerb) -> Iterator[Finding]:
    """Yield that there is no circle for a tool, or that those of other diameters are left out."""
    who = f"T{tool.number} {tool.label}"
    if not holes.drilled:
        others = f" Circles there are of {diameters_in_words(holes.others)}." if holes.others else ""
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{who} has nothing to {verb.base}: the drawing has no circle that it is for.{others} "
            f"Choose another {verb.tool}, the diameters or the layers.",
        )
    elif holes.others:
        left = f"of other diameters {_counted(holes.others)} {'is' if len(holes.others) == 1 else 'are'} left out"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{who} {verb.third} {_counted(holes.drilled)}; {left}: {diameters_in_words(holes.others)}.",
            counts=names_circles(operation),
            amount=float(len(holes.others)),
        )


def circles_missed(verb: HoleVerb) -> Callable[[MachiningAreas, Operation, MachiningArea | None], Iterator[Finding]]:
    """Return what tells of operations with a verb which circles they do not work on: `missed` of an
    `OperationMethod`.
    """

    def missed(areas: MachiningAreas, operation: Operation, _: MachiningArea | None) -> Iterator[Finding]:
        assert isinstance(operation, HoleOperation)
        return circle_findings(holes_of(areas.job, areas.drawn, operation), areas.job, operation, verb)

    return missed


def width_findings(holes: Sequence[CircleHole], tool: Tool) -> Iterator[Finding]:
    """Yield that holes come out as wide as the tool, which is not as wide as they are drawn."""
    wrong = [hole for hole in holes if abs(hole.diameter - tool.diameter) > 1e-3]
    if wrong:
        yield Finding(
            FindingKind.TOLERANCE,
            f"Holes come out {tool.diameter:g} mm wide, as T{tool.number} is; drawn are {diameters_in_words(wrong)}.",
            counts=False,
            amount=max(abs(hole.diameter - tool.diameter) for hole in wrong),
        )


def thread_findings(
    holes: Sequence[CircleHole], tool: Tool, operation: TapOperation | ThreadOperation
) -> Iterator[Finding]:
    """Yield that threads are cut at circles that are drawn as wide as neither the thread nor its hole."""
    wrong = [hole for hole in holes if not operation.is_for(hole.diameter, tool)]
    if wrong:
        yield Finding(
            FindingKind.TOLERANCE,
            f"T{tool.number} cuts {operation.thread.value} where circles of another width are drawn: "
            f"{diameters_in_words(wrong)}.",
            counts=False,
            amount=float(len(wrong)),
        )


def no_thread_findings(
    holes: Sequence[CircleHole], before: HolesBefore, operation: TapOperation | ThreadOperation, depth: float
) -> Iterator[Finding]:
    """Yield that holes are so wide before they are threaded that no more than half of a tooth stands there.

    Args:
        depth: to which the thread is cut, mm.
    """
    thread = operation.thread
    wide = [hole for hole in holes if (before.at(hole, depth) or 0.0) > thread.pitch_diameter]
    if wide:
        x, y, made = wide[0].x, wide[0].y, before.at(wide[0], depth) or 0.0
        what = f"more than the pitch diameter of {thread.value}, {thread.pitch_diameter:.3f} mm"
        advice = f"less than half of each tooth would stand; drill {thread.tap_drill:g} mm instead"
        text = (
            f"The hole at {in_plane(x, y)} is made {made:.3f} mm wide before it is threaded, {what}: {advice}."
            if len(wide) == 1
            else f"{len(wide)} holes are made too wide before they are threaded, the first, at {in_plane(x, y)}, "
            f"{made:.3f} mm, {what}: {advice}."
        )
        yield Finding(FindingKind.ENGAGEMENT, text, x, y, amount=float(len(wide)))


class HolesBefore:
    """The holes that operations before one in the list make, by where they are: of one place there may be several,
    such as a counterbore and what is drilled in its middle.
    """

    def __init__(self, job: Job, drawn: DrawnContours, index: int) -> None:
        """Find the holes of all operations before `index`."""
        self._made: dict[tuple[int, int], list[tuple[float, float]]] = {}
        for each in job.operations[:index]:
            if (
                isinstance(each, HoleOperation)
                and each.cut.enabled
                and not (each.CARVES or each.TAPS or isinstance(each, ThreadOperation))
            ):
                depth, tool = each.cut.floor + each.beyond, job.tool(each.cut.tool)
                left = 0.0 if "stock_to_leave" in each.UNUSED else 2 * each.cut.stock_to_leave
                for hole in holes_of(job, drawn, each).drilled:
                    key = round(hole.x / _HERE), round(hole.y / _HERE)
                    self._made.setdefault(key, []).append((each.made(hole.diameter, tool) - left, depth))

    def at(self, hole: CircleHole, depth: float) -> float | None:
        """Return how wide the hole round the centre of a circle is down to a depth, mm; None: none is as deep."""
        x, y = round(hole.x / _HERE), round(hole.y / _HERE)
        near = (each for dx in (-1, 0, 1) for dy in (-1, 0, 1) for each in self._made.get((x + dx, y + dy), ()))
        return max((diameter for diameter, deep in near if deep >= depth - _ROUNDING), default=None)


def _counted(holes: Sequence[CircleHole]) -> str:
    return "1 circle" if len(holes) == 1 else f"{len(holes)} circles"


def diameters_in_words(holes: Sequence[CircleHole]) -> str:
    """Return diameters in words, and how many of each."""
    counts = Counter(trimmed(hole.diameter, 3) for hole in holes)
    named = [f"{text} mm ({count})" for text, count in sorted(counts.items(), key=lambda item: float(item[0]))[:_NAMED]]
    return ", ".join(named) + (f" and {len(counts) - _NAMED} more" if len(counts) > _NAMED else "")
