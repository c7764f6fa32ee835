"""Read an NC program: the door of this room, as a whole or block by block."""

from __future__ import annotations

from typing import NamedTuple

from ...core.memory import MemoryRemedy, ask, fewer
from ...core.progress import NO_PROGRESS, Progress
from .block import BlockStep
from .options import ReadOptions
from .program import NcProgram

DEFAULT = ReadOptions()


class SteppedProgram(NamedTuple):
    """What a control does with a program, and every block that it did, in the order of doing."""

    program: NcProgram
    steps: tuple[BlockStep, ...]


def read_steps(data: bytes, options: ReadOptions, progress: Progress = NO_PROGRESS) -> SteppedProgram:
    """Return what a control does with a program, and every block that it did, in the order of doing.

    Several times slower than `read_program`, which does plain lines at once.

    Args, errors: as `read_program`.
    """
    from .run import InterpreterRun  # compiled code: loaded where it is used

    steps: list[BlockStep] = []
    program = InterpreterRun(data, options, progress, steps.append).read()
    return SteppedProgram(program, tuple(steps))


LINE_BYTES = 400
"""What a line takes at a time, with the motion that it makes."""


def read_program(data: bytes, options: ReadOptions = DEFAULT, progress: Progress = NO_PROGRESS) -> NcProgram:
    """Return what a control does with a program.

    The text is never refused: an error ends the reading where it is found, is the last of the program's problems,
    and what was read up to there is given.

    Args:
        data: the file's bytes, UTF-8 or Latin-1, lines ended in any way.
        options: dialect, tool table, limits.

    Raises:
        MemoryShortError: it has more lines than there is memory for. Cancelled: the job was asked to stop.
    """
    from .run import InterpreterRun  # compiled code: loaded where it is used

    lines = data.count(b"\n") + 1
    ask(
        LINE_BYTES * lines,
        f"A program of {lines:,} lines",
        MemoryRemedy(f"cut it in parts of at most {fewer(lines, LINE_BYTES * lines)} lines"),
    )
    return InterpreterRun(data, options, progress).read()
