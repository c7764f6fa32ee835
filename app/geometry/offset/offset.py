"""Exact offset of whole regions: lines and arcs in, lines and arcs out, one ring set a level.

A level is the set of points at a given distance from the drawing, on the side of the area to machine (step 120 and
the frames of steps 142-148). Every ring comes from the drawing itself, never from another ring, so nothing drifts.

Method: each line and arc is moved to its left by the level, each vertex at which the boundary turns right becomes an
arc; the parts of these to which any primitive comes nearer than the level are cut away in closed form; what remains is
stitched into rings. Then every move is proven, along its whole length and in other closed forms, to keep its distance
from the whole drawing. A level that does not close or measures wrong is tried again a fraction of a micrometre further
in, and falls back to a fine polyline at last.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core import tolerances
from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...model.part import Contour
from ..distance import DistanceField
from ..primitives import (
    CX,
    TURN,
    Indices,
    Primitives,
    Rows,
    contour_rows,
    lengths,
    points_at,
    reversed_rows,
    row_curve,
    sample,
    signed_area,
    within_half_turn,
)
from . import clearance_kernels as offset_clearance_kernels
from . import offset_kernels, ring_kernels
from . import tree_kernels as offset_tree_kernels
from . import trim_kernels as offset_trim_kernels

_WORTH_TWO_CORES = 2000
"""Pieces from which a second core is worth its start."""

_FEW = 64
"""Rows among which it is not worth looking for those that can still block."""

_BANDS = 4
"""Bands at least: uneven ones keep both cores at work until the end."""

_BAND = 10_000
"""Pieces that are cut in less than a fifth of a second."""

_BAY = 50
"""A corner of 2.3 degrees goes back by so many times what its ring goes in; what goes back farther is a bay."""

_EXACT = 8e-7
"""How far from its level a path of lines and arcs may measure, mm; more, up to the path's own tolerance, if nothing
else closes.
"""

_NUDGES = (0.0, 1e-7, 3.3e-7, 7.1e-7, -1.3e-7)
"""mm by which a level is moved where rings do not close on it: what touches at one place alone crosses beside it, or
not at all.
"""

_ATTEMPTS = tuple((nudge, limit) for limit in (_EXACT, tolerances.LEVEL / 2) for nudge in _NUDGES)
"""Nudge and limit of each try, mm, the exact limit first."""


@dataclass(frozen=True)
class Ring:
    """A closed path at one distance from the drawing; the area to machine beyond it lies to its left.

    Attributes:
        rows: (n, 8) lines and arcs, each beginning exactly where the one before ends.
        region: number of the region.
        area: signed area, mm2; negative round an island.
        length: mm.
        polyline: True when the exact way failed and this is a fine polyline within tolerance.
    """

    rows: Rows
    region: int
    area: float
    length: float
    polyline: bool = False


@dataclass(frozen=True)
class OffsetLevel:
    """All rings at one distance, mm, from the drawing."""

    distance: float
    rings: tuple[Ring, ...]


def offset_levels(
    primitives: Primitives, levels: Sequence[float], progress: Progress = NO_PROGRESS, *, frame: bool = False
) -> tuple[OffsetLevel, ...]:
    """Return the rings at each of some distances from a drawing.

    Args:
        primitives: closed contours, the area to the left.
        levels: distances, mm, > 0, rising.
        progress: looked at between levels, and within levels of many pieces.
        frame: the first level is an outermost frame: a tool that fits a slot or a hole exactly goes there too,
            along a ring that is as good as a line or a point.

    Returns:
        One Level a distance, in order; without rings where nothing is that far from the drawing.

    Raises:
        Cancelled: by progress.

    References:
        Levels of one distance field instead of the peeling of steps 301-307, whose offsets of offsets drift.
    """
    if len(primitives.rows) == 0:
        return tuple(OffsetLevel(d, ()) for d in levels)
    engine = _Engine(primitives)
    result = []
    for k, distance in enumerate(levels):
        if engine.exhausted:
            break
        progress.step(k / len(levels), f"Offset {distance:.3f} mm")
        part = progress.part(k / len(levels), (k + 1) / len(levels))
        result.append(
            OffsetLevel(distance, engine.frame(distance, part) if frame and k == 0 else engine.rings(distance, part))
        )
    return *result, *(OffsetLevel(distance, ()) for distance in levels[len(result) :])


class RowTree(NamedTuple):
    """A tree of boxes over runs of rows, as the kernels read it: the order of the rows, boxes of runs, and of nodes."""

    order: Indices
    runs: Rows
    nodes: Rows


class _Engine:
    """Keeps what is still free of each element from one level to the next."""

    def __init__(self, primitives: Primitives) -> None:
        origin = (primitives.rows[:, :2].min(axis=0) + primitives.rows[:, :2].max(axis=0)) / 2
        self._shift = np.concatenate([origin, origin, origin, [0, 0]])
        rows = primitives.rows - self._shift
        rows[rows[:, TURN] == 0, CX:] = 0.0
        self._primitives = primitives
        self._rows = rows
        self._field = DistanceField.of(rows)
        self._tree = RowTree(*offset_tree_kernels.build_runs(rows, self._field.boxes))
        self._slack = 2e-13 * max(float(np.abs(rows[:, :4]).max()), 100.0)
        self._angles = np.empty((2 * len(rows), 2))
        offset_kernels.element_angles(rows, primitives.previous, self._angles)
        elements = np.concatenate([np.arange(len(rows)), len(rows) + np.flatnonzero(self._angles[len(rows) :, 1] < 0)])
        self._active = np.zeros((len(elements), 3))
        self._active[:, 0], self._active[:, 2] = elements, 1.0
        self._levels = [0.0]
        self._live = np.zeros(len(rows))
        self._blockers = self._tree

    @property
    def exhausted(self) -> bool:
        """Tell whether nothing is as far from the drawing as the last level."""
        return len(self._active) == 0

    def frame(self, distance: float, progress: Progress) -> tuple[Ring, ...]:
        """Return the rings at the first distance; for regions that the tool passes only just, those at FIT or NOMINAL
        less.
        """
        loose = _by_region(self.rings(distance - tolerances.NOMINAL, progress, keep_ridges=True))
        tight = _by_region(self.rings(distance - tolerances.FIT, progress, keep_ridges=True))
        true = _by_region(self.rings(distance, progress))
        chosen: list[Ring] = []
        for region, wide in loose.items():
            near, exact = tight.get(region, []), true.get(region, [])
            if not _alike(wide, near, tolerances.NOMINAL):
                chosen += wide
            else:
                chosen += exact if _alike(near, exact, tolerances.FIT) else near
        return tuple(chosen)

    def rings(self, distance: float, progress: Progress, keep_ridges: bool = False) -> tuple[Ring, ...]:
        """Return the rings at the next distance, which is greater than the last one."""
        if len(self._active) == 0:
            return ()
        self._blockers = self._still_blocking(distance)
        for nudge, limit in _ATTEMPTS:
            pieces = self._trim(distance + nudge, progress)
            rings = self._stitch(pieces, distance + nudge, limit)
            if rings is not None:
                break
        else:
            pieces, rings = self._trim(distance, progress), self._polylines(distance)
        self._active = pieces
        if len(self._blockers.order) > _FEW:
            self._levels.append(distance)
            self._live[pieces[:, 0].astype(np.int64) % len(self._rows)] = distance
        return tuple(ring for ring in rings if keep_ridges or not _on_a_ridge(ring))

    def _still_blocking(self, distance: float) -> RowTree:
        """Return a tree of the rows that can be nearest to any point of this level.

        A point left of a level `last` by distance - last at most is nearer to no row than 2 last - distance, and the
        row that is nearest was then still live at every level up to that.
        """
        if len(self._blockers.order) <= _FEW:
            return self._blockers
        safe = max(2 * self._levels[-1] - distance - 1e-6, 0.0)
        known = self._levels[bisect.bisect_right(self._levels, safe) - 1]
        return RowTree(*offset_trim_kernels.blockers(self._rows, self._field.boxes, *self._blockers, self._live, known))

    def _trim(self, distance: float, progress: Progress) -> Rows:
        """Return the pieces (m, 3) of elements to which nothing is nearer than the distance; many are cut on two
        cores.
        """

        def trimmed(active: Rows) -> Rows:
            pieces: Rows = offset_trim_kernels.trim(
                self._rows, self._field.boxes, *self._blockers, self._angles, active, distance, self._slack
            )
            return pieces

        if len(self._active) < _WORTH_TWO_CORES:
            return trimmed(self._active)
        bands, parts = np.array_split(self._active, max(_BANDS, len(self._active) // _BAND)), []
        for k, part in enumerate(pool().map(trimmed, bands)):
            parts.append(part)
            progress.step(k / len(bands))
        return np.concatenate(parts)

    def _stitch(self, pieces: Rows, distance: float, limit: float) -> list[Ring] | None:
        """Return closed rings made of all pieces, or None when one has no continuation, measures wrong or lies
        outside.
        """
        apart = max(2e-5, 8 * math.sqrt(self._slack * distance))
        closed, joined, owners, table = ring_kernels.close(
            self._rows, *self._tree[:2], self._angles, pieces, distance, apart, tolerances.RIDGE
        )
        if not closed or not self._measure_right(joined, owners, distance, limit):
            return None
        ring_kernels.shift(joined, self._shift[0], self._shift[1])
        still = np.concatenate([[0], np.cumsum((joined[:, :2] == joined[:, 2:4]).all(axis=1))])
        first, stop, owner = table[:, [0, 1, 4]].T.astype(np.int64)
        each = zip(
            first.tolist(),
            stop.tolist(),
            (still[stop] > still[first]).tolist(),
            self._primitives.region[owner].tolist(),
            *table[:, 2:4].T.tolist(),
            strict=True,
        )
        return [
            Ring(_lasting(joined[a:b]) if some else joined[a:b], region, area, length)
            for a, b, some, region, area, length in each
        ]

    def _measure_right(self, joined: Rows, owners: Indices, distance: float, limit: float) -> bool:
        """Return whether all of a level keeps its distance from the whole drawing within a limit, mm."""

        def right(part: slice) -> bool:
            good: bool = offset_clearance_kernels.measures_right(
                joined[part], owners[part], self._rows, self._field.boxes, *self._tree, distance, limit
            )
            return good

        if len(joined) < _WORTH_TWO_CORES:
            return right(slice(None))
        ends = np.linspace(0, len(joined), max(_BANDS, len(joined) // _BAND) + 1).astype(int)
        return all(pool().map(right, (slice(*band) for band in pairwise(ends))))

    def _polylines(self, distance: float) -> list[Ring]:
        """Return the rings as fine polylines that measure right."""
        rings = []
        for points, region in polyline_loops(self._field, self._rows, self._primitives, distance):
            rows = np.hstack([points, np.roll(points, -1, axis=0), np.zeros((len(points), 4))])
            area, length = signed_area(rows), float(lengths(rows).sum())
            rows[:, :4] += self._shift[:4]
            rings.append(Ring(_lasting(rows), region, area, length, polyline=True))
        return rings


def _lasting(rows: Rows) -> Rows:
    """Return a ring's rows without those that rounding leaves no length where the drawing lies: of an arc it would make
    a full turn.
    """
    still = (rows[:, :2] == rows[:, 2:4]).all(axis=1)
    return rows[~still] if 0 < np.count_nonzero(still) < len(rows) else rows


def _by_region(rings: Sequence[Ring]) -> dict[int, list[Ring]]:
    """Return the rings of each region, regions in the order of their first rings."""
    regions: dict[int, list[Ring]] = {}
    for ring in rings:
        regions.setdefault(ring.region, []).append(ring)
    return regions


def _alike(wide: Sequence[Ring], exact: Sequence[Ring], apart: float) -> bool:
    """Tell whether two sets of rings, so far apart, mm, are the same but for that shift: no ring, no width and no way
    into a bay is lost.
    """
    perimeter = sum(ring.length for ring in wide)
    lost = sum(ring.area for ring in wide) - sum(ring.area for ring in exact)
    return len(wide) == len(exact) and lost <= 1.5 * perimeter * apart and not _bay_is_lost(wide, exact, apart)


def _bay_is_lost(wide: Sequence[Ring], exact: Sequence[Ring], apart: float) -> bool:
    """Tell whether one set of rings goes where another of as many rings, so much farther in, mm, does not.

    A ring that moves in by t gets shorter by 2 pi t, a hole's longer; corners take more, but a way into a bay and back
    is gone whole, and only then it is looked for.
    """
    turns = sum(math.copysign(1.0, ring.area) for ring in wide)
    shorter = sum(ring.length for ring in wide) - sum(ring.length for ring in exact) - math.tau * turns * apart
    if shorter < 2 * _BAY * apart:
        return False
    rows = np.concatenate([ring.rows for ring in wide])
    points = np.concatenate([rows[:, :2], points_at(rows, np.full(len(rows), 0.5))])
    away = DistanceField.of(np.concatenate([ring.rows for ring in exact])).nearest(points)[0]
    return bool(away.max() > _BAY * apart)


def _on_a_ridge(ring: Ring) -> bool:
    """Tell whether the field rises above the ring's level by less than the ridge tolerance inside it."""
    return ring.length < 4 * tolerances.RIDGE or 0 <= ring.area < ring.length * tolerances.RIDGE


# The last resort of the exact offset: a ring as a fine polyline that still measures right.


_STEP = 0.05  # mm between points; the chord of a 0.3 mm arc then sags by 1 um

_CHORD = 1e-4
"""mm by which chords may leave arcs in polygons that show where rings are to be looked for."""

_SMALL = 1e-6  # mm; step of the numeric slope


def polyline_loops(
    field: DistanceField, rows: Rows, primitives: Primitives, distance: float
) -> list[tuple[NDArray[np.float64], int]]:
    """Return (points (m, 2), region number) of the rings at a distance, found by buffering polygons with shapely.

    Every point is then moved along the line from its nearest point on the drawing until it measures `distance`; a
    ring of which any point or middle still comes nearer than the tolerance is left out, and so shows as metal left.
    """
    loops = []
    for number in np.unique(primitives.region):
        area = _beyond(rows, primitives, int(number), distance)
        for polygon in getattr(area, "geoms", [area]):
            for hole, line in enumerate((polygon.exterior, *polygon.interiors) if not polygon.is_empty else ()):
                points = _on_level(field, shapely.get_coordinates(shapely.segmentize(line, _STEP))[:-1], distance)
                if len(points) > 2 and _measures_right(field, points, distance):
                    ahead = shapely.LinearRing(points).is_ccw == (hole == 0)
                    loops.append((points if ahead else points[::-1], int(number)))
    return loops


def _beyond(rows: Rows, primitives: Primitives, number: int, distance: float) -> shapely.Geometry:
    """Return what of one region is farther than a distance from its outlines, some of which may go there and back."""
    area: shapely.Geometry = shapely.Polygon()
    ways = []
    starts = np.flatnonzero((primitives.region == number) & (primitives.previous >= np.arange(len(rows))))
    for first in starts:
        last = int(primitives.previous[first])
        points = sample(rows[first : last + 1], _CHORD)
        ways.append(shapely.LineString(np.concatenate([points, points[:1]])))
        if len(points) > 2:  # else a line there and back, which has no area
            area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(points)))
    return shapely.difference(area, shapely.union_all(shapely.buffer(ways, distance, quad_segs=32)))


def _on_level(field: DistanceField, points: NDArray[np.float64], distance: float) -> NDArray[np.float64]:
    """Move points (m, 2) to the given distance from the drawing by Newton steps along the field's slope."""
    for _ in range(3):
        found, _ = field.nearest(points)
        right, up = (field.nearest(points + step)[0] for step in np.eye(2) * _SMALL)
        slope = np.stack([right - found, up - found], 1) / _SMALL
        size = np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 0.5)
        points = points + slope / size[:, None] ** 2 * (distance - found)[:, None]
    return points


def _measures_right(field: DistanceField, points: NDArray[np.float64], distance: float) -> bool:
    both = np.concatenate([points, (points + np.roll(points, -1, axis=0)) / 2])
    return bool(np.all(field.nearest(both)[0] >= distance - tolerances.LEVEL))


# What lies within a distance of drawn lines: the outlines of lines that are grown, as exact lines and arcs.
#
# A line is a wall that one can go round: its rows there and back bound no area, and the level of the distance round
# them is the outline of what lies within. Round ends come out of the half turn at each end. Lines may cross, touch and
# end on one another: the level is that of the distance from all of them.


_ROOM = 2.0
"""Times the distance, between the lines and the frame round them."""

_SAME = 1e-9
"""mm; lines of which all rows are this near to those of another one are drawn twice."""


def grown_lines(lines: Sequence[Contour], distance: float, progress: Progress = NO_PROGRESS) -> tuple[Contour, ...]:
    """Return the outlines of all that lies within a distance of some lines: the area is even-odd.

    Args:
        lines: open and closed ones; they may cross one another and themselves.
        distance: mm, > 0.

    Raises:
        Cancelled: by progress.
    """
    drawn = _once([contour_rows(line) for line in lines])
    if not drawn:
        return ()
    loops = [_frame(np.concatenate(drawn), _ROOM * distance)]
    for rows in drawn:
        back = reversed_rows(rows)
        closed = bool((rows[0, :2] == rows[-1, 2:4]).all())
        loops.extend((rows, back) if closed else (np.concatenate([rows, back]),))
    (level,) = offset_levels(_packed(loops), [distance], progress)
    ids = tuple(dict.fromkeys(number for line in lines for number in line.entity_ids))
    rings = sorted(level.rings, key=lambda ring: -ring.area)[1:]  # the largest one is that along the frame
    return tuple(_contour(ring, lines[0].layer, ids) for ring in rings)


def _once(lines: Sequence[Rows]) -> list[Rows]:
    """Return lines without those that are drawn as another one is, from either end."""
    kept: list[Rows] = []
    for rows in lines:
        ways = rows, reversed_rows(rows)
        if not any(
            each.shape == rows.shape and any(np.abs(each[:, :4] - way[:, :4]).max() < _SAME for way in ways)
            for each in kept
        ):
            kept.append(rows)
    return kept


def _frame(rows: Rows, room: float) -> Rows:
    """Return a box with room round rows, mm, counter-clockwise."""
    wide = rows[:, 6].max() + 2 * room  # of an arc no point is farther from its ends than two radii
    low, high = rows[:, :4].reshape(-1, 2).min(axis=0) - 2 * wide, rows[:, :4].reshape(-1, 2).max(axis=0) + 2 * wide
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    return np.hstack([corners, np.roll(corners, -1, axis=0), np.zeros((4, 4))])


def _packed(loops: Sequence[Rows]) -> Primitives:
    """Return closed runs of rows as one region."""
    previous, first = [], 0
    for rows in loops:
        previous.append(first + (np.arange(len(rows)) - 1) % len(rows))
        first += len(rows)
    return Primitives(np.concatenate(loops), np.concatenate(previous), np.zeros(first, np.int64))


def _contour(ring: Ring, layer: str, ids: tuple[int, ...]) -> Contour:
    rows = within_half_turn(ring.rows)
    return Contour(tuple(row_curve(row) for row in rows), closed=True, layer=layer, entity_ids=ids)
