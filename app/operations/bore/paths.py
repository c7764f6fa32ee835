"""Boring: down on a helix, once round at the floor, then a finishing turn at the full width, in and out on half
circles.

A mill of radius r whose centre goes round at R clears the ring from R - r to R + r. So the first helix is no wider than
r, that no core stays, and each one after it at most r wider than the one before.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...core.progress import Progress
from ...model.hole_operations import BoreOperation
from ...model.moves import Purpose
from ...model.operation import Direction
from ...toolpath.build import MovesBuilder, Stroke, StrokeLabel
from ...toolpath.operation_context import OperationContext
from ..helix import HelixRows, half_circle, helix
from ..holes import HoleVerb, holes_in_order, out_of_hole, over_hole

VERB = HoleVerb("bore", "bores", "bored", "mill", "no wider than the mill")

_MOST_TURNS = 500
"""Of a helix; a narrower one goes down steeper."""

_OVERLAP = 0.9
"""Of the mill's radius: how much wider one helix is than the one before, so that rounding leaves no ridge between."""


@dataclass(frozen=True)
class BoreWays:
    """The radii of the ways of a mill's centre in one bore, mm.

    Attributes:
        helices: from the narrowest to the widest, each down to the floor.
        finish: of the last turn, at the floor; None = the widest helix leaves nothing.
    """

    helices: tuple[float, ...]
    finish: float | None


def ways_of(widest: float, radius: float, finish_width: float) -> BoreWays:
    """Return the ways in a bore.

    Args:
        widest: radius of the way along the wall, mm, > 0. radius: of the mill, mm.
        finish_width: metal for the last turn, mm; as much of it as there is room for.
    """
    rough = max(widest - finish_width, widest / 2) if finish_width else widest
    count = max(1, math.ceil(rough / (_OVERLAP * radius) - 1e-9))
    return BoreWays(tuple(rough * (k + 1) / count for k in range(count)), widest if finish_width else None)


def bore(context: OperationContext, index: int, progress: Progress) -> None:
    """Bore every circle that is wider than the mill.

    Raises:
        ParameterError: it is deeper than the stock.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, BoreOperation)
    tool, cut = job.tool(operation.cut.tool), operation.cut
    bottom, ccw = -(cut.floor + operation.beyond), cut.direction is Direction.CLIMB
    for hole, label in holes_in_order(context, index, VERB, progress):
        widest = operation.made(hole.diameter, tool) / 2 - cut.stock_to_leave - tool.radius
        writer = _BoreWriter(context.builder, label, (hole.x, hole.y), ccw)
        ways = ways_of(widest, tool.radius, operation.finish_width)
        over_hole(context, (hole.x + ways.helices[0], hole.y), label)
        for k, radius in enumerate(ways.helices):
            if k:
                writer.across(radius, job.retract_z)
            step = min(cut.stepdown, math.tau * radius * math.tan(cut.entry.angle))
            writer.down(radius, (job.retract_z, bottom), max(step, (job.retract_z - bottom) / _MOST_TURNS))
        if ways.finish is not None:
            writer.finish(ways.finish, bottom)
        context.strokes += len(ways.helices)
        out_of_hole(context, label)


@dataclass(frozen=True)
class _BoreWriter:
    """Appends the ways in one bore."""

    builder: MovesBuilder
    label: StrokeLabel
    centre: tuple[float, float]
    ccw: bool

    def down(self, radius: float, heights: tuple[float, float], step: float) -> None:
        """Go down on a helix, and once round at its foot."""
        turns = max(1, math.ceil((heights[0] - heights[1]) / step - 1e-9))
        self._along(helix(self.centre, radius, heights, turns, self.ccw), Purpose.PLUNGE)
        self._along(helix(self.centre, radius, (heights[1], heights[1]), 1, self.ccw), Purpose.POCKET)

    def across(self, radius: float, height: float) -> None:
        """Go up and over to where the next helix begins."""
        x, y, _ = self.builder.at
        self.builder.straight((x, y, height), Purpose.RAPID, self.label)
        self.builder.straight((self.centre[0] + radius, self.centre[1], height), Purpose.RAPID, self.label)

    def finish(self, radius: float, height: float) -> None:
        """Go round at the wall, with a half circle in from the middle, and one out to it."""
        x, y, _ = self.builder.at
        rows = np.array([[x, y, *self.centre, 0.0, 0.0, 0.0, 0.0]])
        self._along(HelixRows(rows, np.array([height])), Purpose.LINK)
        wall = self.centre[0] + radius, self.centre[1]
        level = height, height
        self._along(half_circle(self.centre, wall, level, self.ccw), Purpose.LEAD)
        self._along(helix(self.centre, radius, level, 1, self.ccw), Purpose.CONTOUR)
        self._along(half_circle(wall, self.centre, level, self.ccw), Purpose.LEAD)

    def _along(self, way: HelixRows, purpose: Purpose) -> None:
        stroke = Stroke(way.rows, np.full(len(way.rows), purpose, np.uint8), 0)
        if purpose is Purpose.PLUNGE:
            self.builder.ramp(stroke, way.heights, self.label)
            return
        self.builder.along(stroke, way.heights, self.label, np.full(len(way.rows), self.label.feed))
