# mypy: allow-untyped-defs
"""Compiled inner loops of chains: which straight ways are clear, and the nearest goals in a net of ways."""

from __future__ import annotations

import heapq
import math

from ...core.jit import kernel
from ...geometry.kernels import nearest_from
from ..cleared_kernels import keeps_off


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64, float64, int64, boolean[::1])")
def clear_ways(rows, order, nodes, ways, distance, slack, budget, out):
    """Write for each straight way (n, 4) whether it keeps `distance` - `slack` from all rows of a tree."""
    for k in range(len(ways)):
        out[k] = keeps_off(rows, order, nodes, ways[k], distance, slack, budget)


@kernel(
    "void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[::1], float64, float64, boolean[::1])"
)
def clear_rows(rows, order, nodes, path, turn, distance, slack, out):
    """Write for each row of a path (n, 8) whether it keeps `distance` - `slack` from all rows of a tree.

    Distance changes by no more than the way gone, so a step as long as there is to spare passes nothing unseen.

    Args:
        turn: (n,) signed sweep of each row, radians.
    """
    near = -1
    for k in range(len(path)):
        ax, ay, cx, cy, r = path[k, 0], path[k, 1], path[k, 4], path[k, 5], path[k, 6]
        dx, dy = path[k, 2] - ax, path[k, 3] - ay
        arc = path[k, 7] != 0.0
        length = abs(turn[k]) * r if arc else math.hypot(dx, dy)
        start = math.atan2(ay - cy, ax - cx)
        at, out[k] = 0.0, True
        while True:
            part = at / length if length > 0.0 else 0.0
            x, y = ax + dx * part, ay + dy * part
            if arc:
                x, y = cx + r * math.cos(start + turn[k] * part), cy + r * math.sin(start + turn[k] * part)
            away, near = nearest_from(rows, order, nodes, x, y, -1.0, math.inf, near)
            spare = away - (distance - slack)
            # a shorter step than this could go on for ever; what is that near is taken not to be clear
            if spare < slack / 4.0:
                out[k] = False
                break
            if at >= length:
                break
            at = min(at + spare, length)


@kernel(
    "int64(int64[::1], int64[::1], float64[::1], int64[::1], int64[:, ::1], float64, int64, float64[::1], int64[::1], "
    "int64[:, ::1], float64[::1])"
)
def nearest_goals(first, to, cost, label, sources, limit, most, way, touched, found, costs):
    """Write (source, goal) and the cost of the way for the goals nearest to each source; return how many.

    Args:
        first, to, cost: ways from each node k: to[first[k]:first[k + 1]], mm.
        label: of each node; those of 0 or more are goals.
        sources: (n, 2) node, and a label that is no goal for it.
        limit: longest way, mm. most: goals a source.
        way: (n,) of each node, infinite, as it is again afterwards: only what a search has seen is put back, so that a
            search costs what it has seen and not the whole net. touched: room for the nodes.
        found, costs: room for `most` a source.
    """
    count = 0
    for s in range(len(sources)):
        start, own, got, touches = sources[s, 0], sources[s, 1], 0, 1
        way[start], touched[0] = 0.0, start
        heap = [(0.0, start)]
        while len(heap) > 0 and got < most:
            gone, node = heapq.heappop(heap)
            # an older entry of the heap: a shorter way there has been found since
            if gone > way[node]:
                continue
            if label[node] >= 0 and label[node] != own and node != start:
                found[count, 0], found[count, 1], costs[count] = s, node, gone
                count += 1
                got += 1
            for e in range(first[node], first[node + 1]):
                other, total = to[e], gone + cost[e]
                if total < way[other] and total <= limit:
                    if way[other] == math.inf:
                        touched[touches] = other
                        touches += 1
                    way[other] = total
                    heapq.heappush(heap, (total, other))
        for k in range(touches):
            way[touched[k]] = math.inf
    return count


@kernel(
    "int64(int64[::1], int64[::1], float64[::1], int64[::1], int64, int64, float64, float64[::1], int64[::1], "
    "int64[::1])"
)
def cheapest_way(first, to, cost, come_from, start, goal, limit, way, came, out):
    """Write the edges of the cheapest way from a node to another, last first; return how many (0 where there is
    none).

    Args:
        first, to, cost, limit, way: as of `nearest_goals`. come_from: of each edge.
        came: room for the edge by which each node was come to. out: room for the nodes, and for the edges.
    """
    way[start], out[0], touches = 0.0, start, 1
    heap = [(0.0, start)]
    while len(heap) > 0:
        gone, node = heapq.heappop(heap)
        if gone > way[node]:
            continue
        if node == goal:
            break
        for e in range(first[node], first[node + 1]):
            other, total = to[e], gone + cost[e]
            if total < way[other] and total <= limit:
                if way[other] == math.inf:
                    out[touches] = other
                    touches += 1
                way[other], came[other] = total, e
                heapq.heappush(heap, (total, other))
    # `out` has told which nodes were seen up to here; from here on it takes the edges
    reached = way[goal] < math.inf
    for k in range(touches):
        way[out[k]] = math.inf
    count, node = 0, goal
    while reached and node != start:
        out[count] = came[node]
        count += 1
        node = come_from[came[node]]
    return count
