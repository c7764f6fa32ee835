"""Exact offset of whole regions: lines and arcs in, lines and arcs out, one ring set a level.

A level is the set of points at a given distance from the drawing, on the side of the area to machine (step 120 and
the frames of steps 142-148). Every ring comes from the drawing itself, never from another ring, so nothing drifts.

Method: each line and arc is moved to its left by the level, each vertex at which the boundary turns right becomes an
arc; the parts of these to which any primitive comes nearer than the level are cut away in closed form; what remains is
stitched into rings. Then every joint and the middle of every piece is measured against the whole drawing. A level that
does not close or measures wrong is tried again a fraction of a micrometre further in, and falls back to a fine polyline
at last.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from app import tolerances
from app.geometry import kernels, offset_kernels, ring_kernels
from app.geometry.distance import DistanceField
from app.geometry.offset_polyline import polyline_loops
from app.geometry.primitives import CX, TURN, Indices, Primitives, Rows, boxes, lengths, signed_area
from app.pool import pool
from app.progress import NO_PROGRESS, Progress

_WORTH_TWO_CORES = 2000
"""Pieces from which a second core is worth its start."""

_BANDS = 4
_NUDGES = (0.0, 1e-7, 3.3e-7, 7.1e-7, -1.3e-7)


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
class Level:
    """All rings at one distance, mm, from the drawing."""

    distance: float
    rings: tuple[Ring, ...]


def offset_levels(primitives: Primitives, levels: Sequence[float], progress: Progress = NO_PROGRESS, *,
                  frame: bool = False) -> tuple[Level, ...]:
    """Return the rings at each of some distances from a drawing.

    Args:
        primitives: closed contours, the area to the left.
        levels: distances, mm, > 0, rising.
        progress: looked at between levels.
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
        return tuple(Level(d, ()) for d in levels)
    engine = _Engine(primitives)
    result = []
    for k, distance in enumerate(levels):
        progress.step(k / len(levels), f"Offset {distance:.3f} mm")
        result.append(Level(distance, engine.frame(distance) if frame and k == 0 else engine.rings(distance)))
    return tuple(result)


class _Engine:
    """Keeps what is still free of each element from one level to the next."""

    def __init__(self, primitives: Primitives) -> None:
        origin = (primitives.rows[:, :2].min(axis=0) + primitives.rows[:, :2].max(axis=0)) / 2
        self._shift = np.concatenate([origin, origin, origin, [0, 0]])
        rows = primitives.rows - self._shift * np.where(primitives.rows[:, 7:8] != 0, 1, [1, 1, 1, 1, 0, 0, 0, 0])
        self._primitives = primitives
        self._rows = np.ascontiguousarray(rows)
        self._field = DistanceField.of(self._rows)
        self._boxes = np.ascontiguousarray(boxes(self._rows))
        self._slack = 2e-13 * max(float(np.abs(self._rows[:, :4]).max()), 100.0)
        self._vertices = np.zeros((len(rows), 2))
        offset_kernels.vertex_arcs(self._rows, primitives.previous, self._vertices)
        elements = np.concatenate([np.arange(len(rows)), len(rows) + np.flatnonzero(self._vertices[:, 1] < 0)])
        self._active = np.stack([elements, np.zeros(len(elements)), np.ones(len(elements))], 1)
        self._history: list[tuple[float, Rows]] = [(0.0, self._active)]

    def frame(self, distance: float) -> tuple[Ring, ...]:
        """Return the rings at the first distance; for regions that the tool passes only just, those at FIT less."""
        loose, tight = self.rings(distance - tolerances.FIT, keep_ridges=True), self.rings(distance)
        chosen: list[Ring] = []
        for region in dict.fromkeys(ring.region for ring in loose):
            wide, exact = ([ring for ring in rings if ring.region == region] for rings in (loose, tight))
            chosen += exact if _alike(wide, exact) else wide
        return tuple(chosen)

    def rings(self, distance: float, keep_ridges: bool = False) -> tuple[Ring, ...]:
        """Return the rings at the next distance, which is greater than the last one."""
        if len(self._active) == 0:
            return ()
        for nudge in _NUDGES:
            pieces = self._trim(distance + nudge)
            rings = self._stitch(pieces, distance + nudge)
            if rings is not None:
                break
        else:
            pieces, rings = self._trim(distance), self._polylines(distance)
        self._active = pieces
        self._history.append((distance, pieces))
        return tuple(self._back(ring) for ring in rings if keep_ridges or not _on_a_ridge(ring))

    def _trim(self, distance: float) -> Rows:
        """Return the pieces (m, 3) of elements to which nothing is nearer than the distance; many are cut on two cores."""
        order, nodes = self._blockers(distance)
        level_slack = np.array([distance, self._slack])

        def trimmed(active: Rows) -> Rows:
            room = 4 * len(active) + 64
            while True:
                pieces = np.empty((room, 3))
                count = offset_kernels.trim(self._rows, self._vertices, order, nodes, self._boxes, active, level_slack, pieces)
                if count < room:
                    return pieces[:count]
                room *= 4

        if len(self._active) < _WORTH_TWO_CORES:
            return np.ascontiguousarray(trimmed(self._active))
        return np.concatenate(list(pool().map(trimmed, np.array_split(self._active, _BANDS))))

    def _blockers(self, distance: float) -> tuple[Indices, Rows]:
        """Return a tree of the rows that can be nearest to any point of this level.

        A point left of a level `last` by distance - last at most is nearer to no row than 2 last - distance, and the
        row that is nearest was then still free at every level up to that.
        """
        safe = 2 * self._history[-1][0] - distance - 1e-6
        pieces = next(active for level, active in reversed(self._history) if level <= max(safe, 0.0))
        elements = pieces[:, 0].astype(np.int64)
        used = np.unique(np.where(elements >= len(self._rows), elements - len(self._rows), elements))
        order, nodes = kernels.build_tree(np.ascontiguousarray(self._boxes[used]))
        return used[order], nodes

    def _piece_rows(self, pieces: Rows, distance: float) -> Rows:
        out = np.empty((len(pieces), 8))
        offset_kernels.piece_rows(self._rows, self._vertices, pieces, distance, out)
        return out

    def _stitch(self, pieces: Rows, distance: float) -> list[Ring] | None:
        """Return closed rings made of all pieces, or None when one has no continuation, measures wrong or lies outside."""
        rows = self._piece_rows(pieces, distance)
        count = len(rows)
        following = np.empty(count, np.int64)
        ring_kernels.follow(rows, np.argsort(rows[:, 0]), max(2e-5, 8 * math.sqrt(self._slack * distance)), following)
        if count and following.min() < 0:
            return None
        joined, order, starts = np.empty((count, 8)), np.empty(count, np.int64), np.empty(count + 1, np.int64)
        rings = ring_kernels.assemble(rows, following, joined, order, starts)
        limit = tolerances.LEVEL / 2
        if ring_kernels.worst_error(joined, self._rows, self._field.order, self._field.nodes, distance, limit) > limit:
            return None
        sums = np.empty((rings, 2))
        ring_kernels.sums(joined, starts, rings, sums)
        regions = self._primitives.region[pieces[order[starts[:rings]], 0].astype(np.int64) % len(self._rows)]
        found = [Ring(joined[starts[k]:starts[k + 1]], int(regions[k]), float(sums[k, 0]), float(sums[k, 1])) for k in range(rings)]
        inside = self._field.inside(joined[starts[:rings], :2])
        if not all(good or _on_a_ridge(ring) for good, ring in zip(inside, found, strict=True)):
            return None
        return [ring for good, ring in zip(inside, found, strict=True) if good]

    def _polylines(self, distance: float) -> list[Ring]:
        """Return the rings as fine polylines that measure right."""
        rings = []
        for points, region in polyline_loops(self._field, self._rows, self._primitives, distance):
            rows = np.hstack([points, np.roll(points, -1, axis=0), np.zeros((len(points), 4))])
            rings.append(Ring(rows, region, signed_area(rows), float(lengths(rows).sum()), polyline=True))
        return rings

    def _back(self, ring: Ring) -> Ring:
        """Return the ring in the drawing's coordinates."""
        rows = ring.rows + self._shift
        rows[rows[:, TURN] == 0, CX:] = 0.0
        return replace(ring, rows=rows)


def _alike(wide: Sequence[Ring], exact: Sequence[Ring]) -> bool:
    """Tell whether two sets of rings, FIT apart, are the same but for that shift."""
    perimeter = sum(ring.length for ring in wide)
    lost = sum(ring.area for ring in wide) - sum(ring.area for ring in exact)
    return len(wide) == len(exact) and lost <= 1.5 * perimeter * tolerances.FIT


def _on_a_ridge(ring: Ring) -> bool:
    """Tell whether the field rises above the ring's level by less than the ridge tolerance inside it."""
    return ring.length < 4 * tolerances.RIDGE or 0 <= ring.area < ring.length * tolerances.RIDGE
