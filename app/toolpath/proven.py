"""A coarse picture proves most of a swept area covered, so that only the rest needs exact polygons.

The centre lines of the path are drawn on a grid and the distance of every cell from them is taken. A cell is proven
covered when that distance, with everything the grid can be wrong by, is within the cutter's radius. Row 0 = min Y.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

_CELLS_A_RADIUS = 10
_LARGEST = 1600
"""Cells along the longer side, at most."""

_DOUBT = 2.0
"""Cells by which a distance may be too small: drawn cell from path, cell's centre from its corner, rounding."""

_TILE = 8
"""Cells along the side of a tile."""

_SHIFT = 4
"""Binary digits of a cell that positions keep."""


@dataclass(frozen=True)
class _Grid:
    x0: float
    y0: float
    pitch: float
    rows: int
    columns: int

    def cells(self, points: NDArray[np.float64]) -> NDArray[np.int32]:
        """Return points (n, 2), mm, as cells in fixed point."""
        place = (points - (self.x0, self.y0)) / self.pitch - 0.5
        return np.asarray(np.round(place * 2**_SHIFT), dtype=np.int32)

    def blank(self, value: int) -> NDArray[np.uint8]:
        """Return a picture of one value."""
        return np.full((self.rows, self.columns), value, np.uint8)


def uncertain(wanted: Shape, paths: Sequence[NDArray[np.float64]], radius: float) -> NDArray[np.object_]:
    """Return boxes (n,) that hold every point of a wanted area that is not proven covered.

    Args:
        wanted: polygons, mm.
        paths: points (n, 2) of each path, mm.
        radius: of the cutter, mm, > 0.
    """
    if wanted.is_empty:
        return np.zeros(0, dtype=object)
    grid = _grid(wanted, radius)
    lines = grid.blank(1)
    cv2.polylines(lines, [grid.cells(path) for path in paths], False, 0, 1, cv2.LINE_8, _SHIFT)
    distance = cv2.distanceTransform(lines, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    doubtful = ((distance + _DOUBT) * grid.pitch > radius) & (_drawn(wanted, grid) > 0)
    tiles = doubtful.reshape(grid.rows // _TILE, _TILE, grid.columns // _TILE, _TILE).any(axis=(1, 3))
    row, column = np.nonzero(tiles)
    x = grid.x0 + np.arange(tiles.shape[1] + 1) * _TILE * grid.pitch
    y = grid.y0 + np.arange(tiles.shape[0] + 1) * _TILE * grid.pitch
    return np.asarray(shapely.box(x[column], y[row], x[column + 1], y[row + 1]), dtype=object)


def _grid(wanted: Shape, radius: float) -> _Grid:
    """Return a grid over an area, with two cells round it."""
    x0, y0, x1, y1 = wanted.bounds
    pitch = max(radius / _CELLS_A_RADIUS, max(x1 - x0, y1 - y0) / _LARGEST)
    rows, columns = (_TILE * int(np.ceil((span / pitch + 4) / _TILE)) for span in (y1 - y0, x1 - x0))
    return _Grid(x0 - 2 * pitch, y0 - 2 * pitch, pitch, rows, columns)


def _drawn(wanted: Shape, grid: _Grid) -> NDArray[np.uint8]:
    """Return a picture whose cells are not 0 wherever the area is, and up to two cells round it."""
    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(shapely.get_parts(wanted))]
    picture = grid.blank(0)
    cv2.fillPoly(picture, [grid.cells(ring) for ring in rings], 1, cv2.LINE_8, _SHIFT)
    return np.asarray(cv2.dilate(picture, np.ones((3, 3), np.uint8)), dtype=np.uint8)
