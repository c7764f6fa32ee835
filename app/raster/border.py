"""Borders of filled areas as chain codes: of one area, or of nested areas of many levels in one pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .trace import PixelChain
from .walls import Mask

Index = NDArray[np.uint16]
"""(rows, cols): the level that each pixel belongs to; 0 = none. The area of level k is all pixels of k and above."""


@dataclass(frozen=True)
class Border:
    """A closed border of the area of one level.

    Attributes:
        level: 1, 2, …
        chain: through the area's own pixels, the area on the left: outer borders run counter-clockwise as seen on the
            screen, those of holes clockwise. Two pixels are neighbours across corners too.
    """

    level: int
    chain: PixelChain


def borders_of(index: Index | Mask) -> tuple[Border, ...]:
    """Return every border of every level's area, in raster order of their start pixels.

    Args:
        index: levels, which rise by at most 8 from a pixel to its neighbour in the row; or one area.

    References:
        Each border is found once, at the first of its pixels that have nothing to their left: S. Suzuki and K. Abe,
        Topological structural analysis of digitized binary images by border following, 1985.
    """
    from . import border_kernels

    plane = np.ascontiguousarray(index, np.uint16)
    starts, codes = np.empty((256, 5), np.int64), np.empty(plane.size // 16 + 4096, np.uint8)
    count, used = border_kernels.borders(plane, np.zeros(plane.shape, np.uint8), starts, codes)
    if count > len(starts) or used > len(codes):
        starts, codes = np.empty((count, 5), np.int64), np.empty(used, np.uint8)
        border_kernels.borders(plane, np.zeros(plane.shape, np.uint8), starts, codes)
    return tuple(
        Border(k, PixelChain((r, c), codes[first : first + n])) for r, c, k, first, n in starts[:count].tolist()
    )


def mark(plane: NDArray[np.uint8], borders: tuple[Border, ...], code: int) -> None:
    """Write a code into all pixels of some borders."""
    for border in borders:
        plane[tuple(border.chain.pixels().T)] = code
