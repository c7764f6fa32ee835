"""Adaptive clearing: an area cleared by a cutter that is nowhere engaged by more than an angle, see `limit`.

The runs of a plan become moves at all depths: down into metal once a part and depth, everything else over clear ground.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.offset.offset import OffsetLevel
from ...geometry.primitives import lengths, within_half_turn
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import Purpose
from ...model.operation import Direction, Operation
from ...model.part import Units
from ...toolpath.build import MovesBuilder, Stroke, StrokeLabel
from ...toolpath.depth import DepthLevels
from ...toolpath.entry.entry import EntryContext, EntryFallbacks, descent
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.narrow_regions import finest, necks, too_small
from ...toolpath.operation_context import ANY_DIGITS, OperationContext, ProgramDigits, check_depth, levels_of
from ..from_outside import know_as_clear, open_stock
from .limit import DigitGrid, EngagementLimit
from .path_builder import CutRun
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
    ground = EntryContext(
        tool,
        cut.entry,
        area.distances,
        keep,
        beside=True,
        direction=cut.direction,
        cleared=context.cleared,
        tabs=context.tabs,
    )
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


FASTER = 4.0
"""Times the feed rate at which the cutter goes over clear ground."""

_FASTEST = 5000.0
"""mm/min, and no faster."""

_STOPS = 1.0
"""s that a lift costs beside its length."""

_SEED = 2
"""Rows at the beginning of a part that widen the hole in which the cutter has come down."""

_SAME = 1e-9
"""mm; heights that differ by less are the same."""


def clear_feed(label: StrokeLabel) -> float:
    """Return the feed over clear ground, mm/min."""
    return max(label.feed, min(FASTER * label.feed, _FASTEST))


def farthest(label: StrokeLabel, levels: DepthLevels) -> float:
    """Return how far the cutter goes over clear ground in the time that a lift takes, mm."""
    high = levels.travel - levels.passes[-1]
    return clear_feed(label) * (2 * high / _FASTEST + _STOPS / 60)


@dataclass(eq=False)
class DiscPasses:
    """Cuts parts at all depths.

    Attributes:
        lift: how high the cutter goes over clear ground, mm.
        entries: what is to say of the ways into the metal.
    """

    builder: MovesBuilder
    label: StrokeLabel
    ground: EntryContext
    levels: DepthLevels
    lift: float
    entries: EntryFallbacks = field(default_factory=EntryFallbacks)

    def cut(self, parts: Sequence[ConnectedPath], progress: Progress) -> None:
        """Append parts, each at all depths before the next.

        Raises:
            Cancelled: by progress.
        """
        count = len(parts) * len(self.levels.passes)
        for k, part in enumerate(parts):
            for n, z in enumerate(self.levels.passes):
                progress.step((k * len(self.levels.passes) + n) / count, "Depth passes")
                for run in part.runs:
                    self._run(run, z, part.region, run is part.runs[0])

    def _run(self, run: CutRun, z: float, region: int, into_metal: bool) -> None:
        stroke = Stroke(run.rows, np.where(run.clear, Purpose.LINK, Purpose.POCKET).astype(np.uint8), region)
        if into_metal:
            stroke.purpose[:_SEED] = Purpose.PLUNGE
        x, y = stroke.start
        for height in self.levels.over(x, y):
            self.builder.straight((x, y, height), Purpose.RAPID, self.label)
        if into_metal and self.ground.cleared.floor(self.ground.tool, (x, y)) > z + _SAME:
            self._enter(stroke, z)
        else:
            self._down(x, y, z, z + self.levels.retract, region)
        self.builder.along(stroke, self._heights(run, z), self.label, self._feeds(run, into_metal))
        rows = within_half_turn(run.rows[~run.clear])
        self.ground.cleared.add(self.ground.tool, rows, np.full(len(rows), z))
        x, y, _ = self.builder.at
        self.builder.straight((x, y, self.levels.travel), Purpose.RAPID, self.label)

    def _enter(self, stroke: Stroke, z: float) -> None:
        requested = self.ground.entry.kind
        way = descent(stroke, z, requested, self.ground)
        self.entries.note(requested, way.kind, stroke.start)
        x, y = stroke.start
        if not len(way.heights):
            self._down(x, y, z, way.top + self.levels.retract, stroke.region)
            return
        self._down(x, y, way.top, way.top + self.levels.retract, stroke.region)
        self.builder.ramp(way.path, way.heights, self.label)
        if way.well is not None:
            self.ground.cleared.wells[way.well[0]] = way.well[1]

    def _down(self, x: float, y: float, z: float, slow: float, region: int) -> None:
        """Go straight down: quickly to a height, then at plunge rate."""
        height = self.builder.at[2]
        if height > slow + _SAME and slow > z:
            self.builder.straight((x, y, slow), Purpose.PLUNGE, self.label.fast, region)
        if height > z + _SAME:
            self.builder.straight((x, y, z), Purpose.PLUNGE, self.label, region)

    def _heights(self, run: CutRun, z: float) -> np.ndarray:
        """Return (n,) at which height each row ends: over clear ground lifted, where the first and the last row of the
        way are long enough to rise and to fall.
        """
        heights, size = np.full(len(run.rows), z), lengths(run.rows)
        edge = np.flatnonzero(np.diff(run.clear.astype(np.int8), prepend=0, append=0))
        for first, stop in edge.reshape(-1, 2).tolist():
            if stop - first > 1 and min(size[first], size[stop - 1]) >= self.lift > 0:
                heights[first : stop - 1] = min(z + self.lift, self.levels.retract)
        return heights

    def _feeds(self, run: CutRun, into_metal: bool) -> np.ndarray:
        fast = clear_feed(self.label)
        feeds = np.where(run.clear, fast, np.minimum(run.times * self.label.feed, fast))
        if into_metal:
            feeds[:_SEED] = max(self.label.feed / 2, min(self.label.plunge_rate, self.label.feed))
        return feeds


def nearest_first(parts: Sequence[ConnectedPath], at: tuple[float, float]) -> list[ConnectedPath]:
    """Return parts so that each is the one that begins nearest to where the one before it ends."""
    left, order = list(parts), []
    while left:
        part = min(left, key=lambda each: math.dist(at, each.runs[0].rows[0, :2]))
        left.remove(part)
        order.append(part)
        x, y = part.runs[-1].rows[-1, 2:4].tolist()
        at = (x, y)
    return order
