# mypy: allow-untyped-defs
"""Compiled inner loops of the exact offset: pieces of a level to rings, and what these measure."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import DEPTH, inside
from .offset_kernels import piece_rows


@kernel("int64(int64, int64, int64)", counts=False)
def _slot(i, j, mask):
    """Return a cell's place in a table of mask + 1 places."""
    # two large primes, so that neighbouring cells do not share places (Teschner et al., 2003)
    return ((i * 73856093) ^ (j * 19349663)) & mask


@kernel("int64(float64[:, ::1], boolean[::1], float64, int64[::1], int64[::1])", counts=False)
def _fill_table(rows, taken, size, last, before):
    """Enter the starts of rows not taken into a table by square cells; return its mask.

    last: the last row of each place, at least twice as many places as rows. before: the row before each row there.
    """
    mask = 1
    while mask < len(rows):
        mask *= 2
    last[:mask] = -1
    mask -= 1
    for j in range(len(rows)):
        if not taken[j]:
            at = _slot(math.floor(rows[j, 0] / size), math.floor(rows[j, 1] / size), mask)
            before[j] = last[at]
            last[at] = j
    return mask


@kernel("int64(float64[:, ::1], int64, boolean[::1], float64, int64[::1], int64[::1], int64)", counts=False)
def _nearest_start(rows, i, taken, radius, last, before, mask):
    """Return the row not taken that starts nearest to row i's end, -1 when none does within the radius."""
    x, y, best, chosen, size = rows[i, 2], rows[i, 3], radius * radius, -1, 4 * radius
    # cells are four radii wide, so a circle meets at most four of them
    for u in range(math.floor((x - radius) / size), math.floor((x + radius) / size) + 1):
        for v in range(math.floor((y - radius) / size), math.floor((y + radius) / size) + 1):
            j = last[_slot(u, v, mask)]
            while j >= 0:
                dx, dy = rows[j, 0] - x, rows[j, 1] - y
                if not taken[j] and dx * dx + dy * dy <= best:
                    best, chosen = dx * dx + dy * dy, j
                j = before[j]
    return chosen


@kernel("boolean(float64[:, ::1], float64, int64[::1])")
def follow(rows, tolerance, following):
    """Write for each row the row that starts nearest to its end, each used once; return False when one has none within
    tolerance.

    Nearest pairs are matched first: ever wider circles.
    """
    m = len(rows)
    taken, left = np.zeros(m, np.bool_), m
    last, before = np.empty(2 * m + 2, np.int64), np.empty(m, np.int64)
    following[:] = -1
    reach = 1e-9
    while left > 0:
        radius = min(reach, tolerance)
        mask = _fill_table(rows, taken, 4 * radius, last, before)
        for i in range(m):
            if following[i] < 0:
                chosen = _nearest_start(rows, i, taken, radius, last, before, mask)
                if chosen >= 0:
                    following[i], taken[chosen] = chosen, True
                    left -= 1
        if radius == tolerance:
            break
        # what rounding alone parts is joined first, so that nothing farther away takes its place
        reach *= 10.0
    return left == 0


@kernel("int64(float64[:, ::1], int64[::1], float64[:, ::1], int64[::1], int64[::1])")
def assemble(rows, following, out, order, starts):
    """Write the rows ring after ring, each beginning exactly where the one before ends; return how many rings there
    are.

    Args:
        following: (m,) row that comes after each row; a permutation.
        out: (m, 8) the rows in the order of rings. order: (m,) where each of them came from.
        starts: (m + 1,) first row of each ring, and the end of the last one.
    """
    for i in range(len(rows)):
        j = following[i]
        # ends that are apart by rounding alone meet half way
        x, y = (rows[i, 2] + rows[j, 0]) / 2, (rows[i, 3] + rows[j, 1]) / 2
        rows[i, 2], rows[i, 3], rows[j, 0], rows[j, 1] = x, y, x, y
    seen = np.zeros(len(rows), np.bool_)
    count = rings = 0
    for first in range(len(rows)):
        if seen[first]:
            continue
        starts[rings] = count
        rings += 1
        at = first
        while not seen[at]:
            seen[at] = True
            for c in range(8):
                out[count, c] = rows[at, c]
            order[count] = at
            count += 1
            at = following[at]
    starts[rings] = count
    return rings


@kernel("float64(float64[:, ::1], int64)", counts=False)
def _sweep(rows, i):
    """Return the signed sweep of row i, in (-2 pi, 2 pi)."""
    if rows[i, 7] == 0.0:
        return 0.0
    a = math.atan2(rows[i, 1] - rows[i, 5], rows[i, 0] - rows[i, 4])
    b = math.atan2(rows[i, 3] - rows[i, 5], rows[i, 2] - rows[i, 4])
    return ((b - a) * rows[i, 7]) % (2 * math.pi) * rows[i, 7]


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, int64)", counts=False)
def measure(rows, first, stop):
    """Return (signed area, length) of the ring of rows first to stop - 1: Green's theorem, exact for arcs."""
    area = length = 0.0
    x, y = rows[first, 0], rows[first, 1]
    for i in range(first, stop):
        sweep = _sweep(rows, i)
        area += ((rows[i, 0] - x) * (rows[i, 3] - y) - (rows[i, 2] - x) * (rows[i, 1] - y)) / 2
        # between chord and arc: r^2 (sweep - sin sweep) / 2, signed as the sweep is
        area += rows[i, 6] * rows[i, 6] * (sweep - math.sin(sweep)) / 2
        length += (
            math.hypot(rows[i, 2] - rows[i, 0], rows[i, 3] - rows[i, 1])
            if rows[i, 7] == 0.0
            else rows[i, 6] * abs(sweep)
        )
    return area, length


_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"
_SIZES = "float64, float64, float64"


@kernel(
    f"Tuple((boolean, float64[:, ::1], int64[::1], float64[:, ::1]))({_TREE}, float64[:, ::1], float64[:, ::1], "
    f"{_SIZES})"
)
def close(drawing, order, nodes, angles, pieces, level, apart, ridge):
    """Join all pieces at a level into closed rings; return (whether that can be done, rows, their owners, a table of
    rings).

    Rings outside the drawing are left out when they are as good as a line or a point; other ones make it fail.

    Args:
        drawing, order, nodes: all rows of the drawing and their tree. angles: of their elements.
        pieces: (m, 3) element, u0, u1.
        apart: the farthest that ends may be apart, mm. ridge: the height of a ridge, mm.

    Returns:
        rows: (m, 8) ring after ring. owners: (m,) row of the drawing to which each keeps the level.
        table: (rings, 5) first row, end, signed area, length, owner of the first row.
    """
    m = len(pieces)
    following, origin, starts = np.empty(m, np.int64), np.empty(m, np.int64), np.empty(m + 1, np.int64)
    rows, joined, stack, kept = np.empty((m, 8)), np.empty((m, 8)), np.empty(DEPTH, np.int64), 0
    piece_rows(drawing, angles, pieces, level, rows)
    if not follow(rows, apart, following):
        return False, joined, origin, np.empty((0, 5))
    rings = assemble(rows, following, joined, origin, starts)
    for i in range(m):
        origin[i] = int(pieces[origin[i], 0]) % len(drawing)
    table = np.empty((rings, 5))
    for k in range(rings):
        first, stop = starts[k], starts[k + 1]
        area, length = measure(joined, first, stop)
        if not inside(drawing, order, nodes, joined[first, 0], joined[first, 1], stack):
            if length < 4 * ridge or 0.0 <= area < length * ridge:
                continue
            return False, joined, origin, table
        table[kept, 0], table[kept, 1], table[kept, 2], table[kept, 3], table[kept, 4] = (
            first,
            stop,
            area,
            length,
            origin[first],
        )
        kept += 1
    return True, joined, origin, table[:kept]


@kernel("void(float64[:, ::1], float64, float64)")
def shift(rows, x, y):
    """Move rows, in place."""
    for i in range(len(rows)):
        for k in range(0, 4 if rows[i, 7] == 0.0 else 6, 2):
            rows[i, k] += x
            rows[i, k + 1] += y
