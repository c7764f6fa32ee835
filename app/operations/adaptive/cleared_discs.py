"""Room for a cutter, and the discs that its path has cleared so far."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...geometry.distance import DistanceField
from ...toolpath.linking.bridge import foot

Floats = NDArray[np.float64]
Point = tuple[float, float]

_EXACT = 1e-9
"""mm; rounding of distances."""
_STEPS = 40
"""Halvings of the way on which the same wall stays the nearest, at most."""


@dataclass(frozen=True, eq=False)
class WallClearance:
    """How far from the walls places are.

    Attributes:
        distances: from the walls.
        leave: stock to leave on them, mm.
        needed: the least reach of a place that a path goes round, mm.
    """

    distances: DistanceField
    leave: float
    needed: float

    def reach(self, points: Floats) -> Floats:
        """Return (n,) how far points (n, 2) are from what stays on the walls, mm; negative outside of the area."""
        far = self.distances.nearest(points)[0] - self.leave
        return np.where(self.distances.inside(points), far, -1.0)

    def at(self, place: Point) -> float:
        """Return how far an inner place is from what stays on the walls, mm."""
        return float(self.distances.nearest(np.array([place]))[0][0]) - self.leave

    def to_axis(self, place: Point, most: float = math.inf) -> tuple[Point, float]:
        """Return the centre, and the reach there, of the largest disc that touches the wall where that about an inner
        place does.

        Args:
            most: mm that the centre is moved at most.
        """
        at = np.array([place])
        far, row = self.distances.nearest(at)
        wall = foot(self.distances.rows[row], at)[0]
        if far[0] <= 0:
            return place, float(far[0]) - self.leave
        ahead = (at[0] - wall) / far[0]
        limits = np.array([most, 2 * float(np.ptp(self.distances.boxes))])
        low, high = 0.0, float(limits.min())
        for _ in range(_STEPS):
            middle = (low + high) / 2
            if self.distances.nearest(at + middle * ahead)[0][0] >= far[0] + middle - _EXACT:
                low = middle
            else:
                high = middle
            if high - low < 1e-7:
                break
        x, y = (at[0] + low * ahead).tolist()
        return (x, y), self.at((x, y))


@dataclass(frozen=True)
class ClearedDisc:
    """A disc that the path clears, and the one that was clear before and pays for it.

    Attributes:
        x, y, reach: mm.
        payer: number of that disc; -1: the one that the first spiral clears.
        swept: whether it is clear anyway, and needs no arc.
    """

    x: float
    y: float
    reach: float
    payer: int
    swept: bool = False

    @property
    def centre(self) -> Point:
        """Its centre, mm."""
        return self.x, self.y


@dataclass
class ClearedDiscs:
    """Discs that are clear, in the order of cutting."""

    each: list[ClearedDisc] = field(default_factory=list)
    _table: Floats = field(default_factory=lambda: np.empty((64, 3)))

    def __len__(self) -> int:
        return len(self.each)

    def add(self, disc: ClearedDisc) -> int:
        """Take a disc as clear; return its number."""
        if len(self.each) == len(self._table):
            self._table = np.concatenate([self._table, np.empty_like(self._table)])
        self._table[len(self.each)] = disc.x, disc.y, disc.reach
        self.each.append(disc)
        return len(self.each) - 1

    @property
    def table(self) -> Floats:
        """(n, 3) centres and reaches, mm."""
        return self._table[: len(self.each)]

    def depth_in(self, place: Point) -> Floats:
        """Return (n,) how deep a place lies in each disc, mm."""
        table = self.table
        return np.asarray(table[:, 2] - np.hypot(table[:, 0] - place[0], table[:, 1] - place[1]))
