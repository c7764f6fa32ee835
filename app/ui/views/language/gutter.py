"""The line numbers beside the editor, and the mark of the line that is wrong."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRect, QSize, Qt
from PySide6.QtGui import QFontMetrics, QMouseEvent, QPainter, QPaintEvent, QTextBlock, QTextCursor
from PySide6.QtWidgets import QPlainTextEdit, QWidget

from ...framework.theme import mono_font
from ...framework.themed import Themed

_LEAST_DIGITS = 3


class Gutter(Themed, QWidget):
    """Line numbers; a click takes the line, a drag the lines.

    Attributes:
        wrong: line (1-based) that is wrong; 0 = none.
    """

    def __init__(self, editor: QPlainTextEdit) -> None:
        super().__init__(editor)
        self._editor = editor
        self.wrong = 0

    def width_wanted(self) -> int:
        """Return how wide the numbers are, px."""
        digits = max(_LEAST_DIGITS, len(str(self._editor.blockCount())))
        return 16 + 12 + QFontMetrics(mono_font()).horizontalAdvance("0") * digits

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """As wide as the numbers."""
        return QSize(self.width_wanted(), 0)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the numbers in sight."""
        painter, theme = QPainter(self), self._theme
        painter.fillRect(event.rect(), theme.raised)
        painter.setFont(mono_font())
        current = self._editor.textCursor().blockNumber()
        for block, top, height in blocks_in_sight(self._editor):
            row = block.blockNumber()
            painter.setPen(theme.error if row + 1 == self.wrong else theme.ink if row == current else theme.muted)
            painter.drawText(
                QRect(0, round(top), self.width() - 12, round(height)),
                Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignTop,
                str(row + 1),
            )
            if row + 1 == self.wrong:
                painter.fillRect(QRect(4, round(top) + 2, 3, round(height) - 4), theme.error)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Take the line."""
        self._take(event.position(), keep=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Take the lines up to here."""
        self._take(event.position(), keep=True)

    def _take(self, at: QPointF, keep: bool) -> None:
        cursor = self._editor.cursorForPosition(QPointF(0, at.y()).toPoint())
        begin = cursor.block().position()
        end = begin + cursor.block().length() - 1
        anchor = self._editor.textCursor().anchor() if keep else begin
        cursor.setPosition(anchor)
        cursor.setPosition(end if end >= anchor else begin, QTextCursor.MoveMode.KeepAnchor)
        self._editor.setTextCursor(cursor)
        self._editor.setFocus()


def blocks_in_sight(editor: QPlainTextEdit) -> list[tuple[QTextBlock, float, float]]:
    """Return (line, top, height) of the lines in sight, px of the viewport."""
    found = list[tuple[QTextBlock, float, float]]()
    block, offset, bottom = editor.firstVisibleBlock(), editor.contentOffset(), editor.viewport().height()
    while block.isValid():
        box = editor.blockBoundingGeometry(block).translated(offset)
        if box.top() > bottom:
            break
        found.append((block, box.top(), box.height()))
        block = block.next()
    return found
