"""Where each operation's cutter may be, and how deep: what a verdict holds moves against."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import tan

import numpy as np
from numpy.typing import NDArray

from ..geometry.distance import DistanceField
from ..geometry.primitives import Primitives, contour_rows, pack, points_at, within_half_turn
from ..model.curves import Circle
from ..model.job import Job
from ..model.moves import Area, DogBone, Moves, Program
from ..model.operation import Operation
from ..model.part import Contour, Region
from ..model.tool import Tool
from ..simulation.cutter import cutter_of
from ..toolpath.coverage.floor_target import areas_of_operations
from ..toolpath.machining_areas import lies_on

Floats = NDArray[np.float64]

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
