"""From a made program to the metal that it leaves: the very bytes are read back and cut out of the job's stock."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from app.dexel.cutter import cutter_of
from app.dexel.trim import Course, Cut, TrimOptions, trim
from app.dexel.workpiece import Grid, Workpiece
from app.model.job import Job
from app.model.motion_path import anchored
from app.model.stock_box import stock_box, work_origin
from app.nc.posts import load_post
from app.nc.read.options import ReadOptions
from app.nc.read.program import NcProgram
from app.nc.read.reader import read_program
from app.progress import NO_PROGRESS, Progress
from app.workflow.make import Made

CELLS = 1024
"""Along the stock's longer side, as on the text's screen."""


@dataclass(frozen=True, eq=False)
class CutProgram:
    """A program that was cut, of one file or more.

    Attributes:
        programs: of each file, as read back.
        cut: what is left after the last one; its owners count through the motions of all files.
        top, floor: of the stock, mm, program coordinates.
    """

    programs: tuple[NcProgram, ...]
    cut: Cut
    top: float
    floor: float

    def lines(self) -> NDArray[np.int32]:
        """Return the line of each motion, in its own file."""
        return np.concatenate([program.motions.line for program in self.programs])

    def tools(self) -> NDArray[np.int32]:
        """Return the T number of each motion."""
        return np.concatenate([_tools(program) for program in self.programs])


def _tools(program: NcProgram) -> NDArray[np.int32]:
    return np.array([state.tool for state in program.states], np.int32)[program.motions.state]


def cut_made(made: Made, cells: int = CELLS, progress: Progress = NO_PROGRESS) -> CutProgram:
    """Cut a made program out of its job's stock.

    Args:
        made: with at least one file.
        cells: along the stock's longer side.

    Raises:
        HitofudeError: a tool makes no shape, or there are more cells than memory holds.
        Cancelled: the job was asked to stop.
    """
    workpiece = _stock(made.job, made, cells)
    cutters = {tool.number: cutter_of(tool) for tool in made.job.tools}
    options = ReadOptions(dialect=load_post(made.job.post).dialect)
    programs: list[NcProgram] = []
    cut: Cut | None = None
    for k, file in enumerate(made.files):
        part = progress.part(k / len(made.files), (k + 1) / len(made.files))
        program = read_program(file.nc.text.encode("ascii"), options, part.part(0.0, 0.2))
        program = replace(program, motions=anchored(program.motions))
        own = int(made.program.moves.tool[file.first])  # where the control changes no tools, the file names none
        program = replace(program, states=tuple(replace(state, tool=state.tool or own) for state in program.states))
        course = Course.of(program.motions, tuple(state.tool for state in program.states), program.homeward)
        after = trim(workpiece, course, cutters, TrimOptions(trace=True), part.part(0.2, 1.0))
        cut = after if cut is None else _joined(cut, after, sum(len(each.motions) for each in programs))
        workpiece = cut.workpiece
        programs.append(program)
    assert cut is not None
    return CutProgram(tuple(programs), cut, float(cut.before.heights.max()), cut.before.floor)


def _stock(job: Job, made: Made, cells: int) -> Workpiece:
    """Return the job's stock in program coordinates."""
    box = stock_box(job, made.program.regions)
    x, y, z = work_origin(job, box)
    grid = Grid.over((box.x0 - x, box.y0 - y, box.x1 - x, box.y1 - y), cells)
    heights = np.full((grid.rows, grid.cols), box.z1 - z, np.float32)
    return Workpiece(grid, heights, box.z0 - z)


def _joined(first: Cut, then: Cut, motions: int) -> Cut:
    """Return two cuts, one after the other, as one; `motions` came before the second."""
    assert first.owner is not None and then.owner is not None
    owner = np.where(then.owner >= 0, then.owner + np.int32(motions), first.owner)
    rapids = tuple(replace(hit, motion=hit.motion + motions) for hit in then.rapids)
    return Cut(
        first.before, then.heights, first.rapids + rapids, owner, np.concatenate([first.volume, then.volume]),
        np.concatenate([first.engaged, then.engaged]),
    )  # fmt: skip
