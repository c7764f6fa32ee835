"""The stages of cutting: one program after the other out of the metal, then what is left beside the part."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...core.progress import Progress
from ...model.finding import Finding
from ...simulation.engines import CutStep, Engine, EngineReport, HeightEngine
from ...simulation.field.workpiece import Heights, Workpiece
from ...simulation.sweeps.course import TrimOptions
from ...simulation.sweeps.trim import CutResult, trim
from ...verify.accidents import ProgramStage, accidents
from ...verify.course import FineStock
from ...verify.exact import ExactDeviations, exact_of
from ...verify.holder_contacts import HolderReport
from ...verify.judge import HeightBounds, JudgementInput, bounded, certify, judge, part_target
from ...verify.judgement import Judgement
from ...verify.parts import FlatPart, SolidPart
from ...verify.wall_probe import WallProbe
from .context import CutContext
from .setup import CELLS


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
    rough = replace(options, window=None, trace=False, engine=Engine.CPU, cells=min(options.cells, CELLS))
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

    return ProgramStage(context.courses[k], before, after, metal, context.setup.tools, where, rates, under)


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
