"""Where the tool is to wait in holes, and where the spindle is to turn back: from the moves and the job alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.job import Job
from ...model.moves import MoveKind, Moves, Purpose
from ..interpreter.program import Event, EventKind, ProgramProblem
from .lines import MotionOwners

Mask = NDArray[np.bool_]

_SAME = 1e-6
_SECOND = 1e-3
"""s by which a wait may be longer or shorter."""


def backing_out(moves: Moves, job: Job) -> Mask:
    """Return (n,) which moves lead a tap out of its hole, so that the spindle must turn the other way."""
    taps = [k for k, each in enumerate(job.operations) if each.TAPS]
    up = moves.end[:, 2] > moves.start[:, 2] + _SAME
    back: Mask = np.isin(moves.operation, taps) & (moves.kind == MoveKind.LINE) & up
    return back


def _bottoms(moves: Moves, job: Job) -> dict[int, float]:
    """Return how long the tool waits behind moves that end at the bottoms of holes, s, by their index."""
    seconds = {k: each.dwell_s for k, each in enumerate(job.operations) if each.dwell_s > 0}
    drilling = (moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)
    lines = np.flatnonzero(drilling & np.isin(moves.operation, list(seconds)))
    if not len(lines):
        return {}
    place, height = moves.end[lines, :2], moves.end[lines, 2]
    elsewhere = np.hypot(*np.diff(place, axis=0).T) > _SAME
    hole = np.cumsum(np.append(True, elsewhere | (np.diff(moves.operation[lines]) != 0)))
    lowest = [lines[hole == k][np.argmin(height[hole == k])] for k in np.unique(hole)]
    return {int(k): seconds[int(moves.operation[k])] for k in lowest}


class HolePauses:
    """The waits that the holes of a program are to have, ticked off as they are met."""

    def __init__(self, moves: Moves, job: Job, owned: MotionOwners) -> None:
        """Find them."""
        self._missing = _bottoms(moves, job)
        self._behind = {int(owned.last[k]) + 1: k for k in self._missing}
        tapped = np.flatnonzero(backing_out(moves, job)) - 1
        self._turning = {int(owned.last[k]) + 1 for k in tapped.tolist()}

    def takes(self, event: Event) -> bool:
        """Tell whether an event is such a wait; a tapping cycle stands still for no time before it turns back."""
        if event.kind is not EventKind.DWELL:
            return False
        if event.before in self._turning and event.value <= _SECOND:
            return True
        move = self._behind.get(event.before)
        if move is None or abs(self._missing.get(move, -1.0) - event.value) > _SECOND:
            return False
        del self._missing[move]
        return True

    def missing(self, lines: Sequence[int] | NDArray[np.int32]) -> Iterator[ProgramProblem]:
        """Yield a wait that has not been met."""
        for move, seconds in self._missing.items():
            text = f"the tool does not wait for {seconds:g} s at the bottom of the hole, as it should."
            yield ProgramProblem(int(lines[move]), 0, "", text)
            return
