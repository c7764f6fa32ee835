"""Where the program can go on: its O words and N words, found once in the whole text."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from .program import BlockFault
from .text import ProgramBuffer, code_of

KEYWORDS = (
    "sub",
    "endsub",
    "return",
    "call",
    "do",
    "while",
    "endwhile",
    "if",
    "elseif",
    "else",
    "endif",
    "repeat",
    "endrepeat",
    "break",
    "continue",
)

_SPACED = "|".join(r"[ \t]*".join(word) for word in sorted(KEYWORDS, key=len, reverse=True))
"""The keywords with blanks between their letters, which a control skips: "end sub"."""


@cache
def _o_line() -> re.Pattern[bytes]:
    """Return what a line with an O word looks like, compiled for the first program that jumps."""
    line = (
        rb"^[ \t]*(?:/[ \t]*)?(?:n[ \t]*[0-9.]+[ \t]*)?[o:][ \t]*(<[^>\n]{1,200}>|[0-9](?:[ \t]*[0-9]){0,8})[ \t]*(%s)?"
    )
    return re.compile(line % _SPACED.encode(), re.IGNORECASE | re.MULTILINE)


_N_LINE = re.compile(rb"^[ \t]*(?:/[ \t]*)?n[ \t]*([0-9]{1,9})(?![0-9.])", re.IGNORECASE | re.MULTILINE)
_DO_END = re.compile(
    rb"^[ \t]*(?:n[ \t]*[0-9]+[ \t]*)?(?:while[^\n(]*\]do|(end))[ \t]*([0-9])", re.IGNORECASE | re.MULTILINE
)


MOST_PLACES = 500_000
"""O and N words that are looked up; more would fill the memory."""
_LINE_END = 10
"""The byte that ends a line."""


@dataclass(frozen=True, slots=True)
class Cursor:
    """The beginning of a line: its offset in the text and its 1-based number."""

    offset: int
    line: int


@dataclass(frozen=True, slots=True)
class Statement:
    """An O word: where it stands, where the line behind it begins, its label, its keyword ("" = none)."""

    at: Cursor
    label: str
    keyword: str


class _LoopBound(NamedTuple):
    """A line with DO n or END n: whether it is an end, and n."""

    at: Cursor
    ends: bool
    number: int


class _MatchInLine(NamedTuple):
    """A match, and the number of its line."""

    match: re.Match[bytes]
    line: int


class JumpTargets:
    """Finds places of a text; each index is made when it is first asked."""

    def __init__(self, text: ProgramBuffer) -> None:
        """Look into a text."""
        self._text, self._end = text, len(text.data)
        self._closed = self._end
        self._by_label: dict[str, list[Statement]] | None = None
        self._numbers: dict[int, list[Cursor]] | None = None
        self._loops: list[_LoopBound] | None = None
        self._subroutines: list[Statement] | None = None
        self._begins: list[int] | None = None
        self._long: list[Cursor] | None = None

    def end_at(self, offset: int, beyond: bool = False) -> None:
        """Take note of a program's closing per cent sign.

        Args:
            offset: where it stands. beyond: programs behind it can be called; else no control reads what stands there.
        """
        self._closed = offset
        self._end = len(self._text.data) if beyond else offset

    def is_behind_the_end(self, at: Cursor) -> bool:
        """Tell whether a line stands behind the closing per cent sign."""
        return at.offset > self._closed

    def after(self, at: Cursor) -> Cursor:
        """Return the line behind the one at a place."""
        return Cursor(self._text.line_end(at.offset) + 1, at.line + 1)

    def code(self, at: Cursor, nested: bool) -> str:
        """Return what the control obeys of the line at a place; `nested` as `text.code_of` has it."""
        return code_of(self._text.line(at.offset), nested)

    def codes_between(self, begin: Cursor, end: Cursor, nested: bool) -> Iterator[str]:
        """Yield what the control obeys of the lines between two, both excluded.

        Raises:
            Fault: a line has a comment without end.
        """
        at = self.after(begin)
        while at.offset < end.offset:
            yield self.code(at, nested)
            at = self.after(at)

    def next_of(self, label: str, keywords: tuple[str, ...], behind: int) -> Statement | None:
        """Return the first statement of a label with one of the keywords behind an offset."""
        statements = self._statements(label)
        first = bisect_right(statements, behind, key=lambda statement: statement.at.offset)
        return next((statements[i] for i in range(first, len(statements)) if statements[i].keyword in keywords), None)

    def subroutine(self, label: str) -> Statement | None:
        """Return where a subroutine begins: an O word with sub, or with nothing (a program number)."""
        return next((each for each in self._statements(label) if each.keyword in ("sub", "")), None)

    def subroutine_between(self, begin: int, end: int) -> Statement | None:
        """Return the first sub between two offsets, both excluded."""
        if self._subroutines is None:
            self._statements("")
            subs = (each for own in (self._by_label or {}).values() for each in own if each.keyword == "sub")
            self._subroutines = sorted(subs, key=lambda each: each.at.offset)
        first = bisect_right(self._subroutines, begin, key=lambda each: each.at.offset)
        found = next(iter(self._subroutines[first : first + 1]), None)
        return found if found is not None and found.at.offset < end else None

    def too_long(self, begin: int, end: int, longest: int) -> Cursor | None:
        """Return the first line between two offsets, the first one of which begins a line, that has more bytes than a
        control reads.

        Args:
            begin, end: offsets, the latter excluded.
            longest: bytes without the line's end, always the same.
        """
        if self._long is None:
            ends = np.flatnonzero(np.frombuffer(self._text.data, np.uint8) == _LINE_END)
            begins = np.concatenate([[0], ends[:-1] + 1])
            lines = np.flatnonzero(ends - begins > longest)
            self._long = [
                Cursor(offset, line + 1) for offset, line in zip(begins[lines].tolist(), lines.tolist(), strict=True)
            ]
        first = bisect_left(self._long, begin, key=lambda line: line.offset)
        found = next(iter(self._long[first : first + 1]), None)
        return found if found is not None and found.offset < end else None

    def number(self, number: int, at: int) -> Cursor | None:
        """Return the line with an N word in the program that holds an offset: the first one behind that, else its
        first.
        """
        if self._numbers is None:
            self._numbers = {}
            for found, line in self._found(_N_LINE):
                self._numbers.setdefault(int(found[1]), []).append(Cursor(found.start(), line))
        begin, end = self._program_round(at)
        lines = self._numbers.get(number, [])
        own = lines[bisect_left(lines, begin, key=_offset) : bisect_left(lines, end, key=_offset)]
        first = bisect_right(own, at, key=_offset)
        return own[first if first < len(own) else 0] if own else None

    def _program_round(self, at: int) -> tuple[int, int]:
        """Return the offsets between which the program lies that holds one: from its number to the next one's."""
        if self._begins is None:
            self._statements("")
            every = (each for own in (self._by_label or {}).values() for each in own)
            self._begins = sorted(each.at.offset for each in every if not each.keyword)
        next_one = bisect_right(self._begins, at)
        begin = self._begins[next_one - 1] if next_one else 0
        return begin, self._begins[next_one] if next_one < len(self._begins) else self._end

    def uncalled(self, behind: Cursor) -> tuple[Statement, ...]:
        """Return the programs behind a line that no P word of the whole text names, in their order."""
        if _o_line().search(self._text.data, behind.offset, self._end) is None:
            return ()
        self._statements("")
        every = [each for own in (self._by_label or {}).values() for each in own]
        later = (each for each in every if each.at.offset > behind.offset and not each.keyword)
        return tuple(sorted((each for each in later if not self._names(each.label)), key=lambda each: each.at.offset))

    def _names(self, label: str) -> bool:
        called = re.compile(rb"p[ \t]*[0-9]*%s(?![0-9])|p[ \t]*[#\[]" % label.encode(), re.IGNORECASE)
        return called.search(self._text.data) is not None

    def loop_end(self, number: int, behind: int) -> Cursor | None:
        """Return the line with END n that belongs to the WHILE ... DO n at an offset."""
        if self._loops is None:
            self._loops = [
                _LoopBound(Cursor(found.start(), line), found[1] is not None, int(found[2]))
                for found, line in self._found(_DO_END)
            ]
        first = bisect_right(self._loops, behind, key=lambda loop: loop.at.offset)
        return next(
            (
                at
                for at, ends, its in (self._loops[i] for i in range(first, len(self._loops)))
                if ends and its == number
            ),
            None,
        )

    def _statements(self, label: str) -> list[Statement]:
        if self._by_label is None:
            self._by_label = {}
            for found, line in self._found(_o_line()):
                name = label_of(found[1].decode(self._text.encoding, "replace"))
                keyword = "".join((found[2] or b"").decode().lower().split())
                self._by_label.setdefault(name, []).append(Statement(Cursor(found.start(), line), name, keyword))
        return self._by_label.get(label, [])

    def _found(self, pattern: re.Pattern[bytes]) -> Iterator[_MatchInLine]:
        """Yield every match.

        Raises:
            Fault: there are more than any program has.
        """
        data, line, counted = self._text.data, 1, 0
        for index, match in enumerate(pattern.finditer(data, 0, self._end)):
            if index >= MOST_PLACES:
                raise BlockFault(f"the program has more than {MOST_PLACES} places to go on at; the reader stops here.")
            line += data.count(b"\n", counted, match.start())
            counted = match.start()
            yield _MatchInLine(match, line)


def _offset(at: Cursor) -> int:
    return at.offset


def label_of(text: str) -> str:
    """Return an O word's label in one spelling: "100", "<name>"."""
    plain = "".join(text.split()).lower()
    return str(int(plain)) if plain.isdigit() else plain
