"""The way of a cut along time: how much is taken, by which tool, what goes wrong when; a click goes there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QToolTip, QWidget

from ...framework.figures import grouped
from ...framework.theme import mixed
from ...framework.themed import Themed
from .panel import colour_of

if TYPE_CHECKING:
    from ....usecases.cutting.timeline import Timeline, TimelineColumns
    from .cut_picture import CutMoves
    from .cut_player import TimelineMark

HEIGHT = 58
_EDGE, _BAND, _TOP, _HANDLE, _MARK = 12, 5, 9, 5.0, 4.0
"""px: margins at the sides, the tools' band, room for marks above the plot, half of the cursor's handle and of a
mark.
"""

_FULL = 0.985
"""Share of the columns that the plot's height is made for: a few moves that take much more stick out."""


@dataclass(frozen=True, eq=False)
class _Columns:
    """What is painted for one width."""

    sampled: TimelineColumns
    scale: float


class TimePlot(Themed, QWidget):
    """Painted once for each width; the cursor moves over it.

    Signals:
        requested(seconds): the user wants to be there.
    """

    requested = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(HEIGHT)
        self.setMouseTracking(True)
        self.setAccessibleName("Timeline: cross-section of the cut and metal removed; click to go there")
        self._marks: tuple[TimelineMark, ...] = ()
        self._at = 0.0
        self._columns: _Columns | None = None
        self._timeline: Timeline | None = None
        self._moves: CutMoves | None = None

    def show_timeline(
        self, timeline: Timeline | None, marks: tuple[TimelineMark, ...], moves: CutMoves | None = None
    ) -> None:
        """Show another way, or none; its moves tell the colours of the tools."""
        if timeline is self._timeline and marks == self._marks and moves is self._moves:
            return
        self._timeline, self._marks, self._moves, self._columns = timeline, marks, moves, None
        self.setCursor(Qt.CursorShape.PointingHandCursor if timeline is not None else Qt.CursorShape.ArrowCursor)
        self.update()

    def show_time(self, seconds: float) -> None:
        """Put the cursor elsewhere."""
        before, self._at = self._x(self._at), seconds
        for x in (before, self._x(seconds)):
            self.update(QRectF(x - _HANDLE - 2, 0, 2 * _HANDLE + 4, HEIGHT).toAlignedRect())

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Plot for another width."""
        self._columns = None

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Go where it was clicked."""
        if event.button() is Qt.MouseButton.LeftButton:
            self._go(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Drag the cursor; else tell what is there."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._go(event.position().x())
        elif self._timeline is not None:
            QToolTip.showText(
                event.globalPosition().toPoint(), self.words_at(self._seconds(event.position().x())), self
            )

    def words_at(self, seconds: float) -> str:
        """Return what goes on at a time."""
        timeline = self._timeline
        if timeline is None or not len(timeline):
            return ""
        moment = timeline.at(seconds)
        row = timeline.current(moment)
        section = (
            timeline.volume[row] / timeline.length[row] if len(timeline.volume) and timeline.length[row] > 0 else 0.0
        )
        waits = "waits, " if seconds < timeline.begins[row] or seconds > timeline.ends[row] else ""
        return (
            f"{exact_clock(seconds)} · {waits}line {timeline.line[row]} · T{timeline.tool[row]} · cut {section:.3f} "
            f"mm² · {grouped(timeline.removed_at(moment), 1)} mm³ removed"
        )

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the plot, the tools, the marks and the cursor."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        room = self._room()
        painter.fillRect(room, mixed(self._theme.canvas, self._theme.hover, 0.6))
        timeline = self._timeline
        if timeline is None or timeline.total <= 0:
            return
        columns = self._plotted(timeline)
        self._paint_done(painter, room)
        self._paint_areas(painter, room, columns)
        self._paint_tools(painter, room, timeline)
        self._paint_marks(painter, timeline)
        self._paint_cursor(painter)

    def _room(self) -> QRectF:
        return QRectF(_EDGE, _TOP, max(self.width() - 2 * _EDGE, 1), HEIGHT - _TOP - _BAND - 6)

    def _plotted(self, timeline: Timeline) -> _Columns:
        if self._columns is None:
            sampled = timeline.sampled(max(int(self._room().width()), 1))
            cutting = sampled.mean[sampled.mean > 0]
            scale = float(np.quantile(cutting, _FULL)) if len(cutting) else 1.0
            self._columns = _Columns(sampled, max(scale, 1e-9))
        return self._columns

    def _paint_done(self, painter: QPainter, room: QRectF) -> None:
        """Tint the time that is gone."""
        painter.fillRect(
            QRectF(room.left(), room.top(), self._x(self._at) - room.left(), room.height()),
            mixed(self._theme.canvas, self._theme.chosen, 0.55),
        )

    def _paint_areas(self, painter: QPainter, room: QRectF, columns: _Columns) -> None:
        sampled, theme = columns.sampled, self._theme
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        heights = np.minimum(sampled.mean / columns.scale, 1.0) * (room.height() - 2)
        peaks = np.minimum(sampled.most / columns.scale, 1.0) * (room.height() - 2)
        for values, part in ((peaks, 0.28), (heights, 0.72)):
            painter.setPen(QPen(mixed(theme.canvas, theme.pocket, part), 1))
            painter.drawLines([_upright(room, k, float(height)) for k, height in enumerate(values) if height >= 0.5])
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        total = float(sampled.removed[-1])
        if total > 0:
            low, tall = room.bottom() - 1, room.height() - 4
            line = [QPointF(room.left() + k, low - share * tall) for k, share in enumerate(sampled.removed / total)]
            painter.setPen(QPen(theme.muted, 1.2))
            painter.drawPolyline(QPolygonF(line))

    def _paint_tools(self, painter: QPainter, room: QRectF, timeline: Timeline) -> None:
        """Draw which tool is in the spindle, in the colours that its cuts have."""
        ends = np.concatenate([[0], timeline.tool_changes, [len(timeline)]])
        for first, last in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
            if last <= first:
                continue
            begin = self._x(float(timeline.ends[first - 1]) if first else 0.0)
            end = self._x(float(timeline.ends[last - 1]) if last < len(timeline) else timeline.total)
            number = int(timeline.tool[first])
            ink = self._moves.ink_of(number) if self._moves is not None else number - 1
            colour = self._theme.tools[ink % len(self._theme.tools)]
            painter.fillRect(QRectF(begin, room.bottom() + 3, max(end - begin - 1, 1), _BAND), colour)
            if first:
                painter.fillRect(QRectF(begin - 1, room.top(), 1, room.height()), self._theme.hairline)

    def _paint_marks(self, painter: QPainter, timeline: Timeline) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        for mark in self._marks:
            x = self._x(float(timeline.ends[min(mark.motion, len(timeline)) - 1]))
            painter.setBrush(colour_of(mark.colour, self._theme))
            painter.drawPolygon(QPolygonF([QPointF(x - _MARK, 1), QPointF(x + _MARK, 1), QPointF(x, 1 + 1.6 * _MARK)]))

    def _paint_cursor(self, painter: QPainter) -> None:
        x, theme = self._x(self._at), self._theme
        painter.setPen(QPen(theme.ink, 1.5))
        painter.drawLine(QPointF(x, _TOP - 2), QPointF(x, HEIGHT - 3))
        painter.setPen(QPen(theme.canvas, 1.5))
        painter.setBrush(theme.accent)
        painter.drawEllipse(QPointF(x, _TOP - 1), _HANDLE, _HANDLE)

    def _x(self, seconds: float) -> float:
        room, timeline = self._room(), self._timeline
        total = timeline.total if timeline is not None else 0.0
        return room.left() + room.width() * min(max(seconds / total, 0.0), 1.0) if total > 0 else room.left()

    def _seconds(self, x: float) -> float:
        room = self._room()
        share = min(max((x - room.left()) / room.width(), 0.0), 1.0)
        return share * self._timeline.total if self._timeline is not None else 0.0

    def _go(self, x: float) -> None:
        if self._timeline is not None:
            self.requested.emit(self._seconds(x))


def _upright(room: QRectF, column: int, height: float) -> QLineF:
    """Return the line of a column of the plot."""
    x = room.left() + column + 0.5
    return QLineF(x, room.bottom(), x, room.bottom() - height)


def exact_clock(seconds: float) -> str:
    """Return a time as m:ss.t, or h:mm:ss from one hour on."""
    tenths = int(seconds * 10)
    minutes, rest = divmod(tenths, 600)
    if minutes >= 60:
        return f"{minutes // 60}:{minutes % 60:02d}:{rest // 10:02d}"
    return f"{minutes}:{rest // 10:02d}.{rest % 10}"
