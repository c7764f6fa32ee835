"""A part of the side panel: a heading, perhaps a button beside it, and rows."""

from __future__ import annotations

import math

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QFrame, QLabel, QWidget

from .boxes import h_box, v_box
from .labels import restyle
from .theme import HEADING_PX, Theme, text_font

EDGE = 16
_OWN_KEYS = frozenset(
    {
        (Qt.KeyboardModifier.ControlModifier | Qt.Key.Key_D).toCombined(),
        (Qt.KeyboardModifier.AltModifier | Qt.Key.Key_Up).toCombined(),
        (Qt.KeyboardModifier.AltModifier | Qt.Key.Key_Down).toCombined(),
        int(Qt.Key.Key_Delete),
    }
)


def heading(text: str) -> QLabel:
    """Return a label in the heading's type."""
    made = QLabel(text)
    made.setFont(text_font(HEADING_PX, semibold=True))
    made.setStyleSheet(f"font-size: {HEADING_PX}px; font-weight: 600;")
    return made


def hairline() -> QFrame:
    """Return a separator, 1 px high."""
    made = QFrame()
    made.setObjectName("hairline")
    made.setFixedHeight(1)
    return made


def upright_hairline() -> QFrame:
    """Return a separator, 1 px wide."""
    made = QFrame()
    made.setObjectName("hairline")
    made.setFixedWidth(1)
    return made


def theme_children(parent: QWidget, theme: Theme) -> None:
    """Give a theme to every part of a widget that takes one."""
    for child in parent.findChildren(QWidget):
        if hasattr(child, "set_theme"):
            child.set_theme(theme)


class PanelSection(QWidget):
    """Heading and rows, 16 px from the panel's edges."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title = heading(title)
        self.head = h_box(margins=(EDGE, 0, EDGE - 4, 0), spacing=4)
        self.head.addWidget(self.title)
        self.head.addStretch(1)
        self.rows = v_box(self, (0, 8, 0, 8), 0)
        self.rows.addLayout(self.head)
        self.rows.addSpacing(2)

    def add_indented(self, widget: QWidget) -> None:
        """Add a row that keeps the panel's margins."""
        line = h_box(margins=(EDGE, 0, EDGE, 0))
        self.rows.addLayout(line)  # first: PySide frees a widget twice that went into a layout without a window
        line.addWidget(widget)


class ListRow(QWidget):
    """A line of a list that can be chosen with the mouse or the keyboard; `widgets` fill it from the left."""

    clicked = Signal()
    removed = Signal()
    stepped = Signal(int)
    moved = Signal(int)
    copied = Signal()

    def __init__(self, *widgets: QWidget, stretch_after: int = 0, wide: int = -1) -> None:
        """Make a row.

        Args:
            widgets: from the left.
            stretch_after: index of the one behind which room is left.
            wide: index of the one that takes all the room there is; -1 = none.
        """
        super().__init__()
        self._pressed_at, self._named = 0.0, False
        self.setProperty("row", "true")
        self.setProperty("chosen", "false")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedHeight(28)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        line = h_box(self, (EDGE, 0, EDGE, 0), 8)
        for at, widget in enumerate(widgets):
            line.addWidget(widget, 1 if at == wide else 0)
            if at == stretch_after:
                line.addStretch(1)

    @property
    def stops(self) -> list[QWidget]:
        """The row and what in it the Tab key reaches, in this order."""
        inner = (child for child in self.findChildren(QWidget) if child.focusPolicy() & Qt.FocusPolicy.TabFocus)
        return [self, *inner]

    def focusInEvent(self, event: QFocusEvent) -> None:  # noqa: N802 (Qt's name)
        """Be read aloud as it reads now, in the window's language."""
        self._read_aloud()
        super().focusInEvent(event)

    def call(self, name: str) -> None:
        """Give the row a name for those who have it read aloud, in place of its words."""
        self._named = True
        self.setAccessibleName(name)

    def _read_aloud(self) -> None:
        """Have the row's words for its name, unless it was given one."""
        if not self._named:
            words = (label.text() for label in self.findChildren(QLabel) if not label.isHidden())
            self.setAccessibleName(", ".join(filter(None, words)))

    def set_chosen(self, chosen: bool) -> None:
        """Show whether this row's properties are the ones below."""
        if (self.property("chosen") == "true") != chosen:
            self.setProperty("chosen", "true" if chosen else "false")
            restyle(self)

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Choose."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.clicked.emit()
            self.setFocus(Qt.FocusReason.MouseFocusReason)
            self._pressed_at = event.globalPosition().y()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Dragged over the better part of a row, move by one."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            way = event.globalPosition().y() - self._pressed_at
            if abs(way) > self.height() * 0.75:
                self._pressed_at += math.copysign(self.height(), way)
                self.moved.emit(1 if way > 0 else -1)

    def event(self, event: QEvent) -> bool:
        """Keep the row's own keys from the window's shortcuts."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and (event.keyCombination().toCombined() in _OWN_KEYS)
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Space and Enter choose, Up and Down choose the neighbour, with Alt they move the row, Ctrl+D copies it,
        Delete removes.
        """
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}
        if event.key() in steps and event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self.moved.emit(steps[Qt.Key(event.key())])
        elif event.key() in steps:
            self.stepped.emit(steps[Qt.Key(event.key())])
        elif event.key() in (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.clicked.emit()
        elif event.key() == Qt.Key.Key_Delete:
            self.removed.emit()
        elif event.key() == Qt.Key.Key_D and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.copied.emit()
        else:
            super().keyPressEvent(event)
