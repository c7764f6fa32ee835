"""Contours that cross become contours that only touch, with the same area by the even-odd rule.

The boundary of an even-odd area is the sum, modulo two, of all edges: whether an edge stays follows from how often it
is there, and no look at its sides can lose it. Sides say which of the edges that meet at a node go on from one another,
which edge that two areas share stays as a wall, and what outlines hold. At the end an independent witness measures the
same area.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.finding import Finding, FindingKind
from ...model.part import Contour
from ..chaining.findings import at
from ..distance import DistanceField
from ..even_odd import EvenOddMeasure, even_odd
from ..near_points import groups
from ..primitives import R, Rows, boxes, contour_rows, lengths, reversed_rows, row_curve, signed_area, sweeps
from .nodes import NodeOrder, PlanarEdges, RowPieces, edges_of, pieces_of, settled, turn_of

Indices = NDArray[np.int64]

Flags = NDArray[np.bool_]

_SPECK = tolerances.LEVEL**2
"""mm2; less is no area, whatever it is of."""

_NAMED = 3
"""So many contours are named in a sentence."""


@dataclass(frozen=True)
class OverlayResult:
    """What an overlay gives.

    Attributes:
        contours: closed; they touch at most.
        findings: where their area is not that of what they were made of.
    """

    contours: tuple[Contour, ...]
    findings: tuple[Finding, ...] = ()


def without_crossings(contours: Sequence[Contour]) -> OverlayResult:
    """Return contours whose even-odd area is the same, of which none crosses itself or another.

    Args:
        contours: closed.

    Returns:
        Closed contours; those that meet neither themselves nor others are as they were. They name all entities of those
        they were made of. Slivers thinner than WELD are left out.
    """
    pieces = pieces_of(*_together([contour_rows(contour) for contour in contours]))
    meet = _meeting(pieces, len(contours))
    made = [_MadeOf(k, contours[k]) for k in np.flatnonzero(~meet).tolist()]
    pieces = settled(_part(pieces, meet[pieces.contour]))
    if not len(pieces.rows):  # what meets is smaller than what is merged
        return OverlayResult(_in_order(made))
    net = PlanarGraph.of(pieces)
    odd = np.bincount(net.edges.of, minlength=len(net.edges.rows)) % 2 == 1
    none = np.zeros(len(net.members), np.int64)
    counts = counted(net.faces, CountSteps(odd, np.zeros(len(odd), np.int64)), none > 0, none)
    findings: list[Finding] = []
    for numbers, loops in zip(net.members, net.loops(odd, counts), strict=True):
        members = [contours[k] for k in numbers]
        parts = net.contours(loops, members)
        made += [_MadeOf(numbers[0], part) for part in parts]
        findings += differing(even_odd(members), even_odd(parts).area, members)
    return OverlayResult(_in_order(made), tuple(findings))


def without_outlines(contours: Sequence[Contour], outlines: Sequence[Contour]) -> OverlayResult:
    """Return contours of the area that contours bound by the even-odd rule, without what any of some outlines holds.

    Args:
        contours: closed; they may touch, but cross neither themselves nor one another.
        outlines: closed; none crosses itself, but they may lie over one another and over the contours.

    Returns:
        Closed contours that touch at most. Those that meet no outline are as they were.
    """
    if not contours or not outlines:
        return OverlayResult(tuple(contours))
    every, count = [*contours, *outlines], len(contours)
    rows = [contour_rows(contour) for contour in every]
    rows[count:] = [each if signed_area(each) > 0 else reversed_rows(each) for each in rows[count:]]
    pieces = settled(pieces_of(*_together(rows)))
    if not len(pieces.rows):  # all is smaller than what is merged
        return OverlayResult(tuple(contours))
    net = PlanarGraph.of(pieces)
    steps = _steps(net, count)
    around, holder = net.held_by(rows)
    odd = np.bincount(around, holder < count, len(net.members)) % 2 == 1
    held = np.bincount(around, holder >= count, len(net.members)).astype(np.int64)
    loops = net.loops(steps.odd, counted(net.faces, steps, odd, held))
    made: list[_MadeOf] = []
    for number, members in enumerate(net.members):
        mine = [every[k] for k in members if k < count]
        if len(mine) == len(members) and held[number] == 0:
            made += map(_MadeOf, members, mine)
        else:
            named = mine or [replace(every[members[0]], layer=contours[0].layer)]
            made += [_MadeOf(members[0], part) for part in net.contours(loops[number], named)]
    parts = _in_order(made)
    return OverlayResult(parts, tuple(differing(even_odd(contours, outlines), even_odd(parts).area, contours)))


def differing(drawn: EvenOddMeasure, made: float, contours: Sequence[Contour], spare: float = 0.0) -> list[Finding]:
    """Return the finding that an area is not what was drawn, if it is not: then something is wrong that nobody has
    noticed.

    Args:
        drawn: the witness of what was drawn.
        made: area of what was made of it, mm2.
        contours: from which it was made.
        spare: by which it may differ for reasons that are known, mm2, besides what merging moves.
    """
    missing = drawn.area - made
    if abs(missing) <= max(drawn.length * tolerances.WELD, _SPECK) + spare:
        return []
    x, y = contours[0].primitives[0].start
    places = ", ".join(at(contour.primitives[0].start) for contour in contours[:_NAMED])
    more = f" and {len(contours) - _NAMED} more" if len(contours) > _NAMED else ""
    who = f"contour that begins at {places}" if len(contours) == 1 else f"contours that begin at {places}{more}"
    text = (
        f"The area of the {who} came out {abs(missing):.4f} mm2 too {'small' if missing > 0 else 'large'}; do not use "
        "this program, move one of the curves by 1 um and compute again."
    )
    ids = tuple(dict.fromkeys(number for contour in contours for number in contour.entity_ids))
    return [Finding(FindingKind.AREA, text, x, y, entity_ids=ids, amount=abs(missing))]


class _MadeOf(NamedTuple):
    """A contour, and the number of the one that it was made of."""

    number: int
    contour: Contour


def _in_order(made: Sequence[_MadeOf]) -> tuple[Contour, ...]:
    """Return contours in the order of what they were made of."""
    return tuple(contour for _, contour in sorted(made, key=lambda each: each.number))


def _steps(net: PlanarGraph, count: int) -> CountSteps:
    """Return how counts of contours, which are numbered below `count`, and of outlines differ across each edge."""
    drawn = net.pieces.contour < count
    odd = np.bincount(net.edges.of, drawn, len(net.edges.rows)) % 2 == 1
    ahead = np.where(drawn, 0, np.where(net.edges.forward, 1, -1))
    return CountSteps(odd, np.bincount(net.edges.of, ahead, len(net.edges.rows)).astype(np.int64))


class _NumberedRows(NamedTuple):
    """Rows (n, 8), and the number of the contour of each."""

    rows: Rows
    contour: Indices


def _together(rows: Sequence[Rows]) -> _NumberedRows:
    """Return the rows of all contours, one after the other."""
    number = np.repeat(np.arange(len(rows)), [len(each) for each in rows])
    return _NumberedRows(np.concatenate([np.zeros((0, 8)), *rows]), number)


def _part(pieces: RowPieces, chosen: Flags) -> RowPieces:
    """Return some of the pieces."""
    start, end = pieces.start[chosen], pieces.end[chosen]
    return RowPieces(pieces.rows[chosen], pieces.contour[chosen], start, end, pieces.nodes, pieces.moved[chosen])


def _meeting(pieces: RowPieces, count: int) -> Flags:
    """Return which contours (count,) come to a node where they, or others, have been; ways forth and back do not
    count.
    """
    meet = np.zeros(count, np.bool_)
    if not len(pieces.rows):
        return meet
    edges = edges_of(pieces)
    index = np.arange(len(pieces.rows))
    first = np.unique(pieces.contour, return_index=True)[1]
    after = index + 1
    after[np.append(first[1:], len(index)) - 1] = first
    back = (edges.of[after] == edges.of) & (edges.forward[after] != edges.forward) & (after != index)
    before = np.empty_like(after)
    before[after] = index
    gone = back & ~back[before]
    kept = ~(gone | gone[before])
    node = pieces.start[kept]
    busy = np.bincount(node, minlength=len(pieces.nodes)) > 1
    meet[pieces.contour[kept][busy[node]]] = True
    return meet


# Connected nets of edges: whose contours they are of, what lies round them, and the contours that are made of them.


_SLIVER = tolerances.WELD / 4
"""mm; loops whose area is less than this times their length are what merging leaves of edges that nearly coincide."""


@dataclass(frozen=True, eq=False)
class PlanarGraph:
    """Pieces as edges, their order round the nodes, and the faces between them; several connected nets as a rule.

    Attributes:
        members: contours of each connected net, rising.
    """

    pieces: RowPieces
    edges: PlanarEdges
    turn: NodeOrder
    faces: Faces
    members: tuple[tuple[int, ...], ...]

    @staticmethod
    def of(pieces: RowPieces) -> PlanarGraph:
        """Return the net of some pieces, one or more."""
        edges = edges_of(pieces)
        turn = turn_of(edges)
        faces = faces_of(edges, turn)
        pairs = np.unique(np.stack([faces.net[edges.of], pieces.contour], 1), axis=0)
        stops = np.searchsorted(pairs[:, 0], np.arange(len(faces.outer)), side="right")[:-1]
        members = tuple(tuple(each.tolist()) for each in np.split(pairs[:, 1], stops))
        return PlanarGraph(pieces, edges, turn, faces, members)

    def loops(self, odd: Flags, counts: FaceCounts) -> list[list[list[int]]]:
        """Return for each connected net the loops of ends that bound its area; see `loops`.

        Args:
            odd: (n,) True for edges along which an odd number of contours runs.
        """
        inside = (counts.odd & (counts.held == 0))[self.faces.left]
        left, right = inside[::2], inside[1::2]
        wall = left & right & (self.faces.left[::2] != self.faces.left[1::2]) & ~odd
        whole = ~counts.torn[self.faces.net]
        kept = np.empty(2 * len(odd), np.bool_)
        kept[::2], kept[1::2] = (left & ~right | wall) & whole, (right & ~left | wall) & whole
        found = loops_along(self.edges, self.turn, kept)
        if not whole.all():
            found += loops_in_pairs(self.edges, self.turn, np.repeat(odd & ~whole, 2))
        loops: list[list[list[int]]] = [[] for _ in self.members]
        for loop in found:
            loops[int(self.faces.net[loop[0] // 2])].append(loop)
        return loops

    def contours(self, loops: Sequence[Sequence[int]], members: Sequence[Contour]) -> list[Contour]:
        """Return loops as contours that name all entities of some contours; slivers are left out."""
        ids = tuple(dict.fromkeys(number for contour in members for number in contour.entity_ids))
        deviation = max((contour.deviation for contour in members), default=0.0)
        made = []
        for loop in loops:
            rows = self._rows(np.array(loop))
            if abs(signed_area(rows)) > _SLIVER * float(lengths(rows).sum()):
                made.append(
                    Contour(
                        tuple(map(row_curve, rows)),
                        closed=True,
                        layer=members[0].layer,
                        entity_ids=ids,
                        deviation=deviation,
                    )
                )
        return made

    def _rows(self, ends: Indices) -> Rows:
        """Return the rows along some ends."""
        rows = self.edges.rows[ends // 2].copy()
        back = ends % 2 == 1
        rows[back] = reversed_rows(rows[back])[::-1]
        return rows

    def held_by(self, rows: Sequence[Rows]) -> tuple[Indices, Indices]:
        """Return (net, contour), each (m,), of contours that go round nets of which they are no part.

        Args:
            rows: of each contour.
        """
        first = np.unique(self.faces.net, return_index=True)[1]
        points = self.edges.rows[first, :2]
        own = np.full(len(rows), -1)
        for number, members in enumerate(self.members):
            own[list(members)] = number
        nets, held = [], []
        for k, each in enumerate(rows):
            around = boxes(each)
            low, high = around[:, :2].min(axis=0), around[:, 2:].max(axis=0)
            near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
            near = near[near != own[k]]
            if len(near):
                nets.append(near[DistanceField.of(each).inside(points[near])])
                held.append(np.full(len(nets[-1]), k))
        none = [np.zeros(0, np.int64)]
        return np.concatenate(none + nets), np.concatenate(none + held)


# Closed loops of edges that bound an area: no loop passes a node twice.


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


# What lies on either side of every edge: counted from face to face, never probed.
#
# Across an edge the count changes by what runs along it: even and odd change places where an odd number of contours
# does; the number of outlines that hold the place changes with their direction. One face of each connected net is its
# outer one, which is that with a negative area; what is counted there comes from the nets round it.


@dataclass(frozen=True, eq=False)
class Faces:
    """The faces between edges.

    Attributes:
        left: (2 n,) face to the left of each end as it leaves.
        net: (n,) number of the connected net of each edge, by its first one.
        net_of: (f,) net of each face.
        outer: (c,) outer face of each net.
    """

    left: Indices
    net: Indices
    net_of: Indices
    outer: Indices


@dataclass(frozen=True, eq=False)
class FaceCounts:
    """What is counted in each face.

    Attributes:
        odd: (f,) True where an odd number of contours goes round it.
        held: (f,) how many outlines hold it.
        torn: (c,) True for nets in which ways from face to face tell different counts.
    """

    odd: Flags
    held: Indices
    torn: Flags


@dataclass(frozen=True, eq=False)
class CountSteps:
    """How counts differ across each edge, from its right to its left: odd (n,), held (n,)."""

    odd: Flags
    held: Indices


def faces_of(edges: PlanarEdges, turn: NodeOrder) -> Faces:
    """Return the faces of some edges with their order round the nodes."""
    count = len(edges.rows)
    ends = np.arange(2 * count)
    left = groups(2 * count, np.stack([ends, turn.following() ^ 1], 1))
    nodes = int(max(edges.start.max(), edges.end.max())) + 1
    by_node = groups(nodes, np.stack([edges.start, edges.end], 1))
    net = np.unique(by_node[edges.start], return_index=True, return_inverse=True)
    rank = np.empty(len(net[0]), np.int64)
    rank[np.argsort(net[1])] = np.arange(len(net[0]))
    number = rank[net[2]]
    net_of = np.zeros(int(left.max()) + 1, np.int64)
    net_of[left] = number[ends // 2]
    areas = _areas(edges, left, number)
    order = np.lexsort((areas, net_of))
    outer = order[np.unique(net_of[order], return_index=True)[1]]
    return Faces(left, number, net_of, outer)


def _areas(edges: PlanarEdges, left: Indices, net: Indices) -> NDArray[np.float64]:
    """Return the area that the edges of each face run round, mm2; negative for outer ones."""
    first = np.unique(net, return_index=True)[1]
    origin = edges.rows[first, :2][net]
    a, b = edges.rows[:, :2] - origin, edges.rows[:, 2:4] - origin
    sweep = sweeps(edges.rows)
    part = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] + edges.rows[:, R] ** 2 * (sweep - np.sin(sweep))) / 2
    total = int(left.max()) + 1
    areas = np.bincount(left[::2], part, total) - np.bincount(left[1::2], part, total)
    return areas.astype(np.float64)


class _WayAcross(NamedTuple):
    """A way across an edge: to which face, whether the contours' count flips, and by how much the outlines' rises."""

    face: int
    flips: bool
    more: int


def counted(faces: Faces, steps: CountSteps, odd: Flags, held: Indices) -> FaceCounts:
    """Return the counts of all faces from those of the outer ones, odd (c,) and held (c,)."""
    total = len(faces.net_of)
    right, left = faces.left[1::2], faces.left[::2]
    ways: list[list[_WayAcross]] = [[] for _ in range(total)]
    for a, b, flips, more in zip(right.tolist(), left.tolist(), steps.odd.tolist(), steps.held.tolist(), strict=True):
        ways[a].append(_WayAcross(b, flips, more))
        ways[b].append(_WayAcross(a, flips, -more))
    parity, number, known = [False] * total, [0] * total, [False] * total
    for face, begins, holds in zip(faces.outer.tolist(), odd.tolist(), held.tolist(), strict=True):
        parity[face], number[face], known[face] = begins, holds, True
        waiting = deque([face])
        while waiting:
            here = waiting.popleft()
            for there, flips, more in ways[here]:
                if not known[there]:
                    parity[there], number[there], known[there] = parity[here] ^ flips, number[here] + more, True
                    waiting.append(there)
    odds, helds = np.array(parity, np.bool_), np.array(number, np.int64)
    wrong = (odds[left] ^ odds[right] != steps.odd) | (helds[left] - helds[right] != steps.held)
    torn = np.zeros(len(faces.outer), np.bool_)
    torn[faces.net[wrong]] = True
    return FaceCounts(odds, helds, torn)
