"""Which ends of curves are one point: equal ends, and loose ends within the join tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from operator import attrgetter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.curves import Arc, Line, Point
from ..near_points import all_within, groups, groups_within, pairs_within
from .findings import ClosedGap
from .pieces import ChainPiece, length_of, repeated, same, with_ends

Nodes = NDArray[np.int64]


def nodes_of(pieces: Sequence[ChainPiece], join_tolerance: float) -> Nodes:
    """Return (n, 2) numbers of the points at which each piece starts and ends; -1 for circles.

    Ends within WELD of one another are one point. Of what is loose then, the nearest two within the tolerance are
    joined first, so that joining never swallows a detail that is already connected; a loose end without such a
    partner is joined to the nearest point within the tolerance. A curve drawn twice, be it a
    little apart, does not connect its own copy.
    """
    ends = _ends_of(pieces).reshape(-1, 2)
    nodes, reach = _welded(ends), reach_of(join_tolerance)
    nodes[np.repeat(np.array([p.is_circle for p in pieces], dtype=bool), 2)] = -1
    nodes = merge_near_duplicates(pieces, ends, nodes, reach)
    if join_tolerance > tolerances.WELD and len(pieces):
        single = np.ones(len(pieces), dtype=bool)
        single[[overlap.second for overlap in repeated(pieces, nodes.reshape(-1, 2), reach)]] = False
        _join_loose(
            pieces,
            ends,
            _JoinedEnds(np.where(np.repeat(single, 2), nodes, -1), nodes),
            join_tolerance + tolerances.WELD,
        )
    return nodes.reshape(-1, 2)


def _ends_of(pieces: Sequence[ChainPiece]) -> NDArray[np.float64]:
    """Return (n, 4) x and y of where each piece starts and ends, mm."""
    numbers = chain.from_iterable(chain.from_iterable(map(attrgetter("start", "end"), pieces)))
    return np.fromiter(numbers, np.float64, 4 * len(pieces)).reshape(-1, 4)


def _welded(ends: NDArray[np.float64]) -> Nodes:
    if len(ends) == 0:
        return np.zeros(0, np.int64)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    new = np.append(True, (ends[order[1:]] != ends[order[:-1]]).any(axis=1))
    points, nodes = ends[order[new]], np.empty(len(ends), np.int64)
    nodes[order] = np.cumsum(new) - 1
    return groups_within(points, np.arange(len(points)), len(points), tolerances.WELD)[nodes]


class _JoinedEnds(NamedTuple):
    """Numbers of the points of ends: -1 for circles and for curves that repeat another; and of all, which change."""

    single: Nodes
    every: Nodes


def _join_loose(pieces: Sequence[ChainPiece], ends: NDArray[np.float64], joined: _JoinedEnds, reach: float) -> None:
    """Give points that belong together within `reach` mm the same number, in place."""
    single, nodes = joined
    loose = _loose(single)
    if len(loose) == 0:
        return
    pairs = pairs_within(ends[loose], reach)
    gaps = np.hypot(*(ends[loose[pairs[:, 0]]] - ends[loose[pairs[:, 1]]]).T)
    free = set(loose.tolist())
    becomes = np.arange(single.max() + 1)
    for k in np.lexsort((pairs[:, 1], pairs[:, 0], np.round(gaps, 9))):
        a, b = int(loose[pairs[k, 0]]), int(loose[pairs[k, 1]])
        if a in free and b in free and _may_meet(pieces, a, b, float(gaps[k])):
            becomes[single[b]] = single[a]
            free -= {a, b}
    if free:
        points = np.flatnonzero(single >= 0)
        left = np.array(sorted(free))
        place, found = all_within(ends[points], ends[left], reach)
        begins = np.searchsorted(place, np.arange(len(left) + 1)).tolist()
        for k, a in enumerate(left.tolist()):
            near = [(math.dist(ends[a], ends[b]), int(b)) for b in points[found[begins[k] : begins[k + 1]]]]
            allowed = [
                b
                for gap, b in sorted(near)
                if becomes[single[b]] != becomes[single[a]] and _may_meet(pieces, a, b, gap)
            ]
            if allowed:
                becomes[single[a]] = becomes[single[allowed[0]]]
    nodes[nodes >= 0] = becomes[nodes[nodes >= 0]]


def _loose(nodes: Nodes) -> Nodes:
    """Return the ends whose point no other end shares."""
    counts = np.bincount(nodes[nodes >= 0], minlength=1)
    return np.flatnonzero((nodes >= 0) & (counts[np.maximum(nodes, 0)] == 1))


def _may_meet(pieces: Sequence[ChainPiece], a: int, b: int, gap: float) -> bool:
    """A curve may close on itself only when it is much longer than its gap."""
    if a // 2 != b // 2:
        return True
    piece = pieces[a // 2]
    return (
        not (len(piece.primitives) == 1 and isinstance(piece.primitives[0], Line))
        and sum(map(length_of, piece.primitives)) > 3 * gap
    )


class JoinedPieces(NamedTuple):
    """Pieces with ends that meet exactly, their nodes, and every gap wider than 1 um that was closed."""

    pieces: list[ChainPiece]
    nodes: Nodes
    gaps: list[ClosedGap]


class _PieceEnd(NamedTuple):
    """Where a piece ends, and whether with an arc."""

    place: Point
    is_arc: bool


def join_ends(pieces: Sequence[ChainPiece], nodes: Nodes) -> JoinedPieces:
    """Return the pieces with ends that meet exactly.

    Pieces that shrink to nothing are left out. Lines give way to arcs: the point where ends meet is the mean of the
    arcs' ends there, or of all ends when there are only lines.
    """
    apart = _apart(pieces, nodes)
    ends: dict[int, list[_PieceEnd]] = {}
    for k in apart:
        piece, (a, b) = pieces[k], nodes[k].tolist()
        ends.setdefault(a, []).append(_PieceEnd(piece.start, isinstance(piece.primitives[0], Arc)))
        ends.setdefault(b, []).append(_PieceEnd(piece.end, isinstance(piece.primitives[-1], Arc)))
    target: dict[int, Point] = {}
    gaps: list[ClosedGap] = []
    for node, members in ends.items():
        points = {point for point, _ in members}
        if len(points) == 1:
            target[node] = members[0].place
            continue
        target[node] = _mean([point for point, is_arc in members if is_arc] or [point for point, _ in members])
        gap = max(math.dist(p, q) for p in points for q in points)
        if gap > tolerances.CURVE:
            gaps.append(ClosedGap(gap, target[node]))
    moved = list(pieces)
    for k in apart:
        a, b = nodes[k].tolist()
        moved[k] = with_ends(pieces[k], target[a], target[b])
    kept = [k for k, piece in enumerate(moved) if piece.primitives]
    return JoinedPieces([moved[k] for k in kept], nodes[kept] if len(nodes) else nodes, gaps)


def _apart(pieces: Sequence[ChainPiece], nodes: Nodes) -> list[int]:
    """Return the pieces, by their indices, one of whose ends is at a point whose ends are not all the same: all that
    may have to move.
    """
    if not len(nodes):
        return []
    places, at = _ends_of(pieces).reshape(-1, 2), nodes.ravel()
    first = np.zeros(int(at.max()) + 2, np.int64)
    first[at] = np.arange(len(at))
    uneven = np.zeros(len(first), np.bool_)
    uneven[at[(places != places[first[at]]).any(axis=1)]] = True
    uneven[-1] = False  # circles, which have no ends
    found: list[int] = np.flatnonzero(uneven[nodes].any(axis=1)).tolist()
    return found


def _mean(points: list[Point]) -> Point:
    if len(set(points)) == 1:
        return points[0]
    return sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points)


# Curves drawn twice a little apart: their ends become one point, so that one of them can go.


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
