"""SVG's attributes as numbers: lists, and the map of a viewBox into its place."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ...geometry.affine import Affine

PIXEL = 25.4 / 96
"""Size of a CSS pixel, mm."""
MM = {"mm": 1.0, "cm": 10.0, "in": 25.4, "pt": 25.4 / 72, "pc": 25.4 / 6, "q": 0.25}
"""Units of length that have a size of their own, mm."""
NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
_LIST = re.compile(rf"[\s,]*({NUMBER})")


class UnreadableError(ValueError):
    """An attribute cannot be read; the argument is its text."""


def numbers(text: str) -> list[float]:
    """Return a list of numbers with blanks or commas between them.

    Raises:
        UnreadableError: something in it is no number; the numbers before it are the error's second argument.
    """
    found, at = [], 0
    while match := _LIST.match(text, at):
        found.append(float(match[1]))
        at = match.end()
    if text[at:].strip(" \t\r\n,"):
        raise UnreadableError(text, found)
    return found


@dataclass(frozen=True, slots=True)
class ViewBox:
    """A viewBox, or the place that it goes to; user units."""

    x: float
    y: float
    width: float
    height: float


def view_box(text: str) -> ViewBox:
    """Return a viewBox.

    Raises:
        UnreadableError: it has not four numbers, or no area.
    """
    given = numbers(text)
    if len(given) != 4 or not all(map(math.isfinite, given)) or min(given[2:]) <= 0:
        raise UnreadableError(text)
    return ViewBox(*given)


def fitted(box: ViewBox, place: ViewBox, aspect: str) -> Affine:
    """Return the map that brings a viewBox to its place.

    Args:
        aspect: preserveAspectRatio; what it does not say is "xMidYMid meet".
    """
    across, up = place.width / box.width, place.height / box.height
    words = [word for word in aspect.split() if word != "defer"]
    align = words[0] if words else "xMidYMid"
    if align == "none":
        return Affine(across, 0.0, 0.0, up, place.x - across * box.x, place.y - up * box.y)
    scale = max(across, up) if "slice" in words else min(across, up)
    x = place.x - scale * box.x + _share(align[1:4]) * (place.width - scale * box.width)
    y = place.y - scale * box.y + _share(align[5:8]) * (place.height - scale * box.height)
    return Affine(scale, 0.0, 0.0, scale, x, y)


def _share(word: str) -> float:
    return {"Min": 0.0, "Max": 1.0}.get(word, 0.5)
