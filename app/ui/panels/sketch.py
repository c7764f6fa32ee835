"""Small line drawings beside parameters: what a number means in metal, redrawn as the number changes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from ..framework.theme import Theme
from ..framework.themed import Themed

WIDE, HIGH = 150, 70

Point = tuple[float, float]


class Sketch:
    """A painter that knows the house's lines: metal, tool, path, measure."""

    def __init__(self, painter: QPainter, theme: Theme) -> None:
        self._painter, self._theme = painter, theme

    def metal(self, points: Sequence[Point]) -> None:
        """Fill an outline as metal that stands."""
        self._painter.setPen(QPen(self._theme.muted, 1))
        self._painter.setBrush(QBrush(self._theme.hairline))
        self._painter.drawPolygon([QPointF(*point) for point in points])
        self._painter.setBrush(Qt.BrushStyle.NoBrush)

    def tool(self, x: float, tip: float, diameter: float, top: float = 6.0) -> None:
        """Draw a cutter from the side, its tip at a height."""
        left, right = x - diameter / 2, x + diameter / 2
        self._painter.setPen(QPen(self._theme.ink, 1.4))
        self._painter.drawPolyline([QPointF(left, top), QPointF(left, tip), QPointF(right, tip), QPointF(right, top)])

    def disc(self, x: float, y: float, diameter: float, before: bool = False) -> None:
        """Draw a cutter from above; `before`: where it was, dashed."""
        pen = QPen(self._theme.muted if before else self._theme.ink, 1.0 if before else 1.4)
        if before:
            pen.setDashPattern([3, 3])
        self._painter.setPen(pen)
        self._painter.drawEllipse(QPointF(x, y), diameter / 2, diameter / 2)

    def path(self, points: Sequence[Point], thin: bool = False) -> None:
        """Draw a way of the cutter."""
        pen = QPen(self._theme.accent_text, 1.0 if thin else 1.6)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        self._painter.setPen(pen)
        self._painter.drawPolyline([QPointF(*point) for point in points])

    def outline(self, points: Sequence[Point]) -> None:
        """Draw the edge of something that does not cut."""
        self._painter.setPen(QPen(self._theme.ink, 1))
        self._painter.drawPolyline([QPointF(*point) for point in points])

    def guide(self, points: Sequence[Point]) -> None:
        """Draw a thin dashed line."""
        pen = QPen(self._theme.muted, 1)
        pen.setDashPattern([3, 3])
        self._painter.setPen(pen)
        self._painter.drawPolyline([QPointF(*point) for point in points])

    def measure(self, a: Point, b: Point, word: str = "") -> None:
        """Draw a measure with arrows between two points, and a word behind it."""
        length = math.dist(a, b)
        if length < 1:
            return
        along = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        size = min(3.5, length / 3)
        self._painter.setPen(QPen(self._theme.accent_text, 1.3))
        self._painter.drawLine(QPointF(*a), QPointF(*b))
        for (x, y), way in ((a, 1), (b, -1)):
            for side in (1, -1):
                self._painter.drawLine(
                    QPointF(x, y),
                    QPointF(
                        x + size * (way * along[0] - side * along[1]), y + size * (way * along[1] + side * along[0])
                    ),
                )
        if word:
            self.word(b[0] + 5, (a[1] + b[1]) / 2 + 4, word)

    def word(self, x: float, y: float, text: str) -> None:
        """Write a letter or a short word."""
        self._painter.setPen(self._theme.ink)
        self._painter.drawText(QPointF(x, y), text)

    def arc(self, centre: Point, radius: float, start: float, sweep: float) -> None:
        """Draw a way of the cutter along a circle; degrees, counter-clockwise as on paper."""
        self._painter.setPen(QPen(self._theme.accent_text, 1.6))
        box = QRectF(centre[0] - radius, centre[1] - radius, 2 * radius, 2 * radius)
        self._painter.drawArc(box, round(16 * start), round(16 * sweep))


class SketchWidget(Themed, QWidget):
    """A drawing that follows values.

    `draw(sketch, values)` paints it on 150 x 70 px; `show_values` hands it the values to draw.
    """

    def __init__(self, draw: Callable[[Sketch, tuple[float, ...]], None], name: str) -> None:
        super().__init__()
        self._draw = draw
        self._values: tuple[float, ...] | None = None
        self.setFixedSize(WIDE, HIGH)
        self.setAccessibleName(name)

    def show_values(self, *values: float) -> None:
        """Draw other values."""
        if values != self._values:
            self._values = values
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw, once there are values."""
        if self._values is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._draw(Sketch(painter, self._theme), self._values)
