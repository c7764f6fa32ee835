"""Chains: open runs joined to as few strokes as can be, over ground that is cut or along the rings, so that the tool seldom lifts.

Always the two ends that are nearest to one another on the net of ways are joined. A run may be cut either way. A chain begins on
ground that is cut, where there is any within its reach, so that the tool goes straight down there.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.geometry.primitives import Indices, Rows
from app.model.moves import Purpose
from app.progress import NO_PROGRESS, Progress
from app.toolpath import chain_kernels
from app.toolpath.build import Stroke
from app.toolpath.chain_net import Corridor, Net
from app.toolpath.rest_runs import Chunks, Run

_MOST = 6
"""Ends nearest to each that are looked at before ends farther off."""

_FAR = 24
"""Places that a way is tried to be led past in one go."""

Floats = NDArray[np.float64]


def chains(chunks: Chunks, runs: list[Run], corridor: Corridor, longest: float, progress: Progress = NO_PROGRESS) -> tuple[Stroke, ...]:
    """Return strokes that run through all runs.

    Args:
        chunks: the rings that runs are on.
        longest: way from one run to the next, mm; where there is none as short the tool lifts. Metal counts half as much again.
    """
    if not runs:
        return ()
    progress.step(0.0, "Ways between runs")
    net = Net.of(chunks, runs, corridor, longest)
    progress.step(0.5, "Chaining runs")
    tied = _Ties(len(runs))
    while tied.add(_candidates(net, tied, longest)):
        progress.step(0.6, "Chaining runs")
    thread = _Thread(chunks, runs, corridor, net, longest)
    return tuple(proven for chain in tied.chains() for proven in _proven(thread.stroke(chain), corridor))


def _proven(stroke: Stroke, corridor: Corridor) -> list[Stroke]:
    """Return the parts of a stroke whose rows all keep off the walls: all of it, unless a ring was wrong."""
    good = corridor.clear_rows(stroke.rows)
    if good.all():
        return [stroke]
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]))).reshape(-1, 2)
    return [stroke.part(int(a), int(b)) for a, b in edges]


@dataclass
class _Ties:
    """Which ends of runs are joined: end 2 k is the beginning, 2 k + 1 the end of run k."""

    count: int
    mate: Indices = field(init=False)
    group: Indices = field(init=False)

    def __post_init__(self) -> None:
        self.mate = np.full(2 * self.count, -1)
        self.group = np.arange(self.count)

    def find(self, run: int) -> int:
        """Return the number of the chain that a run is in."""
        while self.group[run] != run:
            self.group[run] = self.group[self.group[run]]
            run = int(self.group[run])
        return run

    def add(self, pairs: Indices) -> bool:
        """Join pairs (n, 2) of ends, the first ones first, where both are free and in different chains; tell whether any was."""
        any_new = False
        for a, b in pairs.tolist():
            one, other = self.find(a // 2), self.find(b // 2)
            if one != other and self.mate[a] < 0 and self.mate[b] < 0:
                self.mate[a], self.mate[b] = b, a
                self.group[one] = other
                any_new = True
        return any_new

    def chains(self) -> list[list[int]]:
        """Return each chain as the ends at which its runs begin, one after the other."""
        done, chains = np.zeros(self.count, np.bool_), []
        for end in np.flatnonzero(self.mate < 0).tolist():
            chain: list[int] = []
            while end >= 0 and not done[end // 2]:
                done[end // 2] = True
                chain.append(end)
                end = int(self.mate[end ^ 1])
            if chain:
                chains.append(chain)
        return chains


def _candidates(net: Net, tied: _Ties, longest: float) -> Indices:
    """Return pairs of free ends, those with the cheapest ways between them first."""
    free = np.flatnonzero(tied.mate < 0)
    chain = np.array([tied.find(end // 2) for end in free.tolist()])
    place = net.ends.reshape(-1)[free]
    label = np.full(len(net.places), -1)
    label[place] = chain
    first = np.full(len(net.places), -1)
    first[place] = free
    here = np.stack([free, first[place], np.zeros(len(free), np.int64)], 1)  # ends that share a place with another one
    here = here[here[:, 0] != here[:, 1]]
    sources = np.ascontiguousarray(np.stack([place, chain], 1))
    found, costs = np.empty((_MOST * len(free), 2), np.int64), np.empty(_MOST * len(free))
    count = chain_kernels.nearest_goals(net.first, net.to, net.cost, label, sources, longest, _MOST, found, costs)
    pairs = np.concatenate([here[:, :2], np.stack([free[found[:count, 0]], first[found[:count, 1]]], 1)])
    order = np.argsort(np.concatenate([np.zeros(len(here)), costs[:count]]), kind="stable")
    return np.asarray(pairs[order], np.int64)


@dataclass(frozen=True, eq=False)
class _Thread:
    """Makes the path of a chain."""

    chunks: Chunks
    runs: list[Run]
    corridor: Corridor
    net: Net
    longest: float

    def stroke(self, chain: list[int]) -> Stroke:
        """Return the stroke through runs, each given by the end at which it begins."""
        back = [end ^ 1 for end in reversed(chain)]
        ways = [self._way_down(each[0]) for each in (chain, back)]
        if len(ways[1]) and (not len(ways[0]) or self._cost(ways[1]) < self._cost(ways[0])):
            chain, ways = back, ways[::-1]
        rows, purpose = [], []

        def take(part: Rows, what: Purpose) -> None:
            rows.append(part)
            purpose.append(np.full(len(part), what, np.uint8))

        take(self._pulled(ways[0]), Purpose.LINK)
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

    def _cost(self, edges: Indices) -> float:
        return float(self.net.cost[edges].sum())

    def _way_down(self, end: int) -> Indices:
        """Return the edges from the nearest place on ground that is cut to an end of a run; none where there is none, or it is there."""
        start, none = self._place(end), np.zeros(0, np.int64)
        found, costs = np.empty((1, 2), np.int64), np.empty(1)
        if self.net.air[start]:
            return none
        label = np.where(self.net.air, 0, -1)
        count = chain_kernels.nearest_goals(self.net.first, self.net.to, self.net.cost, label, np.array([[start, -1]]), self.longest, 1,
                                            found, costs)
        return self.net.way(int(found[0, 1]), start, np.inf) if count else none

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
