"""Areas that a tool's centre may be in, on pixels alone, and the paths round them as levels of one distance field."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..core.pool import pool
from .border import Index
from .peel import inner_pixels
from .walls import Mask

_PART = 1 << 20
"""Pixels that are worth a thread's start."""

SAFE_PX = 1.21
"""A path through pixel centres comes nearer to the walls' squares than its pixels' distances say by less than this:
half a pixel's diagonal for the square, half a pixel for the way between two centres."""


def offset_area(free: Mask, radius: float, spare: float) -> Mask:
    """Step 120: return the pixels in which a tool's centre may be, A' of A.

    Args:
        free: pixels whose squares lie wholly inside the part's walls.
        radius: of the tool, and the stock it leaves, px, >= 0; 0 = every free pixel.
        spare: how far smoothing may move the path off these pixels, px.
    """
    if radius == 0:
        return free
    area: Mask = thresholds_reached(free, [math.ceil((radius + SAFE_PX + spare) ** 2)]) != 0
    return area


def thresholds_reached(free: Mask, squares: Sequence[int]) -> Index:
    """Return for every pixel how many of some thresholds its distance from the nearest pixel that is not free reaches.

    Distances are Euclidean, between centres, and exact; what lies beyond the picture is not free.

    Args:
        squares: of the thresholds, px2, whole and rising, no more than 65535 of them.
    """
    from . import distance_kernels

    inner, bands = np.ascontiguousarray(free).view(np.uint8), -(-len(free) // distance_kernels.BAND)
    index, beside = np.zeros(free.shape, np.uint16), np.empty((2, bands, free.shape[1]), np.uint16)
    thresholds = np.array([0, *squares, np.iinfo(np.int64).max], np.int64)
    list(pool().map(lambda k: distance_kernels.beside_bands(inner, k == 0, beside[k]), range(2)))
    parts = pairwise(np.linspace(0, bands, 1 + min(free.size // _PART, bands) + 1).astype(int).tolist())
    list(pool().map(lambda part: distance_kernels.reached(inner, beside, thresholds, index, part), parts))
    return index


@dataclass(frozen=True, slots=True)
class RingSteps:
    """Where pocket paths lie, in pixels from the frame of A'.

    Attributes:
        first: the outermost one, >= 0.
        step: from path to path, >= 1.
        early: by how much all others lie nearer to the frame than steps say: what the outermost one keeps to be safe,
            they need not; 0 <= early <= step - 1.
    """

    first: float
    step: float
    early: float = 0.0


def ring_index(area: Mask, steps: RingSteps) -> Index:
    """Return which pocket path each pixel lies inside of (steps 141-148): path k is the border of {index >= k}, k = 1,
    2, …

    No path is made from the one before it, so nothing adds up.

    Args:
        area: A'; distances are measured from its frame.
    """
    first = math.floor(steps.first**2) + 1
    count = min(int((min(area.shape) / 2 - steps.first + steps.early) / steps.step) + 1, 65534)
    further = [
        max(math.ceil((steps.first - steps.early + k * steps.step) ** 2), first) for k in range(1, max(count, 1))
    ]
    index = thresholds_reached(inner_pixels(area), [first, *further])
    if steps.first == 0:
        index[area & (index == 0)] = 1
    return index
