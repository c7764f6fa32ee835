"""A net of ways for a cutter's centre: along rings, and straight between places of rings where no wall is near."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.pool import in_bands
from ...geometry.distance import DistanceField
from ...geometry.primitives import Indices, Rows, sweeps
from ...geometry.triangulation import neighbours
from ..rest_material import CutGround
from . import chain_kernels
from .rest_runs import RingChunks, RingRun

STRAIGHT, ALONG, BACK = 0, 1, 2
"""How an edge of the net goes: straight, along a ring, back along a ring."""

SLACK = tolerances.LEVEL / 2
"""mm; by so much a way may come nearer to a wall than asked, as rings may."""

_STEPS = 20_000

_IN_METAL = 1.5
"""A mm of way through metal counts as so many over ground that is cut."""

_UNDER = 2e-3
"""mm by which the cutter must lie within what is cut for its ground to count as cut."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Corridor:
    """Where chains may go.

    Attributes:
        walls: distances from all walls.
        closest: the cutter's centre keeps so far off them, mm.
        ground: what is cut when the chains are run.
        radius: of the cutter, mm.
    """

    walls: DistanceField
    closest: float
    ground: CutGround
    radius: float

    def clear(self, ways: Floats) -> NDArray[np.bool_]:
        """Return whether straight ways (n, 4) keep off the walls."""
        walls, ways, out = self.walls, np.ascontiguousarray(ways), np.empty(len(ways), np.bool_)

        def look(band: slice) -> None:
            chain_kernels.clear_ways(
                walls.rows, walls.order, walls.nodes, ways[band], self.closest, SLACK, _STEPS, out[band]
            )

        in_bands(look, len(ways))
        return out

    def clear_rows(self, path: Rows) -> NDArray[np.bool_]:
        """Return for each row (n, 8) of a path whether it keeps off the walls, within the tolerance of rings."""
        out = np.empty(len(path), np.bool_)
        chain_kernels.clear_rows(
            self.walls.rows,
            self.walls.order,
            self.walls.nodes,
            np.ascontiguousarray(path),
            sweeps(path),
            self.closest,
            tolerances.LEVEL,
            out,
        )
        return out

    def in_air(self, ways: Floats) -> NDArray[np.bool_]:
        """Return whether straight ways (n, 4) surely lie on ground that is cut, with a little to spare."""
        return self.ground.in_air(np.hstack([ways, np.zeros((len(ways), 4))]), self.radius, -_UNDER)


@dataclass(frozen=True, eq=False)
class LinkGraph:
    """Places on rings, and the ways between them.

    Attributes:
        places: (n, 2) mm. chunk: (n,) the row of the rings that begins at each.
        first, to, cost: ways from each place as `chain_kernels` wants them; kind: of each; come_from: where it begins.
        count: (e,) rows of the ring that an edge along it has.
        air: (n,) True where the ground under the cutter is cut.
        ends: (m, 2) places of the beginning and the end of each run.
    """

    places: Floats
    chunk: Indices
    first: Indices
    to: Indices
    cost: Floats
    kind: Indices
    come_from: Indices
    count: Indices
    air: NDArray[np.bool_]
    ends: Indices

    @staticmethod
    def of(chunks: RingChunks, runs: list[RingRun], corridor: Corridor, longest: float) -> LinkGraph:
        """Return the net over all rings that runs are on, and over every ring a cutter's radius farther from the walls.

        Args:
            longest: straight way, mm.
        """
        spots, ends = _spots(chunks, runs, corridor.radius)
        ring = chunks.ring[spots]
        places = chunks.rows[spots, :2]
        air = corridor.in_air(np.hstack([places, places]))
        a, b, kind, count, size = _along(chunks, spots)
        c, d = _across((places, ring), corridor, longest)
        far = np.hypot(*(places[c] - places[d]).T)
        zero = np.zeros(len(c), np.int64)
        start, end = np.concatenate([a, c, d]), np.concatenate([b, d, c])
        size = np.concatenate([size, far, far])
        cost = size * np.where(air[start] & air[end], 1.0, _IN_METAL)
        order = np.argsort(start, kind="stable")
        first = np.concatenate([[0], np.cumsum(np.bincount(start, minlength=len(spots)))]).astype(np.int64)
        kinds, counts = np.concatenate([kind, np.full(2 * len(c), STRAIGHT)]), np.concatenate([count, zero, zero])
        return LinkGraph(
            places, spots, first, end[order], cost[order], kinds[order], start[order], counts[order], air, ends
        )

    def way(self, start: int, goal: int, limit: float) -> Indices:
        """Return the edges of the cheapest way between two places."""
        out = np.empty(len(self.places) + 1, np.int64)
        count = chain_kernels.cheapest_way(self.first, self.to, self.cost, start, goal, limit, out)
        return out[:count][::-1]

    def rows(self, chunks: RingChunks, edge: int) -> Rows:
        """Return the rows of an edge."""
        a, b = int(self.come_from[edge]), int(self.to[edge])
        if self.kind[edge] == ALONG:
            return chunks.path(int(self.chunk[a]), int(self.count[edge]))
        if self.kind[edge] == BACK:
            return chunks.path(int(self.chunk[b]), int(self.count[edge]), backwards=True)
        return np.array([[*self.places[a], *self.places[b], 0.0, 0.0, 0.0, 0.0]])


def _spots(chunks: RingChunks, runs: list[RingRun], radius: float) -> tuple[Indices, Indices]:
    """Return (rows of the rings at which a place of the net is, places of the ends of each run)."""
    begins = np.array([run.chunk for run in runs])
    stops = np.array([chunks.after(run.chunk, run.count) for run in runs])
    gone = np.cumsum(chunks.size) - chunks.size
    ring = chunks.ring
    step = np.floor((gone - gone[chunks.first[:-1]][ring]) / radius)
    every = np.concatenate([[True], np.diff(step) != 0]) | np.concatenate([[True], np.diff(ring) != 0])
    used = np.zeros(len(chunks.level), np.bool_)
    used[ring[begins]] = True
    used |= np.isin(chunks.level, _road_levels(chunks))
    every &= used[ring]
    every[begins] = every[stops] = True
    spots = np.flatnonzero(every)
    return spots, np.stack([np.searchsorted(spots, begins), np.searchsorted(spots, stops)], 1)


def _road_levels(chunks: RingChunks) -> Indices:
    """Return the levels all rings of which belong to the net: every fourth."""
    return np.unique(chunks.level)[::4]


def _along(chunks: RingChunks, spots: Indices) -> tuple[Indices, Indices, Indices, Indices, Floats]:
    """Return (from, to, kind, rows, length) of the ways from each place to the next round its ring, there and back."""
    ring = chunks.ring[spots]
    last = np.concatenate([np.diff(ring) != 0, [True]])
    starts = np.flatnonzero(np.concatenate([[True], np.diff(ring) != 0]))
    number = np.arange(len(spots))
    after = np.where(last, np.repeat(starts, np.diff(np.append(starts, len(spots)))), number + 1)
    around = np.diff(chunks.first)[ring]
    count = (spots[after] - spots - 1) % around + 1
    total = np.concatenate([[0.0], np.cumsum(chunks.size)])
    whole = (total[chunks.first[1:]] - total[chunks.first[:-1]])[ring]
    size = total[spots[after]] - total[spots]
    size = np.where(size <= 0, size + whole, size)
    real = after != number
    a, b, count, size = number[real], after[real], count[real], size[real]
    kind = np.full(len(a), ALONG)
    return (
        np.concatenate([a, b]),
        np.concatenate([b, a]),
        np.concatenate([kind, np.full(len(a), BACK)]),
        np.concatenate([count, count]),
        np.concatenate([size, size]),
    )


def _across(spots: tuple[Floats, Indices], corridor: Corridor, longest: float) -> tuple[Indices, Indices]:
    """Return (from, to) of straight ways between places near one another that are clear: edges of a Delaunay
    triangulation.

    Args:
        spots: places (n, 2) and the ring of each; those that follow one another round a ring have their way along it.
    """
    places, ring = spots
    edges = neighbours(places)
    edges = edges[(ring[edges[:, 0]] != ring[edges[:, 1]]) | (edges[:, 1] - edges[:, 0] > 1)]
    ways = np.hstack([places[edges[:, 0]], places[edges[:, 1]]])
    edges, ways = (each[np.hypot(*(ways[:, :2] - ways[:, 2:]).T) <= longest] for each in (edges, ways))
    edges = edges[corridor.clear(ways)]
    return edges[:, 0], edges[:, 1]
