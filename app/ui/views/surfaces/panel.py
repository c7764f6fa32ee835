"""Beside a scene: its surfaces, passes and tools in lists, and what can be set of the one that is chosen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QLabel, QMenu, QWidget

from ....formats.plot.surface_plot import colour_of, line_of
from ....formats.scene.edit import with_table_moved, with_value, without_table
from ....model.scene import LineType, Scene
from ...framework.boxes import put_away, v_box
from ...framework.dropping import drop
from ...framework.fields import NumberField
from ...framework.figures import TIMES, grouped
from ...framework.icons import IconButton, IconLabel
from ...framework.labels import Elided, muted
from ...framework.samples import Switch
from ...framework.section import ListRow, PanelSection, hairline, theme_children
from ...framework.side_scroll import SideScroll
from ...framework.theme import Theme
from ...framework.themed import Themed
from ...panels.tool_kinds import icon_of
from .field_widgets import Field, field_of
from .new_parts import FROM_CURVES, KINDS
from .scene_fields import (
    SHAPES,
    Choices,
    SceneField,
    SceneFieldKind,
    passes_fields,
    scene_fields,
    surface_fields,
    tool_fields,
)

Subject = tuple[str, int]
"""What properties are shown of: "surface", "passes" or "tool" and its number from 0; or the scene itself, ("scene",
0).
"""
THE_SCENE: Subject = ("scene", 0)
_DASHES: Mapping[LineType, list[float]] = {LineType.SOLID: [], LineType.DOTTED: [1, 2], LineType.CHAIN: [6, 2, 1, 2]}


class SurfaceSample(QWidget):
    """A piece of the line that a surface's paths are drawn with."""

    def __init__(self, colour: str, line: LineType, shown: bool) -> None:
        super().__init__()
        self._colour, self._line, self._shown = colour, line, shown
        self.setFixedSize(24, 16)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the line, faint where the surface is not shown."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colour = QColor(self._colour)
        colour.setAlphaF(1.0 if self._shown else 0.35)
        pen = QPen(colour, 2.5)
        if _DASHES[self._line]:
            pen.setDashPattern([length * 0.8 for length in _DASHES[self._line]])
        painter.setPen(pen)
        painter.drawLine(1, 8, 23, 8)


class PartListSection(PanelSection):
    """A heading with a button to add, and rows."""

    def __init__(self, title: str, tip: str) -> None:
        super().__init__(title)
        self.add_button = IconButton("add", tip)
        self.head.addWidget(self.add_button)
        self.shown: list[ListRow] = []

    def fill(self, rows: Sequence[ListRow], theme: Theme) -> None:
        """Show other rows."""
        for row in self.shown:
            self.rows.removeWidget(row)
            put_away(row)
        self.shown = list(rows)
        for row in rows:
            self.rows.addWidget(row)
            theme_children(row, theme)


class PartPropertiesSection(Themed, PanelSection):
    """Fields for what is asked of the subject that is chosen; they stay the same widgets while only values change.

    Signals:
        changed(ask, value). removed(): the user wants the subject gone. text_requested(): wants to see it in the text.
    """

    changed = Signal(object, object)
    removed = Signal()
    text_requested = Signal()

    def __init__(self) -> None:
        super().__init__("Properties")
        self.text_button = IconButton("text", "Show it in the text")
        self.remove_button = IconButton("remove", "Remove it (Del in the list)")
        for button, signal in ((self.text_button, self.text_requested), (self.remove_button, self.removed)):
            button.clicked.connect(signal)
            self.head.addWidget(button)
        self.fields: dict[str, Field] = {}
        self._asks: tuple[SceneField, ...] = ()
        self._body = QWidget()
        self._column = v_box(self._body, spacing=0)
        self.add_indented(self._body)

    def show_asks(self, title: str, asks: tuple[SceneField, ...], removable: bool) -> None:
        """Show what is asked, with the values that are."""
        self.title.setText(title)
        self.remove_button.setVisible(removable)
        if [ask.form for ask in asks] != [ask.form for ask in self._asks]:
            self._build(asks)
        self._asks = asks
        for ask in asks:
            field = self.fields.get(ask.name)
            if field is not None and not isinstance(field, QLabel):
                field.show_value(ask.value)

    def _build(self, asks: tuple[SceneField, ...]) -> None:
        for field in self.fields.values():
            self._column.removeWidget(field)
            put_away(field)
        self.fields = {}
        for at, ask in enumerate(asks):
            field = field_of(ask)
            self.fields[ask.name] = field
            self._column.addWidget(field)
            field.show()
            if isinstance(field, NumberField):
                field.committed.connect(partial(self._tell, at))
            elif not isinstance(field, QLabel):
                field.chosen.connect(partial(self._tell, at))
        theme_children(self._body, self._theme)
        self._body.updateGeometry()

    def _tell(self, at: int, value: object) -> None:
        if value != self._asks[at].value:
            self.changed.emit(self._asks[at], value)


class ScenePanel(Themed, SideScroll):
    """Lists and properties of a scene.

    Signals:
        changed(change): a function from the text to another one. surface_requested(kind), curves_requested(kind),
        file_requested(), passes_requested(), tool_requested(): one more. text_requested(name, number): of the subject,
        as in the text.

    Attributes:
        subject: whose properties are shown. awaited: to be chosen as soon as the scene has it.
    """

    changed = Signal(object)
    surface_requested = Signal(str)
    curves_requested = Signal(str)
    file_requested = Signal()
    passes_requested = Signal()
    tool_requested = Signal()
    text_requested = Signal(str, int)

    def __init__(self) -> None:
        super().__init__((0, 4, 0, 8))
        self.surfaces, self.passes = (
            PartListSection("Surfaces", "Add a surface"),
            PartListSection("Passes", "Add passes"),
        )
        self.tools, self.scene, self.form = (
            PartListSection("Tools", "Add a tool"),
            PanelSection("Scene"),
            PartPropertiesSection(),
        )
        self.stock, self.control = Elided(), Elided()
        self.subject: Subject = THE_SCENE
        self._shown: Scene | None = None
        self._block: tuple[float, ...] = (0.0,) * 6
        self._posts: Choices = ()
        self._rows: dict[Subject, ListRow] = {}
        self.awaited: Subject | None = None
        self.menu = QMenu(self.surfaces.add_button)
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        stock = ListRow(muted("Stock"), self.stock, stretch_after=1)
        control = ListRow(muted("Control"), self.control, stretch_after=1)
        for row in (stock, control):
            row.setFixedHeight(24)
            row.layout().itemAt(0).widget().setFixedWidth(56)  # type: ignore[union-attr]
            row.clicked.connect(lambda: self.choose(THE_SCENE))
            self.scene.rows.addWidget(row)
        self._rows[THE_SCENE] = stock
        for kind in KINDS:
            self.menu.addAction(SHAPES[kind], partial(self.surface_requested.emit, kind))
        self.menu.addSeparator()
        drawn = self.menu.addMenu("From selected curves of the drawing")
        for kind in FROM_CURVES:
            drawn.addAction(SHAPES[kind], partial(self.curves_requested.emit, kind))
        self.menu.addAction("From a file…", self.file_requested.emit)
        column = self.column
        for section in (self.scene, self.surfaces, self.passes, self.tools):
            column.addWidget(section)
        column.addWidget(hairline())
        column.addWidget(self.form)
        column.addStretch(1)

    def _connect(self) -> None:
        add = self.surfaces.add_button
        add.clicked.connect(lambda: drop(self.menu, add))
        self.passes.add_button.clicked.connect(self.passes_requested)
        self.tools.add_button.clicked.connect(self.tool_requested)
        self.form.changed.connect(self._on_changed)
        self.form.removed.connect(lambda: self._remove(self.subject))
        self.form.text_requested.connect(lambda: self.text_requested.emit(*self.subject))

    def show_posts(self, posts: Choices) -> None:
        """Offer controls, by their names."""
        self._posts = posts

    def show_scene(self, scene: Scene) -> None:
        """Show another scene, or another state of it."""
        before, self._shown = self._shown, scene
        if before is None or (before.surfaces, before.passes, before.tools) != (
            scene.surfaces,
            scene.passes,
            scene.tools,
        ):
            self._fill(scene)
        self._show_stock(scene)
        self.control.setText(dict(self._posts).get(scene.post, scene.post))
        if self.awaited in self._rows:
            self.subject, self.awaited = self.awaited, None
        if self.subject not in self._rows:
            self.subject = THE_SCENE
        self.choose(self.subject)

    def show_block(self, block: tuple[float, ...]) -> None:
        """Show the stock as it was computed, x0, y0, z0, x1, y1, z1 mm."""
        self._block = block
        if self._shown is not None:
            self._show_stock(self._shown)
            self.choose(self.subject)

    def choose(self, subject: Subject) -> None:
        """Show the properties of a subject."""
        scene, (name, number) = self._shown, subject
        if scene is None or subject not in self._rows:
            return
        self.subject = subject
        for key, row in self._rows.items():
            row.set_chosen(key == subject)
        match name:
            case "surface":
                title, asks = f"Surface {number + 1}", surface_fields(scene.surfaces[number])
            case "passes":
                title, asks = f"Passes {number + 1}", passes_fields(scene.passes[number], scene)
            case "tool":
                title, asks = f"T{scene.tools[number].number}", tool_fields(scene.tools[number])
            case _:
                title, asks = "Scene", scene_fields(scene, self._block, self._posts)
        self.form.show_asks(title, asks, subject != THE_SCENE)

    def _show_stock(self, scene: Scene) -> None:
        box = scene.stock.box or self._block
        if box == (0.0,) * 6:
            self.stock.setText("")  # known once the scene has been looked at
            return
        size = f" {TIMES} ".join(grouped(high - low) for low, high in zip(box[:3], box[3:], strict=True))
        self.stock.setText(f"{size} mm")

    def _fill(self, scene: Scene) -> None:
        self._rows = {THE_SCENE: self._rows[THE_SCENE]}
        surfaces, passes, tools = [], [], []
        for number, surface in enumerate(scene.surfaces):
            line = line_of(number) if surface.line is LineType.AUTO else surface.line
            sample = SurfaceSample(surface.colour or colour_of(number), line, surface.visible)
            surfaces.append(
                self._row(
                    ("surface", number),
                    surface.enabled,
                    sample,
                    Elided(surface.name),
                    muted(SHAPES.get(surface.shape.kind, surface.shape.kind)),
                )
            )
        for number, each in enumerate(scene.passes):
            apart = f"pitch {each.pitch:g}" if each.pitch is not None else f"scallop {each.scallop:g}"
            passes.append(
                self._row(
                    ("passes", number),
                    each.enabled,
                    QLabel(f"T{each.tool}"),
                    Elided(each.name or "Passes"),
                    muted(f"{math_degrees(each.angle)}°, {apart}"),
                )
            )
        for number, tool in enumerate(scene.tools):
            row = ListRow(IconLabel(icon_of(tool.kind)), QLabel(f"T{tool.number}"), Elided(tool.label), stretch_after=2)
            tools.append(self._known(("tool", number), row))
        for section, rows in ((self.surfaces, surfaces), (self.passes, passes), (self.tools, tools)):
            section.fill(rows, self._theme)

    def _row(self, subject: Subject, on: bool, *widgets: QWidget) -> ListRow:
        switch = Switch("On or off")
        switch.setChecked(on)
        switch.setToolTip("Machined" if subject[0] == "surface" else "Computed")
        switch.clicked.connect(lambda now: self._set(subject, {("enabled",): now}))
        row = ListRow(switch, *widgets, stretch_after=-1, wide=len(widgets) - 1)
        row.setToolTip("Drag, or Alt+Up and Alt+Down: earlier or later; Del: remove")
        row.moved.connect(lambda way: self._move(subject, way))
        return self._known(subject, row)

    def _known(self, subject: Subject, row: ListRow) -> ListRow:
        self._rows[subject] = row
        row.clicked.connect(lambda: self.choose(subject))
        row.removed.connect(lambda: self._remove(subject))
        row.stepped.connect(lambda way: self._step(subject, way))
        return row

    def _step(self, subject: Subject, way: int) -> None:
        keys = list(self._rows)
        at = keys.index(subject) + way
        if 0 <= at < len(keys):
            self._rows[keys[at]].setFocus()
            self.choose(keys[at])

    def _on_changed(self, ask: SceneField, value: object) -> None:
        if ask.kind is SceneFieldKind.COLOUR or not (
            isinstance(value, str) and value == "" and ask.kind is SceneFieldKind.WORDS and ask.name != "Name"
        ):
            self._set(self.subject, ask.changes(value))
            if self.subject[0] == "tool" and ask.key == ("number",):
                self._renumber(int(ask.value), value)

    def _renumber(self, before: int, number: object) -> None:
        """Have the passes of a tool go on with it under its new number."""
        for at, passes in enumerate(self._shown.passes if self._shown is not None else ()):
            if passes.tool == before:
                self._set(("passes", at), {("tool",): number})

    def _set(self, subject: Subject, values: Mapping[tuple[str | int, ...], object]) -> None:
        place: tuple[str | int, ...] = () if subject == THE_SCENE else subject

        def change(text: str) -> str:
            for key, value in values.items():
                text = with_value(text, (*place, *key), value.value if isinstance(value, Enum) else value)
            return text

        self.changed.emit(change)

    def _move(self, subject: Subject, way: int) -> None:
        name, number = subject
        to = (name, number + way)
        if to in self._rows:
            self.subject = to
            self.changed.emit(lambda text: with_table_moved(text, name, number, way))

    def _remove(self, subject: Subject) -> None:
        if subject != THE_SCENE:
            self.changed.emit(lambda text: without_table(text, *subject))


def math_degrees(angle: float) -> str:
    """Return an angle in degrees, as short as it is."""
    return f"{angle * 57.29577951308232:.2f}".rstrip("0").rstrip(".")
