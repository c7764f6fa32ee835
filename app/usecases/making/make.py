"""From a drawing to an NC program and what there is to know about it: the one place where the rooms are put together.

The command line and the window both call it. Everything is pure: bytes and values in, values out, no file is touched.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from ...core.beside import beside
from ...core.errors import GeometryError, InputError
from ...core.memory import give_back
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...core.tolerances import LEVEL
from ...formats.drawing import Drawing
from ...gcode.posts import Post, load_post
from ...gcode.timing.extent import Extent
from ...gcode.writer.write import NcFile, NcText
from ...model.finding import Finding, FindingKind, worst_first
from ...model.job import Job
from ...model.machine import Machine
from ...model.moves import Program
from ...model.operation import Operation
from ...model.stock_box import program_origin
from ...model.tool import Tool
from ...toolpath.coverage.coverage import Coverage, coverage_findings, measure_beside_clear
from ...toolpath.coverage.floor_target import CHORD
from ...toolpath.witness import floor_findings
from ...verify.verdict import (
    Gouge,
    RapidInMaterial,
    clamps_met,
    clear_moves,
    deepest_of,
    gouge_depths,
    rapids_in_material,
)
from ..cutting.cut import CutProgram
from ..job.feeds import JobWithFeeds
from ..job.layer_operations import with_layer_rules
from ..job.machining import check_order
from ..job.options import MakeOptions, job_with_options, with_feeds, with_own_job
from ..job.plausible import read_for
from ..pixels.options import is_picture
from .proofs.proofs import prove
from .report import MakeReport, ReportData, make_report, rings_in_words
from .written import MeasuredMoves, cut_job, news, write_and_check

if TYPE_CHECKING:
    from ..job.drawn_depths import JobToDepths  # few drawings tell depths
    from ..proposal.propose import Proposal  # few jobs are proposed

NO_TEXT = NcText("", np.zeros(0, np.int32))

_MOST_BESIDE = 1_000_000
"""Moves up to which they are measured while they are written and cut; of more the memory of one after the other is
enough.
"""

NAMED, LETTERS = 3, 340
"""How many findings the one line names that says why nothing can be cut, and letters beyond which it names no further
one.
"""


@dataclass(frozen=True)
class MakeResult:
    """What a make job gives.

    Attributes:
        job: what it was computed from.
        program: the moves; each knows its line of its NC file.
        files: the NC program, read back and found to be the moves: one file, or one a tool where the control changes
            none; none when no move was made.
        box: round its cutting motions, mm, program coordinates.
        report: every measured number.
        findings: everything there is to say, what counts first.
        coverage: what is left on the floor, with outlines.
        cut: the files cut out of the stock and compared with the drawing; None when no move was made.
        proposal: that the operations are of; None where none was asked for.
        feeds: the speeds and feeds that were proposed; None where they are those of the job.
        ruled: what rules for layers have made, a line a layer.
        depths: what was read of the drawing's own depths; None where nobody asked.
    """

    job: Job
    program: Program
    files: tuple[NcFile, ...]
    box: Extent
    report: MakeReport
    findings: tuple[Finding, ...]
    coverage: Coverage
    cut: CutProgram | None
    proposal: Proposal | None = None
    feeds: JobWithFeeds | None = None
    ruled: tuple[str, ...] = ()
    depths: JobToDepths | None = None

    @property
    def nc(self) -> NcText:
        """The NC text, of several files the first one; an empty one when no move was made."""
        return self.files[0].nc if self.files else NO_TEXT

    def proposed(self) -> list[str]:
        """Return what was proposed for the drawing, and why: operations, rules for layers, speeds and feeds."""
        operations = [] if self.proposal is None else self.proposal.lines()
        depths = [] if self.depths is None else self.depths.lines()
        return [*operations, *self.ruled, *depths, *(() if self.feeds is None else self.feeds.lines())]

    def frame(self) -> str:
        """Return the NC text that goes round the cuts at clearance height with the first tool, spindle off.

        Raises:
            ParameterError: nothing is cut.
        """
        from ...gcode.rework.frame import JobFrame, frame_text

        top = program_origin(self.job, self.program)[2] if self.files else 0.0
        height = self.job.travel_z - top if self.files else 0.0
        tool = int(self.program.moves.tool[0]) if self.files else 0
        return frame_text(JobFrame(self.box, height, tool), self.job, load_post(self.job.post))

    @property
    def clean(self) -> bool:
        """True when no finding counts (exit status 0)."""
        return not any(finding.counts for finding in self.findings)


def job_from_drawing(drawing: Drawing, options: MakeOptions) -> Job:
    """Return the job for a drawing: the given or the default one with every given option put in.

    Raises:
        ParameterError: an option is out of its range or has no effect on the job, or two contradict one another.
        InputError: there is no such post, or a layer is not in the drawing.
    """
    job = job_with_options(drawing.part, options)
    check_order(job, options.order)
    load_post(job.post)
    return job


def make(name: str, data: bytes, options: MakeOptions, progress: Progress = NO_PROGRESS) -> MakeResult:
    """Return NC program and report for the bytes of a drawing.

    Args:
        name: file name of the drawing; its suffix tells the format.
        data: its bytes.

    Raises:
        HitofudeError: the drawing or an option cannot be used, or nothing in it can be cut with these tools.
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, f"Reading {name}")
    options = with_own_job(name, data, options)
    on_pixels = options.bitmap is not None or is_picture(name)
    resolved = _on_pixels if on_pixels else _exactly
    context = resolved(name, data, options, progress.part(0.05, 0.1))
    program = context.compute(progress.part(0.1, context.computed_at))
    made = _finished(program, context, progress.part(context.computed_at, 1.0))
    if (proposal := context.proposal) is not None:
        made = replace(made, report=made.report.with_proposal(proposal.report()), proposal=proposal)
    made = replace(made, ruled=context.ruled)
    if (depths := context.depths) is not None:
        made = replace(made, report=made.report.with_depths(depths.report()), depths=depths)
    if (feeds := context.feeds) is not None:
        made = replace(made, report=made.report.with_feeds(feeds.report()), feeds=feeds)
    if not len(made.program.moves):
        raise GeometryError(_nothing(name, made.findings))
    return made


@dataclass(frozen=True)
class MakeContext:
    """What a program is made with, resolved once, before anything is computed.

    Attributes:
        job: what is computed.
        post: in whose words it is written.
        machine: that it has to fit, and on which it is timed; None = timed on a usual one.
        drawing_findings: what reading the drawing had to say.
        compute: makes the moves.
        computed_at: share of the progress at which they are made.
        proposal: the operations that were proposed; None where they were given.
        feeds: the speeds and feeds that were proposed; None where they were given.
        ruled: what rules for layers have made, a line a layer.
        depths: what was read of the drawing's own depths; None where nobody asked.
    """

    job: Job
    post: Post
    machine: Machine | None
    drawing_findings: tuple[Finding, ...]
    compute: Callable[[Progress], Program]
    computed_at: float = 0.64
    proposal: Proposal | None = None
    feeds: JobWithFeeds | None = None
    ruled: tuple[str, ...] = ()
    depths: JobToDepths | None = None


def _exactly(name: str, data: bytes, options: MakeOptions, progress: Progress) -> MakeContext:
    """Return how a drawing is machined on its exact lines and arcs."""
    drawing = read_for(name, data, options)
    ruled = with_layer_rules(drawing.part, options)
    options, proposal = ruled.options, None
    if options.propose is not None:
        from ..job.proposed import with_proposal

        options, proposal = with_proposal(drawing.part, options, progress)
    job, depths = job_from_drawing(drawing, options), None
    if options.drawn_depths:
        from ..job.drawn_depths import with_drawn_depths

        depths = with_drawn_depths(job)
        job = depths.job
    found = (
        *ruled.findings,
        *(depths.findings if depths else ()),
        *(proposal.findings if proposal else ()),
        *drawing.findings,
    )
    fed = with_feeds(job, options)
    return replace(
        _exact_context(fed.job, found, options.machine),
        proposal=proposal,
        feeds=_proposed(fed),
        ruled=ruled.lines,
        depths=depths,
    )


def _proposed(fed: JobWithFeeds) -> JobWithFeeds | None:
    return fed if fed.proposals else None


def _exact_context(job: Job, findings: tuple[Finding, ...], machine: Machine | None) -> MakeContext:
    from ...operations.compute import compute

    job.check_operations()
    whole = job.prepared()
    whole.check_operations()
    post = load_post(job.post)
    step = job.out_units.value * 10.0 ** -post.digits(job.out_units).X
    return MakeContext(whole, post, machine, findings, lambda progress: compute(whole, progress, step=step))


def _on_pixels(name: str, data: bytes, options: MakeOptions, progress: Progress) -> MakeContext:
    """Return how a drawing or a picture is machined on pixels alone."""
    from ..pixels.way import compute_on_bitmap
    from .bitmap_job import bitmap_job

    if options.rules:
        raise InputError("Rules for layers have no effect on pixels, which have none; leave the template away.")
    if options.drawn_depths:
        raise InputError(f"{option('depths', 'drawing')} has no effect on pixels, which tell no depth; leave it away.")
    ready = bitmap_job(name, data, options)
    fed = with_feeds(ready.job, options)
    return MakeContext(
        fed.job,
        load_post(fed.job.post),
        options.machine,
        ready.findings,
        lambda progress: compute_on_bitmap(fed.job, ready.part, progress).program,
        computed_at=0.5,
        feeds=_proposed(fed),
    )


def _nothing(name: str, findings: tuple[Finding, ...]) -> str:
    """Return why a drawing gave no path."""
    if not findings:
        return f"{name}: there is no closed contour to machine; draw one, or choose other layers."
    telling = sorted(findings, key=lambda finding: (not finding.counts, finding.kind is not FindingKind.OPEN_CONTOUR))
    counting = {finding.kind for finding in findings if finding.counts}
    why = (
        "there is no closed contour, so nothing can be cut."
        if counting == {FindingKind.OPEN_CONTOUR}
        else "nothing can be cut."
    )
    letters = accumulate(len(finding.text) for finding in telling[:NAMED])
    named = max(1, sum(upto <= LETTERS for upto in letters))
    more = f" ({len(findings) - named} more findings)" if len(findings) > named else ""
    return f"{name}: {why} {' '.join(finding.text for finding in telling[:named])}{more}"


def export(
    job: Job,
    progress: Progress = NO_PROGRESS,
    drawing_findings: tuple[Finding, ...] = (),
    machine: Machine | None = None,
) -> MakeResult:
    """Compute a job, write its NC text, read it back, and measure what was made.

    Args:
        job: what to compute.
        progress: steps through all of it.
        drawing_findings: what reading the drawing had to say; goes into the report with the rest.
        machine: that it has to fit, and on which it is timed; None = timed on a usual one.

    Raises:
        HitofudeError: the job cannot be computed or written, or what was written is not what was computed.
        Cancelled: the job was asked to stop.
    """
    context = _exact_context(job, drawing_findings, machine)
    return _finished(context.compute(progress.part(0.0, 0.6)), context, progress.part(0.6, 1.0))


def finish(
    program: Program,
    job: Job,
    progress: Progress = NO_PROGRESS,
    drawing_findings: tuple[Finding, ...] = (),
    machine: Machine | None = None,
) -> MakeResult:
    """Slow the feed where too much is engaged, write the NC text, read it back, and measure it: for a caller that has
    the program.

    Args and errors: as `export`.
    """
    context = MakeContext(job, load_post(job.post), machine, drawing_findings, lambda _: program)
    return _finished(program, context, progress)


def _finished(program: Program, context: MakeContext, progress: Progress) -> MakeResult:
    """Return all that is made of computed moves: the text, what is proven and measured of it, the report."""
    job = context.job
    give_back()  # contours, rings and strokes were very many small things
    if any(operation.engagement_limit < 1.0 for operation in job.operations):
        from ...toolpath.engagement.feed import followed  # compiled code: loaded where it is used

        program = followed(program, job, progress.part(0.0, 0.1))
    measured_first = partial(_measured, program, job)
    with beside(measured_first, progress.part(0.6, 0.85), len(program.moves) <= _MOST_BESIDE) as measuring:
        progress.step(0.1, "Writing NC")
        written = write_and_check(program, job, context.post, context.machine, progress.part(0.1, 0.2))
        lines = np.concatenate([file.nc.lines for file in written.files]) if written.files else program.moves.line
        program = replace(program, moves=replace(program.moves, line=lines))
        give_back()
        proofs = prove(program, job, written, progress.part(0.2, 0.22))
        rapids = rapids_in_material(program, job, progress.part(0.22, 0.25))
        metal = cut_job(program, job, written, measuring.result, progress.part(0.25, 0.98)) if written.files else None
        depths, coverage = measuring.result()
    deepest = deepest_of(depths)
    clamped = deepest_of(clamps_met(program, job, depths))
    unsafe = (*_gouge_findings(deepest, program), *_clamp_findings(clamped, program), *_rapid_findings(rapids, program))
    own = (
        *unsafe,
        *(news(metal, unsafe) if metal is not None else ()),
        *proofs.findings(),
        *_shape_findings(program, job),
        *written.coarseness(job.out_units),
        *(written.misfits() if context.machine else ()),
        *coverage_findings(coverage),
        *floor_findings(program.areas, CHORD),
        *_ring_findings(program),
    )
    findings = worst_first((*own, *program.findings, *context.drawing_findings))
    progress.step(1.0, "Done")
    measured = ReportData(program, job, written, deepest, rapids, coverage, findings, metal, proofs)
    report = make_report(measured)
    return MakeResult(job, program, written.files, written.box(cuts=True), report, findings, coverage, metal)


def _measured(program: Program, job: Job, progress: Progress) -> MeasuredMoves:
    """Return what closed forms say of computed moves; nothing of it needs their text."""
    progress.step(0.0, "Checking clearance")
    give_back()
    depths = gouge_depths(program, job, progress=progress.part(0.0, 0.2))
    clear = clear_moves(program.moves, depths, CHORD)
    measured = MeasuredMoves(depths, measure_beside_clear(program, job, clear, progress.part(0.2, 1.0)))
    give_back()
    return measured


def _shape_findings(program: Program, job: Job) -> Iterator[Finding]:
    """Yield what is to say of tools that do not cut straight walls and a flat floor, as paths beside walls take them to
    do, and of cones that go deeper than they are high.

    Holes that go through are as wide as they should be where the tool goes on by as much as its end is rounded.
    """
    moves = program.moves
    used = set(np.unique(moves.operation).tolist())
    operations = [(k, each) for k, each in enumerate(job.operations) if k in used]
    bare = [k for k, each in operations if each.CARVES or (each.follows_lines and not _needs_square(each, job))]
    tools = [job.tool(number) for number in dict.fromkeys(moves.tool[~np.isin(moves.operation, bare)].tolist())]
    for tool in tools:
        if not tool.kind.square:
            text = (
                f"T{tool.number} is a {tool.kind.value} cutter, and its path is that of a flat one of "
                f"{tool.diameter:g} mm: walls and floor will not come out as they are shown; choose a flat cutter."
            )
            yield Finding(FindingKind.TOOL_SHAPE, text)
    opened = max((each.cut.floor for _, each in operations if not each.HOLES and not each.follows_lines), default=0.0)
    for _, each in operations:
        if each.follows_lines:
            yield from _too_deep_for(each, job.tool(each.cut.tool), opened)


def _needs_square(operation: Operation, job: Job) -> bool:
    """Tell whether holes that an operation makes want a tool with a sharp lower edge: they have a floor, or the tool
    does not come out of the stock as far as its end is rounded.
    """
    profile, radius = job.tool(operation.cut.tool).profile, job.tool(operation.cut.tool).radius
    end = profile.fillet + (radius - profile.flat) * profile.cone
    out = operation.cut.floor + operation.beyond - job.stock.thickness
    return operation.HOLES and operation.LEVELS and out < end


def _too_deep_for(operation: Operation, tool: Tool, opened: float) -> Iterator[Finding]:
    """Yield that a cone goes deeper than it is high, and no flutes are known above it, or that a drill's flutes do not
    reach out of the hole.

    Args:
        opened: how deep other operations clear areas, in which holes may begin, mm.
    """
    high, depth = (tool.radius - tool.profile.flat) * tool.profile.cone, operation.cut.floor + operation.beyond
    who = f"T{tool.number} {tool.label}"
    if operation.HOLES and tool.kind.drills:
        within = depth - opened
        if not operation.CARVES and 0 < tool.flute_length < within:
            text = (
                f"{who} goes {within:g} mm deep, and its flutes are {tool.flute_length:g} mm long: chips do not come "
                "out of the hole; take a longer tool."
            )
            yield Finding(FindingKind.TOOL_SHAPE, text, counts=False, amount=within - tool.flute_length)
    elif high and not (operation.HOLES and operation.CARVES) and depth > max(high, tool.flute_length) + LEVEL:
        text = (
            f"{who} goes {depth:g} mm deep, and its cone is {high:.3f} mm high: above that it would cut with its "
            "shank; reduce the depth, or take a wider cutter."
        )
        yield Finding(FindingKind.TOOL_SHAPE, text, amount=depth - high)


def _ring_findings(program: Program) -> tuple[Finding, ...]:
    """Return the remark that some rings are not exact lines and arcs."""
    count = program.polyline_rings
    return (
        (Finding(FindingKind.TOLERANCE, f"{rings_in_words(count)}.", counts=False, amount=float(count)),)
        if count
        else ()
    )


def _gouge_findings(gouge: Gouge, program: Program) -> tuple[Finding, ...]:
    if gouge.max_mm <= LEVEL or gouge.x is None or gouge.y is None:
        return ()
    text = (
        f"{gouge.count} moves cut into the part, the worst by {gouge.max_mm:.4f} mm at ({gouge.x:.3f}, {gouge.y:.3f}), "
        f"NC line {program.moves.line[gouge.move]}; do not run this program."
    )
    return (Finding(FindingKind.GOUGE, text, gouge.x, gouge.y, amount=gouge.max_mm),)


def _clamp_findings(met: Gouge, program: Program) -> tuple[Finding, ...]:
    if met.max_mm <= LEVEL or met.x is None or met.y is None:
        return ()
    text = (
        f"{met.count} moves reach into a keep-out area, the worst by {met.max_mm:.4f} mm at ({met.x:.3f}, "
        f"{met.y:.3f}), NC line {program.moves.line[met.move]}; do not run this program."
    )
    return (Finding(FindingKind.CLAMP, text, met.x, met.y, amount=met.max_mm),)


def _rapid_findings(rapids: tuple[RapidInMaterial, ...], program: Program) -> tuple[Finding, ...]:
    if not rapids:
        return ()
    first = rapids[0]
    text = (
        f"{len(rapids)} rapids go through material, the first to ({first.x:.3f}, {first.y:.3f}, {first.z:.3f}), "
        f"NC line {program.moves.line[first.move]}; do not run this program."
    )
    return (Finding(FindingKind.RAPID_IN_MATERIAL, text, first.x, first.y, amount=float(len(rapids))),)
