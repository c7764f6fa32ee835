"""Any program cut out of its stock: what is left, what went wrong on the way, and how near it is to the part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from ...core.effort import announce
from ...core.progress import NO_PROGRESS, Progress
from ...model.finding import Finding, FindingKind, worst_first
from ...simulation.engines import Engine, EngineReport, Graphics
from ...simulation.sweeps.trim import CutResult
from ...verify.exact import ExactDeviations
from ...verify.holder_contacts import HolderReport
from ...verify.judgement import Judgement, findings_of
from ...verify.parts import SolidPart, beyond
from ...verify.wall_probe import unseen_walls
from .context import CutContext
from .setup import CELLS, CutOptions, CutSetup
from .stages import CutOutcome, bounded_cut, cut_all, judged

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
    if judgement is not None:
        yield from findings_of(judgement, setup.where)
    if isinstance(setup.part, SolidPart) and context.closely:
        yield from unseen_walls(setup.part, context.workpiece.grid.pitch)
    yield from _fallen_back(done.engine_report, options.engine)


def _fallen_back(engine_report: EngineReport, requested: Engine) -> tuple[Finding, ...]:
    """Return the remark that another engine has computed the heights than the one that was asked for."""
    if not engine_report.fault or requested is Engine.AUTO:
        return ()
    text = f"The heights are the processor's, not those of the engine {requested.value}: {engine_report.fault}."
    return (Finding(FindingKind.ASSUMED, text, counts=False),)
