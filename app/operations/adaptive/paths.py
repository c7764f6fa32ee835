"""Adaptive clearing: an area cleared by a cutter that is nowhere engaged by more than an angle, see `limit`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ...core.progress import Progress
from ...geometry.offset.offset import Level
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.operation import AdaptiveOperation, Direction
from ...model.part import Units
from ...toolpath.build import Label
from ...toolpath.entry.entry import Ground
from ...toolpath.narrow import finest, necks, too_small
from ...toolpath.setting import Setting, check_depth, levels_of
from ...toolpath.sheets import Sheet
from .limit import Limit
from .passes import DiscPasses, farthest, nearest_first
from .plan import Part, Task, least_turn, mirrored, mirrored_part, plan

_INCH = 2.54
"""Times the digits of a program in inches are coarser: 0.00001 in against 0.0001 mm."""

_TOLD = 20
"""Places that are told one by one."""


def limit_of(job: Job, operation: AdaptiveOperation) -> Limit:
    """Return what the cutter of an operation may be engaged."""
    coarser = _INCH if job.out_units is Units.INCH else 1.0
    return Limit(job.tool(operation.cut.tool).radius, operation.most_engaged_deg, coarser)


def room_needed(job: Job, operation: AdaptiveOperation) -> float:
    """Return how far from the walls the cutter's centre must have room to be, mm."""
    limit = limit_of(job, operation)
    return limit.radius + least_turn(limit) + operation.cut.stock_to_leave


def least_width(job: Job, operation: AdaptiveOperation) -> float:
    """Return the least width, mm, of a region that this operation, or another one without a limit, machines."""
    others = replace(job, operations=tuple(each for each in job.operations if each.proven_angle is None))
    return min(2 * room_needed(job, operation), finest(others, operation))


def adaptive(setting: Setting, index: int, progress: Progress) -> None:
    """Clear the area of an operation."""
    job = setting.job
    operation = job.operations[index]
    assert isinstance(operation, AdaptiveOperation)
    sheet, cut, tool = setting.sheets.of(operation), operation.cut, job.tool(operation.cut.tool)
    if sheet is None:
        return
    check_depth(job, cut)
    levels, label = levels_of(setting, cut), Label(index, tool.number, tool.feed_rate, tool.plunge_rate)
    limit, level = limit_of(job, operation), sheet.frame(room_needed(job, operation), progress.part(0.0, 0.05))
    setting.findings.extend(too_narrow(job, operation, sheet, level))
    climb = cut.direction is Direction.CLIMB
    walls = sheet.primitives if climb else mirrored(sheet.primitives)
    parts = plan(Task(walls, cut.stock_to_leave, farthest(label, levels)), limit, progress.part(0.05, 0.9))
    if not climb:
        parts = tuple(mirrored_part(part) for part in parts)
    setting.findings.extend(_left(parts, operation))
    if not parts:
        return
    parts = tuple(nearest_first(parts, setting.at))
    keep = tool.radius + cut.stock_to_leave
    ground = Ground(tool, cut.entry, sheet.distances, keep, True, cut.direction, setting.cleared, setting.tabs)
    passes = DiscPasses(setting.builder, label, ground, levels, operation.lift)
    passes.cut(parts, progress.part(0.9, 1.0))
    setting.strokes += sum(len(part.runs) for part in parts) * len(levels.passes)
    setting.at = (float(parts[-1].runs[-1].rows[-1, 2]), float(parts[-1].runs[-1].rows[-1, 3]))
    setting.findings.extend(passes.entries.findings(tool, cut.entry.kind))


def too_narrow(job: Job, operation: AdaptiveOperation, sheet: Sheet, level: Level) -> list[Finding]:
    """Return which regions are too small for the cutter, and which necks it does not pass, keeping its limit."""
    tool = job.tool(operation.cut.tool)
    return [
        *too_small(sheet.regions, level, tool, least_width(job, operation)),
        *necks(level, sheet.primitives, sheet.distances, tool),
    ]


def _left(parts: Sequence[Part], operation: AdaptiveOperation) -> list[Finding]:
    """Return what was left because the limit could not be kept there."""
    angle = f"{operation.limit_deg:g} degrees"
    found = []
    for stop in [stop for part in parts for stop in part.stops][:_TOLD]:
        x, y = stop.place
        text = (
            f"At ({x:.3f}, {y:.3f}) the area is {stop.width:.3f} mm wide, too narrow for T{operation.cut.tool} to keep "
            f"to {angle}; use a smaller tool there, or a larger angle."
        )
        found.append(Finding(FindingKind.NECK_TOO_NARROW, text, x, y, amount=stop.width))
    for x, y in [place for part in parts for place in part.unproven][:_TOLD]:
        text = (
            f"The way along the wall at ({x:.3f}, {y:.3f}) cannot be proven to keep to {angle}, and is left out; "
            "let a contour operation follow it."
        )
        found.append(Finding(FindingKind.ENGAGEMENT, text, x, y))
    return found
