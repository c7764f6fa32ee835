"""The text of a program block by block, knowing what the control knows: position, motion and feed are modal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice, pairwise

import numpy as np
from numpy.typing import NDArray

from ...model.moves import MoveKind, Purpose
from ...model.part import Units
from ..posts import ArcCentre, DrillingWords, Post
from .block_kernels import LONGEST_NUMBER, NO_FEED, NO_MOTION, UNKNOWN, WORDS, write_blocks
from .template_fields import Position, numeral, spelled
from .work_moves import MoveLists, WorkMoves

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
        if hole.rate or hole.feed != self._state[_FEED]:
            words.append(f"F{hole.rate or self._rate(hole.feed)}")
        self.lines.append(self._numbered(" ".join(words)))
        for kind, end in steps:
            if np.any(self._state[_POSITION] != end):
                self._moved(kind, end)
        self._cycle, self._state[_MOTION] = hole.cycle, NO_MOTION
        self._state[_FEED] = NO_FEED if hole.rate else hole.feed  # a finer rate is none of the others

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


# Holes as canned cycles: a cycle is written only where it moves exactly as the tool path does.


Step = tuple[MoveKind, int]
"""A move along Z and where it ends, counts of the last decimal."""


@dataclass(frozen=True, slots=True)
class CycleHole:
    """A hole as a cycle.

    Attributes:
        cycle: G words of the height at which it ends, and of the cycle.
        x, y, z, r: place, bottom, and height from which it feeds, counts of the last decimal.
        peck: depth of a step, counts; 0 = in one go.
        feed: count of the last decimal of F.
        stop: index of the move behind it.
        dwell: P word of the wait at the bottom; "" = there is none.
        start: block before the first hole of a row; "" = none.
        rate: number of F, finer than `feed` counts, where a tap's pitch needs it; "" = `feed` is exact.
    """

    cycle: str
    x: int
    y: int
    z: int
    r: int
    peck: int
    feed: int
    stop: int
    dwell: str = ""
    start: str = ""
    rate: str = ""


@dataclass(frozen=True, slots=True)
class CycleRules:
    """The control's cycles.

    Attributes:
        words: its G words.
        scale: counts of the last decimal of Z in an out unit.
        peck_gap, chip_gap: counts.
        near: counts by which a rounded height between two pecks may be off.
        dwells: how long the operations wait at the bottom, by index, s; those that do not are left out.
        taps: the blocks before a tapping cycle, by the index of the operations that tap. left: of these, those that
            tap to the left. rates: numbers of F of those whose feed the decimals of F do not spell exactly.
    """

    words: DrillingWords
    scale: int
    peck_gap: int
    chip_gap: int
    near: int = 1
    dwells: Mapping[int, float] = field(default_factory=dict)
    taps: Mapping[int, str] = field(default_factory=dict)
    left: frozenset[int] = frozenset()
    rates: Mapping[int, str] = field(default_factory=dict)

    def wait(self, operation: int) -> str:
        """Return the block of an operation's wait at the bottom; "" = it does not wait."""
        seconds = self.dwells.get(operation, 0.0)
        return self.words.wait.format(dwell_s=f"{seconds:g}", dwell_ms=round(1000 * seconds)) if seconds else ""


def holes_of(moves: WorkMoves, rules: CycleRules) -> dict[int, CycleHole]:
    """Return the holes of a program that the control has cycles for, by the index of the move that each begins with.

    The first move of a tool, from wherever it was, is no part of a cycle.

    Args:
        moves: the program's.
        rules: what the control has.
    """
    if not rules.words.drill:
        return {}
    drilling = (moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)
    soon = np.append(drilling, (False, False))
    begins = (
        (moves.kind == MoveKind.RAPID) & (soon[1:-1] | soon[2:]) & (np.diff(moves.tool, prepend=moves.tool[:1]) == 0)
    )
    holes: dict[int, CycleHole] = {}
    stop = 1
    for i in np.flatnonzero(begins).tolist():
        if i >= stop and (hole := hole_at(moves.lists, i, moves.lists.end[i - 1][2], rules)) is not None:
            holes[i], stop = hole, hole.stop
    return holes


def hole_at(moves: MoveLists, i: int, height: int, rules: CycleRules) -> CycleHole | None:
    """Return the hole that begins with move i, or None where the control has no cycle that moves like it.

    A hole is a rapid over it, a rapid down to R, feeds down marked as drilling, and a rapid up to R or to the height
    before it, which is where its row began too; with pecks, there are the rapids between that `DrillingWords` tells of.
    What is there already, the place or R, needs no rapid.

    Args:
        moves: the program's.
        i: index of a move.
        height: Z before move i, count of the last decimal.
        rules: what the control has.
    """
    feed = _first_feed(moves, i, height)
    last = _last_feed(moves, feed) if feed else None
    if not feed or not last or not rules.words.drill:
        return None
    operation = moves.operation[feed]
    taps = operation in rules.taps
    stop = last + 1 if taps and not rules.words.tap_to_initial else last + 2
    x, y, first = moves.end[feed]
    r = moves.end[feed - 1][2]
    done = [(moves.kind[k], moves.end[k][2]) for k in range(feed, stop)]
    bottom, clear = min(z for _, z in done), done[-1][1]
    level = {height: rules.words.to_initial, r: rules.words.to_r}.get(clear, "")
    wait, tap = rules.wait(operation), rules.words.tap_left if operation in rules.left else rules.words.tap
    one_go, peck = [(MoveKind.LINE, bottom), (MoveKind.RAPID, clear)], r - first
    out, up = (islice(_steps((r, peck, bottom), rules, by_r), len(done)) for by_r in (True, False))
    fed_out = [(MoveKind.LINE, bottom), (MoveKind.LINE, r), (MoveKind.RAPID, clear)][: stop - feed]
    ways = (
        (rules.words.dwell if wait else rules.words.drill, one_go, 0),
        ("" if wait else rules.words.peck, [*out, *one_go], peck),
        ("" if wait else rules.words.chip_break, [*up, *one_go], peck),
        (tap if taps else "" if wait else rules.words.feed_out, fed_out, 0),
    )
    for word, steps, q in ways:
        if word and level and _alike(steps, done, rules.near):
            pause = f"P{wait.rpartition('P')[2]}" if wait else ""
            start, rate = rules.taps.get(operation, ""), rules.rates.get(operation, "")
            return CycleHole(
                cycle=f"{level} {word}",
                x=x,
                y=y,
                z=bottom,
                r=r,
                peck=q,
                feed=moves.feed[feed],
                stop=stop,
                dwell=pause,
                start=start,
                rate=rate,
            )
    return None


def waits_of(moves: WorkMoves, rules: CycleRules, holes: Mapping[int, CycleHole]) -> dict[int, str]:
    """Return the blocks of waits at the bottom of holes that no cycle makes, by the index of the move that follows."""
    if not rules.dwells:
        return {}
    inside = {k for first, hole in holes.items() for k in range(first, hole.stop)}
    lines = np.flatnonzero((moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)).tolist()
    found = {}
    for k, following in pairwise([*lines, len(moves)]):
        deeper = following < len(moves) and moves.lists.end[following][:2] == moves.lists.end[k][:2]
        wait = rules.wait(moves.lists.operation[k])
        if wait and k not in inside and not deeper and k + 1 < len(moves):
            found[k + 1] = wait
    return found


def untapped(moves: WorkMoves, rules: CycleRules, holes: Mapping[int, CycleHole]) -> bool:
    """Tell whether a move of a tap is in no tapping cycle, so that the spindle would not turn back."""
    tapping = np.isin(moves.operation, list(rules.taps)) & (moves.kind == MoveKind.LINE)
    for first, hole in holes.items():
        tapping[first : hole.stop] = False
    return bool(tapping.any())


def _first_feed(moves: MoveLists, i: int, height: int) -> int | None:
    """Return the index of the feed behind the rapids over a hole and down to R, which begin with move i."""
    for k in range(i, min(i + 3, len(moves) - 1)):
        z = moves.end[k][2]
        if z > height or _belonging(moves, k) != _belonging(moves, i):
            return None
        if k > i and moves.kind[k] is MoveKind.LINE:
            return k if z < height else None
        if moves.kind[k] is not MoveKind.RAPID:
            return None
        height = z
    return None


def _last_feed(moves: MoveLists, feed: int) -> int | None:
    """Return the index of the last feed that drills the hole and has a move of the hole behind it; None where there is
    none.
    """
    last = None
    for k in range(feed, len(moves) - 1):
        if any(_belonging(moves, j) != _belonging(moves, feed) for j in (k, k + 1)):
            break
        if moves.kind[k] is MoveKind.LINE:
            if moves.purpose[k] != Purpose.DRILL or moves.feed[k] != moves.feed[feed]:
                break
            last = k
    return last


def _belonging(moves: MoveLists, k: int) -> tuple[int, ...]:
    """Return place, tool and operation of a move."""
    return (*moves.end[k][:2], moves.tool[k], moves.operation[k])


def _steps(depths: tuple[int, int, int], rules: CycleRules, by_r: bool) -> Iterator[Step]:
    """Yield what a control does before the last feed, given R, Q and bottom; heights added up as it adds them up.

    Args:
        depths: R, Q and bottom, counts of the last decimal.
        rules: its gaps.
        by_r: up to R after each step, and down again; else only a little up.
    """
    r, peck, bottom = (count / rules.scale for count in depths)
    gap = rules.peck_gap if by_r else rules.chip_gap
    height = r - peck
    while height > bottom:
        count = round(height * rules.scale)
        yield MoveKind.LINE, count
        if by_r:
            yield MoveKind.RAPID, depths[0]
        yield MoveKind.RAPID, count + gap
        height -= peck


def _alike(steps: list[Step], done: list[Step], near: int) -> bool:
    """Tell whether two sequences are the same but for the rounding of heights; where they end is that of both."""
    return len(steps) == len(done) and all(
        a is b and abs(z - w) <= near for (a, z), (b, w) in zip(steps, done, strict=True)
    )
