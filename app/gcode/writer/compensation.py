"""Where the control offsets the path, by the wear of the tool or by its radius: G41 or G42 before the straight way to a
wall, G40 before that away from it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.errors import ParameterError
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Purpose
from ...model.operation import Direction
from ..posts.post import Post
from .programmed_contour import CompensatedStretch

_ALONG = (Purpose.CONTOUR, Purpose.TAB)

_LEVEL = 1e-9
"""mm; heights and places that differ by less are one."""


def compensated_stretches(moves: Moves, job: Job) -> tuple[CompensatedStretch, ...]:
    """Return where the control offsets a program's path.

    A path along a wall that has no straight lead at both its ends, or one that is no longer than what may stand in the
    register, is left as it is.
    """
    by_index = [each.wear for each in job.operations]
    if not any(by_index) or not len(moves):
        return ()
    wear = np.array(by_index)[np.maximum(moves.operation, 0)]
    radius = np.array([each.offset_by_control for each in job.operations])[np.maximum(moves.operation, 0)]
    scan, found, i = _Scan(moves, radius), [], 0
    for first in np.flatnonzero((wear > 0) & (moves.purpose == Purpose.LEAD)).tolist():
        if first < i:
            continue
        held = wear[first] + (job.tool(int(moves.tool[first])).radius if radius[first] else 0.0)
        stop = scan.stretch(first) if scan.length(first) > held else 0
        if stop:
            found.append(CompensatedStretch(first, stop))
            i = stop + 1
    return tuple(found)


def compensation_blocks(moves: Moves, job: Job, post: Post, stretches: Sequence[CompensatedStretch]) -> dict[int, str]:
    """Return the blocks that begin and end compensation, by the index of the move that follows.

    The spindle turns clockwise, so climb milling has the tool at the left.

    Raises:
        ParameterError: an operation asks for it, and the control has none, or one register would hold two things.
    """
    if not any(each.wear and np.any(moves.operation == k) for k, each in enumerate(job.operations)):
        return {}
    words = post.compensation
    if not (words.left and words.right and words.off):
        raise ParameterError(
            f"{post.title} cannot offset a path by the wear or the radius of a tool (G41, G42); set "
            'compensation = "computer", or '
            "choose another post."
        )
    _check_registers(job)
    found: dict[int, str] = {}
    for each in stretches:
        operation = job.operations[int(moves.operation[each.first])]
        side = words.left if operation.cut.direction is Direction.CLIMB else words.right
        found[each.first] = side.format(tool=int(moves.tool[each.first]))
        found[each.stop] = words.off
    return found


def _check_registers(job: Job) -> None:
    """Refuse a register that would have to hold the wear and the radius of a tool."""
    own = [each for each in job.operations if each.wear and each.cut.enabled]
    both = {each.cut.tool for each in own if each.offset_by_control} & {
        each.cut.tool for each in own if not each.offset_by_control
    }
    if both:
        raise ParameterError(
            f'T{min(both)} has contours with compensation = "wear" and with "control": one register D{min(both)} '
            "cannot hold its wear and its radius; choose one of them for all of its contours."
        )


class _Scan:
    """Looks for ways to a wall, along it and away from it."""

    def __init__(self, moves: Moves, radius: np.ndarray) -> None:
        """Look at moves; `radius`: (n,) whether the control offsets each by the tool's whole radius."""
        self._kind, self._purpose, self._radius = moves.kind.tolist(), moves.purpose.tolist(), radius.tolist()
        self._operation, self._end = moves.operation.tolist(), moves.end

    def length(self, i: int) -> float:
        """Return how long a way is in the plane, mm: its side along which the control comes to the wall."""
        return float(np.hypot(*(self._end[i, :2] - self._end[i - 1, :2]))) if i else 0.0

    def _is_lead(self, i: int) -> bool:
        return (
            0 < i < len(self._kind)
            and self._purpose[i] == Purpose.LEAD
            and bool(abs(self._end[i, 2] - self._end[i - 1, 2]) <= _LEVEL)
        )

    def _is_straight_lead(self, i: int) -> bool:
        return self._is_lead(i) and self._kind[i] == MoveKind.LINE

    def _is_upright(self, i: int) -> bool:
        return self._kind[i] == MoveKind.LINE and bool(
            np.all(np.abs(self._end[i, :2] - self._end[i - 1, :2]) <= _LEVEL)
        )

    def stretch(self, first: int) -> int:
        """Return the index of the way away from the wall that the way to it, move `first`, belongs to; 0 = it is none,
        or there is none.
        """
        if not self._is_straight_lead(first):
            return 0
        i, along, own = first + 1, False, self._operation[first]
        if self._radius[first]:
            if not self._is_lead(i) or self._kind[i] == MoveKind.LINE:
                return 0
            i += 1
        else:
            while i < len(self._kind) and self._is_straight_lead(i):  # where the feed changes on the way
                i += 1
        while i < len(self._kind) and self._operation[i] == own:
            if self._purpose[i] in _ALONG:
                along = True
            elif not (along and self._is_upright(i)):
                break
            i += 1
        if along and self._radius[first] and self._is_lead(i):
            i += 1
        return i if along and self._is_straight_lead(i) and self._operation[i] == own else 0
