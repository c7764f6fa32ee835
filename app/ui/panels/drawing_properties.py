"""Properties of what is selected, with numbers that can be changed; of the whole drawing while nothing is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from ...drafting.commands.properties import Property, PropertyKind, Value, kind_name, properties_of
from ...drafting.curves.area import enclosed_area
from ...drafting.curves.shapes import curve_length
from ...drafting.document import Document
from ...drafting.expressions.evaluate import length_of, number_of
from ...drafting.expressions.grammar import read_value
from ...drafting.expressions.units import ANGLE_UNITS, LENGTH_UNITS
from ...drafting.expressions.words import ids_text, name_text, number_text, point_text
from ...geometry.dimension_lines import figure
from ...geometry.sample import Box
from ...model.curves import Arc, Circle, Curve, Ellipse, Spline
from ...model.notes import Dimension, Shape
from ...model.part import Units
from ..framework.boxes import put_away, v_box
from ..framework.catalogue import tr
from ..framework.display_unit import clean, display_unit_name, display_unit_size
from ..framework.fields import ListField, NumberField, NumberSpec
from ..framework.figures import TIMES, counted, grouped
from ..framework.labels import muted
from ..framework.section import EDGE, PanelSection
from .drawing_fields import COORDINATE_WIDTH, Figure, PointField
from .totals import TotalsCalculator

VARIOUS = "various"
"""What a field shows while what is selected differs in it."""

TOTAL, EXTENT, KINDS = "Total length", "Extent", "Kinds"
_NOT_SHOWN = ("middle",)
_FIRST_KINDS = 3
_FARTHEST = 1e7
_MOST_ROUND = 2_000  # curves that an area is looked for among
_SAME = 5e-4  # numbers that are shown alike
_UNITS = {Units.MM: "mm", Units.INCH: "inch", Units.CM: "cm", Units.M: "m", Units.FOOT: "foot", Units.MICRON: "µm"}


@dataclass(frozen=True, slots=True)
class SelectedEntities:
    """What is selected: numbers, shapes and layers, curves first."""

    ids: tuple[int, ...]
    shapes: tuple[Curve | Shape, ...]
    layers: tuple[str, ...]

    @staticmethod
    def of(document: Document) -> SelectedEntities:
        """Return what is selected in a document."""
        part, chosen = document.part, document.selection
        items = [(e.id, e.curve, e.layer) for e in part.entities if e.id in chosen] if chosen else []
        notes = [(n.id, n.shape, n.layer) for n in part.notes if n.id in chosen]
        ids, shapes, layers = zip(*items, *notes, strict=True) if items or notes else ((), (), ())
        return SelectedEntities(tuple(ids), tuple(shapes), tuple(dict.fromkeys(layers)))

    @property
    def properties(self) -> Mapping[str, Property]:
        """What can be set of all of them: of one everything, of several what they have in common, but no places."""
        tables = {type(shape): properties_of(shape) for shape in self.shapes}
        if not tables:
            return {}
        first, *others = tables.values()
        common = {
            word: each
            for word, each in first.items()
            if all(word in table for table in others) and word not in _NOT_SHOWN
        }
        return (
            common
            if len(self.ids) == 1
            else {word: each for word, each in common.items() if each.kind is not PropertyKind.POINT}
        )

    def value(self, word: str) -> Value | None:
        """Return the value of a property, None where they differ in it by what is seen."""
        values = [properties_of(shape)[word].read(shape) for shape in self.shapes]
        if len(values) > 1:
            numbers = [value for value in values if isinstance(value, float)]
            return numbers[0] if max(numbers) - min(numbers) < _SAME else None
        return values[0]


class PropertiesSection(PanelSection):
    """Shows a document's selection.

    Signals:
        asked(line, field): the user wants a line of the shape language carried out; `field` marks what is wrong with
        it.
    """

    asked = Signal(str, object)

    def __init__(self, document: Document) -> None:
        super().__init__("Properties")
        self._document = document
        self.remark = muted()
        self.head.addWidget(self.remark)
        self.head.addSpacing(4)
        self.layer = ListField("Layer", [])
        self.layer.box.setPlaceholderText(tr(VARIOUS))
        self.layer.chosen.connect(self._ask_layer)
        self.fields: dict[str, NumberField | PointField] = {}
        self.figures: dict[str, Figure] = {}
        self._shown: object = None
        self._selected = SelectedEntities((), (), ())
        self._adding = TotalsCalculator()
        self._adding.done.connect(self._show_sum)
        self.add_indented(self.layer)
        self._body = QWidget()
        self._column = v_box(self._body, (EDGE, 0, EDGE, 0), 0)
        self.rows.addWidget(self._body)

    def _ask_layer(self, name: object) -> None:
        """Put what is selected on a layer, unless all of it lies there."""
        if self._selected.layers != (name,):
            self.asked.emit(f"set {self._numbers()}layer {name_text(str(name))}", None)

    def refresh(self, extent: Box | None) -> None:
        """Show what is selected as it is now; `extent` is that of the whole drawing."""
        self._selected = selected = SelectedEntities.of(self._document)
        properties = selected.properties
        figures = _figures(selected) if selected.ids else _whole(self._document, extent)
        shown = (tuple(properties.items()), tuple(figures), len(selected.ids) > 1)
        if shown != self._shown:
            self._shown = shown
            self._build(properties, tuple(figures))
        self.remark.setText(_remark(selected))
        self.layer.setVisible(bool(selected.ids))
        self.layer.set_choices([(layer.name, layer.name) for layer in self._document.part.layers])
        self.layer.show_value(selected.layers[0] if len(selected.layers) == 1 else None)
        for word, field in self.fields.items():
            field.show_value(selected.value(word))  # type: ignore[arg-type]
        for name, text in figures.items():
            if text:
                self.figures[name].show_value(text)
        several = len(selected.ids) > 1
        self._adding.start(
            {n: s for n, s in zip(selected.ids, selected.shapes, strict=True) if isinstance(s, Curve)}
            if several
            else {}
        )

    def _show_sum(self, length: float, box: Box) -> None:
        self.figures[TOTAL].show_value(_length(length))
        self.figures[EXTENT].show_value(_size(box))

    def _build(self, properties: Mapping[str, Property], figures: tuple[str, ...]) -> None:
        for old in (*self.fields.values(), *self.figures.values()):
            self._column.removeWidget(old)
            put_away(old)
        self.fields = {word: self._field(word, each) for word, each in properties.items()}
        self.figures = {name: Figure(name, wraps=name == KINDS) for name in figures}
        for new in (*self.fields.values(), *self.figures.values()):
            self._column.addWidget(new)

    def _field(self, word: str, known: Property) -> NumberField | PointField:
        several = len(self._selected.ids) > 1
        angle = known.kind is PropertyKind.ANGLE
        spec = NumberSpec(
            word.capitalize(),
            "°" if angle else "mm",
            -_FARTHEST,
            _FARTHEST,
            2 if angle else 3,
            tip=known.about,
            auto=VARIOUS if several else "",
        )
        read = partial(self._read, ANGLE_UNITS if angle else LENGTH_UNITS)
        made = PointField(spec, read) if known.kind is PropertyKind.POINT else NumberField(spec, read)
        if isinstance(made, NumberField):
            made.edit.setFixedWidth(COORDINATE_WIDTH)
        made.committed.connect(lambda value: self._ask(word, value, made))
        return made

    def _ask(self, word: str, value: Value | None, field: NumberField | PointField) -> None:
        if value is not None:
            text = point_text(value) if isinstance(value, tuple) else number_text(value)
            self.asked.emit(f"set {self._numbers()}{word} {text}", field)

    def _numbers(self) -> str:
        """Return the number of the one that is selected; several are what the language takes without any."""
        return f"{ids_text(self._selected.ids)} " if len(self._selected.ids) == 1 else ""

    def _read(self, units: Mapping[str, float], text: str) -> float:
        """Return what a text means here, where the drawing's names can be used."""
        scope = replace(self._document.session.scope, units=units, plain=display_unit_size())
        return number_of(read_value(text), scope) if units is ANGLE_UNITS else clean(length_of(read_value(text), scope))


def _remark(selected: SelectedEntities) -> str:
    if not selected.ids:
        return "nothing selected"
    if len(selected.ids) > 1:
        return f"{grouped(len(selected.ids), 0)} selected"
    return f"{kind_name(selected.shapes[0]).capitalize()} {selected.ids[0]}"


def _kinds(selected: SelectedEntities) -> str:
    counts = Counter(kind_name(shape) for shape in selected.shapes).most_common()
    words = [counted(count, kind) for kind, count in counts[:_FIRST_KINDS]]
    rest = sum(count for _, count in counts[_FIRST_KINDS:])
    return ", ".join(words + [f"{rest} others"] * bool(rest))


def _size(box: Box) -> str:
    return f"{_plain(box[2] - box[0])} {TIMES} {_length(box[3] - box[1])}"


def _plain(length: float) -> str:
    """Return a length in the unit that is shown, without its name; inches with a decimal more."""
    return grouped(length) if display_unit_size() == 1.0 else grouped(length / display_unit_size(), 4)


def _length(length: float) -> str:
    return f"{_plain(length)} {display_unit_name('mm')}"


def _figures(selected: SelectedEntities) -> dict[str, str]:
    """Return what there is to read of what is selected and cannot be set."""
    curves = [shape for shape in selected.shapes if isinstance(shape, Curve)]
    area = enclosed_area(curves) if len(curves) <= _MOST_ROUND else None
    closed = (
        {"Area": f"{grouped(area / display_unit_size() ** 2)} {display_unit_name('mm')}²"} if area is not None else {}
    )
    if len(selected.ids) == 1:
        return (_of_curve(curves[0]) if curves else _of_note(selected.shapes[0])) | closed
    return {KINDS: _kinds(selected)} | ({TOTAL: "", EXTENT: ""} if curves else {}) | closed


def _of_curve(curve: Curve) -> dict[str, str]:
    if isinstance(curve, Arc | Circle):
        return {"Direction": "counter-clockwise" if curve.ccw else "clockwise"}
    if isinstance(curve, Ellipse):
        return {"Length": _length(curve_length(curve)), "Direction": "counter-clockwise" if curve.ccw else "clockwise"}
    if isinstance(curve, Spline):
        return {
            "Length": _length(curve_length(curve)),
            "Degree": str(curve.degree),
            "Control points": f"{len(curve.control_points)}{', weighted' * bool(curve.weights)}",
        }
    return {}


def _of_note(shape: object) -> dict[str, str]:
    return {"Measures": shape.measure.value, "Figure": figure(shape)} if isinstance(shape, Dimension) else {}


def _whole(document: Document, extent: Box | None) -> dict[str, str]:
    part = document.part
    found = {"Curves": grouped(len(part.entities), 0)}
    if part.notes:
        found["Notes"] = grouped(len(part.notes), 0)
    if extent is not None:
        found |= {EXTENT: _size(extent), "Lower left": f"{_plain(extent[0])}, {_plain(extent[1])}"}
    return found | {"Units": _UNITS[part.units]}
