"""What is in force at a line of a program, and how the tool's place there is known.

It is learnt by reading the program up to there, twice: the second time as if the tool had begun somewhere else, and the
machine's zero and its reference points lay elsewhere. What differs between the two depends on what nobody knows; by how
much it differs tells on what.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from ...core.errors import InputError
from ...core.progress import Progress
from ..interpreter.control import Control
from ..interpreter.dialect import Dialect
from ..interpreter.expression import Key
from ..interpreter.offsets import ZERO, Place, added, taken
from ..interpreter.options import ReadOptions
from ..interpreter.program import FeedMode
from ..interpreter.text import ProgramBuffer

if TYPE_CHECKING:
    from ..interpreter.run import InterpreterRun

SAME = 1e-5
"""mm; positions that differ by less are the same: they are written with 6 decimals."""

ELSEWHERE: Place = (137.31, 251.73, 173.91)
OTHER_ZERO: Place = (1013.7, 2027.9, 3041.3)
OTHER_HOMES: dict[str, Place] = {"G28": (411.9, 523.7, 631.1), "G30": (709.3, 811.1, 907.7)}
CYCLE = re.compile(r"g(?:73|74|8[1-9])(?![0-9.])")
OWN_MOTION = re.compile(r"g(?:0?[0-3]|80|73|74|8[1-9])(?![0-9.])")


class AxisKnowledge(Enum):
    """How it is known where an axis stands at a line."""

    WORK = "program coordinates"
    MACHINE = "machine coordinates"
    HOME = "G28"
    SECOND_HOME = "G30"
    FREE = "the program has moved nothing yet"


@dataclass(frozen=True)
class ControlState:
    """A control at a line.

    Attributes:
        control: what is in force.
        axes: how X, Y and Z are known.
        motions: how many are done by then.
        common: the offset of all work offsets where the program set it, mm.
        parameters: what the text behind may ask for.
    """

    control: Control
    axes: tuple[AxisKnowledge, AxisKnowledge, AxisKnowledge]
    motions: int
    common: Place = ZERO
    parameters: tuple[tuple[Key, float], ...] = ()

    @property
    def per_minute(self) -> bool:
        """Whether F counts mm or inch a minute."""
        return self.control.modal.feed_mode is FeedMode.PER_MINUTE


def control_state_at(data: bytes, line: int, options: ReadOptions, progress: Progress) -> ControlState:
    """Return what is in force at a line, and how the tool's place there is known.

    Args:
        data: the program's bytes.
        line: 1-based, one that there is.
        options: of the control.
        progress: told of how much is read.

    Raises:
        InputError: nothing can begin there; the text says why.
        Cancelled: the job was asked to stop.
    """
    from ..interpreter.run import InterpreterRun  # compiled code: loaded where it is used

    control, motions = _read_to(data, line, InterpreterRun(data, options, progress.part(0.0, 0.5)))
    elsewhere = InterpreterRun(data, replace(options, start=added(options.start, ELSEWHERE)), progress.part(0.5, 1.0))
    elsewhere.control.offsets.common, elsewhere.control.homes = OTHER_ZERO, dict(OTHER_HOMES)
    elsewhere.control.offsets_changed()
    other = _read_to(data, line, elsewhere).control
    _check_zeros(control, other, line)
    axes = [_axis(control, other, axis) if motions else AxisKnowledge.FREE for axis in range(3)]
    if None in axes or (motions and axes[2] is AxisKnowledge.FREE):
        name = "XYZ"[axes.index(None) if None in axes else 2]
        raise InputError(
            f"Line {line}: where {name} is there depends on where the tool stood when the program began; "
            f"start at line 1, or behind the first block that says {name} in absolute coordinates (G90)."
        )
    known = (axes[0] or AxisKnowledge.FREE, axes[1] or AxisKnowledge.FREE, axes[2] or AxisKnowledge.FREE)
    _check_here(control, known, line)
    common = control.offsets.common if not _differ(control.offsets.common, other.offsets.common) else ZERO
    return ControlState(control, known, motions, common, control.parameters.values())


def _axis(control: Control, other: Control, axis: int) -> AxisKnowledge | None:
    """Return how an axis is known, None where that cannot be said in any way."""
    if abs(control.program_place[axis] - other.program_place[axis]) < SAME:
        return AxisKnowledge.WORK
    machine = [at.at[axis] + at.offsets.tool[axis] for at in (control, other)]
    for home, apart in (
        (AxisKnowledge.MACHINE, ZERO),
        *((AxisKnowledge(name), place) for name, place in OTHER_HOMES.items()),
    ):
        if abs(machine[1] - machine[0] - apart[axis]) < SAME:
            return home
    return (
        AxisKnowledge.FREE if max(control.known[axis], control.known[3 + axis]) < 0 and control.modal.absolute else None
    )


def _check_zeros(control: Control, other: Control, line: int) -> None:
    """Refuse zeros and parameters that depend on where the tool was at first."""
    offsets, others = control.offsets, other.offsets
    here = offsets.set_here_on and _differ(offsets.set_here, others.set_here)
    if here or any(_differ(place, others.work.get(name, ZERO)) for name, place in offsets.work.items()):
        raise InputError(
            f"Line {line} stands behind a zero that the program sets from where the tool was when it began (G92, G10 "
            "L20), and where that was it does not say; set the same zero by hand, and start at the line behind it."
        )
    if dict(control.parameters.values()) != dict(other.parameters.values()):
        raise InputError(
            f"Line {line} stands behind parameters (#) that the program takes from where the tool stood when it began; "
            "start before they are set."
        )


def _check_here(control: Control, axes: tuple[AxisKnowledge, AxisKnowledge, AxisKnowledge], line: int) -> None:
    """Refuse a G92 that cannot be set again: that is done at a place of the work that is known."""
    dialect, offsets = control.options.dialect, control.offsets
    if dialect is Dialect.LINUXCNC or not offsets.set_here_on or offsets.set_here == ZERO:
        return
    if dialect in (Dialect.FANUC, Dialect.HAAS) or set(axes) != {AxisKnowledge.WORK}:
        raise InputError(
            f"Line {line} stands behind G92, which a restart cannot set again on a {control.rules.title} control; "
            "start before it."
        )


def _differ(a: Place, b: Place) -> bool:
    return any(abs(value) > SAME for value in taken(a, b))


class _ControlAtLine(NamedTuple):
    """A control as it stands at a line, and how many motions it has done."""

    control: Control
    motions: int


def _read_to(data: bytes, line: int, run: InterpreterRun) -> _ControlAtLine:
    """Return the control as it stands when a reading comes to a line.

    Raises:
        InputError: it never does, or nothing can begin there.
    """
    run.stop_at(line)
    program, control = run.read(), run.control
    if program.error is not None:
        raise InputError(
            f"Line {line} stands behind an error, so what is in force there is not known: "
            f"{program.error.message('line')}"
        )
    if not run.stopped:
        raise InputError(
            f"The program never comes to line {line}: it ends before, at line {control.line}, or jumps over it."
        )
    if run.inside:
        raise InputError(
            f"Line {line} is done within a subroutine or a loop; start at the line that calls it, or where the loop "
            "begins."
        )
    _check_begin(control, data, line)
    return _ControlAtLine(control, len(program.motions))


def _check_begin(control: Control, data: bytes, line: int) -> None:
    """Refuse where a block alone does not say what it does."""
    if control.curve is not None:
        raise InputError(
            f"Line {line} is within a spline that an earlier line begins (G5.2, G6.2); start at that line, or behind "
            "the spline."
        )
    if control.cycle is not None and not OWN_MOTION.search(_lines(data)[line - 1]):
        raise InputError(
            f"Line {line} is within the run of a canned cycle; start at the line that begins it, "
            f"{_cycle_line(data, line)}."
        )
    if control.stray is not None or control.side:
        raise InputError(
            f"Line {line} is under cutter compensation or directly behind it; start before its G41 or G42, or behind "
            "the first move after G40."
        )
    if control.modal.constant_surface:
        raise InputError(
            f"Line {line} is under constant surface speed (G96), which a restart does not set; start before it."
        )
    offsets, table = control.offsets, control.options.tool_table
    row = table.get(control.modal.length_offset)
    if offsets.tool != (row.offset if row is not None and control.modal.length_offset else ZERO):
        raise InputError(
            f"Line {line} has a tool length that is not one of the tool table (G43.1, G43.2, G44 or G10); "
            "start before it is set."
        )
    if control.tool_table != dict(table):
        raise InputError(f"Line {line} stands behind a change of the tool table (G10); start before it.")


def _lines(data: bytes) -> list[str]:
    """Return what the control obeys of each line, in small letters, without comments and blanks."""
    return [
        re.sub(r"\([^)]*\)|;.*|\s", "", line) for line in ProgramBuffer(data).data.decode("latin-1").lower().split("\n")
    ]


def _cycle_line(data: bytes, line: int) -> int:
    """Return the line of the last cycle's word before a line."""
    return max((number for number, code in enumerate(_lines(data)[: line - 1], 1) if CYCLE.search(code)), default=1)
