"""Problems and differences as rows of a list, and the lines they mark. No Qt but for the rows' own type."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ....gcode.interpreter.program import ProgramProblem, Severity
from ....gcode.rework.compare import DifferenceKind, ProgramDifference, ProgramDifferences, ProgramSpan
from ...framework.figures import counted
from .motion_shapes import Ints, ViewSide
from .painting.motion_layer import MotionLayer
from .places_panel import ListedPlace, PlaceWeight
from .program_reader import ShownProgram


@dataclass(frozen=True, eq=False)
class ComparedProgram:
    """Another program held against the one that is shown.

    Attributes:
        other: the second program. differences: between the shown one (a) and the second (b).
        pictures: by side, what only the first does and what only the second does.
    """

    other: ShownProgram
    differences: ProgramDifferences
    pictures: dict[ViewSide, tuple[MotionLayer, MotionLayer]]


_APART = (DifferenceKind.PATH, DifferenceKind.RAPID, DifferenceKind.MISSING, DifferenceKind.EXTRA)


def drawn_apart(
    first: ShownProgram, second: ShownProgram, differences: ProgramDifferences, side: ViewSide
) -> tuple[MotionLayer, MotionLayer]:
    """Return pictures of what only the first program does, and of what only the second does: where paths differ, not
    their feeds.
    """
    items = [item for item in differences.items if item.kind in _APART]
    one, other = (_motions([getattr(item, name) for item in items]) for name in "ab")
    return MotionLayer(first.shapes, side, one), MotionLayer(second.shapes, side, other)


def _motions(spans: Sequence[ProgramSpan]) -> Ints:
    return np.unique(np.concatenate([np.zeros(0, np.int64), *(np.arange(span.first, span.stop) for span in spans)]))


def in_order(problems: Sequence[ProgramProblem]) -> tuple[ProgramProblem, ...]:
    """Return problems in the order of the text."""
    return tuple(sorted(problems, key=lambda problem: (problem.line, problem.column)))


class TitledPlaces(NamedTuple):
    """Rows of a list, and its title."""

    title: str
    places: list[ListedPlace]


def problem_places(problems: Sequence[ProgramProblem]) -> TitledPlaces:
    """Return the list of problems."""
    errors = sum(problem.severity is Severity.ERROR for problem in problems)
    warnings = len(problems) - errors
    words = [counted(errors, "error") if errors else "", counted(warnings, "warning") if warnings else ""]
    return TitledPlaces(", ".join(filter(None, words)), [_problem_place(problem) for problem in problems])


def _problem_place(problem: ProgramProblem) -> ListedPlace:
    at = f"{problem.line}:{problem.column}" if problem.column else f"{problem.line}"
    weight = PlaceWeight.ERROR if problem.severity is Severity.ERROR else PlaceWeight.WARNING
    return ListedPlace(f"{at}   {problem.word + ': ' if problem.word else ''}{problem.text}", problem.text, weight)


def difference_places(differences: ProgramDifferences) -> TitledPlaces:
    """Return the list of differences."""
    items = differences.items
    if not items:
        words = "No motion, feed, tool, length, work offset, spindle, coolant, path mode or dwell differs."
        return TitledPlaces("Both programs do the same.", [ListedPlace(words, "", PlaceWeight.REMARK)])
    motion = (
        "the same motion" if differences.same_motion else f"paths up to {differences.largest_distance:.3f} mm apart"
    )
    return TitledPlaces(f"{counted(len(items), 'difference')}, {motion}", [_difference_place(item) for item in items])


def _difference_place(item: ProgramDifference) -> ListedPlace:
    lines = f"{_lines(item.a)}  \u2194  {_lines(item.b)}"
    loud = PlaceWeight.REMARK if item.kind is DifferenceKind.SAME_PATH else PlaceWeight.WARNING
    return ListedPlace(f"{lines}   {item.kind.value}: {item.text}", item.text, loud)


def _lines(span: ProgramSpan) -> str:
    if span.stop == span.first:
        return f"after {span.first_line}"
    return f"{span.first_line}" if span.first_line == span.last_line else f"{span.first_line} to {span.last_line}"


def rows_of(span: ProgramSpan) -> tuple[int, int]:
    """Return first and last row (0-based) of a stretch."""
    first, last = sorted((max(span.first_line, 1) - 1, max(span.last_line, 1) - 1))
    return first, last


def differing_rows(spans: Sequence[ProgramSpan]) -> Ints:
    """Return the rows (0-based) of stretches, in order, each once; a stretch without motions has none."""
    rows = [np.arange(first, last + 1) for first, last in (rows_of(span) for span in spans if span.stop > span.first)]
    return np.unique(np.concatenate(rows)).astype(np.int64) if rows else np.zeros(0, np.int64)
