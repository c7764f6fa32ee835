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
    CIRCLE = "circle"
    RECTANGLE = "rectangle"


class CanvasMode(Enum):
    """What is shown: the drawing to be edited, or the tool paths over it."""

    DRAW = "draw"
    PATHS = "paths"


class ColourBy(Enum):
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
    LINK = auto()
    LEAD = auto()
    RAPID = auto()
    PLUNGE = auto()
    LEFT = auto()
    UNREACHABLE = auto()
    CLAMP = auto()
    ALL = PART | REGION | POCKET | REST | CONTOUR | LINK | LEAD | RAPID | PLUNGE | LEFT | UNREACHABLE | CLAMP
