"""What is painted in the window's theme."""

from __future__ import annotations

from typing import cast

from PySide6.QtWidgets import QWidget

from .theme import LIGHT, Theme


class Themed:
    """A widget that is painted anew in another theme, and no more; it stands before the class of Qt among the bases."""

    _theme: Theme = LIGHT

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        cast(QWidget, self).update()
