"""Contours that cross become contours that only touch, with the same area by the even-odd rule."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from app import tolerances
from app.geometry.chain_crossings import contacts
from app.geometry.chain_overlap import near_pairs
from app.geometry.distance import DistanceField
from app.geometry.near_points import groups, nearest, pairs_within
from app.geometry.primitives import (
    CX,
    CY,
    TURN,
    X0,
    X1,
    Y0,
    Y1,
    Rows,
    boxes,
    contour_rows,
    lengths,
    points_at,
    reversed_rows,
    row_curve,
    signed_area,
    sweeps,
)
from app.model.part import Contour

_NOT_BACK = 1e-9
"""Radians; the way back along a shared edge is the last choice, not the first."""

_SIDE = tolerances.WELD
"""mm; how far from a piece its two sides are looked at."""


def without_crossings(contours: Sequence[Contour]) -> tuple[Contour, ...]:
    """Return contours whose even-odd area is the same, of which none crosses itself or another.

    Every contour is cut where it meets another; each piece is turned so that the area lies to its left; pieces are
    joined again by always taking, of the pieces that go on from a meeting point, the one that bounds the same area.

    Args:
        contours: closed.

    Returns:
        Closed contours. They name all entities of those they were made of. Slivers thinner than WELD are left out.
    """
    groups: dict[int, list[Contour]] = {}
    for contour, number in zip(contours, _meeting(contours), strict=True):
        groups.setdefault(number, []).append(contour)
    return tuple(part for group in groups.values() for part in _parted(group))


def without_outlines(contours: Sequence[Contour], outlines: Sequence[Contour]) -> tuple[Contour, ...]:
    """Return contours of the area that contours bound by the even-odd rule, without what any of some outlines holds.

    Args:
        contours: closed; they may touch, but cross neither themselves nor one another.
        outlines: closed; none crosses itself, but they may lie over one another and over the contours.

    Returns:
        Closed contours that touch at most. Those that lie far from all outlines are as they were.
    """
    if not contours or not outlines:
        return tuple(contours)
    rows, held = [contour_rows(contour) for contour in contours], [contour_rows(outline) for outline in outlines]
    area, fields = DistanceField.of(np.concatenate(rows)), [DistanceField.of(each) for each in held]

    def inside(points: NDArray[np.float64]) -> NDArray[np.bool_]:
        free: NDArray[np.bool_] = area.inside(points)
        for field in fields:
            free[free] = ~field.inside(points[free])
        return free

    near = _boxes_meet(rows, held)
    changed = [each for each, mine in zip(contours, near, strict=True) if mine]
    blocks = [*(each for each, mine in zip(rows, near, strict=True) if mine), *held]
    pieces = _split(np.concatenate([each if signed_area(each) > 0 else reversed_rows(each) for each in blocks]))
    made = _joined(_once(_turned(pieces[lengths(pieces) > tolerances.WELD], inside)), changed or contours)
    return (*(each for each, mine in zip(contours, near, strict=True) if not mine), *made)


def _boxes_meet(rows: Sequence[Rows], others: Sequence[Rows]) -> NDArray[np.bool_]:
    """Return which contours (n,) have a box that comes near to the box of another."""
    mine, theirs = (np.array([boxes(each)[:, :2].min(axis=0).tolist() + boxes(each)[:, 2:].max(axis=0).tolist() for each in some])
                    for some in (rows, others))  # fmt: skip
    apart = np.array([(theirs[:, :2] > box[2:] + 1e-3).any(axis=1) | (theirs[:, 2:] < box[:2] - 1e-3).any(axis=1) for box in mine])
    near: NDArray[np.bool_] = np.logical_not(apart.all(axis=1))
    return near


def _once(pieces: Rows) -> Rows:
    """Return pieces without those that are there twice the same way round, where an outline lies along a contour or another."""
    if len(pieces) < 2:
        return pieces
    places = np.column_stack([pieces[:, :4], points_at(pieces, np.full(len(pieces), 0.5))])
    pairs = pairs_within(places, 20 * tolerances.WELD)
    kept: Rows = np.delete(pieces, np.unique(pairs.max(axis=1)), axis=0)
    return kept


def _meeting(contours: Sequence[Contour]) -> list[int]:
    """Return for each contour the number of the group of contours that meet one another."""
    rows = [contour_rows(contour) for contour in contours]
    owner = np.repeat(np.arange(len(rows)), [len(r) for r in rows])
    whole = np.concatenate([np.zeros((0, 8)), *rows])
    _, i, j = contacts(whole, *near_pairs(whole, tolerances.WELD))
    return list(groups(len(rows), np.stack([owner[i], owner[j]], 1)).tolist())


def _parted(contours: Sequence[Contour]) -> tuple[Contour, ...]:
    """Return the simple contours of one group."""
    rows = [contour_rows(contour) for contour in contours]
    whole = np.concatenate([block if signed_area(block) > 0 else reversed_rows(block) for block in rows])
    pieces = _split(whole)
    pieces = pieces[lengths(pieces) > tolerances.WELD]
    return _joined(_turned(pieces, DistanceField.of(whole).inside), contours)


def _joined(pieces: Rows, contours: Sequence[Contour]) -> tuple[Contour, ...]:
    """Return the contours that pieces of some contours make."""
    pieces, start, end = _welded(pieces)
    loops = _loops(pieces, start, end)
    ids = tuple(dict.fromkeys(i for contour in contours for i in contour.entity_ids))
    deviation = max((contour.deviation for contour in contours), default=0.0)
    return tuple(Contour(tuple(row_curve(row) for row in pieces[loop]), True, contours[0].layer, ids, deviation)
                 for loop in loops if abs(signed_area(pieces[loop])) > float(lengths(pieces[loop]).sum()) * tolerances.WELD)


def _split(rows: Rows) -> Rows:
    """Return the rows cut at every point where two of them meet."""
    points, i, j = contacts(rows, *near_pairs(rows, tolerances.WELD))
    owner, place = np.concatenate([i, j]), np.concatenate([points, points])
    cuts: list[list[float]] = [[0.0, 1.0] for _ in rows]
    for k, fraction in zip(owner, _fractions(rows[owner], place), strict=True):
        cuts[k].append(float(fraction))
    index = np.concatenate([np.full(len(c) - 1, k) for k, c in enumerate(cuts)])
    low = np.concatenate([np.sort(c)[:-1] for c in cuts])
    high = np.concatenate([np.sort(c)[1:] for c in cuts])
    parts = rows[index].copy()
    parts[:, :2] = points_at(rows[index], low)
    parts[:, 2:4] = np.where((high == 1)[:, None], rows[index, 2:4], points_at(rows[index], high))
    used: Rows = parts[high > low]
    return used


def _fractions(rows: Rows, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return where along its row each point lies, in [0, 1]."""
    along = rows[:, 2:4] - rows[:, :2]
    straight = ((points - rows[:, :2]) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300)
    sweep = sweeps(rows)
    start = np.arctan2(rows[:, Y0] - rows[:, CY], rows[:, X0] - rows[:, CX])
    ahead = (np.arctan2(points[:, 1] - rows[:, CY], points[:, 0] - rows[:, CX]) - start) * rows[:, TURN] % math.tau
    ahead = np.where(ahead > math.pi + np.abs(sweep) / 2, 0.0, ahead)  # a hair before the start
    fraction = np.where(rows[:, TURN] == 0, straight, ahead / np.maximum(np.abs(sweep), 1e-300))
    clipped: NDArray[np.float64] = np.clip(fraction, 0.0, 1.0)
    return clipped


def _turned(pieces: Rows, inside: Callable[[NDArray[np.float64]], NDArray[np.bool_]]) -> Rows:
    """Return the pieces with the area to their left.

    With the area on both sides a piece is an edge that two contours share: a wall without thickness, which each keeps
    in the direction of its own counter-clockwise outline. With the area on neither side it bounds nothing, and goes.
    """
    middle = points_at(pieces, np.full(len(pieces), 0.5))
    ahead = points_at(pieces, np.full(len(pieces), 0.5 + 1e-6)) - points_at(pieces, np.full(len(pieces), 0.5 - 1e-6))
    normal = np.stack([-ahead[:, 1], ahead[:, 0]], 1) / np.maximum(np.hypot(*ahead.T), 1e-300)[:, None]
    left, right = inside(middle + normal * _SIDE), inside(middle - normal * _SIDE)
    back = pieces.copy()
    back[:, [X0, Y0, X1, Y1]] = pieces[:, [X1, Y1, X0, Y0]]
    back[:, TURN] *= -1
    kept = (left != right) | (left & right & _twice(middle))
    turned: Rows = np.where((right & ~left)[:, None], back, pieces)[kept]
    return turned


def _twice(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which points (n, 2) are there more than once."""
    if len(points) < 2:
        return np.zeros(len(points), np.bool_)
    twice: NDArray[np.bool_] = nearest(points, points, 2)[0][:, 1] < 10 * tolerances.WELD
    return twice


def _welded(pieces: Rows) -> tuple[Rows, NDArray[np.int64], NDArray[np.int64]]:
    """Return (pieces, number of the point where each starts, and ends); ends within 10 WELD become one point."""
    count = len(pieces)
    ends = np.concatenate([pieces[:, :2], pieces[:, 2:4]])
    number = groups(2 * count, pairs_within(ends, 10 * tolerances.WELD))
    first = np.unique(number, return_index=True)[1]
    pieces = pieces.copy()
    pieces[:, :2], pieces[:, 2:4] = ends[first[number[:count]]], ends[first[number[count:]]]
    return pieces, number[:count], number[count:]


def _loops(pieces: Rows, start: NDArray[np.int64], end: NDArray[np.int64]) -> list[list[int]]:
    """Return closed sequences of pieces; where several go on from a point, the next one clockwise from the way back."""
    leaving: dict[int, list[int]] = {}
    for k, node in enumerate(start):
        leaving.setdefault(int(node), []).append(k)
    small = np.minimum(1e-3 / np.maximum(lengths(pieces), 1e-300), 0.5)
    out = points_at(pieces, small) - pieces[:, :2]
    back = points_at(pieces, 1 - small) - pieces[:, 2:4]
    loops: list[list[int]] = []
    unused = set(range(len(pieces)))
    while unused:
        loop = [min(unused)]
        while True:
            unused.discard(loop[-1])
            choices = [k for k in leaving.get(int(end[loop[-1]]), ()) if k in unused or k == loop[0]]
            if not choices:
                break  # a loose end: not a closed contour, and dropped
            reverse = math.atan2(back[loop[-1], 1], back[loop[-1], 0])
            following = min(choices, key=lambda k: (reverse - math.atan2(out[k, 1], out[k, 0]) - _NOT_BACK) % math.tau)
            if following == loop[0]:
                loops.append(loop)
                break
            loop.append(following)
    return loops
