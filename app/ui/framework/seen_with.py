"""A bar that speaks of one view is seen only while that view is."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QWidget


class SeenWith(QObject):
    """Shows a widget while another one is shown."""

    def __init__(self, widget: QWidget) -> None:
        super().__init__(widget)
        self._widget = widget
        self._view: QWidget | None = None

    def follow(self, view: QWidget | None) -> None:
        """Come and go with a view from now on; None = with none."""
        if self._view is not None:
            self._view.removeEventFilter(self)
        self._view = view
        if view is not None:
            view.installEventFilter(self)
            self._widget.setVisible(not view.isHidden())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Follow what is shown or hidden."""
        if watched is self._view and event.type() in (QEvent.Type.Show, QEvent.Type.Hide):
            self._widget.setVisible(event.type() == QEvent.Type.Show)
        return super().eventFilter(watched, event)
