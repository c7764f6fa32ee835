# mypy: allow-untyped-defs
"""Compiled inner loop for necks: the way over a grid that keeps farthest from walls."""

from __future__ import annotations

import heapq
import math

import numpy as np

from ..core.jit import kernel


@kernel("int64[::1](float64[::1], int64, float64, int64, int64)")
def widest_way(room, side, pitch, start, end):
    """Return the points of the way over a square grid from one to another whose least room is greatest, the last one
    first; none where there is no way.

    Two of the eight neighbours of a point are joined to it where their discs without a wall overlap.

    Args:
        room: (side * side,) how far each point is from the walls, mm, column by column or row by row.
        pitch: of the grid, mm.

    References:
        Dijkstra's way, with the least room in place of the length (Pollack: the maximum capacity).
    """
    before, done = np.full(len(room), -1, np.int64), np.zeros(len(room), np.bool_)
    widest = np.zeros(len(room))
    widest[start] = room[start]
    heap = [(-room[start], start)]
    while len(heap) > 0:
        k = heapq.heappop(heap)[1]
        if done[k]:
            continue
        done[k] = True
        if k == end:
            break
        row, column = k // side, k % side
        for r in range(max(row - 1, 0), min(row + 2, side)):
            for c in range(max(column - 1, 0), min(column + 2, side)):
                j = r * side + c
                # discs that overlap leave no wall between the two points
                if done[j] or room[k] + room[j] <= pitch * math.sqrt(float((r - row) ** 2 + (c - column) ** 2)):
                    continue
                # a way is as wide as its narrowest point
                least = min(widest[k], room[j])
                if least > widest[j]:
                    widest[j], before[j] = least, k
                    heapq.heappush(heap, (-least, j))
    if not done[end]:
        return np.empty(0, np.int64)
    count, k = 1, end
    while k != start:
        count, k = count + 1, before[k]
    way, k = np.empty(count, np.int64), end
    for place in range(count):
        way[place], k = k, before[k]
    return way
