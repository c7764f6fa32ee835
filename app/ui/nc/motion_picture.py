"""Paints a program's motions from one side: rapids dotted, plunges in their own hue, cuts by tool or by kind of motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.edit.sample import Box
from app.model.motion import MotionKind
from app.nc.read.program import StockNote, ToolNote
from app.ui.canvas.curve_path import MANY, path_of
from app.ui.canvas.pens import FINE, screen_pen
from app.ui.canvas.program_chunks import rapids_path
from app.ui.canvas.program_geometry import RUN
from app.ui.canvas.program_picture import CUT_WIDTH, RAPID_DOTS, RAPID_WIDTH, paint_plunges
from app.ui.canvas.view import View
from app.ui.nc.motion_shapes import Look, MotionShapes, Side, tools_of
from app.ui.theme import Theme, text_font

Floats = NDArray[np.float64]

_MANY_RAPIDS = 1_500
"""So many dotted lines take Qt too long; they are painted faint instead."""


_KEY_PX, _MOST_TOOLS = 18, 8
_MIX = np.uint64(0x9E3779B97F4A7C15)
_KIND_NAMES = {MotionKind.RAPID: "G0 rapid", MotionKind.LINE: "G1 line", MotionKind.ARC_CW: "G2 clockwise",
               MotionKind.ARC_CCW: "G3 counter-clockwise", MotionKind.SPLINE: "Spline"}


class PathColour(Enum):
    """What the colour of a motion tells."""

    TOOL = "tool"
    MOTION = "motion"


@dataclass(frozen=True, slots=True)
class PathPaint:
    """How a picture is painted.

    Attributes:
        one: a single hue for everything, for a program laid under another; None = colours that tell something.
        width: of cuts, px, unless there are very many.
    """

    theme: Theme
    colour: PathColour = PathColour.TOOL
    one: QColor | None = None
    width: float = CUT_WIDTH


@dataclass(frozen=True, slots=True)
class _Chunk:
    """Motions of one look: a path in mm, and what its colour depends on."""

    path: QPainterPath
    look: Look
    tool: int
    kind: MotionKind


def tool_colour(order: int, theme: Theme) -> QColor:
    """Return the colour of the program's first (0), second (1), ... tool."""
    three = (theme.pocket, theme.contour, theme.rest)
    return three[order] if order < len(three) else theme.regions[(order - 1) % len(theme.regions)]


def motion_colour(kind: MotionKind, theme: Theme) -> QColor:
    """Return the colour of a kind of motion."""
    return {MotionKind.RAPID: theme.rapid, MotionKind.LINE: theme.pocket, MotionKind.ARC_CW: theme.contour,
            MotionKind.ARC_CCW: theme.rest, MotionKind.SPLINE: theme.parameter}[kind]


def _tool_name(number: int, note: ToolNote | None) -> str:
    """Return a tool's number and what the program's comments tell of it."""
    words = [f"T{number}" if number else "No tool"]
    if note is not None:
        words += [note.kind] if note.kind else []
        words += [f"{note.diameter:g} mm"] if note.diameter else []
    return " ".join(words)


def paint_stock(painter: QPainter, view: View, stock: StockNote | None, side: Side, theme: Theme) -> None:
    """Paint the outline of the stock that the program's comments tell of, where they tell enough of it."""
    if stock is None:
        return
    low, high = ([corner[axis] for axis in side.value] for corner in (stock.low, stock.high))
    if all(map(math.isfinite, (*low, *high))):
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.muted, 1.0, Qt.PenStyle.DashLine))
        painter.drawRect(QRectF(view.to_screen((low[0], high[1])), view.to_screen((high[0], low[1]))))


def paint_key(painter: QPainter, area: QRectF, key: list[tuple[str, QColor]], theme: Theme) -> None:
    """Paint what colours mean in the upper right corner of an area, px."""
    painter.setFont(text_font(12))
    wide = max((painter.fontMetrics().horizontalAdvance(words) for words, _ in key), default=0)
    left, top = area.right() - wide - 48, area.top() + 10
    ground = QColor(theme.canvas)
    ground.setAlphaF(0.88)
    painter.fillRect(QRectF(left - 8, top - 4, wide + 48, len(key) * _KEY_PX + 8), ground)
    for at, (words, colour) in enumerate(key):
        middle = top + (at + 0.5) * _KEY_PX
        painter.fillRect(QRectF(left, middle - 1, 20, 2), colour)
        painter.setPen(theme.muted)
        painter.drawText(QRectF(left + 28, middle - _KEY_PX / 2, wide + 4, _KEY_PX), Qt.AlignmentFlag.AlignVCenter, words)


class MotionPicture:
    """One program seen from one side, ready to paint.

    Attributes:
        shapes: its motions. side: from where they are seen.
        tools: T numbers that cut, in order; what colours by tool count.
    """

    def __init__(self, shapes: MotionShapes, side: Side) -> None:
        """Build every path once, in mm."""
        self.shapes, self.side, self.tools = shapes, side, tools_of(shapes)
        self._order = {tool: at for at, tool in enumerate(self.tools)}
        self._chunks: list[_Chunk] = []
        self._boxes: Floats = np.zeros((0, 4))
        self._sizes = np.zeros(0, np.int64)
        columns = list(side.value)
        motions = shapes.program.motions
        plunge = shapes.look == Look.PLUNGE
        self._plunges = _once(motions.end[plunge][:, columns]) if side is Side.XY else np.zeros((0, 2))
        rapid = np.hstack([motions.start[:, columns], motions.end[:, columns]])[shapes.look == Look.RAPID]
        self._rapids = _once(rapid[np.any(rapid[:, :2] != rapid[:, 2:], axis=1)])
        self._cut(shapes)

    @cached_property
    def box(self) -> Box | None:
        """x0, y0, x1, y1 of all that is seen, mm; None when there is nothing."""
        return self.box_of(None)

    def key(self, how: PathPaint) -> list[tuple[str, QColor]]:
        """Return what each colour means, of the first eight tools or of the kinds of motion that there are."""
        plunge = [("Plunge", how.theme.plunge)] if np.any(self.shapes.look == Look.PLUNGE) else []
        if how.colour is PathColour.TOOL:
            notes = {note.number: note for note in reversed(self.shapes.program.tools)}
            tools = self.tools[:_MOST_TOOLS]
            return [(_tool_name(tool, notes.get(tool)), tool_colour(at, how.theme)) for at, tool in enumerate(tools)] + plunge
        kinds = np.unique(self.shapes.program.motions.kind).tolist()
        return [(_KIND_NAMES[MotionKind(kind)], motion_colour(MotionKind(kind), how.theme)) for kind in kinds] + plunge

    def box_of(self, motions: NDArray[np.int64] | None) -> Box | None:
        """Return x0, y0, x1, y1 of some motions seen from this side, mm."""
        corners = self.shapes.box(motions)
        if corners is None:
            return None
        (x0, y0), (x1, y1) = (corner[list(self.side.value)].tolist() for corner in corners)
        return (x0, y0, x1, y1)

    def paint(self, painter: QPainter, view: View, box: Box, how: PathPaint) -> None:
        """Paint what lies in a box in mm; the painter works in screen px."""
        painter.save()
        painter.setTransform(view.transform(), True)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        self._paint_rapids(painter, box, how)
        boxes = self._boxes
        near = (boxes[:, 0] <= box[2]) & (boxes[:, 2] >= box[0]) & (boxes[:, 1] <= box[3]) & (boxes[:, 3] >= box[1])
        seen = np.flatnonzero(near)
        width = FINE if int(self._sizes[seen].sum()) > MANY else how.width
        for chunk in (self._chunks[k] for k in seen):
            painter.setPen(screen_pen(painter, self._colour(chunk, how), width))
            painter.drawPath(chunk.path)
        painter.restore()
        paint_plunges(painter, view, self._plunges, box, (how.one or how.theme.plunge, how.theme.canvas))

    def _paint_rapids(self, painter: QPainter, box: Box, how: PathPaint) -> None:
        path = rapids_path(self._rapids, box)
        colour = QColor(how.one or how.theme.rapid)
        if path.elementCount() > 2 * _MANY_RAPIDS:
            colour.setAlphaF(0.35)
            painter.setPen(screen_pen(painter, colour, FINE))
        else:
            painter.setPen(screen_pen(painter, colour, RAPID_WIDTH, RAPID_DOTS))
        painter.drawPath(path)

    def _colour(self, chunk: _Chunk, how: PathPaint) -> QColor:
        if how.one is not None:
            return how.one
        if chunk.look is Look.PLUNGE:
            return how.theme.plunge
        return motion_colour(chunk.kind, how.theme) if how.colour is PathColour.MOTION else tool_colour(self._order[chunk.tool], how.theme)

    def _cut(self, shapes: MotionShapes) -> None:
        """Cut the feeds into chunks of about 96 motions of one look, tool and kind."""
        seen = shapes.look != Look.RAPID
        if self.side is Side.XY:
            seen &= shapes.look != Look.PLUNGE
        rows = np.flatnonzero(seen)
        tools, tool = np.unique(shapes.tool[rows], return_inverse=True)
        codes = (tool * len(Look) + shapes.look[rows]) * len(MotionKind) + shapes.program.motions.kind[rows]
        boxes, sizes = [np.zeros((0, 4))], [np.zeros(0, np.int64)]
        for code in np.unique(codes).tolist():
            own = rows[codes == code]
            look, kind = Look(code // len(MotionKind) % len(Look)), MotionKind(code % len(MotionKind))
            elements, at = shapes.elements(own, self.side, RUN)
            edges = np.append(at[:-1:RUN], at[-1])
            data = elements.tobytes()
            for first, last in pairwise((edges * elements.itemsize).tolist()):
                self._chunks.append(_Chunk(path_of(data[first:last]), look, int(tools[code // len(MotionKind) // len(Look)]), kind))
            boxes.append(self._boxes_of(own))
            sizes.append(np.diff(edges))
        self._boxes, self._sizes = np.concatenate(boxes), np.concatenate(sizes)

    def _boxes_of(self, motions: NDArray[np.int64]) -> Floats:
        """Return (k, 4) boxes of every 96 of some motions, mm."""
        columns, first = list(self.side.value), np.arange(0, len(motions), RUN)
        low, high = self.shapes.low[motions][:, columns], self.shapes.high[motions][:, columns]
        return np.hstack([np.minimum.reduceat(low, first), np.maximum.reduceat(high, first)])


def _once(rows: Floats) -> Floats:
    """Return (n, k) rows, each once, sorted by nothing in particular.

    Rows are told apart by 64 bits mixed from their numbers: numpy's own way through rows stops every thread.
    """
    mixed = np.zeros(len(rows), np.uint64)
    for column in (rows + 0.0).T:
        mixed = (mixed ^ np.ascontiguousarray(column).view(np.uint64)) * _MIX
        mixed ^= mixed >> np.uint64(29)
    return rows[np.unique(mixed, return_index=True)[1]]
