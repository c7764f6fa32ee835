# mypy: allow-untyped-defs
"""Compiled tracing of the borders of filled areas: all areas of all levels in one pass over the picture.

Directions are those of the chain code: 0 to the right, then counter-clockwise by 45 degrees.
"""

from __future__ import annotations

from ..core.jit import kernel
from .row_kernels import end_of_run

LEFT = 4
"""A step to the left, of eight numbered counter-clockwise from the right on."""
RIGHT_DOWN = 7
"""A step this way has passed the empty pixel left of where it ends, which the next search leaves out."""


@kernel("int64(int64)")
def _du(d):
    return 1 if d == 0 or d == 1 or d == 7 else -1 if 3 <= d <= 5 else 0


@kernel("int64(int64)")
def _dv(d):
    return -1 if 1 <= d <= 3 else 1 if d >= 5 else 0


@kernel("boolean(uint16[:, ::1], int64, int64, int64)")
def _is_in(index, r, c, level):
    return 0 <= r < index.shape[0] and 0 <= c < index.shape[1] and index[r, c] >= level


@kernel("void(uint16[:, ::1], uint8[:, ::1], int64, int64, int64)")
def _note(index, seen, r, c, level):
    """Note that the border of a level passes between a pixel and its emptier left neighbour."""
    emptier = int(index[r, c - 1]) if c > 0 else 0
    seen[r, c] |= 1 << (level - emptier - 1)


@kernel("int64(uint16[:, ::1], uint8[:, ::1], int64, int64, int64)")
def _next(index, seen, r, c, code):
    """Return the first of the eight directions, from code % 8 counter-clockwise, that stays in the area, or -1.

    An emptier pixel found to the left is noted in `seen`, so that no border is traced twice.

    Args:
        code: 8 level + the direction to begin with.
    """
    level, first = code // 8, code % 8
    for k in range(8):
        d = (first + k) % 8
        if _is_in(index, r + _dv(d), c + _du(d), level):
            return d
        if d == LEFT:
            _note(index, seen, r, c, level)
    return -1


@kernel("int64(uint16[:, ::1], uint8[:, ::1], int64[::1], uint8[::1])")
def _trace_one(index, seen, start, chain):
    """Trace the border that has the emptier pixel left of start (row, column, level); return the number of
    directions.
    """
    r, c, level = start[0], start[1], start[2]
    first = _next(index, seen, r, c, 8 * level + LEFT)
    d, j, i, length = first, r, c, 0
    while d >= 0:
        if length < len(chain):
            chain[length] = d
        length += 1
        j, i = j + _dv(d), i + _du(d)
        if d == RIGHT_DOWN:
            _note(index, seen, j, i, level)
        # two directions before the one that led here: the empty side stays on the right (step 202)
        d = _next(index, seen, j, i, 8 * level + (d + 6) % 8)
        if j == r and i == c and d == first:
            break
    return length


@kernel("UniTuple(int64, 2)(uint16[:, ::1], uint8[:, ::1], int64[:, ::1], uint8[::1])")
def borders(index, seen, starts, chain):
    """Trace every border of every level's area {index >= level}.

    Args:
        index: (r, c) 0 = outside of all areas; levels count from 1, and rise by at most 8 from a pixel to the next.
        seen: (r, c) zeros; at a pixel with an emptier left neighbour a bit for each level between them, set when
            traced.
        starts: (n, 5) gets row, column, level, offset into `chain` and number of directions.
        chain: gets the directions.

    Returns:
        Number of borders and of directions; where either is larger than its array, nothing beyond was written.
    """
    count, used = 0, 0
    start = starts[0, :3].copy()
    for r in range(index.shape[0]):
        before, c = 0, end_of_run(index[r], 0, 0)
        while c < index.shape[1]:
            here = int(index[r, c])
            # between these two pixels the borders of all levels in between pass; each is traced once
            for level in range(before + 1, here + 1):
                if seen[r, c] >> (level - before - 1) & 1:
                    continue
                start[0], start[1], start[2] = r, c, level
                # where `chain` is full, tracing goes on without writing, so that the caller learns how much room it
                # needs
                length = _trace_one(index, seen, start, chain[min(used, len(chain)) :])
                if count < len(starts):
                    starts[count, 0], starts[count, 1], starts[count, 2] = r, c, level
                    starts[count, 3], starts[count, 4] = used, length
                count += 1
                used += length
            before, c = here, end_of_run(index[r], c, here)
    return count, used
