# mypy: allow-untyped-defs
"""The metal round a cutter, as it stands before each place of a path: heights in square cells, in tiles along the path.

A frame is (x, y of the corner of cell 0, 0; side of a cell), mm. Cell (row, column) lies in tile (row >> SHIFT, column
>> SHIFT); `index` tells the tile's slot in `heights`, -1 where nobody looks. Callers choose frames in which every
cutter lies wholly within the index.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel

SHIFT = 6
"""A tile has 2^SHIFT cells along a side."""

HAIR = 1e-3
"""mm; metal no higher than this above the tip is none: a floor that is cut twice, within rounding."""

_SIDE = 1 << SHIFT
"""Cells along a side of a tile."""
_CELLS = _SIDE * _SIDE
_FRAME = "UniTuple(float64, 3)"
_FIELD = f"float32[::1], int32[:, ::1], {_FRAME}"


@kernel(f"void(int32[:, ::1], {_FRAME}, float64[:, ::1], float64)")
def mark(index, frame, places, radius):
    """Set the index to 0 in all tiles that the square round a cutter meets at some places (n, 6)."""
    tile = 1.0 / (frame[2] * _SIDE)
    for i in range(len(places)):
        x, y = places[i, 0] - frame[0], places[i, 1] - frame[1]
        for row in range(math.floor((y - radius) * tile), math.floor((y + radius) * tile) + 1):
            for col in range(math.floor((x - radius) * tile), math.floor((x + radius) * tile) + 1):
                index[row, col] = 0


@kernel(f"boolean(int32[:, ::1], {_FRAME}, UniTuple(float64, 4))", counts=False)
def looked_at(index, frame, disc):
    """Tell whether the square round a disc (x, y, z, radius, mm) meets a tile that is looked at."""
    tile, x, y, radius = 1.0 / (frame[2] * _SIDE), disc[0] - frame[0], disc[1] - frame[1], disc[3]
    for row in range(math.floor((y - radius) * tile), math.floor((y + radius) * tile) + 1):
        for col in range(math.floor((x - radius) * tile), math.floor((x + radius) * tile) + 1):
            if index[row, col] >= 0:
                return True
    return False


@kernel("void(float32[::1], int32[:, ::1], UniTuple(int64, 3), float32)", counts=False)
def cut_run(heights, index, run, z):
    """Cut the cells (row, first column … last column) down to z, mm."""
    row, at, last = run
    while at <= last:
        stop = min(last, at | (_SIDE - 1))
        slot = np.int64(index[row >> SHIFT, at >> SHIFT])
        if slot >= 0:
            base = slot * _CELLS + (row & (_SIDE - 1)) * _SIDE
            for k in range(base + (at & (_SIDE - 1)), base + (stop & (_SIDE - 1)) + 1):
                heights[k] = min(heights[k], z)
        at = stop + 1


@kernel(f"void({_FIELD}, UniTuple(float64, 4), UniTuple(float64, 3))", counts=False)
def cut_disc(heights, index, frame, disc, before):
    """Cut all cells whose centres lie within a disc.

    Args:
        disc: x, y, z, radius, mm.
        before: x, y, radius of a disc that was cut at least as deep and need not be looked at again; radius 0: there is
            none.
    """
    cell = 1.0 / frame[2]
    # in cells, centres at whole numbers
    cx, cy, reach = (disc[0] - frame[0]) * cell - 0.5, (disc[1] - frame[1]) * cell - 0.5, disc[3] * cell
    bx, by, old = (before[0] - frame[0]) * cell - 0.5, (before[1] - frame[1]) * cell - 0.5, before[2] * cell
    z = np.float32(disc[2])
    for row in range(math.ceil(cy - reach), math.floor(cy + reach) + 1):
        half = math.sqrt(max(reach * reach - (row - cy) * (row - cy), 0.0))
        first, last = math.ceil(cx - half), math.floor(cx + half)
        # what lies within the older disc's chord was cut with it: only what is left and right of it is new
        square, done = old * old - (row - by) * (row - by), last
        if old > 0.0 and square >= 0.0:
            half = math.sqrt(square)
            done = min(last, math.ceil(bx - half) - 1)
            cut_run(heights, index, (row, max(first, math.floor(bx + half) + 1), last), z)
        cut_run(heights, index, (row, first, done), z)


@kernel(f"int64({_FIELD}, UniTuple(float64, 5), float64, float64[:, ::1])", counts=False)
def standing(heights, index, frame, place, inner, rim):
    """Return how many points of the rim of a cutter's front half lie in standing metal.

    Args:
        place: x, y, z, mm, and the direction of travel, a unit vector.
        inner: radius of the rim that is looked at, mm.
        rim: (m, 2) unit vectors from the centre to its points, direction of travel = +X.
    """
    x, y, z, dx, dy = place
    x, y, cell, count = x - frame[0], y - frame[1], 1.0 / frame[2], 0
    for k in range(len(rim)):
        col = int((x + inner * (dx * rim[k, 0] - dy * rim[k, 1])) * cell)
        row = int((y + inner * (dy * rim[k, 0] + dx * rim[k, 1])) * cell)
        slot = np.int64(index[row >> SHIFT, col >> SHIFT])
        if heights[slot * _CELLS + (row & (_SIDE - 1)) * _SIDE + (col & (_SIDE - 1))] > z + HAIR:
            count += 1
    return count


@kernel(f"int64({_FIELD}, float64[:, ::1], float64[:, ::1], UniTuple(float64, 3), UniTuple(int64, 3), float64[::1])")
def sweep(heights, index, frame, places, rim, cutter, span, share):
    """Lead a cutter through places of its path: tell how far it is engaged, and cut.

    A place is cut only when the path has gone on by the lag, so that the rim, which is looked at a little inside the
    true one, is not taken for cut by the very move that it is to cut on.

    Args:
        places: (n, 6) x, y, z, position along the path (not falling), mm, and direction of travel; no direction: only
            cut there.
        rim: as `standing` has it; none: the cutter is not looked at, and need not lie where anybody looks.
        cutter: radius, radius of the rim that is looked at, lag, mm.
        span: first place, behind the last place, first place that is not cut yet.
        share: (n,) is filled with the engaged share of the diameter where there is a direction.

    Returns:
        The first place that is not cut yet.
    """
    radius, inner, lag = cutter
    first, stop, at = span
    for i in range(first, stop):
        while at < i and places[at, 3] <= places[i, 3] - lag:
            disc = (places[at, 0], places[at, 1], places[at, 2], radius)
            before = max(at - 1, 0)
            old = radius if at > 0 and places[before, 2] <= disc[2] else 0.0
            if looked_at(index, frame, disc):
                cut_disc(heights, index, frame, disc, (places[before, 0], places[before, 1], old))
            at += 1
        dx, dy = places[i, 4], places[i, 5]
        if len(rim) and (dx != 0.0 or dy != 0.0):
            count = standing(heights, index, frame, (places[i, 0], places[i, 1], places[i, 2], dx, dy), inner, rim)
            if count == 0 or count == len(rim):
                share[i] = 1.0 if count else 0.0
            else:
                # the points in metal are an arc of the front half, from one side on; it is (1 - cos) / 2 of its
                # diameter wide
                share[i] = 0.5 * (1.0 - inner / radius * math.cos(math.pi * count / len(rim)))
    return at
