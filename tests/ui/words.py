"""What the widgets of a window say, whether anybody sees them or not."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QAbstractButton, QComboBox, QLabel, QLineEdit, QWidget
from shiboken6 import isValid

Worded = QLabel | QAbstractButton | QLineEdit


@dataclass(frozen=True, slots=True)
class Words:
    """What a widget says.

    Attributes:
        widget: that says it. text: of a label, a button or a field. tip: over it.
    """

    widget: Worded
    text: str
    tip: str

    def put_back(self) -> None:
        """Have a widget that nobody sees say that again; one that is seen is looked at with the rest of the window."""
        widget = self.widget
        if not isValid(widget) or (widget.text(), widget.toolTip()) == (self.text, self.tip):
            return
        if not widget.isVisibleTo(widget.window()):
            with QSignalBlocker(widget):
                widget.setText(self.text)
                widget.setToolTip(self.tip)


def words_in(window: QWidget) -> list[Words]:
    """Return what every widget of a window says, seen or not."""
    kinds = (QLabel, QAbstractButton, QLineEdit)
    widgets = (each for kind in kinds for each in window.findChildren(kind))
    return [Words(each, each.text(), each.toolTip()) for each in widgets]


def said_by(window: QWidget) -> Counter[tuple[str, str]]:
    """Return everything that a window's widgets say, tips and choices among it, by the kind of widget."""
    said = Counter[tuple[str, str]]()
    for each in window.findChildren(QWidget):
        kind = type(each).__name__
        said[kind, each.toolTip()] += 1
        if isinstance(each, Worded):
            said[kind, each.text()] += 1
        elif isinstance(each, QComboBox):
            said.update((kind, each.itemText(at)) for at in range(each.count()))
    return Counter({words: count for words, count in said.items() if words[1]})
