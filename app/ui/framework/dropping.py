"""Menus that drop from a button and stay within its window."""

from __future__ import annotations

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QMenu, QWidget


def drop(menu: QMenu, button: QWidget) -> None:
    """Open a menu under a button: its left edges in line, or its right ones where it would leave the window."""
    menu.popup(place_under(button, menu.sizeHint().width()))


def place_under(button: QWidget, width: int) -> QPoint:
    """Return where on the screen a menu of a width, px, drops from a button."""
    window = button.window()
    right = window.mapToGlobal(QPoint(window.width(), 0)).x()
    corner = button.mapToGlobal(button.rect().bottomLeft())
    return QPoint(min(corner.x(), right - width), corner.y())
