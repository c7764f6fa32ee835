"""Squares that hold all of an area that some cutters may not have covered; everything else is proven covered.

The distance from a path changes by no more than the way gone, so one exact distance, from a square's centre, can decide
the whole square: covered, when the cutter reaches its farthest corner; untouched, when it does not reach its nearest
point. What neither proves is divided in four, down to a fraction of the cutter's radius. There a square on a wall is
left, which never lies within reach as a whole; it is covered where one stretch of the path covers all corners of what
of it is wanted (`swath_kernels`). At joints of a path, where no one stretch does, still smaller squares are looked at.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core.memory import portion
from ...core.pool import in_bands
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.near_points import groups
from ...geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, Indices, R, Rows, sweeps, within_half_turn
from ...model.job import Job
from ...model.moves import Area, Program
from ...model.operation import Side
from .areas import CutterInArea, Shapes, each_with_each, gathered, grown, region_shapes, unions, united
from .floor_target import CHORD, FITS, FloorTarget, areas_of_operations, cutters_of

_FINEST = 8
"""The smallest squares' half side on a wall goes so many times into the smallest cutter's radius."""

_SMALLEST = 256
"""The same at joints of a path; there squares get as small as `_SLACK`, within which the disc at a joint covers all."""

_START = 32
"""Squares along the area's longer side at the beginning."""

_SLACK = 3e-3
"""mm beyond a cutter's radius that count as covered: more than chords and what counts as fitting are off at a corner,
less than half of the thinnest strip that counts as left. Boxes are as much larger, so that nothing of such a strip is
taken away: a disc in it that is wider than this comes no farther than this out of what is deeper.
"""

_SAME = 1e-4
"""mm by which two arcs that follow one another may miss being one."""

_WORTH_TWO_CORES = 500
"""Squares from which a second core is worth its start."""

_ROUNDING = 1e-9
"""mm; more than a distance is off by."""

_AT_A_TIME, _SQUARE_BYTES = 1 << 20, 250
"""Squares that are looked at together, few enough to be stopped between them, and what one takes meanwhile."""

_EDGES_AT_A_TIME, _EDGE_BYTES = 400_000, 160
"""Edges of an area that are looked at together, and what one takes with its tree."""

Floats = NDArray[np.float64]

States = NDArray[np.uint8]


def uncertain(
    target: Shape, paths: Sequence[tuple[Rows, float]], progress: Progress = NO_PROGRESS
) -> NDArray[np.object_]:
    """Return boxes (n,) that hold every point of a wanted area that is not proven covered.

    Args:
        target: polygons with no inside in common, mm.
        paths: (rows (m, 8) of a path, radius of its cutter, mm, > 0); rows may sweep up to a full turn.
        progress: looked at between sizes of squares.
    """
    swaths = [_Swath.of(rows, radius) for rows, radius in paths if len(rows)]
    if target.is_empty or not swaths:
        return np.array([] if target.is_empty else [shapely.box(*target.bounds)], dtype=object)
    portions = _portions(target)
    if len(portions) > 1 and not any(
        len(_undecided(shapely.multipolygons(each), swaths, progress)) for each in portions
    ):
        return np.zeros(0, dtype=object)
    return _undecided(target, swaths, progress)


def _portions(target: Shape) -> list[NDArray[np.object_]]:
    """Return the polygons of an area in portions whose edges are not too many to be held with all that is known of
    them.
    """
    shapes, most = shapely.get_parts(target), min(_EDGES_AT_A_TIME, portion(_EDGE_BYTES))
    upto = np.cumsum(shapely.get_num_coordinates(shapes))
    return np.split(shapes, np.flatnonzero(np.diff(upto // most)) + 1)


def _undecided(target: Shape, swaths: Sequence[_Swath], progress: Progress) -> NDArray[np.object_]:
    """Return `uncertain` of an area beside some paths."""
    from .swath_kernels import COVERED, OPEN, OUTSIDE

    area, least = DistanceField.of(_edges(target)), min(each.radius for each in swaths)
    most_reach = max(each.radius for each in swaths) + _SLACK
    kept: list[NDArray[np.object_]] = []
    centres, half = _grid(target.bounds)
    waiting = [(centres, half, np.zeros(len(centres), np.bool_))]
    while waiting:
        centres, half, within = waiting.pop()
        if len(centres) > (most := min(_AT_A_TIME, portion(_SQUARE_BYTES))):
            waiting += [
                (centres[first : first + most], half, within[first : first + most])
                for first in range(0, len(centres), most)
            ]
            continue
        progress.step(0.0, "Measuring what is left")
        q = half * math.sqrt(2)
        # what lies deep enough in one stretch need not be known to lie deeper in another
        beside = [
            each.field.nearest(centres, each.radius + _SLACK + 2 * q, each.radius - q - _ROUNDING) for each in swaths
        ]
        uncut = np.min([far - each.radius for (far, _), each in zip(beside, swaths, strict=True)], axis=0)
        doubtful = uncut > -q
        centres, within, uncut = centres[doubtful], within[doubtful], uncut[doubtful]
        if half > most_reach:
            states = _wide_states(area, centres, half, within)
        else:
            near = [
                _NearestRows(each, near[doubtful], far[doubtful])
                for (far, near), each in zip(beside, swaths, strict=True)
            ]
            states = _states(area, near, _Squares.of(centres, half, within, area))
        open_still = (states != OUTSIDE) & (states != COVERED)
        centres, within, uncut, states = (each[open_still] for each in (centres, within, uncut, states))
        left = (uncut >= q) | (half <= min(least / _SMALLEST, _SLACK / 3))
        if half <= least / _FINEST:
            left |= states != OPEN
        kept.append(_runs(centres[left], half))
        if not left.all():
            waiting.append((quarters(centres[~left], half / 2), half / 2, np.repeat(within[~left], 4)))
    return np.concatenate(kept) if kept else np.zeros(0, dtype=object)


@dataclass(frozen=True, eq=False)
class _Swath:
    """A path and what is known of it.

    Attributes:
        field: its rows, arcs below half a turn. radius: of its cutter, mm.
        sectors: (n, 2) from which angle, and how far round, each arc's circle is covered by it and the arcs next to it,
            radians.
    """

    field: DistanceField
    radius: float
    sectors: Floats

    @staticmethod
    def of(rows: Rows, radius: float) -> _Swath:
        """Return it for rows (n, 8), n > 0."""
        parts = within_half_turn(rows)
        return _Swath(DistanceField.of(parts), radius, _sectors(parts))


@dataclass(frozen=True, eq=False)
class _Squares:
    """Squares of one size.

    Attributes:
        centres: (n, 2). half: their half side, mm.
        within: (n,) True for those that are known to be wanted as a whole; those that are found to be are written.
        left: (n, 2) of the others, whether their lower and their upper corner on the left are wanted.
    """

    centres: Floats
    half: float
    within: NDArray[np.bool_]
    left: NDArray[np.bool_]

    def some(self, which: Indices) -> _Squares:
        """Return some of them."""
        return _Squares(self.centres[which], self.half, self.within[which], self.left[which])

    @staticmethod
    def of(centres: Floats, half: float, within: NDArray[np.bool_], area: DistanceField) -> _Squares:
        """Return squares of an area."""
        left, unknown = np.ones((len(centres), 2), np.bool_), np.flatnonzero(~within)
        corners = centres[unknown, None] + np.array([[-half, -half], [-half, half]])
        left[unknown] = area.inside(corners.reshape(-1, 2)).reshape(-1, 2)
        return _Squares(centres, half, within, left)


@dataclass(frozen=True, eq=False)
class _NearestRows:
    """A path, its row nearest to each of some squares' centres (n,), -1 for none, and how far that is (n,), mm."""

    swath: _Swath
    near: Indices
    far: Floats


def _wide_states(area: DistanceField, centres: Floats, half: float, within: NDArray[np.bool_]) -> States:
    """Return what of squares is wanted that are wider than any stretch of a path cuts: some of it may be uncut.

    Args:
        centres, half, within: as of `_Squares`.
    """
    from .swath_kernels import OPEN, OUTSIDE

    beside = area.nearest(centres, half * math.sqrt(2))[1] >= 0
    alone = np.flatnonzero(~beside & ~within)
    within[alone] = area.inside(centres[alone])
    return np.where(beside | within, np.uint8(OPEN), np.uint8(OUTSIDE))


def _states(area: DistanceField, paths: Sequence[_NearestRows], squares: _Squares) -> States:
    """Return what of squares is wanted and covered, by numbers of `swath_kernels`: UNCUT is what all paths leave
    something of.
    """
    from .swath_kernels import COVERED, OPEN, OUTSIDE, UNCUT

    states = np.full(len(squares.centres), UNCUT, np.uint8)
    for each in paths:
        requested = np.flatnonzero((states != COVERED) & (states != OUTSIDE))
        some = squares.some(requested)
        found = _judged(area, _NearestRows(each.swath, each.near[requested], each.far[requested]), some)
        squares.within[requested] = some.within
        states[requested] = np.where((found == UNCUT) & (states[requested] == OPEN), np.uint8(OPEN), found)
    return states


def _judged(area: DistanceField, path: _NearestRows, squares: _Squares) -> States:
    """Return what of some squares is wanted and covered by one path."""
    from .swath_kernels import judge

    count, field, reach = len(squares.centres), path.swath.field, path.swath.radius + _SLACK
    found = np.empty(count, np.uint8)

    def look(band: slice) -> None:
        judge(
            area.rows,
            area.order,
            area.nodes,
            field.rows,
            field.order,
            field.nodes,
            path.swath.sectors,
            reach,
            squares.centres[band],
            squares.half,
            path.near[band],
            path.far[band],
            squares.within[band],
            squares.left[band],
            found[band],
        )

    in_bands(look, count, _WORTH_TWO_CORES)
    return found


def _edges(area: Shape) -> Rows:
    """Return the edges of polygons as rows (n, 8)."""
    rings = shapely.get_rings(shapely.get_parts(area))
    points, ring = shapely.get_coordinates(rings, return_index=True)
    on = np.flatnonzero(ring[1:] == ring[:-1])
    rows = np.zeros((len(on), 8))
    rows[:, :2], rows[:, 2:4] = points[on], points[on + 1]
    return rows


def _sectors(rows: Rows) -> Floats:
    """Return (n, 2) in which sector each arc's circle is covered by the arc and those that go on from it; see
    `_Swath`.
    """
    arc, before = rows[1:, TURN] != 0, rows[:-1]
    circle = np.abs(rows[1:, CX : R + 1] - before[:, CX : R + 1]).max(axis=1, initial=0.0) <= _SAME
    meets = np.abs(rows[1:, X0 : Y0 + 1] - before[:, X1 : Y1 + 1]).max(axis=1, initial=0.0) <= _SAME
    run = np.concatenate([[0], np.cumsum(~(arc & circle & meets & (rows[1:, TURN] == before[:, TURN])))])
    first, last = np.searchsorted(run, run, "left"), np.searchsorted(run, run, "right") - 1
    spread = np.max([_by_run(rows[:, k], run) for k in (CX, CY, R)], axis=0)[run]
    first, last = (np.where(spread <= _SAME, each, np.arange(len(rows))) for each in (first, last))
    sweep = np.concatenate([[0.0], np.cumsum(np.abs(sweeps(rows)))])
    ccw = rows[:, TURN] > 0
    x, y = (np.where(ccw, rows[first, a], rows[last, b]) for a, b in ((X0, X1), (Y0, Y1)))
    far = np.minimum(sweep[last + 1] - sweep[first], math.tau)
    return np.ascontiguousarray(np.column_stack([np.arctan2(y - rows[:, CY], x - rows[:, CX]), far]))


def _by_run(values: Floats, run: NDArray[np.int64]) -> Floats:
    """Return for each run by how much its values differ."""
    starts = np.flatnonzero(np.diff(run, prepend=-1))
    return np.asarray(np.maximum.reduceat(values, starts) - np.minimum.reduceat(values, starts))


def _runs(centres: Floats, half: float) -> NDArray[np.object_]:
    """Return boxes round squares of one size, wider by `_SLACK` all round; those side by side share one."""
    if not len(centres):
        return np.zeros(0, dtype=object)
    column, row = np.round((centres - centres.min(axis=0)) / (2 * half)).astype(np.int64).T
    order = np.lexsort((column, row))
    column, row = column[order], row[order]
    first = np.concatenate([[True], (np.diff(row) != 0) | (np.diff(column) != 1)])
    last = np.concatenate([first[1:], [True]])
    low, high = centres[order][first] - half - _SLACK, centres[order][last] + half + _SLACK
    return np.asarray(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]), dtype=object)


def _grid(bounds: tuple[float, float, float, float]) -> tuple[Floats, float]:
    """Return (centres (n, 2), half side): binary fractions, so that edges of squares of all sizes meet to the last
    digit.
    """
    x0, y0, x1, y1 = bounds
    half = 2.0 ** math.ceil(math.log2(max(x1 - x0, y1 - y0) / _START / 2))
    x, y = (
        np.arange(math.floor(low / half / 2), math.ceil(high / half / 2)) * 2 * half + half
        for low, high in ((x0, x1), (y0, y1))
    )
    return np.stack(np.meshgrid(x, y), -1).reshape(-1, 2), half


def quarters(centres: Floats, half: float) -> Floats:
    """Return the centres of the four quarters, of half side `half`, of each square."""
    corners = np.array([[-half, -half], [half, -half], [-half, half], [half, half]])
    parts: Floats = (centres[:, None] + corners).reshape(-1, 2)
    return parts


# Floor that needs no polygons: what is proven cleared by cutters that keep off the walls is within reach, too.
#
# What a cutter covers whose centre stays its radius from the walls is within its reach by definition. So squares that
# such moves alone cover have nothing left and nothing out of reach; polygons are made round the other squares only.


_SAME_FLOOR = 1e-9
"""mm between floors that are one."""

_SPARE = 0.1
"""mm of floor more than can have a say in what is reached."""


@dataclass(frozen=True, eq=False)
class SingleFloor:
    """The one floor of a job.

    Attributes:
        open: what is wanted in the boxes; None where there are none.
        all: what is wanted on all of the floor.
        tiles: boxes that hold every point of the floor that is not proven covered.
    """

    open: FloorTarget | None
    all: FloorTarget
    tiles: NDArray[np.object_]


def one_floor(program: Program, job: Job) -> Area | None:
    """Return the area of a job that clears all of one area down to one floor and its walls, by flat tools; None for any
    other job.
    """
    areas = areas_of_operations(program, job)
    works = [
        (each, area) for each, area in zip(job.operations, areas, strict=True) if each.cut.enabled and area.regions
    ]
    if not works or program.tabs or program.dog_bones or program.allowance_mm:
        return None
    operation, first = works[0]
    for each, area in works:
        cut, outside = each.cut, each.wall_side is not Side.INSIDE
        elsewhere = (
            area.regions is not first.regions
            or area.lines
            or area.bare
            or abs(cut.floor - operation.cut.floor) >= _SAME_FLOOR
        )
        other = not job.tool(cut.tool).kind.square
        if elsewhere or outside or other or cut.stock_to_leave:
            return None
    return first if any(each.COARSE for each, _ in works) else None


def settled(program: Program, job: Job, paths: Sequence[tuple[Rows, float]], progress: Progress) -> SingleFloor | None:
    """Return the floor of a job that has but one (`one_floor`), with what of it is in doubt told apart; None where all
    is.

    Args:
        paths: (rows, radius, mm) of moves as deep as the floor that keep off the walls by at least their radius.

    Raises:
        Cancelled: by progress.
    """
    area = one_floor(program, job)
    shapes = region_shapes(area.regions, CHORD) if area else np.zeros(0, dtype=object)
    if not len(shapes) or not any(len(rows) for rows, _ in paths):
        return None
    floor = gathered(shapes)
    tiles = uncertain(floor, paths, progress)
    depth, cutters = cutters_of(program, job)
    known = FloorTarget(depth, floor, floor, floor, whole=True, cutters=cutters, out_of_reach=shapely.Polygon())
    if not len(tiles):
        return SingleFloor(None, known, tiles)
    near, reach = _around(shapes, tiles, cutters)
    some = FloorTarget(depth, near, reach, reach, whole=True, cutters=cutters)
    return SingleFloor(some, replace(known, out_of_reach=some.beyond), tiles)


def _around(shapes: Shapes, tiles: Shapes, cutters: Sequence[CutterInArea]) -> tuple[Shape, Shape]:
    """Return what of a floor lies in boxes, and what of that cutters reach: their openings of the floor.

    Boxes that touch are asked together, and as much of the floor round them as can have a say in it. It is cut off
    there as if by walls, which are too far away to keep a cutter from the boxes.

    Args:
        shapes: (n,) polygons of the floor's regions. tiles: (m,) boxes that do not overlap.
    """
    number = groups(len(tiles), np.column_stack(shapely.STRtree(tiles).query(tiles, predicate="intersects")))
    order = np.argsort(number, kind="stable")
    lumps = unions(np.split(tiles[order], np.flatnonzero(np.diff(number[order])) + 1))
    far = max(each.wall for each in cutters) + max(each.radius for each in cutters) + _SPARE
    x0, y0, x1, y1 = shapely.bounds(lumps).T
    lump, pieces = cut_out(shapes, np.asarray(shapely.box(x0 - far, y0 - far, x1 + far, y1 + far), dtype=object))
    floors = each_with_each(shapely.intersection, pieces, lumps[lump])
    reached = [each_with_each(partial(_reached, each), pieces, floors) for each in cutters]
    return gathered(floors), united([gathered(each) for each in reached])


def _reached(cutter: CutterInArea, pieces: Shapes, floors: Shapes, grid_size: float | None = None) -> Shapes:
    """Return what a cutter reaches of floors (n,) that stays in pieces (n,) of an area; on a grid where it is asked for
    so.
    """
    opened = grown(grown(pieces, FITS - cutter.wall, CHORD), cutter.radius - FITS, CHORD)
    return np.asarray(shapely.intersection(opened, floors, grid_size=grid_size), dtype=object)


# What of polygons lies in each of many boxes: each box is brought to the library with the rings that come near it
# alone.
#
# A plate with thousands of holes is one polygon. To intersect it with as many boxes, one after the other, takes as
# long as both numbers multiplied.


_FEW_POINTS = 1000
"""Of a ring; one of more points is cut in halves before boxes are cut out of it, until few boxes are left."""

_FEW_BOXES = 4
"""Boxes that are cut out of a ring as it is, however many points it has."""


def cut_out(shapes: Shapes, boxes: Shapes) -> tuple[Indices, Shapes]:
    """Return (box (k,), what of one polygon lies in it (k,)), nothing of polygons that have no part in a box.

    Args:
        shapes: (n,) polygons. boxes: (m,) rectangles along the axes; they may overlap.
    """
    rings, owner = shapely.get_rings(shapes, return_index=True)
    filled = np.asarray(shapely.polygons(rings), dtype=object)
    hole = owner[1:] == owner[:-1]  # a polygon's outline comes first
    hole = np.concatenate([[False], hole])
    box, ring = shapely.STRtree(filled).query(boxes)
    pieces = _pieces(filled, boxes, ring, box)
    there = ~shapely.is_empty(pieces)
    box, ring, pieces = box[there], ring[there], pieces[there]
    key, inner = box * len(shapes) + owner[ring], hole[ring]
    outer = np.flatnonzero(~inner)
    of, which = np.unique(key[outer], return_inverse=True)  # one outline a box and a polygon
    kept = outer[np.argsort(which, kind="stable")]
    within = np.flatnonzero(inner)[np.isin(key[inner], of)]
    holes = np.full(len(of), shapely.Polygon(), dtype=object)
    at, first = np.unique(np.searchsorted(of, np.sort(key[within])), return_index=True)
    order = within[np.argsort(key[within], kind="stable")]
    holes[at] = unions([pieces[some] for some in np.split(order, first[1:])]) if len(at) else []
    left = each_with_each(shapely.difference, pieces[kept], holes)
    some = ~shapely.is_empty(left)
    return box[kept][some], left[some]


def _pieces(filled: Shapes, boxes: Shapes, ring: Indices, box: Indices) -> Shapes:
    """Return what of rings (k,), filled, lies in a box (k,) of its own each."""
    pieces = np.empty(len(ring), dtype=object)
    long = shapely.get_num_coordinates(filled)[ring] > _FEW_POINTS
    pieces[~long] = each_with_each(shapely.intersection, filled[ring[~long]], boxes[box[~long]])
    requested = np.flatnonzero(long)
    requested = requested[np.argsort(ring[requested], kind="stable")]
    for some in np.split(requested, np.flatnonzero(np.diff(ring[requested])) + 1):
        if len(some):
            for part, number in _halved(filled[ring[some[0]]], boxes[box[some]], some):
                pieces[number] = shapely.intersection(part, boxes[box[number]])
    return pieces


def _halved(shape: Shape, boxes: Shapes, numbers: Indices) -> Iterator[tuple[Shape, Indices]]:
    """Yield (what of a shape is round some of the boxes, their numbers): few boxes, or few points."""
    if len(numbers) <= _FEW_BOXES or shapely.get_num_coordinates(shape) <= _FEW_POINTS:
        yield shape, numbers
        return
    bounds = shapely.bounds(boxes)
    middle = bounds[:, :2] + bounds[:, 2:]
    order = np.argsort(middle[:, int(np.ptp(middle[:, 1]) > np.ptp(middle[:, 0]))], kind="stable")
    for half in (order[: len(order) // 2], order[len(order) // 2 :]):
        round_it = shapely.box(*bounds[half, :2].min(axis=0), *bounds[half, 2:].max(axis=0))
        yield from _halved(shapely.intersection(shape, round_it), boxes[half], numbers[half])
