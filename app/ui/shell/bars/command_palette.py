"""The command palette: every action, command of the shape language and recent file by a few letters of its name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QEvent, QModelIndex, QObject, QPersistentModelIndex, QRect, QSize, Qt, Signal
from PySide6.QtGui import QFontMetrics, QKeyEvent, QPainter
from PySide6.QtWidgets import (
    QFrame,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QWidget,
)

from ....drafting.language.language import COMMANDS
from ...framework.boxes import v_box
from ...framework.catalogue import tr
from ...framework.fuzzy import fit
from ...framework.preferences import Preferences
from ...framework.theme import LIGHT, Theme
from .actions import Actions, plain

WIDTH, ROW_PX, SHOWN = 520, 30, 10
_RECENT = 8
_TOP_PX, _EDGE_PX = 12, 12
_ENTRY = Qt.ItemDataRole.UserRole


@dataclass(frozen=True)
class PaletteEntry:
    """One thing that can be done.

    Attributes:
        name: by which it is remembered. text: what it is called. where: its menu, or what kind of thing it is.
        key: shortcut, or "". act: does it. also: other words by which it is found.
    """

    name: str
    text: str
    where: str
    key: str
    act: Callable[[], object]
    also: str = ""


class _Rows(QStyledItemDelegate):
    """Name at the left, then quietly where it is, its key at the right."""

    theme = LIGHT

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:  # noqa: N802 (Qt's name)
        return QSize(0, ROW_PX)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        entry, theme = index.data(_ENTRY), self.theme
        area: QRect = option.rect
        if option.state & QStyle.StateFlag.State_Selected:
            painter.fillRect(area, theme.chosen)
        area = area.adjusted(_EDGE_PX, 0, -_EDGE_PX, 0)
        painter.setPen(theme.muted)
        painter.drawText(area, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, entry.key)
        metrics = QFontMetrics(painter.font())
        room = area.width() - metrics.horizontalAdvance(entry.key) - _EDGE_PX
        name = metrics.elidedText(entry.text, Qt.TextElideMode.ElideMiddle, room)
        after = metrics.horizontalAdvance(name) + _EDGE_PX
        painter.drawText(
            area.adjusted(after, 0, 0, 0),
            Qt.AlignmentFlag.AlignVCenter,
            metrics.elidedText(entry.where, Qt.TextElideMode.ElideRight, max(0, room - after)),
        )
        painter.setPen(theme.ink)
        painter.drawText(area, Qt.AlignmentFlag.AlignVCenter, name)


class CommandPalette(QFrame):
    """A line to type in and what fits it, over the top of the view; what was used lately stands first.

    Signals:
        left(): it was left, and the keys belong elsewhere.
    """

    left = Signal()

    def __init__(
        self,
        views: QWidget,
        actions: Actions,
        preferences: Preferences,
        begin_line: Callable[[str], object],
        open_file: Callable[[Path], object],
    ) -> None:
        """Make one over `views`; `begin_line` types a word of the shape language, `open_file` opens a recent file."""
        super().__init__(views.window())
        self.setObjectName("palette")
        self._views, self._all, self._preferences = views, actions, preferences
        self._begin_line, self._open_file = begin_line, open_file
        self.edit, self.list, self._rows = QLineEdit(), QListWidget(), _Rows()
        self.edit.setAccessibleName("Command palette")
        self.list.setAccessibleName("What fits")
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setItemDelegate(self._rows)
        column = v_box(self, (1, 8, 1, 4), 4)
        column.addWidget(self.edit)
        column.addWidget(self.list)
        self._entries: list[PaletteEntry] = []
        self.edit.textChanged.connect(self._show_fitting)
        self.edit.installEventFilter(self)
        self.list.itemClicked.connect(self._run)
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._rows.theme = theme
        self.list.viewport().update()

    def open(self) -> None:
        """Come up empty, with what was used lately first."""
        self._entries = [*self._actions(), *self._commands(), *self._files()]
        self.edit.setPlaceholderText(tr("Type a few letters of what you want to do"))
        self.edit.clear()
        self._show_fitting("")
        views = self._views
        corner = views.mapTo(views.window(), views.rect().topLeft())
        self.move(corner.x() + (views.width() - WIDTH) // 2, corner.y() + _TOP_PX)
        self.show()
        self.raise_()
        self.edit.setFocus()

    def _actions(self) -> list[PaletteEntry]:
        actions = self._all
        return [
            PaletteEntry(
                name,
                tr(plain(spec.text)),
                tr(plain(actions.menu_of[name])),
                actions.key(name) or spec.key_hint,
                actions[name].trigger,
                plain(spec.text),
            )
            for name, spec in actions.specs.items()
            if actions[name].isEnabled() and name != "palette"
        ]

    def _commands(self) -> list[PaletteEntry]:
        return [
            PaletteEntry(
                f"> {word}", word, tr("command of the shape language"), "", partial(self._begin_line, f"{word} ")
            )
            for word in COMMANDS
        ]

    def _files(self) -> list[PaletteEntry]:
        paths = [Path(name) for name in self._preferences.settings.recent_files]
        return [
            PaletteEntry(str(path), path.name, str(path.parent), "", partial(self._open_file, path)) for path in paths
        ]

    def _show_fitting(self, typed: str) -> None:
        recent = {name: at for at, name in enumerate(self._preferences.settings.recent_commands)}
        found = [
            (score, entry)
            for entry in self._entries
            if (score := fit(typed, entry.text, f"{entry.where} {entry.also}")) is not None
        ]
        found.sort(
            key=lambda pair: (-pair[0] - (10 if pair[1].name in recent else 0), recent.get(pair[1].name, len(recent)))
        )
        self.list.clear()
        for _, entry in found:
            item = QListWidgetItem()
            item.setData(_ENTRY, entry)
            item.setData(Qt.ItemDataRole.AccessibleTextRole, f"{entry.text}, {entry.where} {entry.key}")
            self.list.addItem(item)
        self.list.setCurrentRow(0)
        self.list.setFixedHeight(ROW_PX * min(max(len(found), 1), SHOWN) + 2)
        self.setFixedWidth(WIDTH)
        self.adjustSize()

    def _run(self, item: QListWidgetItem | None) -> None:
        if item is None:
            return
        entry: PaletteEntry = item.data(_ENTRY)
        names = (entry.name, *(name for name in self._preferences.settings.recent_commands if name != entry.name))
        self._preferences.keep(replace(self._preferences.settings, recent_commands=names[:_RECENT]))
        self._leave()
        entry.act()

    def _leave(self) -> None:
        self.hide()
        self.left.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Up and Down choose, Enter does it, Escape and a click elsewhere leave."""
        if event.type() == QEvent.Type.FocusOut and self.isVisible():
            self.hide()
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        steps = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1, Qt.Key.Key_PageUp: -SHOWN, Qt.Key.Key_PageDown: SHOWN}
        if event.key() in steps:
            self.list.setCurrentRow(
                min(max(self.list.currentRow() + steps[Qt.Key(event.key())], 0), self.list.count() - 1)
            )
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._run(self.list.currentItem())
        elif event.key() == Qt.Key.Key_Escape:
            self._leave()
        else:
            return super().eventFilter(watched, event)
        return True
