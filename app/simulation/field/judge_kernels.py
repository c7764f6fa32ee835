# mypy: allow-untyped-defs
"""Heights against heights: grey dilation by a profile, and how far a cell is from the part at most."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

_FIELD = "Array(float32, 2, 'C', True)"

MOST_RINGS = 12
"""Cells round a cell in which the part's surface is looked for; a farther one makes a bound no better."""


@kernel(f"void({_FIELD}, {_FIELD}, float32[:, ::1], int64, int64)")
def dilate(heights, profile, out, first, last):
    """Write the rows first … last - 1 of max over (dy, dx) of heights[y + dy, x + dx] - profile[k + dy, k + dx].

    Args:
        heights: (rows, cols). profile: (2 k + 1, 2 k + 1), infinite where it is not. out: (rows, cols).
        first, last: rows to do.
    """
    rows, cols = heights.shape
    reach = profile.shape[0] // 2
    for y in range(first, last):
        line = out[y]
        line[:] = np.float32(-math.inf)
        for dy in range(max(-reach, -y), min(reach, rows - 1 - y) + 1):
            row, form = heights[y + dy], profile[reach + dy]
            for dx in range(-reach, reach + 1):
                off = form[reach + dx]
                if off == np.float32(math.inf):
                    continue
                begin, end = max(0, -dx), min(cols, cols - dx)
                if begin >= end:
                    continue
                # one shift of the whole row at a time: contiguous, so that it is done many cells at once
                into, source = line[begin:end], row[begin + dx : end + dx]
                for k in range(len(into)):
                    value = source[k] - off
                    into[k] = value if value > into[k] else into[k]


@kernel(f"float64({_FIELD}, int64, int64, float64, UniTuple(float64, 2), int64)")
def apart(wanted, row, col, height, where, sign):
    """Return how far any point of a cell at a height is from the part's surface at most, mm.

    That is the least, over the cells' centres q, of the longest way from the cell to q and straight up (sign 1) or down
    (-1) to the part there, if it is that way.

    Args:
        wanted: the part at the cells' centres, with MOST_RINGS cells more on each side.
        row, col: of the cell, in the grid without these.
        height: of the metal's end. where: pitch, half a cell's diagonal, mm.
    """
    pitch, half = where
    rows, cols = wanted.shape
    row, col = row + MOST_RINGS, col + MOST_RINGS
    best = math.inf
    for ring in range(MOST_RINGS):
        # cells of a ring are no nearer than that, so what is left to look at makes the bound no smaller
        if ring * pitch + half >= best:
            break
        for y in range(max(row - ring, 0), min(row + ring, rows - 1) + 1):
            # the rim alone: the inner cells were the rings before
            step = 1 if abs(y - row) == ring or ring == 0 else 2 * ring
            for x in range(col - ring, col + ring + 1, step):
                if 0 <= x < cols:
                    side = math.sqrt(float((x - col) * (x - col) + (y - row) * (y - row))) * pitch + half
                    up = max(sign * (wanted[y, x] - height), 0.0)
                    best = min(best, math.sqrt(side * side + up * up))
    return best


@kernel(f"float64({_FIELD}, {_FIELD}, {_FIELD}, UniTuple(float64, 2), int64, int64, int64)")
def farthest(heights, wanted, before, where, sign, first, last):
    """Return the greatest `apart` of the cells in rows first … last - 1 that count.

    Args:
        heights: bound of what is left, from below for gouges (sign 1), from above for metal left (-1).
        wanted: the part, see `apart`. before: gouges: the stock before; metal left: nothing is said where this is not
            finite.
    """
    worst = 0.0
    for y in range(first, last):
        for x in range(heights.shape[1]):
            height = float(heights[y, x])
            gap = sign * (wanted[y + MOST_RINGS, x + MOST_RINGS] - height)
            if sign > 0 and heights[y, x] >= before[y, x]:
                continue
            if sign < 0 and not before[y, x] < np.float32(math.inf):
                continue
            # straight up or down is one of the ways: a cell near enough by that needs no search
            if math.sqrt(max(gap, 0.0) ** 2 + where[1] ** 2) > worst:
                worst = max(worst, apart(wanted, y, x, height, where, sign))
    return worst


@kernel(f"void({_FIELD}, {_FIELD}, int64[::1], UniTuple(float64, 2), float64[::1])")
def ways_out(wanted, heights, cells, where, out):
    """Write how far the metal's end in some cells, row * cols + col each, is from the part's surface above it; see
    `apart`.
    """
    cols = heights.shape[1]
    for k in range(len(cells)):
        row, col = cells[k] // cols, cells[k] % cols
        out[k] = apart(wanted, row, col, heights[row, col], where, 1)
