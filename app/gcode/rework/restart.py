"""Start a program again from one of its lines: a new program that leads in safely and goes on with the old one's own
text.

The restart program is read in its turn, and given out only if it goes on with exactly the motions of the old one.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...model.part import Units
from ..interpreter.control import Control
from ..interpreter.dialect import Dialect
from ..interpreter.offsets import OFFSETS, ZERO, Place, added
from ..interpreter.options import ReadOptions
from ..interpreter.places import KEYWORDS, label_of
from ..interpreter.program import FeedMode, ModalState, NcProgram
from ..interpreter.reader import DEFAULT, read_program
from ..interpreter.text import ProgramBuffer
from ..timing.extent import extent
from .control_state import ELSEWHERE, SAME, AxisKnowledge, ControlState, control_state_at

O_WORD = re.compile(rf"/?(?:n[0-9.]+)?o(<[^>]+>|[0-9]+)({'|'.join(sorted(KEYWORDS, key=len, reverse=True))})")

OPENS = {"sub": "endsub", "if": "endif", "while": "endwhile", "repeat": "endrepeat", "do": "while"}

INNER = {"else": "if", "elseif": "if", "return": "sub", "break": "", "continue": ""}

STAND_CLEAR = "(THE TOOL MUST STAND CLEAR ABOVE THE WORK BEFORE THE START)"


@dataclass(frozen=True)
class RestartOptions:
    """How to lead in.

    Attributes:
        read: dialect and tool table of the control; its start does not matter.
        clearance: height above the work's zero in force at the line, mm, from which the tool goes down; None = the
            highest that the program itself goes.
        approach: how far above its start point the tool leaves the rapid, mm, >= 0.
        plunge_feed: from there down, mm/min; None = the slowest with which the program itself goes straight down, or,
            where it never does, the slowest that it has.
        spin_up: how long the spindle is waited for, s.
    """

    read: ReadOptions = DEFAULT
    clearance: float | None = None
    approach: float = 2.0
    plunge_feed: float | None = None
    spin_up: float = 3.0


def restart(data: bytes, line: int, options: RestartOptions, progress: Progress = NO_PROGRESS) -> bytes:
    """Return a program that leads in to a line and goes on with the text from there, byte for byte.

    Args:
        data: the program's bytes.
        line: 1-based; what stands there is done first.
        options: of the control and of the lead-in.
        progress: told of how much is done.

    Raises:
        InputError: it cannot be safe from there; the text says why, and where it could.
        Cancelled: the job was asked to stop.
    """
    text = ProgramBuffer(data)
    if not 1 <= line <= text.line_count:
        raise InputError(f"Line {line} is not there: the program has {text.line_count} lines.")
    whole = read_program(data, options.read, progress.part(0.0, 0.3))
    state = control_state_at(data, line, options.read, progress.part(0.3, 0.6))
    _check_structure(text, line)
    head = [*_leader(text, line, state.control), *_subroutines(text, line)]
    tail = _tail(data, text, line)
    if b"#" not in tail:
        state = replace(state, parameters=())
    blocks = lead_in(state, _approach(whole, state, options))
    end = "\r\n" if b"\r\n" in data else "\n"
    made = end.join([*head, *blocks, ""]).encode(text.encoding, "replace") + tail
    _check(made, _RestartedProgram(whole, line), state, options, progress.part(0.6, 1.0))
    return made


def _offset(data: bytes, line: int) -> int:
    """Return where a line begins."""
    at = 0
    for _ in range(line - 1):
        at = data.index(b"\n", at) + 1
    return at


def _tail(data: bytes, text: ProgramBuffer, line: int) -> bytes:
    """Return the file's own bytes from a line on; of a file in UTF-16, the text's."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return text.data[_offset(text.data, line) :]
    own = data.removeprefix(b"\xef\xbb\xbf")
    ends = (end.end() for end in re.finditer(rb"\r\n|\r|\n", own))
    return own[next(islice(ends, line - 2, None)) :] if line > 1 else own


def _check_structure(text: ProgramBuffer, line: int) -> None:
    """Refuse a line within a block of O words: what belongs to its beginning would be missing."""
    open_words: list[tuple[str, str]] = []
    for number, label, keyword in _o_words(text, line):
        partner = (label, INNER.get(keyword, ""))
        if keyword == "while" and (label, "do") in open_words:
            open_words.remove((label, "do"))
        elif keyword in OPENS:
            open_words.append((label, keyword))
        elif begun := [each for each in open_words if each[0] == label and OPENS[each[1]] == keyword]:
            open_words.remove(begun[-1])
        elif keyword in OPENS.values() or (partner[1] and partner not in open_words and keyword != "return"):
            raise InputError(
                f"Line {line} is within what O{label} begins before and ends at line {number}; start before it or "
                "behind it."
            )


class _OWordLine(NamedTuple):
    """A line with an O word: its number, the label, the keyword."""

    number: int
    label: str
    keyword: str


def _o_words(text: ProgramBuffer, first: int) -> list[_OWordLine]:
    """Return each O word from a line on."""
    begin = _offset(text.data, first)
    rest = text.data[begin:].decode(text.encoding).lower().split("\n")
    found = [(number, O_WORD.match("".join(each.split()))) for number, each in enumerate(rest, first) if "o" in each]
    return [_OWordLine(number, label_of(match[1]), match[2]) for number, match in found if match is not None]


def _leader(text: ProgramBuffer, line: int, control: Control) -> list[str]:
    """Return the lines that must stand first, and comments that say what this is."""
    lines = text.data.decode(text.encoding).split("\n")
    first = [number for number, each in enumerate(lines[:20], 1) if each.strip()][:2]
    begin = [number for number in first[:1] if lines[number - 1].strip().startswith("%")]
    if control.rules.fanuc_flow:
        begin += [number for number in first if re.match(r"\s*[oO:]\s*\d", lines[number - 1])]
    if begin and line <= begin[-1]:
        raise InputError(
            f"Line {line} is the program's beginning; run the whole program, or start at line {begin[-1] + 1}."
        )
    plain = re.sub(r"[^ -~]|[()%;]", " ", lines[line - 1])[:50].strip()
    reported = [f"(RESTART FROM LINE {line})", f"({plain or 'an empty line'})"]
    if control.options.dialect not in HOMEWARD:
        reported.append(STAND_CLEAR)
    return [*(lines[number - 1].strip() for number in begin), *reported]


def _subroutines(text: ProgramBuffer, line: int) -> list[str]:
    """Return the subroutines that are defined before a line, as they are written."""
    lines = text.data.decode(text.encoding).split("\n")
    found, begun = [], 0
    for number, _, keyword in _o_words(text, 1):
        if keyword == "sub" and number < line:
            begun = number
        elif keyword == "endsub" and begun:
            found += lines[begun - 1 : number]
            begun = 0
    return found


def _approach(whole: NcProgram, state: ControlState, options: RestartOptions) -> Approach:
    """Return how high to travel and how to go down, program coordinates, mm."""
    control, motions = state.control, whole.motions
    highest = extent(whole).high[2]  # not the machine's home: where that is, the program does not know
    clearance = options.clearance if options.clearance is not None else highest - control.modal.shift[2]
    ways = motions.end - motions.start
    fed = np.isfinite(motions.feed) & (motions.feed > 0)
    down = fed & (ways[:, 2] < 0) & np.all(np.abs(ways[:, :2]) < SAME, axis=1)
    slowest = motions.feed[down if down.any() else fed].min(initial=np.inf)
    feed = options.plunge_feed or (float(slowest) if np.isfinite(slowest) else 0.0)
    height = control.program_place[2]
    if AxisKnowledge.FREE in state.axes and state.axes[2] is AxisKnowledge.WORK and height < clearance - SAME:
        name = "XYZ"[state.axes.index(AxisKnowledge.FREE)]
        raise InputError(
            f"Where {name} is at this line the program does not say, and the tool would have to go down there; "
            f"start behind the first block that says {name}."
        )
    clearance = float(np.fmax(clearance, height)) if state.axes[2] is AxisKnowledge.WORK else clearance
    if control.options.dialect in HOMEWARD and control.modal.length_offset and not np.isfinite(clearance):
        raise InputError("The program says no height to which the tool could go with its length; say a clearance.")
    return Approach(clearance, options.approach, feed, options.spin_up)


class _RestartedProgram(NamedTuple):
    """A program, and the line that it is begun at again."""

    program: NcProgram
    line: int


def _check(
    made: bytes, original: _RestartedProgram, state: ControlState, options: RestartOptions, progress: Progress
) -> None:
    """Read the restart program, and refuse to give it out if it does not go on with the old one's motions."""
    whole, line = original
    read = replace(options.read, start=ELSEWHERE) if AxisKnowledge.FREE not in state.axes else options.read
    again = read_program(made, read, progress)
    first, count = state.motions, len(whole.motions)
    skipped = len(again.motions) - (count - first)
    if (whole.error is None) != (again.error is None) or skipped < 0:
        behind = made.count(b"\n") - whole.line_count + (made[-1:] != b"\n")
        reason = f" at line {again.error.line - behind}: {again.error.text}" if again.error is not None else "."
        raise InputError(
            f"A restart from line {line} would not go on as the program does{reason} Start at a line that says its own "
            "G words, and that no later line jumps back over."
        )
    row = _first_other(whole, again, first, skipped)
    if row is not None:
        raise InputError(
            f"A restart from line {line} would not move as the program does at line {int(whole.motions.line[row])}: "
            "that block goes on with words of a line before the restart; start at a line that says them itself."
        )


def _first_other(a: NcProgram, b: NcProgram, first: int, skipped: int) -> int | None:
    """Return the first motion of a, from `first` on, that is another one in b behind those that are skipped."""
    one, two = a.motions, b.motions
    same = np.ones(len(one) - first, bool)
    for name in ("start", "end", "centre"):
        near = np.abs(getattr(one, name)[first:] - getattr(two, name)[skipped:])
        near[: max(one.known_from[2] + (name == "start") - first, 0), 2] = (
            0  # where Z is unknown, a lead-in may go home
        )
        same &= np.all((near < SAME) | np.isnan(near), axis=1)
    for name in ("kind", "plane", "turns"):
        same &= getattr(one, name)[first:] == getattr(two, name)[skipped:]
    feed, other = one.feed[first:], two.feed[skipped:]
    same &= (np.abs(feed - other) <= 1e-6 * np.abs(feed) + 1e-3) | (np.isnan(feed) & np.isnan(other))
    for pair in np.unique(np.column_stack([one.state[first:], two.state[skipped:]]), axis=0).tolist():
        if _told(a.states[pair[0]]) != _told(b.states[pair[1]]):
            same &= ~((one.state[first:] == pair[0]) & (two.state[skipped:] == pair[1]))
    wrong = np.flatnonzero(~same)
    return first + int(wrong[0]) if len(wrong) else None


def _told(state: ModalState) -> tuple[object, ...]:
    """Return of a state what a machine shows: tool, length, spindle, coolant, work offset, blending."""
    tolerance = None if state.path_tolerance is None else round(state.path_tolerance, 6)
    return (
        state.tool,
        state.length_offset,
        round(state.speed, 6),
        state.spindle,
        state.flood,
        state.mist,
        state.work_offset,
        tolerance,
        tuple(round(value, 4) + 0.0 for value in state.shift),
    )


# The blocks that bring a control to where a program stood at one of its lines: everything in force, then the tool's
# way there.


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
