"""Which cells of a grid have their centre inside closed outlines, or near them: even-odd, exact but for the last bit of
float64.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .workpiece import Grid

_AT_A_TIME = 1 << 20
"""Edges with lines of centres, or with cells, that are looked at together."""

Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]


def inside(grid: Grid, outlines: Sequence[Floats]) -> Mask:
    """Return (rows, cols) whether a cell's centre lies inside.

    Each line of centres is crossed by the outlines' edges (an edge counts for y0 <= y < y1); a cell is inside where an
    odd number of crossings lie left of its centre.

    Args:
        grid: where.
        outlines: (n, 2) points each, mm; closed from the last to the first.
    """
    start, end = _edges(outlines)
    first = _count(np.minimum(start[:, 1], end[:, 1]), grid.y0, grid.pitch, grid.rows)
    stop = _count(np.maximum(start[:, 1], end[:, 1]), grid.y0, grid.pitch, grid.rows)
    crossings = np.zeros((grid.rows, grid.cols + 1), np.uint8)
    for edge, row in _spread(first, stop):
        share = (grid.y0 + (row + 0.5) * grid.pitch - start[edge, 1]) / (end[edge, 1] - start[edge, 1])
        x = start[edge, 0] + share * (end[edge, 0] - start[edge, 0])
        # the first cell whose centre lies beyond the crossing
        np.bitwise_xor.at(crossings, (row, _count(x, grid.x0, grid.pitch, grid.cols)), 1)
    return np.bitwise_xor.accumulate(crossings[:, :-1], axis=1).astype(bool)


def beside(grid: Grid, outlines: Sequence[Floats], distance: float) -> Mask:
    """Return (rows, cols) whether a cell's centre lies within a distance of an outline.

    Quick where that is small beside a cell.

    Args:
        grid, outlines: as of `inside`.
        distance: mm, >= 0.
    """
    start, end = _edges(outlines)
    low, high = np.minimum(start, end) - distance, np.maximum(start, end) + distance
    first, stop = (_count(each[:, 1], grid.y0, grid.pitch, grid.rows) for each in (low, np.nextafter(high, np.inf)))
    near = np.zeros((grid.rows, grid.cols), bool)
    for edge, row in _spread(first, stop):
        a, way = start[edge], end[edge] - start[edge]
        y = grid.y0 + (row + 0.5) * grid.pitch
        # what of the edge is no farther from the line of centres, and the cells along that
        flat = way[:, 1] == 0
        parts = [(y + off - a[:, 1]) / np.where(flat, 1.0, way[:, 1]) for off in (-distance, distance)]
        ends = [np.where(flat, k, np.clip(part, 0.0, 1.0)) for k, part in enumerate(parts)]
        across = np.sort(np.stack([a[:, 0] + part * way[:, 0] for part in ends]), axis=0)
        left = _count(across[0] - distance, grid.x0, grid.pitch, grid.cols)
        right = _count(np.nextafter(across[1] + distance, np.inf), grid.x0, grid.pitch, grid.cols)
        for k, col in _spread(left, right):
            arm = np.stack([grid.x0 + (col + 0.5) * grid.pitch, y[k]], 1) - a[k]
            square = np.einsum("ij,ij->i", way[k], way[k])
            share = np.clip(np.einsum("ij,ij->i", arm, way[k]) / np.where(square > 0, square, 1.0), 0.0, 1.0)
            off = arm - share[:, None] * way[k]
            close = np.hypot(off[:, 0], off[:, 1]) <= distance
            near[row[k[close]], col[close]] = True
    return near


def _edges(outlines: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Return where the edges of closed outlines begin and end, (n, 2) each."""
    counts = np.array([len(points) for points in outlines], np.int64)
    start = np.concatenate([np.zeros((0, 2)), *outlines])
    after = np.arange(1, len(start) + 1)
    stops = np.cumsum(counts)[counts > 0]
    after[stops - 1] = stops - counts[counts > 0]
    return start, start[after]


def _count(at: Floats, zero: float, pitch: float, most: int) -> Indices:
    """Return how many centres along a side of the grid lie before each place."""
    return np.clip(np.ceil((at - zero) / pitch - 0.5), 0, most).astype(np.int64)


def _spread(first: Indices, stop: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield (which, number) for all numbers from the first of each up to its stop, in portions."""
    counts = np.maximum(stop - first, 0)
    ends = np.cumsum(counts)
    cuts = np.searchsorted(ends, np.arange(0, int(ends[-1]) if len(ends) else 0, _AT_A_TIME), "right")
    for begin, end in pairwise([*cuts.tolist(), len(counts)]):
        some = counts[begin:end]
        which = np.repeat(np.arange(begin, end), some)
        yield which, np.arange(len(which)) - np.repeat(np.cumsum(some) - some, some) + first[which]
