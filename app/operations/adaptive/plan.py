"""The path of one pass: for each connected part a spiral, discs along the axis, and the way along the walls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import OffsetLevel, Ring, offset_levels
from ...geometry.primitives import Primitives, Rows, lengths, sample
from ...toolpath.leads.contour_path import headings_at
from ...toolpath.machining_areas import BoxSides
from .axis import RoughAxis, rough_axis
from .cleared_discs import ClearedDisc, ClearedDiscs, Point, WallClearance
from .limit import EngagementLimit
from .link import PathPose
from .path_builder import CutRun, PathBuilder
from .ring import RingProof, rounded, sharp_corners
from .spiral import spiral
from .walk import AxisTree, AxisWalk, WalkStop, trees
from .wall_stretches import stretches
from .wide import WayWorth
from .wide_place import WidePlace, WideStart, swept_discs, wide_place

Floats = NDArray[np.float64]

_SPACING = 0.12
"""Radii of the cutter between points along the walls from which the axis is made."""

_TURN = 0.05
"""mm; the least radius of a path round a centre, but for the tips of corners."""

_SHARP = 0.1
"""Radians; a corner of the way along the walls that turns by less needs no arc of its own."""

_SLIVER = 0.005
"""mm; as much may stand in a corner: less than counts as left."""

_BESIDE = 0.5
"""mm beside the stock at least at which the cutter comes down, as the first turn is not quite about its centre."""

_CHORD = 1e-3
"""mm between a wall and its chords, and by as much the outline is grown."""

_SHORT, _KINK = 1e-4, 2e-3
"""mm of rows that have no direction to speak of, and radians by which the others may turn where they meet."""


@dataclass(frozen=True, eq=False)
class ConnectedPath:
    """The path of a connected part.

    Attributes:
        runs: in the order of cutting; at the beginning of the first one the cutter comes down into metal, at those of
            the others onto clear ground.
        region: number of the region.
        stops: where the area goes on, but too narrow to keep the limit in it.
        unproven: places along the walls that are not gone along: the limit could not be kept there.
    """

    runs: tuple[CutRun, ...]
    region: int
    stops: tuple[WalkStop, ...] = ()
    unproven: tuple[Point, ...] = ()

    def effort(self, faster: float) -> float:
        """Return how long it takes, as mm at the tool's feed; over clear ground the cutter is so many times faster."""
        size = [lengths(run.rows) / np.where(run.clear, faster, run.times) for run in self.runs]
        return sum(float(each.sum()) for each in size)


@dataclass(frozen=True)
class ClearingTask:
    """What is to be cleared.

    Attributes:
        walls: closed contours, the area to the left.
        leave: stock to leave on them, mm.
        farthest: mm that the cutter goes over clear ground rather than through the air.
        stock: beside which it begins, where the area goes on past its edges; None = the area does not.
        fastest: times the tool's feed at most, where less is engaged than at the limit.
        faster: times the tool's feed over clear ground.
    """

    walls: Primitives
    leave: float
    farthest: float
    stock: BoxSides | None = None
    fastest: float = 1.0
    faster: float = 4.0


def plan(task: ClearingTask, limit: EngagementLimit, progress: Progress = NO_PROGRESS) -> tuple[ConnectedPath, ...]:
    """Return the paths of all connected parts in which a cutter keeps its limit, counter-clockwise along the walls.

    Raises:
        Cancelled: by progress.
    """
    least = least_turn(limit)
    inner = task.leave + limit.radius
    (frame,) = offset_levels(task.walls, [inner + limit.least_turn], progress.part(0.0, 0.1))
    _, turns = sharp_corners(frame.rings, _SHARP)
    tip = _tip(turns, limit, least)
    levels = [inner + tip] if tip == least else [inner + tip, inner + least]
    fine, *more = offset_levels(task.walls, levels, progress.part(0.1, 0.2))
    coarse = more[0] if more else fine
    corners, _ = sharp_corners(fine.rings, _SHARP)
    field = DistanceField.of(task.walls.rows)
    room = WallClearance(field, task.leave, limit.radius + least)
    axis = rough_axis(task.walls, room, corners, _SPACING * limit.radius, progress.part(0.2, 0.4))
    axis = _complete(axis, coarse, room)
    parts, found = [], trees(axis, _beside_stock(axis, task.stock, limit.radius, least))
    for k, tree in enumerate(found):
        if axis.reach[tree.root] < limit.radius + least - 1e-9:
            continue
        part = progress.part(0.4 + 0.6 * k / len(found), 0.4 + 0.6 * (k + 1) / len(found))
        parts.append(_part(_PlannedArea(room, axis, (fine, coarse), (tip, least), task), tree, limit, part))
    return tuple(parts)


def _beside_stock(axis: RoughAxis, stock: BoxSides | None, radius: float, least: float) -> NDArray[np.bool_] | None:
    """Return (n,) at which points of the axis the cutter may begin wholly beside the stock, None where it has no
    business there.
    """
    if stock is None:
        return None
    return (stock.away(axis.points) >= radius + _BESIDE) & (axis.reach >= radius + least)


@dataclass(frozen=True, eq=False)
class _PlannedArea:
    """A connected part that has an axis.

    Attributes:
        room, axis: where the cutter may be, and the middle of it.
        levels: the last ways along the walls, as fine and as coarse ones. turns: least radius of a path round a centre,
            mm, at tips of corners and elsewhere.
    """

    room: WallClearance
    axis: RoughAxis
    levels: tuple[OffsetLevel, OffsetLevel]
    turns: tuple[float, float]
    task: ClearingTask


def least_turn(limit: EngagementLimit) -> float:
    """Return the least radius of a path round a centre, mm, but for the tips of corners."""
    return max(_TURN * limit.coarser, limit.least_turn)


def _tip(turns: Floats, limit: EngagementLimit, least: float) -> float:
    """Return the radius of the arcs in corners, mm: small enough that next to nothing stands in the sharpest."""
    if not len(turns):
        return least
    sine = math.sin((math.pi - float(turns.max())) / 2)
    return max(min(least, _SLIVER * sine / max(1e-9, 1 - sine)), limit.least_turn)


def _complete(axis: RoughAxis, level: OffsetLevel, room: WallClearance) -> RoughAxis:
    """Return the axis with a point in each part that has none, such as the middle of a circle."""
    points, reach = [axis.points], [axis.reach]
    for ring in level.rings:
        if ring.area <= 0:
            continue
        outline = shapely.Polygon(sample(ring.rows, _CHORD)).buffer(_CHORD)
        if len(axis.points) and shapely.contains_xy(outline, axis.points[:, 0], axis.points[:, 1]).any():
            continue
        x, y = ring.rows[0, :2].tolist()
        centre, wide = room.to_axis((x, y))
        points.append(np.array([centre]))
        reach.append(np.array([wide]))
    made = np.concatenate(points)
    lone = np.arange(len(axis.points), len(made))
    return RoughAxis(made, np.concatenate(reach), np.concatenate([axis.edges, np.column_stack([lone, lone])]))


def _part(area: _PlannedArea, tree: AxisTree, limit: EngagementLimit, progress: Progress) -> ConnectedPath:
    """Return the quicker path of a part: by discs alone, or with its wide places cleared along the metal."""
    by_discs = _path(area, tree, limit, None, progress.part(0.0, 0.3))
    wide = _wide(area, tree, by_discs, limit, progress.part(0.3, 0.8))
    if wide is None:
        return by_discs
    other = _path(area, tree, limit, wide, progress.part(0.8, 1.0))
    worse = len(other.unproven) > len(by_discs.unproven) or len(other.stops) > len(by_discs.stops)
    faster = area.task.faster
    better = not worse and other.effort(faster) < by_discs.effort(faster)
    return other if better and all(_is_smooth(run.rows) for run in other.runs) else by_discs


def _is_smooth(rows: Rows) -> bool:
    """Tell whether rows (n, 8) touch one another where they meet, but for those too short to have a direction."""
    long = rows[lengths(rows) > _SHORT]
    begin, end = (headings_at(long, np.full(len(long), fraction)) for fraction in (0.0, 1.0))
    across = begin[1:, 1] * end[:-1, 0] - begin[1:, 0] * end[:-1, 1]
    return bool((np.abs(np.arctan2(across, (begin[1:] * end[:-1]).sum(axis=1))) < _KINK).all())


def _path(
    area: _PlannedArea, tree: AxisTree, limit: EngagementLimit, wide: WidePlace | None, progress: Progress
) -> ConnectedPath:
    walk = AxisWalk(limit, area.room, area.axis)
    none = np.zeros(len(area.axis.points), np.bool_)
    swept = swept_discs(wide, area.axis, tree, limit) if wide is not None else none
    walk.along(tree, swept, progress.part(0.0, 0.5))
    discs = walk.discs
    paths, unproven = _rings(area, discs, limit, progress.part(0.5, 0.9))
    first = discs.each[0]
    way = PathBuilder(limit, discs, area.task.farthest, area.task.fastest, wide.front if wide is not None else None)
    way.begin(_first_turns(area, first, limit))
    if wide is not None:
        way.go_on(wide.rows, wide.clear, wide.pose)
        paths = _left_of(paths, wide, way)
    for number in range(1, len(discs)):
        way.slice(number)
    unproven += way.finish()
    unproven += [_begin(path) for path in paths if not way.ring(path)]
    region = int(area.task.walls.region[area.room.distances.nearest(np.array([first.centre]))[1][0]])
    return ConnectedPath(tuple(way.done()), region, tuple(walk.stops), tuple(unproven))


def _left_of(paths: Sequence[Rows], wide: WidePlace, way: PathBuilder) -> list[Rows]:
    """Have the stretches cut that are left of ways along walls; return the ways that are left as a whole."""
    found = [stretches(path, wide, way.discs) for path in paths]
    way.leave_for([each for parts in found if parts is not None for each in parts])
    return [path for path, parts in zip(paths, found, strict=True) if parts is None]


def _first_turns(area: _PlannedArea, first: ClearedDisc, limit: EngagementLimit) -> Rows:
    return spiral(first.centre, first.reach - limit.radius, limit, max(limit.least_turn, area.turns[1]))


def _wide(
    area: _PlannedArea, tree: AxisTree, by_discs: ConnectedPath, limit: EngagementLimit, progress: Progress
) -> WidePlace | None:
    """Return how the wide place about the root is cleared, None where there is none, or discs are quicker.

    Coarse digits turn short arcs by too much for it.
    """
    if limit.grid is not None or limit.coarser > 1.0:
        return None
    first = AxisWalk(limit, area.room, area.axis).begin(tree)
    turns = _first_turns(area, first, limit)
    end, faster = turns[-1], area.task.faster
    pose = PathPose(end[2], end[3], math.atan2(end[3] - first.y, end[2] - first.x), first.reach - limit.radius)
    worth = WayWorth(by_discs.effort(faster) - float(lengths(turns).sum()), faster)
    return wide_place(area.task.walls, area.room, area.axis, WideStart(limit, first, pose, worth), progress)


def _begin(path: Rows) -> Point:
    x, y = path[0, :2].tolist()
    return x, y


def _rings(
    area: _PlannedArea, discs: ClearedDiscs, limit: EngagementLimit, progress: Progress
) -> tuple[list[Rows], list[Point]]:
    """Return the ways along the walls of a part, each proven; the coarse one where the fine one is not."""
    proof = RingProof(limit, area.room, discs)
    done: list[Rows] = []
    for level, turn in zip(area.levels, area.turns, strict=True):
        proof.unproven.clear()
        paths = [rounded(ring, turn) for ring in level.rings if _beside(ring, discs, limit)]
        done = [path for path in paths if proof.holds(path, progress)]
        if len(done) == len(paths):
            break
    return done, list(proof.unproven)


def _beside(ring: Ring, discs: ClearedDiscs, limit: EngagementLimit) -> bool:
    """Tell whether a ring lies along walls that discs of this part touch."""
    table = discs.table
    places = ring.rows[:, :2]
    for x, y in places[:: max(1, len(places) // 50)]:
        if (np.hypot(table[:, 0] - x, table[:, 1] - y) <= table[:, 2] - limit.radius + 2 * limit.scallop).any():
            return True
    return False


def mirrored(walls: Primitives) -> Primitives:
    """Return walls in a mirror: x changes its sign, and the area is to the left again."""
    rows = walls.rows[::-1].copy()
    rows[:, [0, 1, 2, 3]] = rows[:, [2, 3, 0, 1]]
    rows[:, [0, 2, 4]] *= -1
    count = len(rows)
    following = np.empty(count, np.int64)
    following[walls.previous] = np.arange(count)
    return Primitives(np.ascontiguousarray(rows), count - 1 - following[::-1], walls.region[::-1].copy())


def mirrored_part(part: ConnectedPath) -> ConnectedPath:
    """Return the path of a part as it is outside of the mirror."""
    return replace(
        part,
        runs=tuple(CutRun(mirrored_rows(run.rows), run.clear, run.times) for run in part.runs),
        stops=tuple(WalkStop((-stop.place[0], stop.place[1]), stop.width) for stop in part.stops),
        unproven=tuple((-x, y) for x, y in part.unproven),
    )


def mirrored_rows(rows: Rows) -> Rows:
    """Return a path in a mirror, travelled as before."""
    out = rows.copy()
    out[:, [0, 2, 4, 7]] *= -1
    return out
