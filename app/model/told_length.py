"""A length as people write it into a drawing: "4", "2,5 mm", "1/4 in", '1 1/2"'; or why it is none."""

from __future__ import annotations

import re
from functools import cache

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

LENGTH = (
    r"(?:(?P<whole>\d{1,4})[ -])?(?P<above>\d{1,3})/(?P<below>[1-9]\d{0,2})(?!\d)"
    r"|(?P<plain>\d{1,4}(?:[.,]\d{1,6})?|[.,]\d{1,6})(?!\d)"
)
UNIT = rf"(?:\s?(?P<unit>{_UNIT})(?![a-z]))?"
_TOLD = rf"(?:{LENGTH}){UNIT}"

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
