"""The field of heights that is cut: a grid of square cells, and the metal's top over each of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.memory import MemoryRemedy, ask, fewer
from ...model.motion import Floats
from ...model.stock_box import StockBox

Heights = NDArray[np.float32]

MOST_CELLS = 30_000
"""Along a side: where an index of a cell still fits into 32 bits."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Square cells.

    Attributes:
        x0, y0: lower left corner of the grid (not the centre of a cell), mm.
        pitch: side of a cell, mm, > 0.
        rows, cols: cells along Y and X; row 0 is the lowest Y.
    """

    x0: float
    y0: float
    pitch: float
    rows: int
    cols: int

    def __post_init__(self) -> None:
        if not (math.isfinite(self.x0) and math.isfinite(self.y0) and 0 < self.pitch < math.inf):
            raise ParameterError(
                f"A grid at {self.x0:g}, {self.y0:g} with cells of {self.pitch:g} mm is none; cells must be wider than "
                "0."
            )
        if not (1 <= self.rows <= MOST_CELLS and 1 <= self.cols <= MOST_CELLS):
            raise ParameterError(
                f"A grid of {self.cols} x {self.rows} cells is out of range; use 1 to {MOST_CELLS} along each side."
            )

    @staticmethod
    def over(box: tuple[float, float, float, float], cells: int) -> Grid:
        """Return the grid over a rectangle with `cells` along its longer side; along the shorter one as many as cover
        it.

        Args:
            box: x0, y0, x1, y1, mm.
            cells: >= 1.

        Raises:
            ParameterError: the rectangle is empty, or there are too many cells.
        """
        x0, y0, x1, y1 = box
        if not (x1 > x0 and y1 > y0):
            raise ParameterError(
                f"The rectangle from {x0:g}, {y0:g} to {x1:g}, {y1:g} mm is empty; "
                "its second corner must lie right of and above the first."
            )
        if not 1 <= cells <= MOST_CELLS:
            raise ParameterError(f"A grid of {cells} cells along a side is out of range; use 1 to {MOST_CELLS}.")
        pitch = max(x1 - x0, y1 - y0) / cells
        cols, rows = (max(1, math.ceil(side / pitch - 1e-6)) for side in (x1 - x0, y1 - y0))
        return Grid(x0, y0, pitch, rows, cols)

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1, mm."""
        return self.x0, self.y0, self.x0 + self.cols * self.pitch, self.y0 + self.rows * self.pitch

    def xs(self) -> NDArray[np.float64]:
        """Return (cols,) X of the cells' centres, mm."""
        return np.asarray(self.x0 + (np.arange(self.cols) + 0.5) * self.pitch)

    def ys(self) -> NDArray[np.float64]:
        """Return (rows,) Y of the cells' centres, mm."""
        return np.asarray(self.y0 + (np.arange(self.rows) + 0.5) * self.pitch)

    def place(self, cell: int) -> tuple[float, float]:
        """Return the centre of a cell, row * cols + column, mm."""
        row, col = divmod(cell, self.cols)
        return self.x0 + (col + 0.5) * self.pitch, self.y0 + (row + 0.5) * self.pitch


@dataclass(frozen=True, eq=False)
class Workpiece:
    """The metal over a grid.

    Attributes:
        grid: where.
        heights: (rows, cols) top of the metal at the cells' centres, mm; `floor` where there is none.
        floor: underside, mm: nothing is lower.
        hidden: cells that a vertical line through their centre meets the solid in more than once; only its top is kept.
    """

    grid: Grid
    heights: Heights
    floor: float
    hidden: int = 0

    def __post_init__(self) -> None:
        if self.heights.shape != (self.grid.rows, self.grid.cols) or self.heights.dtype != np.float32:
            raise ValueError("heights do not fit the grid")
        self.heights.setflags(write=False)


class StockShape(Protocol):
    """Metal that can be laid over any grid: all of it, or a window at a finer pitch."""

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1 of all of it, mm."""

    def over(self, grid: Grid) -> Workpiece:
        """Return what of it lies over a grid."""


@dataclass(frozen=True, slots=True)
class BoxStock:
    """A box of metal."""

    solid: StockBox

    def __post_init__(self) -> None:
        if not all(size > 0 for size in self.solid.size):
            raise ParameterError(
                f"A stock of {' x '.join(f'{size:g}' for size in self.solid.size)} mm is none; "
                "each side must be longer than 0."
            )

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1, mm."""
        return self.solid.x0, self.solid.y0, self.solid.x1, self.solid.y1

    def over(self, grid: Grid) -> Workpiece:
        """Return the box over a grid; cells whose centre is beside it have no metal."""
        ensure_memory(grid, 4)
        heights = np.full((grid.rows, grid.cols), self.solid.z1, np.float32)
        xs, ys = grid.xs(), grid.ys()
        slack = 1e-9 * grid.pitch
        heights[:, (xs < self.solid.x0 - slack) | (xs > self.solid.x1 + slack)] = self.solid.z0
        heights[(ys < self.solid.y0 - slack) | (ys > self.solid.y1 + slack)] = self.solid.z0
        return Workpiece(grid, heights, self.solid.z0)


@dataclass(frozen=True, eq=False)
class HeightStock:
    """What an earlier set-up has left. Over another grid each cell takes the height of the cell that its centre lies
    in.
    """

    workpiece: Workpiece

    @property
    def box(self) -> tuple[float, float, float, float]:
        """x0, y0, x1, y1, mm."""
        return self.workpiece.grid.box

    def over(self, grid: Grid) -> Workpiece:
        """Return the metal over a grid; there is none beside the old one."""
        old = self.workpiece.grid
        if grid == old:
            return self.workpiece
        ensure_memory(grid, 4)
        cols = np.floor((grid.xs() - old.x0) / old.pitch).astype(np.int64)
        rows = np.floor((grid.ys() - old.y0) / old.pitch).astype(np.int64)
        heights = self.workpiece.heights[np.clip(rows, 0, old.rows - 1)[:, None], np.clip(cols, 0, old.cols - 1)]
        heights[(rows < 0) | (rows >= old.rows)] = self.workpiece.floor
        heights[:, (cols < 0) | (cols >= old.cols)] = self.workpiece.floor
        return Workpiece(grid, heights, self.workpiece.floor)


def ensure_memory(grid: Grid, bytes_a_cell: int) -> None:
    """Ask for the memory of a field before it is taken.

    Raises:
        MemoryShortError: there is not as much.
    """
    needed, longer = grid.rows * grid.cols * bytes_a_cell, max(grid.rows, grid.cols)
    fits = fewer(longer, needed, 2)
    ask(
        needed,
        f"A grid of {grid.cols} x {grid.rows} cells",
        MemoryRemedy(f"use at most {fits} cells along its longer side", "grid", fits),
    )


# How far two fields of heights of the same cells are from one another, walls apart.


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
