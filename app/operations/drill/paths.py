"""Drilling: the circles of the drawing, straight down at their centres."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ...core.progress import Progress
from ...model.finding import Finding, FindingKind
from ...model.hole_operations import DrillOperation
from ...model.job import Job
from ...model.moves import Purpose
from ...model.operation import ALIKE
from ...model.tool import Tool
from ...toolpath.build import StrokeLabel
from ...toolpath.drill_holes import DrillHoles, holes_of, tip_depth, tip_length
from ...toolpath.operation_context import OperationContext
from ..holes import HoleVerb, circle_findings, holes_in_order, out_of_hole, over_hole, width_findings

PECK_GAP = 0.254
"""mm above where the last peck ended that the drill goes down to at rapid rate, or up to where the chip is but broken:
0.01 inch, as LinuxCNC's own cycles have it.
"""

VERB = HoleVerb("drill", "drills", "drilled", "drill", f"narrower than the drill by more than {ALIKE:g} mm")


def drill(context: OperationContext, index: int, progress: Progress) -> None:
    """Drill every circle that the operation's drill is for: rapids over it and down to the retract height, then at
    plunge rate.

    Each peck goes so far below the one before, the first one below the retract height, and the drill then comes out to
    that height, or only a little up where the chip is to be broken.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, DrillOperation)
    stops = tuple(_stops(operation, job))
    for hole, label in holes_in_order(context, index, VERB, progress):
        over_hole(context, (hole.x, hole.y), label)
        _strokes(context, (hole.x, hole.y), stops, operation.chip_break, label)
        out_of_hole(context, label)
    context.findings.extend(_depth_findings(holes_of(job, context.areas.drawn, operation), job, operation))


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


def _strokes(
    context: OperationContext, place: tuple[float, float], stops: Sequence[float], breaks: bool, label: StrokeLabel
) -> None:
    job, builder = context.job, context.builder
    for k, height in enumerate(stops):
        if k:
            again = stops[k - 1] + PECK_GAP
            if not breaks:
                builder.straight((*place, job.retract_z), Purpose.RAPID, label)
            if again < job.retract_z or breaks:
                builder.straight((*place, again), Purpose.RAPID, label)
        builder.straight((*place, height), Purpose.DRILL, label)


def hole_findings(holes: DrillHoles, job: Job, operation: DrillOperation) -> Iterator[Finding]:
    """Yield what is drilled how deep, and what is not."""
    yield from circle_findings(holes, job, operation, VERB)
    yield from _depth_findings(holes, job, operation)


def _depth_findings(holes: DrillHoles, job: Job, operation: DrillOperation) -> Iterator[Finding]:
    tool = job.tool(operation.cut.tool)
    if holes.drilled:
        yield from width_findings(holes.drilled, tool)
        yield _tip(tool, job, operation)


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
