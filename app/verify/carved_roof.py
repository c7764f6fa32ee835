"""How much a V cutter has left of what it should carve: looked for on the medial axis, which is found here anew.

Behind each place of a wall, along its normal, lies the largest disc that touches the wall there and holds no other: its
centre c, its radius r. A cone as wide as r at c cuts all that lies between as deep as the wall is far. What cone there
was, as wide as w round p, leaves nowhere between more than r - w + |c - p|, by the triangle's inequality: so what is
left at c bounds what is left all the way to the wall. Discs are found by halving, on the distance field of the drawn
curves alone; nothing is known of how the path was made.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..geometry.distance import DistanceField
from ..geometry.primitives import CX, TURN, Primitives, R, lengths, points_at, sweeps
from ..toolpath.linking.bridge import foot

Floats = NDArray[np.float64]

STEP = 0.05
"""mm along walls between places that are looked at, at most."""

_FEWEST = 8
"""Places on each row, at least."""

_FAN = math.radians(2)
"""Between the normals of a reflex corner, at most."""

_ROUNDS = 10
"""Times that discs are put between those that are farther apart than STEP."""

_SHRINKS, _HALVINGS = 12, 44
_EMPTY = 1e-9
_PORTION = 96
_NEAR = 0.25
"""mm; motions farther than this from a portion's discs are left aside, and asked where the others leave too much."""

_TOO_MUCH = 4e-3
"""mm; less than counts as left."""


@dataclass(frozen=True, eq=False)
class ConePath:
    """Motions of one cone in metal, n of them, straight, part coordinates, the surface at Z 0.

    Attributes:
        start, end: (n, 3) of the tip, mm.
        tip: radius of the flat at the cone's end, mm.
        rate: mm of radius per mm of height.
        greatest: depth that was asked for, mm.
    """

    start: Floats
    end: Floats
    tip: float
    rate: float
    greatest: float


@dataclass(frozen=True)
class RoofProof:
    """What is left of a carving.

    Attributes:
        places: of walls that were looked at.
        left_mm: most that stands above the carved roof, mm of height; 0 = nothing.
        x, y: where.
        above: places behind which more is left than is told of.
        blunt_mm: length of wall that the flat tip is too wide for.
        gap_mm: farthest that discs of neighbouring places are apart; between two of them no more is left than at one
            of them and as much as `gap_mm` makes at the cone's slope.
    """

    places: int
    left_mm: float
    x: float
    y: float
    above: int
    blunt_mm: float
    gap_mm: float


def prove_roof(path: ConePath, walls: Primitives, reported: float, progress: Progress = NO_PROGRESS) -> RoofProof:
    """Return what a path leaves of the roof over regions.

    Args:
        reported: mm of height; what is left beyond it is counted.

    Raises:
        Cancelled: by progress.
    """
    most = path.tip + path.greatest * path.rate
    elements = _Elements.of(walls)
    discs = _discs(elements, DistanceField.of(walls.rows), most, progress.part(0.0, 0.5))
    blunt = discs.radius < path.tip
    left = np.zeros(len(blunt))
    carving = _Carving.of(path)
    chosen = np.flatnonzero(~blunt)
    for first in range(0, len(chosen), _PORTION):
        progress.step(0.5 + 0.5 * first / len(chosen), "Prove what is carved")
        some = chosen[first : first + _PORTION]
        left[some] = _uncarved(carving, discs.centres[some], discs.radius[some])
    height = left / path.rate
    worst = int(np.argmax(height))
    x, y = discs.centres[worst].tolist()
    return RoofProof(
        len(blunt),
        max(0.0, float(height[worst])),
        x,
        y,
        int(np.count_nonzero(height > reported)),
        _blunt_length(elements, discs, blunt),
        float(discs.gaps().max(initial=0.0)),
    )


def _blunt_length(walls: _Elements, discs: _Discs, blunt: NDArray[np.bool_]) -> float:
    """Return the length of wall, mm, of the places that are told apart: each stands for half the way to its
    neighbours.
    """
    same = np.diff(discs.wall) == 0
    between = np.where(same, np.diff(discs.share) / 2, 0.0)
    before = np.where(np.concatenate([[False], same]), np.concatenate([[0.0], between]), discs.share)
    after = np.where(np.concatenate([same, [False]]), np.concatenate([between, [0.0]]), 1.0 - discs.share)
    size = np.concatenate([lengths(walls.rows), np.zeros(len(walls.corners))])[discs.wall]
    return float(((before + after) * size)[blunt].sum())


@dataclass(frozen=True, eq=False)
class _Elements:
    """What discs touch: rows, and behind them the fans of normals at reflex corners, n of both.

    Attributes:
        rows: (m, 8).
        corners: (n - m, 4) places x, y, the angle of the first normal and how far it turns, radians.
    """

    rows: Floats
    corners: Floats

    @staticmethod
    def of(walls: Primitives) -> _Elements:
        rows = walls.rows
        before = rows[walls.previous]
        into, out = _normals(before, before[:, 2:4]), _normals(rows, rows[:, :2])
        turn = np.arctan2(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], np.einsum("ni,ni->n", into, out))
        reflex = turn < -_EMPTY
        angle = np.arctan2(into[reflex, 1], into[reflex, 0])
        return _Elements(rows, np.column_stack([rows[reflex, :2], angle, turn[reflex]]))

    def counts(self) -> NDArray[np.int64]:
        """Return how many places on each are looked at first."""
        on_rows = np.maximum(np.ceil(lengths(self.rows) / STEP), _FEWEST)
        at_corners = np.maximum(np.ceil(-self.corners[:, 3] / _FAN), _FEWEST)
        return np.concatenate([on_rows, at_corners]).astype(np.int64)

    def feet(self, wall: NDArray[np.int64], share: Floats) -> tuple[Floats, Floats]:
        """Return places (k, 2) at fractions (k,) of walls, and their unit normals into the area."""
        feet, normals = np.empty((len(wall), 2)), np.empty((len(wall), 2))
        on = wall < len(self.rows)
        rows = self.rows[wall[on]]
        feet[on] = points_at(rows, share[on])
        normals[on] = _normals(rows, feet[on])
        corners = self.corners[wall[~on] - len(self.rows)]
        angle = corners[:, 2] + corners[:, 3] * share[~on]
        feet[~on], normals[~on] = corners[:, :2], np.stack([np.cos(angle), np.sin(angle)], 1)
        return feet, normals


def _normals(rows: Floats, points: Floats) -> Floats:
    """Return the unit normals (n, 2) of rows at points on them, to the left."""
    way = rows[:, 2:4] - rows[:, :2]
    straight = np.stack([-way[:, 1], way[:, 0]], 1)
    normal = np.where(rows[:, [TURN]] == 0, straight, (rows[:, CX:R] - points) * rows[:, [TURN]])
    unit: Floats = normal / np.maximum(np.hypot(*normal.T), 1e-300)[:, None]
    return unit


@dataclass(frozen=True, eq=False)
class _Discs:
    """The largest discs behind places of walls, in order along each, n of them."""

    wall: NDArray[np.int64]
    share: Floats
    centres: Floats
    radius: Floats

    def gaps(self) -> Floats:
        """Return (n - 1,) how far each centre is from the next one behind the same wall, mm; 0 between walls."""
        apart = np.hypot(*np.diff(self.centres, axis=0).T)
        return np.where(np.diff(self.wall) == 0, apart, 0.0)


def _discs(walls: _Elements, field: DistanceField, most: float, progress: Progress) -> _Discs:
    """Return discs behind all walls; where neighbours are far apart, there are more between them."""
    counts = walls.counts()
    wall = np.repeat(np.arange(len(counts)), counts)
    number = np.arange(len(wall)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (number + 0.5) / counts[wall]
    found = _Discs(wall[:0], share[:0], np.zeros((0, 2)), share[:0])
    for k in range(_ROUNDS):
        feet, normals = walls.feet(wall, share)
        radius = _largest(field, feet, normals, most, progress.part(k / _ROUNDS, (k + 1) / _ROUNDS))
        centres = feet + normals * radius[:, None]
        wall, share = np.concatenate([found.wall, wall]), np.concatenate([found.share, share])
        centres, radius = np.concatenate([found.centres, centres]), np.concatenate([found.radius, radius])
        order = np.lexsort((share, wall))
        found = _Discs(wall[order], share[order], centres[order], radius[order])
        wide = np.flatnonzero(found.gaps() > STEP)
        if not len(wide):
            break
        wall, share = found.wall[wide], (found.share[wide] + found.share[wide + 1]) / 2
    return found


def _largest(field: DistanceField, feet: Floats, normals: Floats, most: float, progress: Progress) -> Floats:
    """Return the radius of the largest disc behind each foot that holds no wall, up to so many mm.

    None that is empty is larger than the one through the foot and any place of a wall, so the place that is nearest to
    a disc's centre makes it smaller until it is empty. What takes longer, as where a wall bends as much as the disc, is
    found by halving: a smaller disc in an empty one is empty.
    """
    found, left = np.full(len(feet), most), np.arange(len(feet))
    for k in range(_SHRINKS):
        progress.step(k / _SHRINKS, "Prove what is carved")
        centres = feet[left] + normals[left] * found[left, None]
        far, row = field.nearest(centres)
        full = far < found[left] - _EMPTY
        left, centres, row = left[full], centres[full], row[full]
        if not len(left):
            return found
        across = foot(field.rows[row], centres) - feet[left]
        ahead = np.einsum("ni,ni->n", across, normals[left])
        through = np.einsum("ni,ni->n", across, across) / np.maximum(2 * ahead, 1e-300)
        found[left] = np.where(ahead > 0, np.minimum(through, found[left]), found[left])
    low, high = np.zeros(len(left)), found[left]
    for _ in range(_HALVINGS):
        radius = (low + high) / 2
        empty = field.nearest(feet[left] + normals[left] * radius[:, None])[0] >= radius - _EMPTY
        low, high = np.where(empty, radius, low), np.where(empty, high, radius)
    found[left] = low
    return found


@dataclass(frozen=True, eq=False)
class _Carving:
    """Motions of a cone, found by where they are.

    Attributes:
        low, high: (n, 2) corners of their boxes. wide: (n,) radius of the cone at the surface, where it is deepest, mm.
        tree: of the boxes.
    """

    path: ConePath
    low: Floats
    high: Floats
    wide: Floats
    tree: shapely.STRtree

    @staticmethod
    def of(path: ConePath) -> _Carving:
        low, high = (pick(path.start[:, :2], path.end[:, :2]) for pick in (np.minimum, np.maximum))
        wide = path.tip - np.minimum(path.start[:, 2], path.end[:, 2]) * path.rate
        return _Carving(path, low, high, wide, shapely.STRtree(shapely.box(*low.T, *high.T)))

    def near(self, centres: Floats, radius: Floats, left: float, far: float) -> NDArray[np.int64]:
        """Return the motions within a distance of some discs, mm, that may leave less of one of them than so much, mm.

        A cone leaves at least the distance of its axis and the disc's radius, less its own at the surface.
        """
        first, last = centres.min(axis=0), centres.max(axis=0)
        around = shapely.box(*(first - far), *(last + far))
        found: NDArray[np.int64] = np.sort(self.tree.query(around))
        beside = np.hypot(*np.maximum(np.maximum(first - self.high[found], self.low[found] - last), 0).T)
        near: NDArray[np.int64] = found[(radius.min() - self.wide[found] + beside <= left) & (beside <= far)]
        return near


def _uncarved(carving: _Carving, centres: Floats, radius: Floats) -> Floats:
    """Return by how much cones are too narrow or too far from discs, mm, each by the motion that is best for it."""
    found = _by_motions(carving.path, carving.near(centres, radius, _NEAR, _NEAR), centres, radius)
    again = np.flatnonzero(found > _TOO_MUCH)
    if len(again):
        near, small = centres[again], radius[again]
        left = min(float(found[again].max()), float(small.max() + np.abs(carving.wide).max()))
        far = max(_NEAR, float(carving.wide.max() - small.min()) + left)
        more = _by_motions(carving.path, carving.near(near, small, left, far), near, small)
        found[again] = np.minimum(found[again], more)
    lost = np.flatnonzero(np.isinf(found))
    if len(lost):
        found[lost] = _by_motions(carving.path, np.arange(len(carving.wide)), centres[lost], radius[lost])
    return found


def _by_motions(path: ConePath, motions: NDArray[np.int64], centres: Floats, radius: Floats) -> Floats:
    if not len(motions):
        return np.full(len(radius), np.inf)
    start, way = path.start[motions, :2], path.end[motions, :2] - path.start[motions, :2]
    size = np.hypot(*way.T)
    first = path.tip - path.start[motions, 2] * path.rate
    growth = (path.start[motions, 2] - path.end[motions, 2]) * path.rate
    unit = way / np.maximum(size, 1e-300)[:, None]
    off = centres[:, None] - start[None]
    along = np.einsum("mni,ni->mn", off, unit)
    aside = np.abs(off[:, :, 0] * unit[:, 1] - off[:, :, 1] * unit[:, 0])
    slope = growth / np.maximum(size, 1e-300)
    gentle = np.clip(slope, -1 + 1e-12, 1 - 1e-12)
    best = along + aside * gentle / np.sqrt(1 - gentle**2)
    share = np.clip(best / np.maximum(size, 1e-300), 0.0, 1.0)
    share = np.where(size > 0, share, np.where(growth > 0, 1.0, 0.0))
    place = start[None] + way[None] * share[:, :, None]
    apart = np.hypot(centres[:, None, 0] - place[:, :, 0], centres[:, None, 1] - place[:, :, 1])
    left: Floats = (apart + radius[:, None] - first[None] - growth[None] * share).min(axis=1)
    return left


def straightened(rows: Floats, heights: Sequence[tuple[float, float]] | Floats, chord: float) -> tuple[Floats, Floats]:
    """Return starts and ends (n, 3) of motions, arcs as chords that stay within so many mm of them."""
    heights = np.asarray(heights)
    turn = np.abs(sweeps(rows))
    step = 2 * np.arccos(np.clip(1 - chord / np.maximum(rows[:, R], chord), 0, 1))
    counts = np.where(rows[:, TURN] == 0, 1, np.maximum(1, np.ceil(turn / step))).astype(np.int64)
    row = np.repeat(np.arange(len(rows)), counts)
    number = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
    begin, end = number / counts[row], (number + 1) / counts[row]
    ends = []
    for share in (begin, end):
        z = heights[row, 0] + (heights[row, 1] - heights[row, 0]) * share
        ends.append(np.column_stack([points_at(rows[row], share), z]))
    return ends[0], ends[1]
