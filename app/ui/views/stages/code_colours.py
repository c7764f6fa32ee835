"""How the display memory's codes look: colours by day and by night, letters."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from ....raster.code_words import WRONG
from ....raster.frame import PixelCode
from ...framework.theme import Theme, mixed

LETTERS: Mapping[int, str] = {
    PixelCode.EMPTY: "0",
    PixelCode.CONTOUR: "1",
    PixelCode.TRACED: "2",
    PixelCode.R: "R",
    PixelCode.INSIDE: "I",
    PixelCode.PROCESSED: "P",
    PixelCode.FRAME: "F",
    PixelCode.RING: "N",
    PixelCode.CIRCLE: "C",
    PixelCode.LONG_LINE: "L",
    PixelCode.VERTEX: "V",
    PixelCode.SHORT_LINE: "S",
    PixelCode.ARC: "A",
    PixelCode.SPLINE: "U",
    WRONG: "!",
}
"""What stands in a pixel that is large enough: 0, 1, 2, R and I as in the text, else a letter of the word."""

ORDER: tuple[int, ...] = (
    PixelCode.EMPTY,
    PixelCode.PROCESSED,
    PixelCode.INSIDE,
    PixelCode.CONTOUR,
    PixelCode.TRACED,
    PixelCode.RING,
    PixelCode.FRAME,
    PixelCode.CIRCLE,
    PixelCode.LONG_LINE,
    PixelCode.SHORT_LINE,
    PixelCode.ARC,
    PixelCode.SPLINE,
    PixelCode.R,
    PixelCode.VERTEX,
    WRONG,
)
"""Codes from ground to what must be seen: where several pixels fall on one of the screen, the last of them shows."""


def code_colours(theme: Theme) -> dict[int, QColor]:
    """Return the colour of each code; red is for what is wrong alone."""
    return {
        PixelCode.EMPTY: theme.canvas,
        PixelCode.CONTOUR: mixed(theme.canvas, theme.ink, 0.72),
        PixelCode.TRACED: theme.left,
        PixelCode.R: theme.plunge,
        PixelCode.INSIDE: mixed(theme.canvas, theme.accent, 0.42),
        PixelCode.PROCESSED: mixed(theme.canvas, theme.ink, 0.16),
        PixelCode.FRAME: theme.pocket,
        PixelCode.RING: mixed(theme.canvas, theme.pocket, 0.62),
        PixelCode.CIRCLE: theme.parameter,
        PixelCode.LONG_LINE: theme.left,
        PixelCode.VERTEX: theme.plunge,
        PixelCode.SHORT_LINE: theme.regions[4],
        PixelCode.ARC: theme.contour,
        PixelCode.SPLINE: theme.rest,
        WRONG: theme.gouge,
    }


def step_colours(theme: Theme, step: int) -> dict[int, QColor]:
    """Return the colour of each code in a step: filled areas are calmer than lines, the contour tool's path has its own
    colour.
    """
    made = code_colours(theme)
    if step in (130, *range(301, 308), *range(141, 149)):
        made[PixelCode.CONTOUR] = mixed(theme.canvas, theme.accent, 0.42)
    elif step in (120, 140):
        made[PixelCode.CONTOUR] = theme.contour
    return made


def table(colours: Mapping[int, QColor]) -> list[int]:
    """Return a colour table for an image of codes."""
    return [colours[code].rgb() for code in range(WRONG + 1)]


def rank_of_code() -> NDArray[np.uint8]:
    """Return the place of each code in ORDER."""
    ranks = np.zeros(WRONG + 1, np.uint8)
    ranks[list(ORDER)] = np.arange(len(ORDER))
    return ranks
