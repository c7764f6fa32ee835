"""Pocket paths: rings of one distance field from the outermost frame inwards, linked to one stroke (steps 141-148)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from ...core import tolerances
from ...core.errors import ParameterError
from ...core.memory import MemoryRemedy, ask
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, offset_levels
from ...geometry.primitives import path_length
from ...model.finding import Finding
from ...model.job import Job
from ...model.operation import CutParameters, Operation, PocketOperation, Side
from ...model.tool import Tool
from ...toolpath.build import Stroke
from ...toolpath.linking.link import LinkOptions, link
from ...toolpath.linking.runs import NOTHING, GapFilling, between, fill
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.narrow_regions import finest, necks, too_small
from ...toolpath.operation_context import OperationContext, emit, passes_of
from ..from_outside import from_outside, open_stock

_SHARES = (1.6, 1.8, 1.7, 1.75, 1.65, 1.5, 1.4)
"""Of the radius: stepovers that are compared; the first is the best guess."""

MOST_COMPARED = 20_000
"""Rows of a drawing up to which stepovers are compared."""

MOST_LINKED = 0.05
"""Share of a path that bridges and runs between rings should not exceed."""

_FAR_TOO_LINKED = 0.075
"""Where it is this much, larger stepovers are not looked at."""

_RING_BYTES = 1500
"""What a ring of four lines takes, with its distance and its level; longer ones take more."""

_ABOUT = 0.005
"""mm; so exactly is the largest disc of a region known."""


def pocket(context: OperationContext, index: int, progress: Progress) -> None:
    """Steps 141-148: rings inside A', linked to one stroke a connected area."""
    operation = context.job.operations[index]
    assert isinstance(operation, PocketOperation)
    area, tool = context.areas.of(operation), context.job.tool(operation.cut.tool)
    if area is None:
        return
    wall = wall_distance(context.job, operation)
    outermost = max(wall, operation.cut.stock_to_leave) + tool.radius
    target = PocketTarget(outermost, tool.radius, LinkOptions(operation.cut.direction, operation.outside_in))
    first = clear_in_rings(context, index, area, target, progress)
    small = too_small(area.regions, first, tool, 0.0 if wall else finest(context.job, operation))
    small = left_to_carvings(small, context.job, operation)
    context.findings.extend(each for each in small if not _left_to_contours(each.amount or 0.0, context.job, operation))


def clear_in_rings(
    context: OperationContext, index: int, area: MachiningArea, target: PocketTarget, progress: Progress
) -> OffsetLevel:
    """Clear an area for one of the job's operations, in rings, and return the outermost ones.

    Raises:
        ParameterError: the stepover is larger than the tool, or the operation deeper than the stock.
        Cancelled: by progress.
    """
    operation, tool = context.job.operations[index], context.job.tool(context.job.operations[index].cut.tool)
    stepovers = (
        (stepover_of(operation, tool),)
        if operation.ring_stepover
        else candidates(tool.radius, len(area.primitives.rows))
    )
    chosen = shortest(area, target, stepovers, progress.part(0, 0.9))
    context.note((*chosen.levels, *chosen.filling.halves))
    first = chosen.levels[0] if chosen.levels else OffsetLevel(target.outermost, ())
    context.findings.extend(necks(first, area.primitives, area.distances, tool))
    if chosen.strokes:
        context.stepovers[index] = chosen.stepover
    context.strokes += len(chosen.strokes) * passes_of(context, index)
    stock = open_stock(context, operation, area)
    strokes = (
        chosen.strokes if stock is None else from_outside(context, operation, area, chosen.strokes, target.outermost)
    )
    emit(context, index, area, strokes, progress.part(0.9, 1.0))
    return first


@dataclass(frozen=True)
class PocketTarget:
    """How an area is to be cleared.

    Attributes:
        outermost: distance of the outermost rings from the walls, mm.
        radius: of the tool, mm.
        link_options: direction and order.
    """

    outermost: float
    radius: float
    link_options: LinkOptions


@dataclass(frozen=True, eq=False)
class PocketStrokes:
    """Rings that clear an area, and the strokes through them.

    Attributes:
        levels: rings, outermost first. filling: what cuts all that they leave. strokes: all of it.
        length: of all strokes, mm.
        linked: share of it that is no ring: bridges, and runs between rings.
        stepover: between the rings, mm.
    """

    levels: tuple[OffsetLevel, ...] = ()
    filling: GapFilling = NOTHING
    strokes: tuple[Stroke, ...] = ()
    length: float = 0.0
    linked: float = 0.0
    stepover: float = 0.0

    def may_be_beaten(self, rings: float, more: float) -> bool:
        """Tell whether strokes with rings of a length, mm, and at least so much more, mm, may be better."""
        least = _share(rings, more) > MOST_LINKED, rings + more
        return least < (self.linked > MOST_LINKED, self.length)


def _share(rings: float, more: float) -> float:
    """Return the share of a path, mm, that is no ring."""
    return more / (rings + more) if more else 0.0


def between_rings(levels: Sequence[OffsetLevel], halves: Sequence[OffsetLevel]) -> float:
    """Return how long bridges are at least, mm: each ring hangs on one outside it, no nearer than its level is.

    Args:
        levels: rings, outermost first. halves: closed runs inside each.
    """
    steps = [(inner, inner.distance - outer.distance) for outer, inner in pairwise(levels)]
    steps += [(half, half.distance - level.distance) for level, half in zip(levels, halves, strict=False)]
    return sum(len(level.rings) * step for level, step in steps)


def candidates(radius: float, rows: int) -> tuple[float, ...]:
    """Return the stepovers that are looked at for the shortest path, mm; one alone where a drawing has very many
    rows.
    """
    return tuple(share * radius for share in (_SHARES if rows <= MOST_COMPARED else _SHARES[:1]))


def shortest(
    area: MachiningArea, target: PocketTarget, stepovers: Sequence[float], progress: Progress = NO_PROGRESS
) -> PocketStrokes:
    """Return the shortest of the ways to clear an area, each with another stepover, that keep to the share of links if
    one does.

    Raises:
        Cancelled: by progress.
    """
    plans = [
        (spaced, between(spaced, stepover, target.radius))
        for stepover in stepovers
        if (spaced := pocket_distances(target.outermost, stepover, area.distances))
    ]
    each = sorted({distance for plan in plans for part in plan for distance in part})
    found = dict(zip(each, offset_levels(area.primitives, each, progress.part(0, 0.5), frame=True), strict=True))
    best, too_far = PocketStrokes(), math.inf
    for k, (distances, halves) in enumerate(plans):
        progress.step(0.5 + 0.5 * k / len(plans), "Link rings")
        levels = without_empty(tuple(found[distance] for distance in distances))
        if not levels:
            return best
        rings = sum(ring.length for level in levels for ring in level.rings)
        if best.strokes and (stepovers[k] > too_far or not best.may_be_beaten(rings, between_rings(levels, ()))):
            continue
        filling = (
            fill(levels, [found[distance] for distance in halves], area.distances, target.radius) if halves else NOTHING
        )
        if best.strokes and halves:  # else ways between rings save pieces of them
            more = filling.length + between_rings(levels, filling.halves)
            if not best.may_be_beaten(rings, more):
                too_far = min(too_far, stepovers[k]) if _share(rings, more) > _FAR_TOO_LINKED else too_far
                continue
        strokes = link(levels, area.distances, target.link_options, filling, 0.0 if halves else stepovers[k])
        length = sum(path_length(stroke.rows) for stroke in strokes)
        made = PocketStrokes(levels, filling, strokes, length, 1 - rings / length, stepovers[k])
        if not best.strokes or (made.linked > MOST_LINKED, length) < (best.linked > MOST_LINKED, best.length):
            best = made
        if made.linked > _FAR_TOO_LINKED:
            too_far = min(too_far, stepovers[k])
    return best


def wall_distance(job: Job, operation: Operation) -> float:
    """Return how far A' lies inside the walls, mm: the contour tool's radius and the stock it leaves (step 120).

    Without a contour operation that goes inside the walls of the same curves, as deep, the pocket goes up to the walls
    itself.
    """
    return max((job.tool(cut.tool).radius + cut.stock_to_leave for cut in _followers(job, operation)), default=0.0)


def _followers(job: Job, operation: Operation) -> list[CutParameters]:
    """Return the contour operations inside the walls of the same curves, as deep."""
    cuts = (
        each.cut for each in job.operations if each.FOLLOWS_WALLS and each.cut.enabled and each.wall_side is Side.INSIDE
    )
    return [cut for cut in cuts if set(cut.curves) == set(operation.cut.curves) and cut.floor >= operation.cut.floor]


def _left_to_contours(disc: float, job: Job, operation: PocketOperation) -> bool:
    """Tell whether a region with so large a disc, mm, is cleared by a path along its walls alone, so that no pocket
    tool is missing.
    """
    return any(
        cut.stock_to_leave - _ABOUT
        <= disc / 2 - job.tool(cut.tool).radius
        <= cut.stock_to_leave + job.tool(cut.tool).radius
        for cut in _followers(job, operation)
    )


def left_to_carvings(small: Sequence[Finding], job: Job, operation: PocketOperation) -> list[Finding]:
    """Return what is to be said of regions too small for an operation's tool: nothing where a carving has asked for it
    and the slanted walls meet, so that there is no floor; else a remark, as its cone goes over the floor itself.
    """
    if job.prepares(job.operations.index(operation)) is None:
        return list(small)
    wide = 2 * operation.cut.stock_to_leave + _ABOUT
    return [replace(each, counts=False) for each in small if (each.amount or 0.0) > wide]


def stepover_of(operation: Operation, tool: Tool) -> float:
    """Return the distance between rings, mm: as asked, or the largest at which rings cover everything by themselves.

    A stepover s <= R leaves no point farther than R from some ring. Overlap of the 1986 text = 2 R - s.

    Raises:
        ParameterError: the stepover is larger than the tool.
    """
    if operation.ring_stepover is None:
        return tool.radius
    if operation.ring_stepover > tool.diameter:
        raise ParameterError(
            f"Stepover is {operation.ring_stepover:g} mm, more than the diameter of T{tool.number} "
            f"({tool.diameter:g} mm); use that or less."
        )
    return operation.ring_stepover


def pocket_distances(outermost: float, stepover: float, field: DistanceField) -> tuple[float, ...]:
    """Return the distances of all rings from the drawing, mm: outermost + k stepover, as far as any point can be.

    Args:
        outermost: contour tool radius + stock to leave + pocket tool radius, mm.
        stepover: mm, > 0.

    Raises:
        MemoryShortError: there are more rings than memory for them.
    """
    x0, y0, x1, y1 = field.boxes[:, 0].min(), field.boxes[:, 1].min(), field.boxes[:, 2].max(), field.boxes[:, 3].max()
    deepest = min(x1 - x0, y1 - y0) / 2
    count = max(0, math.floor((deepest - outermost + tolerances.NOMINAL) / stepover) + 1)
    ask(
        count * _RING_BYTES,
        f"A pocket of {count:,} rings, {stepover:g} mm from one to the next,",
        MemoryRemedy("use a larger tool", "pocket-tool"),
        MemoryRemedy(" or stepover", "stepover"),
    )
    return tuple(outermost + k * stepover for k in range(count))


def without_empty(levels: tuple[OffsetLevel, ...]) -> tuple[OffsetLevel, ...]:
    """Return the levels up to the last one that has rings."""
    last = max((k for k, level in enumerate(levels) if level.rings), default=-1)
    return levels[: last + 1]
