"""What of a program can be cut: motions whose ways are known, and where the program first comes to a known place."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..gcode.interpreter.program import NcProgram
from ..gcode.timing.extent import at_home, from_nowhere_of, nowhere_of
from ..model.motion import Floats, MotionKind, Motions
from ..simulation.sweeps.course import Course

COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
"""Of motions, a row for each."""


@dataclass(frozen=True, eq=False)
class KnownCourse:
    """The course of a program, as far as its places are known.

    Attributes:
        course: motions that begin, along an axis, at a place that nobody knows, begin where they end along it. Left out
            are those that end at such a place, curves that begin at one, and the rapid that first comes to a known
            place.
        first: row of the motion that first ends at a known place; the number of motions where none does.
        nowhere: (n, 3) whether each motion ends, along an axis, at a place that nobody knows.
        home: (n, 3) whether that is because it is a place of the machine.
        begins: whether the motion of `first` starts at a known place too.
    """

    course: Course
    first: int
    nowhere: NDArray[np.bool_]
    home: NDArray[np.bool_]
    begins: bool = False


def course_of(program: NcProgram) -> KnownCourse:
    """Return what of a program can be cut; before it sets an axis, and at a place of the machine, nobody knows where it
    is.
    """
    motions, nowhere = program.motions, nowhere_of(program)
    unknown = np.asarray(nowhere.any(axis=1))
    from_nowhere = from_nowhere_of(program, nowhere)
    curved = motions.kind >= MotionKind.ARC_CW
    start, moved = motions.start, from_nowhere & ~curved[:, None] & (motions.start != motions.end)
    if moved.any():  # else it is not held twice
        start = np.where(moved, motions.end, start)
    first = int(np.argmin(unknown)) if not unknown.all() else len(unknown)
    left_out = unknown | (curved & from_nowhere.any(axis=1))
    begins = bool(first < len(unknown) and not from_nowhere[first].any())
    if first < len(unknown) and motions.kind[first] == MotionKind.RAPID and not begins:
        left_out[first] = True
    motions = replace(motions, start=start, known_from=(0, 0, 0))
    tools = tuple(state.tool for state in program.states)
    return KnownCourse(
        Course.of(motions, tools, tuple(np.flatnonzero(left_out).tolist())), first, nowhere, at_home(program), begins
    )


def picked(course: Course, rows: NDArray[np.intp]) -> Course:
    """Return some motions of a course, in their order; `rows` rise."""
    motions = course.motions
    columns = {name: getattr(motions, name)[rows] for name in COLUMNS}
    splines = {
        int(np.searchsorted(rows, row)): motions.splines[row]
        for row in set(motions.splines).intersection(rows.tolist())
    }
    left_out = np.flatnonzero(np.isin(rows, course.left_out))
    return Course(replace(motions, splines=splines, **columns), course.tool[rows], tuple(left_out.tolist()))


def straight(start: Floats, end: Floats, kind: MotionKind = MotionKind.RAPID) -> Motions:
    """Return straight motions between (n, 3) places, mm."""
    count = len(start)
    small, whole = np.zeros(count, np.uint8), np.zeros(count, np.int32)
    return Motions(
        start.copy(),
        end.copy(),
        np.full((count, 3), np.nan),
        np.full(count, kind, np.uint8),
        small,
        whole,
        np.zeros(count),
        whole,
        whole,
    )


class InsertedMotions(NamedTuple):
    """A course, and for each of its motions which of the inserted ones it is, -1: none."""

    course: Course
    owner: NDArray[np.intp]


def inserted(course: Course, at: NDArray[np.intp], more: Motions, tool: NDArray[np.int32]) -> InsertedMotions:
    """Return a course with more motions in it.

    Args:
        at: (n,) row of the course that each comes before, in any order; those before one row keep their order.
        more: n straight motions. tool: (n,) T number of each.
    """
    columns = {name: np.insert(getattr(course.motions, name), at, getattr(more, name), axis=0) for name in COLUMNS}
    owner = np.insert(np.full(len(course.motions), -1, np.intp), at, np.arange(len(more)))
    place = np.flatnonzero(owner < 0)
    splines = {int(place[row]): spline for row, spline in course.motions.splines.items()}
    left_out = tuple(place[list(course.left_out)].tolist())
    made = Course(
        replace(course.motions, splines=splines, **columns), np.insert(course.tool, at, tool).astype(np.int32), left_out
    )
    return InsertedMotions(made, owner)
