"""The cut, and under it the bar that plays it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QWidget

from ...framework.boxes import v_box
from .cut_player import CutPlayer
from .record_sheet import RecordSheet
from .surface import pixel_size
from .transport import Transport
from .view import CutView


class CutPage(QWidget):
    """Puts view and bar together; keys that the view does not take play.

    Attributes:
        view: the cut. player: plays it. transport: the bar; hidden while there is no cut. sheet: asks how it shall be
            recorded. preparing: whether the job's cut is made ready to be looked at. cutting: whether
            another program is being cut.
    """

    def __init__(self, view: CutView) -> None:
        super().__init__()
        self.view, self.player = view, CutPlayer(view, view)
        self.transport = Transport(self.player)
        self.sheet, self.preparing, self.cutting = RecordSheet(self), False, False
        self.sheet.closed.connect(self.close_sheet)
        self._keys = self.transport.keys()
        column = v_box(self, spacing=0)
        column.addWidget(view, 1)
        column.addWidget(self.transport)
        self.setFocusProxy(view)
        self.transport.hide()
        self.player.state_changed.connect(self._on_state)
        view.installEventFilter(self)
        view.render_scheduler.rested.connect(self._prepare)

    def showEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Prepare playing when the cut is first looked at."""
        self._prepare()

    def hideEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """What nobody sees is not played."""
        self.player.pause()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Keep the keys that play from whoever types elsewhere, and do what they ask."""
        if isinstance(event, QKeyEvent) and event.type() in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress):
            act = self._keys.get((Qt.Key(event.key()), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier))
            if act is not None and self.player.shown is not None:
                event.accept()
                if event.type() == QEvent.Type.KeyPress:
                    act()
                return True
        return super().eventFilter(watched, event)

    def open_sheet(self) -> None:
        """Ask how the cut shall be recorded."""
        self.sheet.open_for(pixel_size(self.view))
        self._place_sheet()

    def close_sheet(self) -> None:
        """Ask no more."""
        self.sheet.hide()
        self.view.setFocus()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep the sheet above the bar's right end."""
        self._place_sheet()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Escape closes the sheet."""
        if event.key() == Qt.Key.Key_Escape and self.sheet.isVisible():
            self.close_sheet()
        else:
            super().keyPressEvent(event)

    def _place_sheet(self) -> None:
        below = self.transport.sizeHint().height()
        self.sheet.move(self.width() - self.sheet.width() - 12, self.height() - below - self.sheet.height() - 8)

    def _prepare(self) -> None:
        if self.isVisible() and self.view.model.picture is not None:
            self.player.prepare()

    def _on_state(self) -> None:
        self.transport.setVisible(self.player.shown is not None)
