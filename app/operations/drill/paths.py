"""Drilling: the circles of the drawing, straight down at their centres."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...model.curve_selectors import CirclesOf, CurveNumber
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import Purpose
from ...model.operation import DrillOperation
from ...model.tool import Tool
from ...toolpath.build import Stroke, StrokeLabel
from ...toolpath.drill_holes import ALIKE, CircleHole, DrillHoles, holes_of, tip_depth, tip_length
from ...toolpath.operation_context import OperationContext
from ...toolpath.ordering.tour import in_short_order

_PECK_GAP = 0.254
"""mm above where the last peck ended that the drill goes down to at rapid rate: 0.01 inch, as LinuxCNC's own cycle has
it.
"""

_NAMED = 6
"""Diameters that a finding names."""


def drill(context: OperationContext, index: int, progress: Progress) -> None:
    """Drill every circle that the operation's drill is for: rapids over it and down to the retract height, then at
    plunge rate.

    Each peck goes so far below the one before, the first one below the retract height, and the drill then comes out to
    that height.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, DrillOperation)
    progress.step(0.0, "Looking for circles")
    if operation.cut.depth > job.stock.thickness + 1e-9:
        raise ParameterError(
            f"Depth is {operation.cut.depth:g} mm, but the stock is {job.stock.thickness:g} mm thick; "
            "reduce the depth, or let the drill go through below it."
        )
    holes, tool = holes_of(job, context.areas.drawn, operation), job.tool(operation.cut.tool)
    context.findings.extend(hole_findings(holes, job, operation))
    strokes = [_as_stroke(hole) for hole in holes.drilled]
    label = StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    stops = tuple(_stops(operation, job))
    for stroke in in_short_order(strokes, context.at, progress):
        _drill_hole(context, stroke.start, stops, label)
        context.at = stroke.start


def _as_stroke(hole: CircleHole) -> Stroke:
    """Return a hole as a stroke without a length, for the tour."""
    return Stroke(
        np.array([[hole.x, hole.y, hole.x, hole.y, 0.0, 0.0, 0.0, 0.0]]), np.array([Purpose.DRILL], np.uint8), 0
    )


def _stops(operation: DrillOperation, job: Job) -> Iterator[float]:
    """Yield the heights at which pecks end, mm, the bottom last; added up as a control adds them up, so that cycles can
    say them.
    """
    bottom = -tip_depth(job, operation)
    if operation.peck is not None:
        height = job.retract_z - operation.peck
        while height > bottom + 1e-9:
            yield height
            height -= operation.peck
    yield bottom


def _drill_hole(
    context: OperationContext, place: tuple[float, float], stops: Sequence[float], label: StrokeLabel
) -> None:
    job, builder = context.job, context.builder
    builder.straight((*place, job.travel_z), Purpose.RAPID, label)
    if job.retract_z < job.travel_z:
        builder.straight((*place, job.retract_z), Purpose.RAPID, label)
    for k, height in enumerate(stops):
        if k:
            builder.straight((*place, job.retract_z), Purpose.RAPID, label)
            if stops[k - 1] + _PECK_GAP < job.retract_z:
                builder.straight((*place, stops[k - 1] + _PECK_GAP), Purpose.RAPID, label)
        builder.straight((*place, height), Purpose.DRILL, label)
    builder.straight((*place, job.travel_z), Purpose.RAPID, label)


def hole_findings(holes: DrillHoles, job: Job, operation: DrillOperation) -> Iterator[Finding]:
    """Yield what is drilled how deep, and what is not."""
    tool = job.tool(operation.cut.tool)
    who = f"T{tool.number} {tool.label}"
    if not holes.drilled:
        others = f" Circles there are of {_diameters(holes.others)}." if holes.others else ""
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{who} has nothing to drill: the drawing has no circle that it is for.{others} "
            "Choose another drill, the diameters or the layers.",
        )
    elif holes.others:
        left = f"of other diameters {_counted(holes.others)} {'is' if len(holes.others) == 1 else 'are'} left out"
        yield Finding(
            FindingKind.LEFT_OUT,
            f"{who} drills {_counted(holes.drilled)}; {left}: {_diameters(holes.others)}.",
            counts=_names_them(operation),
            amount=float(len(holes.others)),
        )
    for kept, why in (
        (holes.narrow, f"narrower than the drill by more than {ALIKE:g} mm"),
        (holes.held, "under a clamp or too near to one"),
    ):
        if kept:
            first = f"({kept[0].x:.3f}, {kept[0].y:.3f})"
            where = f"the circle at {first} is" if len(kept) == 1 else f"{len(kept)} circles, the first at {first}, are"
            yield Finding(
                FindingKind.LEFT_OUT,
                f"{who}: {where} {why} and not drilled.",
                kept[0].x,
                kept[0].y,
                amount=float(len(kept)),
            )
    if holes.drilled:
        yield from _widths(holes.drilled, tool)
        yield _tip(tool, job, operation)


def _names_them(operation: DrillOperation) -> bool:
    """Tell whether an operation names the very circles that it is to drill, so that each of them counts."""
    curves = operation.cut.curves
    return bool(curves) and all(isinstance(each, CurveNumber | CirclesOf) for each in curves)


def _widths(drilled: Sequence[CircleHole], tool: Tool) -> Iterator[Finding]:
    """Yield that holes come out as wide as the drill, which is not as wide as they are drawn."""
    wrong = [hole for hole in drilled if abs(hole.diameter - tool.diameter) > 1e-3]
    if wrong:
        yield Finding(
            FindingKind.TOLERANCE,
            f"Holes come out {tool.diameter:g} mm wide, as T{tool.number} is; drawn are {_diameters(wrong)}.",
            counts=False,
            amount=max(abs(hole.diameter - tool.diameter) for hole in wrong),
        )


def _tip(tool: Tool, job: Job, operation: DrillOperation) -> Finding:
    """Return how deep the drill's point and its full width go."""
    deep, tip = tip_depth(job, operation), tip_length(tool)
    if tip:
        text = (
            f"T{tool.number} drills to the depth with its full width; its point goes {tip:.3f} mm deeper, to "
            f"{deep:.3f} mm."
        )
    elif tool.kind.drills:
        text = (
            f"T{tool.number} tells no tip angle, so its point goes to {deep:.3f} mm, and its full width less deep; "
            "give the angle, or let it go through."
        )
    else:
        text = f"T{tool.number} goes straight down to {deep:.3f} mm."
    return Finding(FindingKind.ASSUMED, text, counts=False, amount=deep)


def _counted(holes: Sequence[CircleHole]) -> str:
    return "1 circle" if len(holes) == 1 else f"{len(holes)} circles"


def _diameters(holes: Sequence[CircleHole]) -> str:
    """Return diameters in words, and how many of each."""
    counts = Counter(f"{hole.diameter:.3f}".rstrip("0").rstrip(".") for hole in holes)
    named = [f"{text} mm ({count})" for text, count in sorted(counts.items(), key=lambda item: float(item[0]))[:_NAMED]]
    return ", ".join(named) + (f" and {len(counts) - _NAMED} more" if len(counts) > _NAMED else "")
