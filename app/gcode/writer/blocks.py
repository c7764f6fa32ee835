"""The text of a program block by block, knowing what the control knows: position, motion and feed are modal."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...model.moves import MoveKind
from ...model.part import Units
from ..posts.post import ArcCentre, Post
from .block_kernels import LONGEST_NUMBER, NO_FEED, NO_MOTION, UNKNOWN, WORDS, write_blocks
from .drilling import CycleHole
from .grid import Position, numeral, spelled

CONTINUED = "hitofude+"
"""What the second and later comments of a note begin with."""

LAST_NUMBER = 99999
"""LinuxCNC and Fanuc count blocks no further; N words begin again behind it."""

Whole = NDArray[np.int64]

_PORTION = 4096
"""Motions whose text is made in one piece."""
_POSITION, _MOTION, _FEED, _NUMBER = slice(0, 3), 3, 4, 5  # places in what is in force


class Blocks:
    """Lines of a program as they are written; words that would say what the control knows already are left out.

    Attributes:
        lines: the text so far.
        motion_line: 1-based line of the last motion block; 0 before the first.
        home_lines: 1-based lines that send the tool to the machine's own home, where no move of the program goes.
    """

    def __init__(self, post: Post, units: Units) -> None:
        """Begin an empty program."""
        self.lines: list[str] = []
        self.motion_line = 0
        self.home_lines: list[int] = []
        self._post = post
        self._digits = post.digits(units)
        self._spelling = _MotionFormat(post, units)
        self._state = np.array([UNKNOWN, UNKNOWN, UNKNOWN, NO_MOTION, NO_FEED, post.numbers.start])
        self._cycle = ""

    def forget(self) -> None:
        """Take nothing for granted any more: at the start, and after a tool change."""
        self._state[:_NUMBER] = UNKNOWN, UNKNOWN, UNKNOWN, NO_MOTION, NO_FEED
        self._cycle = ""

    def comment(self, text: str) -> None:
        """Write a comment, in several lines if it is wider than the control takes."""
        for line in _wrapped(text, self._post.comments.width):
            self._comment(line)

    def note(self, text: str) -> None:
        """Write a comment that a program reads; what is wider than the control takes goes on behind "hitofude+"."""
        for line in continued(text, self._post.comments.width):
            self._comment(line)

    def _comment(self, text: str) -> None:
        """Write one comment in the signs that the control takes."""
        comments = self._post.comments
        text = "".join(c if (c.isascii() and c.isalnum()) or c in comments.signs else "," for c in text)
        self.lines.append(f"{comments.open}{text.upper() if comments.capitals else text}{comments.close}")

    @property
    def z(self) -> int:
        """Where the tool is along Z, counts of the last decimal."""
        assert self._state[2] != UNKNOWN
        return int(self._state[2])

    def block(self, text: str) -> None:
        """Write a block that is no motion; an empty text is left out."""
        if text:
            self._end_cycle()
            self.lines.append(text if text.startswith(("%", "O")) else self._numbered(text))

    def optional_block(self, text: str) -> None:
        """Write a block that a switch may leave out."""
        if text:
            self.block(text)
            self.lines[-1] = f"/{self.lines[-1]}"

    def home(self, text: str) -> None:
        """Write a block that goes to the machine's own home."""
        self.block(text)
        self.home_lines.append(len(self.lines))

    def clearance(self, text: str, z: int) -> None:
        """Write a block that is the rapid to a height, in the post's own words."""
        self.block(text)
        self._moved(MoveKind.RAPID, self._above(z))

    def _above(self, z: int) -> Position:
        """Return where the tool is, at a height."""
        return (int(self._state[0]), int(self._state[1]), z)

    def rapid_z(self, z: int) -> None:
        """Go straight up or down at rapid rate."""
        self.straight(MoveKind.RAPID, self._above(z))

    def straight(self, kind: MoveKind, end: Position, feed: int = 0) -> None:
        """Go straight, by a rapid or a line; a move that is none after rounding is left out."""
        self.motions(np.array([(kind, *end, 0, 0, NO_FEED if kind is MoveKind.RAPID else feed)]))

    def motions(self, rows: Whole, first: int = 0, stop: int | None = None) -> Whole:
        """Write the motions of some rows, one block each with the words that change; an arc's X, Y, I and J are always
        written.

        A motion that is none after rounding is left out.

        Args:
            rows: (n, 7) kind, X, Y, Z, I, J, F; see `write_blocks`.
            first, stop: which of them; all from the first on without `stop`.

        Returns:
            (stop - first,) the 1-based line behind which each motion is done.
        """
        stop = len(rows) if stop is None else stop
        done = np.empty(stop - first, np.int64)
        if self._cycle and self._says_any(rows[first:stop]):
            self._end_cycle()
        for begin in range(first, stop, _PORTION):
            end, before = min(begin + _PORTION, stop), len(self.lines)
            blocks, counts = self._spelling.blocks(rows, (begin, end), self._state)
            self.lines += blocks
            done[begin - first : end - first] = np.where(counts, before + counts, self.motion_line)
            self.motion_line = int(done[end - first - 1])
        return done

    def _says_any(self, rows: Whole) -> bool:
        """Tell whether any of the motions is more than nothing."""
        ends = rows[:, 1:4]
        elsewhere = (ends != UNKNOWN) & (ends != self._state[_POSITION])
        return bool(np.any(elsewhere) or np.any(rows[:, 0] > MoveKind.LINE))

    def hole(self, hole: CycleHole, steps: list[tuple[MoveKind, Position]]) -> None:
        """Write a hole as a canned cycle; its G words and its feed are left out where they are in force.

        Args:
            hole: its words.
            steps: the moves that the control makes of it.
        """
        words, begins = [], hole.cycle != self._cycle
        if begins:
            self._end_cycle()
            self.block(hole.start)
            words.append(hole.cycle)
        words += [f"X{self.number(hole.x, self._digits.X)}", f"Y{self.number(hole.y, self._digits.Y)}"]
        heights = {"Z": hole.z, "R": hole.r} | ({"Q": hole.peck} if hole.peck else {})
        words += [letter + self.number(count, self._digits.Z) for letter, count in heights.items()]
        words += [hole.dwell] * (begins and bool(hole.dwell))
        if hole.feed != self._state[_FEED]:
            words.append(f"F{self._rate(hole.feed)}")
        self.lines.append(self._numbered(" ".join(words)))
        for kind, end in steps:
            if np.any(self._state[_POSITION] != end):
                self._moved(kind, end)
        self._cycle, self._state[_MOTION], self._state[_FEED] = hole.cycle, NO_MOTION, hole.feed

    def _end_cycle(self) -> None:
        """Cancel the canned cycle that is in force."""
        if self._cycle:
            self.lines.append(self._numbered(self._post.drilling.cancel))
            self._cycle = ""

    def number(self, count: int, decimals: int) -> str:
        """Return a count of the last decimal as the control wants it in an axis word."""
        return numeral(count, decimals, self._post.words.trailing_zeros)

    def _moved(self, kind: MoveKind, end: Position) -> None:
        """Remember what the last line did."""
        self._state[_POSITION], self._state[_MOTION] = end, self._spelling.known_by(kind)
        self.motion_line = len(self.lines)

    def _rate(self, feed: int) -> str:
        """Return a feed rate without the zeros behind its point; and without the point, if the control can do so."""
        text = spelled(feed, self._digits.F)
        short = text.rstrip("0") if "." in text else f"{text}."
        return short if self._post.words.feed_point else short.rstrip(".")

    def _numbered(self, text: str) -> str:
        """Return a block with its N word, if the post wants one."""
        if not self._post.numbers.use:
            return text
        number, following = self._state[_NUMBER], self._state[_NUMBER] + self._post.numbers.step
        self._state[_NUMBER] = following if following <= LAST_NUMBER else self._post.numbers.start
        return f"N{number} {text}"


class _MotionFormat:
    """How a post spells motions, as the compiled core wants to be told."""

    def __init__(self, post: Post, units: Units) -> None:
        words, digits, texts = post.words, post.digits(units), post.words.motion
        self._order = np.array(["XYZIJFNG".index(letter) for letter in words.order if letter != "N"])
        self._motions = np.array(list("".join(texts).encode("ascii")), np.uint8)
        stops = np.cumsum([len(text) for text in texts])
        known = [texts.index(text) if text else NO_MOTION for text in texts]  # those that are spelled alike are alike
        self._spans = np.column_stack([stops - [len(text) for text in texts], stops, known])
        self._form = np.array(
            (
                digits.X,
                digits.Y,
                digits.Z,
                digits.I,
                digits.F,
                words.trailing_zeros,
                words.feed_point,
                post.arcs.centre is ArcCentre.ABSOLUTE,
                words.modal_motion,
                post.numbers.step if post.numbers.use else 0,
                post.numbers.start,
                LAST_NUMBER,
            ),
            np.int64,
        )
        self._longest = WORDS * LONGEST_NUMBER + max(map(len, texts))

    def known_by(self, kind: MoveKind) -> int:
        """Return what a motion is in force as."""
        return int(self._spans[kind, 2])

    def blocks(self, rows: Whole, span: tuple[int, int], state: Whole) -> tuple[list[str], Whole]:
        """Return the blocks of some motions, and how many of them there are behind each motion; `state` is brought up
        to date.
        """
        out, counts = np.empty((span[1] - span[0]) * self._longest, np.uint8), np.empty(span[1] - span[0], np.int64)
        length = write_blocks(rows, *span, self._order, self._motions, self._spans, self._form, state, out, counts)
        return out[:length].tobytes().decode("ascii").split("\n")[:-1], counts


def _wrapped(text: str, width: int) -> list[str]:
    """Return the text in lines of at most `width` characters, broken at spaces where there are any."""
    lines: list[str] = []
    while len(text) > width:
        cut = text.rfind(" ", 1, width + 1)
        cut = cut if cut > 0 else width
        lines.append(text[:cut])
        text = text[cut:].lstrip()
    return [*lines, text]


def continued(text: str, width: int) -> list[str]:
    """Return a note in lines of at most `width` characters; all but the first begin with CONTINUED.

    Nothing is lost: put together again the lines are the text, and none begins or ends in a space.
    """
    lines: list[str] = []
    room = width
    while len(text) > room:
        cut = next((k for k in range(room, 1, -1) if " " not in text[k - 1 : k + 1]), room)
        lines.append(text[:cut])
        text, room = text[cut:], width - len(CONTINUED)
    lines.append(text)
    return [lines[0], *(CONTINUED + line for line in lines[1:])]
