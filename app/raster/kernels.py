# mypy: allow-untyped-defs
"""Compiled loops of the display memory, in image coordinates: u = column, v = row, downwards; px (r, c) spans [c, c+1)
x [r, r+1).

Codes are those of `PixelCode`, written as numbers. Rows of lines and arcs are (u0, v0, u1, v1, cu, cv, r, turn) with
turn 0 for a line and the sign of the cross product (u, v) along an arc, which sweeps less than pi.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel

END = 8
"""Mark after the last direction of a chain."""


@kernel("void(uint8[:, ::1], uint8[::1], int64, float64)")
def _cross(plane, left, row, u):
    """Note one crossing of a row's centre line: odd counts are code 2, even ones code 3 (R)."""
    if u < 0.0:
        left[row] ^= 1
    elif u < plane.shape[1]:
        c = int(u)
        # two crossings in one pixel are none for what lies to the right of it
        plane[row, c] = 3 if plane[row, c] == 2 else 2


@kernel("void(uint8[:, ::1], float64, float64)")
def _touch(plane, u, v):
    """Draw a contour pixel that has no crossing (yet): zero is even."""
    if 0.0 <= u < plane.shape[1] and 0.0 <= v < plane.shape[0]:
        r, c = int(v), int(u)
        if plane[r, c] == 0:
            plane[r, c] = 3


@kernel("UniTuple(int64, 2)(float64, float64, int64)")
def _centre_lines(a, b, count):
    """Return the range [first, stop) of centre lines i + 0.5 with min < i + 0.5 <= max, within the picture."""
    # bounded first: a contour far off the picture must not become a loop of that many rows
    low = math.floor(min(max(min(a, b), -1.0), count + 1.0) - 0.5) + 1
    high = math.floor(min(max(max(a, b), -1.0), count + 1.0) - 0.5) + 1
    return max(int(low), 0), min(int(high), count)


@kernel("void(uint8[:, ::1], uint8[::1], float64, float64, float64, float64)")
def _draw_line(plane, left, u0, v0, u1, v1):
    first, stop = _centre_lines(v0, v1, plane.shape[0])
    for j in range(first, stop):
        # clamped to the line's own ends, which rounding may leave by a bit
        u = u0 + (j + 0.5 - v0) / (v1 - v0) * (u1 - u0)
        _cross(plane, left, j, min(max(u, min(u0, u1)), max(u0, u1)))
    first, stop = _centre_lines(u0, u1, plane.shape[1])
    for i in range(first, stop):
        v = v0 + (i + 0.5 - u0) / (u1 - u0) * (v1 - v0)
        _touch(plane, i + 0.5, min(max(v, min(v0, v1)), max(v0, v1)))


@kernel("float64(float64, float64, float64, float64, float64)")
def _other(offset, r, centre, a, b):
    """Return the coordinate of an arc's monotone piece from a to b at `offset` from the centre along the other axis."""
    half = math.sqrt(max(r * r - offset * offset, 0.0))
    value = centre + half if (a - centre) + (b - centre) > 0.0 else centre - half
    return min(max(value, min(a, b)), max(a, b))


@kernel("void(uint8[:, ::1], uint8[::1], float64[::1], float64[::1], float64[::1])")
def _draw_piece(plane, left, circle, a, b):
    """Draw a piece of an arc that lies in one quadrant of its circle (cu, cv, r)."""
    cu, cv, r = circle[0], circle[1], circle[2]
    first, stop = _centre_lines(a[1], b[1], plane.shape[0])
    for j in range(first, stop):
        _cross(plane, left, j, _other(j + 0.5 - cv, r, cu, a[0], b[0]))
    first, stop = _centre_lines(a[0], b[0], plane.shape[1])
    for i in range(first, stop):
        _touch(plane, i + 0.5, _other(i + 0.5 - cu, r, cv, a[1], b[1]))


@kernel("int64(float64[::1], float64[:, ::1])")
def _quadrant_ends(row, ends):
    """Write start, changes of quadrant and end of an arc into ends (6, 2), in its direction; return how many there
    are.
    """
    cu, cv, r, turn = row[4], row[5], row[6], row[7]
    quarter = math.pi / 2
    start = turn * math.atan2(row[1] - cv, row[0] - cu)
    # counted along the arc's own sense, so that it lies in [0, 2 pi) for both
    sweep = (turn * math.atan2(row[3] - cv, row[2] - cu) - start) % math.tau
    ends[0, 0], ends[0, 1] = row[0], row[1]
    count = 1
    k = math.floor(start / quarter) + 1
    while k * quarter < start + sweep and count < 5:
        side = int(k % 4)
        ends[count, 0] = cu + (r if side == 0 else -r if side == 2 else 0.0)
        ends[count, 1] = cv + turn * (r if side == 1 else -r if side == 3 else 0.0)
        count += 1
        k += 1
    ends[count, 0], ends[count, 1] = row[2], row[3]
    return count + 1


@kernel("void(float64[:, ::1], uint8[:, ::1], uint8[::1])")
def draw(rows, plane, left):
    """Draw closed contours (n, 8) into an empty plane as codes 2 and 3.

    A line or arc crosses the centre line of every row with min(v) < row + 0.5 <= max(v), which is the half-open rule
    y0 <= yc < y1 in part coordinates; horizontal lines cross none. Pixels in which a column's centre line is crossed
    (grid-intersect quantisation, H. Freeman 1961) make the drawn line 8-connected.

    Args:
        rows: lines and arcs in image coordinates, see the module.
        plane: (r, c) zeros; gets the codes.
        left: (r,) zeros; gets 1 where an odd number of crossings lies left of the picture.
    """
    ends = np.empty((6, 2))
    for n in range(len(rows)):
        row = rows[n]
        _touch(plane, row[0], row[1])
        if row[7] == 0.0:
            _draw_line(plane, left, row[0], row[1], row[2], row[3])
        else:
            count = _quadrant_ends(row, ends)
            for k in range(1, count):
                _draw_piece(plane, left, row[4:7], ends[k - 1], ends[k])


@kernel("void(uint8[:, ::1], uint64[:, ::1], uint8[::1])")
def scan(plane, words, left):
    """Steps 207 and 208: count the 2s along every row; an empty pixel after an odd number of them gets code 4 (I).

    Args:
        plane: (r, 8 c) codes.
        words: (r, c) the same memory, eight pixels at a time: most of a picture is empty.
        left: (r,) 1 where an odd number of crossings lies left of the picture.
    """
    for j in range(plane.shape[0]):
        inside = left[j]
        for k in range(words.shape[1]):
            if words[j, k] == 0:
                if inside == 1:
                    # eight empty pixels inside a contour at a time
                    words[j, k] = 0x0404040404040404
                continue
            for i in range(8 * k, 8 * k + 8):
                code = plane[j, i]
                if code == 2:
                    inside ^= 1
                elif code == 0 and inside == 1:
                    plane[j, i] = 4


@kernel("int64(uint8[:, ::1], int64, int64, int64)")
def _next_direction(plane, r, c, first):
    """Return the first of the eight directions, counter-clockwise from `first`, with a drawn pixel, or -1."""
    for k in range(8):
        d = (first + k) % 8
        i = c + (1 if d in (0, 1, 7) else -1 if d in (3, 4, 5) else 0)
        j = r - (1 if d in (1, 2, 3) else -1 if d in (5, 6, 7) else 0)
        if 0 <= j < plane.shape[0] and 0 <= i < plane.shape[1] and plane[j, i] != 0:
            return d
    return -1


@kernel("int64(uint8[:, ::1], int64, int64, uint8[::1])")
def _trace_one(plane, r, c, chain):
    """Trace the border to whose left pixel (r, c) lies; mark it 2; return how many directions were written, END
    included.
    """
    plane[r, c] = 2
    first = _next_direction(plane, r, c, 4)
    d, j, i, length = first, r, c, 0
    while d >= 0:
        chain[length] = d
        length += 1
        i += 1 if d in (0, 1, 7) else -1 if d in (3, 4, 5) else 0
        j -= 1 if d in (1, 2, 3) else -1 if d in (5, 6, 7) else 0
        plane[j, i] = 2
        # two directions before the incoming one, the rule of step 202; see `trace`
        d = _next_direction(plane, j, i, (d + 6) % 8)
        if j == r and i == c and d == first:
            break
    chain[length] = END
    return length + 1


@kernel("int64(uint8[:, ::1], int64[:, ::1], uint8[::1])")
def trace(plane, starts, chain):
    """Steps 202 and 203: trace all borders of the drawn pixels and mark them 2.

    Start pixels are found in raster order: a 1 whose left neighbour is 0. From a traced pixel the search begins two
    directions before the incoming one and turns counter-clockwise (directions 0 = right, 2 = up, ...): the empty side
    stays on the right. (The other sense of "two to the left" meets the way back first and never leaves the start.)
    Every (pixel, direction) belongs to one border, so nothing is walked twice.

    Args:
        plane: codes 0 and 1; traced pixels become 2, those that an 8-connected step cuts off stay 1.
        starts: (n, 4) gets row, column, offset into `chain` and number of directions; n >= number of 1s.
        chain: gets directions, each border closed by END; 9 x number of 1s suffice.

    Returns:
        Number of borders.
    """
    count, used = 0, 0
    for r in range(plane.shape[0]):
        for c in range(plane.shape[1]):
            if plane[r, c] == 1 and (c == 0 or plane[r, c - 1] == 0):
                length = _trace_one(plane, r, c, chain[used:])
                starts[count, 0], starts[count, 1], starts[count, 2], starts[count, 3] = r, c, used, length - 1
                used += length
                count += 1
    return count
