"""Fields in the words of a text: expressions and the date, in braces."""

from __future__ import annotations

import re
from datetime import date

from ..expressions.errors import CommandError
from ..expressions.evaluate import number_of
from ..expressions.grammar import read_value
from ..expressions.syntax import TextSpan
from ..expressions.values import Length, Scope, wrong
from ..expressions.words import number_text

DATE = "date"
"""The field that is the day on which the text is carried out, as 2026-03-08."""

_PARTS = re.compile(r"\{\{|\}\}|\{([^{}:]*)(?::(\d{1,2})?(?:\.(\d))?)?\}|[{}]|[^{}]+")
_FINEST = 6
"""Decimals of a number that is written without a format."""


def with_fields(words: str, place: TextSpan, scope: Scope) -> str:
    """Return words with every field in braces written out.

    `{k + 1}` is the shortest way to write a number, `{k + 1:3}` one with three digits or more before its point,
    `{w:.2}` one with two behind it; lengths are in the unit of plain numbers. `{date}` is today. Doubled braces are
    braces.

    Args:
        words: as they stand between the quotes. place: of those, with the quotes.

    Raises:
        CommandError: a field cannot be read, with the place of what is wrong in it.
    """
    return "".join(_written(part, place, scope) for part in _PARTS.finditer(words))


def _written(part: re.Match[str], place: TextSpan, scope: Scope) -> str:
    text = part[0]
    if text in ("{{", "}}"):
        return text[0]
    column = place.column + 1 + part.start()
    if text in ("{", "}"):
        raise CommandError(
            f"A field is written {{k + 1}}, {{k + 1:3}} or {{w:.2}}; a brace itself is written {2 * text}.",
            column,
            place.line,
        )
    if not text.startswith("{"):
        return text
    if not part[1].strip():
        raise wrong("A field is empty; write a number such as {k + 1}, or {date}.", place)
    if part[1].strip().lower() == DATE and DATE not in (scope.names or {}):
        return date.today().isoformat()
    return _number(part, column, place.line, scope)


def _number(part: re.Match[str], column: int, line: int, scope: Scope) -> str:
    try:
        value = number_of(read_value(part[1]), scope)
    except CommandError as error:  # counted from the field's own beginning
        raise CommandError(error.reason, column + error.column, line) from None
    if isinstance(value, Length):
        value /= scope.plain
    digits, decimals = part[2], part[3]
    if digits is None and decimals is None:
        return number_text(round(value, _FINEST))
    behind = int(decimals or 0)
    wide = int(digits or 1) + (behind + 1 if behind else 0) + (value < 0)
    return f"{value:0{wide}.{behind}f}"
