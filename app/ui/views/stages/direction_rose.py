"""The eight directions of the chain code, as the text draws them: 0 to the right, then counter-clockwise."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from ....raster.trace import STEPS
from ...framework.theme import text_font
from ...framework.themed import Themed

_SIDE, _ARM, _HEAD = 96, 26.0, 4.0


class DirectionRose(Themed, QWidget):
    """Eight arrows with their numbers."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedSize(_SIDE, _SIDE)
        self.setToolTip("The directions of the chain code")
        self.setAccessibleName("The directions of the chain code: 0 to the right, then counter-clockwise to 7")

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the arrows."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(text_font())
        middle = QPointF(_SIDE / 2, _SIDE / 2)
        for number, (row, col) in enumerate(STEPS.tolist()):
            size = math.hypot(row, col)
            way = QPointF(col / size, row / size)
            tip = middle + way * _ARM
            painter.setPen(QPen(self._theme.muted, 1.3, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawLine(middle + way * 5, tip)
            for side in (-1, 1):
                painter.drawLine(tip, tip - way * _HEAD + QPointF(-way.y(), way.x()) * side * 0.7 * _HEAD)
            painter.setPen(self._theme.ink)
            at = middle + way * (_ARM + 11)
            painter.drawText(QRectF(at.x() - 8, at.y() - 8, 16, 16), Qt.AlignmentFlag.AlignCenter, str(number))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._theme.ink)
        painter.drawEllipse(middle, 2.5, 2.5)
