"""Rows cut where they meet: every point where two meet is a node, and every row that passes a node goes through it.

One length decides, WELD: points nearer to one another are one node, a row nearer to a node passes it, pieces between
the same nodes that keep nearer are one edge. What moves through that is looked at again, until nothing new meets
(iterated snap rounding). No side is asked here, so nothing can be lost: every row stays a way from the node of its
start to that of its end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ..chaining.chain import contacts
from ..chaining.pieces import near_pairs
from ..distance import DistanceField
from ..near_points import groups, groups_within, nearest, pairs_within
from ..primitives import CX, CY, TURN, X0, Y0, R, Rows, distances, lengths, points_at, reversed_rows, sweeps
from . import overlay_kernels

Floats = NDArray[np.float64]

Indices = NDArray[np.int64]

Flags = NDArray[np.bool_]

REACH = tolerances.WELD
"""mm; the one length below which things are the same. Area moves by less than half of it times the length of what is
moved.
"""

_FLAT = REACH / 100
"""mm; an arc that rises less over its chord is a line: its ends may move by REACH and never make a full turn of it."""

_STILL = REACH / 1000
"""mm; what moved by less cannot have come to meet anything new that matters."""

_ROUNDS = 4
"""Times that rows are cut at most. Two suffice in almost all drawings; what is left then crosses by less than REACH."""


@dataclass(frozen=True, eq=False)
class RowPieces:
    """Parts of rows between nodes, in the order of the rows and along them.

    Attributes:
        rows: (n, 8).
        contour: (n,) of which contour each is part.
        start, end: (n,) numbers of the nodes that it joins, never the same.
        nodes: (k, 2) places, mm.
        moved: (n,) True where it is not where its row was, by more than rounding.
    """

    rows: Rows
    contour: Indices
    start: Indices
    end: Indices
    nodes: Floats
    moved: Flags


def pieces_of(rows: Rows, contour: Indices) -> RowPieces:
    """Return rows cut once wherever they meet.

    Args:
        rows: (n, 8) of closed contours, each behind the one that it follows.
        contour: (n,) number of the contour of each row.
    """
    return _cut(rows, contour, np.ones(len(rows), np.bool_))


def settled(pieces: RowPieces) -> RowPieces:
    """Return pieces cut again until nothing that moved meets anything new."""
    for _ in range(_ROUNDS - 1):
        if not pieces.moved.any():
            break
        again = _cut(pieces.rows, pieces.contour, pieces.moved)
        if len(again.rows) == len(pieces.rows) and np.array_equal(again.rows, pieces.rows):
            break
        pieces = again
    return pieces


def _cut(rows: Rows, contour: Indices, moved: Flags) -> RowPieces:
    """Return the pieces of rows; contacts are looked for where one of two rows has moved."""
    i, j = near_pairs(rows, REACH)
    new = moved[i] | moved[j]
    places, i, j = contacts(rows, i[new], j[new])
    number, nodes = _nodes(np.concatenate([rows[:, :2], rows[:, 2:4], places]))
    start, end, met = np.split(number, [len(rows), 2 * len(rows)])
    through, passed = _passing(rows, (start, end), nodes, _crossed(rows, places, met, (i, j)))
    kept = np.flatnonzero(start != end)
    row = np.concatenate([kept, through])
    share = np.concatenate([np.full(len(kept), -1.0), _fractions(rows[through], nodes[passed])])
    order = np.lexsort((share, row))
    row, begin = row[order], np.concatenate([start[kept], passed])[order]
    last = np.append(row[1:] != row[:-1], True) if len(row) else np.zeros(0, np.bool_)
    finish = np.where(last, end[row], np.append(begin[1:], -1)) if len(row) else begin
    made = _between(rows[row], nodes[begin], nodes[finish])
    off = np.maximum(distances(rows[row], nodes[begin]), distances(rows[row], nodes[finish]))
    return RowPieces(made, contour[row], begin, finish, nodes, off > _STILL)


def _nodes(points: Floats) -> tuple[Indices, Floats]:
    """Return (number of the node (n,) of each point, places (k, 2)); a node lies on the first of its points.

    Points that hang together from one to the next over more than REACH have several nodes, each more than REACH from
    the others.
    """
    number = groups_within(points, np.arange(len(points)), len(points), REACH)
    first = np.unique(number, return_index=True)[1]
    far = np.hypot(*(points - points[first[number]]).T) > REACH
    for long in np.unique(number[far]).tolist():
        members = np.flatnonzero(number == long)
        leaders = _leaders(points[members])
        chosen = members[leaders]
        number[members] = len(points) + chosen[nearest(points[chosen], points[members], 1)[1][:, 0]]
    first, number = np.unique(number, return_index=True, return_inverse=True)[1:]
    return number.astype(np.int64), points[first]


def _leaders(points: Floats) -> list[int]:
    """Return indices of points of which none is within REACH of another, and all others are within REACH of one."""
    cells: dict[tuple[int, int], list[int]] = {}
    leaders: list[int] = []
    for k, (x, y) in enumerate(points.tolist()):
        column, row = math.floor(x / REACH), math.floor(y / REACH)
        around = [m for a in (-1, 0, 1) for b in (-1, 0, 1) for m in cells.get((column + a, row + b), ())]
        if all(math.dist((x, y), points[m]) > REACH for m in around):
            cells.setdefault((column, row), []).append(k)
            leaders.append(k)
    return leaders


def _crossed(rows: Rows, places: Floats, node: Indices, pairs: tuple[Indices, Indices]) -> Indices:
    """Return (row, node) (m, 2) of rows on which contacts lie exactly: they cross there, so both have to go through its
    node.

    The node may be REACH away from the contact, and a hair more than that from the rows.
    """
    row, place, at = np.concatenate(pairs), np.concatenate([places, places]), np.concatenate([node, node])
    exact = distances(rows[row], place) <= _STILL
    return np.stack([row[exact], at[exact]], 1)


def _passing(rows: Rows, ends: tuple[Indices, Indices], nodes: Floats, crossed: Indices) -> tuple[Indices, Indices]:
    """Return (row, node), each (m,), where rows pass nodes other than those of their own ends, between their ends.

    Args:
        crossed: (k, 2) rows and nodes through which they have to go.
    """
    start, end = ends
    if not len(rows):
        return start, end
    field = DistanceField.of(rows)
    near = overlay_kernels.near_points(field.rows, field.order, field.nodes, np.ascontiguousarray(nodes), REACH)
    row, node = np.divmod(np.unique(np.concatenate([near, crossed]) @ [len(nodes), 1]), len(nodes))
    other = (node != start[row]) & (node != end[row]) & (start[row] != end[row])
    row, node = row[other], node[other]
    share = _fractions(rows[row], nodes[node])
    between = (share > 0) & (share < 1)
    return row[between], node[between]


def _fractions(rows: Rows, points: Floats) -> Floats:
    """Return where along its row each point lies, in [0, 1]."""
    along = rows[:, 2:4] - rows[:, :2]
    straight = ((points - rows[:, :2]) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300)
    sweep = np.abs(sweeps(rows))
    start = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX])
    ahead = (np.arctan2(points[:, 1] - rows[:, CY], points[:, 0] - rows[:, CX]) - start) * rows[:, TURN] % math.tau
    ahead = np.where(ahead > math.pi + sweep / 2, 0.0, ahead)  # a hair before the start
    fraction = np.where(rows[:, TURN] == 0, straight, ahead / np.maximum(sweep, 1e-300))
    clipped: Floats = np.clip(fraction, 0.0, 1.0)
    return clipped


def _between(rows: Rows, start: Floats, end: Floats) -> Rows:
    """Return parts of rows between other ends; arcs that are as good as straight become lines, the others keep their
    turn.
    """
    made = rows.copy()
    made[:, :2], made[:, 2:4] = start, end
    same = (made[:, :4] == rows[:, :4]).all(axis=1)
    chord = end - start
    square = np.maximum((chord**2).sum(axis=1), 1e-300)
    along = ((rows[:, CX:R] - (start + end) / 2) * chord).sum(axis=1) / square
    centre = rows[:, CX:R] - chord * along[:, None]
    arc = rows[:, TURN] != 0
    new = arc & ~same
    made[new, CX:R] = centre[new]
    made[new, R] = np.hypot(*(start - centre).T)[new]
    straight = arc & (square < 8 * rows[:, R] * _FLAT)
    # turned round: as small as its ends have moved
    straight |= new & (np.abs(sweeps(made)) > np.abs(sweeps(rows)) + 1e-3)
    made[straight, CX:] = 0.0
    return made


@dataclass(frozen=True, eq=False)
class PlanarEdges:
    """Pieces, each place once.

    Attributes:
        rows: (n, 8), from the node `start` to the node `end`.
        of: (m,) number of the edge of each piece.
        forward: (m,) True where the piece runs as its edge does.
    """

    rows: Rows
    start: Indices
    end: Indices
    of: Indices
    forward: Flags


def edges_of(pieces: RowPieces) -> PlanarEdges:
    """Return the edges that pieces lie on: those between the same nodes whose middles lie within REACH are one."""
    low, high = np.minimum(pieces.start, pieces.end), np.maximum(pieces.start, pieces.end)
    key, count = np.unique(low * (len(pieces.nodes) + 1) + high, return_inverse=True, return_counts=True)[1:]
    several = np.flatnonzero(count[key] > 1)
    middle = points_at(pieces.rows[several], np.full(len(several), 0.5))
    pairs = pairs_within(np.column_stack([middle, key[several].astype(np.float64)]), REACH)
    of = groups(len(pieces.rows), several[pairs].reshape(-1, 2))
    first = np.unique(of, return_index=True)[1]
    start, end = pieces.start[first], pieces.end[first]
    return PlanarEdges(pieces.rows[first], start, end, of, pieces.start == start[of])


def half_lengths(rows: Rows) -> Floats:
    """Return half the length of each row, mm, but no more than half its radius."""
    half: Floats = np.minimum(lengths(rows), np.where(rows[:, TURN] == 0, np.inf, rows[:, R])) / 2
    return half


# The order of edges round each node, counter-clockwise.
#
# An edge has two ends, 2 k where it starts and 2 k + 1 where it ends; each leaves its node. Ends whose directions
# differ are ordered by those. Where they hardly differ, as at a touch, it counts on which side one lies of the other
# at half the length of the shorter one: they do not cross between their nodes, so any place in between tells, and half
# is farthest from both.


_ALIKE = 0.3
"""Radians; ends less apart are compared with one another."""


@dataclass(frozen=True, eq=False)
class NodeOrder:
    """The ends of edges round their nodes.

    Attributes:
        ends: (2 n,) all ends, node by node, counter-clockwise round each.
        at: (2 n,) where in `ends` each stands.
        first, stop: (2 n,) where in `ends` the node of each begins and stops.
    """

    ends: Indices
    at: Indices
    first: Indices
    stop: Indices

    def following(self) -> Indices:
        """Return for each end the next one round its node, counter-clockwise."""
        after = self.at + 1
        return self.ends[np.where(after == self.stop, self.first, after)]


def turn_of(edges: PlanarEdges) -> NodeOrder:
    """Return the ends of some edges in their order round the nodes."""
    count = len(edges.rows)
    rows, node = np.empty((2 * count, 8)), np.empty(2 * count, np.int64)
    rows[::2], rows[1::2] = edges.rows, reversed_rows(edges.rows)[::-1]
    node[::2], node[1::2] = edges.start, edges.end
    angle = _directions(rows)
    ends = np.lexsort((angle, node))
    first, stop = _bounds(node[ends])
    ends = _refined(rows, angle, ends, first, stop)
    at = np.empty(2 * count, np.int64)
    at[ends] = np.arange(2 * count)
    return NodeOrder(ends, at, first[at], stop[at])


def _directions(rows: Rows) -> Floats:
    """Return in which direction each row sets out, radians."""
    arm = (rows[:, :2] - rows[:, CX:R]) * rows[:, [TURN]]
    line = rows[:, TURN] == 0
    ahead = np.where(line[:, None], rows[:, 2:4] - rows[:, :2], np.stack([-arm[:, 1], arm[:, 0]], 1))
    angle: Floats = np.arctan2(ahead[:, 1], ahead[:, 0])
    return angle


def _bounds(sorted_numbers: Indices) -> tuple[Indices, Indices]:
    """Return (first, stop), each (n,), of the run of equal numbers in which each stands."""
    if not len(sorted_numbers):
        return sorted_numbers, sorted_numbers
    new = np.concatenate([[True], sorted_numbers[1:] != sorted_numbers[:-1]])
    starts = np.flatnonzero(new)
    run = np.cumsum(new) - 1
    return starts[run], np.append(starts[1:], len(sorted_numbers))[run]


def _refined(rows: Rows, angle: Floats, ends: Indices, first: Indices, stop: Indices) -> Indices:
    """Return ends sorted by angle round each node, with those that set out alike put into order by their sides."""
    count = len(ends)
    if not count:
        return ends
    place = np.arange(count)
    before = np.where(place == first, stop - 1, place - 1)
    gap = (angle[ends] - angle[ends[before]]) % (2 * np.pi)
    gap[(place == first) & (stop - first == 1)] = 2 * np.pi
    ends, gap = _from_widest_gap(ends, gap, first, stop)
    breaks = (gap >= _ALIKE) | (place == first)
    low, high = _bounds(np.cumsum(breaks))
    busy = (stop - first > 2) & (high - low > 1)
    if not busy.any():
        return ends
    score = _scores(rows[ends], angle[ends], low, high, np.flatnonzero(busy))
    return ends[np.lexsort((score, low))]


def _from_widest_gap(ends: Indices, gap: Floats, first: Indices, stop: Indices) -> tuple[Indices, Floats]:
    """Return (ends, gap before each) with the ends of each node begun behind its widest gap."""
    order = np.lexsort((-gap, first))
    starts = np.flatnonzero(np.arange(len(ends)) == first)
    widest = order[starts]  # the first of each node in that order
    shift = np.repeat(widest - starts, stop[starts] - starts)
    source = first + (np.arange(len(ends)) - first + shift) % (stop - first)
    return ends[source], gap[source]


def _scores(rows: Rows, angle: Floats, low: Indices, high: Indices, busy: Indices) -> Floats:
    """Return for each place how many of its kind lie to the right of it; of those that are not busy: its place.

    Args:
        rows, angle: that set out at each place.
        low, high: first place of those that set out alike, and the place behind the last.
    """
    wide = high[busy] - low[busy]
    a = np.repeat(busy, wide)
    b = np.repeat(low[busy], wide) + np.arange(len(a)) - np.repeat(np.cumsum(wide) - wide, wide)
    a, b = a[a < b], b[a < b]
    left = _left_of(rows[b], rows[a])
    apart = (angle[b] - angle[a] + np.pi) % (2 * np.pi) - np.pi
    later = np.where(np.abs(apart) < _ALIKE, left, True)  # unlike ones are in order by angle
    score = np.zeros(len(rows))
    np.add.at(score, np.where(later, b, a), 1.0)
    idle = np.ones(len(rows), np.bool_)
    idle[busy] = False
    score[idle] = np.flatnonzero(idle)
    return score


def _left_of(rows: Rows, others: Rows) -> NDArray[np.bool_]:
    """Return whether rows lie to the left of others that set out from the same point."""
    reach = np.minimum(half_lengths(rows), half_lengths(others))
    off = _offset(rows, others, reach) - _offset(others, rows, reach)
    result: NDArray[np.bool_] = off > 0
    return result


def _offset(rows: Rows, others: Rows, reach: Floats) -> Floats:
    """Return how far to the left of the others' carriers the rows are, so far along, mm."""
    point = points_at(rows, reach / np.maximum(lengths(rows), 1e-300))
    along, arm = others[:, 2:4] - others[:, :2], point - others[:, :2]
    straight = (along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]) / np.maximum(np.hypot(*along.T), 1e-300)
    curved = (others[:, R] - np.hypot(*(point - others[:, CX:R]).T)) * others[:, TURN]
    off: Floats = np.where(others[:, TURN] == 0, straight, curved)
    return off
