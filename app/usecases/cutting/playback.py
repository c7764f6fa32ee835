"""A cut played: any moment of it at once, told as what has changed since the moment that was shown before."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...formats.machine_toml import DEFAULT_MACHINE, load_machine
from ...gcode.timing.duration import duration
from ...model.motion import Floats, MotionKind
from ...model.motion_part import part_of
from ...model.motion_path import anchored
from ...simulation.cutter import cutter_of
from ...simulation.field.workpiece import Heights
from ...simulation.history.history import History, HistoryOptions, Playhead, changed_box
from ...simulation.sweeps.course import Course
from ...simulation.sweeps.sweeps import CutField
from ...verify.course import course_of
from .cut import CutProgram
from .timeline import Timeline, TimelinePlace

Owners = NDArray[np.int32]

USUAL = HistoryOptions()

ONCE = HistoryOptions(blocks=1, budget=0)
"""To go through it once, from the start to the end: nothing need be kept."""


@dataclass(frozen=True, eq=False)
class PlayFrame:
    """A moment, and the cells that differ from the one that was shown before it.

    Attributes:
        moment: which. row, col: the first cells that differ.
        heights, owner: (h, w) of the cells from there on; (0, 0) where none differs. Owners count through the motions
            of all programs.
        tip: (3,) where the tool's tip is, mm; None: nobody knows.
    """

    moment: TimelinePlace
    row: int
    col: int
    heights: Heights
    owner: Owners
    tip: Floats | None


class Playback:
    """A cut that can be shown at any moment of its way.

    One thread at a time asks it; it takes the budget of `HistoryOptions` and 32 bytes a cell.

    Attributes:
        timeline: when what happens.
    """

    def __init__(
        self,
        done: CutProgram,
        options: HistoryOptions = USUAL,
        progress: Progress = NO_PROGRESS,
    ) -> None:
        """Cut everything once more, and keep what is needed to go anywhere.

        Args:
            done: it must have been traced, on all of the stock or a part of it; it is timed on a usual machine.
            options: how much is kept.
            progress: of this part.

        Raises:
            ParameterError: the grid does not fit into memory.
            Cancelled: the job was asked to stop.
        """
        setup, machine = done.setup, load_machine(DEFAULT_MACHINE)
        courses = [course_of(program) for program in setup.programs]
        known, nowhere = (
            [each.course for each in courses],
            np.concatenate([each.nowhere.any(axis=1) for each in courses]),
        )
        cutters = {number: cutter_of(tool) for number, tool in setup.tools.items()}
        times = [duration(program, machine) for program in setup.programs]
        motions = [anchored(program.motions) for program in setup.programs]
        self.timeline = Timeline.of(motions, times, setup.numbers(), done.cut.volume, nowhere)
        self._courses = known
        self._head = Playhead(History(done.cut.before, known, cutters, options, progress))
        owner = done.cut.owner if done.cut.owner is not None else np.full(done.cut.heights.shape, -1, np.int32)
        self._shown = CutField(done.cut.heights.copy(), owner.copy())
        self._asked = threading.Lock()

    @property
    def bytes(self) -> int:
        """What is kept for going anywhere."""
        return self._head.history.bytes

    def frame(self, moment: TimelinePlace, progress: Progress = NO_PROGRESS) -> PlayFrame:
        """Go to a moment, and return what has changed since the last one that was asked for; the first time since the
        end.

        Raises:
            Cancelled: the job was asked to stop; what was shown before still counts.
        """
        with self._asked:
            self._head.move_to(moment.motion, progress)
            field = self._partly(moment)
            box = changed_box(field, self._shown)
            row, col, end, stop = box or (0, 0, 0, 0)
            return PlayFrame(
                moment,
                row,
                col,
                field.heights[row:end, col:stop].copy(),
                field.owner[row:end, col:stop].copy(),
                self.timeline.place(moment),
            )

    def _partly(self, moment: TimelinePlace) -> CutField:
        """Return the metal with a part of the next motion done."""
        field, row = self._head.field, moment.motion
        if moment.fraction <= 0 or row >= len(self.timeline):
            return field
        program, own = self.timeline.program_of(row)
        course = self._courses[program]
        if course.motions.kind[own] == MotionKind.RAPID or own in course.left_out:
            return field
        part = part_of(course.motions, own, moment.fraction)
        field = CutField(field.heights.copy(), field.owner.copy())
        self._head.history.advance_along(field, Course(part, np.full(len(part), course.tool[own], np.int32)), row)
        return field
