"""Which cells of a grid have their centre inside closed outlines: even-odd, exact but for the last bit of float64."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .workpiece import Grid


def inside(grid: Grid, outlines: Sequence[Floats]) -> NDArray[np.bool_]:
    """Return (rows, cols) whether a cell's centre lies inside.

    Each line of centres is crossed by the outlines' edges (an edge counts for y0 <= y < y1); a cell is inside where an
    odd number of crossings lie left of its centre.

    Args:
        grid: where.
        outlines: (n, 2) points each, mm; closed from the last to the first.
    """
    crossings = np.zeros((grid.rows, grid.cols + 1), np.uint8)
    for points in outlines:
        _cross(grid, points, np.roll(points, -1, axis=0), crossings)
    return np.bitwise_xor.accumulate(crossings[:, :-1], axis=1).astype(bool)


def _cross(grid: Grid, start: Floats, end: Floats, crossings: NDArray[np.uint8]) -> None:
    """Flip, at each crossing of an edge with a line of centres, the first cell whose centre lies beyond it."""
    low, high = np.minimum(start[:, 1], end[:, 1]), np.maximum(start[:, 1], end[:, 1])
    first, stop = (
        np.clip(np.ceil((y - grid.y0) / grid.pitch - 0.5), 0, grid.rows).astype(np.int64) for y in (low, high)
    )
    lines = np.maximum(stop - first, 0)
    edge = np.repeat(np.arange(len(start)), lines)
    row = np.arange(len(edge)) - np.repeat(np.cumsum(lines) - lines, lines) + first[edge]
    share = (grid.y0 + (row + 0.5) * grid.pitch - start[edge, 1]) / (end[edge, 1] - start[edge, 1])
    x = start[edge, 0] + share * (end[edge, 0] - start[edge, 0])
    col = np.clip(np.ceil((x - grid.x0) / grid.pitch - 0.5), 0, grid.cols).astype(np.int64)
    np.bitwise_xor.at(crossings, (row, col), 1)
