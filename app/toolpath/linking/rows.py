"""Pieces of closed paths: places on them, and the rows from one place to another."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...geometry.primitives import Rows, lengths, point_on
from ..build import split_row

_SAME = 1e-9  # fraction of a row


@dataclass(frozen=True)
class RingPlace:
    """A point of a ring: fraction in [0, 1] of one of its rows."""

    ring: int
    row: int
    fraction: float


def point_of(rows: Rows, place: RingPlace) -> Rows:
    """Return the point (2,) at a place of a ring's rows."""
    return np.array(point_on(rows[place.row].tolist(), place.fraction))


def position(place: RingPlace, count: int, forward: bool) -> float:
    """Return where a place is along a ring of `count` rows, in rows from its beginning."""
    at = place.row + place.fraction
    return at if forward else count - at


def point_at(rows: Rows, at: float) -> Rows:
    """Return the point (2,) at a position along a closed ring, in rows from its beginning or past it."""
    row = math.floor(at)
    return point_of(rows, RingPlace(0, row % len(rows), at - row))


def along(rows: Rows, start: float, distance: float) -> float:
    """Return the position so many mm on from another one along a closed ring, or back if less than 0; at most once
    round.
    """
    ends = np.append(0.0, np.cumsum(lengths(rows)))
    row = math.floor(start)
    lap = row // len(rows)
    k = row - lap * len(rows)
    total = float(ends[-1])
    where = float(ends[k] + (start - row) * (ends[k + 1] - ends[k])) + distance
    turns = math.floor(where / total)
    rest = where - turns * total
    at = min(int(np.searchsorted(ends, rest, "right")) - 1, len(rows) - 1)
    return (lap + turns) * len(rows) + at + (rest - float(ends[at])) / float(ends[at + 1] - ends[at])


def span(rows: Rows, start: float, end: float) -> Rows:
    """Return a closed ring's rows from one position to another, going on past its beginning."""
    first, last = math.floor(start), math.ceil(end) - 1
    if last < first:
        return rows[:0]
    if last == first:
        return part_of(rows[first % len(rows)], start - first, end - first)
    whole = rows[np.arange(first, last + 1) % len(rows)]
    if start == first and end == last + 1:
        return whole
    head, tail = part_of(whole[0], start - first, 1.0), part_of(whole[-1], 0.0, end - last)
    return np.concatenate([head, whole[1:-1], tail])


def part_of(row: Rows, start: float, end: float) -> Rows:
    """Return a row from one fraction to another as (1, 8), or nothing where they are the same."""
    if end - start < _SAME:
        return row[None][:0]
    if end < 1:
        row = split_row(row, end)[0]
    if start > 0:
        row = split_row(row, start / end)[1]
    return row[None]


def straight(a: Rows, b: Rows) -> Rows:
    """Return the line from one point (2,) to another as (1, 8)."""
    return np.array([[*a, *b, 0.0, 0.0, 0.0, 0.0]])


def joined(rows: Rows) -> Rows:
    """Make each row begin exactly where the one before ends (bridges meet rings within rounding)."""
    rows = rows.copy()
    rows[1:, :2] = rows[:-1, 2:4]
    return rows
