"""The terminal's display: 400 x 400 points of one bit, a picture and the dialogue under it, or one page of text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ....raster.frame import POINTS
from .glyphs import CELL, Bits, line_bits, spoken, wrapped

MARGIN_PX = 4
"""Points before the first character of a line."""

COLUMNS = (POINTS - MARGIN_PX) // CELL
"""Characters in a line."""

LINE_PX = CELL + 1
"""Points from one line of text to the next."""

HEAD_PX = LINE_PX
"""Rows of the bar at the top that names the step."""

TOP, BOTTOM = 12, 342
"""The picture is in the rows from TOP to BOTTOM - 1; the dialogue begins under it."""

TALK_LINES = (POINTS - BOTTOM - 3) // LINE_PX
"""Lines of the dialogue, the one that is typed in included."""

PAGE_LINES = (POINTS - HEAD_PX - 4) // LINE_PX
"""Lines of a page, the one that is typed in included."""

_CARD = (
    "400 X 400 POINTS, 1 BIT",
    "",
    "",
    "ENTER A SHAPE AND THREE AMOUNTS:",
    "",
    "110  SHAPE",
    "120  OFFSET OF THE CONTOUR TOOL",
    "140  OFFSET OF THE POCKET TOOL",
    "     OVERLAP OF ITS PATHS",
    "",
    "",
    "RETURN   ANSWER; GO TO THE END",
    "SPACE    HOLD, GO ON",
    "ARROWS   STEP BY STEP; CROSS HAIR; PAGE",
    "TAB      PUT THE CROSS HAIR",
    "DELETE   CLEAR THE ANSWER",
    "CTRL-C   BREAK",
    "F2       GREEN, AMBER",
    "ESC      LEAVE",
    "",
    "BACK     THE QUESTION BEFORE",
    "NEW      ANOTHER SESSION",
)
CURSOR = "_"
Place = tuple[int, int]
"""Row and column of a point."""


@dataclass(eq=False)
class TerminalScreen:
    """What the terminal shows; whoever changes it has it painted.

    Attributes:
        head: in the bar at the top, left and right. picture: (400, 400) points. talk: lines of the dialogue, oldest
            first.
        page: lines of a page that takes the place of picture and dialogue; None = there is none. up: lines that it is
            scrolled back.
        prompt: what is asked; "" = nothing is. typed: the answer so far. lit: the cursor is in its lit half.
        hair: where the cross hair is; None = there is none.
    """

    head: tuple[str, str] = ("", "")
    picture: Bits = field(default_factory=lambda: np.zeros((POINTS, POINTS), np.bool_))
    talk: list[str] = field(default_factory=list)
    page: list[str] | None = None
    up: int = 0
    prompt: str = ""
    typed: str = ""
    lit: bool = True
    hair: Place | None = None

    def say(self, text: str) -> None:
        """Add a sentence to the dialogue."""
        self.talk += wrapped(text, COLUMNS)
        del self.talk[:-PAGE_LINES]

    def asked(self) -> list[str]:
        """Return the lines that the question and its answer take up, with the cursor."""
        if not self.prompt:
            return []
        text = f"{self.prompt} {spoken(self.typed)}{CURSOR if self.lit else ' '}"
        return [text[k : k + COLUMNS] for k in range(0, len(text), COLUMNS)]

    def scroll(self, lines: int) -> None:
        """Scroll the page back (> 0) or on."""
        most = max(len(self.page or ()) + len(self.asked()) - PAGE_LINES, 0)
        self.up = min(max(self.up + lines, 0), most)

    def bits(self) -> Bits:
        """Return the points as they are to be seen now."""
        points = np.zeros((POINTS, POINTS), np.bool_)
        self._write_head(points)
        if self.page is not None:
            end = len(self.page) - self.up
            asked = self.asked()
            write(points, HEAD_PX + 4, [*self.page[max(end - PAGE_LINES + len(asked), 0) : end], *asked])
            return points
        points[TOP:BOTTOM] = self.picture[TOP:BOTTOM]
        points[BOTTOM, ::2] = True
        if self.hair is not None:
            points[TOP:BOTTOM, self.hair[1]] ^= True
            points[self.hair[0]] ^= True
        write(points, BOTTOM + 3, [*self.talk, *self.asked()][-TALK_LINES:])
        return points

    def _write_head(self, points: Bits) -> None:
        left, right = (spoken(text) for text in self.head)
        right = right[: COLUMNS - 1]
        write(points, 1, [f"{left[: COLUMNS - len(right) - 1].ljust(COLUMNS - len(right))}{right}"])
        points[: HEAD_PX + 1] ^= True


def write(points: Bits, top: int, lines: Sequence[str]) -> None:
    """Write lines of text into (400, 400) points, from row `top` on."""
    for k, line in enumerate(lines):
        bits = line_bits(line[:COLUMNS])
        points[top + k * LINE_PX : top + k * LINE_PX + CELL, MARGIN_PX : MARGIN_PX + bits.shape[1]] = bits


def card() -> Bits:
    """Return the picture before there is a shape: which keys do what."""
    points = np.zeros((POINTS, POINTS), np.bool_)
    write(points, TOP + 3 * LINE_PX, [f"   {line}" for line in _CARD])
    return points
