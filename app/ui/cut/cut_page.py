"""The cut, and under it the bar that plays it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.ui.cut.cut_view import CutView
from app.ui.cut.player import Player
from app.ui.cut.transport import Transport


class CutPage(QWidget):
    """Puts view and bar together; keys that the view does not take play.

    Attributes:
        view: the cut. player: plays it. transport: the bar; hidden while there is no cut.
    """

    def __init__(self, view: CutView) -> None:
        super().__init__()
        self.view, self.player = view, Player(view, view)
        self.transport = Transport(self.player)
        self._keys = self.transport.keys()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(view, 1)
        column.addWidget(self.transport)
        self.setFocusProxy(view)
        self.transport.hide()
        self.player.state_changed.connect(self._on_state)
        view.installEventFilter(self)
        view.painting.rested.connect(self._prepare)

    def showEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Prepare playing when the cut is first looked at."""
        self._prepare()

    def eventFilter(self, watched: QWidget, event: QEvent) -> bool:  # type: ignore[override]  # noqa: N802 (Qt's name)
        """Keep the keys that play from whoever types elsewhere, and do what they ask."""
        if isinstance(event, QKeyEvent) and event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress):
            act = self._keys.get((Qt.Key(event.key()), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier))
            if act is not None and self.player.shown is not None:
                event.accept()
                if event.type() == QEvent.Type.KeyPress:
                    act()
                return True
        return super().eventFilter(watched, event)

    def _prepare(self) -> None:
        if self.isVisible() and self.view.picture is not None:
            self.player.prepare()

    def _on_state(self) -> None:
        self.transport.setVisible(self.player.shown is not None)
