# mypy: allow-untyped-defs
"""The quads that cover the cells a piece may lower, and the numbers that a fragment of one needs.

Each quad has an anchor, the cell of the grid that is nearest to its middle. Places are float64 up to the anchor, and
what is told of it is rounded once; from there a fragment counts whole cells, which float32 holds exactly. So what
matters to rounding is how far a cell is from its anchor, not from the zero or from the start of a piece, and pieces
longer than `STRETCH` are several quads.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..sweeps.reach_kernels import SLACK

STRETCH = 32.0
"""mm; no quad is longer."""

STRAIGHT, ROUND = 12, 16
"""Floats of a quad, of a straight piece and of an arc."""

_F = np.float32
_PLACES, _SHAPE = "Array(float64, 2, 'C', True)", "UniTuple(float64, 7)"
_GRID = "UniTuple(float64, 5)"


@kernel(f"UniTuple(float64, 4)({_GRID}, float64, float64)")
def anchor_at(grid, x, y):
    """Return column and row of the cell of a grid that is nearest to a place, and the place of its centre, mm.

    Args:
        grid: x and y of the lower left corner, pitch, mm; columns and rows.
    """
    x0, y0, pitch, cols, rows = grid
    col, row = (
        math.floor(min(max((x - x0) / pitch, 0.0), cols - 1.0)),
        math.floor(min(max((y - y0) / pitch, 0.0), rows - 1.0)),
    )
    return col, row, x0 + (col + 0.5) * pitch, y0 + (row + 0.5) * pitch


@kernel(f"UniTuple(float64, 2)({_GRID}, float64, UniTuple(float64, 4), UniTuple(float64, 2))")
def within_grid(grid, radius, way, span):
    """Return what of a span along a straight piece can meet the grid, mm from its start; the second less than the
    first: nothing.

    Args:
        radius: of the cutter.
        way: start of the piece, and its horizontal direction.
    """
    x0, y0, pitch, cols, rows = grid
    px, py, ux, uy = way
    wide, tall = 0.5 * cols * pitch, 0.5 * rows * pitch
    x, y = x0 + wide - px, y0 + tall - py
    # separating axis across the piece: the grid's half extent along the normal is |uy| wide + |ux| tall
    if abs(ux * y - uy * x) > radius * (1.0 + SLACK) + abs(uy) * wide + abs(ux) * tall:
        return 0.0, -1.0
    middle, half = ux * x + uy * y, abs(ux) * wide + abs(uy) * tall
    return max(span[0], middle - half), min(span[1], middle + half)


@kernel(
    f"Tuple((int64, float64))({_PLACES}, {_PLACES}, float64[:, ::1], int64[::1], {_SHAPE}, {_GRID}, float32[:, ::1])"
)
def straight_quads(start, end, spans, chosen, shape, grid, quads):
    """Write the quads of straight pieces that are cut with one cutter; return how many they are, and about how many
    cells they cover.

    Args:
        start, end, spans: of all pieces, as `tile_kernels.survey` says.
        chosen: the pieces to do.
        shape: of the cutter. grid: as for `anchor_at`.
        quads: rows to write: column and row of the anchor, its place along the piece from the lower end (a) and across
            (c), mm; its place from the upper end (b), how a changes from column to column and from row to row, rise;
            from where to where the quad reaches along the piece, from the anchor, z of the tip at both ends.
    """
    radius, lift, count, cells, most = shape[0], shape[5], 0, 0.0, grid[3] * grid[4]
    for k in chosen:
        (px, py, pz), (qx, qy, qz) = (start[k, 0], start[k, 1], start[k, 2]), (end[k, 0], end[k, 1], end[k, 2])
        low, high, falls = spans[k, 0], spans[k, 1], pz > qz
        if falls:
            px, py, pz, qx, qy, qz = qx, qy, qz, px, py, pz
        length, ux, uy, s = math.sqrt((qx - px) * (qx - px) + (qy - py) * (qy - py)), 1.0, 0.0, 0.0
        if high < low:
            length, qz, low, high = 0.0, pz, -radius, radius
        else:
            ux, uy, s = (qx - px) / length, (qy - py) / length, (qz - pz) / length
            if falls:
                low, high = length - high, length - low
        low, high = within_grid(grid, radius, (px, py, ux, uy), (low, high))
        parts = math.ceil((high - low) / STRETCH) if high > low else (1 if high == low else 0)
        for part in range(parts):
            here, there = low + (high - low) * part / parts, low + (high - low) * (part + 1) / parts
            col, row, x, y = anchor_at(grid, px + ux * 0.5 * (here + there), py + uy * 0.5 * (here + there))
            a, c = ux * (x - px) + uy * (y - py), ux * (y - py) - uy * (x - px)
            quad = quads[count]
            quad[0], quad[1], quad[2], quad[3] = _F(col), _F(row), _F(a), _F(c)
            # every number is rounded once, relative to the anchor; see the head of this file
            quad[4], quad[5], quad[6], quad[7] = _F(a - length), _F(ux * grid[2]), _F(uy * grid[2]), _F(s)
            quad[8], quad[9], quad[10], quad[11] = _F(here - a), _F(there - a), _F(pz + lift), _F(qz + lift)
            count, cells = count + 1, cells + min((there - here) * 2.0 * radius / (grid[2] * grid[2]), most)
    return count, cells


@kernel(
    f"Tuple((int64, float64))({_PLACES}, {_PLACES}, int32[::1], float64[:, ::1], int64[::1], {_SHAPE}, {_GRID}, "
    "float32[:, ::1])"
)
def round_quads(start, end, arc, arcs, chosen, shape, grid, quads):
    """Write the quads of level arcs that are cut with one cutter; return how many they are, and about how many cells
    they cover.

    A wide arc is several quads, which hold all of what is said of it and share its cells.

    Args:
        start, end, arc, arcs: of all pieces, as `tile_kernels.survey` says.
        chosen: the pieces to do.
        shape: of the cutter. grid: as for `anchor_at`.
        quads: rows to write: column and row of the anchor, the direction to it from the centre; how far it is beyond
            the circle, 1 / radius of the circle, z of the tip, half the quad's width, cells; its place from start and
            from end, mm; from the anchor the middle of the quad, and from there the middle of its far side, cells.
    """
    radius, cell, count, cells, most = shape[0], 1.0 / grid[2], 0, 0.0, grid[3] * grid[4]
    left, below, right, above = grid[0], grid[1], grid[0] + grid[3] * grid[2], grid[1] + grid[4] * grid[2]
    for k in chosen:
        cx, cy, size = arcs[arc[k], 0], arcs[arc[k], 1], arcs[arc[k], 2]
        px, py, qx, qy = start[k, 0], start[k, 1], end[k, 0], end[k, 1]
        first = math.atan2(py - cy, px - cx)
        turn = max(
            math.atan2((px - cx) * (qy - cy) - (py - cy) * (qx - cx), (px - cx) * (qx - cx) + (py - cy) * (qy - cy)),
            0.0,
        )
        parts = 1.0
        if size > 2.0 * radius:
            parts = max(max(math.ceil(0.5 * turn * math.sqrt(size / radius)), math.ceil(turn * size / STRETCH)), 1.0)
        half = 0.5 * turn / parts
        # a quad holds its part of the ring: from the chord's middle, less the cutter, to the outer rim
        inner, outer = size * math.cos(half) - radius, size + radius
        for part in range(int(parts)):
            angle = first + (2.0 * part + 1.0) * half
            nx, ny = math.cos(angle), math.sin(angle)
            # the outermost parts reach a cutter's radius beyond the ends, the others as far as the outer rim's chord
            back = size * math.sin(half) + radius if part == 0 else outer * math.sin(half)
            ahead = size * math.sin(half) + radius if part == parts - 1.0 else outer * math.sin(half)
            along, wide, deep = 0.5 * (ahead - back), 0.5 * (ahead + back), 0.5 * (outer - inner)
            mx, my = cx + nx * 0.5 * (inner + outer) - ny * along, cy + ny * 0.5 * (inner + outer) + nx * along
            aside, up = abs(ny) * wide + abs(nx) * deep, abs(nx) * wide + abs(ny) * deep
            if mx - aside > right or mx + aside < left or my - up > above or my + up < below:
                continue
            col, row, x, y = anchor_at(grid, cx + nx * size, cy + ny * size)
            far = math.sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy))
            if far > 0.0:
                quads[count, 2], quads[count, 3] = _F((x - cx) / far), _F((y - cy) / far)
            else:
                quads[count, 2], quads[count, 3] = _F(nx), _F(ny)
            quad = quads[count]
            quad[0], quad[1], quad[4], quad[5] = _F(col), _F(row), _F(far - size), _F(1.0 / size)
            quad[6], quad[7], quad[8], quad[9] = _F(start[k, 2] + shape[5]), _F(deep * cell), _F(x - px), _F(y - py)
            quad[10], quad[11], quad[12], quad[13] = _F(x - qx), _F(y - qy), _F((mx - x) * cell), _F((my - y) * cell)
            quad[14], quad[15] = _F(-ny * wide * cell), _F(nx * wide * cell)
            count, cells = count + 1, cells + min(4.0 * wide * deep * cell * cell, most)
    return count, cells
