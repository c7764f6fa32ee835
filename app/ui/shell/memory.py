"""What the window remembers from one run to the next."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from PySide6.QtCore import QByteArray, QRect

from ...core.errors import HitofudeError
from ...core.settings import ThemeChoice, save_settings
from .main_window import MainWindow

_TITLE_BAR_PX = 36
"""Kept free for the title bar, which the desktop adds above the window."""


def remember(window: MainWindow) -> None:
    """Save settings and the window's place; a folder that cannot be written is no reason to bother anybody."""
    geometry = bytes(window.saveGeometry().toBase64().data()).decode()
    window.settings = replace(window.settings, window_geometry=geometry)
    with suppress(HitofudeError):
        save_settings(window.settings)


def restore_geometry(window: MainWindow) -> None:
    """Put the window where it was the last time, and in any case onto the screen."""
    if window.settings.window_geometry:
        window.restoreGeometry(QByteArray.fromBase64(window.settings.window_geometry.encode()))
    fit_onto(window, window.screen().availableGeometry())


def fit_onto(window: MainWindow, screen: QRect) -> None:
    """Make the window no larger than a screen's free rectangle, and move it there when it reaches beyond."""
    if window.isMaximized() or window.isFullScreen():
        return
    room = screen.adjusted(0, _TITLE_BAR_PX, 0, 0)
    window.resize(window.size().boundedTo(room.size()))
    if not room.contains(window.geometry()):
        window.move(screen.topLeft())


def choose_theme(window: MainWindow, choice: ThemeChoice) -> None:
    """Switch colours and remember it."""
    window.settings = replace(window.settings, theme=choice)
    window.set_theme_choice(choice)
    remember(window)
