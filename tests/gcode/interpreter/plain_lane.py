"""The fast lane's kernel for plain lines, called alone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.gcode.interpreter.fast_lane import LONGEST
from app.gcode.interpreter.plain_kernels import run_plain
from app.gcode.interpreter.program import MotionColumns

_PORTION = 8192


@dataclass(slots=True)
class LaneState:
    """What is in force for plain blocks; the lane changes position, motion, feed and known.

    Feeds are per minute and nothing is rotated whenever the lane is called.

    Attributes:
        position: (3,) mm, coordinates of `Motions`.
        motion: 0 to 3, the `MotionKind` of blocks without a G word; -1 = none, or one that is not the lane's. A plain
            block that names its motion makes that the one in force.
        feed: mm/min, NaN = not known.
        scale: mm per unit. bare_scale: mm per unit of lengths that are written without a decimal point.
        absolute: G90. arc_absolute: G90.1. plane: `Plane`.
        shift: (3,) mm, added to absolute coordinates.
        state: index of the modal state.
        semicolon_comments: a semicolon begins a comment.
        known: (6,) first row whose absolute word commands each axis; then first row whose incremental word moves it
            before that; -1 = none yet.
    """

    position: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    motion: int = -1
    feed: float = float("nan")
    scale: float = 1.0
    bare_scale: float = 1.0
    absolute: bool = True
    arc_absolute: bool = False
    plane: int = 0
    shift: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    state: int = 0
    semicolon_comments: bool = True
    known: NDArray[np.int64] = field(default_factory=lambda: np.full(6, -1))


def plain_blocks(
    data: NDArray[np.uint8], at: tuple[int, int], plain: LaneState, columns: MotionColumns, most_lines: int
) -> tuple[int, int]:
    """Do the plain lines that begin at a place of the text; return the place of the first line that is not done.

    A line is done whole or not at all. An absolute coordinate is number * scale + shift, an incremental one
    position + number * scale, in that order, so that the core can give the same bits.

    Args:
        data: the text as bytes, lines ended by newlines.
        at: offset of the line's first byte, and its 1-based number; so is what is returned. At the end the offset is
            the length of the text.
        columns: where the motions go.
        most_lines: how many lines to do at most.
    """
    offset, line = at
    while most_lines > 0 and offset < len(data):
        portion = min(most_lines, _PORTION)
        columns.reserve(portion)
        modes = (
            offset,
            line,
            columns.count,
            plain.motion,
            portion,
            plain.plane,
            plain.state,
            plain.absolute,
            plain.arc_absolute,
            plain.semicolon_comments,
            LONGEST,
        )
        places = plain.position, plain.shift, plain.known
        first = line
        offset, line, columns.count, plain.motion, plain.feed = run_plain(
            data, (plain.scale, plain.bare_scale, plain.feed), tuple(map(int, modes)), places, columns.arrays()
        )
        most_lines -= line - first
        if line - first < portion:
            break
    return offset, line
