"""Motions that change nothing in what is left: another one goes the same way, nowhere higher.

A cutter over a place that goes deeper there takes all that it took before, whatever its shape. So of the turns of a
helix on one circle the last ones count alone, and of passes along one line or arc the deepest. Heights are the least of
all sweeps: which of the two came first is the same to them. It is not to a rapid that asks how high the metal is when
it comes, so none may lie between.
"""

from __future__ import annotations

from collections.abc import Sequence
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
    rows = np.flatnonzero((does == CUTS) & (turns | (kind <= MotionKind.LINE)))
    ways = _ways(motions, rows, turns[rows])
    group = _groups((*ways.columns, cutter[rows], np.cumsum(does == ASKS)[rows]))
    answer = np.zeros(len(motions), bool)
    answer[rows[_not_lowest(group, ways.first, ways.last)]] = True
    return answer


class _Ways(NamedTuple):
    """What ways m motions go in XY.

    Attributes:
        columns: (m,) each; motions go one way where all of these are alike.
        first, last: (m,) the heights at which they begin and end there, mm.
    """

    columns: tuple[NDArray[np.generic], ...]
    first: Floats
    last: Floats


def _ways(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> _Ways:
    """Return the ways of motions, column by column: of millions a table of them, and its copies, take a gigabyte.

    A line is the same from its other end; an arc too, the other way round.
    """
    start, end, centre = motions.start, motions.end, motions.centre
    x, other_x = start[rows, 0], end[rows, 0]
    later = (x > other_x) | ((x == other_x) & (start[rows, 1] > end[rows, 1]))
    swapped = np.where(turns, motions.kind[rows] == MotionKind.ARC_CW, later)
    columns: list[NDArray[np.generic]] = []
    for axis in (0, 1):
        a, b = start[rows, axis], end[rows, axis]
        found = (np.where(swapped, b, a), np.where(swapped, a, b), np.where(turns, centre[rows, axis], 0.0))
        columns += [np.rint(each / SAME) for each in found]
    columns.append(np.where(turns, motions.turns[rows], 0))
    low, high = start[rows, 2], end[rows, 2]
    return _Ways(tuple(columns), np.where(swapped, high, low), np.where(swapped, low, high))


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
