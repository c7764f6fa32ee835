"""Rapids of controls whose axes may each go at their own rate: the way is bent then, and may lead through metal that
the straight one passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.motion import Floats, MotionKind
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import RapidHit, trim
from .course import inserted, straight


class _Legs(NamedTuple):
    """Straight pieces of bent ways: (n, 3) places, mm, and the row of the motion that each belongs to."""

    start: Floats
    end: Floats
    row: NDArray[np.intp]


def bent_rapids(
    course: Course, before: Workpiece, cutters: Mapping[int, Cutter], progress: Progress = NO_PROGRESS
) -> tuple[RapidHit, ...]:
    """Return the rapids that meet metal where all axes set out together at the same rate, and each stops where it is
    to; by the rows of the course, whatever their straight ways meet.

    Args:
        course: of a program. before: the metal before it. cutters: by T number.

    Raises:
        Cancelled: the job was asked to stop.
    """
    rows = _in_question(course, before, cutters)
    if not len(rows):
        return ()
    legs = _legs(course.motions.start[rows], course.motions.end[rows], rows)
    made = inserted(course, legs.row, straight(legs.start, legs.end), course.tool[legs.row])
    deepest: dict[int, RapidHit] = {}
    for hit in trim(before, made.course, cutters, progress=progress).rapids:
        leg = int(made.owner[hit.motion])
        if leg >= 0:
            row = int(legs.row[leg])
            known = deepest.get(row)
            if known is None or hit.depth > known.depth:
                deepest[row] = replace(hit, motion=row)
    return tuple(deepest[row] for row in sorted(deepest))


def _in_question(course: Course, before: Workpiece, cutters: Mapping[int, Cutter]) -> NDArray[np.intp]:
    """Return the rapids along several axes, not as far along each, below the top and over the stock."""
    motions, (x0, y0, x1, y1) = course.motions, before.grid.box
    low, high = np.minimum(motions.start, motions.end), np.maximum(motions.start, motions.end)
    way = high - low
    longest = way.max(axis=1, keepdims=True)
    bent = ((way > LEVEL) & (way < longest - LEVEL)).any(axis=1)
    radius = np.zeros(len(motions))
    for number, cutter in cutters.items():
        radius[course.tool == number] = cutter.radius
    over = (
        (low[:, 0] - radius < x1) & (low[:, 1] - radius < y1) & (high[:, 0] + radius > x0) & (high[:, 1] + radius > y0)
    )
    below = low[:, 2] < float(before.heights.max()) - LEVEL
    found = (motions.kind == MotionKind.RAPID) & bent & over & below & np.isin(course.tool, list(cutters))
    found[list(course.left_out)] = False
    return np.flatnonzero(found)


def _legs(start: Floats, end: Floats, rows: NDArray[np.intp]) -> _Legs:
    """Return the bent ways from (n, 3) places to others: every axis goes on until it is where it is to."""
    way = end - start
    far = np.sort(np.abs(way), axis=1)
    corners = [start] + [start + np.clip(way, -far[:, k : k + 1], far[:, k : k + 1]) for k in range(3)]
    begins, ends = np.stack(corners[:3], axis=1).reshape(-1, 3), np.stack(corners[1:], axis=1).reshape(-1, 3)
    moves = np.abs(ends - begins).max(axis=1) > 0.0
    return _Legs(begins[moves], ends[moves], np.repeat(rows, 3)[moves])
