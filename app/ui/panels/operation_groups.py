"""The groups of an operation's form that fold: fields by the parameters' declarations, and pictures and words beside
some of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from PySide6.QtCore import SignalInstance
from PySide6.QtWidgets import QPushButton, QWidget

from ...core.catalogue import catalogue
from ...model.curve_selectors import CirclesOf, ContourKind, CurveNumber, OnLayer, Selector
from ...model.entry import EntryKind, LeadKind
from ...model.fields import ParameterPlace, Unit, parameters_of
from ...model.job import Job
from ...model.operation import Operation, Side
from ...model.operation_kinds import parameters
from ...model.tool import Tool
from ..framework.catalogue import active_language, tr
from ..framework.fields import ListField
from ..framework.figures import counted
from ..framework.form import FieldGroup
from ..framework.labels import muted
from . import parameter_sketches
from .parameter_fields import ParameterField
from .sketch import SketchWidget

SPAN = " \u2013 "
BY_HAND = "Put tabs by hand"
USE_SELECTION = "Use selection"
_OF_WALLS = ("Walls", "Lead in and out")


class GroupHost(Protocol):
    """What a group needs of the form that it is in."""

    fields: dict[str, ParameterField]
    hand: QPushButton
    use: QPushButton
    tabs: SignalInstance
    selection: SignalInstance

    def begin_group(self, title: str) -> FieldGroup:
        """Begin a group: what is added next is in it."""

    def add(self, widget: QWidget) -> None:
        """Add a row."""

    def add_picture(self, picture: QWidget, *beside: QWidget) -> QWidget:
        """Add a drawing with a few words beside it."""

    def add_parameter(self, key: str) -> None:
        """Add the field of a parameter."""


@dataclass(frozen=True)
class ShownOperation:
    """What is shown: an operation, its tool where the job has it, and the job."""

    operation: Operation
    tool: Tool | None
    job: Job

    def value(self, key: str, other: Any = None) -> Any:
        """Return a parameter's value; the other one where the operation has no such parameter."""
        placed = parameters_of(type(self.operation)).get(key)
        return other if placed is None else placed.of(self.operation)


Show = Callable[[ShownOperation], None]


class OperationGroup:
    """The parameters of one group of the form."""

    def __init__(self, form: GroupHost, title: str, extra: Callable[[GroupHost], Show]) -> None:
        self.title, self.group = title, form.begin_group(title)
        self._keys = tuple(key for key, (placed, _) in parameters().items() if placed.parameter.group == title)
        for key in self._keys:
            if parameters()[key].place.parameter.unit is not Unit.POINTS:
                form.add_parameter(key)
        self._show = extra(form)

    def show(self, operation: Operation, tool: Tool | None, job: Job) -> None:
        """Show an operation's values, or hide what it does not have."""
        mine = [placed for key, placed in parameters_of(type(operation)).items() if key in self._keys]
        walls = self.title in _OF_WALLS and operation.wall_side is Side.ON
        self.group.setVisible(bool(mine) and not walls)
        self._show(ShownOperation(operation, tool, job))
        words = ""
        for placed in mine:
            if placed.has_effect(operation) and (word := _words(placed, operation)):
                comma = "," if words and placed.parameter.unit is not Unit.ANGLE else ""
                words = f"{words}{comma} {word}".strip()
        self.group.say(words or _AS_USUAL.get(self.title, "as usual"))


_AS_USUAL = {"Floor": "to depth", "Walls": "to size", "Tabs": "none", "Feed and layers": "all curves"}


def _words(placed: ParameterPlace, operation: Operation) -> str:
    """Return a parameter in a few words; nothing where it has its default, but for choices."""
    declared, value = placed.parameter, placed.of(operation)
    if placed.enum is not None:
        return str(value.value)
    if value == placed.default:
        return f"{declared.shown(value):g}°" if declared.unit is Unit.ANGLE else ""
    name = (declared.short or declared.label).lower()
    match declared.unit:
        case Unit.FLAG:
            return declared.choices[bool(value)].lower() if declared.choices else name
        case Unit.ANGLE:
            return f"{declared.shown(value):g}°"
        case Unit.CURVES:
            return curve_words(value)
        case Unit.POINTS:
            return f"{len(value)} by hand"
        case Unit.COUNT:
            return f"{value} {name}"
        case _:
            return f"{name} {declared.shown(value):g}{declared.sign}"


def curve_words(selectors: Sequence[Selector]) -> str:
    """Return which curves an operation machines as a person says it, not as a job file does; several in the window's
    language, whose catalogue has entries for each alone.
    """
    numbers = [each for each in selectors if isinstance(each, CurveNumber)]
    if len(numbers) < 2:
        return _listed([_selector_words(each) for each in selectors])
    rest = [_selector_words(each) for each in selectors if not isinstance(each, CurveNumber)]
    return _listed([*rest, counted(len(numbers), "curve")])


def _listed(names: Sequence[str]) -> str:
    if len(names) < 2 or active_language() == "en":
        return ", ".join(names)
    return catalogue(active_language()).joined([tr(name) for name in names])


def _selector_words(selector: Selector) -> str:
    if isinstance(selector, CirclesOf):
        ends = dict.fromkeys((selector.least, selector.most))
        return f"Ø {SPAN.join(f'{each:g}' for each in ends)} mm"
    if isinstance(selector, ContourKind):
        return _PLACES[selector].lower()
    return selector.words if isinstance(selector, OnLayer) else f"curve {selector.number}"


def _floor(form: GroupHost) -> Show:
    picture = SketchWidget(parameter_sketches.passes, "Passes down to the floor")
    form.add_picture(picture)

    def show(shown: ShownOperation) -> None:
        cut = shown.operation.cut
        picture.show_values(cut.depth, cut.stepdown, cut.finish_depth, cut.floor_to_leave)

    return show


def _entry(form: GroupHost) -> Show:
    picture = SketchWidget(parameter_sketches.entry, "The way down into metal")
    form.add_picture(picture, muted("What does not fit falls back, and is told."))

    def show(shown: ShownOperation) -> None:
        entry = shown.operation.cut.entry
        picture.show_values(list(EntryKind).index(entry.kind), math.degrees(entry.angle))

    return show


def _walls(form: GroupHost) -> Show:
    picture, corner = (
        SketchWidget(parameter_sketches.wall, "What stays on the wall"),
        SketchWidget(parameter_sketches.dog_bone, "An inner corner"),
    )
    form.add_picture(picture)
    corner_row = form.add_picture(corner)

    def show(shown: ShownOperation) -> None:
        bones = shown.value("dog_bones")
        diameter = shown.tool.diameter if shown.tool else 1.0
        picture.show_values(shown.operation.cut.stock_to_leave, shown.value("finish_width", 0.0), diameter)
        corner_row.setVisible(bones is not None)
        corner.show_values(float(bones or 0.0))

    return show


def _lead(form: GroupHost) -> Show:
    picture = SketchWidget(parameter_sketches.lead, "The way to the wall")
    form.add_picture(picture)

    def show(shown: ShownOperation) -> None:
        kind, diameter = shown.value("lead"), shown.tool.diameter if shown.tool else 1.0
        if kind is not None:
            given = shown.value("lead_radius")
            radius = diameter / 2 if given is None else given
            picture.show_values(list(LeadKind).index(kind), radius / diameter, shown.value("lead_overlap") / diameter)

    return show


def _tabs(form: GroupHost) -> Show:
    picture, words = SketchWidget(parameter_sketches.tab, "A tab"), muted()
    form.add_picture(picture, words)
    form.hand = QPushButton(BY_HAND)
    form.hand.setToolTip(
        "Click beside a contour to put a tab; drag a tab to move it, click it to take it away; Esc ends."
    )
    form.hand.clicked.connect(form.tabs)
    form.add(form.hand)

    def show(shown: ShownOperation) -> None:
        places = shown.value("tab_places", ())
        picture.show_values(
            shown.value("tab_width", 0.0),
            shown.value("tab_height", 0.0),
            shown.operation.cut.depth,
            shown.value("tabs", 0) + len(places),
        )
        words.setText(f"{len(places)} by hand" if places else "")

    return show


_PLACES = {ContourKind.OUTER: "Outer contours", ContourKind.INNER: "Inner contours", ContourKind.OPEN: "Open lines"}


def _curves(form: GroupHost) -> Show:
    """Offer the layers of the drawing, curves by where they lie, and those that are selected."""
    form.use = QPushButton(USE_SELECTION)
    form.use.setToolTip("Machine the curves that are selected in Draw, and no others")
    form.use.clicked.connect(form.selection)
    form.add(form.use)

    def show(shown: ShownOperation) -> None:
        field, own = form.fields["curves"].field, shown.operation.cut.curves
        assert isinstance(field, ListField)
        choices: list[tuple[object, str]] = [
            ((), "All of the job"),
            *(((OnLayer(layer.name),), layer.name) for layer in shown.job.part.layers),
            *(((each,), _PLACES[each]) for each in ContourKind),
        ]
        if own not in [value for value, _ in choices]:
            choices.append((own, curve_words(own)))
        field.set_choices(choices)
        field.show_value(own)

    return show


def nothing_beside(form: GroupHost) -> Show:
    """Add nothing beside the fields."""
    return lambda shown: None


EXTRAS: dict[str, Callable[[GroupHost], Show]] = {
    "Floor": _floor,
    "Entry": _entry,
    "Walls": _walls,
    "Lead in and out": _lead,
    "Tabs": _tabs,
    "Feed and layers": _curves,
}
"""By title: what a group has beside its fields."""
