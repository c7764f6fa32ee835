"""A written job, cut: the programs as they were read back, out of the job's own stock, against its own drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import Program
from ...model.stock_box import StockBox, stock_box, work_origin
from ...simulation.field.workpiece import BoxStock
from ...toolpath.coverage.coverage import Coverage
from ...verify.exact import ExactDeviations
from ...verify.parts import FlatPart
from ...verify.verdict import MoveDepths
from ..cutting.cut import CutProgram, CutSetup, cut
from .written import WrittenProgram

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
    origin = work_origin(job, box)
    x, y, z = origin
    stock = BoxStock(StockBox(box.x0 - x, box.y0 - y, box.z0 - z, box.x1 - x, box.y1 - y, box.z1 - z))
    outlines = (*(contour for region in program.regions for contour in region.contours), *program.lines)
    deviation = max((contour.deviation for contour in outlines), default=0.0)
    part = FlatPart(
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
    # where the control changes no tools, the file names none
    programs = tuple(
        replace(
            read,
            states=tuple(
                replace(state, tool=state.tool or int(program.moves.tool[file.first])) for state in read.states
            ),
        )
        for file, read in zip(written.files, written.programs, strict=True)
    )

    def exact() -> ExactDeviations:
        depths, coverage = measured()
        motion = np.minimum(np.searchsorted(written.move, depths.move), len(written.move) - 1)
        return ExactDeviations(replace(depths, move=motion), coverage)

    return cut(
        CutSetup(programs, {tool.number: tool for tool in job.tools}, stock, part), progress=progress, exact=exact
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
