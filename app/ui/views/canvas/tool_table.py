"""The table of drawing tools."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ....drafting.curves.shapes import rectangle
from ....drafting.expressions.words import point_text
from ....drafting.language.language import command_word
from ....model.curves import Point
from . import corner_tools as corner
from . import edit_tools as edit
from . import form_tools as form
from .chain_tools import LineTool, PolylineTool
from .drawing_tool import DrawingTool, ToolPreview
from .modes import CanvasTool
from .round_tools import ArcCentreTool, ArcThreeTool, CircleTool
from .value_boxes import PLACE, SIZE


@dataclass
class RectangleTool(DrawingTool):
    """Two opposite corners."""

    name = "Rectangle"
    prompts = ("first corner", "opposite corner, or @width,height")
    asked = (PLACE, SIZE)

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

    def show(self, cursor: Point) -> ToolPreview:
        """Return the rectangle."""
        return ToolPreview(rectangle(self.points[0], cursor))


_ALL: dict[CanvasTool, Callable[[], DrawingTool]] = {
    CanvasTool.LINE: LineTool,
    CanvasTool.POLYLINE: PolylineTool,
    CanvasTool.ARC_CENTRE: ArcCentreTool,
    CanvasTool.ARC_THREE: ArcThreeTool,
    CanvasTool.ARC_RADIUS: form.ArcRadiusTool,
    CanvasTool.ARC_ON: form.ArcOnTool,
    CanvasTool.CIRCLE: CircleTool,
    CanvasTool.CIRCLE_TWO: form.CircleTwoTool,
    CanvasTool.CIRCLE_THREE: form.CircleThreeTool,
    CanvasTool.RECTANGLE: RectangleTool,
    CanvasTool.RECTANGLE_ROUND: form.RoundRectangleTool,
    CanvasTool.POLYGON: form.PolygonTool,
    CanvasTool.SLOT: form.SlotTool,
    CanvasTool.ELLIPSE: form.EllipseTool,
    CanvasTool.SPLINE: form.SplineTool,
    CanvasTool.TEXT: form.TextTool,
    CanvasTool.POINT: form.PointTool,
    CanvasTool.GUIDE: form.GuideTool,
    CanvasTool.DIMENSION: form.DimensionTool,
    CanvasTool.MEASURE: form.MeasureTool,
    CanvasTool.MOVE: edit.MoveTool,
    CanvasTool.COPY: edit.CopyTool,
    CanvasTool.ROTATE: edit.RotateTool,
    CanvasTool.SCALE: edit.ScaleTool,
    CanvasTool.MIRROR: edit.MirrorTool,
    CanvasTool.ARRAY: edit.ArrayTool,
    CanvasTool.ARRAY_POLAR: edit.ArrayPolarTool,
    CanvasTool.OFFSET: edit.OffsetTool,
    CanvasTool.TRIM: corner.TrimTool,
    CanvasTool.EXTEND: corner.ExtendTool,
    CanvasTool.BREAK: corner.BreakTool,
    CanvasTool.FILLET: corner.FilletTool,
    CanvasTool.CHAMFER: corner.ChamferTool,
    CanvasTool.JOIN: edit.JoinTool,
    CanvasTool.EXPLODE: edit.ExplodeTool,
    CanvasTool.REVERSE: edit.ReverseTool,
}

TOOLS = {kind: make for kind, make in _ALL.items() if command_word(kind.value.split("_")[0])}
"""Every tool whose command the language has; SELECT is the absence of one."""

_OTHER_WORDS = {"arc": CanvasTool.ARC_THREE, "rect": CanvasTool.RECTANGLE}
TOOL_WORDS = {tool.value: tool for tool in (CanvasTool.SELECT, *TOOLS)} | _OTHER_WORDS
"""Tools that a command word alone begins."""
