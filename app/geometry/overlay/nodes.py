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
from ..chaining.crossings import contacts
from ..chaining.overlap import near_pairs
from ..distance import DistanceField
from ..near_points import groups, nearest, pairs_within
from ..primitives import CX, CY, TURN, X0, Y0, R, Rows, distances, lengths, points_at, sweeps
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
    number = groups(len(points), pairs_within(points, REACH))
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
