"""The page "Drawing" of the right side: properties of what is selected, layers, how it was read, clean-up, history."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QLineEdit, QScrollArea, QVBoxLayout, QWidget

from app.edit.document import Change, Document
from app.edit.errors import reason_of
from app.edit.sample import Box
from app.errors import HitofudeError
from app.ui.panels.drawing_cleanup import CleanUpSection
from app.ui.panels.drawing_fields import PointField
from app.ui.panels.drawing_history import HistorySection
from app.ui.panels.drawing_layers import LayersSection
from app.ui.panels.drawing_properties import PropertiesSection
from app.ui.panels.fields import NumberField
from app.ui.panels.reading_section import ReadingSection
from app.ui.panels.section import Section, hairline
from app.ui.panels.side_panel import WIDTH


class DrawingPage(QScrollArea):
    """Shows a document's drawing in figures; what the user changes becomes lines of the shape language.

    Args:
        document: followed from now on; shown when the page is, or becomes, visible.
        extent: gives the box round all that is drawn, None while nothing is.

    Signals:
        refused(sentence): something that the drawing does not allow.
    """

    refused = Signal(str)

    def __init__(self, document: Document, extent: Callable[[], Box | None]) -> None:
        super().__init__()
        self._document, self._extent = document, extent
        self.properties, self.layers, self.history = PropertiesSection(document), LayersSection(document), HistorySection(document)
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
        inner = QWidget()
        inner.setObjectName("sidePanel")
        column = self.column = QVBoxLayout(inner)
        column.setContentsMargins(0, 4, 0, 8)
        column.setSpacing(0)
        for section in (self.properties, self.layers, self.reading, self.cleanup):
            column.addWidget(section)
            column.addWidget(self._below_reading if section is self.reading else hairline())
        column.addWidget(self.history, 1)
        self.setWidget(inner)
        self.setWidgetResizable(True)
        self.setFixedWidth(WIDTH)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

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

    def show_section(self, section: Section) -> None:
        """Bring a section into sight, and give it the keyboard."""
        self.refresh()
        QTimer.singleShot(0, self, lambda: self._reveal(section))

    def _reveal(self, section: Section) -> None:
        self.ensureWidgetVisible(section, 0, 0)
        found = [w for w in section.findChildren(QWidget) if w.isVisible() and w.focusPolicy() & Qt.FocusPolicy.TabFocus]
        first = next((w for w in found if isinstance(w, QLineEdit)), next(iter(found), None))
        if first is not None:
            first.setFocus(Qt.FocusReason.OtherFocusReason)

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Take over what happened while another page was in front."""
        super().showEvent(event)
        self.refresh()

    def _on_change(self, change: Change) -> None:
        if change & ~Change.LOG and self.isVisible():
            self._due.start()
