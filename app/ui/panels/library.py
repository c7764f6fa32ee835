"""The tool library in the side panel: search, feeds for a material, a list, and what to do with the tool that is
chosen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QFrame, QLabel, QLineEdit, QPushButton, QScrollArea, QWidget

from ...formats.tools.library import ToolLibrary
from ...model.tool import FeedRow, Tool
from ..framework.boxes import h_box, put_away, v_box
from ..framework.fields import ROW_HEIGHT, ListField
from ..framework.figures import counted, grouped
from ..framework.icons import IconButton, IconLabel
from ..framework.labels import Elided, muted
from ..framework.section import ListRow, PanelSection, theme_children
from ..framework.themed import Themed
from .changes import for_material, row_for
from .tool_kinds import icon_of, listed_kinds, use_of

LEAST_ROWS, MOST_ROWS = 4, 14
ROW_PX = 28
NONE_FOUND = "No tool is called that; search for a diameter, such as 6, a kind, such as drill, or import more."


def matches(tool: Tool, text: str) -> bool:
    """Tell whether every word of a search stands in a tool's name, kind or remark, or is its diameter; numbers are
    whole ones there.
    """
    about = f"{tool.label} {tool.kind.title} {tool.remark}".casefold()
    size = f"{tool.diameter:g}"
    return all(
        word in (size, f"{size}mm") or word in (about.split() if word[0].isdigit() else about)
        for word in text.casefold().split()
    )


def materials(tools: tuple[Tool, ...]) -> tuple[str, ...]:
    """Return every material that some tool has feeds for, in the order of coming, each once."""
    names = {row.material.casefold(): row.material for tool in reversed(tools) for row in reversed(tool.feeds)}
    return tuple(dict.fromkeys(names[row.material.casefold()] for tool in tools for row in tool.feeds))


class LibrarySection(Themed, PanelSection):
    """Every tool of the libraries, kind by kind, the thinnest first.

    Signals:
        added(tool), put(tool): the user wants this tool, with the feeds of the chosen material, in the job as another
            one, or in the place of the job's chosen tool.
        imported(), exported(): wants to read tools from a file, or the job's written to one. closed().
    """

    added = Signal(object)
    put = Signal(object)
    imported = Signal()
    exported = Signal()
    closed = Signal()

    def __init__(self) -> None:
        super().__init__("Tool library")
        close = IconButton("cancel", "Close the library (Esc)")
        close.clicked.connect(self.closed)
        self.head.addWidget(close)
        self.search, self.material = QLineEdit(), ListField("Feeds for", [])
        self.details, self.none = QLabel(), muted(NONE_FOUND)
        self.add_button, self.put_button = QPushButton("Add to job"), QPushButton("Replace")
        self._libraries: tuple[ToolLibrary, ...] = ()
        self._rows: list[tuple[Tool, ListRow]] = []
        self._chosen: Tool | None = None
        self._material, self._room = "", LEAST_ROWS
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        self.search.setPlaceholderText("Search by name, kind or diameter")
        self.search.setAccessibleName("Search the tool library")
        self.search.setFixedHeight(ROW_HEIGHT)
        self.search.setClearButtonEnabled(False)
        self.list_ = QWidget()
        self._column = v_box(self.list_, spacing=0)
        self._column.addStretch(1)
        self.area = QScrollArea()
        self.area.setWidget(self.list_)
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.details.setWordWrap(True)
        self.none.setWordWrap(True)
        self.add_indented(self.search)
        self.add_indented(self.material)
        self.rows.addSpacing(4)
        self.rows.addWidget(self.area)
        self.rows.addSpacing(4)
        self.add_indented(self.details)
        self.rows.addSpacing(4)
        self.add_indented(side_by_side(self.add_button, self.put_button))
        self.add_indented(self.none)
        self.rows.addSpacing(8)
        self.import_button, self.export_button = _link("Import tools…"), _link("Export job tools…")
        self.add_indented(side_by_side(self.import_button, self.export_button))

    def _connect(self) -> None:
        self.search.textEdited.connect(lambda _: self._fill())
        self.search.installEventFilter(self)
        self.material.chosen.connect(self._choose_material)
        self.add_button.clicked.connect(lambda: self._send(self.added.emit))
        self.put_button.clicked.connect(lambda: self._send(self.put.emit))
        self.import_button.clicked.connect(self.imported)
        self.export_button.clicked.connect(self.exported)

    def show_libraries(self, libraries: Mapping[str, ToolLibrary]) -> None:
        """Show the tools of libraries, by their files' names."""
        self._libraries = tuple(libraries.values())
        names = materials(tuple(tool for library in self._libraries for tool in library.tools))
        self._material = self._material if self._material in names else (names[0] if names else "")
        self.material.set_choices([(name, name.capitalize()) for name in names])
        self.material.show_value(self._material)
        self.material.setVisible(bool(names))
        self._fill()

    def fit_into(self, height: int) -> None:
        """Show as many rows as there is room for: `height` px are free when there is no list."""
        self._room = max(LEAST_ROWS, min(height // ROW_PX, MOST_ROWS))
        self._set_height()

    def _set_height(self) -> None:
        self.area.setFixedHeight(ROW_PX * max(1, min(len(self._rows), self._room)))

    def show_place(self, number: int) -> None:
        """Offer to replace the job's tool with this T number; 0 = none is chosen."""
        self.put_button.setText(f"Replace T{number}")
        self.put_button.setVisible(number > 0)

    @property
    def shown(self) -> tuple[Tool, ...]:
        """The tools in the list."""
        return tuple(tool for tool, _ in self._rows)

    def choose(self, tool: Tool | None) -> None:
        """Show what there is to know of a tool of the list."""
        self._chosen = tool
        for other, row in self._rows:
            row.set_chosen(other is tool)
        self.reveal()
        self.details.setText(
            "" if tool is None else about_tool(for_material(tool, self._material), row_for(tool, self._material))
        )
        self.details.setVisible(tool is not None)
        self.add_button.setEnabled(tool is not None)
        self.put_button.setEnabled(tool is not None)

    def reveal(self) -> None:
        """Bring the chosen row into sight."""
        for tool, row in self._rows:
            if tool is self._chosen:
                self.area.ensureWidgetVisible(row, 0, 0)

    def _choose_material(self, name: object) -> None:
        self._material = str(name)
        self._fill()

    def _fill(self) -> None:
        """List what the search finds."""
        for _, row in self._rows:
            self._column.removeWidget(row)
            put_away(row)
        found = [tool for library in self._libraries for tool in library.tools if matches(tool, self.search.text())]
        order = listed_kinds()
        found.sort(key=lambda tool: (order.index(tool.kind), tool.diameter))
        self._rows = [(tool, self._row(tool)) for tool in found]
        for at, (_, row) in enumerate(self._rows):
            self._column.insertWidget(at, row)
        self.area.setVisible(bool(found))
        self._set_height()
        self.none.setVisible(not found)
        kept = next((tool for tool in found if tool == self._chosen), None)
        self.choose(kept or (found[0] if found else None))

    def _row(self, tool: Tool) -> ListRow:
        shown = for_material(tool, self._material)
        row = ListRow(
            IconLabel(icon_of(tool.kind)),
            Elided(tool.label),
            muted(f"{grouped(shown.spindle_speed, 0)} rpm"),
            stretch_after=1,
        )
        row.setToolTip(f"{tool.kind.title}. Enter: add to the job")
        row.clicked.connect(lambda: self.choose(tool))
        row.stepped.connect(lambda way: self._step(tool, way))
        row.installEventFilter(self)
        theme_children(row, self._theme)
        return row

    def _step(self, tool: Tool, way: int) -> None:
        at = self.shown.index(tool) + way
        if 0 <= at < len(self._rows):
            self.choose(self._rows[at][0])
            self._rows[at][1].setFocus(Qt.FocusReason.OtherFocusReason)
        elif at < 0:
            self.search.setFocus(Qt.FocusReason.OtherFocusReason)

    def _send(self, tell: Callable[[object], None]) -> None:
        if self._chosen is not None:
            tell(for_material(self._chosen, self._material))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Enter and a double click add, Escape closes, Down goes from the search into the list."""
        if event.type() == QEvent.Type.MouseButtonDblClick and watched is not self.search:
            self._send(self.added.emit)
            return True
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self._send(self.added.emit)
                return True
            if event.key() == Qt.Key.Key_Escape:
                self.closed.emit()
                return True
            if event.key() == Qt.Key.Key_Down and watched is self.search and self._rows:
                row = next((row for tool, row in self._rows if tool is self._chosen), self._rows[0][1])
                row.setFocus(Qt.FocusReason.OtherFocusReason)
                return True
        return super().eventFilter(watched, event)


def about_tool(tool: Tool, row: FeedRow | None) -> str:
    """Return what there is to know of a tool: what it is, how long, how fast; and what for, where that is not
    everything.
    """
    shape = [f"{math.degrees(tool.tip_angle):g}°"] * bool(tool.tip_angle)
    shape += [
        f"{name} {value:g} mm" for name, value in (("corner", tool.corner_radius), ("tip", tool.tip_diameter)) if value
    ]
    lengths = [
        f"{value:g} mm {name}"
        for name, value in (("of cut", tool.flute_length), ("overall", tool.overall_length))
        if value
    ]
    feeds = f"F {grouped(tool.feed_rate, 0)}, down {grouped(tool.plunge_rate, 0)} mm/min"
    chip = f", {row.feed_per_tooth:g} a tooth" if row is not None else ""
    lines = [
        ", ".join([tool.kind.title, counted(tool.flutes, "flute"), *shape]),
        ", ".join(lengths),
        feeds + chip,
        use_of(tool.kind),
    ]
    return "\n".join(line for line in lines if line)


def _link(text: str) -> QPushButton:
    made = QPushButton(text)
    made.setProperty("role", "link")
    made.setCursor(Qt.CursorShape.PointingHandCursor)
    return made


def side_by_side(*widgets: QWidget) -> QWidget:
    """Return widgets in a row, from the left."""
    made = QWidget()
    row = h_box(made, spacing=8)
    for widget in widgets:
        row.addWidget(widget)
    row.addStretch(1)
    return made
