"""The layers of the drawing: seen, locked, coloured, named, counted; the one that is drawn on is marked."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from itertools import count, pairwise

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QFrame, QLineEdit, QMenu, QScrollArea, QWidget

from ...drafting.document import Document
from ...drafting.expressions.words import name_text
from ...model.part import Layer
from ..framework.boxes import put_away, v_box
from ..framework.figures import counted, grouped
from ..framework.icons import IconButton
from ..framework.labels import Elided, muted
from ..framework.section import EDGE, ListRow, PanelSection, theme_children
from ..framework.themed import Themed
from .swatch import HARD_TO_SEE, HUES, LayerColourButton

ROW_PX = 28
MOST_ROWS = 8
TIP = "Click: draw on it; double click: rename; drag, Alt+Up, Alt+Down: order; right click: more; Del: remove"


class LayerRow(ListRow):
    """One layer.

    Signals:
        asked(line): a line of the shape language. more(): wants the menu.
    """

    asked = Signal(str)
    more = Signal(object)

    def __init__(self, layer: Layer) -> None:
        self.name, self.text = Elided(layer.name), name_text(layer.name)
        self.eye, self.bolt = IconButton("eye", ""), IconButton("lock-open", "")
        self.swatch, self.count, self.edit = LayerColourButton(layer.name), muted(), QLineEdit(layer.name)
        super().__init__(self.eye, self.bolt, self.swatch, self.name, self.edit, self.count, stretch_after=-1, wide=3)
        self.layout().setStretch(4, 1)  # type: ignore[union-attr]
        self.layout().setSpacing(4)  # type: ignore[union-attr]
        self.layout().setContentsMargins(EDGE - 4, 0, EDGE, 0)  # type: ignore[union-attr]
        self._layer = layer
        self.edit.setAccessibleName(f"New name of layer {layer.name}")
        self.edit.hide()
        self.edit.installEventFilter(self)
        self.edit.editingFinished.connect(self._rename)
        self.eye.clicked.connect(lambda: self.asked.emit(f"{'hide' if self._layer.visible else 'show'} {self.text}"))
        self.bolt.clicked.connect(lambda: self.asked.emit(f"{'unlock' if self._layer.locked else 'lock'} {self.text}"))
        self.swatch.chosen.connect(
            lambda colour: self.asked.emit(f"colour {self.text} {name_text(colour) if colour else 'none'}")
        )
        self.setToolTip(TIP)

    def show_layer(self, layer: Layer, curves: int, current: bool) -> None:
        """Show the layer as it is now."""
        self._layer = layer
        self.eye.show_icon(
            "eye" if layer.visible else "eye-off", f"{'Hide' if layer.visible else 'Show'} layer {layer.name}"
        )
        self.bolt.show_icon(
            "lock" if layer.locked else "lock-open", f"{'Unlock' if layer.locked else 'Lock'} layer {layer.name}"
        )
        self.swatch.show_colour(layer.colour)
        self.count.setText(grouped(curves, 0))
        self.count.setToolTip(counted(curves, "curve"))
        self.name.setStyleSheet("font-weight: 600;" if current else "")
        self.name.setEnabled(layer.visible)
        self.set_chosen(current)
        self.setAccessibleName(f"Layer {layer.name}, {counted(curves, 'curve')}{', current' * current}")

    def begin_rename(self) -> None:
        """Type another name in the place of this one."""
        self.edit.setText(self._layer.name)
        self.name.hide()
        self.edit.show()
        self.edit.selectAll()
        self.edit.setFocus()

    def _rename(self) -> None:
        new, typed = self.edit.text().strip(), not self.edit.isHidden()
        self._end_rename()
        if typed and new and new != self._layer.name:
            self.asked.emit(f"rename layer {self.text} to {name_text(new)}")

    def _end_rename(self) -> None:
        self.edit.hide()
        self.name.show()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Enter takes the new name, Escape keeps the old one; all other keys are the line's, neither the row's nor the
        window's.
        """
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()
            return True
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            if event.key() == Qt.Key.Key_Escape:
                self._end_rename()
                self.setFocus()
                return True
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self._rename()
                return True
        return super().eventFilter(watched, event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Rename."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.begin_rename()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:  # noqa: N802 (Qt's name)
        """Offer what else there is to do, by mouse or by the menu key."""
        self.more.emit(event.globalPos())


class LayersSection(Themed, PanelSection):
    """Every layer of a document.

    Signals:
        asked(line): the user wants a line of the shape language carried out.
        removal(name, count): wants a layer away that has so many curves and notes on it.
    """

    asked = Signal(str)
    removal = Signal(str, int)

    def __init__(self, document: Document) -> None:
        super().__init__("Layers")
        self._document = document
        self._renaming = ""
        self.rows_by_name: dict[str, LayerRow] = {}
        self.add_button = IconButton("add", "Add a layer and draw on it")
        self.add_button.clicked.connect(self._add)
        self.head.addWidget(self.add_button)
        self._list = QWidget()
        self._column = v_box(self._list, spacing=0)
        self._column.addStretch(1)
        self.area = QScrollArea()
        self.area.setWidget(self._list)
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.rows.addWidget(self.area)

    def refresh(self) -> None:
        """Show the layers as they are now; rows stay as long as the names do."""
        part = self._document.part
        names = [layer.name for layer in part.layers]
        if set(names) != set(self.rows_by_name):
            self._build(part.layers)
        elif names != list(self.rows_by_name):
            self._sort(names)
        counts = Counter(e.layer for e in part.entities) + Counter(n.layer for n in part.notes)
        for layer in part.layers:
            self.rows_by_name[layer.name].show_layer(layer, counts[layer.name], layer.name == self._document.layer)
        if self._renaming in self.rows_by_name:
            row, self._renaming = self.rows_by_name[self._renaming], ""
            row.show()
            self.area.ensureWidgetVisible(row, 0, 0)
            row.begin_rename()

    def _build(self, layers: tuple[Layer, ...]) -> None:
        focused = next(
            (at for at, row in enumerate(self.rows_by_name.values()) if row.hasFocus() or row.edit.hasFocus()), None
        )
        for row in self.rows_by_name.values():
            self._column.removeWidget(row)
            put_away(row)
        self.rows_by_name = {layer.name: self._row(layer) for layer in layers}
        for at, row in enumerate(self.rows_by_name.values()):
            self._column.insertWidget(at, row)
            theme_children(row, self._theme)
        self.area.setFixedHeight(ROW_PX * min(len(layers), MOST_ROWS))
        if focused is not None:
            list(self.rows_by_name.values())[min(focused, len(layers) - 1)].setFocus()

    def _sort(self, names: list[str]) -> None:
        """Bring the rows into another order; a row that is being dragged stays under the mouse."""
        self.rows_by_name = {name: self.rows_by_name[name] for name in names}
        for at, row in enumerate(self.rows_by_name.values()):
            self._column.removeWidget(row)
            self._column.insertWidget(at, row)
        for before, row in pairwise(self.rows_by_name.values()):
            self.setTabOrder(before, row)

    def _row(self, layer: Layer) -> LayerRow:
        row, name = LayerRow(layer), layer.name
        row.asked.connect(self.asked)
        row.clicked.connect(lambda: self._make_current(name))
        row.removed.connect(lambda: self.remove(name))
        row.stepped.connect(lambda way: self._step(name, way))
        row.moved.connect(lambda way: self._move(name, way))
        row.more.connect(lambda place: self.menu(name).popup(place))
        return row

    def _make_current(self, name: str) -> None:
        if name != self._document.layer:
            self.asked.emit(f"layer {name_text(name)}")

    def _step(self, name: str, way: int) -> None:
        rows = list(self.rows_by_name)
        at = rows.index(name) + way
        if 0 <= at < len(rows):
            self.rows_by_name[rows[at]].setFocus()
            self.area.ensureWidgetVisible(self.rows_by_name[rows[at]], 0, 0)

    def _move(self, name: str, way: int) -> None:
        rows = list(self.rows_by_name)
        at = rows.index(name) + way
        if 0 <= at < len(rows):
            self.asked.emit(f"order layer {name_text(name)} {'after' if way > 0 else 'before'} {name_text(rows[at])}")

    def _add(self) -> None:
        known = set(self.rows_by_name)
        self._renaming = next(name for k in count(1) if (name := f"Layer {k}") not in known)
        name, colour = name_text(self._renaming), self._unused_colour()
        self.asked.emit(f"layer {name}" + (f'; colour {name} "{colour}"' if colour else ""))

    def _unused_colour(self) -> str:
        """Return the first colour that no layer has, or ""."""
        used = {layer.colour for layer in self._document.part.layers}
        return next((hue for hue in HUES if hue not in ("", *HARD_TO_SEE, *used)), "")

    def remove(self, name: str) -> None:
        """Take a layer away; who is asked first when something is on it listens to `removal`."""
        part = self._document.part
        on_it = sum(e.layer == name for e in part.entities) + sum(n.layer == name for n in part.notes)
        if on_it:
            self.removal.emit(name, on_it)
        else:
            self.asked.emit(f"remove layer {name_text(name)}")

    def menu(self, name: str) -> QMenu:
        """Return what can be done with a layer besides its row's own buttons."""
        text, menu = name_text(name), QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        chosen, alone = bool(self._document.selection), len(self.rows_by_name) == 1
        entries: tuple[tuple[str, bool, Callable[[], object]], ...] = (
            ("&Draw on it", name != self._document.layer, lambda: self._make_current(name)),
            ("Put the selection &here", chosen, lambda: self.asked.emit(f"set layer {text}")),
            ("&Select what is on it", True, lambda: self.asked.emit(f"select layer {text}")),
            ("Re&name", True, self.rows_by_name[name].begin_rename),
            ("Move &up", next(iter(self.rows_by_name)) != name, lambda: self._move(name, -1)),
            ("Move &down", list(self.rows_by_name)[-1] != name, lambda: self._move(name, 1)),
            ("&Remove", not alone, lambda: self.remove(name)),
        )
        for words, possible, act in entries:
            action = menu.addAction(words)
            action.setEnabled(possible)
            action.triggered.connect(lambda _=False, do=act: do())
        return menu
