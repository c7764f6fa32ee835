"""What helps to aim, chosen at the switches of the status bar and remembered: kinds of snaps, the step of polar rays,
tracking.
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolButton

from ....core.settings import Settings
from ...framework.preferences import Preferences
from ...views.canvas.snap import CHOICES, SNAP_NAMES, SNAP_WORDS
from ...views.canvas.snap_state import SnapState
from .status_bar import StatusBar

STEPS = (15.0, 30.0, 45.0, 90.0)
_WORDS = {kind: word for word, kind in SNAP_WORDS.items()}


class SnapController(QObject):
    """The menus at Snap and at Polar.

    Attributes:
        kinds: the switch of each kind of snap. steps: of each step of polar rays, degrees. tracking: of points rested
            on.
    """

    def __init__(self, aiming: SnapState, status: StatusBar, polar: QAction, preferences: Preferences) -> None:
        """Make one; `polar` is the action that switches the rays."""
        super().__init__(status)
        self._aiming, self._status, self._preferences, settings = aiming, status, preferences, preferences.settings
        at_snap, at_polar = _menu_at(status.snap), _menu_at(status.polar)
        self.kinds = {
            kind: _switch(at_snap, f"{SNAP_NAMES[kind]}\t{_WORDS[kind]}", _WORDS[kind] in settings.snaps)
            for kind in CHOICES
        }
        at_snap.addSeparator()
        self.tracking = _switch(at_snap, "Track points rested on", settings.tracking)
        group = QActionGroup(at_polar)
        self.steps = {step: _switch(at_polar, f"{step:g}°", step == _step(settings)) for step in STEPS}
        for action in self.steps.values():
            group.addAction(action)
        self.on = polar
        self.on.setChecked(settings.polar_on)
        for action in (*self.kinds.values(), self.tracking, self.on):
            action.toggled.connect(lambda _: self._change())
        for action in self.steps.values():
            action.triggered.connect(lambda _: self._take_step())
        status.polar.clicked.connect(lambda on: self.on.setChecked(on))
        self._apply()

    def _take_step(self) -> None:
        """A step that is chosen is wanted now."""
        self.on.setChecked(True)
        self._change()

    def _change(self) -> None:
        snaps = tuple(_WORDS[kind] for kind, action in self.kinds.items() if action.isChecked())
        step = next(step for step, action in self.steps.items() if action.isChecked())
        self._preferences.keep(
            replace(
                self._preferences.settings,
                snaps=snaps,
                polar_step=f"{step:g}",
                polar_on=self.on.isChecked(),
                tracking=self.tracking.isChecked(),
            )
        )
        self._apply()

    def _apply(self) -> None:
        settings = self._preferences.settings
        kinds = frozenset(kind for kind, action in self.kinds.items() if action.isChecked())
        polar = _step(settings) if settings.polar_on else None
        self._aiming.switch(kinds=kinds, polar=polar, tracking=settings.tracking)
        self._status.polar.setChecked(settings.polar_on)
        self._status.polar.setText(f"Polar {_step(settings):g}°")


def _menu_at(button: QToolButton) -> QMenu:
    menu = QMenu(button)
    menu.setToolTipsVisible(True)
    button.setMenu(menu)
    button.setPopupMode(QToolButton.ToolButtonPopupMode.MenuButtonPopup)
    return menu


def _switch(menu: QMenu, text: str, on: bool) -> QAction:
    action = menu.addAction(text)
    action.setCheckable(True)
    action.setChecked(on)
    return action


def _step(settings: Settings) -> float:
    """Return the remembered step, degrees; what is none of those offered is 45."""
    return next((step for step in STEPS if f"{step:g}" == settings.polar_step), 45.0)
