"""Motions that change nothing in what is left: another one goes the same way, nowhere higher.

A cutter over a place that goes deeper there takes all that it took before, whatever its shape. So of the turns of a
helix on one circle the last ones count alone, and of passes along one line or arc the deepest. Heights are the least of
all sweeps: which of the two came first is the same to them. It is not to a rapid that asks how high the metal is when
it comes, so none may lie between.
"""

from __future__ import annotations

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
    way, first, last = _ways(motions, rows, turns[rows])
    span = np.cumsum(does == ASKS)[rows]
    answer = np.zeros(len(motions), bool)
    answer[rows[_not_lowest(_groups(np.column_stack([way, cutter[rows], span])), first, last)]] = True
    return answer


def _ways(motions: Motions, rows: NDArray[np.intp], turns: Mask) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Return what ways motions go in XY as whole numbers (m, k), and at what height they begin and end there, mm.

    A line is the same from its other end; an arc too, the other way round.
    """
    start, end, centre = motions.start[rows], motions.end[rows], np.where(turns[:, None], motions.centre[rows], 0.0)
    later = (start[:, 0] > end[:, 0]) | ((start[:, 0] == end[:, 0]) & (start[:, 1] > end[:, 1]))
    swapped = np.where(turns, motions.kind[rows] == MotionKind.ARC_CW, later)[:, None]
    a, b = np.where(swapped, end, start), np.where(swapped, start, end)
    places = np.rint(np.column_stack([a[:, :2], b[:, :2], centre[:, :2]]) / SAME).astype(np.int64)
    return np.column_stack([places, np.where(turns, motions.turns[rows], 0)]), a[:, 2], b[:, 2]


def _groups(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return (m,) a number for each row, the same for rows that are alike."""
    order = np.lexsort(keys.T)
    changes = np.any(np.diff(keys[order], axis=0) != 0, axis=1)
    group = np.empty(len(keys), np.int64)
    group[order] = np.concatenate([[0], np.cumsum(changes)]) if len(keys) else 0
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
