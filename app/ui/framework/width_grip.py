"""The left border of a panel, which can be dragged to make the panel wider."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QWidget

GRIP_PX = 6


class WidthGrip(QWidget):
    """Lies over the left border of its panel.

    Signals:
        dragged(width): the panel is to be so wide, px. given_up(): twice clicked, as wide as it was by itself.
    """

    dragged = Signal(int)
    given_up = Signal()

    def __init__(self, panel: QWidget) -> None:
        super().__init__(panel)
        self._panel = panel
        self._from: tuple[float, int] | None = None
        self.setCursor(Qt.CursorShape.SplitHCursor)
        self.setToolTip("Drag to make the panel wider; click twice for its usual width")
        self.setFixedWidth(GRIP_PX)
        panel.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Be as high as the panel, and over what is in it."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.Show):
            self.setGeometry(0, 0, GRIP_PX, self._panel.height())
            self.raise_()
        return False

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Take hold."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._from = event.globalPosition().x(), self._panel.width()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Follow the mouse."""
        if self._from is not None:
            self.dragged.emit(round(self._from[1] + self._from[0] - event.globalPosition().x()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Let go."""
        self._from = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Give up the chosen width."""
        self._from = None
        self.given_up.emit()
