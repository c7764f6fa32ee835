# mypy: allow-untyped-defs
"""Compiled inner loops of rest machining: what paths have left, which pieces of rings cut it, and which of these are
enough.

Paths are rows, and a tree of boxes (`app.geometry.kernels`) over those of each cutter. The depth of a point in
the metal that paths have left is its distance from them less the radius: it changes by no more than the way gone.
"""

from __future__ import annotations

import heapq
import math

import numpy as np

from ..core.jit import kernel
from ..geometry.kernels import LEAF, box_distance, nearest_from, point_distance

_ROUNDING = 1e-9
"""mm; more than a distance is off by."""


@kernel(
    "float64(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64, float64, float64, float64, "
    "int64[::1])"
)
def _depth_between(rows, order, nodes, cutters, x, y, enough, limit, near):
    """Return how deep a point lies in what paths have left, mm: the least (distance - radius) of all rows, at most
    `limit`; or some depth no more than `enough`, mm, where there is one.

    Args:
        order, nodes: the trees of all cutters, one behind the other.
        cutters: (n, 3) radius, mm, and where the order and the nodes of the next one begin.
        near: of each cutter a row that may be near, -1 = none is known; those that are found are written.
    """
    best, o, n = limit, 0, 0
    for k in range(len(cutters)):
        radius, o1, n1 = cutters[k, 0], int(cutters[k, 1]), int(cutters[k, 2])
        away, row = nearest_from(rows, order[o:o1], nodes[n:n1], x, y, enough + radius, best + radius, near[k])
        best = away - radius
        near[k] = row if row >= 0 else near[k]
        if best <= enough:
            break
        o, n = o1, n1
    return best


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, float64[::1])")
def depths_left(rows, order, nodes, cutters, points, limit, out):
    """Write how deep each point (m, 2) lies in what paths have left, see `_depth_between`."""
    near = np.full(len(cutters), -1, np.int64)
    for k in range(len(points)):
        out[k] = _depth_between(rows, order, nodes, cutters, points[k, 0], points[k, 1], -math.inf, limit, near)


@kernel("float64(float64)", counts=False)
def _beyond(limit):
    """Return a distance by so little greater that only rounding is between them."""
    return limit * (1 + 1e-12) + 1e-300


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, boolean[::1])")
def hold(rows, order, nodes, cutters, points, around, out):
    """Write for each point (m, 2) whether all within `around` of it, mm, lies in what a cutter along some one row has
    cut.
    """
    near = np.full(len(cutters), -1, np.int64)
    for i in range(len(points)):
        out[i] = False
        o, n = 0, 0
        for k in range(len(cutters)):
            limit, o1, n1 = cutters[k, 0] - around, int(cutters[k, 1]), int(cutters[k, 2])
            if limit >= 0.0:
                # the first one that is near enough ends the search
                away, row = nearest_from(
                    rows, order[o:o1], nodes[n:n1], points[i, 0], points[i, 1], limit, _beyond(limit), near[k]
                )
                near[k] = row if row >= 0 else near[k]
                if row >= 0 and away <= limit:
                    out[i] = True
                    break
            o, n = o1, n1


@kernel("boolean(float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], float64)")
def _within_one(rows, order, nodes, chunk, limit):
    """Return whether a short row, given by start, middle and end, stays within `limit` of some one row."""
    leaves = (len(nodes) + 1) // 2
    ax, ay, mx, my, bx, by = chunk[0], chunk[1], chunk[2], chunk[3], chunk[4], chunk[5]
    half = max(math.hypot(ax - mx, ay - my), math.hypot(bx - mx, by - my))
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if box_distance(nodes, k, mx, my) > limit:
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            j = order[place]
            middle = point_distance(rows, j, mx, my)
            if middle > limit:
                continue
            # what lies within `limit` of a row that hardly bends is convex, so three points of a short chunk speak for
            # all of it
            if middle + half <= limit or (
                point_distance(rows, j, ax, ay) <= limit and point_distance(rows, j, bx, by) <= limit
            ):
                return True
    return False


@kernel(
    "void(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1], boolean[::1])"
)
def in_air(rows, order, nodes, cutters, chunks, cutter, out):
    """Write for each short row, given by its start, middle and end (m, 6), whether a cutter stays within what some one
    row has cut.

    Args:
        cutter: its radius, and by how much its rim may go beyond what is cut, mm.
    """
    for i in range(len(chunks)):
        out[i] = False
        o, n = 0, 0
        for k in range(len(cutters)):
            limit, o1, n1 = cutters[k, 0] - cutter[0] + cutter[1], int(cutters[k, 1]), int(cutters[k, 2])
            if limit >= 0.0 and _within_one(rows, order[o:o1], nodes[n:n1], chunks[i], limit):
                out[i] = True
                break
            o, n = o1, n1


@kernel(
    "int64(float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[:, "
    "::1], float64[::1], float64[:, ::1], float64[::1], float64[:, ::1])"
)
def left_cells(rows, order, nodes, cutters, bound, bound_order, bound_nodes, rule, squares, sizes, out):
    """Write the centres of the cells in which metal is left; return how many.

    A cell is looked into by halves until a point is found that is left by `least` all round, or none can be.

    Args:
        bound, bound_order, bound_nodes, rule: rows and (base, sign): only points with base + sign * distance from them
            > 0 count.
        squares: centres (n, 2) of the squares that are looked through.
        sizes: half sides of squares and of cells, mm, and `least`, mm.
        out: room for all cells of all squares.
    """
    half0, cell, least = sizes[0], sizes[1], sizes[2]
    stack = np.empty((256, 3))
    near, beside = np.full(len(cutters), -1, np.int64), -1
    count = 0
    for s in range(len(squares)):
        stack[0, 0], stack[0, 1], stack[0, 2] = squares[s, 0], squares[s, 1], half0
        top = 1
        cell_x, cell_y, found = math.inf, math.inf, True
        while top > 0:
            top -= 1
            x, y, half = stack[top, 0], stack[top, 1], stack[top, 2]
            # halves are exact but for rounding; of one cell the first point that is found is enough
            if half <= cell * 1.001:
                if half >= cell * 0.999:
                    cell_x, cell_y, found = x, y, False
                elif found:
                    continue
            q = half * math.sqrt(2.0)
            depth = _depth_between(rows, order, nodes, cutters, x, y, least - q - _ROUNDING, least + _ROUNDING, near)
            if depth + q < least:
                continue
            # of the distance, too, no more is asked than what decides: is it less than least - q, or least at least?
            low, high = least - rule[0] - q, least - rule[0]
            if rule[1] < 0.0:
                low, high = -high, -low
            away, row = nearest_from(bound, bound_order, bound_nodes, x, y, low - _ROUNDING, high + _ROUNDING, beside)
            beside = row if row >= 0 else beside
            depth = min(depth, rule[0] + rule[1] * away)
            if depth + q < least:
                continue
            if half <= cell * 1.001 and (depth >= least or q < least / 4):
                out[count, 0], out[count, 1] = cell_x, cell_y
                count += 1
                found = True
                continue
            half /= 2
            for k in range(4):
                stack[top, 0] = x + (half if k % 2 else -half)
                stack[top, 1] = y + (half if k // 2 else -half)
                stack[top, 2] = half
                top += 1
    return count


_CELLS = "float64[:, ::1], float64[::1], int64[:, ::1], float64[::1]"


@kernel(f"int64(float64[:, ::1], int64, {_CELLS}, int32[::1], boolean)")
def _seen(chunks, i, cells, need, starts, grid, found, kept):
    """Return how many cells a cutter along row i clears.

    Args:
        need: how near the row must come to each cell, mm.
        starts, grid: cells are sorted by buckets: first of each bucket (rows, columns + 1), and (x0, y0, bucket's side,
            largest need).
        found, kept: where they are written to, if they are.
    """
    most, side = grid[3] + _ROUNDING, grid[2]
    low_x, high_x = min(chunks[i, 0], chunks[i, 2]), max(chunks[i, 0], chunks[i, 2])
    low_y, high_y = min(chunks[i, 1], chunks[i, 3]), max(chunks[i, 1], chunks[i, 3])
    if chunks[i, 7] != 0.0:
        # an arc below a half turn stays within this of its chord
        half = math.hypot(chunks[i, 2] - chunks[i, 0], chunks[i, 3] - chunks[i, 1]) / 2.0
        most += chunks[i, 6] - math.sqrt(max(chunks[i, 6] * chunks[i, 6] - half * half, 0.0))
    i0 = max(0, math.floor((low_y - most - grid[1]) / side))
    i1 = min(starts.shape[0] - 1, math.floor((high_y + most - grid[1]) / side))
    count = 0
    for row in range(i0, i1 + 1):
        # cells of this row of buckets are above or below by so much at least, and no farther aside than the rest of it
        off = max(low_y - (grid[1] + (row + 1) * side), grid[1] + row * side - high_y, _ROUNDING) - _ROUNDING
        wide = math.sqrt(max(most * most - off * off, 0.0)) + _ROUNDING
        j0 = max(0, math.floor((low_x - wide - grid[0]) / side))
        j1 = min(starts.shape[1] - 2, math.floor((high_x + wide - grid[0]) / side))
        if j1 < j0:
            continue
        for c in range(starts[row, j0], starts[row, j1 + 1]):
            if point_distance(chunks, i, cells[c, 0], cells[c, 1]) <= need[c]:
                if kept:
                    found[count] = c
                count += 1
    return count


@kernel(f"void(float64[:, ::1], {_CELLS}, int64[::1])")
def count_seen(chunks, cells, need, starts, grid, out):
    """Write how many cells each row (n, 8) clears; args as `_seen`."""
    none = np.empty(0, np.int32)
    for i in range(len(chunks)):
        out[i] = _seen(chunks, i, cells, need, starts, grid, none, False)


@kernel(f"void(float64[:, ::1], {_CELLS}, int64[::1], int32[::1])")
def list_seen(chunks, cells, need, starts, grid, first, out):
    """Write the cells that each row (n, 8) clears, those of row i from out[first[i]] on; args as `_seen`."""
    for i in range(len(chunks)):
        _seen(chunks, i, cells, need, starts, grid, out[first[i] :], True)


@kernel(
    "Tuple((float64, int64, int64))(float64[::1], int64[::1], float64, int64[::1], int32[::1], boolean[::1], "
    "int64[::1])"
)
def _worth(size, span, start, first, seen, cleared, seen_by):
    """Return (cells that a span clears anew per mm, first, stop), without the ends that clear nothing by themselves.

    Args:
        span: first and last row + 1.
        seen_by: zero for each cell, and is so afterwards.
    """
    begin, stop = span[0], span[1]
    gain = 0
    for k in range(first[begin], first[stop]):
        c = seen[k]
        if not cleared[c]:
            gain += seen_by[c] == 0
            seen_by[c] += 1
    # rows at either end that clear nothing which no other row of the span clears go
    for side in range(2):
        while stop - begin > 1:
            i, needed = begin if side == 0 else stop - 1, False
            for k in range(first[i], first[i + 1]):
                if not cleared[seen[k]] and seen_by[seen[k]] == 1:
                    needed = True
                    break
            if needed:
                break
            for k in range(first[i], first[i + 1]):
                if not cleared[seen[k]]:
                    seen_by[seen[k]] -= 1
            if side == 0:
                begin += 1
            else:
                stop -= 1
    length = 0.0
    for i in range(begin, stop):
        length += size[i]
    for k in range(first[begin], first[stop]):
        seen_by[seen[k]] = 0
    return gain / (length + start), begin, stop


@kernel("int64(float64[::1], int64[:, ::1], float64, int64[::1], int32[::1], int64, int64[:, ::1])")
def choose(size, spans, start, first, seen, cells, out):
    """Write (first row, last + 1) of spans that together clear all cells, those first that clear most per mm; return
    how many.

    Args:
        size: lengths of short rows, mm.
        spans: (n, 2) first and last + 1 row of each.
        start: the length that a span costs besides its own, mm.
        first, seen: the cells that each row clears, as `list_seen` writes them; (rows + 1,) and all of them.
        cells: how many there are.
        out: (n, 2).
    """
    cleared, seen_by = np.zeros(cells, np.bool_), np.zeros(cells, np.int64)
    heap = [(-1.0, 0)]
    heap.pop()
    for s in range(len(spans)):
        worth = _worth(size, spans[s], start, first, seen, cleared, seen_by)[0]
        if worth > 0.0:
            heapq.heappush(heap, (-worth, s))
    count = 0
    while len(heap) > 0:
        best = heapq.heappop(heap)[1]
        worth, begin, stop = _worth(size, spans[best], start, first, seen, cleared, seen_by)
        if worth <= 0.0:
            continue
        # worths fall as cells are cleared, so one that is still the best when it is reckoned anew is taken
        if len(heap) > 0 and worth < -heap[0][0] * 0.999:
            heapq.heappush(heap, (-worth, best))
            continue
        out[count, 0], out[count, 1] = begin, stop
        count += 1
        for k in range(first[begin], first[stop]):
            cleared[seen[k]] = True
    return count
