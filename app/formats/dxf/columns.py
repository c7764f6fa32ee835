"""The columns of an MTEXT that is kept as one text, as drawings since R2018 have it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class LetterColumns:
    """Columns beside one another, all of one width.

    Attributes:
        heights: of each, drawing units; what is beyond the last has its height, where `repeated`, else no end.
        repeated: there are as many columns as the text fills.
        width, gutter: of a column, and between two, drawing units. reversed: they go on to the left.
    """

    heights: tuple[float, ...] = ()
    repeated: bool = False
    width: float = 0.0
    gutter: float = 0.0
    reversed: bool = False

    @staticmethod
    def of(columns: Any) -> LetterColumns:
        """Return what the drawing says; columns without a height are one that has no end."""
        manual = bool(columns.heights) and not columns.auto_height
        heights = columns.heights if manual else [columns.defined_height] * max(int(columns.count), 1)
        heights = tuple(abs(float(height)) for height in heights)
        return LetterColumns(
            heights if all(heights) else (),
            columns.has_dynamic_auto_height,
            abs(float(columns.width)),
            float(columns.gutter_width),
            bool(columns.reversed_column_flow),
        )

    @property
    def height(self) -> float:
        """Of the tallest, drawing units; 0 where none has one."""
        return max(self.heights, default=0.0)

    def depth(self, column: int) -> float:
        """Return how far below its top a baseline may lie in a column, by its number from 0, drawing units."""
        last = len(self.heights) - 1
        if column < last or (self.repeated and last >= 0):
            return self.heights[min(column, last)]
        return math.inf

    def breadth(self, column: int) -> float:
        """Return how wide a column is, by its number from 0, in which lines run downwards; the last has no end."""
        last = len(self.heights) - 1
        return self.width if self.width and (column < last or self.repeated) else math.inf

    def starts(self, count: int, width: float) -> list[float]:
        """Return the left edges of so many columns as wide as told, from that of the leftmost, drawing units."""
        starts = [k * (width + self.gutter) for k in range(count)]
        return starts[::-1] if self.reversed else starts


ONE_COLUMN = LetterColumns()
