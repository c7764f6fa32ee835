"""One line of the drawing language, split into words and read from left to right."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby

from app.edit.errors import CommandError
from app.edit.numbers import angle, length, number_text
from app.model.curves import Point

_RANGE = re.compile(r"([0-9]{1,9})(?:-([0-9]{1,9}))?")
_LARGEST_RANGE = 1_000_000
_WORD = re.compile(r'"[^"]*"(?=\s|$)|\S+')


@dataclass(frozen=True, slots=True)
class Word:
    """A word and where it begins.

    Attributes:
        column: 1-based.
    """

    text: str
    column: int


def read_point(text: str, base: Point, column: int = 1) -> Point:
    """Return the point that `x,y`, `@dx,dy` or `@r<angle` (degrees) names, mm.

    Args:
        base: where relative coordinates start from, mm.

    Raises:
        CommandError: the text is no point.
    """
    relative = text.startswith("@")
    body, first = (text[1:], column + 1) if relative else (text, column)
    if relative and "<" in body:
        r, _, turn = body.partition("<")
        radius, direction = length(r, first), math.radians(angle(turn, first + len(r) + 1))
        return (base[0] + radius * math.cos(direction), base[1] + radius * math.sin(direction))
    x, comma, y = body.partition(",")
    if not comma:
        raise CommandError(f"'{text}' is no point; write x,y such as 10,20, or @dx,dy, or @r<angle.", column)
    dx, dy = length(x, first), length(y, first + len(x) + 1)
    return (base[0] + dx, base[1] + dy) if relative else (dx, dy)


def point_text(point: Point) -> str:
    """Return the text that `read_point` reads back as exactly this point."""
    return f"{number_text(point[0])},{number_text(point[1])}"


def ids_text(ids: Iterable[int]) -> str:
    """Return entity numbers as `Words.ids` reads them back, neighbours as ranges."""
    ordered = sorted(ids)
    runs = [[i for _, i in run] for _, run in groupby(enumerate(ordered), key=lambda pair: pair[1] - pair[0])]
    return " ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


class Words:
    """A reading position in one line.

    Attributes:
        last: the point read last; relative points start from it.
    """

    def __init__(self, line: str, last: Point = (0.0, 0.0)) -> None:
        """Begin at the first word; `last` is what a relative first point starts from, mm."""
        self._words = [Word(m.group(), m.start() + 1) for m in _WORD.finditer(line)]
        self._at = 0
        self._end = len(line.rstrip()) + 1
        self.last = last

    @property
    def more(self) -> bool:
        """True while there are words to read."""
        return self._at < len(self._words)

    @property
    def column(self) -> int:
        """Column of the next word, or one past the end of the line."""
        return self._words[self._at].column if self.more else self._end

    def take(self, expected: str) -> Word:
        """Return the next word and step over it.

        Raises:
            CommandError: the line ends; `expected` says what was wanted.
        """
        if not self.more:
            raise CommandError(f"The line ends too early; {expected} is expected.", self.column)
        self._at += 1
        return self._words[self._at - 1]

    def accept(self, *words: str) -> str:
        """Step over the next word when it is one of these, and return it in lower case; else return ""."""
        if self.more and (word := self._words[self._at].text.lower()) in words:
            self._at += 1
            return word
        return ""

    def point(self, expected: str = "a point x,y") -> Point:
        """Read one point; it becomes the base of the next relative one."""
        word = self.take(expected)
        self.last = read_point(word.text, self.last, word.column)
        return self.last

    def points(self) -> list[Point]:
        """Read points for as long as the next word begins like one."""
        found = []
        while self.more and self._words[self._at].text[0] in "@+-.(0123456789":
            found.append(self.point())
        return found

    def length(self, expected: str) -> float:
        """Read one length, mm."""
        word = self.take(expected)
        return length(word.text, word.column)

    def name(self, expected: str) -> str:
        """Read a name; one with spaces stands in double quotes."""
        return self.take(expected).text.strip('"')

    def ids(self) -> tuple[int, ...]:
        """Read entity numbers and ranges such as 4-17 to the end of the line."""
        found: list[int] = []
        while self.more:
            word = self.take("an entity number")
            match = _RANGE.fullmatch(word.text)
            first, last = (int(match[1]), int(match[2] or match[1])) if match else (0, -1)
            if not 0 <= last - first < _LARGEST_RANGE:
                raise CommandError(f"'{word.text}' is no entity number; write numbers such as 4 7 12-20.", word.column)
            found.extend(range(first, last + 1))
        return tuple(dict.fromkeys(found))

    def end(self) -> None:
        """Check that nothing follows.

        Raises:
            CommandError: there are words left.
        """
        if self.more:
            raise CommandError(f"'{self._words[self._at].text}' is not expected here; the command is complete before it.", self.column)
