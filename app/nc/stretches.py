"""Stretches of an NC program that may be written anew: straight feed moves that follow one another, and nothing beside.

A stretch is one that a reader of the text can vouch for: each of its lines is done once, in the order of the text, says no
more than G1, X, Y, Z and a feed that does not change, and says by its very words where the tool goes. So lines under G91,
cutter compensation, rotation, scaling, macros or loops, lines with comments, and those that a slash or a jump may leave
out stay as they are.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from app.model.motion import Floats, MotionKind, Motions
from app.nc.read.program import FeedMode, NcProgram
from app.nc.read.text import Text
from app.progress import NO_PROGRESS, Progress

_MOVE = re.compile(r"\s*(?:N\d+\s*)?(?P<code>G0?1(?![\d.])\s*)?(?P<words>(?:[XYZF]\s*[-+]?(?:\d+\.?\d*|\.\d+)\s*)+)$", re.IGNORECASE)
_WORD = re.compile(r"([XYZF])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE)
_JUMPS = re.compile(r"\bGOTO\b|\bM9[789]\b", re.IGNORECASE)
_NUMBERED = re.compile(r"\s*N\d", re.IGNORECASE)
_SAME = 1e-7
"""mm; a place that words say is that of the motion where they are no farther apart."""
_PORTION = 20_000


class Left(Enum):
    """Why a straight feed move is in no stretch."""

    ALONE = "no other feed move beside it"
    WORDS = "its line says more than where to go, or says it another way"
    REPEATED = "its line is done more than once, or out of order"
    FEED = "feed in inverse time or per revolution"
    UNKNOWN = "where the tool is before it the program has not said"


@dataclass(frozen=True, eq=False)
class Stretch:
    """Straight feed moves in a row.

    Attributes:
        first, stop: rows of the program's motions, `stop` excluded.
        points: (stop - first + 1, 3) from its start on, mm from the zero of the table of work offsets.
        first_line, last_line: 1-based lines of the text; between them there are no others but empty ones.
        feed: text of the F word that one of its lines has, or "".
        coded: whether its first line says G1 itself.
    """

    first: int
    stop: int
    points: Floats
    first_line: int
    last_line: int
    feed: str
    coded: bool


@dataclass(frozen=True, eq=False)
class Found:
    """All stretches of a program, and how many straight feed moves are in none, by the reason."""

    stretches: tuple[Stretch, ...]
    left: dict[Left, int]


def find_stretches(program: NcProgram, text: Text, progress: Progress = NO_PROGRESS) -> Found:
    """Return the stretches of a program of two moves or more, in the order of the text.

    Args:
        program: as the text was read.
        text: of the program.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    motions = program.motions
    why, feeds, coded = _lines(program, text.data.decode(text.encoding).split("\n"), progress)
    lines = motions.line.astype(np.int64)
    empty = np.array([not line.strip() for line in text.data.split(b"\n")])
    gaps = np.concatenate([[0], np.cumsum(~empty)])  # lines with something in them, up to and with each
    stretches, left = [], dict.fromkeys(Left, 0)
    row = 0
    while row < len(motions):
        reason = why[row]
        if reason is not None:
            if isinstance(reason, Left):
                left[reason] += 1
            row += 1
            continue
        stop = row + 1
        while stop < len(motions) and why[stop] is None and not feeds[stop] and _goes_on(motions, row, stop, gaps):
            stop += 1
        if stop - row >= 2:
            points = np.vstack([motions.start[row : row + 1], motions.end[row:stop]])
            feed = next((feeds[k] for k in range(row, stop) if feeds[k]), "")
            stretches.append(Stretch(row, stop, points, int(lines[row]), int(lines[stop - 1]), feed, coded[row]))
        else:
            left[Left.ALONE] += 1
        row = stop
    return Found(tuple(stretches), left)


def _goes_on(motions: Motions, row: int, stop: int, gaps: NDArray[np.int64]) -> bool:
    """Tell whether a motion may be in the stretch of the one before it that began at `row`."""
    line, before = motions.line[stop], motions.line[stop - 1]
    return bool(
        motions.state[stop] == motions.state[row]
        and motions.feed[stop] == motions.feed[row]
        and line > before
        and gaps[line - 1] == gaps[before]
        and np.array_equal(motions.start[stop], motions.end[stop - 1])
    )


def _lines(program: NcProgram, lines: list[str], progress: Progress) -> tuple[list[Left | bool | None], list[str], list[bool]]:
    """Return for each motion: why it can be in no stretch (True: it is no straight feed move), its F word, whether it says G1."""
    motions, states = program.motions, program.states
    count = len(motions)
    numbers = motions.line.tolist()
    times = np.bincount(motions.line, minlength=len(lines) + 2)
    jumps = any(_JUMPS.search(line) for line in lines)
    highest = np.maximum.accumulate(motions.line) if count else motions.line
    known = max(program.motions.known_from)
    homeward = set(program.homeward)
    why: list[Left | bool | None] = [True] * count
    feeds, coded = [""] * count, [False] * count
    for row in np.flatnonzero(motions.kind == MotionKind.LINE).tolist():
        if row % _PORTION == 0:
            progress.step(row / count, "Looking for what can be smoothed")
        line, state = lines[numbers[row] - 1], states[motions.state[row]]
        match = _MOVE.match(line)
        if times[numbers[row]] > 1 or highest[row] > numbers[row] or (jumps and _NUMBERED.match(line)):
            why[row] = Left.REPEATED
        elif row < known or row in homeward or row - 1 in homeward:
            why[row] = Left.UNKNOWN
        elif state.feed_mode is not FeedMode.PER_MINUTE or not motions.feed[row] > 0:
            why[row] = Left.FEED
        elif match is None or not state.absolute or state.rotation != 0.0:
            why[row] = Left.WORDS
        else:
            words = _WORD.findall(match["words"])
            feeds[row] = next((value for letter, value in words if letter in "Ff"), "")
            coded[row] = match["code"] is not None
            said = _said(words, motions.end[row].tolist(), state.shift, state.units.value)
            why[row] = None if said else Left.WORDS
    return why, feeds, coded


def _said(words: list[tuple[str, str]], end: list[float], shift: tuple[float, float, float], unit: float) -> bool:
    """Tell whether the words are where the motion ends, each letter once."""
    letters = [letter.upper() for letter, _ in words]
    if len(set(letters)) < len(letters) or letters == ["F"]:
        return False
    at = {"X": 0, "Y": 1, "Z": 2}
    return all(
        letter == "F" or abs(float(value) * unit + shift[at[letter]] - end[at[letter]]) <= _SAME
        for letter, (_, value) in zip(letters, words, strict=True)
    )
