"""Depths that a drawing tells of its own: by the elevation or the thickness of curves, or by a text beside a shape."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import Enum

from .curves import Point


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


_NUMBER = r"(\d{1,4}(?:[.,]\d{1,6})?|[.,]\d{1,6})"
_UNIT = r"(?:\s?(mm|in(?![a-z])|\"|''))?"
_WORD = r"(?:depth|deep|dp\.?|tiefe|深さ|深|↓|↧|(?<![a-z])[tz](?=\s?[=:\d.+-]))"
_TOLD = re.compile(rf"{_WORD}\s{{0,3}}[=:_-]{{0,2}}\s{{0,3}}{_NUMBER}(?![\d.,]*\d){_UNIT}", re.IGNORECASE)
_BEHIND = re.compile(rf"(?<![\d.,]){_NUMBER}{_UNIT}\s?(?:deep|tief|dp)(?![a-z])", re.IGNORECASE)
_MEANT = re.compile(r"depth|deep|tiefe?(?![a-z])|深|↓|↧", re.IGNORECASE)
_IN = 25.4
"""mm an inch."""


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
    found = _TOLD.findall(words) or _BEHIND.findall(words)
    depths = {float(number.replace(",", ".")) * _size(said, unit) for number, said in found} - {0.0}
    if not found and not _MEANT.search(words):
        return None
    return DepthWords(depths.pop() if len(depths) == 1 else None)


def _size(said: str, unit: float) -> float:
    return unit if not said else 1.0 if said.lower() == "mm" else _IN
