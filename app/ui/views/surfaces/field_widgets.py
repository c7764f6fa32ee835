"""Fields for what is asked of a scene: numbers, places, choices, words, colours."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QHBoxLayout, QLabel, QWidget

from ....formats.plot.content import TOOL_COLOURS
from ...framework.boxes import h_box, put_away
from ...framework.fields import (
    ROW_HEIGHT,
    ChoiceField,
    ListField,
    NumberField,
    NumberSpec,
    TextField,
    field_grid,
    field_name,
    reason_label,
)
from ...framework.form import SwitchField
from ...framework.labels import muted
from ...framework.theme import TEXT_PX, text_font
from ...framework.themed import Themed
from .scene_fields import SceneField, SceneFieldKind

_THIRD = 60
"""Width of one of three numbers, px."""
_SWATCH = 18


class VectorField(QWidget):
    """Two or three numbers in a row.

    Signals:
        chosen(value): a tuple of numbers.
    """

    chosen = Signal(object)

    def __init__(self, ask: SceneField) -> None:
        super().__init__()
        reason = reason_label()
        axes = "XYZ" if ask.name != "Turn" else ("from", "to")
        specs = [
            NumberSpec(f"{ask.name} {axis}", ask.unit, ask.low, ask.high, ask.decimals, ask.unit == "mm", ask.tip)
            for axis, _ in zip(axes, ask.value, strict=False)
        ]
        self.fields = [NumberField(spec, None, reason) for spec in specs]
        self.setToolTip(ask.tip)
        grid, row = field_grid(self), QHBoxLayout()
        grid.addLayout(row, 0, 1)  # before anything stands in it, as in `PanelSection.add_indented`
        row.setSpacing(4)
        for field in self.fields:
            field.edit.setFixedSize(_THIRD, ROW_HEIGHT)
            row.addWidget(field)
            field.committed.connect(lambda _: self.chosen.emit(tuple(each.number for each in self.fields)))
        row.addStretch(1)
        grid.addWidget(field_name(ask.name), 0, 0)
        grid.addWidget(reason, 1, 0, 1, 2)
        grid.setColumnStretch(1, 1)

    def show_value(self, value: tuple[float, ...]) -> None:
        """Show numbers: as short as they are."""
        for field, number in zip(self.fields, value, strict=True):
            field.show_value(number)
            if not (field.edit.hasFocus() and field.edit.isModified()):
                text = field.edit.text()
                field.edit.setText(text.rstrip("0").rstrip(".") if "." in text else text)
                field.edit.setCursorPosition(0)


class ColourSwatch(Themed, QAbstractButton):
    """A colour to choose; "" stands for the next one of the palette, drawn as a ring."""

    def __init__(self, colour: str) -> None:
        super().__init__()
        self.colour = colour
        self.setCheckable(True)
        self.setFixedSize(_SWATCH, _SWATCH)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setToolTip(colour or "The next of the palette")
        self.setAccessibleName(f"Colour {colour or 'auto'}")

    def sizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """A small square."""
        return QSize(_SWATCH, _SWATCH)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw the colour, and a ring round the chosen one."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.isChecked() or self.hasFocus():
            painter.setPen(QPen(self._theme.ink, 1.5))
            painter.drawEllipse(1, 1, _SWATCH - 2, _SWATCH - 2)
        painter.setPen(QPen(self._theme.muted, 1.5) if not self.colour else Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.colour) if self.colour else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(4, 4, _SWATCH - 8, _SWATCH - 8)


class ColourField(QWidget):
    """The colours of the palette side by side, the chosen one ringed; any other stands behind them.

    Signals:
        chosen(text): "#rrggbb", or "".
    """

    chosen = Signal(object)

    def __init__(self, name: str) -> None:
        super().__init__()
        self._row = h_box(self, (0, 3, 0, 3), 2)
        self._row.addWidget(field_name(name))
        self._row.addSpacing(6)
        self._group = QButtonGroup(self)
        self.swatches: dict[str, ColourSwatch] = {}
        for colour in ("", *TOOL_COLOURS):
            self._add(colour)
        self._row.addStretch(1)

    def _add(self, colour: str) -> None:
        made = ColourSwatch(colour)
        made.clicked.connect(lambda: self.chosen.emit(colour))
        self._group.addButton(made)
        self._row.insertWidget(2 + len(self.swatches), made)
        self.swatches[colour.lower()] = made

    def show_value(self, value: str) -> None:
        """Ring a colour; one of the user's own is added."""
        if value.lower() not in self.swatches:
            for colour in [own for own in self.swatches if own not in ("", *(each.lower() for each in TOOL_COLOURS))]:
                gone = self.swatches.pop(colour)
                self._group.removeButton(gone)
                put_away(gone)
            self._add(value)
        self.swatches[value.lower()].setChecked(True)


Field = NumberField | VectorField | TextField | ColourField | ChoiceField | ListField | SwitchField | QLabel


def field_of(ask: SceneField) -> Field:
    """Return the field that asks for something; NumberField tells `committed`, all others `chosen`."""
    match ask.kind:
        case SceneFieldKind.NUMBER:
            is_length = ask.unit == "mm"
            return NumberField(
                NumberSpec(ask.name, ask.unit, ask.low, ask.high, ask.decimals, is_length, ask.tip, ask.auto)
            )
        case SceneFieldKind.VECTOR:
            return VectorField(ask)
        case SceneFieldKind.CHOICE:
            return ChoiceField(ask.name, ask.choices)
        case SceneFieldKind.LIST:
            return ListField(ask.name, ask.choices)
        case SceneFieldKind.SWITCH:
            return SwitchField(ask.name, ask.tip)
        case SceneFieldKind.WORDS:
            return TextField(ask.name)
        case SceneFieldKind.COLOUR:
            return ColourField(ask.name)
    made = muted(ask.name) if ask.kind is SceneFieldKind.TOLD else QLabel(ask.name)
    made.setWordWrap(True)
    made.setContentsMargins(0, 8 if ask.kind is SceneFieldKind.HEADING else 3, 0, 3)
    if ask.kind is SceneFieldKind.HEADING:
        made.setFont(text_font(TEXT_PX, semibold=True))
        made.setStyleSheet("font-weight: 600;")
    return made
