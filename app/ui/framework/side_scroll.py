"""The right side of a view: what stands there below one another, and is scrolled where there is no room."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QScrollArea, QWidget

from .boxes import Margins, v_box

WIDTH = 328
"""Of the right side, px."""


class SideScroll(QScrollArea):
    """A panel at the right side.

    Attributes:
        column: what is shown, from the top.
    """

    def __init__(self, margins: Margins, spacing: int = 0) -> None:
        """Make a panel with so many px round what is shown, and between."""
        super().__init__()
        self.setFixedWidth(WIDTH)
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        inner = QWidget()
        inner.setObjectName("sidePanel")
        self.column = v_box(inner, margins, spacing)
        self.setWidget(inner)
