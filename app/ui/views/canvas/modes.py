"""What the canvas can be asked to be: its tools, views and layers."""

from __future__ import annotations

from enum import Enum, Flag, auto


class CanvasTool(Enum):
    """What a click does."""

    SELECT = "select"
    LINE = "line"
    POLYLINE = "polyline"
    ARC_CENTRE = "arc_centre"
    ARC_THREE = "arc_three"
    ARC_RADIUS = "arc_radius"
    ARC_ON = "arc_on"
    CIRCLE = "circle"
    CIRCLE_TWO = "circle_two"
    CIRCLE_THREE = "circle_three"
    RECTANGLE = "rectangle"
    RECTANGLE_ROUND = "rectangle_round"
    POLYGON = "polygon"
    SLOT = "slot"
    ELLIPSE = "ellipse"
    SPLINE = "spline"
    TEXT = "text"
    POINT = "point"
    GUIDE = "guide"
    DIMENSION = "dimension"
    MEASURE = "measure"
    MOVE = "move"
    COPY = "copy"
    ROTATE = "rotate"
    SCALE = "scale"
    MIRROR = "mirror"
    ARRAY = "array"
    ARRAY_POLAR = "array_polar"
    OFFSET = "offset"
    TRIM = "trim"
    EXTEND = "extend"
    BREAK = "break"
    FILLET = "fillet"
    CHAMFER = "chamfer"
    JOIN = "join"
    EXPLODE = "explode"
    REVERSE = "reverse"


class CanvasMode(Enum):
    """What is shown: the drawing to be edited, or the tool paths over it."""

    DRAW = "draw"
    PATHS = "paths"


class PathColourBy(Enum):
    """What the colour of a tool path tells."""

    TOOL = "tool"
    REGION = "region"
    ENGAGEMENT = "engagement"


class PathLayers(Flag):
    """What the Paths view shows."""

    PART = auto()
    REGION = auto()
    POCKET = auto()
    REST = auto()
    CONTOUR = auto()
    TAB = auto()
    LINK = auto()
    LEAD = auto()
    RAPID = auto()
    PLUNGE = auto()
    LEFT = auto()
    UNREACHABLE = auto()
    CLAMP = auto()
    ALL = PART | REGION | POCKET | REST | CONTOUR | TAB | LINK | LEAD | RAPID | PLUNGE | LEFT | UNREACHABLE | CLAMP
