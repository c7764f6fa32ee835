"""Where the control offsets the path by the wear of the tool: G41 or G42 before the straight way to a wall, G40 before
that away from it.
"""

from __future__ import annotations

import numpy as np

from ...core.errors import ParameterError
from ...model.job import Job
from ...model.moves import MoveKind, Purpose
from ...model.operation import Direction
from ..posts.post import Post
from .work_moves import WorkMoves

_ALONG = (Purpose.CONTOUR, Purpose.TAB)


def compensation_blocks(moves: WorkMoves, job: Job, post: Post) -> dict[int, str]:
    """Return the blocks that begin and end compensation, by the index of the move that follows.

    A path along a wall that has no straight lead at both its ends, or a shorter one than the wear may be, is left as it
    is. The spindle turns clockwise, so climb milling has the tool at the left.

    Raises:
        ParameterError: an operation asks for the wear word, and the control has none.
    """
    worn = np.array([each.wear for each in job.operations])
    wanted = np.flatnonzero(worn[np.maximum(moves.operation, 0)] > 0) if len(worn) else np.zeros(0, np.int64)
    if not len(wanted):
        return {}
    words = post.compensation
    if not (words.left and words.right and words.off):
        raise ParameterError(
            f'{post.title} cannot offset a path by the wear of a tool (G41, G42); set compensation = "computer", or '
            "choose another post."
        )
    found: dict[int, str] = {}
    scan = _Scan(moves, 10.0 ** -post.digits(job.out_units).X * job.out_units.value)
    i = int(wanted[0])
    while i < len(moves):
        k = int(moves.operation[i])
        stop = scan.stretch(i) if worn[k] > 0 and scan.length(i) > worn[k] else 0
        if not stop:
            i += 1
            continue
        operation = job.operations[k]
        side = words.left if operation.cut.direction is Direction.CLIMB else words.right
        found[i] = side.format(tool=int(moves.tool[i]))
        found[stop] = words.off
        i = stop + 1
    return found


class _Scan:
    """Looks for ways to a wall, along it and away from it."""

    def __init__(self, moves: WorkMoves, step: float) -> None:
        """Look at moves; `step`: mm of a count of the last decimal."""
        self._kind, self._purpose = moves.kind.tolist(), moves.purpose.tolist()
        self._operation, self._end, self._step = moves.operation.tolist(), moves.end, step

    def length(self, i: int) -> float:
        """Return how long a move is in the plane, mm."""
        return float(np.hypot(*(self._end[i, :2] - self._end[i - 1, :2]))) * self._step if i else 0.0

    def _is_lead(self, i: int) -> bool:
        return (
            0 < i < len(self._kind)
            and self._purpose[i] == Purpose.LEAD
            and self._kind[i] == MoveKind.LINE
            and self._end[i, 2] == self._end[i - 1, 2]
        )

    def _is_upright(self, i: int) -> bool:
        return self._kind[i] == MoveKind.LINE and bool(np.all(self._end[i, :2] == self._end[i - 1, :2]))

    def stretch(self, first: int) -> int:
        """Return the index of the way away from the wall that the way to it, move `first`, belongs to; 0 = it is none,
        or there is none.
        """
        if not self._is_lead(first):
            return 0
        i, along = first + 1, False
        while i < len(self._kind) and self._is_lead(i):  # where the feed changes on the way
            i += 1
        while i < len(self._kind) and self._operation[i] == self._operation[first]:
            if self._purpose[i] in _ALONG:
                along = True
            elif not (along and self._is_upright(i)):
                break
            i += 1
        return i if along and self._is_lead(i) and self._operation[i] == self._operation[first] else 0
