"""The order of edges round each node, counter-clockwise.

An edge has two ends, 2 k where it starts and 2 k + 1 where it ends; each leaves its node. Ends whose directions differ
are ordered by those. Where they hardly differ, as at a touch, it counts on which side one lies of the other at half the
length of the shorter one: they do not cross between their nodes, so any place in between tells, and half is farthest
from both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..primitives import CX, TURN, R, Rows, lengths, points_at, reversed_rows
from .nodes import PlanarEdges, half_lengths

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

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
    score = _scores(rows[ends], angle[ends], (low, high), np.flatnonzero(busy))
    return ends[np.lexsort((score, low))]


def _from_widest_gap(ends: Indices, gap: Floats, first: Indices, stop: Indices) -> tuple[Indices, Floats]:
    """Return (ends, gap before each) with the ends of each node begun behind its widest gap."""
    order = np.lexsort((-gap, first))
    starts = np.flatnonzero(np.arange(len(ends)) == first)
    widest = order[starts]  # the first of each node in that order
    shift = np.repeat(widest - starts, stop[starts] - starts)
    source = first + (np.arange(len(ends)) - first + shift) % (stop - first)
    return ends[source], gap[source]


def _scores(rows: Rows, angle: Floats, kind: tuple[Indices, Indices], busy: Indices) -> Floats:
    """Return for each place how many of its kind lie to the right of it; of those that are not busy: its place.

    Args:
        rows, angle: that set out at each place.
        kind: first place of those that set out alike, and the place behind the last.
    """
    low, high = kind
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
