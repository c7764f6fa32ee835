"""The steps of the text one under the other: a tick on those that were reached, the one that is shown chosen."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtWidgets import QAbstractItemView, QListWidget, QListWidgetItem

from ....raster.steps import STEPS
from ...framework.icons import SIZE, icon
from ...framework.theme import LIGHT, Theme
from ...framework.translated_items import TranslatedItems
from .film import PHASES

WIDTH = 260
_ROW_PX, _BREAK_PX, _AROUND = 26, 8, 2
_STEP = Qt.ItemDataRole.UserRole
_FIRSTS = {numbers[0] for numbers in PHASES[1:]}


class StepList(QListWidget):
    """Numbers and names of the steps that happen.

    Signals:
        step_requested(number): show this step.
    """

    step_requested = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("stageRail")
        self.setFixedWidth(WIDTH)
        self.setIconSize(QSize(16, 16))
        self.setUniformItemSizes(False)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setAccessibleName("Steps of the text")
        self.setItemDelegate(TranslatedItems(self))
        self._theme = LIGHT
        self._items: dict[int, QListWidgetItem] = {}
        self._reached: frozenset[int] = frozenset()
        self._now = 0
        self._tick, self._none = QIcon(), _blank()
        self.set_theme(LIGHT)
        self.itemClicked.connect(lambda item: self.step_requested.emit(item.data(_STEP)))

    @property
    def numbers(self) -> tuple[int, ...]:
        """The steps that are listed."""
        return tuple(self._items)

    @property
    def now(self) -> int:
        """The step that is shown; 0 = none."""
        return self._now

    @property
    def reached(self) -> frozenset[int]:
        """The steps with a tick."""
        return self._reached

    def show_steps(self, numbers: tuple[int, ...]) -> None:
        """List other steps, in the text's order."""
        if numbers == self.numbers:
            return
        self.clear()
        self._items, self._reached, self._now = {}, frozenset(), 0
        for number in numbers:
            item = QListWidgetItem(self._none, f"{number}  {STEPS[number][0]}")
            item.setData(_STEP, number)
            item.setToolTip(f"{number}  {STEPS[number][0]}")
            item.setSizeHint(QSize(0, _ROW_PX + (_BREAK_PX if number in _FIRSTS and number != numbers[0] else 0)))
            item.setTextAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
            self.addItem(item)
            self._items[number] = item

    def show_place(self, number: int, reached: frozenset[int]) -> None:
        """Show which step is shown, and which were reached before."""
        for changed in reached ^ self._reached:
            if changed in self._items:
                self._items[changed].setIcon(self._tick if changed in reached else self._none)
        self._reached = reached
        if number != self._now and number in self._items:
            self._now = number
            self.setCurrentItem(self._items[number])
            row = self.currentRow()
            for near in (max(row - _AROUND, 0), min(row + _AROUND, self.count() - 1), row):
                self.scrollToItem(self.item(near), QAbstractItemView.ScrollHint.EnsureVisible)

    def set_theme(self, theme: Theme) -> None:
        """Draw the ticks in another theme."""
        self._theme = theme
        self._tick = icon("check", theme, theme.accent_text)
        for number in self._reached & set(self._items):
            self._items[number].setIcon(self._tick)


def _blank() -> QIcon:
    """Return an icon of nothing, so that names stand in one line."""
    picture = QPixmap(SIZE, SIZE)
    picture.fill(QColor(0, 0, 0, 0))
    return QIcon(picture)
