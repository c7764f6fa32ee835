"""The view that was left fades over the one that came."""

from __future__ import annotations

from PySide6.QtCore import Qt, QVariantAnimation
from PySide6.QtGui import QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QWidget

FADE_MS = 120


class Fade(QWidget):
    """A picture laid over a widget that vanishes in 120 ms; mouse and keys pass through it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._over, self._picture, self._opacity = parent, QPixmap(), 0.0
        self._run = QVariantAnimation(self)
        self._run.setDuration(FADE_MS)
        self._run.setStartValue(1.0)
        self._run.setEndValue(0.0)
        self._run.valueChanged.connect(self._fade_to)
        self._run.finished.connect(self._end)
        self.hide()

    def begin(self, picture: QPixmap) -> None:
        """Lay a picture over the whole parent and let it vanish."""
        self._run.stop()
        self._picture = picture
        self.resize(self._over.size())
        self.show()
        self.raise_()
        self._run.start()

    def _fade_to(self, opacity: float) -> None:
        self._opacity = float(opacity)
        self.update()

    def _end(self) -> None:
        self.hide()
        self._picture = QPixmap()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the picture as faint as it is by now, where it was: room comes and goes at the left."""
        painter = QPainter(self)
        painter.setOpacity(self._opacity)
        painter.drawPixmap(self.width() - round(self._picture.deviceIndependentSize().width()), 0, self._picture)
