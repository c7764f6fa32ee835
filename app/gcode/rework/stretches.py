"""Stretches of an NC program that may be written anew: straight feed moves that follow one another, and nothing beside.

A stretch is one that a reader of the text can vouch for: each of its lines is done once, in the order of the text, says
no more than G1, X, Y, Z and a feed that does not change, and says by its very words where the tool goes. So lines under
G91, cutter compensation, rotation, scaling, macros or loops, lines with comments, and those that a slash or a jump may
leave out stay as they are.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, MotionKind, Motions
from ..interpreter.program import BlockFault, FeedMode, NcProgram
from ..interpreter.text import ProgramBuffer, code_of

Flags = NDArray[np.bool_]

_PLAIN = re.compile(r"(?:[a-z][-+]?(?:\d+\.?\d*|\.\d+))+")

_MOTION = re.compile(r"g0?[0-3](?![\d.])")

_JUMPS = re.compile(r"\bGOTO\b|\bM9[789]\b", re.IGNORECASE)


class SkipReason(Enum):
    """Why a straight feed move is in no stretch."""

    ALONE = "no other feed move beside it"
    WORDS = "its line says more than where to go, or says it another way"
    REPEATED = "its line is done more than once, or out of order"
    FEED = "feed in inverse time or per revolution"
    UNKNOWN = "where the tool is before it the program has not said"


@dataclass(frozen=True, eq=False)
class FeedStretch:
    """Straight feed moves in a row.

    Attributes:
        first, stop: rows of the program's motions, `stop` excluded.
        points: (stop - first + 1, 3) from its start on, mm from the zero of the table of work offsets.
        first_line, last_line: 1-based lines of the text; between them there are no others but empty ones.
        feed: text of the F word that its first line has, or ""; further ones of the same feed say nothing.
        coded: whether its first line says G1 itself.
        resumed: whether the next line that says anything says G0 to G3 itself, so that G1 need not be in force behind
            the stretch.
    """

    first: int
    stop: int
    points: Floats
    first_line: int
    last_line: int
    feed: str
    coded: bool
    resumed: bool


@dataclass(frozen=True, eq=False)
class FoundStretches:
    """All stretches of a program, and how many straight feed moves are in none, by the reason."""

    stretches: tuple[FeedStretch, ...]
    left: dict[SkipReason, int]


def find_stretches(program: NcProgram, text: ProgramBuffer, progress: Progress = NO_PROGRESS) -> FoundStretches:
    """Return the stretches of a program of two moves or more, in the order of the text.

    Args:
        program: as the text was read.
        text: of the program.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, "Looking for what can be smoothed")
    motions = program.motions
    spoken = _spoken(program, text)
    reasons = _reasons(program, spoken)
    left = {reason: int(np.sum(reasons == k)) for k, reason in enumerate(SkipReason)}
    free = reasons == _FREE
    on = np.zeros(len(motions), np.bool_)
    on[1:] = free[1:] & free[:-1] & _goes_on(motions, spoken.filled)
    first = np.flatnonzero(free & ~on)
    stop = np.append(first[1:], len(motions))
    behind = np.concatenate([[0], np.cumsum(free)])
    count = behind[stop] - behind[first]  # free moves up to the next first one all go on from it
    left[SkipReason.ALONE] += int(np.sum(count == 1))
    progress.step(0.5)
    rows = zip(first[count > 1].tolist(), (first + count)[count > 1].tolist(), strict=True)
    return FoundStretches(tuple(_stretch(motions, text, spoken, row, end) for row, end in rows), left)


def _stretch(motions: Motions, text: ProgramBuffer, spoken: _LineWords, first: int, stop: int) -> FeedStretch:
    points = np.vstack([motions.start[first : first + 1], motions.end[first:stop]])
    begin, end = spoken.feeds[first].tolist()
    feed = text.data[begin:end].decode() if begin >= 0 else ""
    lines = motions.line[[first, stop - 1]].tolist()
    return FeedStretch(
        first=first,
        stop=stop,
        points=points,
        first_line=lines[0],
        last_line=lines[1],
        feed=feed,
        coded=bool(spoken.coded[first]),
        resumed=_resumed(text, spoken.begins, lines[1]),
    )


def _resumed(text: ProgramBuffer, begins: NDArray[np.int64], behind: int) -> bool:
    """Tell whether the first line behind some lines that is more than a comment is plain words, G0 to G3 among them."""
    for begin in begins[behind:-1].tolist():
        try:
            code = code_of(text.line(begin), nested=False)
        except BlockFault:
            return False
        if code:
            return _PLAIN.fullmatch(code) is not None and _MOTION.search(code) is not None
    return False


def _goes_on(motions: Motions, filled: NDArray[np.int64]) -> Flags:
    """Tell of all motions but the first (n - 1,) whether each may be in the stretch of the one before it."""
    state, feed, line = motions.state, motions.feed, motions.line
    met = np.all(motions.start[1:] == motions.end[:-1], axis=1)
    goes_on: Flags = (
        (state[1:] == state[:-1])
        & (feed[1:] == feed[:-1])
        & (line[1:] > line[:-1])
        & (filled[line[1:] - 1] == filled[line[:-1]])
        & met
    )
    return goes_on


@dataclass(frozen=True, eq=False)
class _LineWords:
    """What the lines of n motions say.

    Attributes:
        begins: (m + 1,) of each line its first byte, and the text's end.
        filled: (m + 1,) lines with something in them, up to and with each line.
        plain, coded, numbered: (n,) see the kernels; False of what is no straight feed move.
        feeds: (n, 2) where the F word's number begins and ends in the text, -1: there is none.
        jumps: whether the text may jump.
    """

    begins: NDArray[np.int64]
    filled: NDArray[np.int64]
    plain: Flags
    coded: Flags
    numbered: Flags
    feeds: NDArray[np.int64]
    jumps: bool


def _spoken(program: NcProgram, text: ProgramBuffer) -> _LineWords:
    from . import stretch_kernels as kernels

    motions, states = program.motions, program.states
    data, count = np.frombuffer(text.data, np.uint8), text.line_count + 1
    begins, filled = np.empty(count, np.int64), np.empty(count, np.int64)
    kernels.read_lines(data, begins, filled)
    rows = np.flatnonzero(motions.kind == MotionKind.LINE)
    plain, coded, numbered = (np.zeros(len(motions), np.bool_) for _ in range(3))
    feeds = np.full((len(motions), 2), -1, np.int64)
    reported = tuple(np.empty(len(rows), np.bool_) for _ in range(3))
    numbers = np.empty((len(rows), 2), np.int64)
    shifts = np.array([state.shift for state in states], np.float64).reshape(-1, 3)
    units = np.array([state.units.value for state in states], np.float64)
    lines, at = motions.line[rows].astype(np.int64) - 1, motions.state[rows].astype(np.int64)
    kernels.read_moves(
        data, begins, lines, np.ascontiguousarray(motions.end[rows]), at, shifts, units, *reported, numbers
    )
    plain[rows], coded[rows], numbered[rows] = reported
    feeds[rows] = numbers
    return _LineWords(begins, filled, plain, coded, numbered, feeds, _may_jump(text))


def _may_jump(text: ProgramBuffer) -> bool:
    """Tell whether the text has words that jump; the whole text is searched for them only where it has their
    letters.
    """
    upper = text.data.upper()
    if not any(word in upper for word in (b"GOTO", b"M97", b"M98", b"M99")):
        return False
    return _JUMPS.search(text.data.decode(text.encoding)) is not None


_FREE, _OTHER = -1, -2
"""Of a motion: nothing speaks against it; it is no straight feed move."""


def _reasons(program: NcProgram, spoken: _LineWords) -> NDArray[np.int64]:
    """Return for each motion the number of the reason why it can be in no stretch, or _FREE, or _OTHER."""
    motions, states = program.motions, program.states
    count, number = len(motions), {reason: k for k, reason in enumerate(SkipReason)}
    line = motions.kind == MotionKind.LINE
    highest = np.maximum.accumulate(motions.line) if count else motions.line
    again = (np.bincount(motions.line)[motions.line] > 1) if count else np.zeros(0, np.bool_)
    unknown = np.arange(count) < max(motions.known_from)
    homeward = np.array([row for row in program.homeward if row < count], np.int64)
    unknown[homeward] = True
    unknown[homeward[homeward < count - 1] + 1] = True
    timed = np.array([state.feed_mode is FeedMode.PER_MINUTE for state in states], np.bool_)
    straight = np.array(
        [state.absolute and state.rotation == 0.0 and not state.respelled for state in states], np.bool_
    )
    reasons = np.select(
        [
            ~line,
            again | (highest > motions.line) | (spoken.jumps & spoken.numbered),
            unknown,
            ~(timed[motions.state] & (motions.feed > 0)),
            ~(straight[motions.state] & spoken.plain),
        ],
        [
            _OTHER,
            number[SkipReason.REPEATED],
            number[SkipReason.UNKNOWN],
            number[SkipReason.FEED],
            number[SkipReason.WORDS],
        ],
        _FREE,
    )
    return reasons.astype(np.int64)


# A program's text with some of its stretches written anew; all other lines stay, byte for byte.


_HEAD = re.compile(r"\s*(?:%.*|[O:]\s*\d+.*|\(.*|;.*)?$", re.IGNORECASE)
"""Lines that notes go behind: the tape's mark, the program's number, its first comments."""


@dataclass(frozen=True)
class RewrittenText:
    """The new text.

    Attributes:
        data: its bytes, with the line ends of the old one.
        lines: of each stretch that was written anew, its first and last line in the new text, 1-based.
    """

    data: bytes
    lines: Mapping[int, tuple[int, int]]


def rewrite(
    data: bytes, stretches: Sequence[FeedStretch], blocks: Mapping[int, Sequence[str]], notes: Sequence[str]
) -> RewrittenText:
    """Return a program in which the lines of some stretches are replaced.

    Args:
        data: the program's bytes.
        stretches: in the order of the text.
        blocks: the new lines of some of them, by index.
        notes: comment lines that are put behind the program's head.
    """
    text = ProgramBuffer(data)
    old = text.data.decode(text.encoding).split("\n")[:-1]
    new: list[str] = []
    at, lines = 0, {}
    behind = next((k for k, line in enumerate(old) if not _HEAD.match(line)), len(old))
    first = stretches[min(blocks)].first_line - 1 if blocks else len(old)
    behind = min(behind, first)
    new += old[:behind] + list(notes)
    at = behind
    for index in sorted(blocks):
        stretch = stretches[index]
        new += old[at : stretch.first_line - 1]
        lines[index] = (len(new) + 1, len(new) + len(blocks[index]))
        new += blocks[index]
        at = stretch.last_line
    new += old[at:]
    end = "\r\n" if b"\r\n" in data else "\n"
    return RewrittenText(end.join([*new, ""]).encode(text.encoding if text.encoding != "ascii" else "ascii"), lines)
