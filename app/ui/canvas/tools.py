"""The table of drawing tools."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from app.edit.shapes import rectangle
from app.edit.words import point_text
from app.model.curves import Point
from app.ui.canvas.chain_tools import LineTool, PolylineTool
from app.ui.canvas.drawing_tool import DrawingTool, Preview
from app.ui.canvas.modes import CanvasTool
from app.ui.canvas.round_tools import ArcCentreTool, ArcThreeTool, CircleTool


@dataclass
class RectangleTool(DrawingTool):
    """Two opposite corners."""

    name = "Rectangle"
    prompts = ("first corner", "opposite corner, or @width,height")

    def number(self, value: float, cursor: Point) -> Point | None:
        """Return nothing: one number is no rectangle."""
        return None

    def held_straight(self, cursor: Point) -> Point:
        """Return the corner of a square."""
        if self.base is None:
            return cursor
        dx, dy = cursor[0] - self.base[0], cursor[1] - self.base[1]
        side = max(abs(dx), abs(dy))
        return (self.base[0] + math.copysign(side, dx), self.base[1] + math.copysign(side, dy))

    def line(self, points: list[Point]) -> str:
        """Return `rect a b`."""
        return f"rect {point_text(points[0])} {point_text(points[1])}"

    def show(self, cursor: Point) -> Preview:
        """Return the rectangle with width and height."""
        (x, y) = self.points[0]
        return Preview(rectangle(self.points[0], cursor), label=f"{abs(cursor[0] - x):.3f} \u00d7 {abs(cursor[1] - y):.3f}")


TOOLS: dict[CanvasTool, Callable[[], DrawingTool]] = {
    CanvasTool.LINE: LineTool, CanvasTool.POLYLINE: PolylineTool, CanvasTool.ARC_CENTRE: ArcCentreTool,
    CanvasTool.ARC_THREE: ArcThreeTool, CanvasTool.CIRCLE: CircleTool, CanvasTool.RECTANGLE: RectangleTool,
}
"""Every drawing tool; SELECT is the absence of one."""

TOOL_WORDS = {"line": CanvasTool.LINE, "polyline": CanvasTool.POLYLINE, "arc": CanvasTool.ARC_THREE, "circle": CanvasTool.CIRCLE,
              "rect": CanvasTool.RECTANGLE, "select": CanvasTool.SELECT}
"""Tools that a command word alone begins."""
