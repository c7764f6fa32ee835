"""An editor of a text with the numbers of its lines beside it."""

from __future__ import annotations

from PySide6.QtCore import QRect
from PySide6.QtGui import QPainter, QPaintEvent, QPalette, QResizeEvent
from PySide6.QtWidgets import QPlainTextEdit

from ...framework.theme import LIGHT, Theme, mono_font
from .gutter import Gutter


class NumberedEditor(QPlainTextEdit):
    """Lines that do not wrap, in letters of one width, and their numbers."""

    def __init__(self, name: str) -> None:
        """Make an editor; `name` is for whoever has it read aloud."""
        super().__init__()
        self.setAccessibleName(name)
        self.setFrameShape(QPlainTextEdit.Shape.NoFrame)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setFont(mono_font())
        self.setStyleSheet(f"QPlainTextEdit {{ font-family: '{mono_font().family()}'; }}")
        self._theme = LIGHT
        self.gutter = Gutter(self)
        self.blockCountChanged.connect(lambda _: self._lay_out())
        self.updateRequest.connect(self._follow)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.Base, theme.raised)
        palette.setColor(QPalette.ColorRole.Text, theme.ink)
        self.setPalette(palette)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Give the numbers their place."""
        super().resizeEvent(event)
        self._lay_out()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the text, and a hairline between numbers and text."""
        super().paintEvent(event)
        QPainter(self.viewport()).fillRect(QRect(0, 0, 1, self.viewport().height()), self._theme.hairline)

    def _lay_out(self) -> None:
        width = self.gutter.width_wanted()
        self.setViewportMargins(width, 0, 0, 0)
        inside = self.contentsRect()
        self.gutter.setGeometry(inside.left(), inside.top(), width, inside.height())

    def _follow(self, area: QRect, scrolled: int) -> None:
        self.gutter.update()
