"""Any program cut out of its stock: what is left, what went wrong on the way, and how near it is to the part."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.effort import Reckoning, announce
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...gcode.interpreter.program import NcProgram
from ...model.finding import Finding, FindingKind, worst_first
from ...model.motion import Floats, MotionKind
from ...model.motion_path import lengths
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...simulation.cutter import Cutter, cutter_of
from ...simulation.engines import CutStep, Engine, EngineReport, Graphics, HeightEngine, hardware
from ...simulation.field.workpiece import Grid, Heights, Workpiece, ensure_memory
from ...simulation.sweeps.course import TrimOptions
from ...simulation.sweeps.probe import PROVING_HELIX_CHORD, LowestReach, PathProbe
from ...simulation.sweeps.trim import CutResult, trim
from ...verify.accidents import ProgramStage, accidents
from ...verify.course import FineStock, KnownCourse, course_of
from ...verify.exact import ExactDeviations, exact_of
from ...verify.holder_contacts import HolderReport
from ...verify.judge import HeightBounds, JudgementInput, bounded, certify, judge, part_target
from ...verify.judgement import Judgement, findings_of
from ...verify.parts import FlatPart, SolidPart, beyond, doubtful_size
from ...verify.standing_spindle import fed_standing, standing_cut
from ...verify.standing_tabs import cut_off_tabs
from ...verify.wall_probe import WallProbe, unseen_walls
from .setup import CELLS, CutOptions, CutSetup

__all__ = ["CELLS", "CutOptions", "CutProgram", "CutSetup", "Engine", "cut"]

GRAPHICS, AS_USUAL = Graphics(), CutOptions()


@dataclass(frozen=True, eq=False)
class CutProgram:
    """A program that was cut.

    Attributes:
        setup: what was cut. options: how it was looked at.
        cut: what is left after the last file; its owners, and the motions of its rapids, count through the motions of
            all files.
        top, floor: of the stock, mm, program coordinates.
        judgement: against the part; None where there is none.
        findings: what went wrong on the way and what is wrong with the result, what counts first; places in program
            coordinates.
        engine_report: what has computed the heights.
        holders: shanks and holders in metal, their motions counted through all files; None where nobody has looked.
    """

    setup: CutSetup
    options: CutOptions
    cut: CutResult
    top: float
    floor: float
    judgement: Judgement | None
    findings: tuple[Finding, ...]
    engine_report: EngineReport
    holders: HolderReport | None = None


def cut(
    setup: CutSetup,
    options: CutOptions = AS_USUAL,
    progress: Progress = NO_PROGRESS,
    exact: Callable[[], ExactDeviations] | None = None,
    graphics: Graphics = GRAPHICS,
) -> CutProgram:
    """Cut programs out of their stock, and judge what is left.

    Args:
        exact: tells what closed forms say against a drawing, where the caller knows it, asked once all is cut; else it
            is measured.
        graphics: what computes heights where the options ask for it.

    Raises:
        HitofudeError: a tool makes no shape, or is not among the tools; or there are more cells than memory holds.
        Cancelled: the job was asked to stop.
    """
    context = CutContext.of(setup, options, graphics)
    if exact is None:  # else the caller has announced all of its job
        announce(context.effort(), progress)
    done = cut_all(context, progress.part(0.0, 0.4))
    bounds, known = bounded_cut(context, progress.part(0.4, 0.6)), None
    if exact is not None:  # asked last: who tells it may be at work beside until then
        known = exact()
        context = replace(context, setup=setup.measured(known))
    judgement = judged(context, done.cut, bounds, known, progress.part(0.6, 1.0)) if setup.part is not None else None
    return CutProgram(
        context.setup,
        options,
        done.cut,
        float(context.workpiece.heights.max()),
        context.workpiece.floor,
        judgement,
        worst_first(_findings(context, done, judgement)),
        done.engine_report,
        done.holders,
    )


def _findings(context: CutContext, done: CutOutcome, judgement: Judgement | None) -> Iterator[Finding]:
    """Yield what went wrong on the way, what is wrong with the result, and what could not be looked at."""
    setup, options = context.setup, context.options
    yield from done.accidents
    if setup.part is not None and options.judge:
        yield from beyond(setup.part, context.box())
        yield from doubtful_size(setup.part, _fed_box(context))
    if judgement is not None:
        yield from findings_of(judgement, setup.where)
    if isinstance(setup.part, FlatPart) and setup.part.tabs and options.judge:
        path = PathProbe.of([known.course for known in context.courses], context.cutters, PROVING_HELIX_CHORD)
        yield from cut_off_tabs(setup.part, path, context.cutters.values(), setup.where, setup.lines().tolist())
    if isinstance(setup.part, SolidPart) and context.closely:
        yield from unseen_walls(setup.part, context.workpiece.grid.pitch)
    yield from _fallen_back(done.engine_report, options.engine)


def _fed_box(context: CutContext) -> StockBox | None:
    """Return the box round the ends of all feed motions, program coordinates; None where there are none."""
    ends = np.concatenate(
        [each.course.motions.end[each.course.motions.kind != MotionKind.RAPID] for each in context.courses]
    )
    return StockBox(*ends.min(axis=0).tolist(), *ends.max(axis=0).tolist()) if len(ends) else None


def _fallen_back(engine_report: EngineReport, requested: Engine) -> tuple[Finding, ...]:
    """Return the remark that another engine has computed the heights than the one that was asked for."""
    if not engine_report.fault or requested is Engine.AUTO:
        return ()
    text = f"The heights are the processor's, not those of the engine {requested.value}: {engine_report.fault}."
    return (Finding(FindingKind.ASSUMED, text, counts=False),)


# The stages of cutting: one program after the other out of the metal, then what is left beside the part.


@dataclass(frozen=True, eq=False)
class CutOutcome:
    """What all programs left, what went wrong on the way, what has computed the heights, and what is known of
    holders.
    """

    cut: CutResult
    accidents: tuple[Finding, ...]
    engine_report: EngineReport
    holders: HolderReport | None


def cut_all(context: CutContext, progress: Progress) -> CutOutcome:
    """Cut all programs, and look for what goes wrong on the way: on the whole stock, whatever the window is."""
    options = context.options
    if options.window is None or not options.judge:
        return _one_after_the_other(context, progress)
    traced = any(fed_standing(program).any() for program in context.setup.programs)
    rough = replace(options, window=None, trace=traced, engine=Engine.CPU, cells=min(options.cells, CELLS))
    of_all = CutContext.of(replace(context.setup, part=None), rough, context.graphics)
    whole = _one_after_the_other(of_all, progress.part(0.0, 0.5))
    seen = _one_after_the_other(replace(context, options=replace(options, judge=False)), progress.part(0.5, 1.0))
    return replace(whole, cut=replace(seen.cut, rapids=whole.cut.rapids), engine_report=seen.engine_report)


def _one_after_the_other(context: CutContext, progress: Progress) -> CutOutcome:
    found: list[Finding] = []
    holders: HolderReport | None = None
    engine = HeightEngine(context.engine, context.graphics, context.options.facet)
    cut: CutResult | None = None
    done, count = 0, len(context.courses)
    for k, known in enumerate(context.courses):
        part, before = progress.part(k / count, (k + 1) / count), context.workpiece if cut is None else cut.workpiece
        stop = None if context.options.stop is None else context.options.stop - done
        step = CutStep(before, known.course, context.cutters)
        after, heights = _heights(context, engine, step, stop, part.part(0.0, 0.8))
        if context.options.judge:
            on_the_way = accidents(_stage(context, k, before, after, done), part.part(0.8, 1.0))
            found, after = [*found, *on_the_way.findings], replace(after, rapids=on_the_way.rapids)
            holders = on_the_way.holders if holders is None else holders.followed(on_the_way.holders, done)
        after = replace(after, heights=heights)
        cut = after if cut is None else _joined(cut, after, done)
        done += len(known.course.motions)
    assert cut is not None
    return CutOutcome(cut, tuple(found), engine.report, holders)


class _StepResult(NamedTuple):
    """What the engine of record tells of a step, and the heights that are wanted."""

    record: CutResult
    heights: Heights


def _heights(
    context: CutContext, engine: HeightEngine, step: CutStep, stop: int | None, progress: Progress
) -> _StepResult:
    """Return what a step leaves, up to a motion."""
    options = context.options
    if stop is not None:
        part = trim(*step, TrimOptions(trace=options.trace, stop=stop), progress)
        return _StepResult(part, part.heights)
    if engine.requested and not (options.trace or options.judge) and options.engine is Engine.AUTO:
        looked = engine.alone(step, progress)
        if looked is not None:
            return _StepResult(CutResult(step.workpiece, looked), looked)
    share = 0.5 if engine.requested else 1.0
    after = trim(*step, TrimOptions(trace=options.trace), progress.part(0.0, share))
    return _StepResult(after, engine.beside(after.heights, step, progress.part(share, 1.0)))


def _stage(context: CutContext, k: int, before: Workpiece, after: CutResult, done: int) -> ProgramStage:
    """Return a program as it was cut; `done` motions were before it."""
    courses = tuple(known.course for known in context.courses[: k + 1])
    metal = FineStock(context.setup.stock, courses, context.cutters)
    header = context.setup.programs[k].header
    rates, under = ({}, 0.0) if header is None else (dict(header.plunge_rates), header.under)

    def where(row: int) -> str:
        return context.setup.where(done + row)

    program = context.setup.programs[k]
    return ProgramStage(
        known=context.courses[k],
        before=before,
        cut=after,
        metal=metal,
        tools=context.setup.tools,
        where=where,
        plunge_rates=rates,
        under=under,
        rapids_bend=program.rapids_bend,
        standing=standing_cut(program, after),
    )


def _joined(first: CutResult, then: CutResult, motions: int) -> CutResult:
    """Return two cuts, one after the other, as one; `motions` came before the second."""
    owner = None
    if first.owner is not None and then.owner is not None:
        owner = np.where(then.owner >= 0, then.owner + np.int32(motions), first.owner)
    rapids = tuple(replace(hit, motion=hit.motion + motions) for hit in then.rapids)
    return CutResult(
        first.before,
        then.heights,
        first.rapids + rapids,
        owner,
        np.concatenate([first.volume, then.volume]),
        np.concatenate([first.engaged, then.engaged]),
    )


def bounded_cut(context: CutContext, progress: Progress) -> HeightBounds | None:
    """Return what bounds the heights between the cells; None where no part is judged."""
    if context.setup.part is None or not context.options.judge:
        return None
    return bounded(context.workpiece, context.cutters, context.trimmed, progress)


def judged(
    context: CutContext,
    cut: CutResult,
    bounds: HeightBounds | None,
    exact: ExactDeviations | None,
    progress: Progress,
) -> Judgement:
    """Compare a cut with the part.

    Args:
        bounds: of what is left, see `bounded_cut`; None = nothing is certified.
        exact: what closed forms say against a drawing; None = they are asked where there is one.
    """
    part, judging = context.setup.part, context.options.judge
    assert part is not None
    courses = [known.course for known in context.courses]
    used = {number for course in courses for number in np.unique(course.tool).tolist()}
    cutters = tuple(context.cutters[number] for number in sorted(used & set(context.cutters)))
    target = part_target(part, cut, context.setup.stock, cutters, progress.part(0.0, 0.3))
    if exact is None and judging and isinstance(part, FlatPart):
        exact = exact_of(part, courses, context.box(), progress.part(0.3, 0.7))
    certificate = None if bounds is None else certify(context.workpiece, target, bounds, progress.part(0.7, 0.95))
    lowest = context.lowest if isinstance(part, SolidPart) and judging else None
    probe = (
        WallProbe(part, context.lowest, context.workpiece) if isinstance(part, SolidPart) and context.closely else None
    )
    asked = JudgementInput(part, cut, target, exact, context.setup.lines(), lowest, probe)
    return judge(asked, certificate, progress.part(0.95, 1.0))


# A setup made ready to be cut: what each program is cut along, the cutters, the metal.


TRIM_BYTES_A_CELL, BYTES_A_CELL = 18, 64
"""What cutting alone takes, and with judging: heights, owners, bounds, wanted heights, masks, labels."""


@dataclass(frozen=True, eq=False)
class CutContext:
    """What is cut, resolved once.

    Attributes:
        setup, options: as they were asked.
        courses: what each program is cut along, without what nobody knows.
        cutters: by T number.
        workpiece: the metal before it is cut.
        graphics: what computes heights where the options ask for it.
    """

    setup: CutSetup
    options: CutOptions
    courses: tuple[KnownCourse, ...]
    cutters: Mapping[int, Cutter]
    workpiece: Workpiece
    graphics: Graphics

    @staticmethod
    def of(setup: CutSetup, options: CutOptions, graphics: Graphics) -> CutContext:
        """Return a setup made ready.

        Raises:
            HitofudeError: a tool makes no shape, or there are more cells than memory holds.
        """
        grid = Grid.over(options.window or setup.stock.box, options.cells)
        ensure_memory(grid, BYTES_A_CELL if setup.part is not None and options.judge else TRIM_BYTES_A_CELL)
        cutters = {n: cutter_of(tool) for n, tool in setup.tools.items()}
        courses = tuple(course_of(program) for program in setup.programs)
        return CutContext(setup, options, courses, cutters, setup.stock.over(grid), graphics)

    @property
    def closely(self) -> bool:
        """Whether a solid is looked at between the cells, too; of surfaces the cells tell enough."""
        part = self.setup.part
        return self.options.judge and isinstance(part, SolidPart) and part.block is None

    @property
    def engine(self) -> Engine:
        """Which engine's heights are wanted."""
        if self.options.engine is not Engine.AUTO:
            return self.options.engine
        return Engine.GPU if self.options.stop is None and hardware(self.graphics) else Engine.CPU

    def effort(self) -> Reckoning:
        """Return how long cutting and judging will take."""
        judged = self.options.judge and self.setup.part is not None
        drawn = judged and isinstance(self.setup.part, FlatPart)
        return cut_effort(self.setup.programs, self.setup.tools, self.workpiece.grid.pitch, drawn, judged)

    def box(self) -> StockBox:
        """Return the box round all of the stock, program coordinates; of a window nobody knows how high the rest is."""
        x0, y0, x1, y1 = self.setup.stock.box
        top = float(self.workpiece.heights.max()) if self.options.window is None else math.inf
        return StockBox(x0, y0, self.workpiece.floor, x1, y1, top)

    def trimmed(self, cutters: Mapping[int, Cutter], options: TrimOptions, progress: Progress) -> Heights:
        """Return what all programs leave when they are cut with other cutters."""
        workpiece, count = self.workpiece, len(self.courses)
        for k, known in enumerate(self.courses):
            share = progress.part(k / count, (k + 1) / count)
            workpiece = trim(workpiece, known.course, cutters, options, share).workpiece
        return workpiece.heights

    @cached_property
    def _path(self) -> PathProbe:
        """All that the programs cut along, to be asked at single points; made when somebody asks."""
        return PathProbe.of([known.course for known in self.courses], self.cutters)

    def lowest(self, points: Floats) -> LowestReach:
        """Return the lowest height that all programs reach at points; motions are counted through all of them."""
        return self._path.lowest(points)


# How long cuts will take, reckoned from counts before they are begun.
#
# Seconds a piece are measured, on cuts of 80,000 to 800,000 motions in 1,024 to 4,096 cells.


_CELL_S, _MOTION_S = 4e-9, 1e-6
"""A cell that a cutter passes over; a motion by itself."""

_JUDGED = 3.0
"""So many cuts are made where a part is proven: as it is, with a wider and with a slimmer cutter."""

_FLOOR_S = 1.5e-5
"""A piece of path as long as its tool is wide, of which coverage of a drawing's floors is asked."""


def cut_effort(
    programs: Sequence[NcProgram], tools: Mapping[int, Tool], pitch: float, drawn: bool, judged: bool
) -> Reckoning:
    """Return what cutting programs takes.

    Args:
        tools: by T number. pitch: of the cells, mm.
        drawn: whether the part is a drawing's. judged: whether there is a part at all.
    """
    cells = pieces = count = 0.0
    for program in programs:
        numbers = np.array([state.tool for state in program.states], np.int64)[program.motions.state]
        length = np.nan_to_num(lengths(program.motions))
        for number in np.unique(numbers).tolist():
            if (tool := tools.get(number)) is not None:
                way = float(length[numbers == number].sum())
                cells += way * tool.diameter / pitch**2
                pieces += way / tool.diameter
        count += len(program.motions)
    seconds = (cells * _CELL_S + count * _MOTION_S) * (_JUDGED if judged else 1.0)
    floors = pieces * _FLOOR_S if drawn else 0.0
    fewer = f"choose fewer cells ({option('grid')}) or a part of the stock ({option('window')})"
    return Reckoning(
        seconds + floors,
        f"{count:,.0f} motions in cells of {pitch:.3g} mm",
        f"leave out what it is compared with ({option('against')})" if floors > seconds else fewer,
    )
