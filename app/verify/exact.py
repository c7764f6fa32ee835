"""Gouges and what is left of a drawing, measured on the motions themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..model.job import Job
from ..model.moves import Moves
from ..model.stock_box import StockBox
from ..simulation.sweeps.course import Course
from ..toolpath.coverage.coverage import Coverage, measure
from .motion_moves import moves_of
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
