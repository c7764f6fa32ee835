"""Fields of a properties form: label, value with unit, a note; wrong input is marked at once with the reason under
it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence
from PySide6.QtWidgets import QButtonGroup, QComboBox, QGridLayout, QLabel, QLineEdit, QToolButton, QWidget

from ...core.errors import HitofudeError
from ...drafting.expressions.errors import CommandError
from ...drafting.expressions.numbers import length
from .boxes import h_box
from .catalogue import tr
from .display_unit import clean, display_unit_name, display_unit_size
from .labels import Elided, muted, restyle, show_words

LABEL_WIDTH = 92
VALUE_WIDTH = 76
ROW_HEIGHT = 24
_COUNTED = ("", "px")  # units of what comes in whole numbers where no decimals are shown


@dataclass(frozen=True, slots=True)
class NumberSpec:
    """What a number field asks for.

    Attributes:
        name, unit: shown before and after the value; mm gives way to the unit that the window shows.
        low, high: range, ends included, in the unit.
        decimals: shown when the field is not being typed in.
        is_length: units such as 1in can be typed; else plain numbers only.
        tip: what it means, one sentence.
        auto: what an empty field stands for and shows, such as "auto"; "" = it must hold a number.
    """

    name: str
    unit: str = "mm"
    low: float = 0.0
    high: float = 99_999.0
    decimals: int = 3
    is_length: bool = True
    tip: str = ""
    auto: str = ""

    @property
    def size(self) -> float:
        """How much of the unit one of what is shown and typed is."""
        return display_unit_size() if display_unit_name(self.unit) != self.unit else 1.0

    def text(self, value: float) -> str:
        """Return a value as it is shown: inches with a decimal more."""
        return f"{value / self.size:.{self.decimals + (self.size != 1.0)}f}"

    def read(self, text: str) -> float:
        """Return the value of a typed text, in the unit.

        Raises:
            HitofudeError: not a number, or out of range; a sentence.
        """
        if (
            not self.is_length
            and text[:1].isnumeric()
            and any(letter.isalpha() or letter in "\"'°%" for letter in text)
        ):
            kind = f"is in {display_unit_name(self.unit)}" if self.unit else "has no unit"
            raise HitofudeError(f"{self.name} {kind}; type the number alone.")
        value = clean(length(text, self.size))
        if self.decimals == 0 and self.unit in _COUNTED and value != int(value):
            raise HitofudeError(f"{self.name} is {value:g}; use a whole number.")
        if not self.low <= value <= self.high:
            unit, size = self.unit if self.unit in ("", "°") else f" {display_unit_name(self.unit)}", self.size
            raise HitofudeError(
                f"{self.name} is {value / size:g}{unit}; use {self.low / size:g} to {self.high / size:g}."
            )
        return value


def reason_label() -> QLabel:
    """Return a label for what is wrong with a value."""
    made = QLabel()
    made.setProperty("role", "error")
    made.setWordWrap(True)
    made.setContentsMargins(0, 0, 0, 4)
    made.hide()
    return made


def field_name(text: str, buddy: QWidget | None = None, width: int = LABEL_WIDTH) -> QLabel:
    """Return the name that stands before a field, so many px wide; a click on it goes to `buddy`."""
    made = muted(text)
    made.setFixedWidth(width)
    if buddy is not None:
        made.setBuddy(buddy)
    return made


def field_grid(field: QWidget) -> QGridLayout:
    """Return the grid of a field whose reason stands under its value."""
    grid = QGridLayout(field)
    grid.setContentsMargins(0, 1, 0, 1)
    grid.setHorizontalSpacing(8)
    grid.setVerticalSpacing(2)
    return grid


def _mark(widget: QWidget, label: QLabel, reason: str) -> None:
    """Mark a widget's value as wrong and say why; "" = it is right."""
    show_words(label, reason)
    if bool(reason) != (widget.property("wrong") == "true"):
        widget.setProperty("wrong", "true" if reason else "false")
        restyle(widget)


_FIRST = (
    1000  # stretch of a name that takes its full width before anything else grows, and gives way where letters are wide
)
_LEAST_LETTERS = 8  # of a drop-down list's text, where room is short


class NumberField(QWidget):
    """One number: arithmetic and units are accepted (`1in + 8mm`).

    Signals:
        committed(value): a float, or None where the field was emptied and may be.
    """

    committed = Signal(object)

    def __init__(
        self,
        spec: NumberSpec,
        read: Callable[[str], float] | None = None,
        reason: QLabel | None = None,
        label_width: int = LABEL_WIDTH,
    ) -> None:
        """Make a field.

        Args:
            spec: what is asked for.
            read: gives the value of a text in the place of the spec.
            reason: where to say what is wrong; the field is then the value alone, and who has it says the rest.
            label_width: room of the name, px.
        """
        super().__init__()
        self.spec = spec
        self._read = read or spec.read
        self._value: float | None = 0.0
        self._before: float | None = 0.0
        self.edit, self.note, self.reason = QLineEdit(), Elided(role="muted"), reason or reason_label()
        self.unit = muted(display_unit_name(spec.unit))
        self.edit.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.edit.setFixedSize(VALUE_WIDTH, ROW_HEIGHT)
        self.edit.setAccessibleName(spec.name)
        self.edit.setPlaceholderText(spec.auto)
        self.edit.textEdited.connect(self._check)
        self.edit.editingFinished.connect(self.commit)
        self.edit.installEventFilter(self)
        self.setToolTip(spec.tip)
        if reason is None:
            self._lay_out(label_width)
        else:
            alone = h_box(self)
            alone.addWidget(self.edit)

    def _lay_out(self, label_width: int) -> None:
        grid = field_grid(self)
        grid.addWidget(field_name(self.spec.name, self.edit, label_width), 0, 0)
        grid.addWidget(self.edit, 0, 1)
        grid.addWidget(self.unit, 0, 2)
        self.note.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        grid.addWidget(self.note, 0, 3)
        grid.addWidget(self.reason, 1, 0, 1, 4)
        grid.setColumnStretch(3, 1)

    @property
    def value(self) -> float | None:
        """The value that was last accepted, in the field's unit; None = automatic."""
        return self._value

    @property
    def number(self) -> float:
        """The value of a field that always holds one."""
        return self._value or 0.0

    def show_value(self, value: float | None, note: str = "") -> None:
        """Show a value of the job, unless the user is in the middle of typing another one; None = automatic."""
        self.note.setText(note)
        if self.edit.isModified() and self.edit.hasFocus():
            return
        self._take(value)
        self._mark("")

    def _take(self, value: float | None) -> None:
        self._value = value
        self.edit.setText("" if value is None else self.spec.text(value))
        self.edit.setModified(False)

    def follow_unit(self) -> None:
        """Show the same value in the unit that the window shows now; what is being typed is given up."""
        self.unit.setText(display_unit_name(self.spec.unit))
        self._take(self._value)
        self._mark("")

    def refuse(self, reason: str) -> None:
        """Mark what was typed as wrong, for a reason that only the job knows; Escape brings back what was there."""
        self._value = self._before
        self._mark(reason)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 (Qt's name)
        """Escape brings the old value back; a double click takes the whole number, not the digits before the point.

        While nothing is being typed, undo and redo are the job's.
        """
        if event.type() == QEvent.Type.MouseButtonDblClick:
            self.edit.selectAll()
            return True
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and not self.edit.isModified()
            and (event.matches(QKeySequence.StandardKey.Undo) or event.matches(QKeySequence.StandardKey.Redo))
        ):
            event.ignore()
            return True
        if event.type() == QEvent.Type.KeyPress and isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            self.edit.setModified(False)
            self.show_value(self._value, self.note.text())
            return True
        return super().eventFilter(watched, event)

    def _is_auto(self, text: str) -> bool:
        return bool(self.spec.auto) and text.strip().lower() in ("", self.spec.auto, tr(self.spec.auto))

    def _check(self, text: str) -> float | None:
        """Return the value of a text; None where it is wrong, or stands for the automatic one."""
        try:
            value = None if self._is_auto(text) else self._read(text)
        except CommandError as wrong:
            self._mark(wrong.reason)
        except HitofudeError as wrong:
            self._mark(str(wrong))
        else:
            self._mark("")
            return value
        return None

    def commit(self) -> None:
        """Take what was typed, if it is right; nothing where nothing was typed."""
        if not self.edit.isModified():
            return
        text = self.edit.text()
        value = self._check(text)
        if value is not None or self._is_auto(text):
            self._before = self._value
            self._take(value)
            self.committed.emit(value)

    def _mark(self, reason: str) -> None:
        _mark(self.edit, self.reason, reason)


class ChoiceField(QWidget):
    """A few values side by side, the chosen one underlined."""

    chosen = Signal(object)

    def __init__(self, name: str, choices: Sequence[tuple[Hashable, str]], label_width: int = LABEL_WIDTH) -> None:
        super().__init__()
        row = h_box(self, (0, 1, 0, 1), 8)
        if name:
            label = muted(name)
            label.setMaximumWidth(label_width - 4)
            row.addWidget(label, _FIRST)
        self._group = QButtonGroup(self)
        self.buttons: dict[Hashable, QToolButton] = {}
        for value, text in choices:
            button = QToolButton()
            button.setText(text)
            button.setCheckable(True)
            button.setProperty("role", "choice")
            button.setMinimumWidth(button.fontMetrics().horizontalAdvance(text) + 10)
            button.clicked.connect(lambda _=False, v=value: self.chosen.emit(v))
            self._group.addButton(button)
            self.buttons[value] = button
            row.addWidget(button)
        row.addStretch(1)

    @property
    def value(self) -> Hashable:
        """The one that is underlined; None where none is."""
        return next((value for value, button in self.buttons.items() if button.isChecked()), None)

    def leave_out(self, values: Collection[Hashable]) -> None:
        """Offer all but some of the values."""
        for value, button in self.buttons.items():
            button.setVisible(value not in values)

    def show_value(self, value: Hashable) -> None:
        """Underline the job's value."""
        self.buttons[value].setChecked(True)


class TextField(QWidget):
    """A line of text."""

    chosen = Signal(object)

    def __init__(self, name: str, tip: str = "") -> None:
        super().__init__()
        self.edit = QLineEdit()
        self.edit.setFixedHeight(ROW_HEIGHT)
        self.edit.setAccessibleName(name)
        self.setToolTip(tip)
        self._shown = ""
        self.edit.editingFinished.connect(self._finish)
        row = h_box(self, (0, 1, 0, 1), 8)
        row.addWidget(field_name(name, self.edit))
        row.addWidget(self.edit, 1)

    def _finish(self) -> None:
        self.edit.setModified(False)
        text = self.edit.text().strip()
        if text != self._shown:
            self._shown = text
            self.chosen.emit(text)

    def show_value(self, text: str) -> None:
        """Show the job's value, unless another one is being typed."""
        self._shown = text
        if self.edit.text() != text and not (self.edit.isModified() and self.edit.hasFocus()):
            self.edit.setText(text)
            self.edit.setCursorPosition(0)


class ListField(QWidget):
    """Many values: a drop-down list."""

    chosen = Signal(object)

    def __init__(self, name: str, choices: Sequence[tuple[object, str]], label_width: int = LABEL_WIDTH) -> None:
        super().__init__()
        self.box = QComboBox()
        self.box.setFixedHeight(ROW_HEIGHT)
        self.box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.box.setMinimumContentsLength(_LEAST_LETTERS)
        self.box.setAccessibleName(name)
        self._values: list[object] = []
        self.set_choices(choices)
        self.box.activated.connect(lambda at: self.chosen.emit(self._values[at]))
        self.reason = reason_label()
        grid = field_grid(self)
        grid.addWidget(field_name(name, self.box, label_width), 0, 0)
        grid.addWidget(self.box, 0, 1)
        grid.addWidget(self.reason, 1, 0, 1, 2)
        grid.setColumnStretch(1, 1)

    def set_choices(self, choices: Sequence[tuple[object, str]]) -> None:
        """Offer other values, each with its text."""
        if [c[0] for c in choices] != self._values or [c[1] for c in choices] != [
            self.box.itemText(i) for i in range(self.box.count())
        ]:
            self._values = [value for value, _ in choices]
            self.box.clear()
            self.box.addItems([text for _, text in choices])

    @property
    def value(self) -> object:
        """What is shown; None where nothing is."""
        at = self.box.currentIndex()
        return self._values[at] if at >= 0 else None

    def show_value(self, value: object, wrong: str = "") -> None:
        """Show the job's value, and what is wrong with it."""
        _mark(self.box, self.reason, wrong)
        self.box.setCurrentIndex(self._values.index(value) if value in self._values else -1)
