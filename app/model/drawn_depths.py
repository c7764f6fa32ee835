"""Depths that a drawing tells of its own: by the elevation or the thickness of curves, or by a text beside a shape."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from enum import Enum

from .curves import Point
from .told_length import LENGTH, UNIT, told_length


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
_BEHIND = rf"(?<![\d.,/])(?:{LENGTH}){UNIT}\s?(?:deep|tief|dp)(?![a-z])"
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
