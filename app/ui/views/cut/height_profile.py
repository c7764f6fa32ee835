"""Heights along a line over the cut, cell by cell. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .camera import SightRay
from .cell_picking import crossings
from .cut_picture import CutPicture, Floats

Place = tuple[float, float]


@dataclass(frozen=True, eq=False)
class HeightProfile:
    """n pieces of a line, each within one cell.

    Attributes:
        borders: (n + 1,) distance from the line's beginning, mm, not decreasing.
        heights: (n,) mm.
    """

    borders: Floats
    heights: Floats


def height_profile(picture: CutPicture, start: Place, end: Place) -> HeightProfile:
    """Return the heights along a line from one place over the stock to another; beside the stock they are the floor.

    Args:
        picture: the heights.
        start, end: mm, not alike.
    """
    origin, way = np.array([*start, 0.0]), np.array([end[0] - start[0], end[1] - start[1], 0.0])
    length = float(np.hypot(way[0], way[1]))
    ray = SightRay(origin, way / length)
    borders = crossings(picture, ray, 0.0, length)
    middles = origin + (borders[:-1] + borders[1:])[:, None] / 2 * ray.direction
    column, row = (np.floor((middles[:, axis] - picture.low[axis]) / picture.pitch).astype(np.int64) for axis in (0, 1))
    inside = (column >= 0) & (column < picture.columns) & (row >= 0) & (row < picture.rows)
    heights = np.full(len(middles), picture.floor)
    heights[inside] = picture.heights[row[inside], column[inside]]
    return HeightProfile(borders, heights)
