"""A list of places in the program under its text: problems, or differences; a row jumps there. Empty, it is not
there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QLabel,
    QListWidget,
    QListWidgetItem,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)

from ...framework.boxes import give_ground, h_box, v_box
from ...framework.catalogue import tr
from ...framework.icons import IconButton
from ...framework.theme import LIGHT, Theme

_MOST, _SEEN, _ROW_PX = 500, 5, 24


class PlaceWeight(Enum):
    """How much a place matters; decides its colour."""

    ERROR = "error"
    WARNING = "warning"
    REMARK = "remark"


@dataclass(frozen=True, slots=True)
class ListedPlace:
    """One row: what to say, and how loud."""

    words: str
    tip: str
    weight: PlaceWeight


class _SpokenRow(QStyledItemDelegate):
    """A row in the language that is spoken when it is painted."""

    def initStyleOption(  # noqa: N802 (Qt's name)
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        """Put the words of that language in the place of the English ones."""
        super().initStyleOption(option, index)
        option.text = tr(option.text)


class PlacesPanel(QWidget):
    """Rows with a heading.

    Signals:
        picked(index): the user wants to see this place.
    """

    picked = Signal(int)

    def __init__(self, name: str, keys: str) -> None:
        """Make the panel; it hides until it has rows.

        Args:
            name: what it lists, such as "problem".
            keys: key of the next row; with Shift it is that of the row before.
        """
        super().__init__()
        give_ground(self, "ncPlaces")
        self.title, self.list = QLabel(), QListWidget()
        self.list.setAccessibleName(f"{name.capitalize()}s of the program")
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setUniformItemSizes(True)
        self.list.setItemDelegate(_SpokenRow(self.list))
        self.list.itemActivated.connect(lambda item: self.picked.emit(self.list.row(item)))
        self.list.itemClicked.connect(lambda item: self.picked.emit(self.list.row(item)))
        self.places: tuple[ListedPlace, ...] = ()
        self._theme: Theme = LIGHT
        head = h_box(margins=(12, 0, 8, 0), spacing=4)
        head.addWidget(self.title, 1)
        for icon, way, key in (("up", -1, f"Shift+{keys}"), ("down", 1, keys)):
            button = IconButton(icon, f"{'Next' if way > 0 else 'Previous'} {name} ({key})")
            button.clicked.connect(lambda _=False, w=way: self.step(w))
            head.addWidget(button)
        column = v_box(self, (0, 4, 0, 8), 2)
        column.addLayout(head)
        column.addWidget(self.list)
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        for row, place in enumerate(self.places[:_MOST]):
            self.list.item(row).setForeground(self._colour(place.weight))

    def show_places(self, title: str, places: Sequence[ListedPlace]) -> None:
        """List places, the first 500 of them; hide when there are none.

        Args:
            title: how many there are.
            places: in the order of the text.
        """
        self.places = tuple(places)
        self.title.setText(title if len(places) <= _MOST else f"{title}; the first {_MOST}")
        self.list.clear()
        for place in self.places[:_MOST]:
            item = QListWidgetItem(place.words)
            item.setToolTip(tr(place.tip))
            item.setForeground(self._colour(place.weight))
            self.list.addItem(item)
        self.list.setFixedHeight(_ROW_PX * min(max(len(places), 1), _SEEN) + 2)
        self.setVisible(bool(places))

    def step(self, way: int) -> None:
        """Go `way` rows farther down, round at the ends."""
        count = min(len(self.places), _MOST)
        if count:
            now = self.list.currentRow()
            row = (now + way) % count if now >= 0 else 0 if way > 0 else count - 1
            self.list.setCurrentRow(row)
            self.picked.emit(row)

    def _colour(self, weight: PlaceWeight) -> QColor:
        theme = self._theme
        return {PlaceWeight.ERROR: theme.error, PlaceWeight.WARNING: theme.warning, PlaceWeight.REMARK: theme.ink}[
            weight
        ]
