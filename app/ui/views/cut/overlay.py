"""What lies over the cut: the axes, and what is known of the place under the mouse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from ...framework.catalogue import tr
from ...framework.theme import text_font
from ...framework.themed import Themed
from .camera import Camera, Floats
from .overlay_text import pitch_words

_AXIS_PX, _AXES_EDGE_PX, _NAME_PX = 30.0, 52.0, 11.0
_AXES_GROUND, _WORDS_GROUND = 0.6, 0.9
"""How much grounds cover: lines are seen sooner than words."""
_RING_PX, _LEADER_PX = 9.0, 34.0
_CARD_GAP_PX, _PAD_PX, _ROW_PX, _CROSS_PX = 18.0, 10.0, 18.0, 9.0


Line = tuple[tuple[float, float, float], tuple[float, float, float]]
"""Two places, mm."""


@dataclass(frozen=True, slots=True)
class ProbedCell:
    """What is known of one place: where it is on the screen, px, and two lines of words."""

    at: QPointF
    place: str
    facts: str


@dataclass(frozen=True, slots=True)
class PlacePin:
    """A place that is pointed at: where, mm, two lines of words, and the colour of the first."""

    place: tuple[float, float, float]
    title: str
    facts: str
    colour: QColor


class CutOverlay(Themed, QWidget):
    """Painted over the cut; mouse and keys pass through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._camera = Camera()
        self.probe: ProbedCell | None = None
        self.line: Line | None = None
        self.pin: PlacePin | None = None
        self.way: Floats | None = None
        self._pitch, self._finer = "", False

    def show_camera(self, camera: Camera) -> None:
        """Turn the axes, and keep the line where it is."""
        turned = camera.axes.tolist() != self._camera.axes.tolist()
        self._camera = camera
        if turned or self.line is not None or self.pin is not None or self.way is not None:
            self.update()

    def show_line(self, line: Line | None) -> None:
        """Show a line over the metal, or none."""
        self.line = line
        self.update()

    def show_way(self, way: Floats | None) -> None:
        """Show the way (n, 3) of a motion over the metal, mm, or none."""
        self.way = way if way is not None and len(way) > 1 else None
        self.update()

    def show_pin(self, pin: PlacePin | None) -> None:
        """Point at a place, or at none."""
        self.pin = pin
        self.update()

    def show_pitch(self, pitch: float, finer: bool) -> None:
        """Tell how wide the cells are, mm, and whether they are finer than those of the whole."""
        self._pitch, self._finer = f"cells {pitch_words(pitch)}", finer
        self.update()

    def show_probe(self, probe: ProbedCell | None) -> None:
        """Show what is known of a place, or nothing."""
        if probe != self.probe:
            self.probe = probe
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint axes and probe."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_axes(painter)
        self._paint_pitch(painter)
        if self.way is not None:
            self._paint_way(painter, self.way)
        if self.line is not None:
            self._paint_line(painter, self.line)
        if self.pin is not None:
            self._paint_pin(painter, self.pin)
        if self.probe is not None:
            self._paint_cross(painter, self.probe.at)
            self._paint_card(painter, self.probe)

    def _paint_axes(self, painter: QPainter) -> None:
        """Paint the three axes, the nearest to the eye last."""
        theme, origin = self._theme, QPointF(_AXES_EDGE_PX, self.height() - _AXES_EDGE_PX)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._ground(_AXES_GROUND))
        painter.drawEllipse(origin, _AXES_EDGE_PX - 4, _AXES_EDGE_PX - 4)
        right, up, towards = self._camera.axes
        painter.setFont(text_font())
        for axis in sorted(range(3), key=lambda k: towards[k]):
            way = QPointF(right[axis], -up[axis])
            colour = (theme.plunge, theme.pocket, theme.left)[axis]
            painter.setPen(QPen(colour, 1.8, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawLine(origin, origin + way * _AXIS_PX)
            if right[axis] ** 2 + up[axis] ** 2 > 0.02:
                name = origin + way * (_AXIS_PX + _NAME_PX)
                painter.drawText(QRectF(name.x() - 8, name.y() - 8, 16, 16), Qt.AlignmentFlag.AlignCenter, "XYZ"[axis])

    def _paint_pitch(self, painter: QPainter) -> None:
        """Paint how wide the cells are, beside the axes."""
        painter.setFont(text_font(semibold=self._finer))
        words = tr(self._pitch)
        wide = painter.fontMetrics().horizontalAdvance(words)
        row = QRectF(2 * _AXES_EDGE_PX + 8, self.height() - _AXES_EDGE_PX + 10, wide, 18)
        if words:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self._ground(_WORDS_GROUND))
            painter.drawRoundedRect(row.adjusted(-8, -2, 8, 2), 4, 4)
        painter.setPen(self._theme.accent_text if self._finer else self._theme.muted)
        painter.drawText(row, Qt.AlignmentFlag.AlignVCenter, words)

    def _ground(self, covering: float) -> QColor:
        """Return the view's own ground, so that words can be read over metal; where none is it is not seen."""
        ground = QColor(self._theme.canvas)
        ground.setAlphaF(covering)
        return ground

    def _on_screen(self, place: tuple[float, float, float]) -> QPointF:
        ratio = self.devicePixelRatioF()
        x, y, _ = self._camera.project(np.array([place]), (self.width() * ratio, self.height() * ratio))[0] / ratio
        return QPointF(x, y)

    def _paint_pin(self, painter: QPainter, pin: PlacePin) -> None:
        """Paint a ring round the place, and a line from it to the words."""
        at = self._on_screen(pin.place)
        if not self.rect().contains(at.toPoint()):
            return
        ground = QColor(pin.colour)
        ground.setAlphaF(0.25)
        painter.setBrush(ground)
        painter.setPen(QPen(pin.colour, 1.6))
        painter.drawEllipse(at, _RING_PX, _RING_PX)
        knee = at + QPointF(_LEADER_PX, _LEADER_PX)
        painter.drawLine(at + QPointF(0.7, 0.7) * _RING_PX, knee)
        painter.drawLine(knee, knee + QPointF(10, 0))
        rows = ((tr(pin.title), text_font(semibold=True)), (tr(pin.facts), text_font()))
        wide = max(QFontMetricsF(font).horizontalAdvance(text) for text, font in rows) + 2.5 * _PAD_PX
        sheet = QColor(self._theme.canvas)
        sheet.setAlphaF(0.94)
        row = QRectF(knee.x() + 12, knee.y() - _ROW_PX, wide, _ROW_PX)
        both = row.united(row.translated(0, _ROW_PX)).adjusted(0, -2, 0, 2)
        painter.fillRect(both, sheet)
        painter.fillRect(QRectF(both.topLeft(), QSizeF(3.0, both.height())), pin.colour)
        painter.setPen(self._theme.ink)  # a place's own colour may be too pale for words
        for k, (text, font) in enumerate(rows):
            painter.setFont(font)
            painter.drawText(row.translated(_PAD_PX, k * _ROW_PX), Qt.AlignmentFlag.AlignVCenter, text)

    def _paint_line(self, painter: QPainter, line: Line) -> None:
        ends = [self._on_screen(place) for place in line]
        for colour, width in ((self._theme.canvas, 4.0), (self._theme.accent, 1.8)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawLine(ends[0], ends[1])
        painter.setBrush(self._theme.accent)
        for end in ends:
            painter.drawEllipse(end, 3.0, 3.0)

    def _paint_way(self, painter: QPainter, way: Floats) -> None:
        """Paint the way of a motion with its end."""
        points = [self._on_screen((x, y, z)) for x, y, z in way.tolist()]
        for colour, width in ((self._theme.canvas, 6.0), (self._theme.accent, 2.6)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawPolyline(points)
        painter.setBrush(self._theme.accent)
        painter.drawEllipse(points[-1], 3.5, 3.5)

    def _paint_cross(self, painter: QPainter, at: QPointF) -> None:
        for colour, width in ((self._theme.canvas, 4.0), (self._theme.accent, 1.6)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap))
            for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                painter.drawLine(at + QPointF(dx, dy) * 3.0, at + QPointF(dx, dy) * _CROSS_PX)

    def _paint_card(self, painter: QPainter, probe: ProbedCell) -> None:
        """Paint the words beside the place, on the side where there is room."""
        metrics = QFontMetricsF(text_font())
        wide = max(metrics.horizontalAdvance(text) for text in (probe.place, probe.facts)) + 2 * _PAD_PX
        card = QRectF(
            probe.at.x() + _CARD_GAP_PX,
            probe.at.y() - _CARD_GAP_PX - 2 * _ROW_PX - _PAD_PX,
            wide,
            2 * _ROW_PX + _PAD_PX,
        )
        if card.right() > self.width() - 8:
            card.moveRight(probe.at.x() - _CARD_GAP_PX)
        if card.top() < 8:
            card.moveTop(probe.at.y() + _CARD_GAP_PX)
        ground = QColor(self._theme.raised)
        ground.setAlphaF(0.96)
        painter.setPen(QPen(self._theme.hairline, 1))
        painter.setBrush(ground)
        painter.drawRoundedRect(card, 4, 4)
        painter.setFont(text_font())
        rows = card.adjusted(_PAD_PX, _PAD_PX / 2, 0, 0)
        for k, (text, colour) in enumerate(((probe.place, self._theme.ink), (probe.facts, self._theme.muted))):
            painter.setPen(colour)
            painter.drawText(
                QRectF(rows.left(), rows.top() + k * _ROW_PX, wide, _ROW_PX), Qt.AlignmentFlag.AlignVCenter, text
            )
