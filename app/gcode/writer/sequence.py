"""Whether a sequence of moves may be sent to a machine at all: no rapid into work, every tool begins at clearance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...model.job import Job
from ...model.moves import MoveKind, Moves, Purpose

Mask = NDArray[np.bool_]

SAME = 1e-9
"""Coordinates that differ by less are alike, mm."""


def check_sequence(moves: Moves, job: Job) -> None:
    """Refuse moves that no machine should make.

    Every tool begins with a rapid at safe Z; rapids go either along Z or level, never down below retract Z but between
    the pecks of a hole, and never level below it; cutting moves have a feed rate; arcs have a radius and are exactly a
    full turn or clearly less, as noise can make a full turn of an arc of no length.

    Raises:
        ParameterError: naming the first move that breaks a rule, where it ends, and the rule.
    """
    if not len(moves):
        raise ParameterError("The program has no moves, so there is nothing to write; enable an operation and compute.")
    _refuse(
        moves,
        (moves.operation < 0) | (moves.operation >= len(job.operations)),
        "belongs to an operation that the job does not have any more; compute again",
    )
    first = np.append(True, moves.tool[1:] != moves.tool[:-1])
    rapid = moves.kind == MoveKind.RAPID
    arc = moves.kind >= MoveKind.ARC_CW
    numbers = np.isfinite(moves.end).all(axis=1) & (np.isfinite(moves.centre).all(axis=1) | ~arc)
    _refuse(moves, ~numbers, "has a coordinate that is no number")
    _refuse(
        moves,
        first & ~(rapid & (np.abs(moves.end[:, 2] - job.travel_z) < SAME)),
        f"is the first of T{{tool}} and must be a rapid at safe Z {job.travel_z:g}",
    )
    _check_rapids(moves, rapid & ~first, job)
    _refuse(moves, ~rapid & ~(moves.feed > 0), "cuts without a feed rate")
    _check_arcs(moves, arc)


def _check_rapids(moves: Moves, rapid: Mask, job: Job) -> None:
    """Refuse rapids that could meet metal; `rapid` leaves the first of each tool out."""
    low = job.retract_z - SAME
    delta = moves.end - moves.start
    level, along_z = np.hypot(delta[:, 0], delta[:, 1]) > SAME, np.abs(delta[:, 2]) > SAME
    _refuse(moves, rapid & level & along_z, "is a rapid that changes XY and Z at once; move level first, then along Z")
    _refuse(moves, rapid & level & (moves.end[:, 2] < low), f"is a rapid in XY below retract Z {job.retract_z:g}")
    down = (delta[:, 2] < -SAME) & ~_into_the_hole(moves)
    _refuse(moves, rapid & down & (moves.end[:, 2] < low), f"is a rapid down below retract Z {job.retract_z:g}")


def _into_the_hole(moves: Moves) -> Mask:
    """Return which moves go down between two pecks: where the move before the last one drilled, no deeper than it
    did.
    """
    before, after = moves.end[:-2], moves.end[2:]
    same = np.hypot(*(before - after)[:, :2].T) < SAME
    drilled = (moves.purpose[:-2] == Purpose.DRILL) & (moves.kind[:-2] == MoveKind.LINE)
    return np.concatenate([np.zeros(min(2, len(moves)), bool), same & drilled & (after[:, 2] > before[:, 2] - SAME)])


def _check_arcs(moves: Moves, arc: Mask) -> None:
    """Refuse arcs that are no arcs."""
    radius = np.hypot(*(moves.end[:, :2] - moves.centre).T)
    gap = np.hypot(*(moves.end - moves.start)[:, :2].T)
    _refuse(moves, arc & ~(radius > 0), "is an arc without a radius")
    _refuse(
        moves,
        arc & (gap > 0) & (gap < SAME) & (np.abs(moves.sweeps()) > np.pi),
        "is an arc whose ends nearly meet, so it may be nothing or a full circle; make the ends exactly alike or leave "
        "it out",
    )


def _refuse(moves: Moves, wrong: Mask, sentence: str) -> None:
    """Raise for the first move that is marked."""
    if wrong.any():
        i = int(np.argmax(wrong))
        x, y, z = moves.end[i]
        raise ParameterError(f"Move {i + 1} to X {x:g} Y {y:g} Z {z:g} {sentence.format(tool=moves.tool[i])}.")
