"""The form of a tool: number, kind, shape, speed and feeds, and the chip load that they make."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from PySide6.QtWidgets import QLabel

from ...model.fields import declared_of
from ...model.job import Job
from ...model.tool import LEAST_RATE, Tool, ToolMaterial
from ...model.tool_kind import ToolKind, shape_keys, tool_kind
from ..framework.fields import ListField, NumberField, NumberSpec
from ..framework.form import FormSection
from .changes import for_material, material_of, with_tool
from .feed_proposal_group import FeedProposalGroup
from .tool_assembly_group import ToolAssemblyGroup
from .tool_kinds import listed_kinds

_EDGES = declared_of(Tool)["tool_material"].parameter.choices


class ToolForm(FormSection):
    """Number, kind, shape, speed, feeds and holder of one tool."""

    def __init__(self) -> None:
        super().__init__("Tool", removable="tool")
        self._number = 0
        self.number = self._add(
            NumberSpec("T number", "", 1, 9999, 0, False), lambda tool, v: replace(tool, number=int(v))
        )
        self.kind = ListField("Kind", [(kind, kind.title) for kind in listed_kinds()])
        self.add_choice("Kind", self.kind, lambda job, v: self._edit(job, lambda tool: _as_kind(tool, tool_kind(v))))
        self.diameter = self._add(
            NumberSpec("Diameter", low=0.001, high=1000), lambda tool, v: replace(tool, diameter=v)
        )
        self.corner = self._add(
            NumberSpec("Corner radius", low=0, high=1000), lambda tool, v: replace(tool, corner_radius=v)
        )
        self.angle = self._add(
            NumberSpec("Full angle", "°", 1, 179, 2, False, "Of the point, or of the cone.", "unknown"),
            lambda tool, v: replace(tool, tip_angle=math.radians(v or 0.0)),
        )
        self.tip = self._add(
            NumberSpec("Tip", low=0, high=1000, tip="Diameter of the flat at the point, or of the ball at the tip."),
            lambda tool, v: replace(tool, tip_diameter=v),
        )
        self.flutes = self._add(
            NumberSpec("Flutes", "", 1, 100, 0, False), lambda tool, v: replace(tool, flutes=int(v))
        )
        self.edges = ListField("Edges of", [(each, word) for each, word in zip(ToolMaterial, _EDGES, strict=True)])
        self.add_choice(
            "Edges",
            self.edges,
            lambda job, v: self._edit(job, lambda tool: replace(tool, tool_material=ToolMaterial(v))),
        )
        self.material = ListField("Feeds for", [])
        self.add_choice("Feeds", self.material, lambda job, v: self._edit(job, lambda tool: for_material(tool, str(v))))
        self.speed = self._add(
            NumberSpec("Speed", "rpm", 1, 200_000, 0, False), lambda tool, v: replace(tool, spindle_speed=v)
        )
        self.feed = self._add(
            NumberSpec("Feed", "mm/min", LEAST_RATE, 100_000, 0, False), lambda tool, v: replace(tool, feed_rate=v)
        )
        self.plunge = self._add(
            NumberSpec("Plunge", "mm/min", LEAST_RATE, 100_000, 0, False), lambda tool, v: replace(tool, plunge_rate=v)
        )
        self.proposal = FeedProposalGroup(self, lambda: self._number)
        self.chip = QLabel()
        self.chip.setWordWrap(True)
        self.chip.setContentsMargins(0, 4, 0, 0)
        self.chip.setProperty("role", "muted")
        self.add(self.chip)
        self.hold = ToolAssemblyGroup(self, self._edit)

    def _add(self, spec: NumberSpec, edit: Callable[[Tool, float], Tool]) -> NumberField:
        return self.add_number(spec, lambda job, v: self._edit(job, lambda tool: edit(tool, v)))

    def _edit(self, job: Job, edit: Callable[[Tool], Tool]) -> Job:
        return with_tool(job, self._number, edit(job.tool(self._number)))

    def show_tool(self, job: Job, number: int) -> None:
        """Show one tool of the job."""
        self._number, tool = number, job.tool(number)
        self.title.setText(f"T{number}")
        self.remark.setText(tool.label)
        self.kind.show_value(tool.kind)
        self.number.show_value(tool.number)
        self.diameter.show_value(tool.diameter)
        self._show_shape(tool)
        self.flutes.show_value(tool.flutes)
        self.edges.show_value(tool.tool_material)
        self.material.set_choices([(row.material, row.material.capitalize()) for row in tool.feeds])
        self.material.show_value(material_of(tool))
        self.material.setVisible(bool(tool.feeds))
        self.speed.show_value(tool.spindle_speed)
        self.feed.show_value(tool.feed_rate)
        self.plunge.show_value(tool.plunge_rate)
        self.proposal.show(job, tool)
        for field, key in ((self.speed, "spindle_speed"), (self.feed, "feed_rate"), (self.plunge, "plunge_rate")):
            field.setToolTip(self.proposal.reason(tool, key))
        self.chip.setText(chip_load_words(tool))
        self.hold.show(tool)

    def _show_shape(self, tool: Tool) -> None:
        """Show the numbers that tools of its kind have beside the diameter."""
        keys = shape_keys(tool.kind)
        for field, key in ((self.corner, "corner_radius"), (self.angle, "tip_angle"), (self.tip, "tip_diameter")):
            field.setVisible(key in keys)
        self.corner.show_value(tool.corner_radius)
        self.angle.show_value(math.degrees(tool.tip_angle) or None)
        self.tip.show_value(tool.tip_diameter)


def _as_kind(tool: Tool, kind: ToolKind) -> Tool:
    """Return the tool with another end; a point or a cone has the usual angle where the tool had none."""
    made = tool.as_kind(kind)
    return replace(made, tip_angle=made.tip_angle or kind.usual_angle)


def chip_load_words(tool: Tool) -> str:
    """Return the chip load and the surface speed of a tool, and how the load compares with its rows of feeds."""
    load = tool.feed_rate / (tool.spindle_speed * tool.flutes)
    speed = math.pi * tool.diameter * tool.spindle_speed / 1000
    said = f"Chip load {load:.4f} mm a tooth, surface speed {speed:.0f} m/min."
    loads = [row.feed_per_tooth for row in tool.feeds]
    if loads and not min(loads) / 1.5 <= load <= max(loads) * 1.5:
        side = "less" if load < min(loads) else "more"
        said += f" That is {side} than any material of this tool asks for ({min(loads):g} to {max(loads):g} mm)."
    return said
