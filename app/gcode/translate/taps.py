"""Tapped holes as another control leaves them: at feed to R alone, where LinuxCNC feeds up to the initial height."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...model.motion import MotionKind, Motions
from ..interpreter.block import BlockStep
from ..interpreter.program import NcProgram
from .translatable import TAPPING

_COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")


@dataclass(frozen=True, slots=True)
class TappedHole:
    """The motions of one tapped hole.

    Attributes:
        into, out: rows of the feeds into it and out of it.
        beyond: whether the one out of it goes on beyond R, up the way that the tool came down at rapid rate.
    """

    into: int
    out: int
    beyond: bool


def tapped_hole(motions: Motions, step: BlockStep) -> TappedHole | None:
    """Return the hole that a block taps; None where it is left in a way that no other control knows.

    Args:
        motions: of the program. step: a block under a tapping cycle that makes motions.
    """
    lines = [row for row in range(*step.rows) if motions.kind[row] == MotionKind.LINE]
    if len(lines) != 2:
        return None
    into, out = lines
    r, top = float(motions.start[into, 2]), float(motions.end[out, 2])
    if r == top:
        return TappedHole(into, out, beyond=False)
    came = into - 1
    down = (
        came >= step.rows[0]
        and motions.kind[came] == MotionKind.RAPID
        and bool(np.all(motions.start[came, :2] == motions.end[came, :2]))
    )
    return TappedHole(into, out, beyond=True) if down and r < top <= float(motions.start[came, 2]) else None


@dataclass(frozen=True, eq=False)
class LeftAtR:
    """A program whose tapped holes are all left at feed to R alone.

    Attributes:
        program: it.
        rows: (n,) of each of its motions the one of the first program that it is, -1 where it is a part of one.
        holes: how many holes are left in another way than in the first program.
    """

    program: NcProgram
    rows: NDArray[np.int64]
    holes: int


def left_at_r(program: NcProgram, steps: tuple[BlockStep, ...]) -> LeftAtR:
    """Return a program in which the way out of each tapped hole is fed to R, and rapid from there on.

    It is the way that the tool came down at rapid rate, so nothing is in it.

    Args:
        program, steps: as they were read together.
    """
    motions = program.motions
    tapping = [step for step in steps if step.motion in TAPPING and step.rows[1] > step.rows[0]]
    found = [hole for step in tapping if (hole := tapped_hole(motions, step)) is not None and hole.beyond]
    rows = np.arange(len(motions))
    if not found:
        return LeftAtR(program, rows, 0)
    into, out = np.array([hole.into for hole in found]), np.array([hole.out for hole in found])
    count = np.ones(len(motions), np.int64)
    count[out] = 2
    rows = np.repeat(rows, count)
    columns = {name: getattr(motions, name)[rows] for name in _COLUMNS}
    behind = np.concatenate([[0], np.cumsum(count)])
    fed = behind[out]
    columns["end"][fed, 2] = columns["start"][fed + 1, 2] = motions.start[into, 2]
    columns["kind"][fed + 1], columns["feed"][fed + 1] = MotionKind.RAPID, 0.0
    columns["state"][fed + 1] = motions.state[into]  # the spindle turns again as it did before the hole
    rows[fed] = rows[fed + 1] = -1
    at = behind.tolist()
    known = motions.known_from
    cut = Motions(
        **columns,
        splines={at[row]: spline for row, spline in motions.splines.items()},
        known_from=(_at(at, known[0]), _at(at, known[1]), _at(at, known[2])),
    )
    events = tuple(replace(event, before=at[event.before]) for event in program.events)
    homeward = tuple(at[row] for row in program.homeward)
    return LeftAtR(replace(program, motions=cut, events=events, homeward=homeward), rows, len(found))


def _at(behind: list[int], row: int) -> int:
    return row if row < 0 else behind[row]
