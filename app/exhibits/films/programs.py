"""The straight moves of an NC program that a film is made of: the longest stretch that may be written anew."""

from __future__ import annotations

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.effective_method import without_repeats
from ...gcode.interpreter.text import ProgramBuffer
from ...gcode.rework.stretches import find_stretches
from ...model.motion import Floats
from ...usecases.smoothing.source import AS_IT_LOOKS, SourceReading, read_source

MOST_POINTS = 400
"""A film shows so many points at most: those from the longest stretch's first one on."""


def points_of(name: str, data: bytes, reading: SourceReading = AS_IT_LOOKS, progress: Progress = NO_PROGRESS) -> Floats:
    """Return the points (n, 3), mm, of a program's longest stretch of straight feed moves, `MOST_POINTS` at most.

    Raises:
        InputError: it cannot be read, or has no four points in a row.
    """
    ready = read_source(name, data, reading, progress=progress.part(0.0, 0.7))
    found = find_stretches(ready.program, ProgramBuffer(ready.data), progress.part(0.7, 1.0)).stretches
    longest = max((without_repeats(each.points) for each in found), key=len, default=None)
    if longest is None or len(longest) < 4:
        raise InputError(
            f"{name} has no three straight feed moves one after the other, of which this film is made; take a program "
            "of short moves, such as the sample that the text is shown on."
        )
    return longest[:MOST_POINTS]
