"""Is the path safe: clearance of every move below the stock's top from every wall, and rapids that meet metal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..geometry.distance import DistanceField
from ..geometry.primitives import TURN, contour_rows, pack, within_half_turn
from ..geometry.tree_queries import near
from ..model.job import Job
from ..model.moves import MoveKind, Moves, Program
from ..model.part import Region
from ..model.stock_box import StockBox
from ..model.tool import ToolKind
from ..toolpath.coverage.flat import lines, move_rows, region_shapes
from .bounds import OperationBound, bounds_of, cutting_radius, in_dog_bones, off_lines, out_of_holes
from .clearance import curve_distance, pair_distance
from .slanted_clearance import SlantedMoves, reach_beyond

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm; within this areas of chords are what was drawn."""

_ROUGH = 0.02
"""mm; walls and moves are flattened within this to find which pairs can be near: few chords are quicker to ask."""

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
    cones = {tool.number: tool.profile for tool in job.tools if tool.kind is ToolKind.V}
    numbers = moves.tool[chosen].tolist()
    tip = np.array([cones[number].flat for number in numbers]) + bound.leave
    rate = np.array([1 / cones[number].cone for number in numbers])
    widest = np.array([job.tool(number).radius for number in numbers]) + bound.leave
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
    tree = shapely.STRtree(lines(walls, _ROUGH))
    depth, places = np.full(len(rows), -np.inf), rows[:, 2:4].copy()
    for first in range(0, len(rows), _PORTION):
        progress.step(first / len(rows), "Checking clearance")
        some = slice(first, first + _PORTION)
        move, wall = near(tree, lines(rows[some], _ROUGH), need[some] + 4 * _ROUGH)
        distance, points = pair_distance(rows[some], walls, move, wall)
        short = need[some][move] - distance
        order = np.lexsort((short, move))
        worst = order[np.flatnonzero(np.diff(move[order], append=-1))]  # of each move the last, which is the deepest
        depth[first + move[worst]], places[first + move[worst]] = short[worst], points[worst]
    return depth, places


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
