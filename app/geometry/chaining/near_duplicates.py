"""Curves drawn twice a little apart: their ends become one point, so that one of them can go."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ..near_points import all_within, groups
from .overlap import same
from .pieces import ChainPiece, length_of

Nodes = NDArray[np.int64]
_LONG = 4.0
"""Pieces not this many times longer than the reach are too short to tell a copy from a neighbour."""


def reach_of(join_tolerance: float) -> float:
    """Return how far apart two drawings of one curve may lie, mm.

    A tolerance above the default is meant for gaps; it must not take the two walls of a thin feature for one.
    """
    return max(min(join_tolerance, tolerances.JOIN), tolerances.WELD)


def merge_near_duplicates(pieces: Sequence[ChainPiece], ends: NDArray[np.float64], nodes: Nodes, reach: float) -> Nodes:
    """Return the nodes with the ends of pieces that lie within `reach` of one another all along made one.

    Outlines that are closed as they are keep to themselves: they are compared as wholes when they are chained. So do
    the walls of two neighbours: a chain of curves is a copy only if all of it lies on others.

    Args:
        pieces: what was drawn.
        ends: (2 n, 2) start and end of each, mm.
        nodes: (2 n,) number of the point of each end, -1 for circles.
        reach: mm.
    """
    if len(pieces) < 2:
        return nodes
    pairs = [pair for pair in _candidates(ends, nodes, reach) if same(pieces[pair[0]], pieces[pair[1]], reach)]
    pairs = _copies(pieces, nodes.reshape(-1, 2), [pair for pair in pairs if _met(pieces, nodes, pair, reach)], reach)
    found = [_met(pieces, nodes, pair, reach) for pair in pairs]
    thin = _thin(pieces, nodes, reach) if pairs else set()
    couples = [couple for met in found if not thin.intersection(met) for couple in met]
    if not couples:
        return nodes
    merged = groups(int(nodes.max()) + 1, np.array(couples))
    return np.where(nodes >= 0, merged[np.maximum(nodes, 0)], -1).astype(np.int64)


def _candidates(ends: NDArray[np.float64], nodes: Nodes, reach: float) -> list[tuple[int, int]]:
    """Return pairs of pieces, not both of closed outlines, whose ends lie within reach and are not the same already."""
    pairs = nodes.reshape(-1, 2)
    loose = np.flatnonzero((pairs[:, 0] >= 0) & ~_in_simple_loop(pairs))
    if len(loose) == 0:
        return []
    able = np.flatnonzero(pairs[:, 0] >= 0)
    whole = ends.reshape(-1, 4)
    found = set()
    for turned in (whole[loose], whole[loose][:, [2, 3, 0, 1]]):
        # of four numbers, none of which differs by more than reach
        place, other = all_within(whole[able], turned, 2 * reach)
        near = np.abs(turned[place] - whole[able[other]]).max(axis=1, initial=0.0) <= reach
        couples = zip(loose[place[near]].tolist(), able[other[near]].tolist(), strict=True)
        found |= {(min(j, k), max(j, k)) for j, k in couples if j != k}
    return sorted((j, k) for j, k in found if set(pairs[j].tolist()) != set(pairs[k].tolist()))


def _in_simple_loop(pairs: Nodes) -> NDArray[np.bool_]:
    """Return which pieces belong to an outline at each of whose points two ends meet."""
    group = _groups(pairs)
    meeting = np.bincount(pairs[pairs >= 0], minlength=1)
    broken = np.zeros(int(group.max()) + 1, dtype=bool)
    broken[group[(pairs[:, 0] >= 0) & (meeting[pairs] != 2).any(axis=1)]] = True
    result: NDArray[np.bool_] = ~broken[group]
    return result


def _groups(pairs: Nodes) -> Nodes:
    """Return for each piece the number of the chain of touching pieces that it is in; 0 for circles too."""
    group = groups(max(int(pairs.max()) + 1, 1), pairs[pairs[:, 0] >= 0])
    return np.where(pairs[:, 0] >= 0, group[np.maximum(pairs[:, 0], 0)], 0).astype(np.int64)


def _copies(
    pieces: Sequence[ChainPiece], nodes: Nodes, pairs: list[tuple[int, int]], reach: float
) -> list[tuple[int, int]]:
    """Return the pairs of which one piece is in a chain whose pieces, but for short ones, are all in some pair."""
    paired = {k for pair in pairs for k in pair}
    group = _groups(nodes)
    concerned = {int(group[k]) for k in paired}
    own = {
        int(group[k])
        for k, piece in enumerate(pieces)
        if k not in paired
        and int(group[k]) in concerned
        and nodes[k, 0] >= 0
        and sum(map(length_of, piece.primitives)) > _LONG * reach
    }
    return [(j, k) for j, k in pairs if int(group[j]) not in own or int(group[k]) not in own]


def _met(pieces: Sequence[ChainPiece], nodes: Nodes, pair: tuple[int, int], reach: float) -> list[tuple[int, int]]:
    """Return the two pairs of nodes (lower first) that become one when two pieces are the same curve; none if they are
    short.
    """
    j, k = pair
    a, b = pieces[j], pieces[k]
    if min(sum(map(length_of, p.primitives)) for p in (a, b)) <= _LONG * reach:
        return []
    choices = [
        (max(math.dist(a.start, b.start), math.dist(a.end, b.end)), 2 * k, 2 * k + 1),
        (max(math.dist(a.start, b.end), math.dist(a.end, b.start)), 2 * k + 1, 2 * k),
    ]
    apart, *other = min(choices)
    couples = [(int(nodes[2 * j + side]), int(nodes[end])) for side, end in enumerate(other)]
    return [(min(c), max(c)) for c in couples] if apart <= reach else []


def _thin(pieces: Sequence[ChainPiece], nodes: Nodes, reach: float) -> set[tuple[int, int]]:
    """Return the pairs of nodes (lower first) that mark the end of a thin feature: a short cap, or the tip of a
    spike.
    """
    caps = {
        (int(min(nodes[2 * k : 2 * k + 2])), int(max(nodes[2 * k : 2 * k + 2])))
        for k, piece in enumerate(pieces)
        if sum(map(length_of, piece.primitives)) <= _LONG * reach
    }
    tips = np.flatnonzero(np.bincount(nodes[nodes >= 0], minlength=1) == 2).tolist()
    return caps | {(tip, tip) for tip in tips}
