"""Where the window stood the last time."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QByteArray, QRect
from PySide6.QtWidgets import QWidget

from ..framework.preferences import Preferences

_TITLE_BAR_PX = 36
"""Kept free for the title bar, which the desktop adds above the window."""


def remember_geometry(window: QWidget, preferences: Preferences) -> None:
    """Put the window's place among the settings."""
    geometry = bytes(window.saveGeometry().toBase64().data()).decode()
    preferences.settings = replace(preferences.settings, window_geometry=geometry)


def restore_geometry(window: QWidget, preferences: Preferences) -> None:
    """Put the window where it was the last time, and in any case onto the screen."""
    if preferences.settings.window_geometry:
        window.restoreGeometry(QByteArray.fromBase64(preferences.settings.window_geometry.encode()))
    fit_onto(window, window.screen().availableGeometry())


def fit_onto(window: QWidget, screen: QRect) -> None:
    """Make the window no larger than a screen's free rectangle, and move it there when it reaches beyond."""
    if window.isMaximized() or window.isFullScreen():
        return
    room = screen.adjusted(0, _TITLE_BAR_PX, 0, 0)
    window.resize(window.size().boundedTo(room.size()))
    if not room.contains(window.geometry()):
        window.move(screen.topLeft())
