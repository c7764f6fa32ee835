"""How far two fields of heights of the same cells are from one another, walls apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.motion import Floats
from .workpiece import Heights

TOLERANCE = 1e-4
"""mm; float32 sums of some hundred millimetres differ by less, whoever adds them."""

RIMS = 0.01
"""Share of the cells that may fall to the other side of a wall: all sides of a part may lie on centres of cells."""


@dataclass(frozen=True, slots=True)
class HeightDifference:
    """How far heights are from those of the engine of record.

    Attributes:
        largest: mm; infinite where one is no number.
        cells: how many differ by more than `TOLERANCE`.
        astray: how many differ by more than was allowed, and by more than a cell that falls to the other side of a wall
            would.
        rims: how many differ by more than was allowed, but lie between the heights beside them.
    """

    largest: float
    cells: int
    astray: int
    rims: int

    @property
    def agrees(self) -> bool:
        """Whether nothing but walls tells them apart."""
        return self.astray == 0

    def joined(self, other: HeightDifference | None) -> HeightDifference:
        """Return both, of one job after another, as one."""
        if other is None:
            return self
        return HeightDifference(
            max(self.largest, other.largest),
            self.cells + other.cells,
            self.astray + other.astray,
            self.rims + other.rims,
        )


def height_difference(record: Heights, other: Heights, allowed: float | Floats = TOLERANCE) -> HeightDifference:
    """Return how far heights are from those of the engine of record, (rows, cols) both.

    A cell whose centre is on a vertical wall falls to either side by rounding: it then has a height between the least
    and the greatest round it, two cells far, for what goes on beyond the wall may rise from cell to cell. More than a
    share `RIMS` of such cells are no walls.

    Args:
        allowed: difference that counts as none, mm; or (rows, cols) of them.
    """
    off = np.abs(np.subtract(record, other, dtype=np.float64))
    off[np.isnan(off)] = np.inf
    far = off > allowed
    low, high = lowest_nearby(record, 2), -lowest_nearby(-record, 2)
    beside = far & (other >= low - allowed) & (other <= high + allowed)
    rims = int(np.count_nonzero(beside))
    astray = int(np.count_nonzero(far & ~beside))
    most = 4 + RIMS * record.size
    return HeightDifference(
        float(off.max(initial=0.0)), int(np.count_nonzero(off > TOLERANCE)), astray + (rims if rims > most else 0), rims
    )


def lowest_nearby(heights: Heights, reach: int = 1) -> Heights:
    """Return (rows, cols) the least height of each cell and of those at most `reach` cells away."""
    import cv2

    return np.asarray(cv2.erode(heights, np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)), np.float32)
