"""Metal that a program cuts while the spindle stands."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..gcode.interpreter.program import NcProgram
from ..model.motion import MotionKind
from ..simulation.sweeps.trim import CutResult

LEAST_MM3 = 1e-3
"""What a motion takes at least to count: less is what the rounding of heights leaves."""


class StandingCut(NamedTuple):
    """Motions that cut while the spindle stands: the first one's row, how many there are, and whether the program
    starts the spindle anywhere.
    """

    row: int
    motions: int
    starts: bool


def fed_standing(program: NcProgram) -> NDArray[np.bool_]:
    """Return which motions of a program are fed while the spindle stands, (n,); those of a probe are meant to be."""
    motions = program.motions
    stands = np.array([state.spindle == 0 for state in program.states], np.bool_)[motions.state]
    probes = np.isin(motions.line, list(program.probe_lines))
    return np.asarray(stands & (motions.kind != MotionKind.RAPID) & ~probes)


def standing_cut(program: NcProgram, cut: CutResult) -> StandingCut | None:
    """Return what a program cuts while the spindle stands; None where that is nothing, or was not traced."""
    rows = np.flatnonzero(fed_standing(program))
    if not len(rows) or len(cut.volume) != len(program.motions):
        return None
    rows = rows[cut.volume[rows] > LEAST_MM3]
    if not len(rows):
        return None
    starts = any(state.spindle for state in program.states)
    return StandingCut(int(rows[0]), len(rows), starts)
