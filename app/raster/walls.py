"""Which pixels a cutter may be in, and the squares of all others as walls of the plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..geometry.outlines import polygon_contour
from ..geometry.primitives import TURN, Rows
from ..model.part import Contour
from .draw import image_rows, rows_of
from .frame import BitmapFrame

Mask = NDArray[np.bool_]
"""(rows, cols), row 0 = top."""

_ON_GRID = 1e-6
"""Pixels; a coordinate nearer than this to the grid's line lies on it."""


def free_pixels(frame: BitmapFrame, contours: Sequence[Contour] | Rows) -> Mask:
    """Return the pixels whose whole square lies inside closed contours, by even-odd counting.

    The squares of all other pixels together hold every contour, so a cutter that keeps clear of these squares keeps
    clear of the contours, however they run inside a pixel.

    Args:
        contours: closed, or the rows (n, 8) of closed contours, mm.
    """
    from . import wall_kernels

    rows = image_rows(frame, rows_of(contours))
    near = np.rint(rows[:, :4])
    rows[:, :4] = np.where((np.abs(rows[:, :4] - near) < _ON_GRID) & (rows[:, [TURN]] == 0), near, rows[:, :4])
    touched, flips = np.zeros((2, frame.rows, frame.cols), np.uint8)
    wall_kernels.cover(rows, touched, flips)
    free = np.ascontiguousarray(np.bitwise_xor.accumulate(flips, axis=1) & (touched ^ 1), np.uint8)
    wall_kernels.close_seams(rows, free)
    return np.asarray(free != 0)


def outline_px(free: Mask) -> NDArray[np.int64]:
    """Return the sides (n, 4) of free areas along the pixels' edges: from and to (u, v), the free side on the left.

    Neighbouring edges in one direction are one side.
    """
    padded = np.pad(free, 1).astype(np.int8)
    v, u0, u1, below = _runs(np.diff(padded, axis=0)[:, 1:-1])
    u, v0, v1, right = _runs(np.ascontiguousarray(np.diff(padded, axis=1)[1:-1].T))
    level = np.where(below[:, None], np.stack([u1, v, u0, v], 1), np.stack([u0, v, u1, v], 1))
    upright = np.where(right[:, None], np.stack([u, v0, u, v1], 1), np.stack([u, v1, u, v0], 1))
    return np.concatenate([level, upright]).astype(np.int64)


def _runs(edges: NDArray[np.int8]) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], Mask]:
    """Return (line, first, stop, whether positive) of each run of equal edges that are not 0."""
    padded = np.pad(edges, ((0, 0), (1, 1)))
    changes = padded[:, 1:] != padded[:, :-1]
    line, first = np.nonzero(changes & (padded[:, 1:] != 0))
    _, stop = np.nonzero(changes & (padded[:, :-1] != 0))
    return line, first, stop, edges[line, first] > 0


def wall_rows(frame: BitmapFrame, free: Mask) -> Rows:
    """Return the edges of the walls' squares as lines (n, 8), mm, for distances; in no particular order."""
    sides = outline_px(free).astype(np.float64)
    rows = np.zeros((len(sides), 8))
    rows[:, :2], rows[:, 2:4] = frame.to_mm(sides[:, :2]), frame.to_mm(sides[:, 2:])
    return rows


def free_contours(frame: BitmapFrame, free: Mask) -> tuple[Contour, ...]:
    """Return the closed contours of free areas along the pixels' edges, mm; areas that meet at a corner stay apart.

    The free side lies on the left: outer contours run counter-clockwise, those of islands clockwise.
    """
    sides = outline_px(free)
    from_corner: dict[tuple[int, int], list[int]] = {}
    for k, (u, v) in enumerate(sides[:, :2].tolist()):
        from_corner.setdefault((u, v), []).append(k)
    contours = []
    for first in range(len(sides)):
        chain, k = [], first
        while (left := from_corner.get((int(sides[k, 0]), int(sides[k, 1])), [])) and k in left:
            left.remove(k)
            chain.append(k)
            k = _next_side(sides, k, from_corner.get((int(sides[k, 2]), int(sides[k, 3])), []))
        if chain:
            points = frame.to_mm(sides[chain, :2].astype(np.float64))
            contours.append(polygon_contour([(x, y) for x, y in points.tolist()]))
    return tuple(contours)


def _next_side(sides: NDArray[np.int64], k: int, waiting: list[int]) -> int:
    """Return which of the sides that begin where side k ends goes on with the same pixel: the one that turns left."""
    along = sides[k, 2:] - sides[k, :2]
    turns = [
        (int(along[0] * -(sides[j, 3] - sides[j, 1]) + along[1] * (sides[j, 2] - sides[j, 0])), j) for j in waiting
    ]
    return max(turns)[1] if turns else k
