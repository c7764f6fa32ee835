"""What of a way along walls the path has not gone yet: stretches that are cut as soon as all before them is clear."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...geometry.distance import DistanceField
from ...geometry.primitives import Rows, fraction_on, point_on
from ...toolpath.linking.bridge import part_of
from .cleared_discs import ClearedDiscs, Point
from .limit import EngagementLimit
from .link import PathPose
from .wall_path import WallPath

_ON = 1e-6
"""mm; nearer to a way than that is on it."""

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
        first, last = self.rows[0].tolist(), self.rows[-1].tolist()
        return (
            PathPose(first[0], first[1], _right(first, 0), self.turn),
            PathPose(last[2], last[3], _right(last, 2), self.turn),
        )


def _right(row: list[float], end: int) -> float:
    """Return the direction to the right of the way at an end of a row, radians."""
    if row[7] == 0:
        return math.atan2(row[3] - row[1], row[2] - row[0]) - math.pi / 2
    outward = math.atan2(row[end + 1] - row[5], row[end] - row[4])
    return outward if row[7] > 0 else outward + math.pi


def stretches(
    path: Rows, swept: Sequence[WallPath], discs: ClearedDiscs, limit: EngagementLimit, turn: float
) -> list[WallStretch] | None:
    """Return what of a closed way some other ways do not go along; None where that is all of it.

    Args:
        turn: radius of the arcs in which the cutter comes to a stretch and leaves, mm.
    """
    pieces = _gone_already(path, swept)
    first = next((k for k, (_, gone) in enumerate(pieces) if gone), None)
    if first is None:
        return None
    found: list[list[list[float]]] = [[]]
    for row, gone in pieces[first:] + pieces[:first]:
        if gone:
            found.append([])
        else:
            found[-1].append(row)
    return [WallStretch(rows := np.array(each), _last(rows, discs, limit), turn) for each in found if each]


def _last(rows: Rows, discs: ClearedDiscs, limit: EngagementLimit) -> int:
    """Return the last of the discs that touch rows, of those that need an arc; -1 where none does."""
    away, _ = DistanceField.of(rows).nearest(discs.table[:, :2])
    touching = away <= discs.table[:, 2] - limit.radius + _BESIDE
    cut = np.array([not disc.swept for disc in discs.each])
    numbers = np.flatnonzero(touching & cut)
    return int(numbers[-1]) if len(numbers) else -1


def _gone_already(rows: Rows, swept: Sequence[WallPath]) -> list[tuple[list[float], bool]]:
    """Return the pieces of a way along walls, and of each whether one of some other ways goes there as well."""
    found: list[tuple[list[float], bool]] = []
    for row in rows:
        shares = {0.0, 1.0}
        for wall in swept:
            for x, y in wall.rows[:, :2].tolist():
                share = fraction_on(row.tolist(), (x, y))
                if math.dist(point_on(row.tolist(), share), (x, y)) < _ON:
                    shares.add(share)
        for begin, end in pairwise(sorted(shares)):
            for part in part_of(row, begin, end):
                x, y = point_on(part.tolist(), 0.5)
                found.append((part.tolist(), any(wall.nearest((x, y))[1] < _ON for wall in swept)))
    return found
