"""Contour lines of the display memory as chain codes, by 8-connected vector tracing (step 203)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.primitives import Rows
from .frame import BitmapFrame, PixelCode, Plane

STEPS = np.array([(0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0), (1, 1)])
"""(row, column) step of directions 0 ... 7: 0 to the right, then counter-clockwise by 45 degrees."""


_DASH = (6, 3)
"""Pixels of a dash, and of the gap behind it."""


@dataclass(frozen=True)
class PixelChain:
    """One closed border of drawn pixels.

    Attributes:
        start: row and column of the start pixel S.
        directions: (n,) uint8, 0 ... 7 from pixel to pixel until the walk is back at S; empty for a pixel all alone.
    """

    start: tuple[int, int]
    directions: NDArray[np.uint8]

    def pixels(self) -> NDArray[np.int64]:
        """Return (n + 1, 2) rows and columns of the walk; the last is S again."""
        return np.concatenate([[self.start], self.start + np.cumsum(STEPS[self.directions], axis=0)]).astype(np.int64)

    def text(self) -> str:
        """Return the chain as one line: row, column, directions, end mark."""
        return f"{self.start[0]} {self.start[1]}: {''.join(map(str, self.directions))}."


def chain_rows(frame: BitmapFrame, chains: Sequence[PixelChain]) -> Rows:
    """Return closed lines (n, 8), mm, through the centres of some chains' pixels; a pixel alone is a line without
    length.
    """
    rows = [np.zeros((0, 8))]
    for chain in chains:
        centres = frame.to_mm(chain.pixels()[:, ::-1].astype(np.float64) + 0.5)
        own = np.zeros((max(len(chain.directions), 1), 8))
        own[:, :2], own[:, 2:4] = centres[: len(own)], centres[-len(own) :]
        rows.append(own)
    return np.concatenate(rows)


def dashed(plane: Plane, chains: Sequence[PixelChain]) -> Plane:
    """Return a plane whose contour pixels along some chains are dashes, as the text draws the contour tool's path."""
    made = plane.copy()
    for chain in chains:
        pixels = chain.pixels()
        gaps = pixels[np.arange(len(pixels)) % sum(_DASH) >= _DASH[0]]
        gaps = gaps[made[tuple(gaps.T)] == PixelCode.CONTOUR]
        made[tuple(gaps.T)] = PixelCode.EMPTY
    return made


def trace(plane: Plane) -> tuple[tuple[PixelChain, ...], Plane]:
    """Extract all contour lines and mark them.

    Args:
        plane: (rows, cols); any code but 0 is a drawn pixel.

    Returns:
        The chains in raster order of their start pixels, and a plane of 0, 1 (drawn, cut off by an 8-connected step)
        and 2 (traced). The outer border of a line runs counter-clockwise, that of a hole clockwise.

    References:
        JPH07107645B2, steps 202 and 203. H. Freeman, On the encoding of arbitrary geometric configurations, 1961.
    """
    from . import kernels

    traced = np.where(plane == PixelCode.EMPTY, PixelCode.EMPTY, PixelCode.CONTOUR).astype(np.uint8)
    drawn = int(np.count_nonzero(traced))
    starts, codes = np.empty((drawn, 4), np.int64), np.empty(9 * drawn, np.uint8)
    count = kernels.trace(traced, starts, codes)
    chains = (PixelChain((r, c), codes[first : first + length]) for r, c, first, length in starts[:count].tolist())
    return tuple(chains), traced
