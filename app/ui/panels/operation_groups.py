"""The groups of an operation's form that fold: depth, entry, walls, lead, tabs, feed, layers. Each knows whom it is for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from PySide6.QtWidgets import QPushButton

from ...model.entry import MOST_OVERLAP, EntryKind, LeadKind
from ...model.job import Job
from ...model.operation import ContourOperation, DrillOperation, Operation, Side
from ...model.tool import Tool
from ..framework.fields import ChoiceField, ListField, Spec
from ..framework.form import SwitchField
from ..framework.labels import muted
from . import drawings
from .pictures import Picture

if TYPE_CHECKING:
    from .operation_form import OperationForm


BY_HAND = "Put tabs by hand"


class OperationGroup(Protocol):
    """A group of fields."""

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values, or hide what it does not have."""


class DepthGroup:
    """The finish pass on the floor, and what is left on it."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Floor")
        self.finish = form.add_number(
            Spec("Finish pass", low=0, high=1000, tip="Thickness of a last pass on the floor; 0: none."),
            lambda job, v: form.with_cut(job, finish_depth=v))
        self.leave = form.add_number(
            Spec("Floor to leave", low=0, high=1000, tip="Metal left on the floor on purpose."),
            lambda job, v: form.with_cut(job, floor_to_leave=v))
        self.picture = Picture(drawings.passes, "Passes down to the floor")
        form.add_picture(self.picture)

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values."""
        cut = operation.cut
        self.group.setVisible(not isinstance(operation, DrillOperation))
        self.finish.show_value(cut.finish_depth)
        self.leave.show_value(cut.floor_to_leave)
        self.picture.show_values(cut.depth, cut.stepdown, cut.finish_depth, cut.floor_to_leave)
        words = [f"finish {cut.finish_depth:g} mm"] * (cut.finish_depth > 0)
        words += [f"leave {cut.floor_to_leave:g} mm"] * (cut.floor_to_leave > 0)
        self.group.say(", ".join(words) or "to depth")


class EntryGroup:
    """The way down."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Entry")
        self.kind = ListField("Way down", [
            (EntryKind.HELIX, "Helix, else ramp"), (EntryKind.RAMP, "Ramp along the path"), (EntryKind.PLUNGE, "Straight down"),
            (EntryKind.PREDRILLED, "Into drilled holes"),
        ])
        form.add_choice("Entry", self.kind, lambda job, v: self._with(form, job, kind=v))
        self.angle = form.add_number(
            Spec("Angle", "°", 0.06, 45, 2, False, "Of helix and ramp against the plane."),
            lambda job, v: self._with(form, job, angle=math.radians(v)))
        self.picture = Picture(drawings.entry, "The way down into metal")
        form.add_picture(self.picture, muted("What does not fit falls back, and is told."))

    def _with(self, form: OperationForm, job: Job, **values: object) -> Job:
        entry = job.operations[form.index].cut.entry
        return form.with_cut(job, entry=replace(entry, **values))  # type: ignore[arg-type]

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values."""
        entry = operation.cut.entry
        self.group.setVisible(not isinstance(operation, DrillOperation))
        self.kind.show_value(entry.kind)
        self.angle.show_value(math.degrees(entry.angle))
        self.angle.setVisible(entry.kind in (EntryKind.HELIX, EntryKind.RAMP))
        self.picture.show_values(list(EntryKind).index(entry.kind), math.degrees(entry.angle))
        slope = f" {math.degrees(entry.angle):g}°" if entry.kind in (EntryKind.HELIX, EntryKind.RAMP) else ""
        self.group.say(f"{entry.kind.value}{slope}")


class WallGroup:
    """Stock to leave; of contours finish and spring passes and dog-bones too."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Walls")
        self.leave = form.add_number(
            Spec("Stock to leave", low=0, high=100, tip="Metal left on the walls on purpose."),
            lambda job, v: form.with_cut(job, stock_to_leave=v))
        form.leave = self.leave
        self.finish = form.add_number(
            Spec("Finish width", low=0, high=100, tip="Metal that the passes leave on the wall for a finish pass; 0: none."),
            lambda job, v: form.with_values(job, finish_width=v))
        self.when = ChoiceField("Finish", [(False, "Once"), (True, "Each depth")])
        form.add_choice("Finish", self.when, lambda job, v: form.with_values(job, finish_each_pass=v))
        self.spring = form.add_number(
            Spec("Spring passes", "", 0, 10, 0, False, "Times the last pass is run again, so that a bent cutter straightens."),
            lambda job, v: form.with_values(job, spring_passes=int(v)))
        self.bones = SwitchField("Dog-bones", "The cutter goes on into inner corners, cutting into the walls, for a sharp counterpart.")
        form.add_choice("Dog-bones", self.bones, lambda job, v: form.with_values(job, dog_bones=v))
        self.picture, self.corner = Picture(drawings.wall, "What stays on the wall"), Picture(drawings.dog_bone, "An inner corner")
        form.add_picture(self.picture)
        self.corner_row = form.add_picture(self.corner)

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values."""
        contour = operation if isinstance(operation, ContourOperation) else None
        on_line = contour is not None and contour.side is Side.ON
        self.group.setVisible(not isinstance(operation, DrillOperation) and not on_line)
        self.leave.show_value(operation.cut.stock_to_leave)
        for widget in (self.finish, self.spring, self.bones, self.corner_row):
            widget.setVisible(contour is not None)
        self.when.setVisible(contour is not None and contour.finish_width > 0)
        width = contour.finish_width if contour else 0.0
        self.picture.show_values(operation.cut.stock_to_leave, width, tool.diameter if tool else 1.0)
        words = [f"leave {operation.cut.stock_to_leave:g} mm"] * (operation.cut.stock_to_leave > 0)
        if contour:
            self.finish.show_value(width)
            self.when.show_value(contour.finish_each_pass)
            self.spring.show_value(contour.spring_passes)
            self.bones.show_value(contour.dog_bones)
            self.corner.show_values(float(contour.dog_bones))
            words += [f"finish {width:g} mm"] * (width > 0) + ["spring"] * (contour.spring_passes > 0) + ["dog-bones"] * contour.dog_bones
        self.group.say(", ".join(words) or "to size")


class LeadGroup:
    """How a contour comes to its wall."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Lead in and out")
        self.kind = ChoiceField("Lead", [(LeadKind.ARC, "Arc"), (LeadKind.LINE, "Line"), (LeadKind.NONE, "None")])
        form.add_choice("Lead", self.kind, lambda job, v: self._with(form, job, kind=v))
        self.radius = form.add_number(
            Spec("Radius", low=0.001, high=1000, auto="auto", tip="Of the arc, or length of the line; empty: half the diameter."),
            lambda job, v: self._with(form, job, radius=v))
        self.overlap = form.add_number(
            Spec("Overlap", low=0, high=MOST_OVERLAP, tip="How far the path goes on over its beginning before it leaves."),
            lambda job, v: self._with(form, job, overlap=v))
        self.picture = Picture(drawings.lead, "The way to the wall")
        form.add_picture(self.picture)

    def _with(self, form: OperationForm, job: Job, **values: object) -> Job:
        operation = job.operations[form.index]
        assert isinstance(operation, ContourOperation)
        return form.with_values(job, lead=replace(operation.lead, **values))  # type: ignore[arg-type]

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show a contour's values."""
        if not isinstance(operation, ContourOperation) or operation.side is Side.ON:
            self.group.hide()
            return
        self.group.show()
        lead, diameter = operation.lead, tool.diameter if tool else 1.0
        radius = diameter / 2 if lead.radius is None else lead.radius
        self.kind.show_value(lead.kind)
        self.radius.show_value(lead.radius, f"{radius:g} mm" if lead.radius is None else "")
        self.radius.setVisible(lead.kind is not LeadKind.NONE)
        self.overlap.show_value(lead.overlap)
        self.picture.show_values(list(LeadKind).index(lead.kind), radius / diameter, lead.overlap / diameter)
        self.group.say(lead.kind.value if lead.kind is LeadKind.NONE else f"{lead.kind.value} {radius:g} mm")


class TabGroup:
    """Tabs of a contour."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Tabs")
        self.count = form.add_number(
            Spec("Each contour", "", 0, 100, 0, False, "Tabs spread evenly along every contour."),
            lambda job, v: self._with(form, job, count=int(v)))
        self.width = form.add_number(
            Spec("Width", low=0.1, high=1000, tip="Of the metal that stands."), lambda job, v: self._with(form, job, width=v))
        self.height = form.add_number(
            Spec("Height", low=0.01, high=1000, tip="Of the metal that stands, above the floor."),
            lambda job, v: self._with(form, job, height=v))
        self.picture, self.words = Picture(drawings.tab, "A tab"), muted()
        form.add_picture(self.picture, self.words)
        form.hand = QPushButton(BY_HAND)
        form.hand.setToolTip("Click beside a contour to put a tab, on a tab to take it away; Esc ends.")
        form.hand.clicked.connect(form.tabs)
        form.add(form.hand)

    def _with(self, form: OperationForm, job: Job, **values: object) -> Job:
        operation = job.operations[form.index]
        assert isinstance(operation, ContourOperation)
        return form.with_values(job, tabs=replace(operation.tabs, **values))  # type: ignore[arg-type]

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show a contour's values."""
        self.group.setVisible(isinstance(operation, ContourOperation))
        if not isinstance(operation, ContourOperation):
            return
        tabs = operation.tabs
        self.count.show_value(tabs.count)
        self.width.show_value(tabs.width)
        self.height.show_value(tabs.height)
        self.picture.show_values(tabs.width, tabs.height, operation.cut.depth, tabs.count + len(tabs.places))
        self.words.setText(f"{len(tabs.places)} by hand" if tabs.places else "")
        said = [f"{tabs.count} each"] * (tabs.count > 0) + [f"{len(tabs.places)} by hand"] * bool(tabs.places)
        self.group.say(", ".join(said) or "none")


class FeedGroup:
    """The engagement beyond which the feed is slowed, and the layers that are machined."""

    def __init__(self, form: OperationForm) -> None:
        self.group = form.begin_group("Feed and layers")
        self.engaged = form.add_number(
            Spec("Slow beyond", "%", 5, 100, 0, False, "Of the diameter engaged: the feed is slowed where more is; 100: never."),
            lambda job, v: form.with_values(job, most_engaged=v / 100))
        self.layers = ListField("Layers", [])
        form.add_choice("Layers", self.layers, lambda job, v: form.with_cut(job, layers=v))

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values."""
        share = 1.0 if isinstance(operation, DrillOperation) else operation.most_engaged
        self.engaged.setVisible(not isinstance(operation, DrillOperation))
        self.engaged.show_value(100 * share)
        own = operation.cut.layers
        choices: list[tuple[object, str]] = [((), "All of the job"), *(((layer.name,), layer.name) for layer in job.part.layers)]
        if own not in [value for value, _ in choices]:
            choices.append((own, ", ".join(own)))
        self.layers.set_choices(choices)
        self.layers.show_value(own)
        words = [f"slowed beyond {100 * share:g} %"] * (share < 1) + [", ".join(own)] * bool(own)
        self.group.say(", ".join(words) or "all layers")


GROUPS: tuple[Callable[[OperationForm], OperationGroup], ...] = (DepthGroup, EntryGroup, WallGroup, LeadGroup, TabGroup, FeedGroup)
