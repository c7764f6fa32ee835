"""The page "Drawing" of the right side: properties of what is selected, layers, how it was read, clean-up, history."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from ...core.errors import HitofudeError
from ...drafting.document import Document, DocumentChange
from ...drafting.expressions.errors import reason_of
from ...geometry.sample import Box
from ..framework.fields import NumberField
from ..framework.section import PanelSection, hairline
from ..framework.side_scroll import SideScroll
from .drawing_cleanup import CleanUpSection
from .drawing_fields import PointField
from .drawing_history import HistorySection
from .drawing_layers import LayersSection
from .drawing_properties import PropertiesSection
from .reading_section import ReadingSection


class DrawingPage(SideScroll):
    """Shows a document's drawing in figures; what the user changes becomes lines of the shape language.

    Args:
        document: followed from now on; shown when the page is, or becomes, visible.
        extent: gives the box round all that is drawn, None while nothing is.

    Signals:
        refused(sentence): something that the drawing does not allow.
    """

    refused = Signal(str)

    def __init__(self, document: Document, extent: Callable[[], Box | None]) -> None:
        super().__init__((0, 4, 0, 8))
        self._document, self._extent = document, extent
        self.properties, self.layers, self.history = (
            PropertiesSection(document),
            LayersSection(document),
            HistorySection(document),
        )
        self.cleanup, self.reading, self._below_reading = CleanUpSection(), ReadingSection(document), hairline()
        self._due = QTimer(self)
        self._due.setSingleShot(True)
        self._due.timeout.connect(self.refresh)
        self._lay_out()
        self.properties.asked.connect(self.run)
        self.layers.asked.connect(self.run)
        self.history.wanted.connect(document.go_to)
        document.subscribe(self._on_change)

    def _lay_out(self) -> None:
        column = self.column
        for section in (self.properties, self.layers, self.reading, self.cleanup):
            column.addWidget(section)
            column.addWidget(self._below_reading if section is self.reading else hairline())
        column.addWidget(self.history, 1)

    def run(self, line: str, field: NumberField | PointField | None = None) -> None:
        """Carry out a line; what is wrong with it is said at the field, or by `refused`."""
        try:
            self._document.run(line)
        except HitofudeError as wrong:
            reason = reason_of(wrong)
            if field is not None:
                field.refuse(reason)
            else:
                self.refused.emit(reason)

    def refresh(self) -> None:
        """Show the drawing as it is now."""
        self._due.stop()
        self.properties.refresh(self._extent())
        self.layers.refresh()
        self.reading.refresh()
        self._below_reading.setVisible(not self.reading.isHidden())
        self.history.refresh()

    def show_section(self, section: PanelSection) -> None:
        """Bring a section into sight, and give it the keyboard."""
        self.refresh()
        QTimer.singleShot(0, self, lambda: self._reveal(section))

    def _reveal(self, section: PanelSection) -> None:
        self.ensureWidgetVisible(section, 0, 0)
        found = [
            w for w in section.findChildren(QWidget) if w.isVisible() and w.focusPolicy() & Qt.FocusPolicy.TabFocus
        ]
        first = next((w for w in found if isinstance(w, QLineEdit)), next(iter(found), None))
        if first is not None:
            first.setFocus(Qt.FocusReason.OtherFocusReason)

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Take over what happened while another page was in front."""
        super().showEvent(event)
        self.refresh()

    def _on_change(self, change: DocumentChange) -> None:
        if change & ~DocumentChange.LOG and self.isVisible():
            self._due.start()
