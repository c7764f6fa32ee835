"""The form of an operation: what most people set first, then groups that fold. It shows what has an effect on its kind
alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from ...core.errors import HitofudeError
from ...drafting.expressions.numbers import length
from ...model.fields import parameters_of, with_values
from ...model.job import Job
from ...model.operation import CutParameters, Operation, Side
from ...model.operation_kinds import parameters
from ...model.tool import Tool
from ..framework.fields import ListField, NumberField
from ..framework.figures import counted
from ..framework.form import FormSection
from ..framework.icons import IconButton
from ..framework.labels import muted
from ..framework.samples import StepoverDrawing
from . import parameter_sketches
from .changes import operation_name, refusal, with_operation
from .operation_groups import EXTRAS, OperationGroup, nothing_beside
from .parameter_fields import ParameterField, field_of, spec_of
from .sketch import SketchWidget

USUAL_SHARE = 0.85
"""Of the diameter: what the stepover with the least path comes to on most parts; for the drawing beside the field."""

USUAL_FLUTES = 3.0
"""Diameters that the flutes of a tool are long where nothing is told of them; the drawing of the tool says so, too."""


def _too_wide(stepover: float, diameter: float) -> str:
    return f"Stepover is {stepover:g} mm; use more than 0 and not more than the tool's diameter, {diameter:g} mm."


def _has_rings(operation: Operation) -> bool:
    """Tell whether there is a distance between the paths of an operation."""
    placed = parameters_of(type(operation)).get("stepover")
    return placed is not None and placed.has_effect(operation)


def _has_strokes(operation: Operation) -> bool:
    """Tell whether the tool goes down in strokes."""
    return "peck" in parameters_of(type(operation))


class OperationForm(FormSection):
    """Everything that can be set of one operation.

    Signals:
        moved(way): to be cut earlier (-1) or later (1). copied(): wanted twice. tabs(): tabs are to be put by hand.
        selection(): its curves are to be those that are selected.
    """

    moved = Signal(int)
    copied = Signal()
    tabs = Signal()
    selection = Signal()

    def __init__(self) -> None:
        super().__init__("Operation", removable="operation")
        self._index, self._diameter = 0, 1.0
        self.fields: dict[str, ParameterField] = {}
        self._of: list[tuple[QWidget, Callable[[Operation], bool]]] = []
        self._add_buttons()
        self._add_main()
        self.hand: QPushButton
        self.use: QPushButton
        self.groups: list[OperationGroup] = []
        titles = {placed.parameter.group for placed, _ in parameters().values()} - {""}
        for title in (*(title for title in EXTRAS if title in titles), *sorted(titles - EXTRAS.keys())):
            self.groups.append(OperationGroup(self, title, EXTRAS.get(title, nothing_beside)))

    @property
    def index(self) -> int:
        """Of the operation that is shown."""
        return self._index

    def _add_buttons(self) -> None:
        self.earlier = IconButton("up", "Cut earlier (Alt+Up in the list)")
        self.later = IconButton("down", "Cut later (Alt+Down in the list)")
        self.twice = IconButton("copy", "Duplicate this operation (Ctrl+D in the list)")
        for button, way in ((self.earlier, -1), (self.later, 1)):
            button.clicked.connect(lambda _=False, w=way: self.moved.emit(w))
        self.twice.clicked.connect(self.copied)
        for button in (self.earlier, self.later, self.twice):
            self.head.insertWidget(self.head.count() - 1, button)

    def of(self, concerns: Callable[[Operation], bool], widget: QWidget) -> None:
        """Show a widget for some operations alone."""
        self._of.append((widget, concerns))

    def add_parameter(
        self, key: str, read: Callable[[str], float] | None = None, edit: Callable[[Job, Any], Job] | None = None
    ) -> None:
        """Add the field of a parameter, with the reading of texts and the change of the job in the place of the usual
        ones.
        """
        placed = parameters()[key].place
        made = ParameterField(placed, field_of(placed, read))
        change = edit or (lambda job, value: self.with_values(job, {key: made.kept(value)}))
        self.add_field(placed.parameter.short or placed.parameter.label, made.field, change)
        self.fields[key] = made

    def _add_main(self) -> None:
        """Add what stands above the groups: the fields of parameters without a group, and pictures beside some."""
        self.tool = ListField("Tool", [])
        self.add_choice("Tool", self.tool, lambda job, v: self.with_values(job, {"tool": v}))
        own: dict[str, tuple[Callable[[str], float] | None, Callable[[Job, Any], Job] | None]] = {
            "stepover": (self._read_stepover, None),
            "side": (None, self._with_side),
        }
        beside = {"stepover": self._add_rings, "side": self._add_side, "peck": self._add_strokes}
        for key, (placed, _) in parameters().items():
            if not placed.parameter.group and key not in ("tool", "enabled"):
                self.add_parameter(key, *own.get(key, (None, None)))
                beside.get(key, lambda: None)()

    def _add_rings(self) -> None:
        self.drawing, self.overlap = StepoverDrawing(), QLabel()
        self.of(_has_rings, self.add_picture(self.drawing, muted("Overlap"), self.overlap))

    def _add_side(self) -> None:
        self.side_picture, self.side_words = SketchWidget(parameter_sketches.side, "Where the path runs"), muted()
        self.of(lambda operation: operation.FOLLOWS_WALLS, self.add_picture(self.side_picture, self.side_words))

    def _add_strokes(self) -> None:
        self.peck_picture = SketchWidget(parameter_sketches.peck, "The strokes of the drill")
        self.of(_has_strokes, self.add_picture(self.peck_picture))

    def with_values(self, job: Job, values: Mapping[str, Any]) -> Job:
        """Return the job with other values of parameters in the operation that is shown, by key."""
        return with_operation(job, self._index, with_values(job.operations[self._index], values))

    def _with_side(self, job: Job, side: object) -> Job:
        """Return the job with another side; on the line there is no wall, so what belongs to walls goes."""
        bare = {"stock_to_leave": 0.0, "dog_bones": False, "finish_width": 0.0} if side is Side.ON else {}
        return self.with_values(job, {"side": side, **bare})

    def _read_stepover(self, text: str) -> float:
        share = text.strip().removesuffix("%")
        value = (
            spec_of(parameters()["stepover"].place.parameter).read(text)
            if share == text.strip()
            else length(share) * self._diameter / 100
        )
        if not 0 < value <= self._diameter:
            raise HitofudeError(_too_wide(value, self._diameter))
        return value

    def show_operation(self, job: Job, index: int, strokes: int | None) -> None:
        """Show one operation of the job; `strokes` is what was computed for it, if it was."""
        self._index = index
        operation = job.operations[index]
        tool = next((t for t in job.tools if t.number == operation.cut.tool), None)
        self.earlier.setEnabled(index > 0)
        self.later.setEnabled(index < len(job.operations) - 1)
        self.title.setText(operation_name(operation))
        self.remark.setText(counted(strokes, "stroke") if strokes is not None else "")
        for widget, concerns in self._of:
            widget.setVisible(concerns(operation))
        self._show_fields(operation)
        self._show_main(job, operation)
        if tool is not None and _has_rings(operation):
            self._show_rings(operation, tool)
        if operation.FOLLOWS_WALLS and operation.wall_side is not None:
            self._show_side(operation.wall_side)
        if _has_strokes(operation):
            self.peck_picture.show_values(operation.cut.depth, self._value(operation, "peck") or 0.0, operation.beyond)
        for group in self.groups:
            group.show(operation, tool, job)

    def _value(self, operation: Operation, key: str) -> Any:
        return self.fields[key].placed.of(operation)

    def _show_fields(self, operation: Operation) -> None:
        known = parameters_of(type(operation))
        for key, made in self.fields.items():
            has = key in known and known[key].has_effect(operation)
            made.field.setVisible(has)
            if has:
                ParameterField(known[key], made.field).show(operation)

    def number(self, key: str) -> NumberField:
        """Return the field of a parameter that is a number."""
        field = self.fields[key].field
        assert isinstance(field, NumberField)
        return field

    def _show_main(self, job: Job, operation: Operation) -> None:
        cut, thickness = operation.cut, job.stock.thickness
        self.tool.set_choices([(t.number, f"T{t.number}  {t.label}") for t in job.tools])
        self.tool.show_value(cut.tool, refusal(job, operation))
        self.number("depth").show_value(cut.depth, "through" if cut.depth == thickness else "")
        if cut.depth > thickness:
            self.number("depth").refuse(
                f"Depth is {cut.depth:g} mm, but the stock is {thickness:g} mm thick; reduce it or take thicker stock."
            )
        passes = math.ceil((cut.floor - cut.finish_depth) / cut.stepdown - 1e-9) + (cut.finish_depth > 0)
        self.number("stepdown").show_value(cut.stepdown, counted(passes, "pass", "passes"))
        tool = next((each for each in job.tools if each.number == cut.tool), None)
        if (
            tool is not None and cut.depth <= thickness and not tool.kind.threads
        ):  # whose teeth go deeper than they are long
            self._warn_of_reach(cut, tool)

    def _warn_of_reach(self, cut: CutParameters, tool: Tool) -> None:
        """Say what the tool's flutes do not reach, before anything is computed."""
        if tool.flute_length and cut.depth > tool.flute_length:
            self.number("depth").refuse(
                f"Depth is {cut.depth:g} mm, but the flutes of T{tool.number} are {tool.flute_length:g} mm long; take "
                "a longer tool, or clear above first."
            )
        least, known = min(cut.stepdown, cut.depth), tool.flute_length or USUAL_FLUTES * tool.diameter
        if least > known:
            self.number("stepdown").refuse(
                f"Step down is {cut.stepdown:g} mm, and T{tool.number} cuts {known:g} mm "
                f"{'with its flutes' if tool.flute_length else 'at the most, as wide as it is'}; use less."
            )

    def _show_rings(self, operation: Operation, tool: Tool) -> None:
        self._diameter = tool.diameter
        value = self._value(operation, "stepover")
        usual = USUAL_SHARE * tool.diameter if operation.COARSE else tool.radius
        shown = usual if value is None else value
        self.number("stepover").show_value(value, f"{100 * shown / tool.diameter:.1f} %" if value is not None else "")
        if value is not None and value > tool.diameter:
            self.number("stepover").refuse(_too_wide(value, tool.diameter))
        self.drawing.show_ratio(shown / tool.diameter)
        self.overlap.setText(f"{tool.diameter - shown:.3f} mm" if value is not None else "of the least path")

    def _show_side(self, side: Side) -> None:
        self.side_picture.show_values(list(Side).index(side))
        self.side_words.setText(
            {
                Side.INSIDE: "What the lines bound is taken out.",
                Side.OUTSIDE: "What the lines bound is the part.",
                Side.ON: "The tool's centre follows the lines, open ones too.",
            }[side]
        )
