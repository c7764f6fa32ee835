"""Chains: open runs joined to as few strokes as can be, over ground that is cut or along the rings, so that the tool
seldom lifts.

Always the two ends that are nearest to one another on the net of ways are joined, the end of one run to the beginning
of another where runs have a sense. Ways become longer than else where that leaves more chains than if all runs went
either way. A chain begins on ground that is cut, where there is any within its reach, so that the tool goes straight
down there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.pool import in_bands
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...geometry.primitives import Indices, Rows, sweeps
from ...geometry.triangulation import neighbours
from ...model.moves import Purpose
from ..build import Stroke
from ..rest_material import CutGround
from . import chain_kernels
from .rest_runs import RingChunks, RingRun

_MOST = 6
"""Ends nearest to each that are looked at before ends farther off."""

_FAR = 24
"""Places that a way is tried to be led past in one go."""


def chains(
    chunks: RingChunks, runs: list[RingRun], corridor: Corridor, longest: float, progress: Progress = NO_PROGRESS
) -> tuple[Stroke, ...]:
    """Return strokes that run through all runs.

    Args:
        chunks: the rings that runs are on.
        longest: way from one run to the next, mm; where there is none as short the tool lifts. Metal counts half as
            much again.
    """
    if not runs:
        return ()
    progress.step(0.0, "Ways between runs")
    net = LinkGraph.of(chunks, runs, corridor, longest)
    progress.step(0.5, "Chaining runs")
    tied = _tied(net, np.array([run.sense for run in runs]), longest, progress)
    thread = _Thread(chunks, runs, corridor, net, longest)
    return tuple(proven for chain in tied.chains() for proven in _proven(thread.stroke(*chain), corridor))


def _tied(net: LinkGraph, senses: Indices, longest: float, progress: Progress) -> _Ties:
    """Return runs joined until no two ends are near enough, or as many chains are left as of runs without senses."""
    tied, fewest = _Ties.of(senses), 0
    for limit in (longest, np.inf):
        while tied.count > fewest and tied.add(_candidates(net, tied, limit), fewest):
            progress.step(0.6, "Chaining runs")
        if not senses.any():
            break
        fewest = fewest or _tied(net, np.zeros_like(senses), longest, progress).count
    return tied


def _proven(stroke: Stroke, corridor: Corridor) -> list[Stroke]:
    """Return the parts of a stroke whose rows all keep off the walls: all of it, unless a ring was wrong."""
    good = corridor.clear_rows(stroke.rows)
    if good.all():
        return [stroke]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]))).reshape(-1, 2)
    return [stroke.part(int(a), int(b)) for a, b in edges]


@dataclass(eq=False)
class _Ties:
    """Which ends of runs are joined: end 2 k is the beginning, 2 k + 1 the end of run k.

    Attributes:
        mate: end that each is joined to, -1 = none.
        group: towards the number of the chain that each run is in.
        other: of an end of a chain, the chain's other one.
        role: of an end of a chain: +1 it is cut from here on, -1 up to here, 0 either.
    """

    mate: Indices
    group: Indices
    other: Indices
    role: Indices

    @staticmethod
    def of(senses: Indices) -> _Ties:
        """Return runs with these senses, each a chain by itself."""
        count = len(senses)
        role = np.stack([senses, -senses], 1).reshape(-1)
        return _Ties(np.full(2 * count, -1), np.arange(count), np.arange(2 * count) ^ 1, role)

    @property
    def count(self) -> int:
        """Chains."""
        return int(np.count_nonzero(self.mate < 0)) // 2

    def find(self, run: int) -> int:
        """Return the number of the chain that a run is in."""
        while self.group[run] != run:
            self.group[run] = self.group[self.group[run]]
            run = int(self.group[run])
        return run

    def add(self, pairs: Indices, fewest: int) -> bool:
        """Join pairs (n, 2) of ends, the last of a chain and the first of another one, where both are free; tell
        whether any was.

        Args:
            pairs: the first ones first.
            fewest: chains, when there are so few no more are joined.
        """
        count = self.count
        any_new = False
        for a, b in pairs.tolist():
            one, other = self.find(a // 2), self.find(b // 2)
            if (
                one == other
                or self.mate[a] >= 0
                or self.mate[b] >= 0
                or self.role[a] > 0
                or self.role[b] < 0
                or count == fewest
            ):
                continue
            sense = min(self.role[a], -self.role[b])
            ends = self.other[a], self.other[b]
            self.mate[a], self.mate[b] = b, a
            self.other[ends[0]], self.other[ends[1]] = ends[1], ends[0]
            self.role[ends[0]], self.role[ends[1]] = -sense, sense
            self.group[one] = other
            any_new, count = True, count - 1
        return any_new

    def chains(self) -> list[tuple[list[int], bool]]:
        """Return each chain as the ends at which its runs begin, one after the other, and whether that is its sense."""
        done, chains = np.zeros(len(self.group), np.bool_), []
        ends = np.flatnonzero(self.mate < 0)
        for end in ends[np.argsort(-self.role[ends], kind="stable")].tolist():
            chain: list[int] = []
            sense = bool(self.role[end] > 0)
            while end >= 0 and not done[end // 2]:
                done[end // 2] = True
                chain.append(end)
                end = int(self.mate[end ^ 1])
            if chain:
                chains.append((chain, sense))
        return chains


def _candidates(net: LinkGraph, tied: _Ties, longest: float) -> Indices:
    """Return pairs of free ends, the last of a chain and the first of another, those with the cheapest ways between
    them first.
    """
    free = np.flatnonzero(tied.mate < 0)
    goals, free = free[tied.role[free] >= 0], free[tied.role[free] <= 0]
    chain = np.array([tied.find(end // 2) for end in free.tolist()], np.int64)
    place = net.ends.reshape(-1)
    label = np.full(len(net.places), -1)
    label[place[goals]] = [tied.find(end // 2) for end in goals.tolist()]
    first = np.full(len(net.places), -1)
    first[place[goals]] = goals
    # ends that share a place with another one
    here = np.stack([free, first[place[free]], np.zeros(len(free), np.int64)], 1)
    here = here[(here[:, 1] >= 0) & (here[:, 0] != here[:, 1])]
    sources = np.ascontiguousarray(np.stack([place[free], chain], 1))
    found, costs = net.nearest(label, sources, longest, _MOST)
    pairs = np.concatenate([here[:, :2], np.stack([free[found[:, 0]], first[found[:, 1]]], 1)])
    order = np.argsort(np.concatenate([np.zeros(len(here)), costs]), kind="stable")
    return np.asarray(pairs[order], np.int64)


@dataclass(frozen=True, eq=False)
class _Thread:
    """Makes the path of a chain.

    Attributes:
        chunks, runs, corridor: what is cut, and where the tool may go. net: ways between ends of runs.
        longest: way from one run to the next, mm.
    """

    chunks: RingChunks
    runs: list[RingRun]
    corridor: Corridor
    net: LinkGraph
    longest: float

    def stroke(self, chain: list[int], sense: bool) -> Stroke:
        """Return the stroke through runs, each given by the end at which it begins.

        Args:
            sense: False: it may as well be cut the other way. Otherwise it is only where it begins on cut ground that
                way alone.
        """
        back = [end ^ 1 for end in reversed(chain)]
        (way, cost), other = self._way_down(chain[0]), self._way_down(back[0])
        if other[1] < cost and (not sense or np.isinf(cost)):
            chain, way = back, other[0]
        rows, purpose = [], []

        def take(part: Rows, what: Purpose) -> None:
            rows.append(part)
            purpose.append(np.full(len(part), what, np.uint8))

        take(self._pulled(way), Purpose.LINK)
        for k, end in enumerate(chain):
            if k:
                take(self._pulled(self.net.way(self._place(chain[k - 1] ^ 1), self._place(end), np.inf)), Purpose.LINK)
            run = self.runs[end // 2]
            take(self.chunks.path(run.chunk, run.count, backwards=bool(end & 1)), Purpose.POCKET)
        path = np.concatenate(rows)
        path[1:, :2] = path[:-1, 2:4]
        ring = int(np.searchsorted(self.chunks.first, self.runs[chain[0] // 2].chunk, "right")) - 1
        return Stroke(path, np.concatenate(purpose), int(self.chunks.region[ring]))

    def _place(self, end: int) -> int:
        return int(self.net.ends[end // 2, end % 2])

    def _way_down(self, end: int) -> tuple[Indices, float]:
        """Return the edges from the nearest place on ground that is cut to an end of a run, and what they cost; inf
        where there is none.
        """
        start, none = self._place(end), np.zeros(0, np.int64)
        if self.net.air[start]:
            return none, 0.0
        found, costs = self.net.nearest(self.net.air_labels, np.array([[start, -1]]), self.longest, 1)
        return (self.net.way(int(found[0, 1]), start, np.inf), float(costs[0])) if len(found) else (none, np.inf)

    def _pulled(self, edges: Indices) -> Rows:
        """Return the rows of a way, with straight ways past places where these are as clear."""
        net, rows, k = self.net, [np.zeros((0, 8))], 0
        stops = np.append(net.come_from[edges], net.to[edges[-1:]])
        while k < len(edges):
            ahead = np.arange(min(len(edges), k + _FAR), k + 1, -1)
            ways = np.hstack([np.broadcast_to(net.places[stops[k]], (len(ahead), 2)), net.places[stops[ahead]]])
            good = self.corridor.clear(ways)
            air = np.logical_and.accumulate(net.air[stops[k:]])[ahead - k]
            good &= ~air | self.corridor.in_air(ways)
            if good.any():
                k = int(ahead[np.argmax(good)])
                rows.append(np.array([[*ways[np.argmax(good)], 0.0, 0.0, 0.0, 0.0]]))
                continue
            rows.append(net.rows(self.chunks, int(edges[k])))
            k += 1
        return np.concatenate(rows)


# A net of ways for a cutter's centre: along rings, and straight between places of rings where no wall is near.


STRAIGHT, ALONG, BACK = 0, 1, 2
"""How an edge of the net goes: straight, along a ring, back along a ring."""

SLACK = tolerances.LEVEL / 2
"""mm; by so much a way may come nearer to a wall than asked, as rings may."""

_STEPS = 20_000
"""Places at most that one way is looked at in; a way that needs more is none."""

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
class _SearchRoom:
    """Room that all searches of a net share, so that each costs what it sees and not the whole net.

    Attributes:
        way: to each place, mm; inf between searches.
        came: the edge by which each place was come to. seen: places that a search has seen, then the edges of its way.
    """

    way: Floats
    came: Indices
    seen: Indices

    @staticmethod
    def of(places: int) -> _SearchRoom:
        """Return room for a net of so many places."""
        return _SearchRoom(np.full(places, np.inf), np.empty(places, np.int64), np.empty(places + 1, np.int64))


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
        round_rings = _along(chunks, spots)
        c, d = _across(places, ring, chunks.region[ring], corridor, longest)
        far = np.hypot(*(places[c] - places[d]).T)
        zero = np.zeros(len(c), np.int64)
        start, end = np.concatenate([round_rings.start, c, d]), np.concatenate([round_rings.end, d, c])
        size = np.concatenate([round_rings.length, far, far])
        cost = size * np.where(air[start] & air[end], 1.0, _IN_METAL)
        order = np.argsort(start, kind="stable")
        first = np.concatenate([[0], np.cumsum(np.bincount(start, minlength=len(spots)))]).astype(np.int64)
        kinds = np.concatenate([round_rings.kind, np.full(2 * len(c), STRAIGHT)])
        counts = np.concatenate([round_rings.rows, zero, zero])
        return LinkGraph(
            places=places,
            chunk=spots,
            first=first,
            to=end[order],
            cost=cost[order],
            kind=kinds[order],
            come_from=start[order],
            count=counts[order],
            air=air,
            ends=ends,
        )

    @cached_property
    def air_labels(self) -> Indices:
        """0 where the ground under the cutter is cut, -1 elsewhere."""
        return np.where(self.air, 0, -1)

    @cached_property
    def _room(self) -> _SearchRoom:
        return _SearchRoom.of(len(self.places))

    def nearest(self, label: Indices, sources: Indices, longest: float, most: int) -> tuple[Indices, Floats]:
        """Return (source, place) (m, 2) and the costs of the ways to the places nearest to each source.

        Args:
            label, sources: as `chain_kernels.nearest_goals` wants them. longest: way, mm. most: places a source.
        """
        found, costs = np.empty((most * len(sources), 2), np.int64), np.empty(most * len(sources))
        room = self._room
        count = chain_kernels.nearest_goals(
            self.first, self.to, self.cost, label, sources, longest, most, room.way, room.seen, found, costs
        )
        return found[:count], costs[:count]

    def way(self, start: int, goal: int, limit: float) -> Indices:
        """Return the edges of the cheapest way between two places."""
        room = self._room
        count = chain_kernels.cheapest_way(
            self.first, self.to, self.cost, self.come_from, start, goal, limit, room.way, room.came, room.seen
        )
        return room.seen[:count][::-1].copy()

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


class _RingWays(NamedTuple):
    """Ways (n,) round rings between places: from and to which, ALONG or BACK, how many rows they have, and mm."""

    start: Indices
    end: Indices
    kind: Indices
    rows: Indices
    length: Floats


def _along(chunks: RingChunks, spots: Indices) -> _RingWays:
    """Return the ways from each place to the next round its ring, there and back."""
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
    return _RingWays(
        start=np.concatenate([a, b]),
        end=np.concatenate([b, a]),
        kind=np.concatenate([kind, np.full(len(a), BACK)]),
        rows=np.concatenate([count, count]),
        length=np.concatenate([size, size]),
    )


def _across(
    places: Floats, ring: Indices, region: Indices, corridor: Corridor, longest: float
) -> tuple[Indices, Indices]:
    """Return (from, to) of straight ways between places near one another that are clear: edges of a Delaunay
    triangulation.

    Args:
        places: (n, 2). ring: of each; those that follow one another round a ring have their way along it.
        region: of each; walls lie between those of two.
    """
    edges = neighbours(places)
    edges = edges[region[edges[:, 0]] == region[edges[:, 1]]]
    edges = edges[(ring[edges[:, 0]] != ring[edges[:, 1]]) | (edges[:, 1] - edges[:, 0] > 1)]
    ways = np.hstack([places[edges[:, 0]], places[edges[:, 1]]])
    edges, ways = (each[np.hypot(*(ways[:, :2] - ways[:, 2:]).T) <= longest] for each in (edges, ways))
    edges = edges[corridor.clear(ways)]
    return edges[:, 0], edges[:, 1]
