"""The form of an operation: what most people set first, then groups that fold. It shows what has an effect on its kind alone."""

from __future__ import annotations

import math
from dataclasses import replace

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from ...core.errors import HitofudeError
from ...drafting.expressions.numbers import length
from ...model.job import Job
from ...model.operation import ContourOperation, Direction, DrillOperation, Operation, PocketOperation, RestOperation, Side
from ...model.tool import Tool
from ..framework.fields import ChoiceField, ListField, NumberField, Spec
from ..framework.figures import counted
from ..framework.form import Form
from ..framework.icons import IconButton
from ..framework.labels import muted
from ..framework.samples import StepoverDrawing
from . import drawings
from .changes import operation_name, refusal, with_operation
from .operation_groups import GROUPS, OperationGroup
from .pictures import Picture

MILLS = (PocketOperation, RestOperation, ContourOperation)
RINGS = (PocketOperation, RestOperation)

USUAL_SHARE = 0.85
"""Of the diameter: what the stepover with the least path comes to on most parts; for the drawing beside the field."""


def _too_wide(stepover: float, diameter: float) -> str:
    return f"Stepover is {stepover:g} mm; use more than 0 and not more than the tool's diameter, {diameter:g} mm."


class OperationForm(Form):
    """Everything that can be set of one operation.

    Signals:
        moved(way): to be cut earlier (-1) or later (1). copied(): wanted twice. tabs(): tabs are to be put by hand.
    """

    moved = Signal(int)
    copied = Signal()
    tabs = Signal()

    def __init__(self) -> None:
        super().__init__("Operation", removable="operation")
        self._index, self._diameter = 0, 1.0
        self._of: list[tuple[QWidget, tuple[type[Operation], ...]]] = []
        self._add_buttons()
        self._add_main()
        self._add_rings()
        self._add_side()
        self._add_holes()
        self.leave: NumberField
        self.hand: QPushButton
        self.groups: list[OperationGroup] = [make(self) for make in GROUPS]

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

    def of(self, kinds: tuple[type[Operation], ...], widget: QWidget) -> None:
        """Show a widget for operations of these kinds alone."""
        self._of.append((widget, kinds))

    def _add_main(self) -> None:
        self.tool = ListField("Tool", [])
        self.add_choice("Tool", self.tool, lambda job, v: self.with_cut(job, tool=v))
        self.cut_depth = self.add_number(
            Spec("Depth", low=0.001, high=10_000, tip="From the stock's top down to the floor."),
            lambda job, v: self.with_cut(job, depth=v))
        self.stepdown = self.add_number(
            Spec("Step down", low=0.001, high=10_000, tip="Largest depth of one pass; passes are made equal."),
            lambda job, v: self.with_cut(job, stepdown=v))
        self.of(MILLS, self.stepdown)
        self.direction = ChoiceField("Direction", [(Direction.CLIMB, "Climb"), (Direction.CONVENTIONAL, "Conventional")])
        self.add_choice("Direction", self.direction, lambda job, v: self.with_cut(job, direction=v))
        self.of(MILLS, self.direction)

    def _add_rings(self) -> None:
        self.stepover = self.add_number(
            Spec("Stepover", auto="auto", tip="Distance between rings: mm, another unit, or per cent of the diameter, up to 100 %. "
                 "Empty: the one with the least path. Every stepover clears everything."),
            lambda job, v: self.with_values(job, stepover=v), self._read_stepover)
        self.drawing, self.overlap = StepoverDrawing(), QLabel()
        self.picture = self.add_picture(self.drawing, muted("Overlap"), self.overlap)
        self.begin = ChoiceField("Begin", [(False, "Inside"), (True, "At the walls")])
        self.add_choice("Beginning", self.begin, lambda job, v: self.with_values(job, outside_in=v))
        self.of(RINGS, self.stepover)
        self.of(RINGS, self.picture)
        self.of((PocketOperation,), self.begin)

    def _add_side(self) -> None:
        self.side = ChoiceField("Side", [(Side.INSIDE, "Inside"), (Side.OUTSIDE, "Outside"), (Side.ON, "On line")])
        self.add_choice("Side", self.side, self._with_side)
        self.side_picture, self.side_words = Picture(drawings.side, "Where the path runs"), muted()
        self.of((ContourOperation,), self.side)
        self.of((ContourOperation,), self.add_picture(self.side_picture, self.side_words))

    def _add_holes(self) -> None:
        self.peck = self.add_number(
            Spec("Peck", low=0.001, high=10_000, auto="none", tip="Depth of a stroke before the drill comes out; empty: in one go."),
            lambda job, v: self.with_values(job, peck=v))
        self.through = self.add_number(
            Spec("Through", low=0, high=1000, tip="How far the drill goes on below the depth."),
            lambda job, v: self.with_values(job, through=v))
        self.peck_picture = Picture(drawings.peck, "The strokes of the drill")
        picture = self.add_picture(self.peck_picture)
        self.least = self.add_number(
            Spec("Holes from", low=0.001, auto="tool", tip="Least diameter of the circles that are drilled; empty: the drill's own."),
            lambda job, v: self.with_values(job, least=v))
        self.most = self.add_number(
            Spec("Holes to", low=0.001, auto="tool", tip="Largest diameter of the circles that are drilled; empty: the drill's own."),
            lambda job, v: self.with_values(job, most=v))
        for widget in (self.peck, self.through, picture, self.least, self.most):
            self.of((DrillOperation,), widget)

    def with_cut(self, job: Job, **values: object) -> Job:
        """Return the job with other values in the cut of the operation that is shown."""
        operation = job.operations[self._index]
        return with_operation(job, self._index, replace(operation, cut=replace(operation.cut, **values)))  # type: ignore[arg-type]

    def with_values(self, job: Job, **values: object) -> Job:
        """Return the job with other values in the operation that is shown."""
        return with_operation(job, self._index, replace(job.operations[self._index], **values))  # type: ignore[arg-type]

    def _with_side(self, job: Job, side: object) -> Job:
        """Return the job with another side; on the line there is no wall, so what belongs to walls goes."""
        if side is not Side.ON:
            return self.with_values(job, side=side)
        job = self.with_cut(job, stock_to_leave=0.0)
        return self.with_values(job, side=side, dog_bones=False, finish_width=0.0)

    def _read_stepover(self, text: str) -> float:
        share = text.strip().removesuffix("%")
        value = self.stepover.spec.read(text) if share == text.strip() else length(share) * self._diameter / 100
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
        for widget, kinds in self._of:
            widget.setVisible(isinstance(operation, kinds))
        self._show_main(job, operation)
        if isinstance(operation, RINGS) and tool is not None:
            self._show_rings(operation, tool)
        if isinstance(operation, ContourOperation):
            self._show_side(operation)
        if isinstance(operation, DrillOperation):
            self._show_holes(operation)
        for group in self.groups:
            group.show(operation, tool, job)

    def _show_main(self, job: Job, operation: Operation) -> None:
        cut, thickness = operation.cut, job.stock.thickness
        self.tool.set_choices([(t.number, f"T{t.number}  {t.label}") for t in job.tools])
        self.tool.show_value(cut.tool, refusal(job, operation))
        self.cut_depth.show_value(cut.depth, "through" if cut.depth == thickness else "")
        if cut.depth > thickness:
            self.cut_depth.refuse(f"Depth is {cut.depth:g} mm, but the stock is {thickness:g} mm thick; reduce it or take thicker stock.")
        passes = math.ceil((cut.floor - cut.finish_depth) / cut.stepdown - 1e-9) + (cut.finish_depth > 0)
        self.stepdown.show_value(cut.stepdown, counted(passes, "pass", "passes"))
        self.direction.show_value(cut.direction)

    def _show_rings(self, operation: PocketOperation | RestOperation, tool: Tool) -> None:
        self._diameter = tool.diameter
        value = operation.stepover
        usual = USUAL_SHARE * tool.diameter if isinstance(operation, PocketOperation) else tool.radius
        shown = usual if value is None else value
        self.stepover.show_value(value, f"{100 * shown / tool.diameter:.1f} %" if value is not None else "")
        if value is not None and value > tool.diameter:
            self.stepover.refuse(_too_wide(value, tool.diameter))
        self.drawing.show_ratio(shown / tool.diameter)
        self.overlap.setText(f"{tool.diameter - shown:.3f} mm" if value is not None else "of the least path")
        if isinstance(operation, PocketOperation):
            self.begin.show_value(operation.outside_in)

    def _show_side(self, operation: ContourOperation) -> None:
        self.side.show_value(operation.side)
        self.side_picture.show_values(list(Side).index(operation.side))
        self.side_words.setText({
            Side.INSIDE: "What the lines bound is taken out.",
            Side.OUTSIDE: "What the lines bound is the part.",
            Side.ON: "The tool's centre follows the lines, open ones too.",
        }[operation.side])

    def _show_holes(self, operation: DrillOperation) -> None:
        self.peck.show_value(operation.peck)
        self.through.show_value(operation.through)
        self.least.show_value(operation.least)
        self.most.show_value(operation.most)
        self.peck_picture.show_values(operation.cut.depth, operation.peck or 0.0, operation.through)

