"""SVG's lengths: numbers with units, and sums of them as CSS's calc() writes them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from .numbers import MM, NUMBER, PIXEL, UnreadableError

Viewport = tuple[float, float]
"""Width and height of the nearest viewport, user units: what percentages are of."""
MEDIUM = 16.0
"""Height of letters where nothing says otherwise, user units: CSS's medium."""
OF_EM = {"ex": 0.5, "ch": 0.5}
"""Units that depend on the font itself, in heights of letters, as CSS takes them where the font is not at hand."""
FONT_LENGTH = re.compile(rf"[\d.](?:{'|'.join(OF_EM)})\b", re.IGNORECASE)
"""Finds a length that depends on what a font is like."""
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([a-zA-Z]*|%)\s*\Z")
_TOKEN = re.compile(rf"\s*(?:({NUMBER})(%|[a-zA-Z]*)|(calc\(|\()|([-+*/)]))", re.IGNORECASE)
_PURE = "1"
"""The unit of a number within calc(), which multiplies."""
_DEEPEST = 32
"""Brackets within brackets."""


@dataclass(frozen=True, slots=True)
class LengthBasis:
    """What lengths are relative to.

    Attributes:
        viewport: percentages are of it. em: height of the element's letters, user units. rem: of the root's.
    """

    viewport: Viewport
    em: float = MEDIUM
    rem: float = MEDIUM

    def whole(self, axis: str) -> float:
        """Return what 100 % is along x, y or neither, user units."""
        return {"x": self.viewport[0], "y": self.viewport[1]}.get(axis, math.hypot(*self.viewport) / math.sqrt(2))


@dataclass(frozen=True, slots=True)
class WrittenLength:
    """A length as it is written: a sum of amounts by unit, in lower case, "" for user units."""

    amounts: Mapping[str, float]

    @property
    def is_physical(self) -> bool:
        """True when it is in mm, inches, points and the like alone."""
        return all(unit in MM for unit in self.amounts)

    @property
    def is_share(self) -> bool:
        """True when some of it is a share of a viewport."""
        return "%" in self.amounts

    @property
    def unit(self) -> str:
        """Its first unit."""
        return next(iter(self.amounts), "")

    @property
    def mm(self) -> float:
        """Of a physical length."""
        return sum(value * MM[unit] for unit, value in self.amounts.items())

    def user(self, basis: LengthBasis, axis: str = "") -> float:
        """Return the length in user units.

        Args:
            basis: what it is relative to. axis: "x", "y" or "" for neither.

        Raises:
            UnreadableError: a unit is none that a drawing by itself can tell.
        """
        return sum(_user(value, unit, basis, axis) for unit, value in self.amounts.items())


def _user(value: float, unit: str, basis: LengthBasis, axis: str) -> float:
    if unit in ("", "px"):
        return value
    if unit == "%":
        return value / 100 * basis.whole(axis)
    if unit in MM:
        return value * MM[unit] / PIXEL
    if unit == "rem":
        return value * basis.rem
    if unit == "em" or unit in OF_EM:
        return value * basis.em * OF_EM.get(unit, 1.0)
    raise UnreadableError(f"{value:g}{unit}")


def length(text: str) -> WrittenLength:
    """Return a length.

    Raises:
        UnreadableError: the text is none.
    """
    found = _LENGTH.match(text)
    if found is not None:
        return WrittenLength({found[2].lower(): float(found[1])})
    if text.strip().lower().startswith("calc("):
        return WrittenLength(_Sum(text).read())
    raise UnreadableError(text)


class _Sum:
    """Reads the text of one calc(): sums and differences of lengths, multiplied and divided by numbers."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._tokens = list(self._parts())
        self._at = 0

    def read(self) -> dict[str, float]:
        """Return the amounts by unit.

        Raises:
            UnreadableError: the text is no such sum.
        """
        made = self._factor(0)
        if self._at < len(self._tokens):
            raise UnreadableError(self._text)
        return {"" if unit == _PURE else unit: value for unit, value in made.items()}

    def _parts(self) -> Iterator[re.Match[str]]:
        at, text = 0, self._text.rstrip()
        while at < len(text):
            found = _TOKEN.match(text, at)
            if found is None:
                raise UnreadableError(self._text)
            yield found
            at = found.end()

    def _next(self, signs: str) -> str:
        """Take one of some signs, if it comes next; "" = it does not."""
        if self._at < len(self._tokens) and (sign := self._tokens[self._at][4]) and sign in signs:
            self._at += 1
            return str(sign)
        return ""

    def _sum(self, depth: int) -> dict[str, float]:
        made = self._product(depth)
        while sign := self._next("+-"):
            other = self._product(depth)
            if (_PURE in made) != (_PURE in other):  # a number is no length
                raise UnreadableError(self._text)
            for unit, value in other.items():
                made[unit] = made.get(unit, 0.0) + (value if sign == "+" else -value)
        return made

    def _product(self, depth: int) -> dict[str, float]:
        made = self._factor(depth)
        while sign := self._next("*/"):
            other = self._factor(depth)
            if sign == "*" and _PURE in made:
                made, other = other, made
            number = other.get(_PURE)
            if number is None or (sign == "/" and number == 0):
                raise UnreadableError(self._text)
            made = {unit: value * number if sign == "*" else value / number for unit, value in made.items()}
        return made

    def _factor(self, depth: int) -> dict[str, float]:
        if self._at >= len(self._tokens) or depth > _DEEPEST:
            raise UnreadableError(self._text)
        token = self._tokens[self._at]
        self._at += 1
        if token[1]:
            return {token[2].lower() or _PURE: float(token[1])}
        if not token[3]:
            raise UnreadableError(self._text)
        made = self._sum(depth + 1)
        if not self._next(")"):
            raise UnreadableError(self._text)
        return made


_NAMED_SIZES = {
    "xx-small": 0.6,
    "x-small": 0.75,
    "small": 8 / 9,
    "medium": 1.0,
    "large": 1.2,
    "x-large": 1.5,
    "xx-large": 2.0,
    "xxx-large": 3.0,
}
"""CSS's sizes of letters, in the medium one."""
_NEIGHBOURS = {"smaller": 1 / 1.2, "larger": 1.2}


def letter_height(text: str, outer: float, rem: float) -> float:
    """Return the height of letters, user units, of a font-size; one that cannot be read is the outer one.

    Args:
        text: as written, "" = not said. outer: of the element round it. rem: of the root.
    """
    word = text.strip().lower()
    if word in _NAMED_SIZES:
        return MEDIUM * _NAMED_SIZES[word]
    if word in _NEIGHBOURS:
        return outer * _NEIGHBOURS[word]
    try:
        made = length(word).user(LengthBasis((outer, outer), outer, rem), "x") if word else outer
    except UnreadableError:
        return outer
    return made if math.isfinite(made) and made >= 0 else outer


_SIZE_OF_FONT = re.compile(
    rf"(?:\A|\s)({NUMBER}(?:[a-zA-Z]+|%)|calc\(.*?\)|[x-]*small(?:er)?|[x-]*larger?|medium)(?=[\s/])"
)


def size_of_font(text: str) -> str:
    """Return the font-size in the shorthand `font`, "" where it has none."""
    found = _SIZE_OF_FONT.search(text)
    return found[1] if found else ""
