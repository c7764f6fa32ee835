"""What was done, step by step; a click on a step goes there."""

from __future__ import annotations

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QBrush, QResizeEvent
from PySide6.QtWidgets import QListWidget, QListWidgetItem

from ...drafting.document import Document
from ..framework.labels import muted
from ..framework.section import PanelSection
from ..framework.theme import LIGHT, Theme
from ..framework.translated_items import TranslatedItems

LEAST_PX = 120
BEGINNING = "Beginning"


class HistorySection(PanelSection):
    """Every change of a document by name, the oldest first; the one where it stands is chosen, those taken back are
    faint.

    Signals:
        wanted(done): the user wants so many of the changes done.
    """

    wanted = Signal(int)

    def __init__(self, document: Document) -> None:
        super().__init__("History")
        self._document, self._theme = document, LIGHT
        self._shown: object = None
        self.remark = muted()
        self.head.addWidget(self.remark)
        self.head.addSpacing(4)
        self.list = QListWidget()
        self.list.setAccessibleName("History: Enter goes to a step")
        self.list.setProperty("role", "rows")
        self.list.setItemDelegate(TranslatedItems(self.list))
        self.list.setUniformItemSizes(True)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setMinimumHeight(LEAST_PX)
        self.list.itemClicked.connect(self._go)
        self.list.itemActivated.connect(self._go)
        self.rows.addWidget(self.list, 1)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme, self._shown = theme, None
        self.refresh()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep the step where the document stands in sight."""
        super().resizeEvent(event)
        QTimer.singleShot(0, self, self._reveal)

    def _reveal(self) -> None:
        self.list.scrollToItem(self.list.currentItem())

    def refresh(self) -> None:
        """Show the steps as they are now."""
        names, done = self._document.history_names
        if (names, done) == self._shown:
            return
        self._shown = (names, done)
        self._fill((BEGINNING, *names))
        faint, ink = QBrush(self._theme.muted), QBrush(self._theme.ink)
        for at in range(self.list.count()):
            item = self.list.item(at)
            item.setForeground(faint if at > done else ink)
            item.setToolTip("Taken back; a click does it again" if at > done else "")
        self.list.setCurrentRow(done)
        self._reveal()
        undone = len(names) - done
        self.remark.setText(f"{undone} taken back" if undone else "")

    def _fill(self, names: tuple[str, ...]) -> None:
        """Change the items that differ, so that a step more costs one item."""
        for at, name in enumerate(names[: self.list.count()]):
            if self.list.item(at).text() != name:
                self.list.item(at).setText(name)
        while self.list.count() > len(names):
            self.list.takeItem(self.list.count() - 1)
        self.list.addItems(names[self.list.count() :])

    def _go(self, item: QListWidgetItem) -> None:
        done = self.list.row(item)
        if done != self._document.history_names[1]:
            self.wanted.emit(done)
