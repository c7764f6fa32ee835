"""Where the mouse aims: from a screen position to the point that a click gives."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from app.model.curves import Point
from app.ui.canvas.drawing_tool import DrawingTool
from app.ui.canvas.snap import Snap, SnapKind, SnapPoints, nearest, to_grid

REACH_PX = 10.0


@dataclass(frozen=True, slots=True)
class AimRules:
    """What helps to aim.

    Attributes:
        snap: to points of the drawing. grid: to the raster. straight: only across or up from the point before.
        grid_step: mm. scale: px per mm.
    """

    snap: bool
    grid: bool
    straight: bool
    grid_step: float
    scale: float


@dataclass(frozen=True, slots=True)
class Aim:
    """The point that a click gives, mm, and what it has snapped to."""

    point: Point
    snap: Snap | None = None


def aim(at: Point, tool: DrawingTool, snaps: SnapPoints, rules: AimRules) -> Aim:
    """Return where a running tool aims with the mouse at a point, mm.

    Points of the drawing win over straightness, straightness over the raster; a free point is rounded to the decimal
    below the size of a screen px, so that lines in the log stay short.
    """
    if rules.snap:
        found = nearest(_with_anchors(snaps, tool), at, REACH_PX / rules.scale)
        if found is not None:
            return Aim(found.point, found)
    point = to_grid(at, rules.grid_step) if rules.grid else rounded(at, rules.scale)
    if rules.straight:
        point = tool.held_straight(point)
    return Aim(point, Snap(point, SnapKind.GRID) if rules.grid else None)


def rounded(at: Point, scale: float) -> Point:
    """Return a point rounded to the power of ten below the size of a screen px, at most 0.1 mm."""
    digits = max(1, math.ceil(math.log10(scale) - 1e-9))
    return (round(at[0], digits) + 0.0, round(at[1], digits) + 0.0)


def _with_anchors(snaps: SnapPoints, tool: DrawingTool) -> SnapPoints:
    anchors = [p for p in tool.anchors if p != tool.base]
    if not anchors:
        return snaps
    own = SnapPoints(np.array(anchors), np.full(len(anchors), SnapKind.END, np.uint8))
    return SnapPoints.joined([snaps, own])
