"""Letters below one another: a line that runs downwards, as a style that is vertical or an MTEXT sets it.

The distance from top to top is that of the strokes in the vertical fonts of DXF's own programs: one and a half
heights of the capitals. Each letter stands upright, its middle on the line.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from .fonts import Fonts
from .letter_boxes import LetterBox
from .letters import run_of

_APART = 1.5
"""Heights of the capitals from one letter down to the next."""
_VERTICAL = 4
"""Flag of a style whose letters stand below one another."""
_SLACK = 1e-9
"""Of a length, for rounding."""


def is_vertical(style: Any) -> bool:
    """Return whether a text style of the drawing, or none, sets letters below one another."""
    return style is not None and bool(style.dxf.flags & _VERTICAL)


@dataclass(frozen=True, slots=True)
class PlacedBox:
    """A box and where it begins, on its baseline, drawing units."""

    box: LetterBox
    x: float
    y: float


@dataclass
class DownColumn:
    """Letters of a column whose lines run downwards beside one another, the middle of the first one at 0.

    Attributes:
        cells: from the top, which is at the height 0. lines: so many are begun, also empty ones. at: middle of the
            last, drawing units.
    """

    cells: list[PlacedBox] = field(default_factory=list)
    lines: int = 0
    at: float = 0.0

    @property
    def left(self) -> float:
        """Where its letters begin."""
        return min((cell.x for cell in self.cells), default=0.0)

    @property
    def right(self) -> float:
        """Where they end."""
        return max((cell.x + cell.box.ink for cell in self.cells), default=0.0)

    def is_full(self, line: Sequence[PlacedBox], apart: float, width: float) -> bool:
        """Return whether a line, its middle at 0, so far from the last one would end beyond a width."""
        end = max((cell.x + cell.box.ink for cell in line), default=0.0)
        return self.lines > 0 and self.at + apart + end - self.left > width * (1 + _SLACK)

    def add(self, line: list[PlacedBox], apart: float, depth: float) -> list[PlacedBox]:
        """Add a line, and return what of it would lie deeper, as a line of its own; at least one letter is added."""
        self.at += apart if self.lines else 0.0
        self.lines += 1
        fit = next((k for k, cell in enumerate(line) if k and -cell.y > depth * (1 + _SLACK)), len(line))
        self.cells += [replace(cell, x=cell.x + self.at) for cell in line[:fit]]
        if fit == len(line):
            return []
        top = line[fit].y + line[fit].box.look.height
        return [replace(cell, y=cell.y - top) for cell in line[fit:]]


def stacked(boxes: Sequence[LetterBox], fonts: Fonts) -> list[PlacedBox]:
    """Return the letters of a line that runs down from the height 0, each with its middle at 0."""
    y, placed = 0.0, list[PlacedBox]()
    for box in boxes:
        for cell in _cells(box, fonts):
            placed.append(PlacedBox(cell, -cell.ink / 2, y - cell.look.height))
            y -= _APART * cell.look.height * cell.look.tracking
    return placed


def _cells(box: LetterBox, fonts: Fonts) -> Iterator[LetterBox]:
    """Yield the letters of words one by one; a fraction stays whole."""
    if len(box.rows) > 1:
        yield box
        return
    for run, _, _ in box.rows:
        yield from (LetterBox.of(run_of(letter, run.look, fonts)) for letter in run.words)
