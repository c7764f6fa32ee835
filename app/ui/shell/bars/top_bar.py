"""The bar above the canvas with files, views and Compute."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QToolButton, QWidget

from ...framework.icons import icon
from ...framework.theme import Theme
from ...framework.view import views
from .actions import Actions

TOP_HEIGHT = 46


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
        self.setObjectName("topBar")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedHeight(TOP_HEIGHT)
        self._actions = actions
        self.compute, self.export = QPushButton(" Compute  F5"), QPushButton(" Export NC")
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 0, 12, 0)
        row.setSpacing(4)
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
        button.clicked.connect(action.trigger)
        action.enabledChanged.connect(button.setEnabled)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self.compute.setIcon(icon("compute", theme, theme.accent_ink))
        self.export.setIcon(icon("export", theme))
