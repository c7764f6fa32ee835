"""The shape while it is drawn: lines of the drawing language, and what they have drawn so far on the display."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError
from ....drafting.document import Document
from ....drafting.language.language import command_word
from ....geometry.sample import bounds, sample, union
from ....model.job import Job
from ....model.part import Part
from ....raster.frame import POINTS
from .glyphs import Bits
from .processing import ScreenSize
from .screen import BOTTOM, TOP, Place

PITCH = 0.25
"""mm a point, until something larger is drawn."""

SHEET = (2 * PITCH, 2 * PITCH, (POINTS - 2) * PITCH, (BOTTOM - TOP - 2) * PITCH)
"""What the display shows at least, x0, y0, x1, y1, mm: its lower left is 0, 0."""

WORDS = ("line", "circle", "arc", "polyline", "rect", "delete", "undo", "redo")


class ShapeDraft:
    """A drawing of its own; the document is not touched.

    Attributes:
        frame: where the points lie on it.
    """

    def __init__(self) -> None:
        self._document = Document(Job(Part(name="session 1986")))
        self.frame = ScreenSize().frame(SHEET)

    @property
    def part(self) -> Part:
        """What is drawn."""
        return self._document.part

    def run(self, line: str) -> str:
        """Carry out a line such as `LINE 10,10 60,10` and return the reply.

        Raises:
            InputError: it cannot be carried out; nothing has changed.
        """
        if line.strip().upper() == "CLEAR":
            self._document.run("select all")
            line = "delete"
        if command_word(line) not in WORDS:
            raise InputError(f"'{line.split()[0]}' is not known here. Use {', '.join(WORDS)}, clear or end.")
        reply = self._document.run(line.lower())
        box = union([SHEET, *(bounds(entity.curve) for entity in self.part.entities)])
        self.frame = ScreenSize().frame(box or SHEET)
        return reply

    def job(self, before: Job) -> Job:
        """Return another job with this drawing."""
        return replace(before, part=self.part, layer_names=())

    def picture(self) -> Bits:
        """Return what is drawn as points (400, 400)."""
        picture = np.zeros((POINTS, POINTS), np.bool_)
        for entity in self.part.entities:
            _plot(picture, self.frame.to_px(sample(entity.curve)))
        return picture

    def point(self, place: Place) -> str:
        """Return the words for the upper left corner of a display point, as the language takes them."""
        x, y = self.frame.to_mm(np.array([(place[1], place[0])], dtype=np.float64))[0].tolist()
        digits = max(0, 1 - math.floor(math.log10(self.frame.pitch)))
        return f"{round(x, digits):g},{round(y, digits):g}"


def _plot(picture: Bits, points: NDArray[np.float64]) -> None:
    """Light the points that a line through (n, 2) columns and rows runs through."""
    for start, end in pairwise(points):
        count = int(np.abs(end - start).max() * 2) + 2
        cols, rows = np.floor(np.linspace(start, end, count)).astype(int).T
        inside = (rows >= TOP) & (rows < BOTTOM) & (cols >= 0) & (cols < POINTS)
        picture[rows[inside], cols[inside]] = True
