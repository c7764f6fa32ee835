"""How the drawing was read from its file: units, layout, density, place, what is left out; a change reads it again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QMenu, QPushButton, QSizePolicy, QWidget

from ...drafting.document import Document
from ...formats.reading_question import NO_CHOICE, UNIT_WORDS, FileContents
from ...model.part import Units
from ...model.read_options import LEAST_PER_INCH, MOST_PER_INCH
from ...model.reading import AS_THE_FILE_SAYS, ReadingOptions
from ..framework.boxes import h_box
from ..framework.fields import ROW_HEIGHT, ListField, NumberField, NumberSpec, field_name, reason_label
from ..framework.form import SwitchField
from ..framework.labels import Elided, show_words
from ..framework.section import PanelSection

MODEL_SPACE, NOTHING, ALL_SHOWN = "Model space", "none", "all that are shown"
PER_INCH = NumberSpec(
    "Per inch",
    "",
    LEAST_PER_INCH,
    MOST_PER_INCH,
    3,
    False,
    "Units of the page to the inch: 96 by CSS, 90 of Inkscape before 0.92, 72 of Illustrator.",
    "auto",
)


class ChecksField(QWidget):
    """Some of many names, chosen in a menu.

    Signals:
        chosen(names): a tuple of those that are checked.
    """

    chosen = Signal(object)

    def __init__(self, name: str, tip: str, empty: str = NOTHING) -> None:
        """Make a field; `empty` is shown while none is checked."""
        super().__init__()
        self._empty = empty
        self._names: tuple[str, ...] = ()
        self._on: tuple[str, ...] = ()
        self.button, self.menu, self.text = QPushButton(), QMenu(self), Elided()
        self.button.setProperty("role", "drop")
        self.button.setFixedHeight(ROW_HEIGHT)
        self.button.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.button.setMenu(self.menu)
        self.button.setAccessibleName(name)
        self.setToolTip(tip)
        inside = h_box(self.button, (6, 0, 20, 0))
        inside.addWidget(self.text)
        self.text.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        row = h_box(self, (0, 1, 0, 1), 8)
        row.addWidget(field_name(name, self.button))
        row.addWidget(self.button, 1)

    def show_names(self, names: tuple[str, ...], on: tuple[str, ...]) -> None:
        """Show which of some names are checked; those that are, are offered even where they are not among them."""
        self._names, self._on = tuple(dict.fromkeys((*names, *on))), on
        self.menu.clear()
        known = {each.casefold() for each in on}
        for name in self._names:
            action = self.menu.addAction(name.replace("&", "&&"))
            action.setCheckable(True)
            action.setChecked(name.casefold() in known)
            action.triggered.connect(lambda checked, each=name: self._choose(each, checked))
        self.text.setText(", ".join(on) or self._empty)
        self.button.setAccessibleDescription(self.text.text())
        self.button.setEnabled(bool(self._names))

    def _choose(self, name: str, checked: bool) -> None:
        kept = tuple(each for each in self._on if each.casefold() != name.casefold())
        self.chosen.emit((*kept, name) if checked else kept)


class ReadingSection(PanelSection):
    """Shows the reading of a document's source; there is nothing to see of one that was drawn here.

    Signals:
        wanted(reading): the user wants the drawing read in this way. again(): wants it read again as its file is now.
        looked(): what the file holds is not known, and somebody looks at this section.
    """

    wanted = Signal(ReadingOptions)
    again = Signal()
    looked = Signal()

    def __init__(self, document: Document) -> None:
        super().__init__("Reading")
        self._document = document
        self.contents: FileContents | None = None
        self.file, self.trouble = Elided(role="muted"), reason_label()
        self.file.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.head.addWidget(self.file, 4)
        self.head.addSpacing(4)
        self.units = ListField("Units", [])
        self.layout_ = ListField("Layout", [("", MODEL_SPACE)])
        self.per_inch = NumberField(PER_INCH)
        self.to_zero = SwitchField("To zero", "The drawing is moved so that its lower left corner is zero.")
        self.only = ChecksField("Only layers", "Curves on these layers alone are read, frozen ones too.", ALL_SHOWN)
        self.layers = ChecksField("Skip layers", "Curves on these layers are left out, such as centre lines.")
        self.types = ChecksField("Skip types", "Entities of these types are left out, such as TEXT or HATCH.")
        self.read_again = QPushButton("Read again")
        self.read_again.setToolTip("Read the file as it is now; Undo brings the drawing of now back")
        self._fields = (self.units, self.layout_, self.per_inch, self.to_zero, self.only, self.layers, self.types)
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        for widget in (*self._fields, self.trouble):
            self.add_indented(widget)
        foot = QWidget()
        row = h_box(foot, (0, 4, 0, 0))
        row.addWidget(self.read_again)
        row.addStretch(1)
        self.add_indented(foot)

    def _connect(self) -> None:
        self.units.chosen.connect(
            lambda units: self._want(
                self._reading.in_units(units) if units else self._reading.with_pixels(self._reading.how.pixels_per_inch)
            )
        )
        self.layout_.chosen.connect(lambda name: self._want_how(layout=name))
        self.per_inch.committed.connect(lambda value: self._want(self._reading.with_pixels(value)))
        self.to_zero.chosen.connect(lambda on: self._want_how(to_zero=on))
        self.only.chosen.connect(lambda names: self._want(replace(self._reading, layers=names)))
        self.layers.chosen.connect(lambda names: self._want_how(without_layers=names))
        self.types.chosen.connect(lambda names: self._want_how(without_types=names))
        self.read_again.clicked.connect(lambda: self.again.emit())

    @property
    def _reading(self) -> ReadingOptions:
        source = self._document.state.source
        return source.reading if source is not None else AS_THE_FILE_SAYS

    def _want_how(self, **values: object) -> None:
        reading = self._reading
        self._want(replace(reading, how=replace(reading.how, **values)))  # type: ignore[arg-type]  # each by its name

    def _want(self, reading: ReadingOptions) -> None:
        if reading != self._reading:
            self.wanted.emit(reading)

    def show_contents(self, contents: FileContents | None, trouble: str = "") -> None:
        """Take what the file holds, None = not known; or why it cannot be read."""
        self.contents = contents
        show_words(self.trouble, trouble)
        self.refresh()

    def refresh(self) -> None:
        """Show how the drawing was read."""
        source = self._document.state.source
        self.setVisible(source is not None)
        if source is None:
            return
        path, reading, contents = Path(source.path), source.reading, self.contents or NO_CHOICE
        drawn, paper = path.suffix.lower() == ".dxf", dict(contents.layouts)
        self.file.setText(path.name)
        self.file.setToolTip(str(path))
        self.units.set_choices([(None, _own_units(drawn, contents)), *((units, UNIT_WORDS[units]) for units in Units)])
        self.units.show_value(reading.units)
        layout = next((name for name in paper if name.casefold() == reading.how.layout.casefold()), reading.how.layout)
        self.layout_.set_choices(
            [("", MODEL_SPACE), *((name, name) for name in dict.fromkeys((*paper, layout)) if name)]
        )
        self.layout_.show_value(layout)
        self.layout_.setVisible(drawn)
        note = "" if reading.how.pixels_per_inch or contents.per_inch is None else f"{contents.per_inch:g}"
        self.per_inch.show_value(reading.how.pixels_per_inch, note)
        self.per_inch.setVisible(
            not drawn and (contents.per_inch is not None or reading.how.pixels_per_inch is not None)
        )
        self.to_zero.show_value(reading.how.to_zero)
        self.only.show_names(contents.layers, reading.layers)
        self.layers.show_names(contents.layers, reading.how.without_layers)
        self.types.show_names(contents.types, reading.how.without_types)
        self.types.setVisible(drawn)
        for field in self._fields:
            field.setEnabled(not self.trouble.text())
        self._look()

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Ask what the file holds, where that is not known."""
        super().showEvent(event)
        self._look()

    def _look(self) -> None:
        if (
            self.contents is None
            and not self.trouble.text()
            and self.isVisible()
            and self._document.state.source is not None
        ):
            self.looked.emit()


def _own_units(drawn: bool, contents: FileContents) -> str:
    """Return the words for the units that a drawing has of its own; `drawn`: it is a DXF."""
    if contents is NO_CHOICE:
        return "As in the file"
    if contents.units is not None:
        return f"{UNIT_WORDS[contents.units]}, as in the file"
    return f"{UNIT_WORDS[Units.MM]}, assumed" if drawn else "pixels, assumed"
