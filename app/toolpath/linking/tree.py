"""Which rings are joined by which bridges: a forest, grown by bridges that join what was apart (Kruskal)."""

from __future__ import annotations

from collections.abc import Sequence

from .bridge import RingBridge
from .rows import RingPlace

Edge = tuple[RingPlace, RingPlace, float]
"""A bridge as seen from one of its rings: place on this ring, place on the other one, length, mm."""


class BridgeForest:
    """A forest over rings numbered from 0."""

    def __init__(self, count: int) -> None:
        self._parent = list(range(count))
        self.neighbours: list[list[Edge]] = [[] for _ in range(count)]

    def group(self, ring: int) -> int:
        """Return the number of the group that a ring is in."""
        while self._parent[ring] != ring:
            self._parent[ring] = self._parent[self._parent[ring]]
            ring = self._parent[ring]
        return ring

    def joined(self, bridge: RingBridge) -> bool:
        """Tell whether both ends are in one group already."""
        return self.group(bridge.a.ring) == self.group(bridge.b.ring)

    def add(self, bridge: RingBridge) -> None:
        """Take a bridge unless it would close a loop."""
        if self.joined(bridge):
            return
        self._parent[self.group(bridge.a.ring)] = self.group(bridge.b.ring)
        self.neighbours[bridge.a.ring].append((bridge.a, bridge.b, bridge.length))
        self.neighbours[bridge.b.ring].append((bridge.b, bridge.a, bridge.length))

    def roots(self, depth: Sequence[float]) -> list[int]:
        """Return the innermost ring of each group.

        Args:
            depth: how far inside each ring is.
        """
        best: dict[int, int] = {}
        for ring in range(len(depth)):
            group = self.group(ring)
            if group not in best or depth[ring] > depth[best[group]]:
                best[group] = ring
        return list(best.values())

    def longest_way(self, root: int) -> list[tuple[int, Edge | None]]:
        """Return the rings from a root to the one farthest from it over bridges, each with the bridge to the next; the
        last with none.
        """
        before: dict[int, tuple[int, Edge] | None] = {root: None}
        far = {root: 0.0}
        waiting = [root]
        while waiting:
            ring = waiting.pop()
            for edge in self.neighbours[ring]:
                if edge[1].ring not in before:
                    before[edge[1].ring] = ring, edge
                    far[edge[1].ring] = far[ring] + edge[2]
                    waiting.append(edge[1].ring)
        way: list[tuple[int, Edge | None]] = []
        at, step = max(far, key=lambda ring: far[ring]), None
        while True:
            way.append((at, step))
            previous = before[at]
            if previous is None:
                return way[::-1]
            at, step = previous
