"""Is the path safe: clearance of every move below the stock's top from every wall, and rapids that meet metal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from app.geometry.near import near
from app.geometry.primitives import contour_rows
from app.model.job import Job
from app.model.moves import MoveKind, Moves, Program
from app.tolerances import LEVEL
from app.toolpath.flat import lines, move_rows, region_shapes
from app.workflow.clearance import curve_distance

Floats = NDArray[np.float64]

_CHORD = 1e-3
"""mm; walls and moves are flattened within this only to find which pairs can be near."""

_SURFACE = 1e-9
"""mm below the stock's top at which a move counts as in the stock."""


@dataclass(frozen=True, slots=True)
class Gouge:
    """The deepest cut into the part.

    Attributes:
        max_mm: how far the cutter, with its stock to leave, reaches beyond a wall, mm; 0 = nowhere.
        x, y, z: where the tool's centre is then, mm, part coordinates; None when max_mm is 0.
        move: index of that move, or -1.
        count: moves that reach more than 1 um beyond a wall.
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


def in_stock(moves: Moves) -> NDArray[np.bool_]:
    """Return (n,) whether a move gets below the stock's top, Z 0."""
    return np.minimum(moves.start[:, 2], moves.end[:, 2]) < -_SURFACE


def required_clearance(moves: Moves, job: Job) -> Floats:
    """Return (n,) the least distance of each move's centre line from walls: tool radius + stock to leave, mm."""
    radius = {tool.number: tool.radius for tool in job.tools}
    leave = [operation.cut.stock_to_leave for operation in job.operations]
    return np.array([radius[int(t)] + leave[int(o)] for t, o in zip(moves.tool, moves.operation, strict=True)])


def gouge(program: Program, job: Job) -> Gouge:
    """Return the deepest gouge of a program, by exact distances of every move in the stock from every wall.

    Args:
        program: its regions' contours are the walls; what lies outside of all regions is part.
        job: its tools' radii and its stock to leave are what the path must keep clear of.
    """
    moves = program.moves
    chosen = np.flatnonzero(in_stock(moves))
    if not len(chosen) or not program.regions:
        return Gouge()
    rows, need = move_rows(moves)[chosen], required_clearance(moves, job)[chosen]
    walls = np.concatenate([contour_rows(contour) for region in program.regions for contour in region.contours])
    depth, places = _depths(rows, need, walls)
    outside, beyond = _outside(rows, program)
    depth[outside], places[outside] = need[outside] + beyond, rows[outside, 2:4]
    worst = int(np.argmax(depth))
    if depth[worst] <= 0:
        return Gouge()
    move = int(chosen[worst])
    z = float(min(moves.start[move, 2], moves.end[move, 2]))
    return Gouge(float(depth[worst]), float(places[worst, 0]), float(places[worst, 1]), z, move, int(np.sum(depth > LEVEL)))


def _depths(rows: Floats, need: Floats, walls: Floats) -> tuple[Floats, Floats]:
    """Return (n,) how far each move comes nearer to a wall than it may (<= 0: it does not), and where, (n, 2)."""
    tree = shapely.STRtree(lines(walls, _CHORD))
    move, wall = near(tree, lines(rows, _CHORD), need + 4 * _CHORD)
    depth, places = np.full(len(rows), -np.inf), rows[:, 2:4].copy()
    distance, points = curve_distance(rows[move], walls[wall])
    short = need[move] - distance
    for k in np.argsort(short):
        depth[move[k]], places[move[k]] = short[k], points[k]
    return depth, places


def _outside(rows: Floats, program: Program) -> tuple[NDArray[np.int64], Floats]:
    """Return the moves whose end lies in no region, and how far outside, mm."""
    polygons = shapely.union_all(region_shapes(program, _CHORD))
    ends = shapely.points(rows[:, 2:4])
    shapely.prepare(polygons)
    distance = np.zeros(len(rows))
    out = ~shapely.intersects(polygons, ends)
    distance[out] = shapely.distance(polygons, ends[out])
    found = np.flatnonzero(distance > 2 * _CHORD)
    return found, distance[found]


def rapids_in_material(program: Program, job: Job) -> tuple[RapidInMaterial, ...]:
    """Return the rapids that go below the stock's top where no earlier cut has made way.

    A vertical rapid up is safe: it leaves a hole that the cutter has made. A vertical rapid down is safe where an
    earlier cut as deep covered the whole cutter there. Every other rapid below Z 0 is reported.
    """
    moves = program.moves
    rapid = np.flatnonzero(in_stock(moves) & (moves.kind == MoveKind.RAPID))
    start, end = moves.start, moves.end
    radius = {tool.number: tool.radius for tool in job.tools}
    found = []
    for k in rapid:
        vertical = bool(np.hypot(*(end[k, :2] - start[k, :2])) < 1e-9)
        if vertical and end[k, 2] >= start[k, 2]:
            continue
        if not (vertical and _cleared_before(moves, int(k), radius)):
            found.append(RapidInMaterial(float(end[k, 0]), float(end[k, 1]), float(end[k, 2]), int(k)))
    return tuple(found)


def _cleared_before(moves: Moves, k: int, radius: dict[int, float]) -> bool:
    """Tell whether a cut before move k, at least as deep, covered the whole cutter where move k ends."""
    before = np.arange(k)
    deep = np.maximum(moves.start[:k, 2], moves.end[:k, 2]) <= moves.end[k, 2] + 1e-6
    chosen = before[deep & (moves.kind[:k] != MoveKind.RAPID)]
    if not len(chosen):
        return False
    rows = move_rows(moves)[chosen]
    point = np.repeat([np.concatenate([moves.end[k, :2], moves.end[k, :2], [0, 0, 0, 0]])], len(chosen), axis=0)
    distance, _ = curve_distance(rows, point)
    larger = np.array([radius[int(tool)] for tool in moves.tool[chosen]]) - radius[int(moves.tool[k])]
    return bool(np.any(distance <= larger + 1e-6))
