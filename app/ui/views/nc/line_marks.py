"""What the text view shows of each line beside its words: what it moves, what is wrong with it, where it differs. No
Qt.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....gcode.interpreter.program import ProgramProblem
from ....model.motion import MotionKind
from .motion_shapes import MotionLineStyle, MotionShapes, contour_inks, tool_inks

Ints = NDArray[np.int64]

NOTHING, RAPID, PLUNGE, CUT = 0, 1, 2, 3
"""What a line moves: nothing, a rapid, straight down; CUT + k = cuts in the k-th colour of the tools (by kind: CUT +
MotionKind).
"""


@dataclass(frozen=True, eq=False)
class LineMarks:
    """The looks of n lines.

    Attributes:
        by_tool, by_motion: (n,) uint8, as above.
        problems: by row, 0-based.
        differing: (k,) rows that another program has not alike, in order.
    """

    by_tool: NDArray[np.uint8]
    by_motion: NDArray[np.uint8]
    problems: dict[int, list[ProgramProblem]] = field(default_factory=dict)
    differing: Ints = field(default_factory=lambda: np.zeros(0, np.int64))


def line_marks(
    count: int,
    shapes: MotionShapes | None = None,
    problems: Sequence[ProgramProblem] = (),
    files: Sequence[MotionShapes] = (),
) -> LineMarks:
    """Return the looks of the lines of a text.

    Args:
        count: lines of the text.
        shapes: what they move; None = not known yet.
        problems: what is wrong with them.
        files: what all texts of the program move, in the order of cutting; a tool has one colour in all of them.
            Empty: it is this text alone.
    """
    by_tool, by_motion = np.zeros(count, np.uint8), np.zeros(count, np.uint8)
    if shapes is not None and len(shapes):
        rows = np.clip(shapes.lines - 1, 0, count - 1)
        by_tool[rows], by_motion[rows] = (codes[shapes.by_line] for codes in _codes(shapes, files or (shapes,)))
    by_row: dict[int, list[ProgramProblem]] = {}
    for problem in problems:
        by_row.setdefault(problem.line - 1, []).append(problem)
    return LineMarks(by_tool, by_motion, by_row)


def _codes(shapes: MotionShapes, files: Sequence[MotionShapes]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    tools, at = np.unique(shapes.tool, return_inverse=True)
    of_tool, of_contour = (
        np.array([CUT + min(inks.get(int(tool), 0), 200) for tool in tools])[at]
        for inks in (tool_inks(*files), contour_inks(*files))
    )
    of_tool = np.where(shapes.look == MotionLineStyle.CONTOUR, of_contour, of_tool)
    plain = np.where(shapes.look == MotionLineStyle.RAPID, RAPID, PLUNGE)
    cuts = (shapes.look == MotionLineStyle.CUT) | (shapes.look == MotionLineStyle.CONTOUR)
    kinds = shapes.program.motions.kind.astype(np.int64)
    return np.where(cuts, of_tool, plain).astype(np.uint8), np.where(cuts, CUT + kinds, plain).astype(np.uint8)


def kind_of(code: int) -> MotionKind:
    """Return the kind of motion that a code of `by_motion` stands for."""
    return MotionKind(code - CUT)
