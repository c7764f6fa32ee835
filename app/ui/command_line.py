"""The command line and, above it, the log: what was done in words, and what the program said to it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QColor, QFontMetrics, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QLineEdit, QSizePolicy, QVBoxLayout, QWidget

from app.edit.document import LogLine
from app.ui.theme import LIGHT, Theme, mono_font, text_font

SHOWN_LINES = 3
LINE_PX = 20


class LogView(QWidget):
    """The last lines of the log: commands at the left, replies at the right."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("logArea")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedHeight(SHOWN_LINES * LINE_PX + 12)
        self._theme: Theme = LIGHT
        self.lines: list[LogLine] = []

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.update()

    def show_lines(self, lines: list[LogLine]) -> None:
        """Show the end of a log."""
        self.lines = lines[-SHOWN_LINES:]
        self.setToolTip("\n".join(f"{each.command}    {each.reply}" for each in lines[-12:]))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the lines, newest at the bottom."""
        super().paintEvent(event)
        painter = QPainter(self)
        middle = int(self.width() * 0.4)
        first = 7 + (SHOWN_LINES - len(self.lines)) * LINE_PX
        for at, line in enumerate(self.lines):
            y = first + at * LINE_PX
            self._text(painter, (16, y, middle - 32), line.command, mono=True, colour=self._theme.ink)
            colour = self._theme.error if line.error else self._theme.muted
            self._text(painter, (middle, y, self.width() - middle - 16), line.reply, mono=False, colour=colour)

    def _text(self, painter: QPainter, place: tuple[int, int, int], text: str, *, mono: bool, colour: QColor) -> None:
        x, y, width = place
        font = mono_font() if mono else text_font()
        painter.setFont(font)
        painter.setPen(colour)
        short = QFontMetrics(font).elidedText(text, Qt.TextElideMode.ElideRight, width)
        painter.drawText(x, y, width, LINE_PX, Qt.AlignmentFlag.AlignVCenter, short)


class CommandLine(QWidget):
    """A log and a line to type in; Up and Down walk through what was typed before.

    Signals:
        entered(text): Enter with text in the line. accepted(): Enter in the empty line. cancelled(): Escape.
    """

    entered = Signal(str)
    accepted = Signal()
    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.log, self.edit = LogView(), QLineEdit()
        self.edit.setObjectName("commandLine")
        self.edit.setAccessibleName("Command line")
        self.edit.textChanged.connect(lambda text: self.edit.setFont(mono_font() if text else text_font()))
        self.edit.installEventFilter(self)
        self._typed: list[str] = []
        self._at = 0
        self._lay_out()

    def _lay_out(self) -> None:
        row = QWidget()
        row.setObjectName("commandRow")
        row.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        row.setFixedHeight(31)
        line = QHBoxLayout(row)
        line.setContentsMargins(16, 0, 16, 0)
        line.setSpacing(8)
        sign = QLabel(">")
        sign.setFont(mono_font())
        sign.setProperty("role", "prompt")
        line.addWidget(sign)
        line.addWidget(self.edit, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.log)
        column.addWidget(row)

    def set_prompt(self, text: str) -> None:
        """Say what is expected next."""
        self.edit.setPlaceholderText(text)

    def begin(self, text: str) -> None:
        """Start typing, with the first character that was typed elsewhere."""
        self.edit.setFocus()
        self.edit.insert(text)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Enter, Escape, Up and Down; with nothing typed, keys like Ctrl+Z are the window's."""
        if event.type() == QEvent.Type.ShortcutOverride and not self.edit.text():
            event.ignore()
            return True
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        key = event.key()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
        elif key == Qt.Key.Key_Escape:
            self.edit.clear()
            self.cancelled.emit()
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._recall(-1 if key == Qt.Key.Key_Up else 1)
        else:
            return super().eventFilter(watched, event)
        return True

    def _enter(self) -> None:
        text = self.edit.text().strip()
        self.edit.setText("")  # forgets what QLineEdit could undo, which `clear` does not
        if not text:
            self.accepted.emit()
            return
        self._typed.append(text)
        self._at = len(self._typed)
        self.entered.emit(text)

    def _recall(self, way: int) -> None:
        self._at = min(max(self._at + way, 0), len(self._typed))
        self.edit.setText(self._typed[self._at] if self._at < len(self._typed) else "")
