"""What is asked about a drawing, above the canvas: the facts, and a button a line for each answer with what comes of
it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QWidget

from ....formats.reading_question import ReadingChoice, ReadingQuestion
from ....model.reading import ReadingOptions
from ...framework.boxes import give_ground, h_box, put_away, v_box
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted
from ...framework.seen_with import SeenWith
from ...framework.theme import HEADING_PX, text_font

ROW_PX = 28
NOW = "as it is now"


class QuestionCard(QWidget):
    """Asks one question at a time; a newer one takes its place.

    Attributes:
        buttons: of the answers, in order; `cancel`: the drawing is not opened.
    """

    def __init__(self, drawing: QWidget) -> None:
        """Make a card.

        Args:
            drawing: where the drawing is seen that is asked about.
        """
        super().__init__()
        self._drawing, self._seen_with = drawing, SeenWith(self)
        give_ground(self, "card")
        self.setAccessibleName("Question about the drawing")
        self.title, self.text = Elided(), QLabel()
        self.title.setFont(text_font(HEADING_PX, semibold=True))
        self.title.setStyleSheet(f"font-size: {HEADING_PX}px; font-weight: 600;")
        self.text.setWordWrap(True)
        self.buttons: list[QPushButton] = []
        self.cancel = QPushButton("Do not open it", self)
        self.cancel.setProperty("role", "link")
        self.cancel.clicked.connect(self.hide)
        self._close = IconButton("cancel", "Close the question (Esc)")
        self._close.clicked.connect(self.hide)
        QShortcut(
            QKeySequence(Qt.Key.Key_Escape), self, self.hide, context=Qt.ShortcutContext.WidgetWithChildrenShortcut
        )
        self._lay_out()
        self.hide()

    def hide(self) -> None:
        """Close the question; it does not come back with the drawing."""
        self._seen_with.follow(None)
        super().hide()

    def _lay_out(self) -> None:
        head = h_box(spacing=8)
        head.addWidget(self.title, 1)
        head.addWidget(self._close, 0, Qt.AlignmentFlag.AlignTop)
        self._rows = QGridLayout()
        self._rows.setHorizontalSpacing(12)
        self._rows.setVerticalSpacing(4)
        self._rows.setColumnStretch(1, 1)
        column = v_box(self, (16, 8, 8, 12), 0)
        column.addLayout(head)
        column.addWidget(self.text)
        column.addSpacing(8)
        column.addLayout(self._rows)

    def ask(self, name: str, question: ReadingQuestion, answer: Callable[[ReadingOptions], None], waits: bool) -> None:
        """Show a question.

        Args:
            name: of the drawing's file.
            question: what is asked.
            answer: takes how the drawing is read by the answer that is pressed; by that which it is read by already:
                nothing happens.
            waits: True where the drawing is not opened before it is answered; then the keyboard is brought here.
        """
        self._clear()
        self.title.setText(name)
        self.text.setText(question.text)
        for row, choice in enumerate(question.choices):
            self._add(row, choice, answer)
        last = len(question.choices)
        self._rows.addWidget(self.cancel, last, 0, Qt.AlignmentFlag.AlignLeft)
        self.cancel.setVisible(waits)
        for button in (*self.buttons, self.cancel):
            button.setFixedHeight(ROW_PX)
        self._seen_with.follow(None)
        self.show()
        if not waits:
            self._seen_with.follow(self._drawing)
        elif self.buttons:
            self.buttons[0].setFocus(Qt.FocusReason.OtherFocusReason)

    def _add(self, row: int, choice: ReadingChoice, answer: Callable[[ReadingOptions], None]) -> None:
        button = QPushButton(choice.words)
        button.setProperty("role", "primary" if choice.likely else "")
        button.clicked.connect(self.hide)
        if not choice.now:
            button.clicked.connect(partial(_answered, answer, choice.reading))
        parts = [part for part in (choice.outcome, NOW if choice.now else "") if part]
        button.setAccessibleDescription(", ".join(parts))
        outcome = QWidget()
        line = h_box(outcome, spacing=12)
        line.addWidget(Elided(choice.outcome))
        if choice.now:
            line.addWidget(muted(NOW))
        line.addStretch(1)
        self.buttons.append(button)
        self._rows.addWidget(button, row, 0)
        self._rows.addWidget(outcome, row, 1)

    def _clear(self) -> None:
        self.buttons = []
        for at in reversed(range(self._rows.count())):
            item = self._rows.takeAt(at)
            widget = item.widget() if item is not None else None
            if widget is not None and widget is not self.cancel:
                put_away(widget)


def _answered(answer: Callable[[ReadingOptions], None], reading: ReadingOptions, *_: object) -> None:
    answer(reading)
