"""Beside the cut: with which tools a program is cut, out of what; for programs that do not tell, and to try something
else.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QPushButton, QScrollArea, QVBoxLayout, QWidget

from ....core.errors import HitofudeError
from ....model.tool import Tool
from ....model.tool_kind import ToolKind, shape_keys, tool_kind, tool_kinds
from ...framework.boxes import h_box, put_away, v_box
from ...framework.fields import ChoiceField, ListField, NumberField, NumberSpec
from ...framework.labels import Elided, muted
from ...framework.samples import Switch
from ...framework.section import EDGE, PanelSection, hairline, heading
from ...framework.side_scroll import WIDTH
from .foreign_program import MissingSetup
from .user_setup import Box, UserSetup

_ANGLE, _FAR = np.radians(60.0), 100_000.0
_AXES = ("X from", "Y from", "Z from", "X to", "Y to", "Z to")


class ToolFields(PanelSection):
    """Kind and shape of one tool; fields that its kind does not have are not there."""

    def __init__(self, number: int, tool: Tool) -> None:
        super().__init__(f"T{number}" if number else "The tool")
        self.tool = tool
        self.kind = ListField("Kind", [(kind, kind.short_title or kind.title) for kind in tool_kinds()])
        self.kind.chosen.connect(lambda kind: self._change(lambda tool: as_kind(tool, tool_kind(kind))))
        self.add_indented(self.kind)
        self.fields = {
            "diameter": NumberField(NumberSpec("Diameter", low=0.001, high=1000)),
            "corner_radius": NumberField(NumberSpec("Corner radius", high=500)),
            "tip_diameter": NumberField(
                NumberSpec("Tip diameter", high=1000, tip="Of the flat of a V tool, of the ball of a tapered one.")
            ),
            "tip_angle": NumberField(
                NumberSpec("Angle", "°", 1, 179, 2, False, "The full angle of the point, or of the cone.")
            ),
        }
        self.reason = QLabel()
        self.reason.setProperty("role", "error")
        self.reason.setWordWrap(True)
        for key, field in self.fields.items():
            field.committed.connect(partial(self._set, key))
            self.add_indented(field)
        self.add_indented(self.reason)
        self._show()

    def _set(self, key: str, value: float) -> None:
        self._change(lambda tool: _with_value(tool, key, np.radians(value) if key == "tip_angle" else value))

    def _change(self, edit: Callable[[Tool], Tool]) -> None:
        """Take another shape, unless it is none: then say why."""
        try:
            self.tool = edit(self.tool)
        except HitofudeError as error:
            self.reason.setText(str(error))
            self.reason.show()
        else:
            self._show()

    def _show(self) -> None:
        self.reason.hide()
        self.kind.show_value(self.tool.kind)
        shape = {"diameter", *shape_keys(self.tool.kind)}
        for key, field in self.fields.items():
            value = getattr(self.tool, key)
            field.setVisible(key in shape)
            field.show_value(float(np.degrees(value)) if key == "tip_angle" else value)


def as_kind(tool: Tool, kind: ToolKind) -> Tool:
    """Return a tool of another kind; what its shape needs and nobody has said is what is usual."""
    usual = {
        "corner_radius": tool.diameter / 8,
        "tip_angle": 0.0 if kind.drills else _ANGLE,
        "tip_diameter": tool.diameter / 4 if kind.needs_tip else 0.0,
    }
    made = tool.as_kind(kind)
    missing = {key: usual[key] for key in shape_keys(kind) if not getattr(made, key) and usual[key]}
    return replace(made, **missing) if missing else made  # type: ignore[arg-type]


def _with_value(tool: Tool, key: str, value: float) -> Tool:
    return replace(tool, **{key: value})  # type: ignore[arg-type]


class SetupForm(QWidget):
    """Fields for every tool that cuts, and for the stock.

    Signals:
        accepted(UserSetup): cut it so. left(): leave it as it is.

    Attributes:
        asked: what it asks for; None = nothing.
    """

    accepted = Signal(UserSetup)
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("sidePanel")
        self.setFixedWidth(WIDTH)
        self.asked: MissingSetup | None = None
        self.title, self.reason = heading("Tools and stock"), QLabel()
        self.name = Elided(role="muted")
        self.reason.setWordWrap(True)
        self.tools: dict[int, ToolFields] = {}
        self.stock = [NumberField(NumberSpec(axis, low=-_FAR, high=_FAR)) for axis in _AXES]
        self.compare, self.compare_row = Switch("Compare with the open drawing"), QWidget()
        self.heights = ChoiceField("Heights", [(False, "Exact"), (True, "Facets")])
        self.heights.setToolTip("Exact in each cell, or by facets in the depth buffer, the method of 1999")
        self.wrong = QLabel()
        self.cut, self.leave = QPushButton("Cut"), QPushButton("Leave it")
        self.area, self._column = QScrollArea(), QVBoxLayout()
        self._lay_out()
        self.cut.clicked.connect(self._accept)
        self.leave.clicked.connect(self.left)

    def _lay_out(self) -> None:
        self.cut.setProperty("role", "primary")
        self.wrong.setProperty("role", "error")
        self.wrong.setWordWrap(True)
        column = v_box(self, (1, 12, 0, 12), 6)
        head = h_box(margins=(EDGE, 0, EDGE, 0), spacing=12)
        head.addWidget(self.title)
        head.addWidget(self.name, 1)
        column.addLayout(head)
        self.reason.setContentsMargins(EDGE, 0, EDGE, 0)
        column.addWidget(self.reason)
        inner = QWidget()
        inner.setLayout(self._column)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(0)
        self._column.addWidget(self._stock_section())
        self._column.addStretch(1)
        self.area.setWidget(inner)
        self.area.setWidgetResizable(True)
        column.addWidget(self.area, 1)
        column.addWidget(hairline())
        self.wrong.setContentsMargins(EDGE, 0, EDGE, 0)
        column.addWidget(self.wrong)
        buttons = h_box(margins=(EDGE, 0, EDGE, 0))
        buttons.addWidget(self.cut)
        buttons.addWidget(self.leave)
        buttons.addStretch(1)
        column.addLayout(buttons)

    def _stock_section(self) -> PanelSection:
        section = PanelSection("Stock")
        for field in self.stock:
            section.add_indented(field)
        row = h_box(self.compare_row, (0, 8, 0, 0))
        row.addWidget(muted("Compare with the open drawing"))
        row.addStretch(1)
        row.addWidget(self.compare)
        section.add_indented(self.compare_row)
        section.add_indented(self.heights)
        return section

    def ask(self, asked: MissingSetup | None) -> None:
        """Ask for something else, or for nothing."""
        self.asked = asked
        for old in self.tools.values():
            self._column.removeWidget(old)
            put_away(old)
        self.tools = {}
        self.wrong.hide()
        if asked is None:
            return
        self.name.setText(asked.foreign.source.name)
        self.reason.setText(asked.reason)
        self.tools = {number: ToolFields(number, tool) for number, tool in asked.given.tools.items()}
        for k, fields in enumerate(self.tools.values()):
            self._column.insertWidget(k, fields)
        for field, value in zip(self.stock, asked.given.stock or (0.0,) * 6, strict=True):
            field.show_value(value)
        self.compare.setChecked(asked.given.compare)
        self.heights.show_value(asked.given.published)
        self.compare_row.setVisible(asked.foreign.part is not None)

    def _accept(self) -> None:
        """Hand over what was said, if it makes a box."""
        x0, y0, z0, x1, y1, z1 = box = self._box()
        if not (x1 > x0 and y1 > y0 and z1 > z0):
            self.wrong.setText("The stock has no volume: each “to” must be greater than its “from”.")
            self.wrong.show()
            return
        tools = {number: fields.tool for number, fields in self.tools.items()}
        self.accepted.emit(UserSetup(tools, box, self.compare.isChecked(), self.heights.value is True))

    def _box(self) -> Box:
        x0, y0, z0, x1, y1, z1 = (field.number for field in self.stock)
        return x0, y0, z0, x1, y1, z1
