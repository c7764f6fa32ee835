"""How thick ink is, pixel by pixel, and how thick the lines of a figure are for most of their length."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .walls import Mask

Floats = NDArray[np.float32]


def thickness_px(ink: Mask) -> Floats:
    """Return how thick ink is at each of its pixels, px; 0 on paper.

    It is the shortest way through the ink along rows, columns or diagonals, from the pixel or one of its neighbours: of
    a stair one step is thick and the next is not. A line of n pixels has n, and at most half of it more where it runs
    aslant; where lines cross, the corners between them keep the diagonals short.
    """
    import cv2

    padded = np.pad(ink, ((1, 2), (1, 1)))
    flat, cols = padded.ravel(), padded.shape[1]
    ways = ((1, 1.0), (cols, 1.0), (cols + 1, np.sqrt(2)), (cols - 1, np.sqrt(2)))
    thickness = np.full(flat.shape, np.inf, np.float32)
    for step, length in ways:
        np.minimum(thickness, _runs(flat, step) * np.float32(length), out=thickness)
    thickness[~flat] = np.inf
    least = cv2.erode(thickness.reshape(padded.shape), np.ones((3, 3), np.uint8))[1:-2, 1:-1]
    return np.where(ink, least, np.float32(0))


def _runs(flat: Mask, step: int) -> NDArray[np.int32]:
    """Return for each pixel how many pixels of ink follow one another through it, each `step` further on in the raster;
    0 on paper.
    """
    rows = -(-len(flat) // step) + 1
    lined = np.zeros(rows * step, np.bool_)
    lined[: len(flat)] = flat
    down = np.ascontiguousarray(lined.reshape(rows, step).T).ravel()
    at = np.flatnonzero(down)
    first = np.flatnonzero(np.diff(at, prepend=-2) != 1)
    counts = np.diff(np.append(first, len(at)))
    lengths = np.zeros(down.shape, np.int32)
    lengths[at] = np.repeat(counts, counts)
    return np.ascontiguousarray(lengths.reshape(step, rows).T).ravel()[: len(flat)]


def usual_thickness(thickness: Floats, figure: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return how thick each figure's lines are for half of their length at most, px, by the figure's number; 0 for
    number 0.

    Args:
        thickness: (rows, cols) of ink. figure: (rows, cols) number of the connected figure that ink belongs to, 0 =
            paper.
    """
    usual = np.zeros(int(figure.max(initial=0)) + 1)
    inked = figure > 0
    own, thick = figure[inked], thickness[inked].astype(np.float64)
    order = np.lexsort((thick, own))
    own, thick = own[order], thick[order]
    length = np.cumsum(1 / thick)
    numbers, first = np.unique(own, return_index=True)
    if len(numbers):
        ends = length[np.append(first[1:], len(own)) - 1]
        begins = np.append(0.0, ends[:-1])
        usual[numbers] = thick[np.searchsorted(length, (begins + ends) / 2 - 1e-9)]
    return usual
