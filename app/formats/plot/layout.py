"""Lays a drawing out on paper at a stated scale: one sheet, or several that overlap and tell where they are joined."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from ...core.errors import InputError
from ...geometry.sample import bounds
from ...geometry.transform import Similarity
from ...model.curves import Line, Point
from ...model.part import Units
from .page import Box, PageContent, Paper, Pen, PenStroke, PlotPage, TextLine, fitted

MARGIN, STRIP, OVERLAP = 10.0, 12.0, 10.0
"""Paper round the frame, height of the title strip, and what neighbouring sheets have in common, mm."""

MOST_PAGES = 200
"""Of a plot; more are a slip of the scale."""
_ROOM = 4.0
"""mm between the drawing and the edge of the page, at least."""
_TICK = 3.0
"""Length of the marks where pages are joined, mm."""
_FRAME, _THIN = Pen(1, "#000000", 0.5), Pen(1, "#000000", 0.18)
_CELLS = ((0.0, "Name"), (0.40, "Scale"), (0.58, "Units"), (0.68, "Date"), (0.86, "Sheet"))
"""Where the cells of the title strip begin, as parts of its width."""

_CAPTION_MM, _TEXT_MM = 2.2, 3.5
"""Heights of letters, mm."""
_EPSILON = 1e-6
"""mm; a drawing that is no wider is a point."""


@dataclass(frozen=True, slots=True)
class PlotOptions:
    """How a drawing is laid out.

    Attributes:
        scale: size on paper over size of the part; None = as large as one sheet holds.
        landscape: the long side lies across. framed: with a frame and a title strip.
    """

    paper: Paper = Paper.A4
    landscape: bool = True
    scale: float | None = None
    framed: bool = True


class PlotContent(Protocol):
    """What can be plotted."""

    @property
    def title(self) -> str:
        """Its name."""

    @property
    def units(self) -> Units:
        """That its lengths are told in."""

    @property
    def strip(self) -> float:
        """Height of the legend under the drawing, mm on paper; 0: none."""

    def box(self) -> Box | None:
        """Return x0, y0, x1, y1 round all of it, mm; None when there is nothing."""

    def ink(self, scale: float) -> PageContent:
        """Return the ink, in mm, for paper on which it is `scale` times as large."""

    def legend(self, box: Box) -> PageContent:
        """Return the legend for that place on the paper."""


@dataclass(frozen=True)
class Plot:
    """A drawing on paper.

    Attributes:
        pages: row by row from the upper left. columns: sheets in a row. scale: size on paper over size of the part.
    """

    pages: tuple[PlotPage, ...]
    columns: int
    scale: float


@dataclass(frozen=True, slots=True)
class _SheetGrid:
    """How many sheets there are, where the drawing lies on the whole of them, and the window of each on its paper."""

    columns: int
    rows: int
    window: Box
    scale: float
    corner: Point

    @property
    def step(self) -> Point:
        x0, y0, x1, y1 = self.window
        return (x1 - x0 - OVERLAP, y1 - y0 - OVERLAP)

    def place(self, column: int, row: int) -> Similarity:
        """Return what takes the part's mm to the paper of one sheet; row 0 is the lowest."""
        x = self.window[0] + self.corner[0] - column * self.step[0]
        y = self.window[1] + self.corner[1] - row * self.step[1]
        return Similarity(complex(self.scale), complex(x, y))


def scale_words(scale: float) -> str:
    """Return a scale as people write it: 1 : 1, 2 : 1, 1 : 2.5."""
    return f"{scale:.6g} : 1" if scale >= 1 else f"1 : {1 / scale:.6g}"


def lay_out(shown: PlotContent, options: PlotOptions, date: str = "") -> Plot:
    """Return the sheets.

    Args:
        shown: what is plotted. options: on what, and how large.
        date: written into the title strip as it is.

    Raises:
        InputError: there is nothing to plot, or it takes more than 200 sheets.
    """
    box = shown.box()
    if box is None:
        raise InputError("Nothing is drawn that could be plotted; layers that are hidden are not plotted.")
    width, height = sorted(options.paper.value, reverse=options.landscape)
    whole = _window(width, height, options.framed)
    window = (whole[0], whole[1] + shown.strip, *whole[2:])
    sheets = _sheets(box, window, options.scale)
    ink, count = shown.ink(sheets.scale), sheets.columns * sheets.rows
    pages: list[PlotPage] = []
    for row in reversed(range(sheets.rows)):
        for column in range(sheets.columns):
            place = sheets.place(column, row)
            seen = _seen(ink, place, sheets.window) if count > 1 else ink
            page = PlotPage(width, height, sheets.window, place, seen)
            title = (shown.title, scale_words(sheets.scale), _unit(shown.units), date, f"{len(pages) + 1} of {count}")
            frame = _frame(whole, title) if options.framed else PageContent()
            if shown.strip:
                frame += _legend(shown, whole)
            pages.append(replace(page, frame=frame + _marks(sheets, column, row)))
    return Plot(tuple(pages), sheets.columns, sheets.scale)


def _unit(units: Units) -> str:
    return "inch" if units in (Units.INCH, Units.FOOT) else "mm"


def _window(width: float, height: float, framed: bool) -> Box:
    return (MARGIN, MARGIN + (STRIP if framed else 0.0), width - MARGIN, height - MARGIN)


def _sheets(box: Box, window: Box, scale: float | None) -> _SheetGrid:
    wide, high = window[2] - window[0], window[3] - window[1]
    across, up = box[2] - box[0], box[3] - box[1]
    if scale is None:
        room = (wide - 2 * _ROOM) / max(across, _EPSILON), (high - 2 * _ROOM) / max(up, _EPSILON)
        scale = 1.0 if max(across, up) < _EPSILON else _stated(min(room))
    columns, rows = _count(across * scale, wide), _count(up * scale, high)
    if columns * rows > MOST_PAGES:
        raise InputError(
            f"At {scale_words(scale)} this takes {columns * rows} sheets; choose larger paper or a smaller scale."
        )
    whole = (columns * (wide - OVERLAP) + OVERLAP, rows * (high - OVERLAP) + OVERLAP)
    corner = ((whole[0] - across * scale) / 2 - box[0] * scale, (whole[1] - up * scale) / 2 - box[1] * scale)
    return _SheetGrid(columns, rows, window, scale, corner)


def _count(length: float, room: float) -> int:
    return 1 if length <= room + _EPSILON else math.ceil((length - OVERLAP - _EPSILON) / (room - OVERLAP))


def _stated(scale: float) -> float:
    """Return the next smaller scale that three figures state exactly."""
    if scale >= 1:
        step = 10.0 ** (math.floor(math.log10(scale)) - 2)
        return math.floor(scale / step + 1e-9) * step
    step = 10.0 ** (math.floor(math.log10(1 / scale)) - 2)
    return 1 / (math.ceil(1 / scale / step - 1e-9) * step)


def _seen(ink: PageContent, place: Similarity, window: Box) -> PageContent:
    """Return what of the ink may reach into a window of the paper."""
    (x0, y0), (x1, y1) = (
        (z.real, z.imag) for z in ((complex(*corner) - place.b) / place.a for corner in (window[:2], window[2:]))
    )
    strokes = []
    for stroke in ink.strokes:
        boxes = ((curve, bounds(curve)) for curve in stroke.curves)
        near = tuple(curve for curve, b in boxes if b[0] <= x1 and b[2] >= x0 and b[1] <= y1 and b[3] >= y0)
        if near:
            strokes.append(PenStroke(stroke.pen, near))
    traces = tuple(
        trace
        for trace in ink.traces
        if np.all(trace.points.min(axis=0) <= (x1, y1)) and np.all(trace.points.max(axis=0) >= (x0, y0))
    )
    return replace(ink, strokes=tuple(strokes), traces=traces)


def _box_lines(box: Box) -> tuple[Line, ...]:
    x0, y0, x1, y1 = box
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    return tuple(Line(a, b) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True))


def _legend(shown: PlotContent, whole: Box) -> PageContent:
    """Return the legend and the line above it."""
    x0, y0, x1, _ = whole
    top = y0 + shown.strip
    return PageContent((PenStroke(_THIN, (Line((x0, top), (x1, top)),)),)) + shown.legend((x0, y0, x1, top))


def _frame(whole: Box, title: tuple[str, ...]) -> PageContent:
    """Return the frame and the title strip under all else."""
    x0, y0, x1, y1 = whole
    low, width = y0 - STRIP, x1 - x0
    outer = PenStroke(_FRAME, _box_lines((x0, low, x1, y1)))
    lefts = [x0 + part * width for part, _ in _CELLS]
    inner = PenStroke(_THIN, (Line((x0, y0), (x1, y0)), *(Line((x, low), (x, y0)) for x in lefts[1:])))
    words: list[TextLine] = []
    for x, right, (_, caption), text in zip(lefts, (*lefts[1:], x1), _CELLS, title, strict=True):
        words.append(TextLine(caption, (x + 2, y0 - 3.6), _CAPTION_MM))
        words.append(TextLine(fitted(text, _TEXT_MM, right - x - 4), (x + 2, low + 2.6), _TEXT_MM))
    return PageContent((outer, inner), (), tuple(words))


def _marks(sheets: _SheetGrid, column: int, row: int) -> PageContent:
    """Return the marks in the middle of overlaps: crosses that come to lie on one another, ticks at the window's
    edge.
    """
    x0, y0, x1, y1 = sheets.window
    half, lines = OVERLAP / 2, []
    ups = [x for x, there in ((x0 + half, column > 0), (x1 - half, column < sheets.columns - 1)) if there]
    acrosses = [y for y, there in ((y0 + half, row > 0), (y1 - half, row < sheets.rows - 1)) if there]
    for x in ups:
        lines += [Line((x, y0), (x, y0 + _TICK)), Line((x, y1 - _TICK), (x, y1))]
    for y in acrosses:
        lines += [Line((x0, y), (x0 + _TICK, y)), Line((x1 - _TICK, y), (x1, y))]
    for x, y in (
        *((x, (y0 + y1) / 2) for x in ups),
        *(((x0 + x1) / 2, y) for y in acrosses),
        *((x, y) for x in ups for y in acrosses),
    ):
        lines += [Line((x - _TICK, y), (x + _TICK, y)), Line((x, y - _TICK), (x, y + _TICK))]
    return PageContent((PenStroke(_THIN, tuple(lines)),)) if lines else PageContent()
