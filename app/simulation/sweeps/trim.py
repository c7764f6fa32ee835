"""Cuts a work piece by motions: the lowest height of every sweep in every cell, exactly."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats
from ..cutter import Cutter
from ..field.workpiece import Heights, Workpiece, ensure_memory
from .course import Course, Ints, TrimOptions
from .sweeps import CoursePart, CutField, HeightLimits, Sweeps

AS_IT_IS = TrimOptions()


@dataclass(frozen=True, slots=True)
class RapidHit:
    """A rapid motion that goes through metal.

    Attributes:
        motion: its row. x, y: where it is deepest, mm. depth: how deep, mm. cells: how many it meets.
        z: height that the cutter reaches there, mm; the metal stands `depth` higher.
    """

    motion: int
    x: float
    y: float
    depth: float
    cells: int
    z: float


@dataclass(frozen=True, eq=False)
class CutResult:
    """What a course has left of a work piece.

    Attributes:
        before: the work piece.
        heights: (rows, cols) mm.
        rapids: those that met metal, in their order.
        owner: (rows, cols) row of the motion that cut each cell last, -1 where none did; None if it was not traced.
        volume: (n,) mm³ that each motion took; empty if not traced.
        engaged: (n,) cells that each motion lowered; empty if not traced.
    """

    before: Workpiece
    heights: Heights
    rapids: tuple[RapidHit, ...] = ()
    owner: Ints | None = None
    volume: Floats = field(default_factory=lambda: np.zeros(0))
    engaged: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))

    @property
    def removed_volume(self) -> float:
        """mm³, from the heights before and after."""
        taken = np.subtract(self.before.heights, self.heights).sum(dtype=np.float64)
        return float(taken) * self.before.grid.pitch**2

    @property
    def workpiece(self) -> Workpiece:
        """What is left, to be cut again."""
        return Workpiece(self.before.grid, self.heights, self.before.floor, self.before.hidden)


def trim(
    workpiece: Workpiece,
    course: Course,
    cutters: Mapping[int, Cutter],
    options: TrimOptions = AS_IT_IS,
    progress: Progress = NO_PROGRESS,
) -> CutResult:
    """Cut a work piece.

    Heights are within 5e-6 mm (1 + slope of the surface) of exact for heights up to 32 mm, where a helix went within
    `pieces.helix_chord`; beside a vertical wall a cell whose centre is on the wall may fall to either side. They do not
    depend on the order of chains of motions, bit for bit, as long as there are no more than `sweeps.BATCH` pieces
    (breaking up a chain changes which cells are evaluated, and so the rounding).

    Args:
        workpiece: it is left as it is.
        course: motions and their tools.
        cutters: by T number.
        options: what to note.
        progress: told as tiles are done.

    Raises:
        ParameterError: a tool that cuts is not among the cutters, or the notes would not fit into memory.
        Cancelled: the job was asked to stop.
    """
    job = _TrimJob(workpiece, course, cutters, options)
    job.run(progress)
    progress.step(1.0, "Cut")
    return job.result()


class _TrimJob:
    """The state of one trim."""

    def __init__(
        self, workpiece: Workpiece, course: Course, cutters: Mapping[int, Cutter], options: TrimOptions
    ) -> None:
        self.workpiece, self.options = workpiece, options
        ensure_memory(workpiece.grid, 8 if options.trace else 4)
        self.sweeps = Sweeps(workpiece.grid, course, cutters, options)
        owner = np.full(workpiece.heights.shape if options.trace else (0, 0), -1, np.int32)
        self.field = CutField(np.empty_like(workpiece.heights), owner)
        noted = len(course.motions) if options.trace else 0
        self.volume, self.engaged = np.zeros(noted), np.zeros(noted, np.int64)
        self.hits: dict[int, RapidHit] = {}

    def run(self, progress: Progress) -> None:
        """Cut batch by batch."""
        workpiece, options, sweeps = self.workpiece, self.options, self.sweeps
        before, ends = workpiece.heights, np.append(0, np.cumsum(sweeps.splitter.counts))
        for first, last in sweeps.batches:
            if before is not workpiece.heights and options.stop is not None and first >= options.stop:
                return
            part, share = sweeps.part(first, last), (ends[[first, last]] / max(ends[-1], 1)).tolist()
            sorting = part.sorting(float(before.max()), options.stop)
            limits = HeightLimits(float(before.max()), float(workpiece.floor), float(options.touch))
            told = part.cut(before, self.field, sorting, limits, progress.part(*share))
            if len(told):
                self._take_notes(part, sorting.refs, told)
            before = self.field.heights

    def result(self) -> CutResult:
        """Return what was cut."""
        return CutResult(
            self.workpiece,
            self.field.heights,
            tuple(self.hits[row] for row in sorted(self.hits)),
            self.field.owner if self.options.trace else None,
            self.volume,
            self.engaged,
        )

    def _take_notes(self, part: CoursePart, refs: Ints, told: Floats) -> None:
        from .tile_kernels import ASKS

        grid, motion, asks = self.workpiece.grid, part.motion[refs], part.does[refs] == ASKS
        if self.options.trace:
            self.volume += np.bincount(motion, np.where(asks, 0.0, told[:, 0]), len(self.volume)) * grid.pitch**2
            self.engaged += np.bincount(motion, np.where(asks, 0.0, told[:, 1]), len(self.engaged)).astype(np.int64)
        for k in np.flatnonzero(asks & (told[:, 1] > 0)):
            row, (_, cells, depth, place, z) = int(motion[k]), told[k]
            x, y = grid.place(int(place))
            hit, old = RapidHit(row, x, y, float(depth), int(cells), float(z)), self.hits.get(row)
            deepest = hit if old is None or hit.depth > old.depth else old
            self.hits[row] = replace(deepest, cells=hit.cells + (old.cells if old else 0))
