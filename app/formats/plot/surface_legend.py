"""The legend of a plot: samples of its lines with what they are, in columns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model.curves import Circle
from .page import Box, PageContent, Pen, PenStroke, TextLine, TracedPolyline, fitted

_COLUMNS, _ROW, _EDGE, _SAMPLE, _TEXT = 3, 5.2, 2.0, 15.0, 2.5
"""Columns; mm: from row to row, to the edge, length of a sample, height of letters."""


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """A line of a legend: a text, behind a sample of a pen's line, behind a circle of a radius in mm, or alone."""

    text: str
    pen: Pen | None = None
    radius: float = 0.0


def legend_height(count: int) -> float:
    """Return the height of a legend of so many entries, mm."""
    return 2 * _EDGE + _ROW * math.ceil(count / _COLUMNS)


def legend_ink(entries: Sequence[LegendEntry], box: Box) -> PageContent:
    """Return a legend in a place x0, y0, x1, y1 of the paper, row by row."""
    x0, _, x1, y1 = box
    wide = (x1 - x0) / _COLUMNS
    made = PageContent()
    for number, entry in enumerate(entries):
        x, y = x0 + wide * (number % _COLUMNS) + _EDGE, y1 - _EDGE - _ROW * (number // _COLUMNS + 0.5)
        indent = 0.0
        if entry.pen is not None and entry.radius:
            made += PageContent((PenStroke(entry.pen, (Circle((x + _SAMPLE / 2, y), entry.radius),)),))
        elif entry.pen is not None:
            made += PageContent(traces=(TracedPolyline(entry.pen, np.array([[x, y], [x + _SAMPLE, y]])),))
        if entry.pen is not None:
            indent = _SAMPLE + _EDGE
        made += PageContent(
            words=(
                TextLine(fitted(entry.text, _TEXT, wide - indent - 2 * _EDGE), (x + indent, y - 0.36 * _TEXT), _TEXT),
            )
        )
    return made
