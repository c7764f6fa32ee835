"""What lies within a distance of drawn lines: the outlines of lines that are grown, as exact lines and arcs.

A line is a wall that one can go round: its rows there and back bound no area, and the level of the distance round them
is the outline of what lies within. Round ends come out of the half turn at each end. Lines may cross, touch and end on
one another: the level is that of the distance from all of them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.part import Contour
from ..primitives import Primitives, Rows, contour_rows, reversed_rows, row_curve, within_half_turn
from .offset import Ring, offset_levels

_ROOM = 2.0
"""Times the distance, between the lines and the frame round them."""

_SAME = 1e-9
"""mm; lines of which all rows are this near to those of another one are drawn twice."""


def grown_lines(lines: Sequence[Contour], distance: float, progress: Progress = NO_PROGRESS) -> tuple[Contour, ...]:
    """Return the outlines of all that lies within a distance of some lines: the area is even-odd.

    Args:
        lines: open and closed ones; they may cross one another and themselves.
        distance: mm, > 0.

    Raises:
        Cancelled: by progress.
    """
    drawn = _once([contour_rows(line) for line in lines])
    if not drawn:
        return ()
    loops = [_frame(np.concatenate(drawn), _ROOM * distance)]
    for rows in drawn:
        back = reversed_rows(rows)
        closed = bool((rows[0, :2] == rows[-1, 2:4]).all())
        loops.extend((rows, back) if closed else (np.concatenate([rows, back]),))
    (level,) = offset_levels(_packed(loops), [distance], progress)
    ids = tuple(dict.fromkeys(number for line in lines for number in line.entity_ids))
    rings = sorted(level.rings, key=lambda ring: -ring.area)[1:]  # the largest one is that along the frame
    return tuple(_contour(ring, lines[0].layer, ids) for ring in rings)


def _once(lines: Sequence[Rows]) -> list[Rows]:
    """Return lines without those that are drawn as another one is, from either end."""
    kept: list[Rows] = []
    for rows in lines:
        ways = rows, reversed_rows(rows)
        if not any(
            each.shape == rows.shape and any(np.abs(each[:, :4] - way[:, :4]).max() < _SAME for way in ways)
            for each in kept
        ):
            kept.append(rows)
    return kept


def _frame(rows: Rows, room: float) -> Rows:
    """Return a box with room round rows, mm, counter-clockwise."""
    wide = rows[:, 6].max() + 2 * room  # of an arc no point is farther from its ends than two radii
    low, high = rows[:, :4].reshape(-1, 2).min(axis=0) - 2 * wide, rows[:, :4].reshape(-1, 2).max(axis=0) + 2 * wide
    corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
    return np.hstack([corners, np.roll(corners, -1, axis=0), np.zeros((4, 4))])


def _packed(loops: Sequence[Rows]) -> Primitives:
    """Return closed runs of rows as one region."""
    previous, first = [], 0
    for rows in loops:
        previous.append(first + (np.arange(len(rows)) - 1) % len(rows))
        first += len(rows)
    return Primitives(np.concatenate(loops), np.concatenate(previous), np.zeros(first, np.int64))


def _contour(ring: Ring, layer: str, ids: tuple[int, ...]) -> Contour:
    rows = within_half_turn(ring.rows)
    return Contour(tuple(row_curve(row) for row in rows), True, layer, ids)
