"""Start a program again from one of its lines: a new program that leads in safely and goes on with the old one's own
text.

The restart program is read in its turn, and given out only if it goes on with exactly the motions of the old one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ..interpreter.control import Control
from ..interpreter.options import ReadOptions
from ..interpreter.places import KEYWORDS, label_of
from ..interpreter.program import ModalState, NcProgram
from ..interpreter.reader import DEFAULT, read_program
from ..interpreter.text import ProgramBuffer
from ..timing.extent import extent
from .control_state import ELSEWHERE, SAME, AxisKnowledge, ControlState, control_state_at
from .lead_in import HOMEWARD, Approach, lead_in

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
