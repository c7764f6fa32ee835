"""The page that the window begins with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QGridLayout, QLabel, QScrollArea, QWidget

from ...framework.boxes import put_away, v_box
from ...framework.labels import muted
from ...framework.section import heading, theme_children
from ...framework.theme import text_font
from ...framework.themed import Themed
from .file_card import FileCard
from .new_card import NewCard

COLUMNS, _BESIDE_NEW = 4, 2
_TITLE_PX, _EDGE_PX, _WIDEST_PX = 22, 48, 1160


class StartPage(Themed, QScrollArea):
    """The last files, what is new, and samples, in four columns.

    Signals:
        opened(Path): a file was pressed. sampled(Path): a sample was. left(): the user wants to draw instead.

    Attributes:
        files, samples: cards. new: asks for a new part.
    """

    opened = Signal(Path)
    sampled = Signal(Path)
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.files: list[FileCard] = []
        self.samples: list[FileCard] = []
        self.new = NewCard()
        self.setWidgetResizable(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName("Start")
        inner = QWidget()
        self._grid = QGridLayout()
        self._grid.setHorizontalSpacing(16)
        self._grid.setVerticalSpacing(10)
        for column in range(COLUMNS):
            self._grid.setColumnStretch(column, 1)
        title = QLabel("Start here")
        title.setFont(text_font(_TITLE_PX, semibold=True))
        title.setStyleSheet(f"font-size: {_TITLE_PX}px; font-weight: 600;")
        self._last, self._try = heading("Last"), heading("Try one")
        rows = v_box(inner, (_EDGE_PX, 24, _EDGE_PX, 24), 8)
        rows.addWidget(title)
        rows.addWidget(muted("Drop a drawing, a solid or an NC program anywhere."))
        rows.addSpacing(8)
        rows.addLayout(self._grid)
        rows.addStretch(1)
        self._grid.addWidget(self._last, 0, 0, 1, _BESIDE_NEW)
        self._try.setContentsMargins(0, 12, 0, 0)
        self._grid.addWidget(self._try, 3, 0, 1, COLUMNS)
        inner.setMaximumWidth(_WIDEST_PX + 2 * _EDGE_PX)
        self.setWidget(inner)

    def show_files(self, files: Sequence[FileCard], samples: Sequence[FileCard]) -> None:
        """Show other files; those that do not fit beside what is new stand in a row of their own."""
        for card in (*self.files, *self.samples):
            self._grid.removeWidget(card)
            put_away(card)
        self.files, self.samples = list(files), list(samples)
        beside, more = self.files[:_BESIDE_NEW], self.files[_BESIDE_NEW : _BESIDE_NEW + COLUMNS]
        self._last.setVisible(bool(files))
        for column, card in enumerate(beside):
            self._grid.addWidget(card, 1, column, Qt.AlignmentFlag.AlignTop)
        self._grid.addWidget(self.new, 1, _BESIDE_NEW if beside else 0, 1, 2)
        for column, card in enumerate(more):
            self._grid.addWidget(card, 2, column)
        for column, card in enumerate(self.samples):
            self._grid.addWidget(card, 4, column)
        for card in self.files:
            card.clicked.connect(lambda _=False, path=card.path: self.opened.emit(path))
        for card in self.samples:
            card.clicked.connect(lambda _=False, path=card.path: self.sampled.emit(path))
        theme_children(self, self._theme)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Escape goes to the empty drawing."""
        if event.key() == Qt.Key.Key_Escape:
            self.left.emit()
        else:
            super().keyPressEvent(event)
