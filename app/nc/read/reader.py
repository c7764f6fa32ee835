"""Read an NC program: the one door of this room."""

from __future__ import annotations

from app.nc.read.options import ReadOptions
from app.nc.read.program import NcProgram
from app.progress import NO_PROGRESS, Progress

DEFAULT = ReadOptions()


def read_program(data: bytes, options: ReadOptions = DEFAULT, progress: Progress = NO_PROGRESS) -> NcProgram:
    """Return what a control does with a program.

    The text is never refused: an error ends the reading where it is found, is the last of the program's problems,
    and what was read up to there is given.

    Args:
        data: the file's bytes, UTF-8 or Latin-1, lines ended in any way.
        options: dialect, tool table, limits.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from app.nc.read.run import Run  # compiled code: loaded where it is used

    return Run(data, options, progress).read()
