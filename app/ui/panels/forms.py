"""Forms: the properties of the job, of a tool, of an operation. They show a job and say what the user wants instead."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.errors import HitofudeError
from app.model.job import LARGEST_JOIN, Job, OriginXY, OriginZ
from app.model.operation import Direction, Operation, Order, PocketOperation
from app.model.part import Units
from app.model.tool import LEAST_RATE, Tool, ToolKind
from app.nc.posts import post_titles
from app.ui.figures import counted
from app.ui.icons import IconButton
from app.ui.labels import muted
from app.ui.panels.changes import (
    for_material,
    in_cutting_order,
    material_of,
    operation_name,
    stepover_of,
    with_cut,
    with_operation,
    with_tool,
)
from app.ui.panels.fields import ChoiceField, ListField, NumberField, Spec
from app.ui.panels.section import Section
from app.ui.samples import StepoverDrawing

Edit = Callable[[Job, float], Job]


class Form(Section):
    """A section of fields.

    Signals:
        edited(name, (field, make)): the user wants `make(job)` instead of the job; `name` is for the undo list.
        removed(): the user wants what the form shows gone.
    """

    edited = Signal(str, object)
    removed = Signal()

    def __init__(self, title: str, removable: str = "") -> None:
        super().__init__(title)
        self.remark = muted()
        self.head.addWidget(self.remark)
        if removable:
            self.remove_button = IconButton("remove", f"Remove this {removable} (Del in the list)")
            self.remove_button.clicked.connect(self.removed)
            self.head.addWidget(self.remove_button)
        else:
            self.head.addSpacing(4)

    def add_number(self, spec: Spec, edit: Edit, read: Callable[[str], float] | None = None) -> NumberField:
        """Add a number field; `edit(job, value)` gives the job with that value."""
        field = NumberField(spec, read)
        field.committed.connect(lambda value: self.edited.emit(f"Change {spec.name.lower()}", (field, lambda job: edit(job, value))))
        self.add_indented(field)
        return field

    def add_choice(self, name: str, field: ChoiceField | ListField, edit: Callable[[Job, object], Job]) -> None:
        """Add a choice; `edit(job, value)` gives the job with that value."""
        field.chosen.connect(lambda value: self.edited.emit(f"Change {name.lower()}", (None, lambda job: edit(job, value))))
        self.add_indented(field)


class JobForm(Form):
    """Stock, origin, heights, how drawings are joined, post and units of the NC text."""

    def __init__(self) -> None:
        super().__init__("Stock and origin")
        self.margin = self.add_number(
            Spec("Stock margin", low=0, high=10_000, tip="How far the stock reaches beyond the part on every side."),
            lambda job, v: replace(job, stock=replace(job.stock, margin=v)))
        self.thickness = self.add_number(
            Spec("Thickness", low=0.001, high=10_000, tip="Height of the stock; Z 0 is its top."),
            lambda job, v: replace(job, stock=replace(job.stock, thickness=v)))
        self.origin_xy = ListField("Origin XY", [(o, o.value.capitalize()) for o in OriginXY])
        self.add_choice("Origin XY", self.origin_xy, lambda job, v: replace(job, origin_xy=OriginXY(v)))
        self.origin_z = ListField("Origin Z", [(o, o.value.capitalize()) for o in OriginZ])
        self.add_choice("Origin Z", self.origin_z, lambda job, v: replace(job, origin_z=OriginZ(v)))
        self.safe_z = self.add_number(
            Spec("Safe Z", low=0.001, high=10_000, tip="Clearance height above the stock's top; rapids in the plane go there."),
            lambda job, v: replace(job, safe_z=v, retract_z=min(job.retract_z, v)))
        self.join = self.add_number(
            Spec("Join tolerance", low=0, high=LARGEST_JOIN, tip="Loose ends of the drawing nearer than this are joined."),
            lambda job, v: replace(job, join_tolerance=v))
        self.order = ChoiceField("Cut first", [(Order.POCKET_FIRST, "Pocket"), (Order.PATENT_1986, "Contour (1986)")])
        self.add_choice("Order", self.order, lambda job, v: in_cutting_order(replace(job, order=Order(v))))
        self._posts = post_titles()
        self.post = ListField("Post", list(self._posts.items()))
        self.add_choice("Post", self.post, lambda job, v: replace(job, post=str(v)))
        self.units = ChoiceField("NC units", [(Units.MM, "mm"), (Units.INCH, "inch")])
        self.add_choice("NC units", self.units, lambda job, v: replace(job, out_units=Units(v)))

    def show_job(self, job: Job) -> None:
        """Show the job's values."""
        self.margin.show_value(job.stock.margin)
        self.thickness.show_value(job.stock.thickness)
        self.origin_xy.show_value(job.origin_xy)
        self.origin_z.show_value(job.origin_z)
        self.safe_z.show_value(job.safe_z)
        self.join.show_value(job.join_tolerance)
        self.order.show_value(job.order)
        unknown = {} if job.post in self._posts else {job.post: f"{job.post} (unknown)"}
        self.post.set_choices(list((self._posts | unknown).items()))
        self.post.show_value(job.post)
        self.units.show_value(job.out_units)


class ToolForm(Form):
    """Number, kind, diameter, speed and feeds of one tool."""

    def __init__(self) -> None:
        super().__init__("Tool", removable="tool")
        self._number = 0
        self.number = self._add(Spec("T number", "", 1, 9999, 0, False), lambda tool, v: replace(tool, number=int(v)))
        self.kind = ListField("Kind", [(ToolKind.FLAT, "Flat end mill")])
        self.add_choice("Kind", self.kind, lambda job, v: self._edit(job, lambda tool: tool.as_kind(ToolKind(v))))
        self.diameter = self._add(Spec("Diameter", low=0.001, high=1000), lambda tool, v: replace(tool, diameter=v))
        self.flutes = self._add(Spec("Flutes", "", 1, 100, 0, False), lambda tool, v: replace(tool, flutes=int(v)))
        self.material = ListField("Feeds for", [])
        self.add_choice("Feeds", self.material, lambda job, v: self._edit(job, lambda tool: for_material(tool, str(v))))
        self.speed = self._add(Spec("Speed", "rpm", 1, 200_000, 0, False), lambda tool, v: replace(tool, spindle_speed=v))
        self.feed = self._add(Spec("Feed", "mm/min", LEAST_RATE, 100_000, 0, False), lambda tool, v: replace(tool, feed_rate=v))
        self.plunge = self._add(Spec("Plunge", "mm/min", LEAST_RATE, 100_000, 0, False), lambda tool, v: replace(tool, plunge_rate=v))

    def _add(self, spec: Spec, edit: Callable[[Tool, float], Tool]) -> NumberField:
        return self.add_number(spec, lambda job, v: self._edit(job, lambda tool: edit(tool, v)))

    def _edit(self, job: Job, edit: Callable[[Tool], Tool]) -> Job:
        return with_tool(job, self._number, edit(job.tool(self._number)))

    def show_tool(self, job: Job, number: int) -> None:
        """Show one tool of the job."""
        self._number, tool = number, job.tool(number)
        self.title.setText(f"T{number}")
        self.remark.setText(tool.label)
        kinds = dict.fromkeys((ToolKind.FLAT, tool.kind))
        self.kind.set_choices([(k, "Flat end mill" if k is ToolKind.FLAT else k.value.capitalize()) for k in kinds])
        self.kind.show_value(tool.kind)
        self.number.show_value(tool.number)
        self.diameter.show_value(tool.diameter)
        self.flutes.show_value(tool.flutes)
        self.material.set_choices([(row.material, row.material.capitalize()) for row in tool.feeds])
        self.material.show_value(material_of(tool))
        self.material.setVisible(bool(tool.feeds))
        self.speed.show_value(tool.spindle_speed)
        self.feed.show_value(tool.feed_rate)
        self.plunge.show_value(tool.plunge_rate)


def _too_wide(stepover: float, diameter: float) -> str:
    return f"Stepover is {stepover:g} mm; use more than 0 and less than the tool's diameter, {diameter:g} mm."


class OperationForm(Form):
    """Tool, depth, stepdown, stepover, stock to leave, direction of one operation.

    Signals:
        moved(way): to be cut earlier (-1) or later (1).
    """

    moved = Signal(int)

    def __init__(self) -> None:
        super().__init__("Operation", removable="operation")
        self.earlier = IconButton("up", "Cut earlier (Alt+Up in the list)")
        self.later = IconButton("down", "Cut later (Alt+Down in the list)")
        for button, way in ((self.earlier, -1), (self.later, 1)):
            button.clicked.connect(lambda _=False, w=way: self.moved.emit(w))
            self.head.insertWidget(self.head.count() - 1, button)
        self._index, self._diameter = 0, 1.0
        self.tool = ListField("Tool", [])
        self.add_choice("Tool", self.tool, lambda job, v: self._cut(job, tool=v))
        self.cut_depth = self.add_number(
            Spec("Depth", low=0.001, high=10_000, tip="From the stock's top down to the floor."), lambda job, v: self._cut(job, depth=v))
        self.stepdown = self.add_number(
            Spec("Step down", low=0.001, high=10_000, tip="Largest depth of one pass; passes are made equal."),
            lambda job, v: self._cut(job, stepdown=v))
        self.stepover = self.add_number(
            Spec("Stepover", tip="Distance between rings; mm, another unit, or per cent of the diameter."),
            lambda job, v: self._set_stepover(job, v), self._read_stepover)
        self.drawing, self.overlap = StepoverDrawing(), QLabel()
        self._picture = self._add_picture()
        self.leave = self.add_number(
            Spec("Stock to leave", low=0, high=100, tip="Metal left on the walls on purpose."),
            lambda job, v: self._cut(job, stock_to_leave=v))
        self.direction = ChoiceField("Direction", [(Direction.CLIMB, "Climb"), (Direction.CONVENTIONAL, "Conventional")])
        self.add_choice("Direction", self.direction, lambda job, v: self._cut(job, direction=v))

    def _add_picture(self) -> QWidget:
        picture = QWidget()
        row = QHBoxLayout(picture)
        row.setContentsMargins(0, 4, 0, 6)
        row.setSpacing(12)
        row.addWidget(self.drawing)
        figures = QVBoxLayout()
        figures.setSpacing(2)
        figures.addStretch(1)
        figures.addWidget(muted("Overlap"))
        figures.addWidget(self.overlap)
        figures.addStretch(1)
        row.addLayout(figures)
        row.addStretch(1)
        self.add_indented(picture)
        return picture

    def _cut(self, job: Job, **values: object) -> Job:
        return with_cut(job, self._index, replace(job.operations[self._index].cut, **values))  # type: ignore[arg-type]

    def _set_stepover(self, job: Job, value: float) -> Job:
        operation = job.operations[self._index]
        if not isinstance(operation, PocketOperation):
            return job
        return with_operation(job, self._index, replace(operation, stepover=value))

    def _read_stepover(self, text: str) -> float:
        share = text.strip().removesuffix("%")
        spec = self.stepover.spec
        value = spec.read(text) if share == text.strip() else spec.read(share) * self._diameter / 100
        if not 0 < value < self._diameter:
            raise HitofudeError(_too_wide(value, self._diameter))
        return value

    def show_operation(self, job: Job, index: int, strokes: int | None) -> None:
        """Show one operation of the job; `strokes` is what was computed for it, if it was."""
        self._index = index
        self.earlier.setEnabled(index > 0)
        self.later.setEnabled(index < len(job.operations) - 1)
        operation = job.operations[index]
        cut = operation.cut
        self.title.setText(operation_name(operation))
        self.remark.setText(counted(strokes, "stroke") if strokes is not None else "")
        choices: list[tuple[object, str]] = [(t.number, f"T{t.number}  {t.label}") for t in job.tools]
        self.tool.set_choices(choices)
        self.tool.show_value(cut.tool)
        passes = max(1, -int(-(cut.depth - 1e-9) // cut.stepdown))
        thickness = job.stock.thickness
        self.cut_depth.show_value(cut.depth, "through" if cut.depth == thickness else "")
        if cut.depth > thickness:
            self.cut_depth.refuse(f"Depth is {cut.depth:g} mm, but the stock is {thickness:g} mm thick; reduce it or take thicker stock.")
        self.stepdown.show_value(cut.stepdown, counted(passes, "pass", "passes"))
        self.leave.show_value(cut.stock_to_leave)
        self.direction.show_value(cut.direction)
        self._show_stepover(operation, next((t for t in job.tools if t.number == cut.tool), None))

    def _show_stepover(self, operation: Operation, tool: Tool | None) -> None:
        pocket = isinstance(operation, PocketOperation) and tool is not None
        self.stepover.setVisible(pocket)
        self._picture.setVisible(pocket)
        if isinstance(operation, PocketOperation) and tool is not None:
            value = stepover_of(operation, tool)
            self._diameter = tool.diameter
            self.stepover.show_value(value, f"{100 * value / tool.diameter:.1f} %")
            if value >= tool.diameter:
                self.stepover.refuse(_too_wide(value, tool.diameter))
            self.drawing.show_ratio(value / tool.diameter)
            self.overlap.setText(f"{tool.diameter - value:.3f} mm")
