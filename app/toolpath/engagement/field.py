"""The metal that the engagement of one tool is measured in: heights of square cells along its path, cut in the order of
the moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import Progress
from ...geometry.primitives import boxes
from ...model.moves import MoveKind, Moves
from ...model.stock_box import StockBox
from ..coverage.flat import move_rows
from .engagement_kernels import SHIFT, mark, sweep
from .places import Floats

_SIDE = 1 << SHIFT

_ODD = (math.sqrt(5) - 1) / 2
"""Keeps paths at round coordinates off the cells' borders, where rounding would decide."""

_FINENESS = 20.0 / (1 - _ODD / 16)
"""Cells in the radius of the cutter."""

_COARSEST = 1000.0
"""Cells in the radius of the largest cutter, at most."""

_MOST_TILES = 1 << 14
"""Of 4,096 cells, 4 bytes each: 256 MiB."""

_MOST_INDEXED = 1 << 24
"""Tiles in the rectangle round all moves."""

_INSIDE = math.sqrt(0.5) + 1e-6
"""Cells by which the rim that is looked at lies inside the true one: what the cutter has gone over counts as cut up to
there.
"""

_SLICE = 1 << 13
"""Places between two looks at whether to stop."""


@dataclass(frozen=True, eq=False)
class EngagementField:
    """The metal along the path of one tool; cutting changes it.

    Attributes:
        radius: of the tool, mm.
        frame: x and y of the corner of its first cell, side of a cell, mm.
        heights: of the cells, tile after tile, mm; -inf where there is no metal.
        index: (rows, columns) slot of each tile, -1 where the tool does not come.
    """

    radius: float
    frame: tuple[float, float, float]
    heights: NDArray[np.float32]
    index: NDArray[np.int32]

    @staticmethod
    def along(
        moves: Moves, radii: tuple[float, float], stock: StockBox, places: Callable[[], Iterable[Floats]]
    ) -> EngagementField:
        """Return the uncut field along the path of a tool.

        Args:
            moves: all of them; every cutter may be led anywhere along them.
            radii: of the tool, and of the largest tool, mm.
            stock: where there is metal.
            places: gives those of the tool's path, (n, 6) each.
        """
        radius, largest = radii
        pitch = max(radius / _FINENESS, largest / _COARSEST)
        reach = boxes(move_rows(moves)[moves.kind != MoveKind.RAPID])
        low, high = reach[:, :2].min(axis=0) - largest, reach[:, 2:].max(axis=0) + largest
        while True:
            tile = pitch * _SIDE
            x, y = ((np.floor((low - 2 * pitch) / tile) - _ODD / _SIDE) * tile).tolist()
            cols, rows = (np.ceil((high + 2 * pitch - (x, y)) / tile) + 1).tolist()
            count = 0
            if rows * cols <= _MOST_INDEXED:
                index = np.full((int(rows), int(cols)), -1, np.int32)
                for each in places():
                    mark(index, (x, y, pitch), each, radius)
                count = int((index == 0).sum())
                if count <= _MOST_TILES:
                    index[index == 0] = np.arange(count)
                    return EngagementField(radius, (x, y, pitch), _metal(index, (x, y, pitch), stock), index)
            pitch *= max(math.sqrt(2), math.sqrt(count / _MOST_TILES))

    @property
    def pitch(self) -> float:
        """Side of a cell, mm."""
        return self.frame[2]

    def cut(self, rows: Floats, radius: float, progress: Progress) -> None:
        """Cut along a path (n, 6) of any tool."""
        self._led(rows, (radius, radius, 0.0), np.zeros((0, 2)), progress)

    def engaged(self, rows: Floats, progress: Progress) -> Floats:
        """Return the engaged share (n,) of the tool's diameter at places (n, 6) of its path, which is cut."""
        inner = max(self.radius - _INSIDE * self.pitch, 0.25 * self.radius)
        # no cell under the front half is cut from farther behind
        lag = math.sqrt((2 * self.radius - inner) ** 2 - inner * inner)
        count = max(32, math.ceil(2 * math.pi * self.radius / self.pitch))
        angle = (np.arange(count) + 0.5) / count * np.pi - np.pi / 2
        return self._led(rows, (self.radius, inner, lag), np.column_stack([np.cos(angle), np.sin(angle)]), progress)

    def _led(self, rows: Floats, cutter: tuple[float, float, float], rim: Floats, progress: Progress) -> Floats:
        share, done = np.zeros(len(rows)), 0
        for first in range(0, len(rows), _SLICE):
            progress.step(first / len(rows), "Measuring engagement")
            span = (first, min(first + _SLICE, len(rows)), done)
            done = sweep(self.heights, self.index, self.frame, rows, rim, cutter, span, share)
        return share


def _metal(index: NDArray[np.int32], frame: tuple[float, float, float], stock: StockBox) -> NDArray[np.float32]:
    """Return the heights of the stock in all tiles of an index."""
    (x, y, pitch), (rows, cols) = frame, np.nonzero(index >= 0)
    inner = (np.arange(_SIDE) + 0.5) * pitch
    xs, ys = x + (cols * _SIDE * pitch)[:, None] + inner, y + (rows * _SIDE * pitch)[:, None] + inner
    across, along = (xs >= stock.x0) & (xs <= stock.x1), (ys >= stock.y0) & (ys <= stock.y1)
    heights = np.full((len(rows), _SIDE, _SIDE), -np.inf, np.float32)
    heights[along[:, :, None] & across[:, None, :]] = stock.z1
    return heights.ravel()
