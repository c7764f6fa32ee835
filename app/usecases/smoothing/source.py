"""The program that is smoothed, as its own control reads it and in the words of the control that it is written for.

A program is read as what it looks to be, or as somebody says; never as the control that it is to be written for, whose
words may mean something else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.dialect_guess import guess_dialect
from ...gcode.interpreter.options import PATIENT, ReadOptions
from ...gcode.interpreter.program import NcProgram
from ...gcode.interpreter.reader import read_program
from ...gcode.posts import Post, load_post
from ...gcode.rework.stretches import FeedStretch
from ...gcode.translate.program import translated
from ...model.motion import Floats, MotionKind
from ...model.part import Units
from ..kind_of_file import ensure_program

_POSTS = {
    Dialect.LINUXCNC: "linuxcnc",
    Dialect.FANUC: "fanuc",
    Dialect.HAAS: "haas",
    Dialect.GRBL: "grbl",
    Dialect.MACH3: "mach3",
}


@dataclass(frozen=True, slots=True)
class SourceReading:
    """How a program is read.

    Attributes:
        dialect: of which control it is; None = as it looks.
        units: of a program that names none; None = mm.
    """

    dialect: Dialect | None = None
    units: Units | None = None


AS_IT_LOOKS = SourceReading()
"""By the looks of its text, in mm unless it says inch."""


@dataclass(frozen=True, eq=False)
class SourceProgram:
    """A program in the words that it is to be written in, before it is smoothed.

    Attributes:
        dialect: of its own control. source: as that reads it.
        post: whose words the text has. data: the text. program: as the post's control reads it.
        off: how far that may be from the source, mm.
        rows: of each motion the one of the source that it is, -1 where it is a part of one.
    """

    dialect: Dialect
    source: NcProgram
    post: Post
    data: bytes
    program: NcProgram
    off: float
    rows: NDArray[np.int64]

    def points(self, stretch: FeedStretch) -> Floats | None:
        """Return the places of a stretch as the source has them, those among them that are one place in the digits of
        the new text; None where the source has something else than straight moves of one feed from its first to its
        last.
        """
        first, last = self.rows[[stretch.first, stretch.stop - 1]].tolist()
        motions = self.source.motions
        span = slice(first, last + 1)
        straight = motions.kind[span] == MotionKind.LINE
        if min(first, last) < 0 or first > last or not straight.all() or np.ptp(motions.feed[span]) != 0:
            return None
        return np.vstack([motions.start[first : first + 1], motions.end[span]])

    def lines(self, stretch: FeedStretch) -> tuple[int, int]:
        """Return first and last line of a stretch in the text that came in; in the new text where it is not there one
        by one.
        """
        rows = self.rows[[stretch.first, stretch.stop - 1]]
        if np.any(rows < 0):
            return stretch.first_line, stretch.last_line
        first, last = self.source.motions.line[rows].tolist()
        return first, last


def usual_post(dialect: Dialect) -> str:
    """Return the name of the post of a control's own language."""
    return _POSTS.get(dialect, "linuxcnc")


def read_source(
    name: str,
    data: bytes,
    reading: SourceReading = AS_IT_LOOKS,
    target: Post | None = None,
    progress: Progress = NO_PROGRESS,
) -> SourceProgram:
    """Return a program in the words that it is to be written in.

    Args:
        name: of the file, for messages. data: its bytes.
        reading: how.
        target: in whose words it is to be written; None = that control's.

    Raises:
        InputError: it is no program, cannot be read to its end, or holds what the other control cannot be told.
    """
    ensure_program(name)
    dialect = reading.dialect or guess_dialect(data)
    post = target or load_post(usual_post(dialect))
    read = ReadOptions(dialect, limits=PATIENT, units=reading.units)
    source = read_program(data, read, progress.part(0.0, 0.3))
    if source.error is not None:
        raise InputError(f"{source.error.message(name)} Mend it there; check tells more.")
    if post.dialect is dialect:
        return SourceProgram(dialect, source, post, data, source, 0.0, np.arange(len(source.motions)))
    made = translated(name, data, read, post, progress.part(0.3, 1.0))
    return SourceProgram(dialect, source, post, made.data, made.program, made.off, made.rows)
