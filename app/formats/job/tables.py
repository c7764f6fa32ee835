"""Tables of a job file: keys are taken one by one, and every mistake names the line of its key."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, TypeVar

from ...core.errors import HitofudeError, InputError
from ...core.toml_tables import QUOTED, Keyword, brief, known_words
from ...core.wording import either
from ...model.curve_selectors import Selector, read_selectors
from ...model.fields import ParameterPlace, Unit
from ...model.tool import FeedRow

Value = TypeVar("Value")
_MISSING = object()
_LARGEST = 1e15
"""Of a number: larger ones lose their decimals."""


@dataclass(frozen=True)
class JobText:
    """A job file's text, for the lines of its keys.

    Attributes:
        name: of the file, shown in errors.
        lines: its text.
    """

    name: str
    lines: tuple[str, ...]

    def line(self, path: str, index: int, key: str) -> int:
        """Return the 1-based line of a key in the index-th table of this path, or of its header."""
        current, count, header = "", -1, 1
        for number, text in enumerate(self.lines, 1):
            if match := re.match(r"\s*\[+\s*([\w.\"-]+)\s*\]+", text):
                current = match[1]
                count += current == path
                if current == path and count == index:
                    header = number
            elif (
                current == path
                and (not path or count == index)
                and re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*=", text)
            ):
                return number
        return header if path else next((n for n, text in enumerate(self.lines, 1) if key in text), 1)

    def built(self, path: str, index: int, build: Callable[[], Value]) -> Value:
        """Return a value built from a table; a value out of its range names the table's line."""
        try:
            return build()
        except InputError:
            raise
        except HitofudeError as error:
            raise InputError(f"{self.name}:{self.line(path, index, '')}: {error}") from error


@dataclass
class JobTable:
    """One table of a job file: its keys are taken one by one, and what is left over is an error.

    Attributes:
        path, index: its name, and which of several of that name it is, from 0.
        values: by key; those that are taken go away.
        taken: what was read, by the names that it is asked for under.
    """

    text: JobText
    path: str
    index: int
    values: dict[str, Any]
    taken: dict[str, Any] = field(default_factory=dict)

    def error(self, key: str, text: str) -> InputError:
        """Return an error at the line of a key."""
        return InputError(f"{self.text.name}:{self.text.line(self.path, self.index, key)}: {brief(key, QUOTED)} {text}")

    def take(self, key: str, read: Callable[[Any], Any], target: str = "") -> None:
        """Read a key, where the table has it, into `taken`."""
        value = self.values.pop(key, _MISSING)
        if value is _MISSING:
            return
        try:
            self.taken[target or key] = read(value)
        except (InputError, TypeError, ValueError) as error:
            raise self.error(key, f"is {_shown(value)}: {error}") from error

    def done(self, known: str) -> None:
        """Complain about keys that nobody took."""
        for key in self.values:
            raise self.error(
                key, f"is no key of [{self.path or 'the file'}]; use {known_words(key, known.split(', '))}"
            )


def _shown(value: object) -> str:
    if isinstance(value, str):
        return f"'{brief(value, QUOTED)}'"
    return str(value).lower() if isinstance(value, bool) else brief(f"{value}", QUOTED)


def one_of(text: str, choices: Mapping[str, Value], what: str) -> Value:
    """Return what a word stands for.

    Raises:
        InputError: the word is none of the choices; it names them.
    """
    try:
        return {word.lower(): value for word, value in choices.items()}[text.strip().lower()]
    except KeyError as error:
        raise InputError(f"'{brief(text, QUOTED)}' is no {what}; use {either(choices)}") from error


def read_number(value: Any) -> float:
    """Return a number.

    Raises:
        InputError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError("it must be a number, in mm, mm/min or rpm")
    if not abs(value) <= _LARGEST:
        raise InputError(f"it must be a number up to {_LARGEST:g}")
    return float(value)


def read_whole(value: Any) -> int:
    """Return a whole number.

    Raises:
        InputError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError("it must be a whole number")
    return value


def read_flag(value: Any) -> bool:
    """Return true or false.

    Raises:
        InputError: it is neither.
    """
    if not isinstance(value, bool):
        raise InputError("it must be true or false")
    return value


def read_text(value: Any) -> str:
    """Return a text.

    Raises:
        InputError: it is none.
    """
    if not isinstance(value, str):
        raise InputError("it must be a text in quotes")
    return value


def read_texts(value: Any) -> tuple[str, ...]:
    """Return a list of texts.

    Raises:
        InputError: it is none.
    """
    if not isinstance(value, list):
        raise InputError('it must be a list of texts, such as ["outline"]')
    return tuple(read_text(item) for item in value)


def read_share(value: Any) -> float:
    """Return a share of a whole: 0.4, or "40%".

    Raises:
        InputError: it is neither.
    """
    if isinstance(value, str):
        match = re.fullmatch(r"\s*(\d{1,3}(?:\.\d{1,9})?)\s*%\s*", value)
        if match is None:
            raise InputError('it must be a share such as 0.4 or "40%"')
        return float(match[1]) / 100
    return read_number(value)


def read_points(value: Any) -> tuple[tuple[float, float], ...]:
    """Return points of the plane.

    Raises:
        InputError: it is no list of pairs of numbers.
    """
    if not isinstance(value, list) or not all(isinstance(each, list) and len(each) == 2 for each in value):
        raise InputError("it must be a list of points, such as [[10, 0], [50, 0]]")
    return tuple((read_number(x), read_number(y)) for x, y in value)


def read_holder(value: Any) -> tuple[tuple[float, float], ...]:
    """Return the outline of a holder: by its points, height and radius, or by its name.

    Raises:
        InputError: it is neither.
    """
    if not isinstance(value, str):
        return read_points(value)
    from ..tools.holders import outline_of  # few jobs name one

    return outline_of(value)


def read_feeds(value: Any) -> tuple[FeedRow, ...]:
    """Return rows of feeds, tables with material, surface_speed, feed_per_tooth and plunge_share.

    Raises:
        InputError: they are none. ParameterError: a value is out of its range.
    """
    known: dict[str, Callable[[Any], Any]] = {
        "material": read_text,
        "surface_speed": read_number,
        "feed_per_tooth": read_number,
        "plunge_share": read_number,
    }
    if not isinstance(value, list) or not all(
        isinstance(row, dict) and {*tuple(known)[:3]} <= row.keys() <= known.keys() for row in value
    ):
        raise InputError(f"write [[tool.feeds]] before each row, and below it {', '.join(known)}")
    return tuple(FeedRow(**{key: known[key](item) for key, item in row.items()}) for row in value)


def read_angle(value: Any) -> float:
    """Return an angle in radians: of a number, degrees; of a text such as "0.5 rad", that.

    Raises:
        InputError: it is neither.
    """
    if isinstance(value, str):
        match = re.fullmatch(r"(-?\d\S{0,30}) rad", value)
        try:
            return float(match[1] if match else "none")
        except ValueError as error:
            raise InputError('it must be a number of degrees, or a text such as "0.5 rad"') from error
    return math.radians(read_number(value))


def word(
    choices: Mapping[str, Value], what: str, also: Mapping[str, str] = MappingProxyType({})
) -> Callable[[Any], Value]:
    """Return a reader of a word that is one of some; `also`: other words for them."""

    def read(value: Any) -> Value:
        text = read_text(value)
        return one_of(also.get(text.strip().lower(), text), choices, what)

    return read


def read_curves(value: Any) -> tuple[Selector, ...]:
    """Return what a list of texts selects.

    Raises:
        InputError: it is no list of texts. ParameterError: one selects nothing that could be.
    """
    return read_selectors(read_texts(value))


_READERS: dict[Unit, Callable[[Any], Any]] = {
    Unit.LENGTH: read_number,
    Unit.ANGLE: read_angle,
    Unit.SHARE: read_share,
    Unit.COUNT: read_whole,
    Unit.FLAG: read_flag,
    Unit.NAMES: read_texts,
    Unit.CURVES: read_curves,
    Unit.POINTS: read_points,
    Unit.SPEED: read_number,
    Unit.RATE: read_number,
    Unit.TIME: read_number,
    Unit.TEXT: read_text,
    Unit.OUTLINE: read_holder,
    Unit.FEEDS: read_feeds,
}


def reader_of(placed: ParameterPlace) -> Callable[[Any], Any]:
    """Return what reads a parameter's value as TOML gives it; it raises InputError for what can be none."""
    if isinstance(placed.default, Keyword):
        kinds = type(placed.default)
        return word(kinds.words(), placed.parameter.label.lower(), kinds.other_words())
    if placed.enum is not None:
        return word({each.value: each for each in placed.enum}, placed.parameter.label.lower())
    return _READERS[placed.parameter.unit]
