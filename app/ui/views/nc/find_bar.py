"""Find in the program: a bar over the text; `:120` goes to line 120."""

from __future__ import annotations

import re

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from ...framework.boxes import give_ground, h_box
from ...framework.icons import IconButton
from ...framework.labels import muted, restyle
from .program_text import ProgramText, program_text

_LINE = re.compile(r":\s*(\d+)\s*")


class FindBar(QWidget):
    """A field, a count, previous and next.

    Signals:
        reached(row, column): go there. marked(words, rows): mark these words, which these rows hold. closed().
    """

    reached = Signal(int, int)
    marked = Signal(str, tuple)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "ncBar")
        self.setFixedHeight(36)
        self.edit, self.count = QLineEdit(), muted()
        self.edit.setPlaceholderText("Find, or :120 for line 120")
        self.edit.setAccessibleName("Find in the program, or a colon and the number of a line")
        self.edit.setFixedHeight(24)
        self.edit.installEventFilter(self)
        self.edit.textEdited.connect(self._on_typed)
        self.before, self.next = IconButton("up", "Previous (Shift+F3)"), IconButton("down", "Next (F3)")
        self.before.clicked.connect(lambda: self.step(back=True))
        self.next.clicked.connect(lambda: self.step())
        close = IconButton("cancel", "Close (Esc)")
        close.clicked.connect(self.close_bar)
        row = h_box(self, (12, 4, 8, 4), 4)
        row.addWidget(self.edit, 1)
        row.addSpacing(4)
        for widget in (self.count, self.before, self.next, close):
            row.addWidget(widget)
        self._text = program_text(b"")
        self._at: int | None = None
        self._from = 0
        self.hide()

    def set_text(self, text: ProgramText) -> None:
        """Look in another program from now on."""
        self._text, self._at, self._from = text, None, 0

    def begin(self, row: int, words: str | None = None) -> None:
        """Open the bar; look from a row on.

        Args:
            row: 0-based; less than 0 = the beginning.
            words: to be in the field, the cursor behind them; None keeps what was there, marked to be typed over.
        """
        self._from = int(self._text.starts[row]) if 0 <= row < len(self._text) else 0
        self.show()
        self.edit.setFocus()
        if words is None:
            self.edit.selectAll()
        else:
            self.edit.setText(words)
        self._at = None
        self._mark()

    def step(self, back: bool = False) -> None:
        """Go to the next place, or to the one before; at the end, on from the other one."""
        words = self.edit.text()
        line = _LINE.fullmatch(words)
        if line:
            self.reached.emit(min(max(int(line[1]), 1), max(1, len(self._text))) - 1, 0)
            return
        if not words or words.startswith(":"):
            return
        here = self._at if self._at is not None else self._from
        self._go(self._text.find(words, here if back or self._at is None else here + 1, back))

    def close_quietly(self) -> None:
        """Close the bar and take the marks away; the focus stays where it is."""
        self.hide()
        self.marked.emit("", ())

    def close_bar(self) -> None:
        """Close the bar and take the marks away."""
        self.close_quietly()
        self.closed.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Enter goes on, Shift+Enter back, Escape closes."""
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self.step(back=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
                if _LINE.fullmatch(self.edit.text()):
                    self.close_bar()
                return True
            if event.key() == Qt.Key.Key_Escape:
                self.close_bar()
                return True
        return super().eventFilter(watched, event)

    def _on_typed(self, words: str) -> None:
        self._at = None
        self._mark()
        if words and not words.startswith(":"):
            self._go(self._text.find(words, self._from))

    def _go(self, position: int | None) -> None:
        self._at = position
        self._tell()
        if position is not None:
            row = self._text.row_at(position)
            self.reached.emit(row, position - int(self._text.starts[row]))

    def _mark(self) -> None:
        words = self.edit.text()
        plain = "" if words.startswith(":") else words
        self.marked.emit(plain, tuple(self._text.rows_with(plain).tolist()))
        self._tell()

    def _tell(self) -> None:
        """Say which one of how many; a word that is nowhere is marked."""
        words = self.edit.text()
        line = _LINE.fullmatch(words)
        if line or not words or words.startswith(":"):
            self.count.setText(f"of {len(self._text)}" if line else "")
        else:
            total = self._text.count(words)
            number = f"{self._text.count(words, self._at) + 1} of {total}" if self._at is not None else f"{total}"
            self.count.setText(number if total else "Not found")
        wrong = "true" if self.count.text() == "Not found" else "false"
        if self.edit.property("wrong") != wrong:
            self.edit.setProperty("wrong", wrong)
            restyle(self.edit)
