"""Rows of a list in the language that the window speaks."""

from __future__ import annotations

from PySide6.QtCore import QLocale
from PySide6.QtWidgets import QStyledItemDelegate

from .catalogue import tr


class TranslatedItems(QStyledItemDelegate):
    """Looks up what a row says when it is painted; the row itself stays as it is."""

    def displayText(self, value: object, locale: QLocale | QLocale.Language) -> str:  # noqa: N802 (Qt's name)
        """Return what is painted of a row."""
        return tr(str(value))
