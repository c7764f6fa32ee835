"""What a new part is to be: how big, of which material, on which machine."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QFrame, QHBoxLayout, QPushButton, QVBoxLayout

from ...framework.boxes import h_box, v_box
from ...framework.fields import ListField, NumberField, NumberSpec
from ...framework.labels import muted
from ...framework.section import heading
from ..new_job import MATERIALS, NewPart
from .file_card import HEIGHT

_LENGTHS = (("Along X", 80.0), ("Along Y", 50.0), ("Thickness", 10.0))
_CORNERS = NumberSpec("Corner R", low=0.0, high=10_000, tip="Radius of the outline's corners; 0 = they are sharp.")
_NAME_PX = 68
"""So narrow that the card takes two columns of the page, no more, in a window of 1024 px."""


class NewCard(QFrame):
    """Four lengths, two lists, one button.

    Signals:
        begun(NewPart): this is to be made.

    Attributes:
        lengths: along X, Y and Z, mm. corners: radius of the outline's, mm.
        material, machine: what of, and what writes the NC text. outline: whether the part's rectangle is drawn.
    """

    begun = Signal(NewPart)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("startCard")
        self.lengths = [
            NumberField(
                NumberSpec(name, low=0.1, high=10_000, tip="Of the part; the stock is as thick as it."),
                label_width=_NAME_PX,
            )
            for name, _ in _LENGTHS
        ]
        for field, (_, value) in zip(self.lengths, _LENGTHS, strict=True):
            field.show_value(value)
        self.corners = NumberField(_CORNERS, label_width=_NAME_PX)
        self.corners.show_value(0.0)
        self._numbers = (*self.lengths, self.corners)
        for field in self._numbers:
            field.note.hide()
        self.material = ListField("Material", [(name, name.capitalize()) for name in MATERIALS], _NAME_PX)
        self.machine = ListField("Machine", [], _NAME_PX)
        self.outline, self.begin = QCheckBox("Draw its outline"), QPushButton("Begin")
        self.outline.setChecked(True)
        self.begin.setProperty("role", "primary")
        self.begin.clicked.connect(self._begin)
        self.outline.toggled.connect(self.corners.setEnabled)
        for field in self._numbers:
            field.edit.returnPressed.connect(self._begin)
        self._lay_out()

    def _lay_out(self) -> None:
        left, right = QVBoxLayout(), QVBoxLayout()
        for column, widgets in (
            (left, self._numbers),
            (right, (self.material, self.machine, self.outline)),
        ):
            column.setSpacing(4)
            for widget in widgets:
                column.addWidget(widget)
            column.addStretch(1)
        both = h_box(spacing=16)
        both.addLayout(left, 1)
        both.addLayout(right, 1)
        foot = QHBoxLayout()
        foot.addWidget(muted("or just draw: pick a tool, type  80 Tab 50 Enter"), 1)
        foot.addWidget(self.begin, 0, Qt.AlignmentFlag.AlignRight)
        column = v_box(self, (16, 12, 16, 12), 8)
        column.addWidget(heading("New"))
        column.addLayout(both, 1)
        column.addLayout(foot)
        self.setMinimumHeight(HEIGHT)

    def show_machines(self, machines: list[tuple[object, str]], chosen: str) -> None:
        """Offer machines by the name of their post."""
        self.machine.set_choices(machines)
        self.machine.show_value(chosen)

    def _begin(self) -> None:
        for field in self._numbers:
            field.commit()  # Enter is told before the field takes what was typed
        wrong = next((field for field in self._numbers if field.reason.text()), None)
        if wrong is not None:
            wrong.edit.setFocus()
            return
        x, y, z = (field.number for field in self.lengths)
        part = NewPart(
            x, y, z, str(self.material.value), str(self.machine.value), self.outline.isChecked(), self.corners.number
        )
        if part.outline and part.round > part.widest_round:
            self.corners.refuse(f"At most {part.widest_round:g} mm, half of the shorter side.")
        else:
            self.begun.emit(part)
