"""The stock out of the text of a comment."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

from .notes_words import NUMBER, UNIT, length_mm
from .program import StockNote

_SIGNED = rf"([-+]?)\s?({NUMBER})\s{{0,3}}({UNIT})?"
_TIMES = r"\s{0,3}(?:x|\*|\u00d7|by)\s{0,3}"
_WORD = r"[xyz]?\s{0,2}[=:]?\s{0,2}"
_SIZE = re.compile(rf"(?<![\w.])[x]?\s?{_SIGNED}{_TIMES}{_WORD}{_SIGNED}{_TIMES}{_WORD}{_SIGNED}", re.IGNORECASE)
_TO = r"\s{0,3}(?:to|\.\.\.?|…)\s{0,3}"
_AXIS = re.compile(rf"(?<![a-z])([xyz])\s{{0,2}}[=:]?\s{{0,2}}{_SIGNED}(?:{_TO}[xyz]?\s?{_SIGNED})?", re.IGNORECASE)
_TOP = re.compile(
    rf"top of (?:the )?(?:stock|material|workpiece)\b[^()]{{0,20}}?z\s{{0,2}}[=:]?\s{{0,2}}{_SIGNED}", re.IGNORECASE
)
_BOUND = re.compile(rf"(min|max)([xyz])\s?=\s?{_SIGNED}", re.IGNORECASE)

Three = list[float]


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


def box_of(text: str, program_mm: float) -> StockBoxNote:
    """Return what a comment about the stock tells.

    Args:
        text: not longer than `LONGEST`.
        program_mm: mm of the program's unit.
    """
    top = _TOP.search(text)
    if top:
        return StockBoxNote(high=[math.nan, math.nan, _signed(top.groups(), program_mm)])
    size = _SIZE.search(text)
    if size:
        return StockBoxNote(size=_sizes(size.groups(), program_mm))
    return _by_axes(text, program_mm)


def bounds_of(text: str) -> StockBoxNote:
    """Return the box of PyCAM's settings: minx = ..., maxz = ..., in mm."""
    box = StockBoxNote()
    for end, axis, *number in _BOUND.findall(text):
        (box.low if end.lower() == "min" else box.high)["xyz".index(axis.lower())] = _signed(number, 1.0)
    return box


def _signed(groups: tuple[str | None, ...] | list[str], program_mm: float) -> float:
    """Return the value of a sign, a number and a unit."""
    sign, number, unit = groups
    value = length_mm(number or "0", unit or None, program_mm)
    return -value if sign == "-" else value


def _sizes(groups: tuple[str | None, ...], program_mm: float) -> Three:
    """Return three sizes; a unit behind the last one holds for those that have none."""
    last = groups[8]
    return [abs(_signed((*groups[k : k + 2], groups[k + 2] or last), program_mm)) for k in (0, 3, 6)]


def _by_axes(text: str, program_mm: float) -> StockBoxNote:
    """Return the box by X, Y, Z words: ranges or two of each are corners; one of each is a size, unless one is <= 0."""
    values: list[Three] = [[], [], []]
    for match in _AXIS.finditer(text):
        found = match.groups()
        axis = "xyz".index((found[0] or "").lower())
        values[axis].append(_signed(found[1:4], program_mm))
        if found[5] is not None:
            values[axis].append(_signed(found[4:7], program_mm))
    if not all(values):
        return StockBoxNote()
    if all(len(of_axis) >= 2 for of_axis in values):
        return StockBoxNote(low=[min(of_axis) for of_axis in values], high=[max(of_axis) for of_axis in values])
    firsts = [of_axis[0] for of_axis in values]
    return StockBoxNote(size=firsts) if min(firsts) > 0 else StockBoxNote(low=firsts)
