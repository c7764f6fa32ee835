"""Where the mouse aims: from a screen position to the point that a click gives."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ....model.curves import Point
from .drawing_tool import DrawingTool
from .neighbour_snaps import MOST, Neighbourhood, forced, neighbour_snaps
from .painting.part_layer import PartLayer
from .snap import SNAP_NAMES, USUAL, Snap, SnapKind, best, to_grid
from .tracking import AcquiredPoint, TrackedPoint, rays, tracked

REACH_PX = 10.0
ORIGIN: Point = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class SnapRules:
    """What helps to aim.

    Attributes:
        grid_step: mm. scale: px per mm.
        snap: to points of the drawing. grid: to the raster. straight: only across or up from the point before.
        kinds: of points of the drawing that count. forced: the one kind that the next click takes, or None.
        polar: degrees between rays from the point before that draw the mouse, or None.
        acquired: points that the mouse has rested on, which draw it across, up and along their lines.
    """

    grid_step: float
    scale: float
    snap: bool = True
    grid: bool = False
    straight: bool = False
    kinds: frozenset[SnapKind] = USUAL
    forced: SnapKind | None = None
    polar: float | None = None
    acquired: tuple[AcquiredPoint, ...] = ()


@dataclass(frozen=True, slots=True)
class SnappedPoint:
    """The point that a click gives, mm, and what it has snapped to."""

    point: Point
    snap: Snap | None = None
    tracked: TrackedPoint | None = field(default=None)

    @property
    def word(self) -> str:
        """What the point is called beside the mouse, or ""."""
        if self.snap is not None:
            return SNAP_NAMES[self.snap.kind]
        return self.tracked.word if self.tracked is not None else ""


def snapped_point(at: Point, tool: DrawingTool, picture: PartLayer, rules: SnapRules) -> SnappedPoint:
    """Return where a running tool aims with the mouse at a point, mm.

    Points of the drawing win over straightness, straightness over rays, rays over the raster; a free point is rounded
    to the decimal below the size of a screen px, so that lines in the log stay short.
    """
    found = _snapped(at, tool, picture, rules)
    drawn = None
    if not rules.straight and (found is None or (found.kind is SnapKind.NEAREST and rules.forced is None)):
        drawn = _drawn(at, tool, picture, rules)
    if found is not None and not (drawn is not None and drawn.crosses):
        return SnappedPoint(tidy(found.point), found)
    if drawn is not None:
        return SnappedPoint(tidy(drawn.point), tracked=drawn)
    point = to_grid(at, rules.grid_step) if rules.grid else rounded(at, rules.scale)
    if rules.straight:
        point = tool.held_straight(point)
    return SnappedPoint(point, Snap(point, SnapKind.GRID) if rules.grid else None)


def _drawn(at: Point, tool: DrawingTool, picture: PartLayer, rules: SnapRules) -> TrackedPoint | None:
    """Return where rays draw the mouse, by themselves or to where they meet a curve that may be snapped to."""
    candidates = rays(tool.base, rules.polar, rules.acquired)
    reach = REACH_PX / rules.scale
    near = (
        [*picture.near_curves(at, reach)[:MOST], *picture.near_guides(at, reach)] if candidates and rules.snap else []
    )
    return tracked(at, candidates, rules.scale, _digits(rules.scale), near)


def rounded(at: Point, scale: float) -> Point:
    """Return a point rounded to the power of ten below the size of a screen px, at most 0.1 mm."""
    digits = _digits(scale)
    return (round(at[0], digits) + 0.0, round(at[1], digits) + 0.0)


def tidy(point: Point) -> Point:
    """Return a point without the noise of its last digits: a coordinate that is a short decimal within 1e-10 mm becomes
    that.
    """
    x, y = ((short if abs((short := round(value, 6) + 0.0) - value) <= 1e-10 else value) for value in point)
    return (x, y)


def _digits(scale: float) -> int:
    return max(1, math.ceil(math.log10(scale) - 1e-9))


def _snapped(at: Point, tool: DrawingTool, picture: PartLayer, rules: SnapRules) -> Snap | None:
    if not rules.snap and rules.forced is None:
        return None
    reach = REACH_PX / rules.scale
    near = Neighbourhood(at, reach, picture.near_curves(at, reach), tool.base, picture.near_guides(at, reach))
    fixed = picture.near_points(at, reach)
    if rules.forced is not None:
        return forced(near, rules.forced, fixed)
    anchors = [Snap(p, SnapKind.END) for p in tool.anchors if p != tool.base]
    origin = [Snap(ORIGIN, SnapKind.ORIGIN)] if tool.base != ORIGIN else []
    on = [snap for snap in (*fixed, *neighbour_snaps(near, rules.kinds)) if snap.kind in rules.kinds]
    return best([*on, *anchors, *origin], at, reach)
