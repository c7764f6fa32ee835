"""Letters below one another: a line that runs downwards, as a style that is vertical or an MTEXT sets it.

The distance from top to top is that of the strokes in the vertical fonts of DXF's own programs: one and a half
heights of the capitals. Each letter stands upright, its middle on the line.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from .fonts import Fonts
from .letter_boxes import LetterBox
from .letters import run_of

_APART = 1.5
_VERTICAL = 4


def is_vertical(style: Any) -> bool:
    """Return whether a text style of the drawing, or none, sets letters below one another."""
    return style is not None and bool(style.dxf.flags & _VERTICAL)


@dataclass(frozen=True, slots=True)
class PlacedBox:
    """A box and where it begins, on its baseline, drawing units."""

    box: LetterBox
    x: float
    y: float


def stacked(boxes: Sequence[LetterBox], fonts: Fonts, x: float = 0.0) -> list[PlacedBox]:
    """Return the letters of a line that runs down from the height 0, each with its middle at `x`."""
    y, placed = 0.0, list[PlacedBox]()
    for box in boxes:
        for cell in _cells(box, fonts):
            placed.append(PlacedBox(cell, x - cell.ink / 2, y - cell.look.height))
            y -= _APART * cell.look.height * cell.look.tracking
    return placed


def _cells(box: LetterBox, fonts: Fonts) -> Iterator[LetterBox]:
    """Yield the letters of words one by one; a fraction stays whole."""
    if len(box.rows) > 1:
        yield box
        return
    for run, _, _ in box.rows:
        yield from (LetterBox.of(run_of(letter, run.look, fonts)) for letter in run.words)
