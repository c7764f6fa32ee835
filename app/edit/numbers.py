"""Numbers as people type them: arithmetic and units, read by a small parser of our own."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from app.edit.errors import CommandError

LENGTH_UNITS: Mapping[str, float] = {
    "mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "µm": 1e-3,
    "in": 25.4, '"': 25.4, "ft": 304.8, "thou": 0.0254, "mil": 0.0254,
}
"""Size of each length unit, mm."""

ANGLE_UNITS: Mapping[str, float] = {"deg": 1.0, "°": 1.0, "rad": 180.0 / math.pi}
"""Size of each angle unit, degrees."""

_LARGEST = 1e7
_DEEPEST = 40
_TOKEN = re.compile(r"""\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<unit>[^\W\d_]+|["°])|(?P<sign>[-+*/()]))""")


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    text: str
    column: int


def length(text: str, column: int = 1) -> float:
    """Return the length that a text such as `12.5`, `1in + 8mm`, `1/4in` or `(3+4)*2` states, mm.

    A number without a unit counts in mm; a unit right after a fraction of whole numbers belongs to the fraction.

    Args:
        text: what was typed.
        column: column of its first character in the whole line, for the error.

    Raises:
        CommandError: not a number, an unknown unit, a division by zero, or beyond 10 km.
    """
    return _Reader(text, column, LENGTH_UNITS).value()


def angle(text: str, column: int = 1) -> float:
    """Return the angle that a text such as `45`, `180/7` or `0.5rad` states, degrees.

    Raises:
        CommandError: as for `length`.
    """
    return _Reader(text, column, ANGLE_UNITS).value()


def number_text(value: float) -> str:
    """Return the shortest text that `length` reads back as exactly this value."""
    text = repr(float(value))
    return text.removesuffix(".0") if text != "-0.0" else "0"


def _tokens(text: str, column: int) -> list[_Token]:
    found, at = [], 0
    end = len(text.rstrip())
    while at < end:
        match = _TOKEN.match(text, at)
        if match is None or match.lastgroup is None:
            bad = at + len(text[at:]) - len(text[at:].lstrip())
            raise CommandError(f"'{text[bad]}' is no part of a number; write a number such as 12.5 or 1in+8mm.", column + bad)
        found.append(_Token(match.lastgroup, match[match.lastgroup], column + match.start(match.lastgroup)))
        at = match.end()
    return found


class _Reader:
    """Recursive descent over sums, products and signed factors."""

    def __init__(self, text: str, column: int, units: Mapping[str, float]) -> None:
        self._text, self._units, self._column = text, units, column
        self._tokens = _tokens(text, column)
        self._at = 0

    def value(self) -> float:
        """Return the value of the whole text."""
        value = self._sum(0)
        if self._at < len(self._tokens):
            raise CommandError(f"'{self._tokens[self._at].text}' is not expected here; the number ends before it.", self._here())
        if not abs(value) <= _LARGEST:
            raise CommandError(f"'{self._text}' is too large; lengths go up to 10 000 000 mm.", self._column)
        return value

    def _here(self) -> int:
        return self._tokens[self._at].column if self._at < len(self._tokens) else self._column + len(self._text)

    def _peek(self, ahead: int = 0) -> _Token:
        at = self._at + ahead
        return self._tokens[at] if at < len(self._tokens) else _Token("end", "", self._column + len(self._text))

    def _sum(self, depth: int) -> float:
        value = self._product(depth)
        while self._peek().text in ("+", "-"):
            sign = 1.0 if self._peek().text == "+" else -1.0
            self._at += 1
            value += sign * self._product(depth)
        return value

    def _product(self, depth: int) -> float:
        value = self._factor(depth)
        while (operator := self._peek()).text in ("*", "/"):
            self._at += 1
            factor = self._factor(depth)
            if operator.text == "/" and factor == 0:
                raise CommandError("Division by zero; write another divisor.", operator.column)
            value = value * factor if operator.text == "*" else value / factor
        return value

    def _factor(self, depth: int) -> float:
        if depth > _DEEPEST:
            raise CommandError("Too many brackets or signs; write the number more simply.", self._here())
        token = self._peek()
        self._at += 1
        if token.text in ("+", "-"):
            return self._factor(depth + 1) * (1.0 if token.text == "+" else -1.0)
        if token.text == "(":
            value = self._sum(depth + 1)
            if self._peek().text != ")":
                raise CommandError("A closing bracket is missing; add ')'.", self._here())
            self._at += 1
            return value * self._unit()
        if token.kind != "number":
            found = f"'{token.text}' is no number" if token.text else "The number ends too early"
            raise CommandError(f"{found}; write a number such as 12.5 or 1in+8mm.", token.column)
        return self._fraction(float(token.text)) * self._unit()

    def _fraction(self, value: float) -> float:
        """Read on when the number is the upper half of a fraction with a unit, such as 1/4in."""
        bar, below, unit = self._peek(), self._peek(1), self._peek(2)
        if bar.text != "/" or below.kind != "number" or unit.kind != "unit" or float(below.text) == 0:
            return value
        self._at += 2
        return value / float(below.text)

    def _unit(self) -> float:
        token = self._peek()
        if token.kind != "unit":
            return 1.0
        if token.text not in self._units:
            raise CommandError(f"'{token.text}' is no unit; use one of {', '.join(self._units)}.", token.column)
        self._at += 1
        return self._units[token.text]
