"""Things in a balanced binary tree of boxes, near ones together: whoever asks for what is near leaves out whole
branches.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..model.motion import Floats

LEAF = 4
"""Things of a leaf."""

_BITS = 16
"""Of each coordinate, interleaved in the number that things are sorted by: three of 16 fit into 64."""


def box_tree(low: Floats, high: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Return the order in which things lie in the leaves, and the boxes of all nodes.

    Args:
        low, high: (n, 3) lowest and highest coordinates of each thing, mm; n > 0.

    Returns:
        order: (n,) thing k of leaf j is order[j * LEAF + k]. boxes: (2^m - 1, 6) x0, y0, z0, x1, y1, z1, the root
            first; children of i
        are 2 i + 1 and 2 i + 2; a leaf without things has an empty box.
    """
    order = np.argsort(_along_a_curve((low + high) / 2), kind="stable")
    leaves = 1
    while leaves * LEAF < len(order):
        leaves *= 2
    level = np.full((leaves * LEAF, 6), np.inf)
    level[: len(order), :3] = low[order]
    level[: len(order), 3:] = -high[order]  # of the negative the least is wanted, too
    level = level.reshape(leaves, LEAF, 6).min(axis=1)
    levels = [level]
    while len(level) > 1:
        level = np.minimum(level[::2], level[1::2])
        levels.append(level)
    boxes = np.concatenate(levels[::-1])
    boxes[:, 3:] *= -1.0
    return order, boxes


def _along_a_curve(places: Floats) -> NDArray[np.int64]:
    """Return numbers of places (n, 3) whose order keeps near ones together: the bits of x, y and z, interleaved
    (Morton).
    """
    low, high = places.min(axis=0), places.max(axis=0)
    cells = ((places - low) / np.maximum(high - low, 1e-300) * ((1 << _BITS) - 1)).astype(np.int64)
    number = np.zeros(len(places), np.int64)
    for axis in range(3):
        bits = cells[:, axis]
        for shift, mask in (
            (32, 0xFFFF00000000FFFF),
            (16, 0x00FF0000FF0000FF),
            (8, 0xF00F00F00F00F00F),
            (4, 0x30C30C30C30C30C3),
            (2, 0x9249249249249249),
        ):
            bits = (bits | (bits << shift)) & np.int64(mask - (1 << 64) if mask >> 63 else mask)
        number |= bits << axis
    return number
