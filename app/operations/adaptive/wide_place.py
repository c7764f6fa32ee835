"""The wide place of a part: where there is room for the arcs in which a cutter turns along walls (`wide`)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ...core.progress import Progress
from ...geometry.offset.offset import Ring, offset_levels
from ...geometry.primitives import Primitives, Rows, sample
from .axis import RoughAxis
from .cleared_discs import ClearedDisc, WallClearance
from .front import MetalFront
from .limit import EngagementLimit
from .link import PathPose
from .ring import rounded
from .walk import AxisTree
from .wall_path import WallPath
from .wide import WayWorth, WideClearing

Floats = NDArray[np.float64]

_TURN = 2 / 3
"""Of the cutter's radius: that of the arcs in which it turns along walls."""

_CHORD = 1e-3
"""mm between a wall and its chords, and by as much the outline is grown beyond them."""

_BESIDE = 0.1
"""Radii of the cutter that metal may be farther than the cutter is in a disc, and still be of that disc."""

_WORTH = 0.1
"""Radii of the cutter by which the farthest disc must stick out of the first one."""


@dataclass(frozen=True, eq=False)
class WidePlace:
    """How a wide place is cleared.

    Attributes:
        rows: (n, 8) from the end of the first spiral on.
        clear: (n,) which of them are over clear ground.
        discs: (m,) of which points of the axis the discs are clear then, as far as walls tell.
        walls: ways along walls that the rows have gone.
        pose: in which the path is at their end.
        front: what is clear then.
    """

    rows: Rows
    clear: NDArray[np.bool_]
    discs: NDArray[np.bool_]
    walls: Sequence[WallPath]
    pose: PathPose
    front: MetalFront


@dataclass(frozen=True)
class WideStart:
    """How it begins: the limit, the disc that is clear, where the path is then, and what the rest may cost."""

    limit: EngagementLimit
    first: ClearedDisc
    pose: PathPose
    worth: WayWorth


def wide_place(
    walls: Primitives, room: WallClearance, axis: RoughAxis, start: WideStart, progress: Progress
) -> WidePlace | None:
    """Return how the wide place about a disc is cleared, None where there is none, or no such way within the limit.

    Raises:
        Cancelled: by progress.
    """
    limit, first = start.limit, start.first
    turn = _TURN * limit.radius
    (level,) = offset_levels(walls, [room.leave + limit.radius + turn])
    rings = _about(level.rings, first)
    if not rings:
        return None
    discs = (axis.reach >= limit.radius + turn) & _within(rings, axis)
    out = np.hypot(*(axis.points - first.centre).T) + axis.reach - first.reach
    if not (out[discs] > _WORTH * limit.radius).any():
        return None
    front = MetalFront(limit)
    front.add_disc(*first.centre, first.reach)
    paths = [WallPath.of(rounded(ring, turn), limit.radius) for ring in rings]
    clearing = WideClearing(limit, room, turn, paths, front, start.worth)
    end = clearing.cut(start.pose, progress)
    if end is None or not clearing.rows:
        return None
    discs &= _far_from(clearing.uncut, axis, limit.radius)
    return WidePlace(np.array(clearing.rows), np.array(clearing.clear), discs, paths, end, front)


def _far_from(uncut: Floats, axis: RoughAxis, radius: float) -> NDArray[np.bool_]:
    """Return which points of an axis have no metal, at places of the cutter along walls, where their discs touch."""
    if not len(uncut):
        return np.ones(len(axis.points), np.bool_)
    away, _ = cKDTree(uncut).query(axis.points)
    return np.asarray(away > axis.reach - radius + _BESIDE * radius)


def _about(rings: Sequence[Ring], first: ClearedDisc) -> list[Ring]:
    """Return the ring about the middle of a disc, and those of islands in it."""
    for ring in rings:
        if ring.area > 0 and _outline(ring).contains(shapely.Point(first.centre)):
            around = _outline(ring)
            inner = [each for each in rings if each.area < 0 and around.contains(shapely.Point(each.rows[0, :2]))]
            return [ring, *inner]
    return []


def _outline(ring: Ring) -> shapely.Polygon:
    return shapely.Polygon(sample(ring.rows, _CHORD)).buffer(_CHORD if ring.area > 0 else -_CHORD)


def _within(rings: Sequence[Ring], axis: RoughAxis) -> NDArray[np.bool_]:
    """Return which points of an axis lie within the first of some rings, and in none of the others."""
    x, y = axis.points.T
    inside = np.asarray(shapely.contains_xy(_outline(rings[0]), x, y))
    for ring in rings[1:]:
        inside &= ~np.asarray(shapely.contains_xy(_outline(ring), x, y))
    return inside


def swept_discs(wide: WidePlace, axis: RoughAxis, tree: AxisTree, limit: EngagementLimit) -> NDArray[np.bool_]:
    """Return of which points of the axis the discs are clear: those that others are to be paid with surely are."""
    swept = wide.discs.copy()
    for node in reversed(tree.order[1:]):
        children = tree.children(node)
        if swept[node] and not (children and swept[children].all()):
            x, y = axis.points[node].tolist()
            swept[node] = wide.front.covers((x, y, float(axis.reach[node]) - limit.slack))
    return swept
