"""The fill of the 1986 text as it is written (steps 203-208), beside the settled one: for the class, never for a cut.

It marks R by the look of the chain codes and counts runs of pixels, so it fails where strands merge into one run, where
an 8-connected step cuts a pixel off, and at acute corners that run on upwards or downwards; see `fill` for the rule
that is always right.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .frame import PixelCode, Plane
from .trace import PixelChain, trace
from .walls import Mask

_UP = np.array([0, 1, 1, 1, 0, -1, -1, -1])
"""Rows that each direction climbs."""


def published_marks(contour: Plane) -> tuple[Plane, tuple[PixelChain, ...]]:
    """Steps 202-206: trace the contour pixels (2) and mark vertices and overlap lines (R); also return the chains.

    Args:
        contour: (rows, cols); any code but 0 is a contour pixel.
    """
    chains, plane = trace(contour)
    for chain in chains:
        pixels = chain.pixels()
        if len(chain.directions):
            pixels = pixels[:-1][_sharp(chain) | _turns_over(chain)]
        plane[tuple(pixels.T)] = PixelCode.R
    return plane, chains


def _sharp(chain: PixelChain) -> NDArray[np.bool_]:
    """Return for each pixel whether the chain turns by 135 degrees or more there: an acute corner, or the way back."""
    turn = (chain.directions.astype(np.int64) - np.roll(chain.directions, 1)) % 8
    return (turn >= 3) & (turn <= 5)


def _turns_over(chain: PixelChain) -> NDArray[np.bool_]:
    """Return for each pixel whether the chain comes from below and leaves downwards, or the reverse, level stretches
    included.
    """
    up = _UP[chain.directions]
    if not up.any():
        return np.ones(len(up), np.bool_)
    after = _last_climb(up[::-1])[::-1]
    before = np.roll(_last_climb(up), 1)
    turns: NDArray[np.bool_] = before == -after
    return turns


def _last_climb(up: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return for each step of a closed chain the last one, itself included, that is not level."""
    twice = np.concatenate([up, up])
    place = np.maximum.accumulate(np.where(twice != 0, np.arange(len(twice)), -1))
    return twice[place[len(up) :]]


def published_scan(marked: Plane) -> Plane:
    """Steps 207 and 208: count along every row the 2s whose left neighbour is 0; 0s behind an odd count become I."""
    left = np.pad(marked, ((0, 0), (1, 0)))[:, :-1]
    odd = np.cumsum((marked == PixelCode.TRACED) & (left == PixelCode.EMPTY), axis=1) % 2 == 1
    return np.where(odd & (marked == PixelCode.EMPTY), PixelCode.INSIDE, marked).astype(np.uint8)


def wrong_pixels(published: Plane, settled: Plane) -> Mask:
    """Return the pixels that are filled by one of two planes and not by the other."""
    wrong: Mask = (published != PixelCode.EMPTY) != (settled != PixelCode.EMPTY)
    return wrong
