"""A text read again on a machine that was left as another job left it: other zeros, other homes, other modes in force.

A control that is switched on stands where nothing is wrong by chance: at its zero, in millimetres, at G90. What a
program does not say itself comes out right there, and shows here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ...core.progress import Progress
from ...model.motion import Plane
from ...model.part import Units
from ..interpreter.compensation import Compensation
from ..interpreter.control import Control
from ..interpreter.dialect import Dialect
from ..interpreter.offsets import OFFSETS, ZERO, Place, taken
from ..interpreter.options import ReadOptions
from ..interpreter.program import FeedMode, NcProgram

CUTTER_RADIUS = 7.5
"""mm, of the G41 that was left on."""


@dataclass(frozen=True)
class StartState:
    """How a machine stands when a program begins.

    Attributes:
        zero: of the work, mm, machine coordinates. start: of the tool's tip from there.
        homes: of G28 and G30, mm, machine coordinates.
        units: in force; a fresh control has mm.
    """

    zero: Place = ZERO
    start: Place = ZERO
    homes: Mapping[str, Place] = field(default_factory=lambda: {"G28": ZERO, "G30": ZERO})
    units: Units = Units.MM


FRESH = StartState()


def foreign_start(written_in: Units) -> StartState:
    """Return another place, above the work as a machine stands, with the units in force that the program is not written
    in.
    """
    return StartState(
        (-421.5, -263.25, -387.125),
        (137.25, 91.5, 63.75),
        {"G28": (-11.5, -23.25, -3.5), "G30": (-211.5, -131.25, -7.25)},
        Units.MM if written_in is Units.INCH else Units.INCH,
    )


def read_from_start(data: bytes, options: ReadOptions, start_state: StartState, progress: Progress) -> NcProgram:
    """Return what a control does with a program that finds the machine so; coordinates are from the work's zero.

    Args:
        data: the file's bytes.
        options: of the control; the length of one of its tools is in force at first.
        start_state: where everything is.
        progress: told of how much is read.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from ..interpreter.run import InterpreterRun  # compiled code: loaded where it is used

    run = InterpreterRun(
        data, replace(options, start=tuple(np.add(start_state.start, start_state.zero).tolist())), progress
    )
    _leave_behind(run.control, options, start_state)
    return _from_zero(run.read(), start_state.zero)


def _leave_behind(control: Control, options: ReadOptions, start_state: StartState) -> None:
    """Put everything in force that another job may have left so and this one should say."""
    control.homes = dict(start_state.homes)
    offsets = control.offsets
    offsets.common, offsets.name = start_state.zero, "G55"
    offsets.work = {name: (10.5 * rank, 20.25 * rank, 5.125 * rank) for rank, name in enumerate(OFFSETS[1:], start=1)}
    control.selected, control.motion = max(options.tool_table, default=0) + 1, "G1"
    control.change(
        units=start_state.units,
        plane=Plane.ZX,
        absolute=False,
        arc_absolute=options.dialect in WITH_ARC_DISTANCE,
        feed_mode=FeedMode.INVERSE_TIME,
        tool=control.selected,
        speed=777.0,
        spindle=-1,
        length_offset=control.selected - 1,
    )
    if options.dialect is not Dialect.GRBL:
        control.compensation = Compensation(CUTTER_RADIUS, Plane.ZX, control.at)
    control.offsets_changed()


WITH_ARC_DISTANCE = frozenset({Dialect.LINUXCNC, Dialect.GRBL, Dialect.MACH3})
"""They know G90.1; the others' I and J always count from the start of the arc."""


def _from_zero(program: NcProgram, zero: Place) -> NcProgram:
    """Return a program with the work's zero at 0."""
    motions = program.motions
    shift = np.array(zero)
    moved = replace(motions, start=motions.start - shift, end=motions.end - shift, centre=motions.centre - shift)
    return replace(
        program, motions=moved, states=tuple(replace(state, shift=taken(state.shift, zero)) for state in program.states)
    )
