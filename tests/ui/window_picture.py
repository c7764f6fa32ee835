"""What a user sees of the window: itself, and whatever is open over it."""

from __future__ import annotations

from PySide6.QtCore import QPoint
from PySide6.QtGui import QPainter, QPixmap
from PySide6.QtWidgets import QApplication, QWidget


def seen(window: QWidget) -> QPixmap:
    """Return what is on the screen where the window is: itself, and the menus, lists and windows over it."""
    picture, origin = window.grab(), window.mapToGlobal(QPoint(0, 0))
    painter = QPainter(picture)
    for other in QApplication.topLevelWidgets():
        if other.isVisible() and not isinstance(other, type(window)):
            painter.drawPixmap(other.mapToGlobal(QPoint(0, 0)) - origin, other.grab())
    painter.end()
    return picture
