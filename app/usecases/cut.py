"""Any program cut out of its stock: what is left, what went wrong on the way, and how near it is to the part."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.effort import Reckoning, announce
from ..core.progress import NO_PROGRESS, Progress
from ..gcode.interpreter.program import NcProgram
from ..model.finding import Finding, FindingKind, worst_first
from ..model.motion import Floats
from ..model.stock_box import StockBox
from ..model.tool import Tool
from ..simulation.cutter import Cutter, cutter_of
from ..simulation.engines import CutStep, Engine, EngineReport, Graphics, HeightEngine, hardware
from ..simulation.field.workpiece import Grid, Heights, StockShape, Workpiece, ensure_memory
from ..simulation.sweeps.course import TrimOptions
from ..simulation.sweeps.probe import LowestReach, PathProbe
from ..simulation.sweeps.trim import CutResult, trim
from ..verify.accidents import ProgramStage, accidents
from ..verify.certify import certify
from ..verify.course import KnownCourse, course_of
from ..verify.exact import ExactDeviations, exact_of
from ..verify.fine_stock import FineStock
from ..verify.holder_contacts import HolderReport
from ..verify.judge import JudgementInput, judge, part_target
from ..verify.judgement import Judgement, findings_of
from ..verify.parts import FlatPart, Part, SolidPart, beyond
from ..verify.wall_probe import WallProbe, unseen_walls
from .effort import cut_effort

__all__ = ["CELLS", "CutOptions", "CutProgram", "CutSetup", "Engine", "cut"]

CELLS = 1024
"""Along the stock's longer side, as on the text's screen."""

TRIM_BYTES_A_CELL, BYTES_A_CELL = 18, 64
"""What cutting alone takes, and with judging: heights, owners, bounds, wanted heights, masks, labels."""

GRAPHICS = Graphics()


@dataclass(frozen=True, eq=False)
class CutSetup:
    """What is cut out of what, with what, to become what.

    Attributes:
        programs: of each file, at least one, in the order of cutting, anchored (`app.model.motion_path.anchored`).
        tools: by T number; 0 stands for the tool of a program that names none.
        stock: the metal, program coordinates.
        part: what is to come out; None = nobody has said.
        names: of the programs' files.
    """

    programs: tuple[NcProgram, ...]
    tools: Mapping[int, Tool]
    stock: StockShape
    part: Part | None = None
    names: tuple[str, ...] = ()

    def where(self, motion: int) -> str:
        """Return words for the place of a motion, counted through all programs; of several programs also which one."""
        ends = np.cumsum([len(program.motions) for program in self.programs])
        file = int(np.searchsorted(ends, motion, "right"))
        line = f"NC line {int(self.lines()[motion])}"
        if len(self.programs) == 1:
            return line
        return f"{line} of {self.names[file] if self.names else f'program {file + 1}'}"

    def measured(self, exact: ExactDeviations) -> CutSetup:
        """Return the setup with what is known to be cleared of its drawing."""
        if exact.coverage is None or not isinstance(self.part, FlatPart):
            return self
        return replace(self, part=replace(self.part, floors=exact.coverage.targets))

    def lines(self) -> NDArray[np.int32]:
        """Return the line of each motion of all programs, in its own file."""
        return np.concatenate([program.motions.line for program in self.programs])

    def numbers(self) -> NDArray[np.int32]:
        """Return the T number of each motion of all programs."""
        return np.concatenate([_tools(program) for program in self.programs])


@dataclass(frozen=True, slots=True)
class CutOptions:
    """How finely to look.

    Attributes:
        cells: along the longer side of the stock, or of the window.
        window: x0, y0, x1, y1, mm: only this part of the stock; None = all of it.
        trace: note who cut each cell last, and what each motion took.
        judge: measure on the motions and certify, and look on the whole stock for what goes wrong on the way; else the
            cells alone are compared with the part, which is quick.
        engine: whose heights are shown, judged and written; what only the engine of record can tell it tells beside
            them. A look that is neither traced nor judged is graphics hardware's alone under AUTO; then nobody tells of
            rapids in metal.
        stop: motions from this one on, counted through all files, are not done; None = all are. The engine of record
            tells alone then.
        facet: size of the facets of the published engine, mm; None = about two cells.
    """

    cells: int = CELLS
    window: tuple[float, float, float, float] | None = None
    trace: bool = True
    judge: bool = True
    engine: Engine = Engine.AUTO
    stop: int | None = None
    facet: float | None = None


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
    options: CutOptions = CutOptions(),
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
    run = _CutRun.of(setup, options, graphics)
    if exact is None:  # else the caller has announced all of its job
        announce(run.effort(), progress)
    done = run.cut(progress.part(0.0, 0.4))
    known = None
    if exact is not None:
        known = exact()
        setup = setup.measured(known)
        run = replace(run, setup=setup)
    judgement = run.judged(done.cut, known, progress.part(0.4, 1.0)) if setup.part is not None else None
    outside = beyond(setup.part, run.box()) if setup.part is not None and options.judge else ()
    judged = findings_of(judgement, setup.where) if judgement is not None else ()
    findings = worst_first(
        (*done.accidents, *outside, *judged, *run.unseen(), *_fallen_back(done.engine_report, options.engine))
    )
    return CutProgram(
        setup,
        options,
        done.cut,
        float(run.workpiece.heights.max()),
        run.workpiece.floor,
        judgement,
        findings,
        done.engine_report,
        done.holders,
    )


def _fallen_back(engine_report: EngineReport, requested: Engine) -> tuple[Finding, ...]:
    """Return the remark that another engine has computed the heights than the one that was asked for."""
    if not engine_report.fault or requested is Engine.AUTO:
        return ()
    text = f"The heights are the processor's, not those of the engine {requested.value}: {engine_report.fault}."
    return (Finding(FindingKind.ASSUMED, text, counts=False),)


@dataclass(frozen=True, eq=False)
class _CutOutcome:
    """What all programs left, what went wrong on the way, what has computed the heights, and what is known of
    holders.
    """

    cut: CutResult
    accidents: tuple[Finding, ...]
    engine_report: EngineReport
    holders: HolderReport | None


class _StepResult(NamedTuple):
    """What the engine of record tells of a step, and the heights that are wanted."""

    record: CutResult
    heights: Heights


@dataclass(frozen=True, eq=False)
class _CutRun:
    """A setup made ready: what each program is cut along, the cutters, the metal."""

    setup: CutSetup
    options: CutOptions
    courses: tuple[KnownCourse, ...]
    cutters: Mapping[int, Cutter]
    workpiece: Workpiece
    graphics: Graphics

    @staticmethod
    def of(setup: CutSetup, options: CutOptions, graphics: Graphics) -> _CutRun:
        grid = Grid.over(options.window or setup.stock.box, options.cells)
        ensure_memory(grid, BYTES_A_CELL if setup.part is not None and options.judge else TRIM_BYTES_A_CELL)
        courses = tuple(course_of(program) for program in setup.programs)
        return _CutRun(
            setup,
            options,
            courses,
            {n: cutter_of(tool) for n, tool in setup.tools.items()},
            setup.stock.over(grid),
            graphics,
        )

    def effort(self) -> Reckoning:
        """Return how long it will take."""
        part, judged = self.setup.part, self.options.judge and self.setup.part is not None
        drawn = judged and isinstance(part, FlatPart)
        return cut_effort(self.setup.programs, self.setup.tools, self.workpiece.grid.pitch, drawn, judged)

    def cut(self, progress: Progress) -> _CutOutcome:
        """Cut all programs, and look for what goes wrong on the way: on the whole stock, whatever the window is."""
        if self.options.window is None or not self.options.judge:
            return self._cut(progress)
        setup, options = (
            replace(self.setup, part=None),
            replace(self.options, window=None, trace=False, engine=Engine.CPU),
        )
        whole = _CutRun.of(setup, replace(options, cells=min(options.cells, CELLS)), self.graphics)._cut(
            progress.part(0.0, 0.5)
        )
        seen = replace(self, options=replace(self.options, judge=False))._cut(progress.part(0.5, 1.0))
        return replace(whole, cut=replace(seen.cut, rapids=whole.cut.rapids), engine_report=seen.engine_report)

    def _cut(self, progress: Progress) -> _CutOutcome:
        accident: list[Finding] = []
        holders: HolderReport | None = None
        engine = HeightEngine(self._engine(), self.graphics, self.options.facet)
        cut: CutResult | None = None
        done, count = 0, len(self.courses)
        for k, known in enumerate(self.courses):
            part, before = progress.part(k / count, (k + 1) / count), self.workpiece if cut is None else cut.workpiece
            stop = None if self.options.stop is None else self.options.stop - done
            after, heights = self._heights(
                engine, CutStep(before, known.course, self.cutters), stop, part.part(0.0, 0.8)
            )
            if self.options.judge:
                found = accidents(self._stage(k, before, after, done), part.part(0.8, 1.0))
                accident, after = [*accident, *found.findings], replace(after, rapids=found.rapids)
                holders = found.holders if holders is None else holders.followed(found.holders, done)
            after = replace(after, heights=heights)
            cut = after if cut is None else _joined(cut, after, done)
            done += len(known.course.motions)
        assert cut is not None
        return _CutOutcome(cut, tuple(accident), engine.report, holders)

    def _engine(self) -> Engine:
        """Return which engine's heights are wanted."""
        if self.options.engine is not Engine.AUTO:
            return self.options.engine
        return Engine.GPU if self.options.stop is None and hardware(self.graphics) else Engine.CPU

    def _heights(self, engine: HeightEngine, step: CutStep, stop: int | None, progress: Progress) -> _StepResult:
        """Return what a step leaves, up to a motion."""
        if stop is not None:
            part = trim(*step, TrimOptions(trace=self.options.trace, stop=stop), progress)
            return _StepResult(part, part.heights)
        if engine.requested and not (self.options.trace or self.options.judge) and self.options.engine is Engine.AUTO:
            looked = engine.alone(step, progress)
            if looked is not None:
                return _StepResult(CutResult(step.workpiece, looked), looked)
        share = 0.5 if engine.requested else 1.0
        after = trim(*step, TrimOptions(trace=self.options.trace), progress.part(0.0, share))
        return _StepResult(after, engine.beside(after.heights, step, progress.part(share, 1.0)))

    def _stage(self, k: int, before: Workpiece, after: CutResult, done: int) -> ProgramStage:
        """Return a program as it was cut; `done` motions were before it."""
        metal = FineStock(self.setup.stock, tuple(known.course for known in self.courses[: k + 1]), self.cutters)
        header = self.setup.programs[k].header
        rates, under = ({}, 0.0) if header is None else (dict(header.plunge_rates), header.under)
        where = lambda row: self.setup.where(done + row)  # noqa: E731 (a place of this program)
        return ProgramStage(self.courses[k], before, after, metal, self.setup.tools, where, rates, under)

    def box(self) -> StockBox:
        """Return the box round all of the stock, program coordinates; of a window nobody knows how high the rest is."""
        x0, y0, x1, y1 = self.setup.stock.box
        top = float(self.workpiece.heights.max()) if self.options.window is None else math.inf
        return StockBox(x0, y0, self.workpiece.floor, x1, y1, top)

    def trimmed(self, cutters: Mapping[int, Cutter], options: TrimOptions, progress: Progress) -> Heights:
        """Return what all programs leave when they are cut with other cutters."""
        workpiece, count = self.workpiece, len(self.courses)
        for k, known in enumerate(self.courses):
            workpiece = trim(
                workpiece, known.course, cutters, options, progress.part(k / count, (k + 1) / count)
            ).workpiece
        return workpiece.heights

    def judged(self, cut: CutResult, exact: ExactDeviations | None, progress: Progress) -> Judgement:
        """Compare a cut with the part."""
        part = self.setup.part
        assert part is not None
        used = {number for known in self.courses for number in np.unique(known.course.tool).tolist()}
        cutters = tuple(self.cutters[number] for number in sorted(used & set(self.cutters)))
        target = part_target(part, cut, self.setup.stock, cutters, progress.part(0.0, 0.3))
        if exact is None and self.options.judge and isinstance(part, FlatPart):
            exact = exact_of(part, [known.course for known in self.courses], self.box(), progress.part(0.3, 0.7))
        certificate = (
            certify(self.workpiece, target, self.cutters, self.trimmed, progress.part(0.7, 0.95))
            if self.options.judge
            else None
        )
        lines = self.setup.lines()
        probe, lowest = None, self._lowest if isinstance(part, SolidPart) and self.options.judge else None
        # of surfaces the cells tell enough
        if isinstance(part, SolidPart) and part.block is None and self.options.judge:
            probe = WallProbe(part, self._lowest, self.workpiece)
        judging = JudgementInput(part, cut, target, exact, lines, lowest, probe)
        return judge(judging, certificate, progress.part(0.95, 1.0))

    def unseen(self) -> Iterator[Finding]:
        """Yield what of a solid could not be looked at as closely as the cells are."""
        part = self.setup.part
        if isinstance(part, SolidPart) and part.block is None and self.options.judge:
            yield from unseen_walls(part, self.workpiece.grid.pitch)

    @cached_property
    def _path(self) -> PathProbe:
        """All that the programs cut along, to be asked at single points; made when somebody asks."""
        return PathProbe.of([known.course for known in self.courses], self.cutters)

    def _lowest(self, points: Floats) -> LowestReach:
        """Return the lowest height that all programs reach at points; motions are counted through all of them."""
        return self._path.lowest(points)


def _tools(program: NcProgram) -> NDArray[np.int32]:
    return np.array([state.tool for state in program.states], np.int32)[program.motions.state]


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
