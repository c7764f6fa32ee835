"""Shrink an area on the display memory as the text does (steps 301-307): peel by peel, then the circle's correction."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..core.pool import pool
from .border import Border, borders_of
from .trace import PixelChain
from .walls import Mask

Floats = NDArray[np.float32]

_PART = 1 << 20
"""Pixels that are worth a thread's start."""


def peels(area: Mask, count: int, *, keep_ends: bool = False) -> Iterator[tuple[Mask, tuple[Border, ...]]]:
    """Steps 301-305: take the border pixels off an area, `count` times at most; yield what is left, and what was taken.

    What is left is exactly what lies farther than the number of peels from the outside in city blocks (steps along rows
    and columns), which is why the text corrects it by circles. It ends where a peel would take nothing more.

    Args:
        area: (rows, cols).
        count: peels, >= 0.
        keep_ends: leave border pixels where the chain turns right back, so that lines of one pixel do not grow shorter:
            the exception of step 304, which the circle's correction undoes.
    """
    left = area
    for _ in range(count):
        borders = borders_of(left)
        if not borders:
            return
        before, left = left, left.copy()
        for border in borders:
            chain = border.chain
            pixels = chain.pixels()[:-1][~_turns_back(chain)] if keep_ends else chain.pixels()
            left[tuple(pixels.T)] = False
        if np.array_equal(left, before):
            return
        yield left, borders


def _turns_back(chain: PixelChain) -> NDArray[np.bool_]:
    """Return for each pixel of a chain whether it is left the way it was entered."""
    into = np.roll(chain.directions, 1)
    turns: NDArray[np.bool_] = (into.astype(np.int64) + 4) % 8 == chain.directions
    return turns


def frame_pixels(area: Mask) -> Mask:
    """Return the border pixels of an area: those with a pixel of the outside above, below, left or right (step 303)."""
    frame: Mask = area & ~inner_pixels(area)
    return frame


def inner_pixels(area: Mask) -> Mask:
    """Return the pixels of an area that are no border pixels."""
    from . import row_kernels

    plane = np.ascontiguousarray(area).view(np.uint8)
    found = np.empty_like(plane)
    parts = pairwise(np.linspace(0, len(plane), 1 + plane.size // _PART + 1).astype(int).tolist())
    list(pool().map(lambda part: row_kernels.inner(plane, found, *part), parts))
    return found.view(np.bool_)


def distance_px(area: Mask, border: Mask | None = None) -> Floats:
    """Return the exact Euclidean distance of every pixel of an area from the nearest pixel outside, or of its border.

    Between centres, in pixels; 0 outside. What lies beyond the picture is outside.

    Args:
        border: pixels of the area that count as outside.
    """
    import cv2

    inner = area if border is None else area & ~border
    padded = np.pad(inner, 1).astype(np.uint8)
    distance = cv2.distanceTransform(padded, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.ascontiguousarray(distance[1:-1, 1:-1], np.float32)


def correct_by_circles(left: Mask, area: Mask, radius: float) -> Mask:
    """Steps 306 and 307: take away what the tool's circle sweeps while its centre follows the area's frame.

    Args:
        left: what the peels have left of the area.
        area: before the first peel.
        radius: of the circle, px, >= 0.

    Returns:
        What lies farther than `radius` from every frame pixel, whatever was peeled.
    """
    corrected: Mask = left & (np.rint(distance_px(area, frame_pixels(area)).astype(np.float64) ** 2) > radius * radius)
    return corrected
