"""Shrink an area on the display memory as the text does (steps 301-307): peel by peel, then the circle's correction."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..core.pool import pool
from .border import Border, borders_of
from .trace import STEPS
from .walls import Mask

Floats = NDArray[np.float32]

_SAME_STRAND = 4
"""Steps along a border: pixels so near to one another along it are the same strand, however it bends."""
_PART = 1 << 20
"""Pixels that are worth a thread's start."""


def peels(area: Mask, count: int, *, keep_narrow: bool = False) -> Iterator[tuple[Mask, tuple[Border, ...]]]:
    """Steps 301-305: take the border pixels off an area, `count` times at most; yield what is left, and what was taken.

    What is left is exactly what lies farther than the number of peels from the outside in city blocks (steps along rows
    and columns), which is why the text corrects it by circles. It ends where a peel would take nothing more.

    Args:
        area: (rows, cols).
        count: peels, >= 0.
        keep_narrow: leave border pixels where another strand of the border is nearer than two pixels, so that an area
            does not fall apart: the exception of step 304, which the circle's correction undoes.
    """
    left = area
    for _ in range(count):
        borders = borders_of(left)
        if not borders:
            return
        before, left = left, left.copy()
        for border in borders:
            chain = border.chain
            left[tuple(chain.pixels().T)] = False
        if keep_narrow:
            narrow = narrow_pixels(borders, before.shape)
            left[narrow] = before[narrow]
        if np.array_equal(left, before):
            return
        yield left, borders


def narrow_pixels(borders: Sequence[Border], shape: tuple[int, ...]) -> Mask:
    """Return the border pixels to which another strand of the border is nearer than two pixels: the same pixel again,
    or one of the eight about it, of another border or far along the same one.
    """
    strand, place = np.zeros(shape, np.int32), np.zeros(shape, np.int64)
    found = np.zeros(shape, np.bool_)
    chains = [border.chain.pixels()[:-1] for border in borders if len(border.chain.directions)]
    for number, pixels in enumerate(chains, 1):
        for k, (row, col) in enumerate(pixels.tolist()):
            found[row, col] |= strand[row, col] > 0  # passed before
            strand[row, col], place[row, col] = number, k
    for border in borders:
        chain = border.chain
        if len(chain.directions):  # the end of a line of one pixel, which is left the way it was entered
            back = (np.roll(chain.directions, 1).astype(np.int64) + 4) % 8 == chain.directions
            found[tuple(chain.pixels()[:-1][back].T)] = True
    for number, pixels in enumerate(chains, 1):
        for step in STEPS:
            near = pixels + step
            inside = np.all((near >= 0) & (near < shape), axis=1)
            rows, cols = near[inside].T
            apart = np.abs(place[rows, cols] - place[tuple(pixels[inside].T)])
            apart = np.minimum(apart, len(pixels) - apart)
            other = (strand[rows, cols] > 0) & ((strand[rows, cols] != number) | (apart > _SAME_STRAND))
            found[tuple(pixels[inside][other].T)] = True
    return found


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
