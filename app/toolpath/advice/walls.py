"""The walls of a drawing as a cutter meets them, and the largest discs that touch them.

A wall is a run of lines and arcs that meet without a corner. At any of its points the largest disc in the free area
that touches it there is the largest cutter that can stand there; its centre lies on the medial axis. It is found by
letting a disc shrink until no wall reaches into it, each wall measured exactly, so that nothing depends on how finely
the drawing is sampled: samples only tell where to look. What is found is then made precise along the wall.

References:
    Ma, Bae, Choi, 3D medial axis point approximation using nearest neighbors and the normal field (2012): the shrinking
    disc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, Indices, Primitives, R, Rows, lengths, points_at

Floats = NDArray[np.float64]

KINK = math.radians(5.0)
"""Bends below this are no corners: a cutter of radius r leaves less than r / 1000 in them."""

_KINK_DEPTH = 4e-3
"""Radii by which a disc may reach over such a bend."""

_SAMPLES = 8000
"""Places along all walls at least, one to a line or arc and three to a wall."""

_MOST = 400
"""Places along one line or arc at most."""

_FAN = math.radians(15.0)
"""Between two discs that touch one corner that stands out."""

_SAME = 1e-5
"""mm; walls that begin so near one another touch."""

_ROUNDS = 60
"""Steps in which a disc shrinks; ten are usual."""


@dataclass(frozen=True)
class Walls:
    """Lines and arcs in runs without corners; the free area is on their left.

    Discs touch walls along tracks: the k walls come first, then the tips, corners that stand out, which a disc rolls
    round.

    Attributes:
        rows, region: as of `Primitives`.
        field: distances from them.
        before: (n,) row before each one.
        turn: (n,) by how much the contour turns where each row begins, radians, > 0 to the left.
        sharp: (n,) whether each row begins in an inner corner, or where other walls touch.
        wall: (n,) number of the wall of each row.
        along: (n,) rows in the order of their walls, and along these.
        start: (n,) how far along its wall each row begins, mm.
        size: (k,) length of each wall, mm.
        tips: (t,) rows that begin at a tip.
        corners: (k, 2) whether it begins and ends in an inner corner.
        kinked: (k,) whether it has bends too small to be corners.
        limit: (n,) radius that no disc in the row's region exceeds, mm.
    """

    rows: Rows
    region: Indices
    field: DistanceField
    before: Indices
    turn: Floats
    sharp: NDArray[np.bool_]
    wall: Indices
    along: Indices
    start: Floats
    size: Floats
    tips: Indices
    corners: NDArray[np.bool_]
    kinked: NDArray[np.bool_]
    limit: Floats

    @staticmethod
    def of(primitives: Primitives) -> Walls:
        """Return the walls of closed contours; there is at least one row."""
        rows, before = primitives.rows, primitives.previous
        turn = (_headings(rows, 0) - _headings(rows, 2)[before] + math.pi) % math.tau - math.pi
        sharp = (turn > KINK) | _touched(rows)
        corner = sharp | (turn < -KINK)
        along, first = _in_walls(before, corner)
        wall = np.empty(len(rows), np.int64)
        wall[along] = np.cumsum(first) - 1
        size = np.bincount(wall, lengths(rows)).astype(np.float64)
        start = np.empty(len(rows))
        gone = np.cumsum(lengths(rows)[along]) - lengths(rows)[along]
        start[along] = gone - gone[first][np.cumsum(first) - 1]
        begin = along[first]
        corners = np.zeros((len(size), 2), np.bool_)
        corners[:, 0] = sharp[begin]
        corners[wall[before[begin]], 1] = sharp[begin]
        kinked = np.bincount(wall, ~corner & (np.abs(turn) > 1e-4)) > 0
        return Walls(
            rows,
            primitives.region,
            DistanceField.of(rows),
            before,
            turn,
            sharp,
            wall,
            along,
            start,
            size,
            np.flatnonzero(turn < -KINK),
            corners,
            kinked,
            _limits(primitives),
        )

    @property
    def spans(self) -> Floats:
        """(k + t,) how long each track is: a wall's length, mm, and 1 for a tip."""
        return np.concatenate([self.size, np.ones(len(self.tips))])

    def normals(self, row: Indices, part: Floats) -> Floats:
        """Return unit vectors (m, 2) into the free area at fractions of rows (m,); over small bends they turn
        evenly.
        """
        rows = self.rows[row]
        along = rows[:, 2:4] - rows[:, :2]
        left = np.column_stack([-along[:, 1], along[:, 0]])
        normal = np.where(
            (rows[:, TURN] == 0)[:, None], left, (rows[:, [CX, CY]] - points_at(rows, part)) * rows[:, [TURN]]
        )
        bend = np.where(np.abs(self.turn) > KINK, 0.0, self.turn / 2)
        at_end = np.empty(len(bend))
        at_end[self.before] = bend
        return _unit(np.arctan2(normal[:, 1], normal[:, 0]) - bend[row] * (1 - part) + at_end[row] * part)


@dataclass(frozen=True)
class Discs:
    """The largest discs that touch walls at some points.

    Attributes:
        row: (m,) row that each touches.
        track: (m,) wall or tip that it touches.
        place: (m,) how far along its track it does, mm; round a tip from 0 to 1.
        point: (m, 2) where.
        radius: (m,) mm.
        centre: (m, 2).
        other: (m,) row that it touches elsewhere, or -1.
        far: (m, 2) where, or the point itself.
    """

    row: Indices
    track: Indices
    place: Floats
    point: Floats
    radius: Floats
    centre: Floats
    other: Indices
    far: Floats


def discs_along(walls: Walls, progress: Progress = NO_PROGRESS) -> Discs:
    """Return discs all along the walls, and round all tips; in the order of tracks, and along each.

    Raises:
        Cancelled: by progress.
    """
    size = lengths(walls.rows)
    least = np.where(np.bincount(walls.wall) < 3, 3, 1)[walls.wall[walls.along]]
    counts = np.clip(np.ceil(size[walls.along] / (size.sum() / _SAMPLES)), least, _MOST).astype(np.int64)
    row, part = np.repeat(walls.along, counts), (_numbered(counts) + 0.5) / np.repeat(counts, counts)
    fan = np.ceil(-walls.turn[walls.tips] / _FAN).astype(np.int64) + 1
    tip, share = np.repeat(np.arange(len(walls.tips)), fan), _numbered(fan) / np.repeat(fan - 1, fan)
    track = np.concatenate([walls.wall[row], len(walls.size) + tip])
    return discs_at(walls, track, np.concatenate([walls.start[row] + part * size[row], share]), progress)


def _numbered(counts: Indices) -> Indices:
    """Return 0 … c - 1 for each count c, one after the other."""
    numbers: Indices = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    return numbers


def discs_at(walls: Walls, track: Indices, place: Floats, progress: Progress = NO_PROGRESS) -> Discs:
    """Return the discs that touch some tracks (m,) at some places along them (m,).

    Raises:
        Cancelled: by progress.
    """
    count = len(walls.size)
    wall = np.minimum(track, count - 1)
    number = walls.wall[walls.along]
    first = np.searchsorted(number, np.arange(count + 1))
    total = np.concatenate([[0.0], np.cumsum(walls.size)])
    index = np.searchsorted(total[number] + walls.start[walls.along], total[wall] + place, side="right") - 1
    row = walls.along[np.clip(index, first[wall], first[wall + 1] - 1)]
    part = np.clip((place - walls.start[row]) / lengths(walls.rows)[row], 0.0, 1.0)
    point, normal = points_at(walls.rows[row], part), walls.normals(row, part)
    round_tip = track >= count
    tip = walls.tips[track[round_tip] - count]
    row[round_tip], point[round_tip] = tip, walls.rows[tip, :2]
    normal[round_tip] = _unit(_headings(walls.rows[tip], 0) - walls.turn[tip] * (1 - place[round_tip]) + math.pi / 2)
    radius, other, far = _shrunk(walls, row, (point, normal), progress)
    return Discs(row, track, place, point, radius, point + radius[:, None] * normal, other, far)


def _shrunk(
    walls: Walls, row: Indices, touch: tuple[Floats, Floats], progress: Progress
) -> tuple[Floats, Indices, Floats]:
    """Return (radius (m,), other row (m,) or -1, where (m, 2)) of discs that touch rows at points (m, 2), centres in
    directions (m, 2).
    """
    point, normal = touch
    radius, other, far = walls.limit[row].copy(), np.full(len(row), -1), point.copy()
    active = np.arange(len(row))
    for step in range(_ROUNDS):
        progress.step(step / _ROUNDS, "Discs along the walls")
        if not len(active):
            break
        centre = point[active] + radius[active, None] * normal[active]
        distance, nearest = walls.field.nearest(centre)
        feet = feet_on(walls.rows[nearest], centre)
        way = feet - point[active]
        gap, depth = (way**2).sum(axis=1), (way * normal[active]).sum(axis=1)
        mine = (
            (walls.wall[nearest] == walls.wall[row[active]])
            & walls.kinked[walls.wall[nearest]]
            & (gap < (radius[active] / 2) ** 2)
        )
        room = np.maximum(np.where(mine, _KINK_DEPTH * radius[active], 0.0), 1e-9)
        with np.errstate(divide="ignore", invalid="ignore"):
            smaller = gap / (2 * depth)
        go_on = (distance < radius[active] - room) & (depth > 0) & (gap > 1e-18) & (smaller < radius[active])
        active, nearest, feet, smaller = active[go_on], nearest[go_on], feet[go_on], smaller[go_on]
        radius[active], other[active], far[active] = smaller, nearest, feet
    return radius, other, far


def feet_on(rows: Rows, points: Floats) -> Floats:
    """Return the point (n, 2) of each row (n, 8) nearest to each point (n, 2)."""
    along = rows[:, 2:4] - rows[:, :2]
    share = np.clip(((points - rows[:, :2]) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0.0, 1.0)
    on_line = rows[:, :2] + share[:, None] * along
    arm, turn = points - rows[:, [CX, CY]], rows[:, TURN]
    a, b = rows[:, [X0, Y0]] - rows[:, [CX, CY]], rows[:, [X1, Y1]] - rows[:, [CX, CY]]
    within = (turn * (a[:, 0] * arm[:, 1] - a[:, 1] * arm[:, 0]) >= 0) & (
        turn * (arm[:, 0] * b[:, 1] - arm[:, 1] * b[:, 0]) >= 0
    )
    size = np.hypot(*arm.T)
    on_arc = rows[:, [CX, CY]] + arm * (rows[:, R] / np.maximum(size, 1e-300))[:, None]
    nearer_a = ((points - rows[:, :2]) ** 2).sum(axis=1) <= ((points - rows[:, 2:4]) ** 2).sum(axis=1)
    at_end = np.where(nearer_a[:, None], rows[:, :2], rows[:, 2:4])
    found: Floats = np.where((turn == 0)[:, None], on_line, np.where((within & (size > 0))[:, None], on_arc, at_end))
    return found


def _headings(rows: Rows, at: int) -> Floats:
    """Return the direction (n,) in which each row leaves its begin (at = 0) or comes to its end (at = 2), radians."""
    arm, turn = rows[:, at : at + 2] - rows[:, [CX, CY]], rows[:, TURN]
    along = rows[:, 2:4] - rows[:, :2]
    angle: Floats = np.arctan2(
        np.where(turn == 0, along[:, 1], turn * arm[:, 0]), np.where(turn == 0, along[:, 0], -turn * arm[:, 1])
    )
    return angle


def _unit(angle: Floats) -> Floats:
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _touched(rows: Rows) -> NDArray[np.bool_]:
    """Tell (n,) where another row begins at the same place as each one: contours touch there."""
    from scipy.spatial import cKDTree

    found = np.zeros(len(rows), np.bool_)
    found[cKDTree(rows[:, :2]).query_pairs(_SAME, output_type="ndarray")] = True
    return found


def _in_walls(before: Indices, corner: NDArray[np.bool_]) -> tuple[Indices, NDArray[np.bool_]]:
    """Return rows (n,) in the order of walls, each contour from a corner on if it has one; and which of them (n,) begin
    a wall.
    """
    count = len(before)
    contours = np.split(np.arange(count), np.flatnonzero(before != np.arange(count) - 1)[1:])
    turned = [np.roll(rows, -int(np.argmax(corner[rows]))) for rows in contours]
    along = np.concatenate(turned)
    first = corner[along].copy()
    first[np.cumsum([0, *map(len, turned)])[:-1]] = True
    return along, first


def _limits(primitives: Primitives) -> Floats:
    """Return for each row half the narrower side of the box round its region, and a little more."""
    _, number = np.unique(primitives.region, return_inverse=True)
    boxes = DistanceField.of(primitives.rows).boxes
    low, high = np.full((number.max() + 1, 2), np.inf), np.full((number.max() + 1, 2), -np.inf)
    np.minimum.at(low, number, boxes[:, :2])
    np.maximum.at(high, number, boxes[:, 2:])
    limits: Floats = 1.001 * (high - low).min(axis=1)[number] / 2
    return limits
