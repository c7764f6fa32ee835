"""The stock out of the text of a comment."""

from __future__ import annotations

import math
import re

from .notes_words import NUMBER, UNIT, StockBoxNote, Three, length_mm

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
