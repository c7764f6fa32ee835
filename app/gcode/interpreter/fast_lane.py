"""The reader's way into its compiled lane: what is in force goes in as numbers, and what the lane made of it comes
back.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...model.motion import Plane
from ...model.part import Units
from . import lane_fields as at
from .control import MOST_EVENTS, Control
from .cycles import Cycle
from .dialect import Dialect
from .offsets import ZERO
from .places import Cursor
from .program import Event, EventKind, FeedMode, ModalState

PORTION = 4096
"""Lines that the lane does at most before its records are taken."""
LONGEST = 1000
"""Bytes of a line that the lane reads; the core is for longer ones."""

_CYCLE_ROOM = 64
"""Motions beyond one a line for which there is always room."""
_KINDS = {
    at.DWELL: EventKind.DWELL,
    at.TOOL_CHANGE: EventKind.TOOL_CHANGE,
    at.STOP: EventKind.STOP,
    at.OPTIONAL_STOP: EventKind.OPTIONAL_STOP,
}
_GO = {"G0": 0, "G1": 1, "G2": 2, "G3": 3}
_CYCLES = {f"G{number}": number for number in (80, 73, 81, 82, 83, 85, 89)}
_CODES = {number: code for table in (_GO, _CYCLES) for code, number in table.items()}

_Row = tuple[float, ...]


class FastLane:
    """Does lines of a control's program in compiled code."""

    def __init__(self, control: Control, text: bytes, longest: int) -> None:
        """Stand ready for a program's text, whose lines may have so many bytes."""
        self._control, self._data = control, np.frombuffer(text, np.uint8)
        self._ints, self._reals = np.zeros(at.INTS, np.int64), np.zeros(at.REALS)
        self._records = np.empty((2 * PORTION + 8, len(at.STATE_FIELDS) + 1)), np.empty((PORTION + 8, 4))
        self._known: tuple[ModalState | None, dict[_Row, ModalState]] = None, {}
        self._ints[at.LONGEST] = min(LONGEST, longest)
        self._set_rules()

    def _set_rules(self) -> None:
        ints, reals, options, rules = self._ints, self._reals, self._control.options, self._control.rules
        ints[at.LINUXCNC] = options.dialect is Dialect.LINUXCNC
        ints[at.COMPUTES] = rules.ngc_flow
        ints[at.TOOL_CHANGES] = rules.tool_changes and rules.stops_at_change
        ints[at.EXTENDED] = options.dialect is not Dialect.GRBL
        reals[at.DWELL_WHOLE], reals[at.DWELL_POINT] = rules.dwell_unit_s, rules.dwell_unit_with_point_s

    @property
    def ready(self) -> bool:
        """Whether nothing is in force that the lane does not know."""
        control = self._control
        if control.curve is not None or control.compensation is not None or control.stray is not None:
            return False
        if control.polar or control.newly_turned or control.astray or not control.scale.plain:
            return False
        modal = control.modal
        return (
            modal.feed_mode is FeedMode.PER_MINUTE
            and modal.rotation == 0.0
            and len(control.events) <= MOST_EVENTS - PORTION - 8
        )

    def run(self, begin: Cursor, stop: int) -> Cursor:
        """Do the lines that it knows, from a place of the text on, and return where it stops.

        Args:
            begin: of the first line.
            stop: offset of a line that it does not come to.
        """
        from .lane_kernels import run_lines  # compiled: loaded where it is used

        control, ints = self._control, self._ints
        control.columns.reserve(PORTION + _CYCLE_ROOM)
        self._put(begin)
        rows, modal = control.columns.count, control.modal
        data = self._data if begin.offset > stop else self._data[:stop]
        run_lines(data, ints, self._reals, control.parameters.plain, control.columns.arrays(), self._records)
        offset, line = ints[: at.LINE + 1].tolist()
        if line > begin.line:
            self._take(rows, modal)
        return Cursor(offset, line)

    def _put(self, begin: Cursor) -> None:
        """Write what is in force into the lane's numbers."""
        control, ints, reals = self._control, self._ints, self._reals
        ints[at.OFFSET], ints[at.LINE], ints[at.COUNT] = begin.offset, begin.line, control.columns.count
        ints[at.MOTION] = self._motion()
        ints[at.SELECTED], ints[at.UNROLLED] = control.selected, control.unrolled
        ints[at.STATE : at.UNROLLED] = 0
        ints[at.LINES_LEFT], ints[at.MOST_UNROLLED] = PORTION, control.options.limits.looped_blocks
        ints[at.ROWS] = min(len(control.columns.kind), control.options.limits.motions)
        ints[at.KNOWN :] = control.known
        reals[at.FEED], reals[at.SCALE], reals[at.BARE] = control.feed, control.unit, control.unit * control.least
        reals[at.INITIAL], reals[at.PLACE : at.SHIFT] = control.initial, control.at
        self._put_modal()
        self._put_cycle()

    def _motion(self) -> int:
        """Return the number of the G word in force, -1 for one that the lane does not know."""
        motion = self._control.motion
        if motion in _GO:
            return _GO[motion]
        return _CYCLES.get(motion, -1) if self._ints[at.LINUXCNC] else -1

    def _put_modal(self) -> None:
        """Write the modal state and the offsets."""
        modal, offsets, ints = self._control.modal, self._control.offsets, self._ints
        ints[at.PLANE], ints[at.ABSOLUTE], ints[at.ARC_ABSOLUTE] = modal.plane, modal.absolute, modal.arc_absolute
        ints[at.SPINDLE], ints[at.FLOOD], ints[at.MIST] = modal.spindle, modal.flood, modal.mist
        ints[at.TOOL], ints[at.RETRACT] = modal.tool, modal.retract_to_r
        ints[at.WORK_OFFSET] = round(100 * float(offsets.name[1:])) if " " not in offsets.name else -1
        ints[at.UNITS] = 2000 if modal.units is Units.INCH else 2100
        ints[at.LENGTH_FREE] = offsets.tool == ZERO and modal.length_offset == 0
        ints[at.SURFACE] = modal.constant_surface
        self._reals[at.SPEED], self._reals[at.SHIFT :] = modal.speed, modal.shift

    def _put_cycle(self) -> None:
        cycle = self._control.cycle
        self._ints[at.CYCLE : at.KNOWN] = 0
        if cycle is not None:
            self._ints[at.CYCLE] = int(cycle.code[1:])
            words = (cycle.depth, cycle.r, cycle.dwell, cycle.peck)
            self._reals[at.CYCLE_Z : at.INITIAL] = [math.nan if word is None else word for word in words]
        else:
            self._reals[at.CYCLE_Z : at.INITIAL] = math.nan

    def _take(self, rows: int, modal: ModalState) -> None:
        """Take what the lane has done into the control.

        Args:
            rows: motions before. modal: what was in force then.
        """
        control, ints, reals = self._control, self._ints.tolist(), self._reals.tolist()
        control.columns.count = count = ints[at.COUNT]
        control.at, control.feed = (reals[at.PLACE], reals[at.PLACE + 1], reals[at.PLACE + 2]), reals[at.FEED]
        control.known, control.selected, control.unrolled = ints[at.KNOWN :], ints[at.SELECTED], ints[at.UNROLLED]
        control.parameters.changes += ints[at.CHANGES]
        if ints[at.MOTION] >= 0:
            control.motion = _CODES[ints[at.MOTION]]
        self._take_cycle(ints, reals)
        self._take_events(ints[at.EVENTS])
        if count > rows:
            self._take_states(rows, count, ints[at.STATES], modal)
        control.modal = self._modal(modal, (*(float(ints[field]) for field in at.STATE_FIELDS), reals[at.SPEED]))

    def _take_cycle(self, ints: list[int], reals: list[float]) -> None:
        control = self._control
        if ints[at.CYCLE] == 0:
            control.cycle = None
        elif ints[at.CYCLED]:
            depth, r, dwell, peck = (None if math.isnan(word) else word for word in reals[at.CYCLE_Z : at.INITIAL])
            control.initial = reals[at.INITIAL]
            control.cycle = Cycle(
                f"G{ints[at.CYCLE]}",
                Plane(ints[at.PLANE]),
                depth=depth,
                r=r,
                dwell=dwell,
                peck=peck,
                unit_mm=control.unit,
            )

    def _take_events(self, count: int) -> None:
        if count:
            for kind, before, line, value in self._records[1][:count].tolist():
                self._control.events.append(Event(_KINDS[int(kind)], int(before), int(line), value))

    def _take_states(self, rows: int, count: int, made: int, base: ModalState) -> None:
        """Give the states of new motions the numbers that the control knows them by."""
        control = self._control
        numbers = [control.number_of(self._modal(base, tuple(row))) for row in self._records[0][:made].tolist()]
        column = control.columns.state[rows:count]
        column[:] = numbers[0] if made == 1 else np.array(numbers, np.int32)[column]

    def _modal(self, base: ModalState, row: _Row) -> ModalState:
        """Return a state whose fields are those of a row, and else those of another state; kept, for most come again
        and again.
        """
        known, states = self._known
        if known is not base:
            if known is None or not _same_beside(known, base):
                states = {}
            self._known = base, states
        state = states.get(row)
        if state is None:
            plane, absolute, arc_absolute, spindle, flood, mist, tool, retract, speed = row
            state = states[row] = replace(
                base,
                plane=Plane(int(plane)),
                absolute=absolute != 0.0,
                arc_absolute=arc_absolute != 0.0,
                spindle=int(spindle),
                flood=flood != 0.0,
                mist=mist != 0.0,
                tool=int(tool),
                retract_to_r=retract != 0.0,
                speed=speed,
            )
        return state


def _same_beside(a: ModalState, b: ModalState) -> bool:
    """Tell whether two states are alike in all that the lane does not change."""
    return (
        a.units is b.units
        and a.feed_mode is b.feed_mode
        and a.length_offset == b.length_offset
        and a.work_offset == b.work_offset
        and a.constant_surface == b.constant_surface
        and a.shift == b.shift
        and a.rotation == b.rotation
        and a.path == b.path
        and a.path_tolerance == b.path_tolerance
    )
