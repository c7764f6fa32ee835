"""Boxes that widgets stand in beside or below one another, and what is said over and over of them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLayout, QVBoxLayout, QWidget

Margins = tuple[int, int, int, int]
"""Left, top, right, bottom, px."""

_NONE: Margins = (0, 0, 0, 0)
_OF_THE_STYLE = -1
"""The spacing that Qt takes for "as the style has it"."""


def v_box(parent: QWidget | None = None, margins: Margins = _NONE, spacing: int = _OF_THE_STYLE) -> QVBoxLayout:
    """Return a box for what stands below one another, spacing in px; it is `parent`'s, if there is one."""
    box = QVBoxLayout(parent) if parent is not None else QVBoxLayout()
    box.setContentsMargins(*margins)
    box.setSpacing(spacing)
    return box


def h_box(parent: QWidget | None = None, margins: Margins = _NONE, spacing: int = _OF_THE_STYLE) -> QHBoxLayout:
    """Return a box for what stands beside one another, spacing in px; it is `parent`'s, if there is one."""
    box = QHBoxLayout(parent) if parent is not None else QHBoxLayout()
    box.setContentsMargins(*margins)
    box.setSpacing(spacing)
    return box


def give_ground(widget: QWidget, name: str) -> None:
    """Have the style sheet paint a plain widget's ground, by a name of the sheet."""
    widget.setObjectName(name)
    widget.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)


def empty(layout: QLayout) -> None:
    """Take every widget out of a layout for good."""
    while (item := layout.takeAt(0)) is not None:
        if (widget := item.widget()) is not None:
            put_away(widget)


def put_away(widget: QWidget) -> None:
    """Hide a widget at once and delete it when Qt has time."""
    widget.hide()
    widget.deleteLater()
