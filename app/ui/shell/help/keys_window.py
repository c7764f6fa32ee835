"""Every key in one list: search it, give an action another key, take one back."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ...framework.catalogue import tr
from ...framework.fuzzy import fit
from ..bars.actions import Actions, plain
from ..bars.shortcuts import Shortcuts

_SIZE = (560, 600)
_NAME = Qt.ItemDataRole.UserRole
_MODIFIERS = (
    Qt.Key.Key_Control,
    Qt.Key.Key_Shift,
    Qt.Key.Key_Alt,
    Qt.Key.Key_Meta,
    Qt.Key.Key_AltGr,
    Qt.Key.Key_unknown,
)
FIXED = (
    ("Zoom at the mouse", "wheel"),
    ("Pan", "middle button, Space + drag"),
    ("Leave a tool, clear the selection", "Esc"),
    ("Repeat the last tool, end a chain", "Enter"),
    ("Straight up or across while drawing", "Shift"),
    ("Turn the cut; from above, front, right, isometric", "drag; 1, 2, 3, 4"),
    ("Profile along a line over the cut", "Ctrl + drag"),
    ("Cut: play, play backward", "Space; Shift + Space"),
    ("Cut: NC line before, next; move before, next", ", . ; Shift + , ."),
    ("Cut: tool before, next; next finding, the one before", "[ ]; N, Shift + N"),
    ("Cut: start, end", "Home, End"),
    ("Stages: play, step, first and last", "Space; Left, Right; Home, End"),
    ("Stages: another region or phase", "Page up, Page down"),
    ("Cut an operation earlier, later", "Alt+Up, Alt+Down"),
    ("Place by number", "x,y   @dx,dy   @length<angle"),
)
"""Keys of the views themselves: what they do, and which they are."""

_HOW = "Double click or Enter on a line, then press its new key; Backspace takes the key away, Esc leaves it."


class KeysWindow(QDialog):
    """The list; a key that another action has is asked for once more before it is taken."""

    def __init__(self, over: QWidget, actions: Actions, shortcuts: Shortcuts) -> None:
        super().__init__(over)
        self._actions, self._shortcuts = actions, shortcuts
        self.setWindowTitle(tr("Keys"))
        self.resize(*_SIZE)
        self.search, self.list, self.told = QLineEdit(), QTreeWidget(), QLabel()
        self.reset, self.reset_all = QPushButton(tr("Reset")), QPushButton(tr("Reset all"))
        self.recording, self._asked = "", ""
        self._lay_out()
        self.search.textChanged.connect(lambda _: self._filter())
        self.list.itemActivated.connect(lambda item: self.record(item.data(0, _NAME)))
        self.list.currentItemChanged.connect(lambda *_: self._stop())
        self.list.installEventFilter(self)
        self.reset.clicked.connect(self._reset)
        self.reset_all.clicked.connect(self._reset_all)
        self._fill()

    def _lay_out(self) -> None:
        self.search.setPlaceholderText(tr("Search an action or a key"))
        self.search.setAccessibleName(tr("Search an action or a key"))
        self.list.setHeaderLabels([tr("Action"), tr("Menu"), tr("Key")])
        self.list.setRootIsDecorated(False)
        self.list.setUniformRowHeights(True)
        self.list.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.list.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.list.header().setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        self.list.header().setStretchLastSection(False)
        self.list.header().resizeSection(2, 170)
        self.told.setWordWrap(True)
        self.told.setProperty("role", "muted")
        column, row = QVBoxLayout(self), QHBoxLayout()
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(8)
        row.addWidget(self.told, 1)
        for button in (self.reset, self.reset_all):
            button.setAutoDefault(False)
            row.addWidget(button)
        column.addWidget(self.search)
        column.addWidget(self.list, 1)
        column.addLayout(row)

    def _fill(self) -> None:
        self.list.clear()
        for name, spec in self._actions.specs.items():
            item = QTreeWidgetItem([tr(plain(spec.text)), tr(plain(self._actions.menu_of[name])), ""])
            item.setData(0, _NAME, name)
            self.list.addTopLevelItem(item)
        for what, key in FIXED:
            item = QTreeWidgetItem([tr(what), "", key])
            item.setFlags(Qt.ItemFlag.ItemIsEnabled)
            self.list.addTopLevelItem(item)
        self._show_keys()

    def _items(self) -> list[QTreeWidgetItem]:
        rows = (self.list.topLevelItem(row) for row in range(self.list.topLevelItemCount()))
        return [item for item in rows if item is not None]

    def _show_keys(self) -> None:
        for item in self._items():
            name = item.data(0, _NAME)
            if name:
                item.setText(2, self._actions.key(name) or self._actions.specs[name].key_hint)
                font = item.font(2)
                font.setBold(self._shortcuts.is_own(name))
                item.setFont(2, font)
        self._stop()
        self._filter()

    def _filter(self) -> None:
        for item in self._items():
            item.setHidden(fit(self.search.text(), item.text(0), f"{item.text(1)} {item.text(2)}") is None)

    def _say(self, text: str) -> None:
        self.told.setText(text)

    def _stop(self) -> None:
        self.recording = self._asked = ""
        self._say(tr(_HOW))

    def record(self, name: str | None) -> None:
        """Wait for the new key of an action."""
        if name:
            self.list.setFocus()
            self.list.setCurrentItem(next(item for item in self._items() if item.data(0, _NAME) == name))
            self.recording, self._asked = name, ""
            self._say(tr("Press the new key of {}.").format(tr(plain(self._actions.specs[name].text))))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """While a key is recorded, every key is the new one."""
        if not self.recording or not isinstance(event, QKeyEvent):
            return super().eventFilter(watched, event)
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()
            return True
        if event.type() == QEvent.Type.KeyPress and Qt.Key(event.key()) not in _MODIFIERS:
            self._take(event)
        return True

    def _take(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self._stop()
            return
        key = "" if event.key() == Qt.Key.Key_Backspace else QKeySequence(event.keyCombination()).toString()
        plain_key = not event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier)
        if key and plain_key and not Qt.Key.Key_F1 <= event.key() <= Qt.Key.Key_F35:
            self._say(tr("{} alone begins a command; use it with Ctrl or Alt, or an F key.").format(key))
            return
        other = self._shortcuts.owner(key, but=self.recording)
        if other is not None and self._asked != key:
            self._asked = key
            self._say(
                tr("{} belongs to {}. Press it again to take it from there.").format(
                    key, tr(plain(self._actions.specs[other].text))
                )
            )
            return
        self._shortcuts.change(self.recording, key)
        self._show_keys()

    def _reset(self) -> None:
        item = self.list.currentItem()
        if item is not None and item.data(0, _NAME):
            self._shortcuts.reset(item.data(0, _NAME))
            self._show_keys()

    def _reset_all(self) -> None:
        self._shortcuts.reset_all()
        self._show_keys()
