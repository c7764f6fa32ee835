"""The files of a program, and what they do on a machine: known by reading them back, not by what was meant to be
written.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...formats.machine_toml import DEFAULT_MACHINE, load_machine
from ...gcode.checks.check import Check, CheckReference, check
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts import Post
from ...gcode.timing.duration import Duration, duration
from ...gcode.timing.extent import NOWHERE, Extent, extent, misfits
from ...gcode.writer.write import NcFile, write_files
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.machine import Machine
from ...model.motion import MotionKind, Motions
from ...model.motion_path import anchored, lengths
from ...model.moves import Program
from ...model.part import Units
from ...model.stock_box import StockBox, stock_box, work_origin
from ...operations.registry import OperationMotions
from ...simulation.field.workpiece import BoxStock
from ...toolpath.coverage.coverage import Coverage
from ...verify.exact import ExactDeviations
from ...verify.parts import FlatPart
from ...verify.verdict import MoveDepths
from ..cutting.cut import CutProgram, CutSetup, cut

Floats = NDArray[np.float64]

COARSE = 0.005
"""mm; a path that is written farther from the computed one is a finding."""


@dataclass(frozen=True, eq=False)
class WrittenProgram:
    """What was written: m motions in all files.

    Attributes:
        post: in whose words.
        files: in the order of cutting; none for a program without moves.
        checks: of each file; none of them found a difference, and their motions are anchored.
        machine: on which the files are timed.
    """

    post: Post
    files: tuple[NcFile, ...]
    checks: tuple[Check, ...]
    machine: Machine

    @cached_property
    def kind(self) -> NDArray[np.uint8]:
        """(m,) MotionKind."""
        return _joined([each.program.motions.kind for each in self.checks], np.uint8)

    @cached_property
    def move(self) -> NDArray[np.int64]:
        """(m,) index of the program's move that each motion is done for."""
        return _joined([each.move for each in self.checks], np.int64)

    @cached_property
    def length(self) -> Floats:
        """(m,) mm; the first approach counts from above its end, as nobody knows where the tool is before."""
        return _joined([lengths(program.motions) for program in self.programs], np.float64)

    @cached_property
    def durations(self) -> tuple[Duration, ...]:
        """How long each file takes."""
        return tuple(duration(program, self.machine) for program in self.programs)

    @property
    def moving(self) -> Floats:
        """(m,) seconds of each motion."""
        return _joined([each.moving for each in self.durations], np.float64)

    @property
    def largest_distance_mm(self) -> float:
        """How far the written path is from the computed one at most, as read back; 0 without files."""
        return max((each.largest_distance_mm for each in self.checks), default=0.0)

    @property
    def changes_s(self) -> float:
        """Seconds for changing tools between files, and for the first one, where no file says so."""
        return len(self.files) * self.machine.tool_change if self.post.file_per_tool else 0.0

    @property
    def programs(self) -> tuple[NcProgram, ...]:
        """Of each file, as read back, its motions anchored."""
        return tuple(each.program for each in self.checks)

    def box(self, cuts: bool) -> Extent:
        """Return the box round all motions, or round those that cut, mm, program coordinates."""
        boxes = [
            extent(program, program.motions.kind != MotionKind.RAPID if cuts else None) for program in self.programs
        ]
        low, high = (np.array([getattr(box, end) for box in boxes]) for end in ("low", "high"))
        return Extent(tuple(np.min(low, axis=0).tolist()), tuple(np.max(high, axis=0).tolist())) if boxes else NOWHERE

    def misfits(self) -> tuple[Finding, ...]:
        """Return what the machine cannot do."""
        return tuple(
            Finding(FindingKind.MACHINE, f"NC line {problem.line}{_in_file(file)}: {problem.text}")
            for file, program in zip(self.files, self.programs, strict=True)
            for problem in misfits(program, self.machine)
        )

    def coarseness(self, units: Units) -> tuple[Finding, ...]:
        """Return that the post's decimals are too few.

        Args:
            units: of the program.
        """
        far, decimals = self.largest_distance_mm, self.post.digits(units).X
        if far <= COARSE:
            return ()
        table = "inch" if units is Units.INCH else "mm"
        text = (
            f"The path that {self.post.title} makes of the written contour is up to {far:.3f} mm from the computed "
            "one, for which gouges and what is left are measured, as the contour is rounded and gentle bends are taken "
            'for none; take compensation = "wear" or "computer", or set more decimals in the post.'
            if any(each.by_control for each in self.checks)
            else f"The post {self.post.title} writes {decimals} decimals: the path written is up to {far:.3f} mm from "
            "the computed one, for which gouges and what is left are measured; set more decimals in the post "
            f"(decimals.{table})."
        )
        return (Finding(FindingKind.TOLERANCE, text, amount=far),)


@dataclass(frozen=True, eq=False)
class WrittenMotions:
    """Motions of all files as read back, and the operation that each is done for: what all judges of single operations
    walk over.

    Attributes:
        files: motions of each file.
        operations: for each file, (m,) indices in the job.
        origin: program = part - origin, mm.
    """

    files: tuple[Motions, ...]
    operations: tuple[NDArray[np.int16], ...]
    origin: tuple[float, float, float]

    @staticmethod
    def of(written: WrittenProgram, program: Program, job: Job) -> WrittenMotions:
        """Return the motions of a program's files."""
        if not written.files:
            return WrittenMotions((), (), (0.0, 0.0, 0.0))
        operations = tuple(program.moves.operation[each.move] for each in written.checks)
        box = stock_box(job, program.regions, program.lines)
        return WrittenMotions(tuple(each.motions for each in written.programs), operations, work_origin(job, box))

    def done_for(self, operation: int, cutting: bool = False) -> OperationMotions:
        """Return the motions of one operation of the job, program coordinates; `cutting`: without its rapids."""
        rows = [which == operation for which in self.operations]
        if cutting:
            rows = [own & (each.kind != MotionKind.RAPID) for own, each in zip(rows, self.files, strict=True)]
        own = [(each, np.flatnonzero(row)) for each, row in zip(self.files, rows, strict=True)]
        return OperationMotions(
            np.concatenate([np.zeros((0, 3)), *(each.start[row] for each, row in own)]),
            np.concatenate([np.zeros((0, 3)), *(each.end[row] for each, row in own)]),
            np.concatenate([np.zeros((0, 3)), *(each.centre[row] for each, row in own)]),
            _joined([each.kind[row] for each, row in own], np.uint8),
            _joined([each.feed[row] for each, row in own], np.float64),
            _joined([each.line[row] for each, row in own], np.int32),
        )


def write_and_check(
    program: Program, job: Job, post: Post, machine: Machine | None, progress: Progress = NO_PROGRESS
) -> WrittenProgram:
    """Return the files of a computed program, each read back and found to be the program's moves.

    Args:
        program: its moves may be none.
        job: what it was computed from.
        post: the control's dialect.
        machine: on which to time it; None = a usual one.

    Raises:
        HitofudeError: the program cannot be written, or what was written differs from it.
        Cancelled: the job was asked to stop.
    """
    machine = machine or load_machine(DEFAULT_MACHINE)
    if not len(program.moves):
        return WrittenProgram(post, (), (), machine)
    files = write_files(program, job, post, progress.part(0.0, 0.6))
    checks: list[Check] = []
    for k, file in enumerate(files):
        share = progress.part(0.6 + 0.4 * k / len(files), 0.6 + 0.4 * (k + 1) / len(files))
        share.step(0.0, "Reading the program back")
        found = check(file.nc.text.encode(), file, CheckReference(program, job, post), share)
        found.require(f"{post.title} program{_in_file(file)}")
        checks.append(replace(found, program=replace(found.program, motions=anchored(found.program.motions))))
    return WrittenProgram(post, files, tuple(checks), machine)


def _in_file(file: NcFile) -> str:
    return f" of file {file.suffix.strip('_').replace('_', ', ')}" if file.suffix else ""


def _joined(columns: list[NDArray[Any]], kind: type) -> NDArray[Any]:
    return np.concatenate(columns) if columns else np.zeros(0, kind)


# A written job, cut: the programs as they were read back, out of the job's own stock, against its own drawing.


_TOLD_ELSEWHERE = (FindingKind.LEFT_REACHABLE, FindingKind.LEFT_UNREACHABLE, FindingKind.SKIN)


class MeasuredMoves(NamedTuple):
    """What closed forms say of the computed moves.

    Attributes:
        depths: how deep each cuts into the part.
        coverage: what they leave.
    """

    depths: MoveDepths
    coverage: Coverage


def cut_job(
    program: Program,
    job: Job,
    written: WrittenProgram,
    measured: Callable[[], MeasuredMoves],
    progress: Progress = NO_PROGRESS,
) -> CutProgram:
    """Cut what was written.

    Args:
        program: what was computed; its regions are the part.
        written: at least one file.
        measured: waits for what closed forms say of the computed moves; asked once they are cut.

    Raises:
        HitofudeError: a tool makes no shape.
        Cancelled: the job was asked to stop.
    """
    box = stock_box(job, program.regions, program.lines)
    x, y, z = work_origin(job, box)
    stock = BoxStock(StockBox(box.x0 - x, box.y0 - y, box.z0 - z, box.x1 - x, box.y1 - y, box.z1 - z))

    def exact() -> ExactDeviations:
        depths, coverage = measured()
        motion = np.minimum(np.searchsorted(written.move, depths.move), len(written.move) - 1)
        return ExactDeviations(replace(depths, move=motion), coverage)

    tools = {tool.number: tool for tool in job.tools}
    setup = CutSetup(_with_tools(written, program), tools, stock, _part_of(program, job, written, (x, y, z)))
    return cut(setup, progress=progress, exact=exact)


def _part_of(program: Program, job: Job, written: WrittenProgram, origin: tuple[float, float, float]) -> FlatPart:
    """Return the part that a program makes; its walls may be off by what paths, text and drawn curves are."""
    outlines = (*(contour for region in program.regions for contour in region.contours), *program.lines)
    deviation = max((contour.deviation for contour in outlines), default=0.0)
    return FlatPart(
        job,
        program.regions,
        origin,
        FlatPart.wall_tolerance + written.largest_distance_mm + deviation,
        allowance=program.allowance_mm,
        areas=program.areas,
        lines=program.lines,
        clamps=program.clamps,
        tabs=program.tabs,
        dog_bones=program.dog_bones,
    )


def _with_tools(written: WrittenProgram, program: Program) -> tuple[NcProgram, ...]:
    """Return the programs as read back, with the tool of each file that names none: its control changes none."""
    return tuple(
        replace(read, states=tuple(replace(state, tool=state.tool or tool) for state in read.states))
        for tool, read in (
            (int(program.moves.tool[file.first]), read)
            for file, read in zip(written.files, written.programs, strict=True)
        )
    )


def news(result: CutProgram, known: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return what only the cut has shown, in part coordinates.

    Args:
        known: what closed forms have found; what they found of a kind, the cut need not tell again.
    """
    part = result.setup.part
    assert isinstance(part, FlatPart)
    kinds = {*_TOLD_ELSEWHERE, *(finding.kind for finding in known)}
    x, y, _ = part.origin
    return tuple(
        finding if finding.x is None or finding.y is None else replace(finding, x=finding.x + x, y=finding.y + y)
        for finding in result.findings
        if finding.kind not in kinds
    )
