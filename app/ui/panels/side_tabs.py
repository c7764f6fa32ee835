"""The right side of the window: pages behind tabs — the job, the drawing, its text."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QButtonGroup, QStackedWidget, QToolButton, QWidget

from ..framework.boxes import give_ground, h_box, v_box
from ..framework.section import EDGE, hairline

HEIGHT = 36


class SideTabs(QWidget):
    """Pages behind tabs, as wide as the page that is in front.

    Signals:
        chosen(name): another page came to the front.
    """

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "sideTabs")
        self.pages = QStackedWidget()
        self.tabs: dict[str, QToolButton] = {}
        self._group = QButtonGroup(self)
        self._row = h_box(margins=(EDGE - 9, 0, EDGE, 0), spacing=4)
        self._row.addStretch(1)
        column = v_box(self, spacing=0)
        column.addLayout(self._row)
        column.addWidget(hairline())
        column.addWidget(self.pages, 1)

    @property
    def page(self) -> str:
        """Name of the page in front."""
        return next(name for name, tab in self.tabs.items() if tab.isChecked())

    def add_page(self, name: str, widget: QWidget, tip: str) -> None:
        """Add a page behind the others; the first one is in front."""
        tab = QToolButton()
        tab.setText(name)
        tab.setToolTip(tip)
        tab.setAccessibleName(f"{name}: {tip}")
        tab.setProperty("role", "tab")
        tab.setCheckable(True)
        tab.setFixedHeight(HEIGHT)
        tab.clicked.connect(lambda: self.show_page(name))
        self._group.addButton(tab)
        self._row.insertWidget(len(self.tabs), tab)
        self.tabs[name] = tab
        self.pages.addWidget(widget)
        if len(self.tabs) == 1:
            self.show_page(name)

    def show_page(self, name: str) -> None:
        """Bring a page to the front."""
        self.tabs[name].setChecked(True)
        self.pages.setCurrentIndex(list(self.tabs).index(name))
        self.setFixedWidth(self.pages.widget(self.pages.currentIndex()).maximumWidth() + 1)  # type: ignore[union-attr]
        self.chosen.emit(name)
