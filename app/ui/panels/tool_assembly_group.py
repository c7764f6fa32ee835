"""How a tool is held, in its form: flutes, shank, stick-out and holder, with a drawing of the assembly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...formats.tools.holders import name_of_outline, named_holders
from ...model.job import Job
from ...model.tool import MOST_LENGTH, HolderPoint, Tool
from ..framework.fields import ListField, NumberSpec
from ..framework.form import FormSection
from ..framework.labels import muted
from . import parameter_sketches
from .sketch import SketchWidget

Outline = tuple[HolderPoint, ...]
EditTool = Callable[[Job, Callable[[Tool], Tool]], Job]

UNKNOWN, OWN = "Not known", "Its own outline"


class ToolAssemblyGroup:
    """The part of a tool that does not cut."""

    def __init__(self, form: FormSection, edit: EditTool) -> None:
        """Add the group to a form; `edit(job, change)` gives the job with the form's tool changed."""
        self.group = form.begin_group("Shank and holder")
        flutes, shank, out = (
            (name, f"{tip} Empty: not known, and not looked at.")
            for name, tip in (
                ("Flute length", "From the tip to where the tool no longer cuts."),
                ("Shank", "Diameter above the flutes."),
                ("Stick-out", "From the tip to the holder's lower face."),
            )
        )
        self.flutes = form.add_number(
            _length(*flutes), lambda job, v: edit(job, lambda tool: replace(tool, flute_length=v or 0.0))
        )
        self.shank = form.add_number(
            _length(*shank), lambda job, v: edit(job, lambda tool: replace(tool, shank_diameter=v or 0.0))
        )
        self.stick_out = form.add_number(
            _length(*out), lambda job, v: edit(job, lambda tool: replace(tool, stick_out=v or 0.0))
        )
        self.holder = ListField("Holder", [])
        form.add_choice("Holder", self.holder, lambda job, v: edit(job, lambda tool: replace(tool, holder=_outline(v))))
        self.picture, self.words = SketchWidget(parameter_sketches.assembly, "The tool in its holder"), muted()
        form.add_picture(self.picture, self.words)

    def show(self, tool: Tool) -> None:
        """Show a tool's values."""
        self.flutes.show_value(tool.flute_length or None)
        self.shank.show_value(tool.shank_diameter or None)
        self.stick_out.show_value(tool.stick_out or None)
        name = name_of_outline(tool.holder)
        choices: list[tuple[object, str]] = [((), UNKNOWN), *((each.outline, each.name) for each in named_holders())]
        self.holder.set_choices(choices + ([(tool.holder, OWN)] if tool.holder and not name else []))
        self.holder.show_value(tool.holder)
        self.picture.show_values(
            tool.diameter,
            tool.flute_length,
            tool.shank_diameter,
            tool.stick_out,
            *(value for point in tool.holder for value in point),
        )
        self.words.setText(_words(tool))
        out = f", {tool.stick_out:g} mm out" if tool.stick_out else ""
        self.group.say(f"{name or OWN.lower()}{out}" if tool.holder else "holder not known")


def _length(name: str, tip: str) -> NumberSpec:
    return NumberSpec(name, low=0.0, high=MOST_LENGTH - 1, tip=tip, auto="unknown")


def _outline(value: object) -> Outline:
    assert isinstance(value, tuple)
    return value


def _words(tool: Tool) -> str:
    """Return what a cut will look at."""
    if tool.holder and not tool.stick_out:
        return "Tell the stick-out too; until then no cut looks for the holder in metal."
    if tool.holder:
        return "Cut tells where the holder goes into metal, and how far the tool must stick out."
    return "Choose a holder, and Cut tells where it goes into metal."
