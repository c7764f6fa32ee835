"""Paints a program's motions from one side: rapids dotted, plunges in their own hue, cuts by tool or by kind of
motion.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter

from .....gcode.interpreter.program import StockNote, ToolNote
from .....geometry.coincident_points import row_keys
from .....geometry.sample import Box
from .....model.motion import MotionKind
from ....framework.theme import Theme
from ...canvas.painting.curve_path import MANY
from ...canvas.painting.pens import FINE, screen_pen
from ...canvas.painting.program_chunks import rapids_path
from ...canvas.painting.program_layer import CONTOUR_DASHES, CUT_WIDTH, RAPID_DOTS, RAPID_WIDTH, paint_plunges
from ...canvas.view_transform import ViewTransform
from ..motion_shapes import (
    Floats,
    Ints,
    MotionLineStyle,
    MotionShapes,
    ViewSide,
    contour_inks,
    tool_inks,
    tools_of,
)
from .motion_chunks import MotionChunk, MotionChunks, chunks_by_style, contour_chunks
from .path_key import KeyMark, KeyRow

_MANY_RAPIDS = 1_500
"""So many dotted lines take Qt too long; they are painted faint instead."""


_MOST_TOOLS = 8
_PORTION = 15_000
"""Elements of paths that are painted before the window listens again."""

_KIND_NAMES = {
    MotionKind.RAPID: "G0 rapid",
    MotionKind.LINE: "G1 line",
    MotionKind.ARC_CW: "G2 clockwise",
    MotionKind.ARC_CCW: "G3 counter-clockwise",
    MotionKind.SPLINE: "Spline",
}


class MotionColourBy(Enum):
    """What the colour of a motion tells."""

    TOOL = "tool"
    MOTION = "motion"


@dataclass(frozen=True, slots=True)
class MotionPaint:
    """How a picture is painted.

    Attributes:
        one: a single hue for everything, for a program laid under another; None = colours that tell something.
        width: of cuts, px, unless there are very many.
    """

    theme: Theme
    colour: MotionColourBy = MotionColourBy.TOOL
    one: QColor | None = None
    width: float = CUT_WIDTH


def tool_colour(ink: int, theme: Theme) -> QColor:
    """Return the colour at a place in the cycle of tools, from 0 (`motion_shapes.tool_inks`)."""
    return theme.tools[ink % len(theme.tools)]


def motion_colour(kind: MotionKind, theme: Theme) -> QColor:
    """Return the colour of a kind of motion."""
    return {
        MotionKind.RAPID: theme.rapid,
        MotionKind.LINE: theme.pocket,
        MotionKind.ARC_CW: theme.contour,
        MotionKind.ARC_CCW: theme.rest,
        MotionKind.SPLINE: theme.parameter,
    }[kind]


def _kind_row(kind: MotionKind, theme: Theme) -> KeyRow:
    mark = KeyMark.DOTS if kind is MotionKind.RAPID else KeyMark.LINE
    return KeyRow(_KIND_NAMES[kind], motion_colour(kind, theme), mark)


def _tool_name(number: int, note: ToolNote | None) -> str:
    """Return a tool's number and what the program's comments tell of it."""
    words = [f"T{number}" if number else "No tool"]
    if note is not None:
        words += [note.kind] if note.kind else []
        words += [f"{note.diameter:g} mm"] if note.diameter else []
    return " ".join(words)


def stock_outline(view: ViewTransform, stock: StockNote | None, side: ViewSide) -> QRectF | None:
    """Return the outline of the stock that a program's comments tell of, px; None where that is not enough."""
    if stock is None:
        return None
    low, high = ([corner[axis] for axis in side.value] for corner in (stock.low, stock.high))
    if not all(map(math.isfinite, (*low, *high))):
        return None
    return QRectF(view.to_screen((low[0], high[1])), view.to_screen((high[0], low[1])))


class MotionLayer:
    """One program seen from one side, ready to paint.

    Attributes:
        shapes: its motions. side: from where they are seen. only: which of them are shown; None = all.
        tools: T numbers that cut, in order; what colours by tool count.
        box: x0, y0, x1, y1 of all that is seen, mm; None when there is nothing.
    """

    def __init__(self, shapes: MotionShapes, side: ViewSide, only: Ints | None = None) -> None:
        """Build every path once, in mm."""
        self.shapes, self.side, self.only, self.tools = shapes, side, only, tools_of(shapes)
        self._inks, self._contour_inks = tool_inks(shapes), contour_inks(shapes)
        columns, motions = list(side.value), shapes.program.motions
        rows = shapes.seen(side, only)
        look = shapes.look[rows]
        plunge = rows[look == MotionLineStyle.PLUNGE] if side is ViewSide.XY else rows[:0]
        self._plunges = _once(motions.end[plunge][:, columns])
        rapid = np.hstack([motions.start[:, columns], motions.end[:, columns]])[rows[look == MotionLineStyle.RAPID]]
        self._rapids = _once(rapid[np.any(rapid[:, :2] != rapid[:, 2:], axis=1)])
        feeds = (MotionLineStyle.CUT,) if side is ViewSide.XY else (MotionLineStyle.CUT, MotionLineStyle.PLUNGE)
        plain, contour = (
            chunks_by_style(shapes, side, rows[np.isin(look, feeds)]),
            rows[look == MotionLineStyle.CONTOUR],
        )
        self._chunks = {
            colour: MotionChunks.joined([plain, contour_chunks(shapes, side, contour, colour is MotionColourBy.MOTION)])
            for colour in MotionColourBy
        }
        self.box = self.box_of(only)
        self._kinds = np.unique(motions.kind).tolist()
        looks = np.unique(shapes.tool.astype(np.int64) * len(MotionLineStyle) + shapes.look)
        self._looks = set(
            zip((looks // len(MotionLineStyle)).tolist(), (looks % len(MotionLineStyle)).tolist(), strict=True)
        )

    @property
    def some(self) -> bool:
        """Whether any motions are shown."""
        return len(self.shapes if self.only is None else self.only) > 0

    def key(self, how: MotionPaint) -> list[KeyRow]:
        """Return what lines mean, of the first eight tools or of the kinds of motion that there are."""
        theme, looks = how.theme, {look for _, look in self._looks}
        down = KeyMark.PLUNGE if self.side is ViewSide.XY else KeyMark.LINE
        plunge = [KeyRow("Plunge", theme.plunge, down)] if MotionLineStyle.PLUNGE in looks else []
        if how.colour is MotionColourBy.TOOL:
            return [
                row for at in range(min(len(self.tools), _MOST_TOOLS)) for row in self._tool_rows(at, theme)
            ] + plunge
        rows = [_kind_row(MotionKind(kind), theme) for kind in self._kinds]
        contour = [KeyRow("Contour", theme.muted, KeyMark.DASHES)] if MotionLineStyle.CONTOUR in looks else []
        return rows + contour + plunge

    def _tool_rows(self, at: int, theme: Theme) -> list[KeyRow]:
        """Return the lines of the key for the tool at a place in order: what it cuts, and dashed the contours that it
        cuts.
        """
        tool = self.tools[at]
        note = next((note for note in self.shapes.program.tools if note.number == tool), None)
        words, colour = _tool_name(tool, note), tool_colour(self._inks[tool], theme)
        contour = (tool, MotionLineStyle.CONTOUR) in self._looks
        rows = [KeyRow(words, colour)] if (tool, MotionLineStyle.CUT) in self._looks or not contour else []
        along = tool_colour(self._contour_inks[tool], theme)
        return [*rows, KeyRow(f"{words}, contour", along, KeyMark.DASHES)] if contour else rows

    def box_of(self, motions: Ints | None) -> Box | None:
        """Return x0, y0, x1, y1 of some motions seen from this side, mm."""
        rows, columns = self.shapes.seen(self.side, motions), list(self.side.value)
        if not len(rows):
            return None
        x0, y0 = self.shapes.low[rows][:, columns].min(axis=0).tolist()
        x1, y1 = self.shapes.high[rows][:, columns].max(axis=0).tolist()
        return (x0, y0, x1, y1)

    def paint(self, painter: QPainter, view: ViewTransform, box: Box, how: MotionPaint) -> None:
        """Paint what lies in a box in mm; the painter works in screen px."""
        for paint_portion in self.portions(view, box, how):
            paint_portion(painter)

    def portions(self, view: ViewTransform, box: Box, how: MotionPaint) -> Iterator[Callable[[QPainter], None]]:
        """Yield what `paint` paints as portions that take a few ms each, to be painted in their order."""
        yield lambda painter: self._paint_rapids(painter, view, box, how)
        boxes, sizes = self._chunks[how.colour].boxes, self._chunks[how.colour].sizes
        near = (boxes[:, 0] <= box[2]) & (boxes[:, 2] >= box[0]) & (boxes[:, 1] <= box[3]) & (boxes[:, 3] >= box[1])
        seen = np.flatnonzero(near)
        share = np.cumsum(sizes[seen])
        width = FINE if len(seen) and share[-1] > MANY else how.width
        for part in np.split(seen, np.flatnonzero(np.diff(share // _PORTION)) + 1):
            chunks = [self._chunks[how.colour].chunks[k] for k in part]
            yield lambda painter, chunks=chunks: self._paint_chunks(painter, view, chunks, replace(how, width=width))  # type: ignore[misc]
        colours = (how.one or how.theme.plunge, how.theme.canvas)
        yield lambda painter: paint_plunges(painter, view, self._plunges, box, colours)

    def _paint_chunks(
        self, painter: QPainter, view: ViewTransform, chunks: list[MotionChunk], how: MotionPaint
    ) -> None:
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for chunk in chunks:
            pen = screen_pen(
                painter,
                self._colour(chunk, how),
                how.width,
                CONTOUR_DASHES if chunk.look is MotionLineStyle.CONTOUR else (),
            )
            if chunk.begins_at:
                pen.setDashOffset(chunk.begins_at * view.scale * painter.device().devicePixelRatioF() / pen.widthF())
            painter.setPen(pen)
            painter.drawPath(chunk.path)
        painter.restore()

    def _paint_rapids(self, painter: QPainter, view: ViewTransform, box: Box, how: MotionPaint) -> None:
        path = rapids_path(self._rapids, box)
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        colour = QColor(how.one or how.theme.rapid)
        if path.elementCount() > 2 * _MANY_RAPIDS:
            colour.setAlphaF(0.35)
            painter.setPen(screen_pen(painter, colour, FINE))
        else:
            painter.setPen(screen_pen(painter, colour, RAPID_WIDTH, RAPID_DOTS))
        painter.drawPath(path)
        painter.restore()

    def _colour(self, chunk: MotionChunk, how: MotionPaint) -> QColor:
        if how.one is not None:
            return how.one
        if chunk.look is MotionLineStyle.PLUNGE:
            return how.theme.plunge
        if how.colour is MotionColourBy.MOTION:
            return motion_colour(chunk.kind, how.theme)
        contour = chunk.look is MotionLineStyle.CONTOUR
        return tool_colour((self._contour_inks if contour else self._inks)[chunk.tool], how.theme)


def _once(rows: Floats) -> Floats:
    """Return (n, k) rows, each once, sorted by nothing in particular."""
    return rows[np.unique(row_keys(rows), return_index=True)[1]]
