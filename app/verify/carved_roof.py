"""How much a V cutter has left of what it should carve: looked for on the medial axis, which is found here anew.

Behind each place of a wall, along its normal, lies the largest disc that touches the wall there and holds no other: its
centre c, its radius r. A cone as wide as r at c cuts all that lies between as deep as the wall is far. What cone there
was, as wide as w round p, leaves nowhere between more than r - w + |c - p|, by the triangle's inequality: so what is
left at c bounds what is left all the way to the wall. Discs are found on the distance field of the drawn curves alone;
nothing is known of how the path was made.

Regions that a translation brings onto one another, as equal letters are, have the same discs: they are found behind the
walls of one of them, and what was cut is held against them in each place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.pool import in_bands
from ..core.progress import NO_PROGRESS, Progress
from ..geometry.distance import DistanceField
from ..geometry.kernels import build_tree
from ..geometry.outlines import Outlines
from ..geometry.primitives import CX, TURN, Primitives, R, lengths, points_at, sweeps
from . import carved_kernels as kernels

Floats = NDArray[np.float64]

STEP = 0.05
"""mm along walls between places that are looked at, at most."""

_FEWEST = 8
"""Places on each row, at least."""

_FAN = math.radians(2)
"""Between the normals of a reflex corner, at most."""

_ROUNDS = 10
"""Times that discs are put between those that are farther apart than STEP."""

_EMPTY = 1e-9
"""mm that a wall may reach into a disc that counts as empty."""

_SAME = 1e-9
"""mm; what rows of regions that are alike may differ by, and with them the discs: a millionth of what is told."""

_PORTION = 100_000
"""Places between two looks at whether to stop."""


@dataclass(frozen=True, eq=False)
class ConePath:
    """Motions of one cone in metal, n of them, straight, part coordinates, the surface at Z 0.

    Attributes:
        start, end: (n, 3) of the tip, mm.
        tip: radius of the flat at the cone's end, mm.
        rate: mm of radius per mm of height.
        greatest: depth that was asked for, mm.
        flat: radius of the flat at the cutter's own end, mm, where that is wider than the cone's.
    """

    start: Floats
    end: Floats
    tip: float
    rate: float
    greatest: float
    flat: float = 0.0


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
    groups = _alike(walls)
    share = [progress.part(0.5 * k / len(groups), 0.5 * (k + 1) / len(groups)) for k in range(len(groups))]
    widest = max(path.tip, path.flat)
    behind = [_behind(group, widest, most, part) for group, part in zip(groups, share, strict=True)]
    centres = np.concatenate([np.zeros((0, 2)), *(each.centres for each in behind)])
    radius = np.concatenate([np.zeros(0), *(each.radius for each in behind)])
    blunt = radius < path.tip
    left = np.zeros(len(blunt))
    left[~blunt] = _Carving.of(path).uncarved(
        centres[~blunt], radius[~blunt], reported * path.rate, progress.part(0.5, 1.0)
    )
    height = left / path.rate
    worst = int(np.argmax(height))
    x, y = centres[worst].tolist()
    return RoofProof(
        len(blunt),
        max(0.0, float(height[worst])),
        x,
        y,
        int(np.count_nonzero(height > reported)),
        sum(each.blunt_mm for each in behind),
        max(each.gap_mm for each in behind),
    )


@dataclass(frozen=True, eq=False)
class _AlikeRegions:
    """Regions, and where each of them is found again.

    Attributes:
        walls: of the regions.
        shifts: by region, (m, 2) mm from it to where it is, its own place (0, 0) among them.
    """

    walls: Primitives
    shifts: dict[int, Floats]


def _alike(walls: Primitives) -> list[_AlikeRegions]:
    """Return the regions that have no other like them, and of those that have the first ones.

    Alike are regions with bounds that close, the area within, whose rows come to the same within `_SAME`: discs that
    touch one wall and hold none then lie in the region, and are as much alike.
    """
    order = np.argsort(walls.region, kind="stable")
    numbers, begins = np.unique(walls.region[order], return_index=True)
    areas = Outlines(walls.rows[order], np.append(begins, len(order))).areas.tolist()
    place = np.empty(len(order), np.int64)
    first: dict[Hashable, list[tuple[int, Floats]]] = {}
    shifts: dict[int, list[Floats]] = {}
    for number, here, area in zip(numbers.tolist(), np.split(order, begins[1:]), areas, strict=True):
        place[here] = np.arange(len(here))
        rows, previous = walls.rows[here], place[walls.previous[here]]
        shifts[number] = [np.zeros(2)]
        if (rows[previous, 2:4] != rows[:, :2]).any() or area <= 0:
            continue
        at = rows[0, :2].copy()
        rows[:, :CX] -= np.tile(at, 2)
        rows[rows[:, TURN] != 0, CX:R] -= at
        size = tuple(np.round(np.ptp(rows[:, :2], axis=0), 6).tolist())
        known = first.setdefault((previous.tobytes(), rows[:, TURN].tobytes(), size), [])
        same = next((each for each, its in known if np.abs(its - rows).max() <= _SAME), None)
        if same is None:
            known.append((number, rows))
            shifts[number][0] = at
        else:
            del shifts[number]
            shifts[same].append(at - shifts[same][0])
    for places in shifts.values():
        places[0] = np.zeros(2)
    single = [number for number, places in shifts.items() if len(places) == 1]
    several = [number for number in shifts if len(shifts[number]) > 1]
    return [
        _AlikeRegions(_of_regions(walls, some), {number: np.array(shifts[number]) for number in some})
        for some in (single, several)
        if some
    ]


def _of_regions(walls: Primitives, numbers: Sequence[int]) -> Primitives:
    own = np.isin(walls.region, numbers)
    place = np.cumsum(own) - 1
    return Primitives(walls.rows[own], place[walls.previous[own]], walls.region[own])


@dataclass(frozen=True, eq=False)
class _BehindWalls:
    """Discs behind walls, wherever these are; `RoofProof` has the words for the rest.

    Attributes:
        centres, radius: (n, 2) and (n,), mm.
        blunt_mm: length of wall behind which the disc is narrower than the tip.
        gap_mm: the most that neighbouring centres are apart.
    """

    centres: Floats
    radius: Floats
    blunt_mm: float
    gap_mm: float


def _behind(group: _AlikeRegions, tip: float, most: float, progress: Progress) -> _BehindWalls:
    """Return the discs behind the walls of regions, and of all that are like them."""
    elements = _Elements.of(group.walls)
    discs = _discs(elements, DistanceField.of(group.walls.rows), most, progress)
    blunt = np.where(discs.radius < tip, _lengths_of_wall(elements, discs), 0.0)
    region = elements.region[discs.wall]
    order = np.argsort(region, kind="stable")
    numbers, begins = np.unique(region[order], return_index=True)
    centres, radius, blunt_mm = [], [], 0.0
    for number, own in zip(numbers.tolist(), np.split(order, begins[1:]), strict=True):
        shifts = group.shifts[number]
        centres.append((discs.centres[own] + shifts[:, None]).reshape(-1, 2))
        radius.append(np.tile(discs.radius[own], len(shifts)))
        blunt_mm += len(shifts) * float(blunt[own].sum())
    gap = float(discs.gaps().max(initial=0.0))
    return _BehindWalls(np.concatenate(centres), np.concatenate(radius), blunt_mm, gap)


def _lengths_of_wall(walls: _Elements, discs: _Discs) -> Floats:
    """Return the length of wall (n,), mm, that each place stands for: half the way to its neighbours."""
    same = np.diff(discs.wall) == 0
    between = np.where(same, np.diff(discs.share) / 2, 0.0)
    before = np.where(np.concatenate([[False], same]), np.concatenate([[0.0], between]), discs.share)
    after = np.where(np.concatenate([same, [False]]), np.concatenate([between, [0.0]]), 1.0 - discs.share)
    size: Floats = np.concatenate([lengths(walls.rows), np.zeros(len(walls.corners))])[discs.wall]
    return (before + after) * size


@dataclass(frozen=True, eq=False)
class _Elements:
    """What discs touch: rows, and behind them the fans of normals at reflex corners, n of both.

    Attributes:
        rows: (m, 8).
        corners: (n - m, 4) places x, y, the angle of the first normal and how far it turns, radians.
        region: (n,) numbers of their regions.
    """

    rows: Floats
    corners: Floats
    region: NDArray[np.int64]

    @staticmethod
    def of(walls: Primitives) -> _Elements:
        rows = walls.rows
        before = rows[walls.previous]
        into, out = _normals(before, before[:, 2:4]), _normals(rows, rows[:, :2])
        turn = np.arctan2(into[:, 0] * out[:, 1] - into[:, 1] * out[:, 0], np.einsum("ni,ni->n", into, out))
        # a row without one before it, as where something else bounds the area, begins at no corner
        reflex = (turn < -_EMPTY) & (walls.previous != np.arange(len(rows)))
        angle = np.arctan2(into[reflex, 1], into[reflex, 0])
        corners = np.column_stack([rows[reflex, :2], angle, turn[reflex]])
        return _Elements(rows, corners, np.concatenate([walls.region, walls.region[reflex]]))

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
    """The largest discs behind places of walls, in order along each, n of them.

    Attributes:
        wall: number of the element. share: of its length, in [0, 1].
        centres, radius: (n, 2) and (n,), mm.
    """

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
    """Return the radius of the largest disc behind each foot that holds no wall, up to so many mm."""
    found = np.empty(len(feet))

    def measure(some: slice) -> None:
        kernels.largest_empty(
            field.rows, field.order, field.nodes, feet[some], normals[some], most, _EMPTY, found[some]
        )

    _in_portions(measure, len(feet), progress)
    return found


def _in_portions(work: Callable[[slice], None], count: int, progress: Progress) -> None:
    """Have so many things done on all cores, in portions between which the job may be stopped."""
    for first in range(0, count, _PORTION):
        progress.step(first / count, "Prove what is carved")

        def some(part: slice, begin: int = first) -> None:
            work(slice(begin + part.start, begin + part.stop))

        in_bands(some, min(_PORTION, count - first))


@dataclass(frozen=True, eq=False)
class _Carving:
    """Motions of a cone, found by where they are and how wide it is there.

    Attributes:
        motions: (n, 7) as `kernels.least_left` wants them.
        order, nodes: tree of their boxes. widest: of the cone on the motions below each node, mm.
    """

    motions: Floats
    order: NDArray[np.int64]
    nodes: Floats
    widest: Floats

    @staticmethod
    def of(path: ConePath) -> _Carving:
        start, way = path.start[:, :2], path.end[:, :2] - path.start[:, :2]
        size = np.hypot(*way.T)
        unit = way / np.maximum(size, 1e-300)[:, None]
        first = path.tip - path.start[:, 2] * path.rate
        growth = (path.start[:, 2] - path.end[:, 2]) * path.rate
        motions = np.column_stack([start, unit, size, first, growth])
        boxes = np.hstack([pick(start, path.end[:, :2]) for pick in (np.minimum, np.maximum)])
        order, nodes = build_tree(boxes) if len(boxes) else (np.zeros(0, np.int64), np.zeros((0, 4)))
        widest = np.empty(len(nodes))
        kernels.widest_below(motions, order, nodes, widest)
        return _Carving(motions, order, nodes, widest)

    def uncarved(self, centres: Floats, radius: Floats, reported: float, progress: Progress) -> Floats:
        """Return by how much cones are too narrow or too far from discs, mm, each by the motion that is best for it.

        Exact where it is more than `reported`, and where it is most of all.
        """
        left = np.full(len(radius), np.inf)
        if not len(self.motions):
            return left

        def measure(some: slice) -> None:
            kernels.least_left(
                self.motions,
                self.order,
                self.nodes,
                self.widest,
                centres[some],
                radius[some],
                reported,
                0.0,
                left[some],
            )

        _in_portions(measure, len(radius), progress)
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
