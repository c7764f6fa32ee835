"""A job to its program: one table from kind of operation to function, and the order of cutting."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import shapely

from ..core.beside import BesideWork, beside
from ..core.effort import Reckoning, announce
from ..core.progress import NO_PROGRESS, Progress
from ..core.wording import counted, in_plane
from ..model.finding import Finding, FindingKind, worst_first
from ..model.job import Job
from ..model.moves import Program
from ..model.operation import Order, Side
from ..model.part import Contour, Region
from ..model.stock_box import stock_box, work_origin
from ..raster.fill import Observer
from ..toolpath.bitmap_check import BitmapCheck
from ..toolpath.coverage.areas import region_shapes
from ..toolpath.coverage.floor_target import CHORD
from ..toolpath.drawn_contours import DrawnContours, drawn_contours, selected, selection_findings
from ..toolpath.drill_holes import across_holes
from ..toolpath.machining_areas import MachiningAreas
from ..toolpath.operation_context import OperationContext, PreparedStrokes, ProgramDigits
from .effort import CONTOUR_S, ISLAND_S, workload_of
from .from_outside import emit_prepared
from .registry import method_of


def compute(job: Job, progress: Progress = NO_PROGRESS, observer: Observer | None = None, step: float = 0.0) -> Program:
    """Return every move of a job.

    Args:
        step: of the digits that it is written with, mm; 0 = fine enough not to matter.
        observer: is shown the numbered steps of the bitmap fill (201-208); costs nothing when there is none.

    Raises:
        ParameterError: an operation's parameters do not fit its tool, or a layer is not in the drawing.
        Cancelled: by progress.
    """
    progress.step(0.0, "Chain contours")
    parts = drawn_contours(job)
    lines = followed_lines(job, parts)
    # What the witness says of the drawing nothing waits for: it measures while the paths are made, unless somebody
    # observes them, who sees one thing after the other.
    beside_paths = partial(_told_beside, progress=progress, at_once=observer is None)
    with beside_paths(lambda: drawing_findings(job, parts, lines)) as about_drawing:
        made = parts.regions
        with beside_paths(lambda: made.findings) as about_regions:
            context = OperationContext(job, made.regions, MachiningAreas(job, parts), observer=observer)
            if context.regions or lines:
                _cut(context, lines, step, progress)
            about = (*about_drawing.result(), *about_regions.result())
    if not context.regions and not lines:
        return Program(context.builder.moves(), findings=about)
    areas = context.areas.areas()
    seen = context.on_bitmap or BitmapCheck(0.0, 0.0, 0, (0.0, 0.0), 0.0)
    return Program(
        moves=context.builder.moves(),
        regions=context.regions,
        findings=worst_first((*about, *context.findings, *context.areas.findings)),
        strokes=context.strokes,
        polyline_rings=context.polyline_rings,
        bitmap_area_mm2=seen.bitmap_area,
        exact_area_mm2=seen.exact_area,
        pitch_mm=seen.pitch,
        areas=areas,
        lines=lines,
        clamps=parts.clamps,
        tabs=tuple(context.tabs),
        dog_bones=tuple(context.dog_bones),
        stepovers=context.stepovers,
    )


def _told_beside(
    about: Callable[[], Sequence[Finding]], progress: Progress, at_once: bool
) -> AbstractContextManager[BesideWork[Sequence[Finding]]]:
    """Return findings that are found beside the job."""

    def found(told: Progress) -> Sequence[Finding]:
        told.step(0.0, "Looking at the curves")
        return about()

    return beside(found, progress.part(1.0, 1.0), at_once)


def _cut(context: OperationContext, lines: Sequence[Contour], step: float, progress: Progress) -> None:
    """Make the moves of a job.

    Args:
        lines: open ones that some operation follows.
        step: of the digits that they are written with, mm; 0 = fine enough not to matter.
    """
    job = context.job
    if step:
        x, y, _ = work_origin(job, stock_box(job, context.regions, lines))
        context.digits = ProgramDigits(step, (x, y))
    announce(job_effort(job, context.regions), progress)
    context.findings.extend(under_clamps(job, context.areas.drawn, context.regions))
    operations = in_order(job)
    context.findings.extend(unfaced(job, operations))
    carry_out(context, operations, progress.part(0.05, 1.0))
    if job.order is Order.PATENT_1986:
        context.findings.extend(slotting(job))


def regions_of(job: Job) -> tuple[tuple[Region, ...], list[Finding]]:
    """Return (regions, findings about the drawing) of the layers that a job machines."""
    parts = drawn_contours(job)
    made = parts.regions
    return made.regions, [*parts.findings, *made.findings]


def followed_lines(job: Job, parts: DrawnContours) -> tuple[Contour, ...]:
    """Return the open lines that some operation machines."""
    cuts = [each.cut for each in job.operations if each.takes_open and each.cut.enabled]
    followed = {id(line) for cut in cuts for line in selected(parts, cut.curves).open}
    return tuple(line for line in parts.open if id(line) in followed)


def drawing_findings(job: Job, parts: DrawnContours, lines: Sequence[Contour]) -> list[Finding]:
    """Return what is to say of a drawing; that lines are open, or cross, counts for nothing where they are but
    followed.
    """
    followed = {number for line in lines for number in line.entity_ids} | _only_followed(job, parts)
    kept = [
        each
        for each in (across_holes(parts.findings, job, parts) if job.makes_holes else parts.findings)
        if each.kind is not FindingKind.OPEN_CONTOUR or not (each.entity_ids and followed.issuperset(each.entity_ids))
    ]
    only_followed = not any(operation.cut.enabled and not operation.follows_lines for operation in job.operations)
    kept = [
        replace(each, counts=False)
        if each.kind is FindingKind.SELF_INTERSECTION
        and (only_followed or (each.entity_ids and followed.issuperset(each.entity_ids)))
        else each
        for each in kept
    ]
    return [*kept, *selection_findings(job, parts)]


def _only_followed(job: Job, parts: DrawnContours) -> set[int]:
    """Return the numbers of the curves that bound no area of any operation, since all that select them follow them."""
    at_work = [each for each in job.operations if each.cut.enabled]
    numbers: dict[bool, set[int]] = {True: set(), False: set()}
    for operation in at_work:
        found = selected(parts, operation.cut.curves)
        contours = found.closed if not operation.takes_open or operation.wall_side is Side.ON else ()
        contours += found.open if operation.takes_open else ()
        if not operation.HOLES:
            numbers[operation.takes_open].update(n for each in contours for n in each.entity_ids)
    return numbers[True] - numbers[False]


def under_clamps(job: Job, parts: DrawnContours, regions: Sequence[Region]) -> list[Finding]:
    """Return how much of what pockets are to clear lies under clamps."""
    if not parts.clamps or not any(each.COARSE and each.cut.enabled for each in job.operations):
        return []
    held = shapely.union_all(region_shapes(parts.clamps, CHORD))
    lost = shapely.intersection(held, shapely.union_all(region_shapes(regions, CHORD)))
    if lost.area < CHORD:
        return []
    x, y = shapely.get_coordinates(shapely.point_on_surface(lost))[0].tolist()
    text = (
        f"{lost.area:.1f} mm2 of what is to be cleared lies under clamps, at {in_plane(x, y)} for one, and stays; "
        "clear it in another set-up."
    )
    return [Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(lost.area))]


def in_order(job: Job) -> list[int]:
    """Return indices of the enabled operations in the order of cutting: the list's, what an operation asks for right
    before it, or all contours first (1986).
    """
    enabled = [k for k, operation in enumerate(job.operations) if operation.cut.enabled]
    before = {k: owner for k in enabled if (owner := job.prepares(k)) is not None and owner < k}
    listed = sorted(enabled, key=lambda k: before[k] - 0.5 if k in before else float(k))
    return sorted(listed, key=lambda k: job.order is Order.PATENT_1986 and not job.operations[k].FOLLOWS_WALLS)


def unfaced(job: Job, operations: Sequence[int]) -> list[Finding]:
    """Return that the first operation does not take off what stands above Z 0, though something does."""
    if not job.stock.above or (operations and job.operations[operations[0]].FACES):
        return []
    text = (
        f"{job.stock.above:g} mm of the stock stand above Z 0, and the first operation does not face them off; the "
        "others count their depths from Z 0: put a face operation first."
    )
    return [Finding(FindingKind.ENGAGEMENT, text, amount=job.stock.above)]


def slotting(job: Job) -> list[Finding]:
    """Return the warning that the 1986 order deserves."""
    tools = [job.tool(op.cut.tool) for op in job.operations if op.FOLLOWS_WALLS and op.cut.enabled]
    return [
        Finding(
            FindingKind.ENGAGEMENT,
            f"Order 1986: T{tool.number} {tool.label} cuts first and slots full stock, engaged over 100 % "
            "of its diameter. Reduce the stepdown, or let the pocket tool cut first.",
            counts=False,
            amount=tool.diameter,
        )
        for tool in tools
    ]


# Operations one after the other, and beside them the strokes of the next one that asks nothing of what was cut.


_PREPARED = 0.7
"""Share of an operation's progress at which its strokes are there."""


class _PreparedApart(NamedTuple):
    """Strokes, and what was collected beside them."""

    context: OperationContext
    strokes: PreparedStrokes | None


def carry_out(context: OperationContext, operations: Sequence[int], progress: Progress) -> None:
    """Make the moves of operations, in the order given.

    Where strokes need no earlier operation they are made while the ones before are still at work, one operation at a
    time: what comes out is what one after the other gives. Whoever observes steps sees them in their order, so then
    nothing is done ahead.

    Args:
        operations: indices in the job.

    Raises:
        ParameterError: an operation's parameters do not fit its tool.
        Cancelled: by progress.
    """
    with ExitStack() as begun:
        ahead = _Ahead(context, operations, progress, begun)
        for place, index in enumerate(operations):
            share = ahead.share(place)
            waiting = ahead.begun_for(place)
            if waiting is None:
                method_of(context.job.operations[index]).paths(context, index, share)
                continue
            apart, prepared = waiting.result()
            ahead.begin(place + 1)
            context.take(apart)
            if prepared is not None:
                emit_prepared(context, index, prepared, share.part(_PREPARED, 1.0))


class _Ahead:
    """The next operation that can be prepared beside those before it."""

    def __init__(
        self, context: OperationContext, operations: Sequence[int], progress: Progress, begun: ExitStack
    ) -> None:
        self._context, self._operations, self._progress, self._begun = context, operations, progress, begun
        self._place = -1
        self._work: BesideWork[_PreparedApart] | None = None
        self.begin(1)  # the first has nothing to be beside

    def share(self, place: int) -> Progress:
        """Return the progress of the operation at a place in the order."""
        count = len(self._operations)
        return self._progress.part(place / count, (place + 1) / count)

    def begun_for(self, place: int) -> BesideWork[_PreparedApart] | None:
        """Return the work that prepares the operation at a place, if it was begun."""
        return self._work if place == self._place else None

    def begin(self, first: int) -> None:
        """Begin with the first operation from a place on that can be prepared."""
        self._place, self._work = -1, None
        if self._context.observer is not None:
            return
        for place in range(first, len(self._operations)):
            index = self._operations[place]
            prepared = method_of(self._context.job.operations[index]).prepared
            if prepared is not None:
                self._make_areas(place)
                work = partial(_prepare, self._context, index, prepared)
                self._place = place
                self._work = self._begun.enter_context(beside(work, self.share(place).part(0.0, _PREPARED)))
                return

    def _make_areas(self, place: int) -> None:
        """Make the areas up to a place, in the order in which they are asked for, as both sides ask for them."""
        for index in self._operations[: place + 1]:
            operation = self._context.job.operations[index]
            if not (operation.HOLES or operation.FACES):
                self._context.areas.of(operation)


def _prepare(
    context: OperationContext,
    index: int,
    prepared: Callable[[OperationContext, int, Progress], PreparedStrokes | None],
    progress: Progress,
) -> _PreparedApart:
    apart = context.apart()
    return _PreparedApart(apart, prepared(apart, index, progress))


# How long a job will take, reckoned before it is computed.


def job_effort(job: Job, regions: Sequence[Region]) -> Reckoning:
    """Return what a job takes whose contours bound some regions."""
    extent = workload_of(regions)
    seconds = extent.regions * CONTOUR_S + extent.islands * ISLAND_S
    worst, most = "", 0.0
    for operation in job.operations:
        if operation.cut.enabled:
            tool = job.tool(operation.cut.tool)
            own = method_of(operation).effort(extent, operation, tool)
            seconds += own
            if own > most:
                worst, most = f"{operation.WORD} with {tool.diameter:g} mm", own
    contours = counted(extent.regions + extent.islands, "contour", thousands=",")
    about = f"{extent.area:,.0f} mm2 within {contours} of {extent.pieces:,} lines and arcs"
    about += f", {worst} for the most part" if most > seconds / 2 else ""
    remedy = "use a larger tool, leave out layers, or check the units" if most > seconds / 2 else "leave out layers"
    return Reckoning(seconds, about, remedy)
