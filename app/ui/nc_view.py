"""The NC text with line numbers and a colour for each path; paints only the lines that can be seen."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetrics, QGuiApplication, QKeyEvent, QKeySequence, QMouseEvent, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QAbstractScrollArea, QWidget

from app.model.moves import Moves, Purpose
from app.ui.theme import LIGHT, Theme, mono_font

_LINE_PX = 20
_PARTS = re.compile(r"\([^)]*\)|;.*|[A-Z][-+.\d]*|\s+|.")
_COLOURS: dict[int, Callable[[Theme], QColor]] = {
    Purpose.RAPID: lambda t: t.rapid, Purpose.PLUNGE: lambda t: t.plunge, Purpose.CONTOUR: lambda t: t.contour,
    Purpose.POCKET: lambda t: t.pocket, Purpose.LINK: lambda t: t.pocket, Purpose.LEAD: lambda t: t.contour,
}


class NcView(QAbstractScrollArea):
    """Read-only NC text.

    Signals:
        line_picked(move): index of the move that the picked line holds.
    """

    line_picked = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._theme: Theme = LIGHT
        self.lines: list[str] = []
        self.current = -1
        self._line_of_move: NDArray[np.int32] = np.zeros(0, np.int32)
        self._purpose_of_move: NDArray[np.uint8] = np.zeros(0, np.uint8)
        self.setFrameShape(QAbstractScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName("NC program")

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.viewport().update()

    def show_program(self, text: str, lines: NDArray[np.int32], moves: Moves) -> None:
        """Show an NC text.

        Args:
            text: the program, lines ended by newline.
            lines: (n,) which line of the text holds each move, 1-based, not decreasing.
            moves: n moves.
        """
        self.lines = text.splitlines()
        self._line_of_move, self._purpose_of_move = lines, moves.purpose
        self.current = -1
        self._set_range()
        self.verticalScrollBar().setValue(0)
        self.viewport().update()

    def pick(self, row: int) -> None:
        """Highlight a line (0-based) and tell which move it is, if it is one."""
        if not 0 <= row < len(self.lines):
            return
        self.current = row
        bar = self.verticalScrollBar()
        if row < bar.value():
            bar.setValue(row)
        elif row >= bar.value() + self._rows() - 1:
            bar.setValue(row - self._rows() + 2)
        self.viewport().update()
        move = self._move_in(row)
        if move is not None:
            self.line_picked.emit(move)

    def _move_in(self, row: int) -> int | None:
        move = int(np.searchsorted(self._line_of_move, row + 1))
        return move if move < len(self._line_of_move) and self._line_of_move[move] == row + 1 else None

    def _rows(self) -> int:
        return max(1, (self.viewport().height() - 16) // _LINE_PX)

    def _set_range(self) -> None:
        self.verticalScrollBar().setRange(0, max(0, len(self.lines) - self._rows()))
        self.verticalScrollBar().setPageStep(self._rows())
        self.verticalScrollBar().setSingleStep(1)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep the scroll range in step."""
        super().resizeEvent(event)
        self._set_range()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Pick the line under the mouse."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.pick(self.verticalScrollBar().value() + int(event.position().y() - 8) // _LINE_PX)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Walk through the lines; Ctrl+C copies the picked line, or all."""
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_PageUp: -self._rows(), Qt.Key.Key_PageDown: self._rows()}
        if event.matches(QKeySequence.StandardKey.Copy):
            picked = self.lines[self.current] if self.current >= 0 else "\n".join(self.lines)
            QGuiApplication.clipboard().setText(picked)
        elif event.key() in steps and self.lines:
            self.pick(min(max(self.current + steps[Qt.Key(event.key())], 0), len(self.lines) - 1))
        elif event.key() in (Qt.Key.Key_Home, Qt.Key.Key_End) and self.lines:
            self.pick(0 if event.key() == Qt.Key.Key_Home else len(self.lines) - 1)
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the lines in sight."""
        painter = QPainter(self.viewport())
        painter.fillRect(self.viewport().rect(), self._theme.canvas)
        painter.setFont(mono_font())
        metrics = painter.fontMetrics()
        first = self.verticalScrollBar().value()
        gutter = 40 + metrics.horizontalAdvance("0" * max(3, len(str(len(self.lines)))))
        for at in range(self._rows() + 1):
            if first + at < len(self.lines):
                self._draw_line(painter, metrics, first + at, (8 + at * _LINE_PX, gutter))

    def _draw_line(self, painter: QPainter, metrics: QFontMetrics, row: int, place: tuple[int, int]) -> None:
        top, gutter = place
        if row == self.current:
            painter.fillRect(0, top, self.viewport().width(), _LINE_PX, self._theme.chosen)
        move = self._move_in(row)
        if move is not None:
            painter.fillRect(QRectF(14, top + 3, 3, _LINE_PX - 6), _COLOURS[int(self._purpose_of_move[move])](self._theme))
        painter.setPen(self._theme.muted)
        painter.drawText(QRectF(20, top, gutter - 32, _LINE_PX), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, str(row + 1))
        x = float(gutter)
        for part in _PARTS.findall(self.lines[row]):
            painter.setPen(self._word_colour(part))
            painter.drawText(QRectF(x, top, 2000, _LINE_PX), Qt.AlignmentFlag.AlignVCenter, part)
            x += metrics.horizontalAdvance(part)

    def _word_colour(self, word: str) -> QColor:
        if word[0] in "(;%":
            return self._theme.muted
        return self._theme.accent_text if word[0] in "GMT" else self._theme.ink
