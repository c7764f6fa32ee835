"""The blocks that bring a control to where a program stood at one of its lines: everything in force, then the tool's
way there.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from ...model.part import Units
from ..interpreter.dialect import Dialect
from ..interpreter.offsets import OFFSETS, ZERO, Place, added
from ..interpreter.program import FeedMode
from .control_state import AxisKnowledge, ControlState

PLANES = ("G17", "G18", "G19")
ARC_MODES = (Dialect.LINUXCNC, Dialect.GRBL, Dialect.MACH3)
"""They know G91.1 and G92.1."""
HOMEWARD = {Dialect.FANUC: ("G91 G28 Z0.", "G90"), Dialect.HAAS: ("G53 G0 Z0.",)}
"""Up to the machine's home along Z, wherever the tool stands, as the posts of these controls write it. Where nothing is
named here, no such words are safe on every machine: a LinuxCNC machine may have no home at its top, a router none at
all.
"""
LEAST = 1e-6
"""mm; shorter ways are none."""


@dataclass(frozen=True, slots=True)
class Approach:
    """How to go to the start point, mm, program coordinates.

    Attributes:
        clearance: height of the ways in the plane.
        above: how far above the start point rapids end.
        feed: from there down, mm/min; 0 = not known, so rapid.
        spin_up: s.
    """

    clearance: float
    above: float
    feed: float
    spin_up: float


def lead_in(state: ControlState, approach: Approach) -> list[str]:
    """Return the blocks, one a line."""
    writer = _LeadInWriter(state)
    way = list(writer.way(approach))
    before = [*writer.modes(), *writer.parameters(), *writer.zeros(), *writer.up(), *writer.tool(approach)]
    return [block for block in (*before, *way, *writer.rest(way, approach.feed)) if block]


class _LeadInWriter:
    """Writes words in the units that are in force at the line."""

    def __init__(self, state: ControlState) -> None:
        self._standing, self._control = state, state.control
        self._modal, self._dialect = state.control.modal, state.control.options.dialect

    def _word(self, letter: str, value: float) -> str:
        """Return a word with a length in mm, with a decimal point and no more digits than it needs."""
        digits = 7 if self._modal.units is Units.INCH else 6
        return f"{letter}{_plain(value / self._control.unit, digits)}"

    def _words(self, place: Place, axes: tuple[int, ...] = (0, 1, 2)) -> str:
        return " ".join(self._word("XYZ"[axis], place[axis]) for axis in axes)

    def _known(self, *codes: str) -> str:
        """Return the codes that the dialect has."""
        return " ".join(code for code in codes if code not in self._control.rules.missing)

    def modes(self) -> Iterator[str]:
        """Yield what makes the blocks to come mean what they say."""
        yield self._known("G20" if self._modal.units is Units.INCH else "G21", "G17", "G90", "G94", "G40", "G49", "G80")

    def parameters(self) -> Iterator[str]:
        """Yield the parameters that the program has set."""
        for key, value in self._standing.parameters:
            name = str(key) if isinstance(key, int) else f"<{key}>"
            yield f"#{name}={_plain(value, 10)}"

    def zeros(self) -> Iterator[str]:
        """Yield the work offsets that the program has set, the one in force, and what G52 and G92 add."""
        offsets = self._control.offsets
        if self._standing.common != ZERO:
            yield f"G10 L2 P0 {self._words(self._standing.common)}"
        for name in dict.fromkeys([*offsets.work, *offsets.turned]):
            turn = f" R{_plain(math.degrees(offsets.turned[name]), 9)}" if name in offsets.turned else ""
            number = OFFSETS.index(name) + 1 if name in OFFSETS else int(name.split("P")[1])
            kind = "L2" if name in OFFSETS else "L20"
            yield f"G10 {kind} P{number} {self._words(offsets.work.get(name, ZERO))}{turn}"
        yield self._modal.work_offset
        if self._dialect in ARC_MODES:
            yield "G92.1"
        if offsets.local != ZERO:
            yield f"G52 {self._words(offsets.local)}"
        if self._dialect is Dialect.LINUXCNC and offsets.set_here_on and offsets.set_here != ZERO:
            yield f"G52 {self._words(offsets.set_here)}"

    def up(self) -> Iterator[str]:
        """Yield the way off the work, before tool and spindle are touched."""
        modal = self._modal
        if modal.tool or modal.spindle or modal.length_offset:
            yield from HOMEWARD.get(self._dialect, ())

    def tool(self, approach: Approach) -> Iterator[str]:
        """Yield tool, length, spindle and coolant."""
        modal, rules = self._modal, self._control.rules
        if modal.tool and rules.tool_changes:
            yield f"T{modal.tool} M6"
        if modal.length_offset:
            length = f"G43 H{modal.length_offset}"
            yield f"G0 {length} {self._word('Z', approach.clearance)}" if self._length_moves else length
        if modal.speed:
            yield f"S{_plain(modal.speed, 4).removesuffix('.')}{('', ' M3', ' M4')[modal.spindle]}"
        if modal.spindle and approach.spin_up:
            yield f"G4 P{self._dwell(approach.spin_up)}"
        yield from (code for code, on in (("M7", modal.mist), ("M8", modal.flood)) if on)

    def _dwell(self, seconds: float) -> str:
        """Return P of G4: where whole numbers count milliseconds, without the point that a Fanuc refuses."""
        unit = self._control.rules.dwell_unit_s
        return _plain(seconds / unit, 3) if unit == 1.0 else f"{round(seconds / unit)}"

    @property
    def _length_moves(self) -> bool:
        """Whether G43 may move Z by itself, so that it must stand with the Z that is meant."""
        return self._dialect in HOMEWARD and self._modal.length_offset > 0

    @property
    def _added(self) -> Place:
        """What G92 adds and can only be set at a place that is known."""
        offsets = self._control.offsets
        return offsets.set_here if self._dialect is not Dialect.LINUXCNC and offsets.set_here_on else ZERO

    def way(self, approach: Approach) -> Iterator[str]:
        """Yield the way to the start point: up, across, down."""
        axes, goal, extra = self._standing.axes, self._control.program_place, self._added
        machine = added(self._control.at, self._control.offsets.tool)
        before = added(goal, extra)
        high = (before[0], before[1], approach.clearance + extra[2])
        if not (axes[2] is AxisKnowledge.WORK and self._length_moves):
            yield from self._to(high, machine, (2,))
        yield from self._to(before, machine, (0, 1))
        if extra != ZERO:
            yield f"G92 {self._words((goal[0], goal[1], approach.clearance))}"
        if axes[2] is AxisKnowledge.WORK:
            yield from self._down(approach, goal[2])

    def _to(self, place: Place, machine: Place, some: tuple[int, ...]) -> Iterator[str]:
        """Yield the rapids of some axes to where they are, as each is known; homes before places."""
        for kind in (AxisKnowledge.HOME, AxisKnowledge.SECOND_HOME, AxisKnowledge.MACHINE, AxisKnowledge.WORK):
            mine = tuple(axis for axis in some if self._standing.axes[axis] is kind)
            if not mine:
                continue
            if kind is AxisKnowledge.WORK:
                yield f"G0 {self._words(place, mine)}"
            elif kind is AxisKnowledge.MACHINE:
                yield f"G53 G0 {self._words(machine, mine)}"
            else:
                yield f"G91 {kind.value} {self._words(ZERO, mine)}"
                yield "G90"

    def _down(self, approach: Approach, height: float) -> Iterator[str]:
        """Yield the way down to the start point."""
        above = min(approach.clearance, height + (approach.above if approach.feed else 0.0))
        if above < approach.clearance - LEAST:
            yield f"G0 {self._word('Z', above)}"
        if height < above - LEAST:
            yield f"G1 {self._word('Z', height)} F{_plain(approach.feed / self._control.unit, 4)}"

    def rest(self, way: list[str], feed: float) -> Iterator[str]:
        """Yield the modes that only the program's own blocks need; a motion word stands in feed per minute, as LinuxCNC
        asks.
        """
        modal, control = self._modal, self._control
        if modal.plane:
            yield PLANES[modal.plane]
        if self._dialect in ARC_MODES:
            yield "G90.1" if modal.arc_absolute else "G91.1"
        if modal.path != "G64":
            yield self._path()
        yield self._known("G99" if modal.retract_to_r else "G98")
        if control.motion in ("G0", "G80"):
            yield control.motion
        elif control.motion == "G1" and feed and not (way and way[-1].startswith("G1 ")):
            yield f"G1 F{_plain(feed / control.unit, 4)}"
        if not self._standing.per_minute:
            yield modal.feed_mode.value
        if not math.isnan(control.feed) and modal.feed_mode is not FeedMode.INVERSE_TIME:
            yield f"F{_plain(control.feed / control.unit, 6)}"
        if control.selected != modal.tool and control.rules.tool_changes:
            yield f"T{control.selected}"
        if not modal.absolute:
            yield "G91"

    def _path(self) -> str:
        """Return the path mode; P anew, as it may have been said in other units."""
        words = [word for word in self._modal.path.split() if not word.startswith("P")]
        if words[0] == "G64" and self._modal.path_tolerance is not None:
            words.insert(1, self._word("P", self._modal.path_tolerance))
        return " ".join(words)


def _plain(value: float, digits: int) -> str:
    """Return a number with its decimal point and without the zeros behind that it does not need."""
    text = f"{value:.{digits}f}".rstrip("0")
    return text if text.strip("-.0") else "0."
