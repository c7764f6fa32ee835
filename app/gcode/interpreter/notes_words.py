"""Where comments stand in a program, and the lengths that they tell. All patterns are bounded, so no text can hang
them.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from .program import StockNote

LONGEST = 400
"""Characters of a comment that are looked at."""
MOST_HITS = 1000
"""Places of one word that are looked at."""
MOST_BYTES = 1 << 25
"""How much of a program is looked at."""

NUMBER = r"(?:\d{1,3}[ -])?\d{1,3}/\d{1,3}(?![\d/])|\d{1,7}(?:\.(?!\.)\d{0,9})?|\.\d{1,9}"
UNIT = r"""mm\b|millim\w{0,7}|cm\b|inch(?:es)?\b|in\b|"|''|″"""
LENGTH = rf"({NUMBER})\s{{0,3}}({UNIT})?"
"""Two groups: number and unit, for `length_mm`."""

_GOES_ON = {b".", *(b"%d" % digit for digit in range(10))}


def length_mm(number: str, unit: str | None, program_mm: float) -> float:
    """Return a length in mm; without a unit, a fraction is in inches and any other number in the program's unit.

    Args:
        number: "6", ".5", "1/4", "1-1/4".
        unit: "mm", "in", '"' and the like, or None.
        program_mm: mm of the program's unit.
    """
    whole, _, rest = number.replace("-", " ").rpartition(" ")
    above, _, below = rest.partition("/")
    divisor = float(below or 1)
    value = float(whole or 0) + float(above) / divisor if divisor else 0.0
    sign = (unit or "").lower()
    if sign.startswith(("mm", "milli")):
        return value
    if sign == "cm":
        return value * 10.0
    return value * (25.4 if sign or below else program_mm)


Three = list[float]
"""X, Y and Z, mm."""


def _unknown() -> Three:
    return [math.nan] * 3


@dataclass
class StockBoxNote:
    """A box as far as it is told, mm: corners and size, NaN where they are not."""

    low: Three = field(default_factory=_unknown)
    high: Three = field(default_factory=_unknown)
    size: Three = field(default_factory=_unknown)

    def is_known(self) -> bool:
        """Whether anything is."""
        return any(not math.isnan(value) for value in (*self.low, *self.high, *self.size))

    def merged(self, other: StockBoxNote) -> StockBoxNote:
        """Return the box with what another tells beside it."""
        return StockBoxNote(
            *(
                [b if math.isnan(a) else a for a, b in zip(mine, theirs, strict=True)]
                for mine, theirs in ((self.low, other.low), (self.high, other.high), (self.size, other.size))
            )
        )

    def note(self, line: int) -> StockNote:
        """Return the note, with what follows: of low, high and size two give the third."""
        low, high, size = list(self.low), list(self.high), list(self.size)
        for k in range(3):
            size[k] = high[k] - low[k] if math.isnan(size[k]) else size[k]
            low[k] = high[k] - size[k] if math.isnan(low[k]) else low[k]
            high[k] = low[k] + size[k] if math.isnan(high[k]) else high[k]
        return StockNote((low[0], low[1], low[2]), (high[0], high[1], high[2]), (size[0], size[1], size[2]), line)


@dataclass(frozen=True)
class Comments:
    """A program whose comments are asked for by the words in them.

    Attributes:
        data: bytes, lines ended by line feeds.
        lower: the same in lower case.
        encoding: of the bytes.
    """

    data: bytes
    lower: bytes
    encoding: str

    def places(self, words: tuple[bytes, ...], most: int = MOST_HITS) -> Iterator[int]:
        """Yield where words stand, lower case; not more than `most` of each."""
        for word in words:
            at = self.lower.find(word)
            for _ in range(most):
                if at < 0:
                    break
                yield at
                at = self.lower.find(word, at + len(word))

    def around(self, at: int) -> tuple[int, int] | None:
        """Return the begin and end of the comment's text that a place is in, None where it is in none."""
        begin = self.line_begin(at)
        before = self.data[begin:at]
        semicolon, bracket = before.find(b";"), before.rfind(b"(")
        if semicolon >= 0 and (bracket < 0 or semicolon < bracket):
            return begin + semicolon + 1, self.line_end(at)
        if bracket < 0 or b")" in before[bracket:]:
            return None
        close = self.data.find(b")", at, self.line_end(at))
        return begin + bracket + 1, close if close >= 0 else self.line_end(at)

    def texts(self, words: tuple[bytes, ...], most: int = MOST_HITS) -> Iterator[tuple[int, str]]:
        """Yield each comment that has one of the words, once: where it begins, and its text; looks at `most` places of
        each.
        """
        seen = set()
        for at in self.places(words, most):
            place = self.around(at)
            if place is not None and place[0] not in seen:
                seen.add(place[0])
                yield place[0], self.text(*place)

    def text(self, begin: int, end: int) -> str:
        """Return a stretch of the program."""
        return self.data[begin : min(end, begin + LONGEST)].decode(self.encoding, "replace")

    def line_begin(self, at: int) -> int:
        """Return where the line begins, but not more than `LONGEST` before a place."""
        return max(self.data.rfind(b"\n", max(0, at - LONGEST), at) + 1, at - LONGEST, 0)

    def line_end(self, at: int) -> int:
        """Return where the line ends, but not more than `LONGEST` after a place."""
        end = self.data.find(b"\n", at, at + LONGEST)
        return end if end >= 0 else min(len(self.data), at + LONGEST)

    def line(self, at: int) -> int:
        """Return the 1-based number of a place's line."""
        return self.data.count(b"\n", 0, at) + 1


class ProgramUnits:
    """What a length of the program means, place by place: G20 and G21 outside of comments."""

    def __init__(self, comments: Comments) -> None:
        """Look for the changes of units."""
        found = sorted(at for at in comments.places((b"g20", b"g21")) if self._changes(comments, at))
        self._at = found
        self._mm = [25.4 if comments.lower[at : at + 3] == b"g20" else 1.0 for at in found]

    @staticmethod
    def _changes(comments: Comments, at: int) -> bool:
        """Tell whether a word is G20 or G21, not G210 or G20.1, and not in a comment."""
        return comments.lower[at + 3 : at + 4] not in _GOES_ON and comments.around(at) is None

    def mm_at(self, at: int) -> float:
        """Return the mm of a unit: by the change before a place, else by the first after it; 1 where there is none."""
        if not self._at:
            return 1.0
        return self._mm[max(0, bisect.bisect(self._at, at) - 1)]
