"""Adaptive clearing: an area cleared by a cutter that is nowhere engaged by more than an angle, see `limit`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.offset.offset import OffsetLevel
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.operation import Direction, Operation
from ...model.part import Units
from ...toolpath.build import StrokeLabel
from ...toolpath.entry.entry import EntryContext
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.narrow_regions import finest, necks, too_small
from ...toolpath.operation_context import ANY_DIGITS, OperationContext, ProgramDigits, check_depth, levels_of
from ..from_outside import know_as_clear, open_stock
from .limit import DigitGrid, EngagementLimit
from .passes import DiscPasses, clear_feed, farthest, nearest_first
from .plan import ClearingTask, ConnectedPath, least_turn, mirrored, mirrored_part, plan

_INCH = 2.54
"""Times the digits of a program in inches are coarser: 0.00001 in against 0.0001 mm."""

_TOLD = 20
"""Places that are told one by one."""


_COARSE = 5e-4
"""mm; digits that are no finer are planned with, finer ones are within what the limit leaves."""


def limit_of(job: Job, operation: Operation, digits: ProgramDigits = ANY_DIGITS) -> EngagementLimit:
    """Return what the cutter of an operation may be engaged; `digits`: of the program that it is written to."""
    coarser = _INCH if job.out_units is Units.INCH else 1.0
    assert operation.proven_angle is not None
    grid = DigitGrid(digits.step, digits.zero) if digits.step > _COARSE else None
    return EngagementLimit(job.tool(operation.cut.tool).radius, operation.proven_angle, coarser, grid)


def room_needed(job: Job, operation: Operation, digits: ProgramDigits = ANY_DIGITS) -> float:
    """Return how far from the walls the cutter's centre must have room to be, mm."""
    limit = limit_of(job, operation, digits)
    return limit.radius + least_turn(limit) + operation.cut.stock_to_leave


def least_width(job: Job, operation: Operation) -> float:
    """Return the least width, mm, of a region that this operation, or another one without a limit, machines."""
    others = replace(job, operations=tuple(each for each in job.operations if each.proven_angle is None))
    return min(2 * room_needed(job, operation), finest(others, operation))


def adaptive(context: OperationContext, index: int, progress: Progress) -> None:
    """Clear the area of an operation."""
    job = context.job
    operation = job.operations[index]
    area, cut, tool = context.areas.of(operation), operation.cut, job.tool(operation.cut.tool)
    if area is None:
        return
    check_depth(job, cut)
    levels, label = levels_of(context, cut), StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    limit = limit_of(job, operation, context.digits)
    level = area.frame(room_needed(job, operation, context.digits), progress.part(0.0, 0.05))
    context.findings.extend(too_narrow(job, operation, area, level))
    climb = cut.direction is Direction.CLIMB
    walls = area.primitives if climb else mirrored(area.primitives)
    if not climb and limit.grid is not None:
        limit = replace(limit, grid=limit.grid.mirrored())
    stock = open_stock(context, operation, area)
    seen = stock if climb or stock is None else stock.mirrored()
    faster = clear_feed(label) / label.feed
    task = ClearingTask(walls, cut.stock_to_leave, farthest(label, levels), seen, operation.fastest_cut, faster)
    parts = plan(task, limit, progress.part(0.05, 0.9))
    if not climb:
        parts = tuple(mirrored_part(part) for part in parts)
    context.findings.extend(_left(parts, operation))
    if not parts:
        return
    parts = tuple(nearest_first(parts, context.at))
    keep = tool.radius + cut.stock_to_leave
    ground = EntryContext(tool, cut.entry, area.distances, keep, True, cut.direction, context.cleared, context.tabs)
    if stock is not None:
        know_as_clear(context, operation, stock, [part.runs[0].rows[0, :2] for part in parts])
    passes = DiscPasses(context.builder, label, ground, levels, operation.lift_between)
    passes.cut(parts, progress.part(0.9, 1.0))
    context.strokes += sum(len(part.runs) for part in parts) * len(levels.passes)
    context.at = (float(parts[-1].runs[-1].rows[-1, 2]), float(parts[-1].runs[-1].rows[-1, 3]))
    context.findings.extend(passes.entries.findings(tool, cut.entry.kind))


def too_narrow(job: Job, operation: Operation, area: MachiningArea, level: OffsetLevel) -> list[Finding]:
    """Return which regions are too small for the cutter, and which necks it does not pass, keeping its limit."""
    tool = job.tool(operation.cut.tool)
    return [
        *too_small(area.regions, level, tool, least_width(job, operation)),
        *necks(level, area.primitives, area.distances, tool),
    ]


def _left(parts: Sequence[ConnectedPath], operation: Operation) -> list[Finding]:
    """Return what was left because the limit could not be kept there."""
    angle = f"{round(math.degrees(operation.proven_angle or 0.0), 6):g} degrees"
    found = []
    for stop in [stop for part in parts for stop in part.stops][:_TOLD]:
        x, y = stop.place
        text = (
            f"At {in_plane(x, y)} the area is {stop.width:.3f} mm wide, too narrow for T{operation.cut.tool} to keep "
            f"to {angle}; use a smaller tool there, or a larger angle."
        )
        found.append(Finding(FindingKind.NECK_TOO_NARROW, text, x, y, amount=stop.width))
    for x, y in [place for part in parts for place in part.unproven][:_TOLD]:
        text = (
            f"The way along the wall at {in_plane(x, y)} cannot be proven to keep to {angle}, and is left out; "
            "let a contour operation follow it."
        )
        found.append(Finding(FindingKind.ENGAGEMENT, text, x, y))
    return found
