"""What of a way along walls the path has not gone yet: stretches that are cut as soon as all before them is clear."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...geometry.distance import DistanceField
from ...geometry.primitives import Rows, fraction_on, lengths
from ...toolpath.leads.contour_path import headings_at
from ...toolpath.linking.bridge import part_of
from .cleared_discs import ClearedDiscs, Point
from .limit import EngagementLimit
from .link import PathPose
from .wide_place import WidePlace

_ON = 1e-6
"""mm; nearer to a way than that is on it."""

_NEAR = 1e-3
"""mm from a way that is looked at for rows on it."""

_SHORT = 1e-7
"""mm; a shorter piece is none."""

_BESIDE = 1e-3
"""mm by which a disc may miss a stretch that it touches."""


@dataclass(frozen=True, eq=False)
class WallStretch:
    """A stretch of a way along a wall.

    Attributes:
        rows: (n, 8) that touch one another.
        after: number of the last disc that touches it, and must be clear before; -1 where none does.
        turn: radius of the arcs in which the cutter comes to it and leaves, mm.
    """

    rows: Rows
    after: int
    turn: float

    @property
    def place(self) -> Point:
        """Where it begins, mm."""
        x, y = self.rows[0, :2].tolist()
        return x, y

    @property
    def poses(self) -> tuple[PathPose, PathPose]:
        """The poses at its beginning and at its end."""
        (x0, y0), (x1, y1) = self.rows[0, :2].tolist(), self.rows[-1, 2:4].tolist()
        return (
            PathPose(x0, y0, _right(self.rows[0], 0.0), self.turn),
            PathPose(x1, y1, _right(self.rows[-1], 1.0), self.turn),
        )


def _right(row: Rows, fraction: float) -> float:
    """Return the direction to the right of the way at a fraction of a row (8,), radians."""
    x, y = headings_at(row[None], np.array([fraction]))[0].tolist()
    return math.atan2(-x, y)


def stretches(path: Rows, wide: WidePlace, discs: ClearedDiscs) -> list[WallStretch] | None:
    """Return what of a closed way is not clear after a wide place is; None where that is all of it."""
    pieces = _pieces(path, wide)
    first = next((k for k, (_, gone) in enumerate(pieces) if gone), None)
    if first is None:
        return None
    found: list[list[list[float]]] = [[]]
    for row, gone in pieces[first:] + pieces[:first]:
        if gone:
            found.append([])
        else:
            found[-1].append(row)
    limit, turn = wide.front.limit, wide.pose.turn
    return [WallStretch(rows := np.array(each), _last(rows, discs, limit), turn) for each in found if each]


def _last(rows: Rows, discs: ClearedDiscs, limit: EngagementLimit) -> int:
    """Return the last of the discs that touch rows, of those that need an arc; -1 where none does."""
    away, _ = DistanceField.of(rows).nearest(discs.table[:, :2])
    touching = away <= discs.table[:, 2] - limit.radius + _BESIDE
    cut = np.array([not disc.swept for disc in discs.each])
    numbers = np.flatnonzero(touching & cut)
    return int(numbers[-1]) if len(numbers) else -1


def _pieces(path: Rows, wide: WidePlace) -> list[tuple[list[float], bool]]:
    """Return the pieces of a way along walls, and of each whether it is clear."""
    on = _ends_on(path, wide)
    found: list[tuple[list[float], bool]] = []
    for row, places in zip(path, on, strict=True):
        shares = {0.0, 1.0, *(fraction_on(row.tolist(), place) for place in places)}
        for begin, end in pairwise(sorted(shares)):
            parts = part_of(row, begin, end)
            found += [(part.tolist(), wide.front.is_air(part)) for part in parts if lengths(part[None])[0] > _SHORT]
    return found


def _ends_on(path: Rows, wide: WidePlace) -> list[list[Point]]:
    """Return for each row of a way along walls the places on it at which rows of a wide place begin."""
    starts = wide.rows[:, :2]
    away, row = DistanceField.of(path).nearest(starts, _NEAR)
    found: list[list[Point]] = [[] for _ in path]
    for k in np.flatnonzero(away < _ON):
        x, y = starts[k].tolist()
        found[row[k]].append((x, y))
    return found
