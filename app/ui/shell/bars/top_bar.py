"""The bar above the canvas with files, views and Compute."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QIcon, QResizeEvent
from PySide6.QtWidgets import QFrame, QPushButton, QToolButton, QWidget

from ...framework.boxes import give_ground, h_box
from ...framework.icons import icon
from ...framework.theme import Theme
from ...framework.view import views
from .actions import Actions

TOP_HEIGHT = 46


@dataclass(frozen=True)
class _ButtonForm:
    """What stands on the two buttons at the right."""

    texts: tuple[str, str]
    icons: bool


_FORMS = (
    _ButtonForm((" Compute  F5", " Export NC"), icons=True),
    _ButtonForm(("Compute", "Export NC"), icons=False),
    _ButtonForm(("", ""), icons=True),
)
"""From the one that takes most room to that which takes least."""


def _line(width: int, height: int) -> QFrame:
    made = QFrame()
    made.setObjectName("hairline")
    made.setFixedSize(width, height)
    return made


def _button(actions: Actions, name: str, size: int) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(actions[name])
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
    button.setIconSize(QSize(20, 20))
    button.setFixedSize(size, size)
    button.setAutoRaise(True)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    return button


class TopBar(QWidget):
    """New, Open, Save, Undo, Redo; the views; Compute and Export."""

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        give_ground(self, "topBar")
        self.setFixedHeight(TOP_HEIGHT)
        self._actions = actions
        self.compute, self.export = QPushButton(), QPushButton()
        self._icons = QIcon(), QIcon()
        row = h_box(self, (10, 0, 12, 0), 4)
        for name in ("new", "open", "save", "", "undo", "redo", ""):
            if name:
                row.addWidget(_button(actions, name, 34))
            else:
                row.addSpacing(4)
                row.addWidget(_line(1, 20))
                row.addSpacing(4)
        self.tabs = {name: self._tab(name) for name in (view.value for view in views())}
        for tab in self.tabs.values():
            row.addWidget(tab)
        row.addStretch(1)
        self._connect(self.compute, "compute")
        self._connect(self.export, "export")
        self.compute.setProperty("role", "primary")
        row.addWidget(self.compute)
        row.addSpacing(4)
        row.addWidget(self.export)

    def _tab(self, name: str) -> QToolButton:
        tab = QToolButton()
        tab.setDefaultAction(self._actions[name])
        tab.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
        tab.setProperty("role", "tab")
        tab.setFixedHeight(TOP_HEIGHT - 1)
        return tab

    def _connect(self, button: QPushButton, name: str) -> None:
        action = self._actions[name]
        button.setFixedHeight(32)
        button.setIconSize(QSize(18, 18))
        button.setToolTip(action.toolTip())
        button.setAccessibleName(action.text().replace("&", ""))
        button.clicked.connect(action.trigger)
        action.enabledChanged.connect(button.setEnabled)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._icons = icon("compute", theme, theme.accent_ink), icon("export", theme)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Say no more on the buttons at the right than there is room for."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        row = self.layout()
        assert row is not None  # laid out when it was made
        for form in _FORMS:
            for button, text, picture in zip((self.compute, self.export), form.texts, self._icons, strict=True):
                button.setText(text)
                button.setIcon(picture if form.icons else QIcon())
            row.invalidate()
            if row.minimumSize().width() <= self.width():
                return
