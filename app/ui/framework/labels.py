"""Labels: the quiet one, and the one that ends in … when it does not fit."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QHelpEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QAbstractButton, QLabel, QToolTip, QWidget

from .catalogue import tr

_LEAST_PX, _FEW_LETTERS = 24, 2


def muted(text: str = "") -> QLabel:
    """Return a label in the quiet colour."""
    made = QLabel(text)
    made.setProperty("role", "muted")
    return made


def restyle(widget: QWidget) -> None:
    """Let the style sheet look at a widget's properties again."""
    widget.style().unpolish(widget)
    widget.style().polish(widget)


def set_role(widget: QWidget, role: str) -> None:
    """Give a widget that is seen already another role in the style sheet; "" = none."""
    widget.setProperty("role", role)
    restyle(widget)


def show_words(label: QLabel | QAbstractButton, words: str) -> None:
    """Show a label with other words; without any it is not there."""
    label.setText(words)
    label.setVisible(bool(words))


class Elided(QLabel):
    """One line that gives way where room is short, and then tells itself whole under the mouse.

    Attributes:
        shorter: what is said in the text's place where that does not fit, the longest first; "" = nothing rather
            than a part of a word.
    """

    def __init__(self, text: str = "", role: str = "", shorter: Sequence[str] = ()) -> None:
        """Make one; `role` is its colour: "muted", "error", or "" for ink."""
        super().__init__(text)
        self.setProperty("role", role)
        self.shorter = tuple(shorter)

    def minimumSizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """A few letters."""
        return QSize(_LEAST_PX, super().minimumSizeHint().height())

    @property
    def cut_off(self) -> bool:
        """Whether there is more text than room."""
        return self.fontMetrics().horizontalAdvance(self.text()) > self.width()

    def event(self, event: QEvent) -> bool:
        """Show the whole text as a tip where nothing else is to be said."""
        if isinstance(event, QHelpEvent) and not self.toolTip() and self.cut_off:
            QToolTip.showText(event.globalPos(), self.text(), self)
            return True
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw as much as fits."""
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        painter.drawText(self.rect(), self.alignment(), self.shown)

    @property
    def shown(self) -> str:
        """As much as fits: all of it, what is said in its place, or its beginning."""
        metrics, wordings = self.fontMetrics(), (self.text(), *map(tr, self.shorter))
        fitting = (each for each in wordings if metrics.horizontalAdvance(each) <= self.width())
        found = next(fitting, None)
        if found is not None:
            return found
        begun = metrics.elidedText(wordings[-1], Qt.TextElideMode.ElideRight, self.width())
        return begun if len(begun) > _FEW_LETTERS else ""  # "…" alone says nothing
