"""Rows of the drawing's page: a point as two numbers side by side, and figures that are only read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QWidget

from ...model.curves import Point
from ..framework.boxes import h_box
from ..framework.fields import NumberField, NumberSpec, field_grid, field_name, reason_label
from ..framework.labels import Elided

COORDINATE_WIDTH = 72


class PointField(QWidget):
    """A point: x and y, each by arithmetic and units; what is wrong stands under both.

    Signals:
        committed(point): x and y, mm, of which one has just been typed.
    """

    committed = Signal(object)

    def __init__(self, spec: NumberSpec, read: Callable[[str], float]) -> None:
        super().__init__()
        self.reason = reason_label()
        self.across, self.up = (
            NumberField(replace(spec, name=f"{spec.name} {axis}"), read, self.reason) for axis in "XY"
        )
        self.setToolTip(spec.tip)
        grid = field_grid(self)
        grid.addWidget(field_name(spec.name), 0, 0)
        for column, field in enumerate((self.across, self.up), start=1):
            field.edit.setFixedWidth(COORDINATE_WIDTH)
            field.committed.connect(lambda _: self.committed.emit((self.across.number, self.up.number)))
            grid.addWidget(field, 0, column)
        grid.addWidget(self.across.unit, 0, 3)
        grid.addWidget(self.reason, 1, 0, 1, 4)
        grid.setColumnStretch(3, 1)

    def show_value(self, value: Point) -> None:
        """Show a point, unless the user is in the middle of typing another one."""
        self.across.show_value(value[0])
        self.up.show_value(value[1])

    def refuse(self, reason: str) -> None:
        """Mark what was typed as wrong, for a reason that only the drawing knows; Escape brings back what was there."""
        typed = self.across if self.across.edit.hasFocus() else self.up
        typed.refuse(reason)


class Figure(QWidget):
    """A measure that is only read, and can be copied."""

    def __init__(self, name: str, wraps: bool = False) -> None:
        super().__init__()
        self.value = QLabel() if wraps else Elided()
        self.value.setWordWrap(wraps)
        self.value.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        row = h_box(self, (0, 3, 0, 3), 8)
        row.addWidget(field_name(name), 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(self.value, 1)
        self.setAccessibleName(name)

    def show_value(self, text: str) -> None:
        """Show a measure."""
        self.value.setText(text)
        self.value.setToolTip(text)
