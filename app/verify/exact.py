"""Gouges and what is left of a drawing, measured on the motions themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.job import Job
from ..model.motion import Floats, MotionKind
from ..model.motion_path import arc_paths
from ..model.moves import Moves, Purpose
from ..model.stock_box import StockBox
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.pieces import PieceSplitter
from ..toolpath.coverage.coverage import Coverage, measure
from .parts import FlatPart
from .verdict import MoveDepths, gouge_depths


@dataclass(frozen=True, eq=False)
class ExactDeviations:
    """What closed forms say of a drawing that was milled, part coordinates.

    Attributes:
        depths: of the moves in the stock; `move` counts the motions of all programs.
        coverage: what is left on the floor; None where a tool that cuts is not flat at its end.
    """

    depths: MoveDepths
    coverage: Coverage | None


def exact_of(
    part: FlatPart, courses: Sequence[Course], stock: StockBox, progress: Progress = NO_PROGRESS
) -> ExactDeviations:
    """Measure programs that were cut one after the other.

    Args:
        stock: program coordinates; beside it and above it nothing is cut.

    Raises:
        Cancelled: the job was asked to stop.
    """
    found = [moves_of(course, part.job, part.origin) for course in courses]
    before = np.cumsum([0, *(len(course.motions) for course in courses)])
    moves = _joined([each.moves for each in found])
    motion = np.concatenate([each.motion + count for each, count in zip(found, before.tolist(), strict=False)])
    program = part.program(moves)
    progress.step(0.0, "Checking clearance")
    x, y, z = part.origin
    box = StockBox(stock.x0 + x, stock.y0 + y, stock.z0 + z, stock.x1 + x, stock.y1 + y, stock.z1 + z)
    depths = gouge_depths(program, part.job, box, by_tool=True, progress=progress.part(0.0, 0.2))
    flat = _flat(moves, part.job)
    coverage = measure(program, part.job, progress.part(0.2, 1.0), part.tolerance, part.targets) if flat else None
    return ExactDeviations(replace(depths, move=motion[depths.move]), coverage)


def _joined(parts: Sequence[Moves]) -> Moves:
    """Return moves, one after the other."""
    columns: dict[str, Any] = {
        name: np.concatenate([part.columns()[name] for part in parts]) for name in parts[0].columns()
    }
    return Moves(**columns)


def _flat(moves: Moves, job: Job) -> bool:
    """Return whether all tools that move are flat, but for drills, which clear no floor."""
    kinds = [job.tool(number).kind for number in np.unique(moves.tool).tolist()]
    return all(kind.square or kind.drills for kind in kinds)


# The motions of a read program as moves in the part's coordinates, for the verdicts that know moves.


STIR = 1e-6
"""mm; the library that measures areas overlooks lines of no length at all."""


@dataclass(frozen=True, eq=False)
class MotionMoves:
    """Moves, and the row of the motion that each belongs to, (n,)."""

    moves: Moves
    motion: NDArray[np.int64]


def moves_of(course: Course, job: Job, origin: tuple[float, float, float]) -> MotionMoves:
    """Return a course as moves of a job.

    Motions that are left out are not among them. A way that does not begin where the one before ends begins with a
    rapid there. One that sinks ends with a move of next to no length, since at its end the cutter stands whole at that
    depth. Arcs of up to a full turn in the XY plane stay arcs; other curves become chords within 1 um
    (`app.simulation.sweeps.pieces`).

    Args:
        course: known ways only.
        job: where a tool is used in more than one operation, its moves count to the one that leaves the least stock.
        origin: program = part - origin, mm.
    """
    ways = _ways(course).chosen(course)
    rows = ways.rows
    jumps = np.ones(len(rows), bool)
    jumps[1:] = np.any(ways.start[1:] != ways.end[:-1], axis=1)
    sinks = (ways.end[:, 2] < ways.start[:, 2]) & (ways.kind != MotionKind.RAPID)
    counts = 1 + jumps + sinks
    order = np.repeat(np.arange(len(rows)), counts)
    nth = np.arange(len(order)) - np.repeat(np.cumsum(counts) - counts, counts)
    jump, stop = jumps[order] & (nth == 0), sinks[order] & (nth == jumps[order] + 1)
    end = (
        np.where(jump[:, None], ways.start[order], ways.end[order])
        + np.array(origin)
        + stop[:, None] * np.array((STIR, 0, 0))
    )
    kind = np.where(jump, MotionKind.RAPID, np.where(stop, MotionKind.LINE, ways.kind[order])).astype(np.uint8)
    centre = np.where((jump | stop)[:, None], np.nan, ways.centre[order] + np.array(origin[:2]))
    tool, rapid = course.tool[rows[order]].astype(np.int16), kind == MotionKind.RAPID
    operation = np.zeros(len(order), np.int16)
    for number in np.unique(tool).tolist():
        operation[tool == number] = _operation(job, number)
    purpose, feed = np.where(rapid, Purpose.RAPID, Purpose.POCKET).astype(np.uint8), course.motions.feed[rows[order]]
    moves = Moves(
        end,
        centre,
        kind,
        purpose,
        operation,
        tool,
        np.zeros(len(order), np.int32),
        np.where(rapid, 0.0, feed),
        course.motions.line[rows[order]],
    )
    return MotionMoves(moves, rows[order])


@dataclass(frozen=True, eq=False)
class _PlainMoves:
    """Plain ways: starts and ends, the motion that each belongs to, kinds, and centres of arcs.

    Attributes:
        start, end: (n, 3), mm. centre: (n, 2) of arcs, mm.
        rows: number of the motion. kind: of it.
    """

    start: Floats
    end: Floats
    rows: NDArray[np.int64]
    kind: NDArray[np.uint8]
    centre: Floats

    def chosen(self, course: Course) -> _PlainMoves:
        """Return those of motions that are not left out."""
        kept = ~np.isin(self.rows, course.left_out)
        return _PlainMoves(self.start[kept], self.end[kept], self.rows[kept], self.kind[kept], self.centre[kept])


def _ways(course: Course) -> _PlainMoves:
    """Return every motion: plain arcs whole, other curves in chords."""
    motions = course.motions
    arcs = arc_paths(motions)
    even = np.abs(arcs.end_radius - arcs.start_radius) < LEVEL
    plain = arcs.rows[(arcs.axes[:, 2] == 2) & even & (np.abs(arcs.sweep) <= 2 * np.pi * (1 + 1e-12))]
    curved = np.setdiff1d(np.flatnonzero(motions.kind >= MotionKind.ARC_CW), plain)
    splitter = PieceSplitter(motions, arcs_stay=False)
    counts = np.ones(len(motions), np.int64)
    parts = [splitter.pieces(int(row), int(row) + 1) for row in curved]
    counts[curved] = [len(part) for part in parts]
    rows = np.repeat(np.arange(len(motions)), counts)
    ways = _PlainMoves(
        motions.start[rows].copy(),
        motions.end[rows].copy(),
        rows,
        motions.kind[rows].copy(),
        motions.centre[rows, :2].copy(),
    )
    at = np.cumsum(counts) - counts
    for row, part in zip(curved.tolist(), parts, strict=True):
        mine = slice(int(at[row]), int(at[row] + counts[row]))
        ways.start[mine], ways.end[mine], ways.kind[mine], ways.centre[mine] = (
            part.start,
            part.end,
            MotionKind.LINE,
            np.nan,
        )
    return ways


def _operation(job: Job, number: int) -> int:
    """Return the index of the operation of a tool that leaves the least stock; 0 where the tool has none."""
    mine = [k for k, operation in enumerate(job.operations) if operation.cut.tool == number and operation.cut.enabled]
    return min(mine, key=lambda k: job.operations[k].cut.stock_to_leave, default=0)
