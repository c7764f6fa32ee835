"""The line under the NC view: tool, spindle, motion, place, time and modal words at the picked line."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from ...framework.catalogue import tr
from ...framework.theme import text_font
from ...framework.themed import Themed
from .state_words import StateItem

STRIP_PX = 28
_EDGE, _GAP, _NAME_GAP = 12, 16, 5
_HINT = "Pick a line, or click a motion: what is in force there is shown here."


class StateStrip(Themed, QWidget):
    """Shows as many items as fit; the tool tip has them all."""

    def __init__(self) -> None:
        super().__init__()
        self.items: list[StateItem] = []
        self.setFixedHeight(STRIP_PX)
        self.setMinimumWidth(80)
        self.show_items([])

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """A line."""
        return QSize(400, STRIP_PX)

    def show_items(self, items: list[StateItem]) -> None:
        """Show what is in force; nothing picked, nothing to show."""
        self.items = items
        words = "   ".join(f"{tr(item.name)} {tr(item.value)}".strip() for item in items)
        self.setToolTip(words)
        self.setAccessibleName(f"At the picked line: {words}" if words else tr(_HINT))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw item by item until the line is full."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), self._theme.paper)
        painter.fillRect(0, 0, self.width(), 1, self._theme.hairline)
        painter.setFont(text_font())
        metrics = painter.fontMetrics()
        if not self.items:
            painter.setPen(self._theme.muted)
            painter.drawText(self._place(_EDGE, self.width()), Qt.AlignmentFlag.AlignVCenter, tr(_HINT))
        x = _EDGE
        for item in self.items:
            width = _width(item, metrics)
            if x + width > self.width() - _EDGE:
                break
            painter.setPen(self._theme.muted)
            painter.drawText(self._place(x, width), Qt.AlignmentFlag.AlignVCenter, tr(item.name))
            painter.setPen(self._theme.ink)
            after = metrics.horizontalAdvance(tr(item.name)) + _NAME_GAP if item.name else 0
            painter.drawText(self._place(x + after, width), Qt.AlignmentFlag.AlignVCenter, tr(item.value))
            x += width + _GAP

    def _place(self, x: int, width: int) -> QRect:
        return QRect(x, 1, width + 1, self.height() - 1)


def _width(item: StateItem, metrics: QFontMetrics) -> int:
    name = metrics.horizontalAdvance(tr(item.name)) + _NAME_GAP if item.name else 0
    return name + metrics.horizontalAdvance(tr(item.value))
