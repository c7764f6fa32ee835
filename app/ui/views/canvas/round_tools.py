"""Tools that draw round a centre or through points: arcs and circle."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....core.tolerances import WELD
from ....drafting.curves.shapes import arc_about, arc_through, circle, on_circle
from ....drafting.expressions.words import number_text, point_text
from ....model.curves import Arc, Line, Point
from .drawing_tool import DrawingTool, ToolPreview, arc_label
from .value_boxes import PLACE, RADIUS, SPAN, PointBoxes, ValueBox, sweep


@dataclass
class ArcCentreTool(DrawingTool):
    """Centre, start, end; the arc turns the way the mouse went round."""

    turn: float = 0.0
    seen: float | None = None
    name = "Arc"
    prompts = ("centre", "start point", "end point")
    asked = (PLACE, SPAN.named("Radius"))

    @property
    def boxes(self) -> PointBoxes | ValueBox | None:
        """Place, radius and direction, then how far it goes round."""
        return sweep(self.points[0], self.points[1], self.turn) if len(self.points) == 2 else super().boxes

    def follow(self, cursor: Point) -> None:
        """Add up how far the mouse has gone round the centre since the start, radians."""
        if len(self.points) != 2:
            self.turn, self.seen = 0.0, None
            return
        (x, y), start = self.points
        here = math.atan2(cursor[1] - y, cursor[0] - x)
        before = math.atan2(start[1] - y, start[0] - x) if self.seen is None else self.seen
        step = math.remainder(here - before, math.tau)
        total = self.turn + step
        self.turn, self.seen = (total if abs(total) < math.tau else math.remainder(total, math.tau)), here

    def line(self, points: list[Point]) -> str:
        """Return `arc start end centre c [cw]`, the end brought onto the circle."""
        arc = self._arc(points)
        return f"arc {point_text(arc.start)} {point_text(arc.end)} centre {point_text(points[0])}" + (
            "" if arc.ccw else " cw"
        )

    def show(self, cursor: Point) -> ToolPreview:
        """Return the radius, then the arc."""
        spokes = tuple(Line(self.points[0], p) for p in (*self.points[1:], cursor))
        if len(self.points) == 1:
            return ToolPreview(helpers=spokes)
        return ToolPreview((self._arc([*self.points, cursor]),), spokes)

    def _arc(self, points: list[Point]) -> Arc:
        centre, start, towards = points
        radius = math.dist(centre, start)
        end = towards if abs(math.dist(centre, towards) - radius) < WELD else on_circle(towards, centre, radius)
        return arc_about(start, _round(end) if end is not towards else end, centre, ccw=self.turn >= 0)


@dataclass
class ArcThreeTool(DrawingTool):
    """Start, a point on the way, end."""

    name = "Arc"
    prompts = ("start point", "a point on the arc", "end point")

    def line(self, points: list[Point]) -> str:
        """Return `arc start via end`."""
        return " ".join(["arc", *map(point_text, points)])

    def show(self, cursor: Point) -> ToolPreview:
        """Return the chord, then the arc."""
        if len(self.points) == 1:
            return ToolPreview(helpers=(Line(self.points[0], cursor),))
        arc = arc_through(self.points[0], self.points[1], cursor)
        return ToolPreview((arc,), label=arc_label(arc, self.unit))


@dataclass
class CircleTool(DrawingTool):
    """Centre, then radius by a point or a number."""

    name = "Circle"
    prompts = ("centre", "radius, or a point on the circle")
    asked = (PLACE, RADIUS)

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return a point at the typed radius; any direction will do."""
        return (self.points[0][0] + value, self.points[0][1]) if self.points else None

    def line(self, points: list[Point]) -> str:
        """Return `circle centre r`."""
        return f"circle {point_text(points[0])} {number_text(round(math.dist(*points), 6))}"

    def show(self, cursor: Point) -> ToolPreview:
        """Return the circle and its radius."""
        (centre,) = self.points
        return ToolPreview((circle(centre, math.dist(centre, cursor)),), (Line(centre, cursor),))


def _round(point: Point) -> Point:
    return (round(point[0], 6) + 0.0, round(point[1], 6) + 0.0)
