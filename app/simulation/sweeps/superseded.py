"""Motions that change nothing in what is left: another one goes the same way, nowhere higher.

A cutter over a place that goes deeper there takes all that it took before, whatever its shape. So of the turns of a
helix on one circle the last ones count alone, and of passes along one line or arc the deepest. Heights are the least of
all sweeps: which of the two came first is the same to them. It is not to a rapid that asks how high the metal is when
it comes, so none may lie between.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats, MotionKind, Motions, Plane

Mask = NDArray[np.bool_]

SAME = 1e-9
"""mm that two ways may differ by and be the same: what sums of a program's numbers differ by in their last bits."""


def superseded(motions: Motions, cutter: NDArray[np.int32], does: NDArray[np.uint8]) -> Mask:
    """Return which motions cut nothing that another does not; of motions that are alike all but one.

    Args:
        motions: n motions.
        cutter: (n,) what each is cut with; motions of different ones are not compared.
        does: (n,) what each does, by the numbers of `tile_kernels`.
    """
    from .tile_kernels import ASKS, CUTS

    kind = motions.kind
    turns = ((kind == MotionKind.ARC_CW) | (kind == MotionKind.ARC_CCW)) & (motions.plane == Plane.XY)
    asked = np.cumsum(does == ASKS, dtype=np.int32)
    rows = np.flatnonzero((does == CUTS) & (turns | (kind <= MotionKind.LINE)))
    rows = _not_alone(motions, rows, turns[rows], (cutter, asked))
    ways = _ways(motions, rows, turns[rows])
    group = _groups((*ways.columns, cutter[rows], asked[rows]))
    answer = np.zeros(len(motions), bool)
    answer[rows[_not_lowest(group, ways.first, ways.last)]] = True
    return answer


def _not_alone(
    motions: Motions, rows: NDArray[np.intp], turns: Mask, others: tuple[NDArray[np.int32], ...]
) -> NDArray[np.intp]:
    """Return those of the rows that may go the way of another: their columns have a hash that some other row has, too.

    Of millions of motions few go one way, and sorting one number each is quicker than sorting all columns.
    """
    code = np.zeros(len(rows), np.uint64)
    for column in _columns(motions, rows, turns):
        _mix(code, (column + 0.0).view(np.uint64))  # of two zeros there is one left
    for other in others:
        _mix(code, other[rows].astype(np.uint64))
    order = np.argsort(code, kind="stable")
    same = code[order[1:]] == code[order[:-1]]
    met = np.zeros(len(rows), bool)
    met[order[1:][same]] = met[order[:-1][same]] = True
    return rows[met]


def _mix(code: NDArray[np.uint64], values: NDArray[np.uint64]) -> None:
    """Mix values into hashes, in place (the finishing step of splitmix64)."""
    code ^= values
    code *= np.uint64(0xBF58476D1CE4E5B9)
    code ^= code >> np.uint64(29)


class _Ways(NamedTuple):
    """What ways m motions go in XY.

    Attributes:
        columns: (m,) each; motions go one way where all of these are alike.
        first, last: (m,) the heights at which they begin and end there, mm.
    """

    columns: tuple[Floats, ...]
    first: Floats
    last: Floats


def _ways(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> _Ways:
    """Return the ways of motions."""
    low, high = motions.start[rows, 2], motions.end[rows, 2]
    swapped = _swapped(motions, rows, turns)
    return _Ways(tuple(_columns(motions, rows, turns)), np.where(swapped, high, low), np.where(swapped, low, high))


def _columns(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> Iterator[Floats]:
    """Yield what tells the ways of motions apart, column by column: of millions a table of them takes a gigabyte."""
    swapped = _swapped(motions, rows, turns)
    for axis in (0, 1):
        a, b = motions.start[rows, axis], motions.end[rows, axis]
        yield np.rint(np.where(swapped, b, a) / SAME)
        yield np.rint(np.where(swapped, a, b) / SAME)
        yield np.rint(np.where(turns, motions.centre[rows, axis], 0.0) / SAME)
    yield np.where(turns, motions.turns[rows], 0).astype(np.float64)


def _swapped(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> Mask:
    """Return which motions are told from their ends: a line is the same from there, an arc too, the other way round."""
    start, end = motions.start, motions.end
    x, other_x = start[rows, 0], end[rows, 0]
    later = (x > other_x) | ((x == other_x) & (start[rows, 1] > end[rows, 1]))
    return np.asarray(np.where(turns, motions.kind[rows] == MotionKind.ARC_CW, later))


def _groups(columns: Sequence[NDArray[np.generic]]) -> NDArray[np.int64]:
    """Return (m,) a number for each row, the same for rows whose columns (m,) are all alike."""
    order = np.lexsort(columns)
    changes = np.zeros(max(len(order) - 1, 0), np.bool_)
    for column in columns:
        sorted_column = column[order]
        changes |= sorted_column[1:] != sorted_column[:-1]
    group = np.empty(len(order), np.int64)
    group[order] = np.concatenate([[0], np.cumsum(changes)]) if len(order) else 0
    return group


def _not_lowest(group: NDArray[np.int64], first: Floats, last: Floats) -> Mask:
    """Return for each of m pairs of heights whether one of its group has both no higher.

    In the order of first heights, it is the least of the last heights so far that tells; ranks that fall from group to
    group let the least begin anew with each.
    """
    count = len(group)
    order = np.lexsort((last, first, group))
    rank = np.unique(last, return_inverse=True)[1]
    value = rank[order] - group[order] * (count + 1)
    least = np.minimum.accumulate(value)
    answer = np.zeros(count, bool)
    answer[order[1:]] = (group[order[1:]] == group[order[:-1]]) & (least[:-1] <= value[1:])
    return answer
