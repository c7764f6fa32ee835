"""The arguments of one command, read from left to right."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from ...model.curves import Curve, Point
from . import syntax as s
from .effort import Effort
from .errors import CommandError
from .evaluate import length_of, number_of, point_of, value_of
from .units import ANGLE_UNITS, LENGTH_UNITS
from .values import Curves, Scope, kind_of, wrong
from .words import number_text

_RANGE = re.compile(r"([0-9]{1,9})(?:-([0-9]{1,9}))?")
_LARGEST_RANGE = 1_000_000
"""Numbers of curves that one range may name."""


class Arguments:
    """A reading position among the arguments of a command."""

    def __init__(self, command: s.Command, scope: Scope, effort: Effort | None = None) -> None:
        """Begin at the first argument; work on curves is counted as an effort."""
        self._command, self._scope = command, replace(scope, units=LENGTH_UNITS)
        self._at, self._effort = 0, effort or Effort()

    @property
    def last(self) -> Point:
        """The point read last, mm; relative points start from it."""
        return self._scope.last

    @last.setter
    def last(self, point: Point) -> None:
        self._scope = replace(self._scope, last=point)

    @property
    def more(self) -> bool:
        """True while there are arguments to read."""
        return self._at < len(self._command.arguments)

    @property
    def place(self) -> s.TextSpan:
        """Where the next argument stands, or the end of the command."""
        if self.more:
            return self._command.arguments[self._at].place
        whole, size = self._command.place, len(self._command.text)
        return s.TextSpan(whole.line, whole.column + size, whole.end, whole.end)

    def wrong(self, reason: str) -> CommandError:
        """Return the error that the next argument is wrong."""
        return wrong(reason, self.place)

    def takes(self, curves: Iterable[Curve], share: float = 1.0) -> None:
        """Count curves that the command is about to take apart, or to look at for a share of what that costs.

        Raises:
            CommandError: the text repeats too much of that.
        """
        self._effort.taken(curves, share, self._command.place)

    def accept(self, *words: str) -> str:
        """Step over the next argument when it is one of these words, and return it in lower case; else return ""."""
        if (
            self.more
            and isinstance(name := self._command.arguments[self._at], s.Name)
            and (word := name.text.lower()) in words
        ):
            self._at += 1
            return word
        return ""

    def point(self, expected: str = "a point x,y") -> Point:
        """Read one point; it becomes the base of the next relative one."""
        self.last = point_of(self._next(expected), self._scope)
        return self.last

    def points(self) -> list[Point]:
        """Read points for as long as the next argument is no word of the command."""
        found = []
        while self.more and not self._is_word():
            found.append(self.point())
        return found

    def is_point(self) -> bool:
        """Return whether the next argument is a point."""
        if not self.more or self._is_word():
            return False
        scope = replace(self._scope, units={**LENGTH_UNITS, **ANGLE_UNITS})
        return isinstance(value_of(self._command.arguments[self._at], scope), tuple)

    def shift(self, expected: str) -> Point:
        """Read a shift @dx,dy or @r<angle, mm."""
        word = self._next(expected)
        if not isinstance(word, s.Coordinates) or word.frame not in (
            s.CoordinateMode.FROM_LAST,
            s.CoordinateMode.POLAR_FROM_LAST,
        ):
            raise wrong(f"'{self._text_of(word)}' is no shift; write @dx,dy or @r<angle.", word.place)
        return point_of(word, replace(self._scope, last=(0.0, 0.0)))

    def length(self, expected: str) -> float:
        """Read one length, mm."""
        return float(length_of(self._next(expected), self._scope))

    def angle(self, expected: str) -> float:
        """Read one angle, degrees."""
        return number_of(self._next(expected), replace(self._scope, units=ANGLE_UNITS))

    def number(self, expected: str) -> float:
        """Read a plain number."""
        return number_of(self._next(expected), replace(self._scope, units={}))

    def numbers(self) -> list[float]:
        """Read plain numbers for as long as the next argument is no word of the command."""
        found = []
        while self.more and not self._is_word():
            found.append(self.number("a number"))
        return found

    def count(self, expected: str, low: int, high: int) -> int:
        """Read a whole number in a range, ends included."""
        place = self.place
        value = number_of(self._next(expected), replace(self._scope, units={}))
        if value != int(value) or not low <= value <= high:
            raise wrong(f"This is {number_text(value)}; {expected} is a whole number from {low} to {high}.", place)
        return int(value)

    def name(self, expected: str) -> str:
        """Read a name; one with blanks or signs stands in double quotes."""
        word = self._next(expected)
        return word.text if isinstance(word, s.QuotedText) else self._text_of(word)

    def curve(self, expected: str) -> tuple[int, Curve]:
        """Read one entity by number or by name; return its number and its curve."""
        place, ids = self.place, self._ids(self._next(expected))
        return ids[0], self._scope.curve(Curves(ids), place)

    def some(self, expected: str) -> tuple[int, ...]:
        """Read one argument that stands for entities: a number, a range or a name."""
        return self._ids(self._next(expected))

    def ids(self) -> tuple[int, ...]:
        """Read entity numbers, ranges such as 4-17, and names of curves to the end or to a word of the command."""
        found: list[int] = []
        while self.more and not self._is_word():
            found.extend(self.some("an entity number"))
        return tuple(dict.fromkeys(found))

    def end(self) -> None:
        """Check that nothing follows.

        Raises:
            CommandError: there are arguments left.
        """
        if self.more:
            left = self._command.arguments[self._at]
            raise wrong(f"'{self._text_of(left)}' is not expected here; the command is complete before it.", left.place)

    def _next(self, expected: str) -> s.Expression:
        if not self.more:
            raise self.wrong(f"The line ends too early; {expected} is expected.")
        self._at += 1
        return self._command.arguments[self._at - 1]

    def _text_of(self, expression: s.Expression) -> str:
        first = self._command.place.start
        return self._command.text[expression.place.start - first : expression.place.end - first]

    def _is_word(self) -> bool:
        """Return whether the next argument is a word that stands for nothing: one of the command's own."""
        name = self._command.arguments[self._at]
        return isinstance(name, s.Name) and name.text not in (self._scope.names or {})

    def _ids(self, word: s.Expression) -> tuple[int, ...]:
        if isinstance(word, s.Name):
            value = value_of(word, self._scope)
            if not isinstance(value, Curves):
                raise wrong(f"'{word.text}' is {kind_of(value)}; a curve or its number is wanted.", word.place)
            return value.ids
        match = _RANGE.fullmatch(self._text_of(word))
        first, last = (int(match[1]), int(match[2] or match[1])) if match else (0, -1)
        if not 0 <= last - first < _LARGEST_RANGE:
            raise wrong(f"'{self._text_of(word)}' is no entity number; write numbers such as 4 7 12-20.", word.place)
        return tuple(range(first, last + 1))
