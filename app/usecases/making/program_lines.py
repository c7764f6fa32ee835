"""From a line of the NC files of a job to the operation that it belongs to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .make import MakeResult


def operation_of_line(made: MakeResult, file: int, line: int) -> int | None:
    """Return the index of the operation of a line; None where the line moves nothing.

    Args:
        made: the job's program. file: which of its files, from 0. line: 1-based, of that file.
    """
    if not 0 <= file < len(made.files) or line <= 0:
        return None
    moves, first = made.program.moves, made.files[file].first
    stop = made.files[file + 1].first if file + 1 < len(made.files) else len(moves)
    rows = np.flatnonzero(moves.line[first:stop] == line)
    return int(moves.operation[first + rows[0]]) if len(rows) else None
