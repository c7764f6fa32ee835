"""Closed loops of edges that bound an area: no loop passes a node twice."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .node_order import NodeOrder
from .nodes import PlanarEdges

Indices = NDArray[np.int64]
Flags = NDArray[np.bool_]


def loops_along(edges: PlanarEdges, turn: NodeOrder, kept: Flags) -> list[list[int]]:
    """Return loops of ends (2 k: along edge k, 2 k + 1: back along it) that have the same area to their left all along.

    Args:
        kept: (2 n,) True for the ends that leave with the area to their left.
    """
    return _simple(edges, _next_clockwise(turn, kept), np.flatnonzero(kept).tolist())


def loops_in_pairs(edges: PlanarEdges, turn: NodeOrder, kept: Flags) -> list[list[int]]:
    """Return loops in which all edges are used once, whatever lies beside them; there is an even number at each node.

    Args:
        kept: (2 n,) True for both ends of these edges.
    """
    chosen = turn.ends[kept[turn.ends]]
    partner = np.full(len(kept), -1, np.int64)
    partner[chosen[::2]], partner[chosen[1::2]] = chosen[1::2], chosen[::2]
    following = np.full(len(kept), -1, np.int64)
    ends = np.flatnonzero(kept)
    following[ends] = partner[ends ^ 1]
    return _simple(edges, following, ends.tolist(), either_way=True)


def _next_clockwise(turn: NodeOrder, kept: Flags) -> Indices:
    """Return for each end which kept one goes on from where it leads: the next clockwise from the way back; -1 where
    none does.
    """
    place = np.arange(len(turn.ends))
    there = kept[turn.ends]
    first, stop = turn.first[turn.ends], turn.stop[turn.ends]
    last = np.maximum.accumulate(np.where(there, place, -1))
    before = np.concatenate([[-1], last[:-1]])
    before = np.where(before >= first, before, last[stop - 1])
    before = np.where(before >= first, before, -1)
    following = np.where(before >= 0, turn.ends[before], -1)
    back = np.arange(len(turn.ends)) ^ 1
    onward: Indices = following[turn.at[back]]
    return onward


def _simple(edges: PlanarEdges, following: Indices, begins: Iterable[int], either_way: bool = False) -> list[list[int]]:
    """Return the loops that `following` makes, parted where they come back to a node; what does not close is no loop.

    Args:
        either_way: an edge that was used one way is not used the other way too.
    """
    onward, node = following.tolist(), np.stack([edges.start, edges.end], 1).ravel().tolist()
    used = [False] * len(onward)
    loops: list[list[int]] = []
    for begin in begins:
        way: list[int] = []
        seen: dict[int, int] = {}
        end = begin
        while end >= 0 and not used[end]:
            used[end] = True
            used[end ^ 1] |= either_way
            seen[node[end]] = len(way)
            way.append(end)
            reached = seen.get(node[end ^ 1])
            if reached is not None:
                loop, way = way[reached:], way[:reached]
                loops.append(loop)
                for each in loop[1:]:
                    del seen[node[each]]
            end = onward[end]
    return loops
