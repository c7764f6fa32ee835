"""The engaged angle of a cutter along a path, looked at in many places: plain distances from all that was cut before.

Shares nothing with the program: no discs, no bounds, no kernels. A point of the rim is metal if no earlier part of the
path has come within the cutter's radius of it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HAIR = 1e-6
"""mm; thinner metal than this is none."""


BLOCK = 100
"""Rows that are asked about together."""


def reached(x: Floats, y: Floats, rows: Floats, reach: float) -> NDArray[np.bool_]:
    """Return which points (n,) are no farther than reach from lines and arcs (m, 8), whose columns are named here."""
    x, y, square = x[:, None], y[:, None], reach * reach
    x0, y0, x1, y1, cx, cy, r, turn = rows[rows[:, 7] == 0].T
    wide, high = x1 - x0, y1 - y0
    share = np.clip(((x - x0) * wide + (y - y0) * high) / np.maximum(wide * wide + high * high, 1e-300), 0, 1)
    near = ((x - x0 - share * wide) ** 2 + (y - y0 - share * high) ** 2 <= square).any(axis=1)
    x0, y0, x1, y1, cx, cy, r, turn = rows[rows[:, 7] != 0].T
    near |= ((x - x0) ** 2 + (y - y0) ** 2 <= square).any(axis=1)
    near |= ((x - x1) ** 2 + (y - y1) ** 2 <= square).any(axis=1)
    away = (x - cx) ** 2 + (y - cy) ** 2
    point, arc = np.nonzero((away <= (r + reach) ** 2) & (away >= np.maximum(r - reach, 0.0) ** 2) & ~near[:, None])
    first = np.arctan2(y0 - cy, x0 - cx)
    whole = (np.arctan2(y1 - cy, x1 - cx) - first) * turn % math.tau
    angle = (np.arctan2(y[point, 0] - cy[arc], x[point, 0] - cx[arc]) - first[arc]) * turn[arc] % math.tau
    near[point[angle <= np.where(whole > 1e-9, whole, math.tau)[arc]]] = True
    return np.asarray(near)


def sweep(row: Floats) -> float:
    """Return the sweep of an arc, radians, > 0."""
    a, b = (math.atan2(row[k + 1] - row[5], row[k] - row[4]) for k in (0, 2))
    turn: float = ((b - a) * row[7]) % math.tau
    return turn if turn > 1e-9 else math.tau


def at(row: Floats, share: Floats) -> tuple[Floats, Floats]:
    """Return places (n, 2) of a row and the directions of travel there."""
    if row[7] == 0:
        along = row[2:4] - row[:2]
        return row[:2] + share[:, None] * along, np.full(len(share), math.atan2(along[1], along[0]))
    angle = math.atan2(row[1] - row[5], row[0] - row[4]) + row[7] * sweep(row) * share
    return row[4:6] + row[6] * np.column_stack([np.cos(angle), np.sin(angle)]), angle + row[7] * math.pi / 2


def size(row: Floats) -> float:
    """Return the length of a row, mm."""
    return math.dist(row[:2], row[2:4]) if row[7] == 0 else float(row[6]) * sweep(row)


HALVINGS = 7
"""By which each end of what is in metal is narrowed down."""


def engaged(rows: Floats, radius: float, *, step: float = 0.4, rim: int = 90) -> list[Floats]:
    """Return, row by row, the engaged angle at places not farther apart than `step` mm, radians, within pi / rim / 100
    for each end of what is in metal.

    Args:
        rows: the whole path in the order of cutting; at its beginning the cutter stands in a hole of its own size.
        rim: points of the front half of the rim that are looked at first.
    """
    boxes = np.array([[r[:4:2].min(), r[1:4:2].min(), r[:4:2].max(), r[1:4:2].max()] for r in rows])
    arcs = rows[:, 7] != 0
    boxes[arcs, :2] = rows[arcs, 4:6] - rows[arcs, 6:7]
    boxes[arcs, 2:] = rows[arcs, 4:6] + rows[arcs, 6:7]
    found = []
    for k, row in enumerate(rows):
        count = max(1, math.ceil(size(row) / step))
        places, ahead = at(row, (np.arange(count) + 0.5) / count)
        low, high = places.min(axis=0) - 2 * radius, places.max(axis=0) + 2 * radius
        near = np.flatnonzero((boxes[:k, :2] <= high).all(axis=1) & (boxes[:k, 2:] >= low).all(axis=1))
        before = np.concatenate([rows[near[::-1]], [[*rows[0, :2], *rows[0, :2], 0, 0, 0, 0]]])
        found.append(_angles(before, places, ahead, (radius, rim)))
    return found


def _angles(before: Floats, places: Floats, ahead: Floats, cutter: tuple[float, int]) -> Floats:
    radius, rim = cutter
    each = math.pi / rim

    def metal(place: NDArray[np.int64], angle: Floats) -> NDArray[np.bool_]:
        x, y = (places[place] + radius * np.column_stack([np.cos(angle), np.sin(angle)])).T
        left = np.arange(len(x))
        for first in range(0, len(before), BLOCK):
            stays = ~reached(x, y, before[first : first + BLOCK], radius - HAIR)
            x, y, left = x[stays], y[stays], left[stays]
        standing = np.zeros(len(place), np.bool_)
        standing[left] = True
        return standing

    front = (np.arange(rim) + 0.5) * each - math.pi / 2
    number = np.repeat(np.arange(len(places)), rim)
    seen = metal(number, (ahead[:, None] + front).ravel()).reshape(len(places), rim)
    total = seen.sum(axis=1) * each
    place, k = np.nonzero(seen[:, 1:] != seen[:, :-1])
    into, low, high = seen[place, k], np.zeros(len(place)), np.ones(len(place))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        same = metal(place, ahead[place] + front[k] + middle * each) == into
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    np.add.at(total, place, np.where(into, 1, -1) * ((low + high) / 2 - 0.5) * each)
    return np.asarray(total)
