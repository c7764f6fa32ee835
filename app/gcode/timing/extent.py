"""Does a program fit a machine: the box of its motions against the travel, its feeds and speeds against the ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.machine import LinearAxis, Machine
from ...model.motion import Floats, MotionKind, Motions
from ...model.motion_path import reach
from ..interpreter.program import NcProgram, ProgramProblem, Severity

ROUNDING = 1e-6
"""mm by which a motion may pass an end of the travel unreported."""


@dataclass(frozen=True, slots=True)
class Extent:
    """A box, mm; NaN along an axis that no motion moves."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @property
    def size(self) -> tuple[float, float, float]:
        """Length along X, Y and Z, mm."""
        return (self.high[0] - self.low[0], self.high[1] - self.low[1], self.high[2] - self.low[2])


NOWHERE = Extent((np.nan,) * 3, (np.nan,) * 3)
"""The box of no motion."""


def extent(program: NcProgram, chosen: NDArray[np.bool_] | None = None) -> Extent:
    """Return the box round a program's motions: arcs by what they reach, splines by their control points.

    Args:
        program: an axis counts from the first motion on that sets it, and not while it stands at a place of the machine
            (G28, G53): where these are, only the operator and the machine know.
        chosen: (n,) which motions count; None = all.
    """
    low, high = _known_reach(program)
    if chosen is not None:
        low, high = low[chosen], high[chosen]
    return Extent(
        _triple(np.fmin.reduce(low, axis=0, initial=np.inf)), _triple(np.fmax.reduce(high, axis=0, initial=-np.inf))
    )


def _triple(values: Floats) -> tuple[float, float, float]:
    x, y, z = np.where(np.isfinite(values), values, np.nan).tolist()
    return (x, y, z)


def _known_reach(program: NcProgram) -> tuple[Floats, Floats]:
    """Return what each motion reaches, (n, 3); NaN where it is not known."""
    motions = program.motions
    low, high = reach(motions)
    nowhere = nowhere_of(program)
    straight = (motions.kind == MotionKind.RAPID) | (motions.kind == MotionKind.LINE)
    from_nowhere = from_nowhere_of(program, nowhere) & straight[:, None]
    for side in (low, high):
        side[from_nowhere] = motions.end[from_nowhere]
        side[nowhere] = np.nan
    return low, high


def from_nowhere_of(program: NcProgram, nowhere: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return (n, 3) whether a motion starts, along an axis, where nobody knows.

    Args:
        nowhere: (n, 3) whether it ends so.
    """
    first = np.tile(np.array(program.motions.known_from) >= 0, (len(nowhere[:1]), 1))
    return np.concatenate([first, nowhere[:-1]])


def nowhere_of(program: NcProgram) -> NDArray[np.bool_]:
    """Return (n, 3) whether a motion ends, along an axis, where nobody knows: before the program sets it, or at the
    machine's home.
    """
    motions = program.motions
    nowhere = np.zeros((len(motions), 3), bool)
    for axis, row in enumerate(motions.known_from):
        nowhere[: max(row, 0), axis] = True
    for home in program.homeward:
        for axis in range(3):
            row, height = home, motions.end[home, axis]
            reported = home == motions.known_from[axis] or (home > 0 and nowhere[home - 1, axis])
            moved = reported or height != motions.start[home, axis]
            while moved and row < len(motions) and motions.end[row, axis] == height and not nowhere[row, axis]:
                nowhere[row, axis] = True
                row += 1
    return nowhere


def at_home(program: NcProgram) -> NDArray[np.bool_]:
    """Return (n, 3) whether a motion ends, along an axis that the program has set before, at a place of the machine.

    Args:
        program: as it was read, or with its motions anchored.
    """
    return nowhere_of(program) & (np.arange(len(program.motions))[:, None] >= program.motions.known_from)


def misfits(program: NcProgram, machine: Machine) -> tuple[ProgramProblem, ...]:
    """Return what of a program the machine cannot do, each with the first line that asks for it.

    The travel is held against the tool's tip: what the tool's length adds, only the control's tool table knows.

    Args:
        program: as it was read.
        machine: where its work origin is not known, only the size of the program's box is held against its travel.
    """
    return (*_beyond_travel(program, machine), *_too_fast(program.motions, machine), *_wrong_speeds(program, machine))


def _beyond_travel(program: NcProgram, machine: Machine) -> Iterator[ProgramProblem]:
    """Yield a problem for each axis whose travel the program leaves, or whose travel is less than the program's
    size.
    """
    low, high = _known_reach(program)
    for column, name in enumerate("XYZ"):
        if not np.any(np.isfinite(low[:, column])):
            continue
        reached = _AxisReach(name, low[:, column], high[:, column], program.motions.line)
        axis = machine.axes[column]
        yield from (
            reached.too_long(axis, machine)
            if machine.work_origin is None
            else reached.outside(axis, machine.work_origin[column], machine)
        )


@dataclass(frozen=True)
class _AxisReach:
    """What each motion reaches along one axis, mm, and its line."""

    name: str
    low: Floats
    high: Floats
    line: NDArray[np.int32]

    def too_long(self, axis: LinearAxis, machine: Machine) -> Iterator[ProgramProblem]:
        """Yield the problem that no place of the work origin could help."""
        low, high = float(np.nanmin(self.low)), float(np.nanmax(self.high))
        if high - low > axis.travel + ROUNDING:
            line = int(self.line[np.nanargmax(self.high) if -low < high else np.nanargmin(self.low)])
            yield _problem(
                line,
                self.name,
                f"the program spans {high - low:.3f} mm along {self.name} ({low:.3f} to {high:.3f}), "
                f"and {machine.title} travels {axis.travel:g} mm there.",
            )

    def outside(self, axis: LinearAxis, origin: float, machine: Machine) -> Iterator[ProgramProblem]:
        """Yield the problem at each end of the travel."""
        for values, end, sign in ((self.low, axis.low, -1), (self.high, axis.high, 1)):
            beyond = sign * (values + origin - end)
            rows = np.flatnonzero(beyond > ROUNDING)
            if len(rows):
                worst = rows[np.argmax(beyond[rows])]
                yield _problem(
                    int(self.line[rows[0]]),
                    self.name,
                    f"the program goes to {self.name}{values[worst]:.3f}, {beyond[worst]:.3f} mm beyond the travel of "
                    f"{machine.title}, which ends at {end - origin:g} from the work origin; move the work or the "
                    "origin.",
                )


def _too_fast(motions: Motions, machine: Machine) -> Iterator[ProgramProblem]:
    """Yield the problem of feeds above the machine's largest."""
    over = np.flatnonzero((motions.kind != MotionKind.RAPID) & (motions.feed > machine.largest_feed * (1 + 1e-9)))
    if len(over):
        largest = float(np.max(motions.feed[over]))
        yield _problem(
            int(motions.line[over[0]]),
            "F",
            f"feed is up to {largest:g} mm/min in {len(over)} motions, and {machine.title} "
            f"feeds at {machine.largest_feed:g} at most; it will go slower than the program says.",
        )


def _wrong_speeds(program: NcProgram, machine: Machine) -> Iterator[ProgramProblem]:
    """Yield a problem for each spindle speed out of the range, at the first motion that turns at it."""
    reported: set[float] = set()
    states, first = np.unique(program.motions.state, return_index=True)
    for state_row, row in sorted(zip(states.tolist(), first.tolist(), strict=True), key=lambda pair: pair[1]):
        state = program.states[state_row]
        fits = machine.spindle.low <= state.speed <= machine.spindle.high
        if state.spindle == 0 or state.constant_surface or fits or state.speed in reported:
            continue
        reported.add(state.speed)
        yield _problem(
            int(program.motions.line[row]),
            "S",
            f"the spindle is to turn at {state.speed:g} rpm, and that of {machine.title} turns at "
            f"{machine.spindle.low:g} to {machine.spindle.high:g}.",
        )


def _problem(line: int, word: str, text: str) -> ProgramProblem:
    return ProgramProblem(line, 0, word, text, Severity.WARNING)
