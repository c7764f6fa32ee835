"""Slants: ways there and back between two rings that leave out a piece of the outer one and cut what it would have cut.

Where levels are no farther apart than the tool's radius, every point between two levels is cut by the outer one: by the
ring's point y on the way to the nearest wall. So when a piece of a ring is left out, only what lies within a step
inwards of it is still to be cut, and its rows, moved inwards by the step, bound all of that. A straight way cuts
whatever it comes within the radius of, which is convex: it cuts a row's whole strip when it comes as near to the
strip's corners. The outermost level's rings have nothing outside them that cuts their walls' side, and stay whole.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...geometry.distance import DistanceField
from ...geometry.primitives import CX, CY, TURN, R, Rows, lengths, sweeps
from ..leads.contour_path import headings_at, left_of
from .bridge import is_clear
from .rows import RingPlace, along, point_at, span

_LONGEST = (4.0, 3.0, 2.0, 1.5, 1.0, 0.5)
"""Steps along the ring that a slant takes on either side; the longer the less way it costs."""

_SPARE = 1e-3
"""Of the step: so much nearer than it slants come to all that they have to cut."""

_WIDEST = 0.5 * np.pi
"""Radians; along arcs that turn more no piece is left out."""

Floats = NDArray[np.float64]


def left_out(
    rows: Rows, place: RingPlace, apex: Floats, room: tuple[float, float], keep: tuple[DistanceField, float, float]
) -> tuple[float, float]:
    """Return how much of a ring before and after a place slants to a point of the ring inside it leave out, in rows.

    Args:
        rows: of the outer ring, in its own direction: walls are on the right.
        place: where the bridge to the inner ring begins.
        apex: (2,) where it ends.
        room: before and after the place that may be left out, mm.
        keep: distances from the walls, how much of it is kept, and the step between levels, mm.
    """
    field, least, step = keep
    at, found = place.row + place.fraction, [0.0, 0.0]
    for side, sign in enumerate((-1.0, 1.0)):
        for share in _LONGEST:
            if share * step > room[side]:
                continue
            end = along(rows, at, sign * share * step)
            start = point_at(rows, end)
            if covers(start, apex, span(rows, *sorted((at, end))), step) and is_clear(field, start, apex, least):
                found[side] = abs(end - at)
                break
    return found[0], found[1]


def covers(a: Floats, b: Floats, rows: Rows, step: float) -> bool:
    """Tell whether a straight way cuts all that some rows cut within a step to their left, by a tool of a radius of
    that or more.
    """
    if np.any(np.abs(sweeps(rows)) > _WIDEST):
        return False
    corners = _corners(rows, step)
    ahead = b - a
    part = np.clip((corners - a) @ ahead / float(ahead @ ahead), 0.0, 1.0)
    return bool(np.all(np.hypot(*(corners - a - part[:, None] * ahead).T) <= step * (1 - _SPARE)))


def _corners(rows: Rows, step: float) -> Floats:
    """Return points whose hull holds the strip of a step to the left of each row; no arc's strip goes past its
    centre.
    """
    bent = rows[:, TURN] != 0
    wide = np.where(bent & (rows[:, TURN] > 0), np.minimum(step, rows[:, R]), step)[:, None]
    ends = [(rows[:, 2 * k : 2 * k + 2], left_of(headings_at(rows, np.full(len(rows), float(k))))) for k in (0, 1)]
    corners = [point + width * aside for point, aside in ends for width in (0.0, wide)]
    arcs, half = rows[bent], np.abs(sweeps(rows[bent])) / 2
    middle = -arcs[:, [TURN]] * left_of(headings_at(arcs, np.full(len(arcs), 0.5)))
    outer = arcs[:, R] + np.where(arcs[:, TURN] < 0, step, 0.0)
    return np.concatenate([*corners, arcs[:, [CX, CY]] + middle * (outer / np.cos(half))[:, None]])


def room_beside(rows: Rows, place: RingPlace, others: Sequence[RingPlace]) -> tuple[float, float]:
    """Return how much of a ring before and after a place is its own, mm: half the way to the next other place, at most
    a quarter round.
    """
    size = lengths(rows)
    ends = np.append(0.0, np.cumsum(size))
    total = float(ends[-1])
    where = np.array([ends[other.row] + other.fraction * size[other.row] for other in (place, *others)])
    after, before = (where[1:] - where[0]) % total, (where[0] - where[1:]) % total
    return (min(total / 4, float(before.min(initial=total)) / 2), min(total / 4, float(after.min(initial=total)) / 2))
