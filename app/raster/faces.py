"""What a picture's ink encloses.

A picture has no vectors to count crossings of, so its faces (connected areas of paper) are told apart by how deep they
are nested in lines: one line in, area; two lines in, island.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .peel import distance_px
from .picture_options import InkMeaning
from .walls import Mask

_THIN = 6.0
"""Pixels; ink that is nowhere thicker is lines."""

_SLENDER = 20
"""Times a line's width; what lines draw is longer."""


def ink_meaning(ink: Mask, requested: InkMeaning) -> InkMeaning:
    """Return whether ink is lines or areas, where nobody said.

    Lines are thin everywhere, or most of their ink is narrower than a small part of the largest figure it makes and
    they enclose more paper than they cover: a bar is thin too, but encloses nothing.
    """
    if requested is not InkMeaning.AUTO:
        return requested
    depth = distance_px(ink)
    if 2 * float(depth.max(initial=0.0)) <= _THIN:
        return InkMeaning.LINES
    count = np.count_nonzero(ink)
    slender = 2 * np.count_nonzero(_opened(depth, max(_THIN, _largest(ink) / _SLENDER) / 2)) < count
    return InkMeaning.LINES if slender and np.count_nonzero(inner_faces(ink)) > count else InkMeaning.AREAS


def _largest(ink: Mask) -> int:
    """Return the longer side of the largest connected figure of ink, px."""
    import cv2

    stats = cv2.connectedComponentsWithStats(ink.astype(np.uint8), connectivity=8)[2]
    return int(stats[1:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]].max(initial=0))


def _opened(depth: NDArray[np.float32], radius: float) -> Mask:
    """Return what an opening by a disc leaves of ink that is that deep, px."""
    rim = int(radius) + 1
    away = distance_px(np.pad(depth <= radius, rim, constant_values=True))[rim:-rim, rim:-rim]
    opened: Mask = (depth > 0) & (away < radius)
    return opened


def inner_faces(ink: Mask) -> Mask:
    """Return the paper that lines enclose: faces nested in an odd number of lines.

    A line that encloses several faces side by side counts as one line round each of them.
    """
    import cv2

    padded = np.pad(~ink, 1, constant_values=True)
    _, face = cv2.connectedComponents(padded.astype(np.uint8), connectivity=4)
    _, line = cv2.connectedComponents((~padded).astype(np.uint8), connectivity=8)
    depth = _depths(np.asarray(face, np.int32), np.asarray(line, np.int32))
    inside: Mask = (depth[face] % 2 == 1)[1:-1, 1:-1] & ~ink
    return inside


def _depths(face: NDArray[np.int32], line: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return how many lines each face is nested in; the face at the picture's corner is outside of all."""
    pairs = np.concatenate([_touching(face, line), _touching(face.T, line.T)])
    pairs = np.unique(pairs, axis=0)
    depth = np.full(int(face.max()) + 1, -1, np.int64)
    depth[face[0, 0]] = 0
    reached = np.zeros(int(line.max()) + 1, np.bool_)
    front = np.array([face[0, 0]])
    while len(front):
        lines = np.unique(pairs[np.isin(pairs[:, 0], front), 1])
        lines = lines[~reached[lines]]
        reached[lines] = True
        level = depth[front[0]] + 1
        front = np.unique(pairs[np.isin(pairs[:, 1], lines), 0])
        front = front[depth[front] < 0]
        depth[front] = level
    return depth


def _touching(face: NDArray[np.int32], line: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return (face, line) of all pixels side by side in a row, of which one is paper and one ink."""
    a = np.stack([face[:, :-1].ravel(), line[:, 1:].ravel()], 1)
    b = np.stack([face[:, 1:].ravel(), line[:, :-1].ravel()], 1)
    both = np.concatenate([a, b])
    return both[(both[:, 0] > 0) & (both[:, 1] > 0)]
