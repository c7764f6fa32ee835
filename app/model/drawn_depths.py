"""Depths that a drawing tells of its own: by the elevation or the thickness of curves, or by a text beside a shape,
with a length as people write it: "4", "2,5 mm", "1/4 in", '1 1/2"'.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import Enum
from functools import cache

from .curves import Point

_INCH = 25.4
"""mm."""
_SIZES = {
    "mm": 1.0,
    "ミリ": 1.0,
    "cm": 10.0,
    "センチ": 10.0,
    "m": 1000.0,
    "in": _INCH,
    "inch": _INCH,
    "inches": _INCH,
    '"': _INCH,
    "”": _INCH,
    "″": _INCH,
    "''": _INCH,
    "thou": _INCH / 1000,
}
_UNIT = "|".join(re.escape(unit) for unit in sorted(_SIZES, key=len, reverse=True))

_LENGTH = (
    r"(?:(?P<whole>\d{1,4})[ -])?(?P<above>\d{1,3})/(?P<below>[1-9]\d{0,2})(?!\d)"
    r"|(?P<plain>\d{1,4}(?:[.,]\d{1,6})?|[.,]\d{1,6})(?!\d)"
)
UNIT = rf"(?:\s?(?P<unit>{_UNIT})(?![a-z]))?"
_TOLD = rf"(?:{_LENGTH}){UNIT}"

_GOES_ON = (
    r"[.,/]\d|[a-z\u00b5\u03bc'\u2019\u2032]|\s?[-\u2013~](?=[\d.,])|\s?(?:to|bis|or)\s?\d"
    r"|\s?(?:ft|feet|foot|mils?|[\u00b5\u03bcu]m)(?![a-z])"
)
"""What follows a number that is another one than it seems: a range, a product, a unit that is none of these."""

_THOUSANDS = r"[1-9]\d*,\d{3}"
"""A comma before three digits stands for nothing, or for a point."""


@cache
def _any_case(pattern: str) -> re.Pattern[str]:
    """Return a pattern in any case, compiled with the first drawing that has words: most have none."""
    return re.compile(pattern, re.IGNORECASE)


def size_of(word: str | None, unit: float) -> float:
    """Return how long a unit is, by a word that `UNIT` finds, mm; None, "" = `unit`."""
    return _SIZES[word.lower()] if word else unit


def told_length(words: str, at: int, unit: float) -> tuple[float, int] | None:
    """Return the length that words tell from a place on, mm, and where it ends; None where it cannot be told for sure.

    Args:
        unit: of a number beside which none stands, mm.
    """
    found = _any_case(_TOLD).match(words, at)
    if found is None or _any_case(_GOES_ON).match(words, found.end()) or re.fullmatch(_THOUSANDS, found["plain"] or ""):
        return None
    size = size_of(found["unit"], unit)
    if found["plain"]:
        return float(found["plain"].replace(",", ".")) * size, found.end()
    return (int(found["whole"] or 0) + int(found["above"]) / int(found["below"])) * size, found.end()


class DepthSource(Enum):
    """Who tells a depth; the value is its word in reports and projects."""

    TEXT = "text"
    ELEVATION = "elevation"
    THICKNESS = "thickness"


@dataclass(frozen=True, slots=True)
class DrawnDepth:
    """A depth that a drawing tells.

    Attributes:
        source: who tells it.
        depth: below the stock's top, mm, > 0; None where it is told in a way that nobody understands.
        words: what the drawing says.
        at: where, mm.
        curves: of a text the numbers of the curves of its letters, of curves their own.
        height: of the letters, mm; 0 of curves.
    """

    source: DepthSource
    depth: float | None
    words: str
    at: Point
    curves: tuple[int, ...] = ()
    height: float = 0.0


_WORD = r"(?:depth|deep|dp\.?|tiefe|深さ|深|↓|↧|(?<![a-z])[tz](?=\s?[=:\d.+-]))"
_BEFORE = rf"{_WORD}\s{{0,3}}[=:_\u2212-]{{0,2}}\s{{0,3}}(?=[\d.,]*\d)"
_BEHIND = rf"(?<![\d.,/])(?:{_LENGTH}){UNIT}\s?(?:deep|tief|dp)(?![a-z])"
_RANGE = r"(?:^|[\s(=:])\d{1,4}(?:[.,]\d+)?\s?[-\u2013~]\s?$"
_MEANT = r"depth|deep|tiefe?(?![a-z])|深|↓|↧"


@dataclass(frozen=True, slots=True)
class DepthWords:
    """What words say of a depth.

    Attributes:
        depth: mm; None where they speak of one, and do not tell it, or tell several.
    """

    depth: float | None


def depth_words(words: str, unit: float) -> DepthWords | None:
    """Return what a text says of a depth: "↓4", "t=4", "depth 4", "深さ4", "4 deep"; None where it says nothing of one.

    A number beside "mm" alone is no depth, nor is one behind a D, which is a diameter beside a shape.

    Args:
        unit: of numbers beside which none stands, mm.
    """
    told = [told_length(words, each.end(), unit) for each in re.finditer(_BEFORE, words, re.IGNORECASE)]
    if not told:
        behind = re.finditer(_BEHIND, words, re.IGNORECASE)
        told = [None if re.search(_RANGE, words[: k.start()]) else told_length(words, k.start(), unit) for k in behind]
    if not told and not re.search(_MEANT, words, re.IGNORECASE):
        return None
    depths = {each[0] if each else math.nan for each in told} - {0.0}
    depth = depths.pop() if len(depths) == 1 else math.nan
    return DepthWords(None if math.isnan(depth) else depth)
