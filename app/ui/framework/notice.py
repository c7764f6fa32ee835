"""A bar above the canvas: one sentence and the buttons that answer it. Never a window of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QPushButton, QWidget

from .boxes import give_ground, h_box, put_away
from .icons import IconButton
from .labels import restyle
from .seen_with import SeenWith

Answers = Sequence[tuple[str, Callable[[], None]]]

_LEAST_TEXT_PX = 240
"""Where buttons leave a sentence less than this, they stand below it."""


def _call(act: Callable[[], None], *_: object) -> None:
    act()


class Notice(QWidget):
    """Shows one sentence at a time; a newer one takes its place, and one that comes back is seen again after that.

    Attributes:
        sentence: as it was said last, whatever language it is shown in.
    """

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "notice")
        self.text = QLabel()
        self.text.setWordWrap(True)
        self.buttons: list[QPushButton] = []
        self._stays = self._of_job = False
        self._again: Callable[[], None] | None = None
        self._comes_back: Callable[[], None] | None = None
        self._kept: Callable[[], None] | None = None
        self._seen_with = SeenWith(self)
        self.sentence = ""
        self._answers, self._below = QWidget(), False
        self._row = h_box(self._answers, spacing=8)
        self._close = IconButton("cancel", "Close this line")
        self._close.clicked.connect(self.hide)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(16, 4, 8, 4)
        self._grid.setSpacing(8)
        self._grid.setColumnStretch(0, 1)
        self._grid.addWidget(self.text, 0, 0)
        self._grid.addWidget(self._answers, 0, 1)
        self._grid.addWidget(self._close, 0, 2)
        self.setMinimumHeight(36)
        self.hide()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Put the buttons where the sentence keeps room."""
        super().resizeEvent(event)
        self._arrange()

    def event(self, event: QEvent) -> bool:
        """Put the buttons elsewhere where they become wider: words are looked up when they are painted."""
        if event.type() == QEvent.Type.LayoutRequest:
            self._arrange()
        return super().event(event)

    def _arrange(self) -> None:
        beside = self.width() - self._answers.sizeHint().width() - self._close.width() - 5 * self._grid.spacing()
        below = bool(self.buttons) and beside < min(_LEAST_TEXT_PX, self.text.sizeHint().width())
        if below != self._below:
            self._below = below
            self._grid.removeWidget(self._answers)
            if below:
                self._grid.addWidget(self._answers, 1, 0, 1, 3, Qt.AlignmentFlag.AlignLeft)
            else:
                self._grid.addWidget(self._answers, 0, 1)

    def hide(self) -> None:
        """Close the bar; it does not come back with the view that it spoke of."""
        self._seen_with.follow(None)
        super().hide()
        kept, self._kept, self._comes_back = self._kept, None, None
        if kept is not None:
            kept()

    def dismiss(self) -> None:
        """Close the bar, unless its question still needs an answer."""
        if not self._stays:
            self.hide()

    def turn_over(self) -> None:
        """Close the bar because something else is open from now on, even a question about what was before; one that
        comes back is about neither, and stays.
        """
        if self._comes_back is None:
            self.hide()

    def lapse(self) -> None:
        """Close the bar, with its buttons, if it speaks of the job as it was before it changed."""
        if self._of_job:
            self.hide()

    def ask(
        self,
        sentence: str,
        answers: Answers = (),
        error: bool = False,
        stays: bool = False,
        of_job: bool = False,
    ) -> None:
        """Show a sentence and a button for each answer; a pressed button closes the bar and acts.

        Args:
            sentence: what to say.
            answers: text of each button, and what it does.
            error: True for what went wrong.
            stays: True when only an answer, or another sentence, closes the bar.
            of_job: True when it holds of the job as it is now, and is to go when that changes.
        """
        if self._comes_back is not None:
            self._kept = self._comes_back
        self._again, self._comes_back = partial(self.ask, sentence, answers, error, stays, of_job), None
        self._stays, self._of_job, self.sentence = stays, of_job, sentence
        self._seen_with.follow(None)
        for button in self.buttons:
            self._row.removeWidget(button)
            put_away(button)  # a dialog that opens now would let it live, and lie over the sentence
        self.buttons = []
        self.text.setText(sentence)
        self.setProperty("error", "true" if error else "false")
        self.text.setProperty("role", "error" if error else "")
        for widget in (self, self.text):
            restyle(widget)
        for text, act in answers:
            button = QPushButton(text)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.clicked.connect(self.hide)
            button.clicked.connect(partial(_call, act))
            self.buttons.append(button)
            self._row.addWidget(button)
        self._answers.setVisible(bool(self.buttons))
        self._arrange()
        self.show()

    def come_back(self) -> None:
        """Have the sentence seen again, unanswered, once what takes its place is closed."""
        again = self._again

        def ask() -> None:
            if again is not None:
                again()
                self.come_back()

        self._comes_back = ask

    def show_with(self, view: QWidget) -> None:
        """Be seen only while the view is that the sentence speaks of; the next sentence stands for itself."""
        self._seen_with.follow(view)
