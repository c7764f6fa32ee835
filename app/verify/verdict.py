"""Is the path safe: clearance of every move below the stock's top from every wall, and rapids that meet metal."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import tan
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core.pool import in_bands
from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..geometry.distance import DistanceField
from ..geometry.primitives import TURN, Primitives, boxes, contour_rows, pack, points_at, within_half_turn
from ..model.curves import Circle
from ..model.job import Job
from ..model.moves import Area, DogBone, MoveKind, Moves, Program
from ..model.operation import Operation
from ..model.part import Contour, Region
from ..model.stock_box import StockBox
from ..model.tool import Tool
from ..model.tool_kind import ToolKind
from ..simulation.cutter import cutter_of
from ..toolpath.coverage.areas import lines, move_rows, region_shapes
from ..toolpath.coverage.floor_target import areas_of_operations
from ..toolpath.machining_areas import lies_on
from . import clearance_kernels as kernels
from .clearance_kernels import reaches

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm; within this areas of chords are what was drawn."""

_CLEAR = 0.08
"""mm that a move keeps clear of walls by beyond what it must, from which on it is not told by how much."""

_WORTH_TWO = 1000
"""Moves from which on a second core is worth its start."""

_PORTION = 4000
"""Moves that are held against walls between two looks at whether to stop."""

_SURFACE = 1e-9
"""mm below the stock's top at which a move counts as in the stock."""


@dataclass(frozen=True, slots=True)
class Gouge:
    """The deepest cut into the part.

    Attributes:
        max_mm: how far the cutter, with its stock to leave, reaches beyond a wall, or below the floor, mm; 0 = nowhere.
        x, y, z: where the tool's tip is then, mm, part coordinates; None when max_mm is 0.
        move: index of that move, or -1.
        count: moves that reach beyond by more than 1 um, or than is tolerated.
    """

    max_mm: float = 0.0
    x: float | None = None
    y: float | None = None
    z: float | None = None
    move: int = -1
    count: int = 0


@dataclass(frozen=True, slots=True)
class RapidInMaterial:
    """A rapid below the stock's top that no earlier cut has made way for: where it ends, mm, and its index."""

    x: float
    y: float
    z: float
    move: int


def in_stock(moves: Moves, top: float = 0.0) -> NDArray[np.bool_]:
    """Return (n,) whether a move gets below the stock's top, mm."""
    return np.minimum(moves.start[:, 2], moves.end[:, 2]) < top - _SURFACE


@dataclass(frozen=True, eq=False)
class MoveDepths:
    """How deep moves in the stock cut into the part, n of them.

    Attributes:
        move: (n,) their indices.
        depth: (n,) mm; <= 0: they keep clear by as much.
        places: (n, 3) where the tool's tip is then, mm, part coordinates.
    """

    move: NDArray[np.int64]
    depth: Floats
    places: Floats


def gouge_depths(
    program: Program, job: Job, stock: StockBox | None = None, by_tool: bool = False, progress: Progress = NO_PROGRESS
) -> MoveDepths:
    """Return how deep each move in the stock cuts into walls, by exact distances, or below the floor of its operation.

    Args:
        program: what lies outside of an operation's area is part, or a clamp.
        job: its tools and its stock to leave are what the path must keep clear of.
        stock: moves above it, and those that keep off it by their cutter's radius, cut nothing; straight ones count up
            to where they leave it. None = it is everywhere below Z 0.
        by_tool: True: nobody knows which operation a move belongs to, so it may be wherever one of its tool's may.

    Raises:
        Cancelled: by progress.
    """
    moves = program.moves
    top = min(0.0, stock.z1) if stock is not None else 0.0
    chosen = np.flatnonzero(in_stock(moves, top)) if program.regions or program.lines else np.zeros(0, np.int64)
    if stock is not None and len(chosen):
        chosen = chosen[_touches(moves, job, stock)[chosen]]
    depth, places = np.full(len(chosen), np.inf), np.zeros((len(chosen), 2))
    low = np.minimum(moves.start[chosen, 2], moves.end[chosen, 2])
    rows = move_rows(moves, chosen)
    rows = _clipped(rows, stock) if stock is not None else rows
    radius = cutting_radius(moves, job)[chosen]
    exempt = in_dog_bones(rows, program.dog_bones)
    bounds = bounds_of(program, job)
    for k, bound in enumerate(bounds):
        mine = np.flatnonzero(
            np.isin(moves.tool[chosen], bound.tools) if by_tool else np.isin(moves.operation[chosen], bound.operations)
        )
        if not len(mine):
            continue
        cone = _on_cones(moves, job, chosen[mine]) if bound.carves else np.zeros(len(mine), np.bool_)
        deep, where = np.empty(len(mine)), np.empty((len(mine), 2))
        deep[~cone], where[~cone] = _beyond(
            bound,
            rows[mine][~cone],
            (radius[mine] + bound.leave)[~cone],
            progress.part(k / len(bounds), (k + 1) / len(bounds)),
        )
        if cone.any():
            deep[cone], where[cone] = _slanted(bound, moves, job, chosen[mine][cone])
        deep[exempt[mine]] = -np.inf
        too_deep = -low[mine] - bound.floor
        deeper = too_deep > np.maximum(deep, _SURFACE)
        deep[deeper], where[deeper] = too_deep[deeper], rows[mine][deeper, 2:4]
        better = deep < depth[mine]
        depth[mine[better]], places[mine[better]] = deep[better], where[better]
    return MoveDepths(chosen, depth, np.column_stack([places, low]))


class _OutsideMoves(NamedTuple):
    """Moves whose end lies in no region, and how far outside, mm."""

    move: NDArray[np.int64]
    beyond: Floats


def _on_cones(moves: Moves, job: Job, chosen: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which of some moves are those of a cone that goes up or down on a straight way along."""
    cones = [tool.number for tool in job.tools if tool.kind is ToolKind.V]
    start, end = moves.start[chosen], moves.end[chosen]
    straight = np.isin(moves.tool[chosen], cones) & (moves.kind[chosen] <= MoveKind.LINE)
    found: NDArray[np.bool_] = straight & (start[:, 2] != end[:, 2]) & (start[:, :2] != end[:, :2]).any(axis=1)
    return found


def _slanted(bound: OperationBound, moves: Moves, job: Job, chosen: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Return how far moves of `_on_cones` reach beyond walls, mm, each as wide as it is there, and where, (n, 2)."""
    numbers, which = np.unique(moves.tool[chosen], return_inverse=True)
    tools = [job.tool(number) for number in numbers.tolist()]
    tip = np.array([tool.profile.flat for tool in tools])[which] + bound.leave
    rate = np.array([1 / tool.profile.cone for tool in tools])[which]
    widest = np.array([tool.radius for tool in tools])[which] + bound.leave
    slanted = SlantedMoves(moves.start[chosen], moves.end[chosen], tip, rate, widest)
    walls = np.concatenate([contour_rows(contour) for region in bound.area.regions for contour in region.contours])
    depth, places = reach_beyond(slanted, within_half_turn(walls))
    rows = move_rows(moves, chosen)
    outside, beyond = _outside(rows, bound.area.regions)
    depth[outside] = np.maximum(slanted.width(np.ones(len(chosen)))[outside], 0.0) + beyond
    places[outside] = rows[outside, 2:4]
    return depth, places


def clear_moves(moves: Moves, depths: MoveDepths, within: float) -> NDArray[np.bool_]:
    """Return (n,) which moves were looked at and reach beyond no wall and no floor by more than so many mm."""
    clear = np.zeros(len(moves), np.bool_)
    clear[depths.move] = depths.depth <= within
    return clear


def _beyond(bound: OperationBound, rows: Floats, need: Floats, progress: Progress) -> tuple[Floats, Floats]:
    """Return how far moves leave an area, with all the width that they need (<= 0: they do not), mm, and where, (n,
    2).
    """
    area = bound.area
    if bound.holes:
        return out_of_holes(rows, need, area.regions)
    walls = np.concatenate([contour_rows(contour) for region in area.regions for contour in region.contours])
    depth, places = _depths(rows, need, walls, progress)
    outside, beyond = _outside(rows, area.regions)
    depth[outside], places[outside] = need[outside] + beyond, rows[outside, 2:4]
    if area.lines:
        off, where = off_lines(rows, area.lines)
        farther = off > np.maximum(depth, 0.0)
        depth[farther], places[farther] = off[farther], where[farther]
    return depth, places


def clamps_met(program: Program, job: Job, depths: MoveDepths | None = None) -> MoveDepths:
    """Return how far each move below the clamps' tops, rapids too, reaches into a clamp with its cutter.

    Args:
        program: its clamps are as high as the job says.
        depths: of moves in the stock, by walls, clamps among them; those that are gouges there are not told again.
    """
    moves = program.moves
    low = np.minimum(moves.start[:, 2], moves.end[:, 2])
    chosen = np.flatnonzero(low < job.keep_out_height - _SURFACE) if program.clamps else np.zeros(0, np.int64)
    if depths is not None:
        chosen = np.setdiff1d(chosen, depths.move[depths.depth > LEVEL])
    if not len(chosen):
        return MoveDepths(chosen, np.zeros(0), np.zeros((0, 3)))
    rows, need = move_rows(moves, chosen), np.array([job.tool(number).radius for number in moves.tool[chosen].tolist()])
    depth, places = _depths(
        rows, need, np.concatenate([contour_rows(c) for region in program.clamps for c in region.contours])
    )
    held = shapely.union_all(region_shapes(program.clamps, _CHORD))
    over = np.asarray(shapely.intersects(shapely.points(rows[:, 2:4]), held))
    depth[over] = np.maximum(depth[over], need[over])
    return MoveDepths(chosen, depth, np.column_stack([places, low[chosen]]))


def _touches(moves: Moves, job: Job, stock: StockBox) -> NDArray[np.bool_]:
    """Return (n,) whether the cutter, seen from above, comes into the stock on a move."""
    radius = {tool.number: tool.radius for tool in job.tools}
    wide = np.array([radius[number] for number in moves.tool.tolist()])
    rectangle = shapely.box(stock.x0, stock.y0, stock.x1, stock.y1)
    return np.asarray(shapely.distance(rectangle, lines(move_rows(moves), _CHORD)) < wide)


def _clipped(rows: Floats, stock: StockBox) -> Floats:
    """Return rows of which straight ones that go through the stock, seen from above, begin and end in it or on its
    rim.
    """
    rows = rows.copy()
    way = rows[:, 2:4] - rows[:, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        sides = [(np.array(side) - rows[:, :2]) / way for side in ((stock.x0, stock.y0), (stock.x1, stock.y1))]
    still = way == 0
    enter = np.where(still, 0.0, np.minimum(*sides)).max(axis=1).clip(0.0, 1.0)
    leave = np.where(still, 1.0, np.maximum(*sides)).min(axis=1).clip(0.0, 1.0)
    through = (rows[:, TURN] == 0) & (enter < leave)
    first, last = (rows[:, :2] + way * share[:, None] for share in (enter, leave))
    rows[through, :2], rows[through, 2:4] = first[through], last[through]
    return rows


def deepest_of(depths: MoveDepths) -> Gouge:
    """Return the deepest gouge; moves that reach more than LEVEL into the part are counted."""
    worst = int(np.argmax(depths.depth)) if len(depths.depth) else 0
    if not len(depths.depth) or depths.depth[worst] <= 0:
        return Gouge()
    x, y, z = depths.places[worst].tolist()
    return Gouge(float(depths.depth[worst]), x, y, z, int(depths.move[worst]), int(np.sum(depths.depth > LEVEL)))


def _depths(rows: Floats, need: Floats, walls: Floats, progress: Progress = NO_PROGRESS) -> tuple[Floats, Floats]:
    """Return (n,) how far each move comes nearer to a wall than it may (<= 0: it does not), and where, (n, 2)."""
    field, around, within = DistanceField.of(walls), boxes(rows), need + _CLEAR
    distance, places, rows = np.empty(len(rows)), rows[:, 2:4].copy(), np.ascontiguousarray(rows)
    for first in range(0, len(rows), _PORTION):
        progress.step(first / len(rows), "Checking clearance")
        portion = slice(first, first + _PORTION)
        moves, found = ([each[portion] for each in some] for some in ((rows, around, within), (distance, places)))

        def measure(band: slice, moves: list[Floats] = moves, found: list[Floats] = found) -> None:
            some, out = ([each[band] for each in arrays] for arrays in (moves, found))
            kernels.nearest_walls(*some, field.rows, field.boxes, field.order, field.nodes, *out)

        in_bands(measure, len(moves[0]), _WORTH_TWO)
    return np.where(distance < within, need - distance, -np.inf), places


def _outside(rows: Floats, regions: Sequence[Region]) -> _OutsideMoves:
    """Return the moves whose end lies in no region."""
    field = DistanceField.of(pack(regions).rows)
    ends = rows[:, 2:4]
    out = np.flatnonzero(~field.inside(ends))
    distance = field.nearest(ends[out])[0]
    far = distance > 2 * _CHORD
    return _OutsideMoves(out[far], distance[far])


def rapids_in_material(program: Program, job: Job, progress: Progress = NO_PROGRESS) -> tuple[RapidInMaterial, ...]:
    """Return the rapids that go below the stock's top where no earlier cut has made way.

    A vertical rapid up is safe: it leaves a hole that the cutter has made. A vertical rapid down is safe where an
    earlier cut as deep covered the whole cutter there. Every other rapid below Z 0 is reported.

    Raises:
        Cancelled: by progress.
    """
    moves = program.moves
    rapid = np.flatnonzero(in_stock(moves) & (moves.kind == MoveKind.RAPID))
    start, end = moves.start, moves.end
    radius = {tool.number: tool.radius for tool in job.tools}
    found = []
    for done, k in enumerate(rapid):
        progress.step(done / len(rapid), "Checking rapids")
        vertical = bool(np.hypot(*(end[k, :2] - start[k, :2])) < 1e-9)
        if vertical and end[k, 2] >= start[k, 2]:
            continue
        if not (vertical and _cleared_before(moves, int(k), radius)):
            found.append(RapidInMaterial(float(end[k, 0]), float(end[k, 1]), float(end[k, 2]), int(k)))
    return tuple(found)


def _cleared_before(moves: Moves, k: int, radius: dict[int, float]) -> bool:
    """Tell whether a cut before move k, at least as deep, covered the whole cutter where move k ends.

    What the same tool has cut straight down it can go down again; of other cuts all must be as deep.
    """
    before = np.arange(k)
    heights = np.array([moves.start[:k, 2], moves.end[:k, 2]])
    straight = (np.hypot(*(moves.end[:k, :2] - moves.start[:k, :2]).T) < 1e-9) & (moves.tool[:k] == moves.tool[k])
    deep = np.where(straight, heights.min(axis=0), heights.max(axis=0)) <= moves.end[k, 2] + 1e-6
    chosen = before[deep & (moves.kind[:k] != MoveKind.RAPID)]
    if not len(chosen):
        return False
    rows = move_rows(moves, chosen)
    point = np.repeat([np.concatenate([moves.end[k, :2], moves.end[k, :2], [0, 0, 0, 0]])], len(chosen), axis=0)
    distance, _ = curve_distance(rows, point)
    larger = np.array([radius[int(tool)] for tool in moves.tool[chosen]]) - radius[int(moves.tool[k])]
    return bool(np.any(distance <= larger + 1e-6))


# Where each operation's cutter may be, and how deep: what a verdict holds moves against.


_ON_BONE = 2e-3
"""mm; a move this near to a dog-bone's way is on it: as far as writing may shift it."""


@dataclass(frozen=True, eq=False)
class OperationBound:
    """What holds for some operations alike.

    Attributes:
        operations: their indices in the job. tools: T numbers.
        area: that their cutters stay in.
        leave: stock to leave on its walls, mm; < 0: so far the cutter may reach over their edges at the surface.
        floor: how deep they may go, mm.
        holes: True where the area is circles to drill, which may cross: a drill stays in one of them.
        carves: True where walls are slanted as the cutter is, and end at the area's outline.
    """

    operations: tuple[int, ...]
    tools: tuple[int, ...]
    area: Area
    leave: float
    floor: float
    holes: bool = False
    carves: bool = False


def bounds_of(program: Program, job: Job) -> list[OperationBound]:
    """Return what holds for the operations of a job that are switched on; tools without one may do what any other
    may.
    """
    found: dict[tuple[int, int, float, float, bool], list[int]] = {}
    areas = areas_of_operations(program, job)
    for k, operation in enumerate(job.operations):
        if operation.cut.enabled and areas[k].regions:
            leave, floor = operation.cut.stock_to_leave - operation.over_edge, deepest(operation, job)
            key = id(areas[k].regions), id(areas[k].lines), leave, floor, operation.CARVES
            found.setdefault(key, []).append(k)
    busy = {operation.cut.tool for operation in job.operations if operation.cut.enabled}
    idle = tuple(tool.number for tool in job.tools if tool.number not in busy)
    return [
        OperationBound(
            tuple(group),
            (*dict.fromkeys(job.operations[k].cut.tool for k in group), *idle),
            areas[group[0]],
            leave,
            floor,
            job.operations[group[0]].HOLES,
            carves,
        )
        for (_, _, leave, floor, carves), group in found.items()
    ]


def deepest(operation: Operation, job: Job) -> float:
    """Return how deep an operation's tool may go, mm: a drill goes through by its tip's length and what is asked
    for.
    """
    tool = job.tool(operation.cut.tool)
    return operation.deepest(tool) + (tip_length(tool) if operation.DRILLS else 0.0)


def tip_length(tool: Tool) -> float:
    """Return the length of a drill's tip, mm; 0 of other tools."""
    angle = (tool.tip_angle or tool.kind.assumed_angle) if tool.kind.drills else 0.0
    return tool.radius / tan(angle / 2) if angle else 0.0


def cutting_radius(moves: Moves, job: Job) -> Floats:
    """Return (n,) how wide each move's cutter cuts, mm, as a radius.

    A cutter that is not as wide as that at its tip counts as wide as it is at Z 0, where the walls end, when the move
    is deepest.
    """
    height = -np.minimum(moves.start[:, 2], moves.end[:, 2])
    wide = np.zeros(len(moves))
    for tool in job.tools:
        mine = moves.tool == tool.number
        if tool.kind.square:
            wide[mine] = tool.radius
        else:
            wide[mine] = cutter_of(tool).radii_at(height[mine])
    return wide


def followed_walls(area: Area) -> Primitives:
    """Return the walls of an area that its cutter follows: not clamps, nor the frame round an area outside."""
    walls = pack(area.regions)
    if not area.bare:
        return walls
    kept = ~lies_on(walls, area.bare)
    number = np.where(kept, np.cumsum(kept) - 1, -1)
    before = number[walls.previous[kept]]
    return Primitives(walls.rows[kept], np.where(before < 0, number[kept], before), walls.region[kept])


def in_dog_bones(rows: Floats, dog_bones: Sequence[DogBone]) -> NDArray[np.bool_]:
    """Return (n,) whether a straight move (n, 8) lies on the way of a dog-bone."""
    on = np.zeros(len(rows), np.bool_)
    for dog_bone in dog_bones:
        a, b = np.array([dog_bone.x0, dog_bone.y0]), np.array([dog_bone.x1, dog_bone.y1])
        near = (rows[:, 7] == 0) & _near_segment(rows[:, :2], a, b) & _near_segment(rows[:, 2:4], a, b)
        on |= near
    return on


def _near_segment(points: Floats, a: Floats, b: Floats) -> NDArray[np.bool_]:
    along = b - a
    part = np.clip((points - a) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
    near: NDArray[np.bool_] = np.hypot(*(points - a - part[:, None] * along).T) <= _ON_BONE
    return near


def off_lines(rows: Floats, lines: Sequence[Contour]) -> tuple[Floats, Floats]:
    """Return how far moves (n, 8) leave lines at most, mm, and where, (n, 2): looked at at their ends and three places
    between.

    A path on lines runs along them, so a move that is on a line at five places runs along it.
    """
    field = DistanceField.of(within_half_turn(np.concatenate([contour_rows(contour) for contour in lines])))
    return _worst_along(rows, lambda points: field.nearest(points)[0])


def out_of_holes(rows: Floats, need: Floats, holes: Sequence[Region]) -> tuple[Floats, Floats]:
    """Return how far moves (n, 8) that need room all round, mm, reach beyond the hole that holds most of them, mm, and
    where, (n, 2).

    Args:
        holes: regions that are circles; they may cross one another.
    """
    circles = [each for region in holes for each in region.boundary.primitives if isinstance(each, Circle)]
    from scipy.spatial import cKDTree  # takes longer to import than most jobs to judge

    centres, radius = np.array([each.centre for each in circles]), np.array([each.radius for each in circles])
    nearest = cKDTree(centres)
    alike = [(size, cKDTree(centres[radius == size])) for size in np.unique(radius).tolist()]

    def off(points: Floats) -> Floats:
        far, which = nearest.query(points)
        beyond: Floats = far + need - radius[which]
        out = np.flatnonzero(beyond > 0)  # of the hole whose middle is nearest, but a wider one may hold them
        for size, tree in alike if len(out) else ():
            beyond[out] = np.minimum(beyond[out], tree.query(points[out])[0] + need[out] - size)
        return beyond

    return _worst_along(rows, off)


def _worst_along(rows: Floats, measure: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
    """Return the largest of what is measured at the ends of moves (n, 8) and at three places between, and where that
    is, (n, 2).
    """
    worst, places = np.full(len(rows), -np.inf), rows[:, :2].copy()
    for part in (0.0, 0.25, 0.5, 0.75, 1.0):
        points = points_at(rows, np.full(len(rows), part))
        off = measure(points)
        more = off > worst
        worst[more], places[more] = off[more], points[more]
    return worst, places


# Exact distance between tool path and walls in closed form: a second opinion that shares no code with the path makers.
#
# Two plane curves that do not cross are nearest at an end of one of them, or where both have the same normal: at the
# foot of an arc's centre on a line, or on the line through two arcs' centres. Where they cross, the distance is 0. So
# a few candidate points on the first curve, measured against the second, hold the exact minimum. Rows of curves are
# those of `app.geometry.primitives`, of any sweep.


Indices = NDArray[np.int64]


def curve_distance(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return the least distance of each pair of curves, and where on the first curve it is.

    Args:
        first, second: (n, 8) rows; line k of one belongs to line k of the other.

    Returns:
        Distances (n,), mm, and points (n, 2), mm.
    """
    each = np.arange(len(first))
    return pair_distance(first, second, each, each)


def pair_distance(first: Floats, second: Floats, one: Indices, other: Indices) -> tuple[Floats, Floats]:
    """Return the least distance of some pairs of curves, and where on the first curve it is.

    Args:
        first, second: (n, 8) and (m, 8) rows.
        one, other: (k,) rows of both that make a pair.

    Returns:
        Distances (k,), mm, and points (k, 2), mm.
    """
    distances, places = np.empty(len(one)), np.empty((len(one), 2))
    rows = (np.ascontiguousarray(each, np.float64) for each in (first, second))
    pairs = (np.ascontiguousarray(each, np.int64) for each in (one, other))
    kernels.pair_distances(*rows, *pairs, distances, places)
    return distances, places


# How far a cone that goes up or down along straight moves reaches beyond walls: closed forms, nothing is sampled.
#
# At the surface a cone whose tip is at height z is tip - z tan a wide, which is linear along a move. What it reaches
# beyond a wall is that less the distance from the wall. To a point the distance along a move is a root of a square, so
# the most is where the slope of the root is that of the width; to a line it is linear between the feet of its ends,
# and to a circle's arc it is the distance to the centre, less the radius. So the most is at an end of the move, at the
# best place for one of the wall's ends or its centre, or where the move crosses the wall.


@dataclass(frozen=True, eq=False)
class SlantedMoves:
    """Straight moves of cones, n of them.

    Attributes:
        start, end: (n, 3) of the tip, mm, the surface at Z 0.
        tip: (n,) radius of the flat at the cone's end, mm.
        rate: (n,) mm of radius per mm of height.
        widest: (n,) radius where the cone ends, mm.
    """

    start: Floats
    end: Floats
    tip: Floats
    rate: Floats
    widest: Floats

    def width(self, share: Floats) -> Floats:
        """Return how wide the cone is at the surface at fractions (n,) of the moves, mm; above it, the less."""
        z = self.start[:, 2] + (self.end[:, 2] - self.start[:, 2]) * share
        width: Floats = np.minimum(self.tip - z * self.rate, self.widest)
        return width

    def at(self, share: Floats) -> Floats:
        """Return the places (n, 2) at fractions (n,) of the moves."""
        places: Floats = self.start[:, :2] + (self.end[:, :2] - self.start[:, :2]) * share[:, None]
        return places


def reach_beyond(moves: SlantedMoves, walls: Floats) -> tuple[Floats, Floats]:
    """Return how far each move's cone reaches beyond a wall at the surface at most, mm (<= 0: nowhere), and where its
    tip is then, (n, 2).

    Args:
        walls: (m, 8) lines and arcs below half a turn.
    """
    depth, places = np.full(len(moves.tip), -np.inf), moves.end[:, :2].copy()
    if not len(walls):
        return depth, places
    field = DistanceField.of(walls)
    table = np.column_stack([moves.start, moves.end, moves.tip, moves.rate, moves.widest])

    def measure(some: slice) -> None:
        reaches(table[some], field.rows, field.boxes, field.order, field.nodes, depth[some], places[some])

    in_bands(measure, len(table))
    return depth, places
