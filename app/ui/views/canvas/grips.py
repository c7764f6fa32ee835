"""Grips of what is selected, and the tools that hold them: one pulls a grip, one carries the whole selection."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from ....drafting.commands.grips import Grip, grip_position, grips, note_grips
from ....drafting.commands.select import reachable
from ....drafting.difference import DrawingDifference
from ....drafting.document import Document
from ....drafting.expressions.words import ids_text, point_text
from ....model.curves import Point
from .command_trials import CommandTrials
from .drawing_tool import DrawingTool, ToolPreview, length_label
from .snapped_point import tidy

GRIP_PX = 7.0
_MOST = 200


class Grips:
    """The grips of a document's selection.

    Attributes:
        points: where they are, mm, each place once.
    """

    def __init__(self) -> None:
        """Begin without any."""
        self.points: tuple[Point, ...] = ()

    def update(self, document: Document, shown: bool) -> None:
        """Take over a document's selection; one of more than 200 has none, nor have hidden and locked layers, nor has
        any unless shown.
        """
        chosen, part = document.selection, document.part
        found: list[Grip] = []
        if shown and 0 < len(chosen) <= _MOST:
            shut = {layer.name for layer in part.layers if not layer.visible or layer.locked}
            found = [grip for e in reachable(part) if e.id in chosen for grip in grips(e.curve)]
            found += [
                grip for n in part.notes if n.id in chosen and n.layer not in shut for grip in note_grips(n.shape)
            ]
        self.points = tuple({(round(x, 6), round(y, 6)): (x, y) for x, y in (grip.at for grip in found)}.values())

    def at(self, point: Point, reach: float) -> Point | None:
        """Return the grip within `reach` mm of a point, or None."""
        nearest = min(self.points, key=lambda grip: math.dist(grip, point), default=None)
        return nearest if nearest is not None and math.dist(nearest, point) <= reach else None


@dataclass
class DragTool(DrawingTool):
    """A tool that is in hand until one point is given."""

    prompts = ("", "")

    @property
    def anchors(self) -> list[Point]:
        """Nothing: the point it comes from is no aim."""
        return []

    def back(self) -> str | None:
        """Let go."""
        return self.finish()

    def show(self, cursor: Point) -> ToolPreview:
        """Return how far it goes across and up."""
        dx, dy = cursor[0] - self.points[0][0], cursor[1] - self.points[0][1]
        if not dx and not dy:
            return ToolPreview()
        return ToolPreview(label=f"dx {length_label(dx, self.unit)}   dy {length_label(dy, self.unit)}")


@dataclass
class GripDragTool(DragTool):
    """A grip in hand."""

    trials: CommandTrials | None = None
    ids: frozenset[int] = frozenset()

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return "Pull: where to; a point, a length towards the mouse, or @dx,dy; Esc gives up"

    def line(self, points: list[Point]) -> str:
        """Return `pull CURVES P to P`."""
        return f"pull {ids_text(self.ids)} {point_text(points[0])} to {point_text(points[1])}"

    def show(self, cursor: Point) -> ToolPreview:
        """Return what the curves would become, where they would be curves."""
        made = (
            self.trials.of(self.line([self.points[0], cursor])).difference
            if self.trials is not None
            else DrawingDifference()
        )
        return replace(super().show(cursor), trial=replace(made, gone=()))


@dataclass
class SelectionDragTool(DragTool):
    """The selection in hand; what is carried with Ctrl is a copy."""

    keep: bool = False

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return (
            f"{'Copy' if self.keep else 'Move'}: where to; Ctrl copies; a length towards the mouse, or @dx,dy; Esc "
            "gives up"
        )

    def line(self, points: list[Point]) -> str:
        """Return `move @dx,dy` or `copy @dx,dy`."""
        return f"{'copy' if self.keep else 'move'} @{point_text(self.shift(points[1]))}"

    def shift(self, cursor: Point) -> Point:
        """Return how far the selection goes with the mouse at a point, mm."""
        return tidy((cursor[0] - self.points[0][0], cursor[1] - self.points[0][1]))


def pull_tool(document: Document, at: Point) -> GripDragTool:
    """Return the tool that holds the grip at a point of what is selected."""
    return GripDragTool([at], CommandTrials(document), grip_position(document.part, document.selection, at))
