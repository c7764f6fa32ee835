# mypy: allow-untyped-defs
"""Compiled inner loop for runs between rings: the parts of paths that a cutter along other paths does not come over."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ...geometry.kernels import LEAF, box_distance, enlarged, nearest, point_distance, query_box
from ...geometry.offset.offset_kernels import blocked_parts
from ...geometry.sort_kernels import order_of
from ..coverage.uncut_kernels import beyond

SHORTEST = 1e-5  # mm; what is shorter is rounding


@kernel("void(float64[:, ::1], int64, float64[::1])")
def _shape(rows, k, shape):
    """Write row k as `offset_kernels` takes shapes: a line (0, ax, ay, bx, by) or an arc (1, cx, cy, radius, start,
    sweep).
    """
    if rows[k, 7] == 0.0:
        shape[0] = 0.0
        shape[1], shape[2], shape[3], shape[4] = rows[k, 0], rows[k, 1], rows[k, 2], rows[k, 3]
        shape[5] = 0.0
        return
    shape[0], shape[1], shape[2], shape[3] = 1.0, rows[k, 4], rows[k, 5], rows[k, 6]
    shape[4] = math.atan2(rows[k, 1] - rows[k, 5], rows[k, 0] - rows[k, 4])
    turn = math.atan2(rows[k, 3] - rows[k, 5], rows[k, 2] - rows[k, 4]) - shape[4]
    shape[5] = (turn * rows[k, 7]) % (2 * math.pi) * rows[k, 7]


@kernel(
    "Tuple((float64[:, ::1], int64))(float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64[:, ::1], "
    "float64)"
)
def uncovered(rows, paths, order, nodes, around, reach):
    """Return (parts (m, 3): row and fractions from and to, in order; how many) that are farther than `reach` from some
    paths.

    Args:
        rows: (n, 8); each sweeps less than pi.
        paths, order, nodes, around: rows that a cutter follows, their tree and their boxes.
        reach: mm; a little more than the radius of the cutter, since parallels just that far apart do not cross its
            edge in one place.
    """
    found, count = np.empty((2 * len(rows) + 16, 3)), 0
    shape, box, limits = np.empty(6), np.empty(4), np.empty(6)
    near, starts = np.empty(len(paths), np.int64), np.empty(0)
    limits[0], limits[1], limits[2], limits[3] = reach, 0.0, 0.0, 1.0
    for k in range(len(rows)):
        _shape(rows, k, shape)
        wide, length = reach, math.hypot(rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1])
        if shape[0] == 1.0:  # an arc is within its sagitta of the chord's box
            wide += shape[3] * (1 - math.cos(min(abs(shape[5]) / 2, math.pi)))
            length = shape[3] * abs(shape[5])
        box[0], box[1] = min(rows[k, 0], rows[k, 2]) - wide, min(rows[k, 1], rows[k, 3]) - wide
        box[2], box[3] = max(rows[k, 0], rows[k, 2]) + wide, max(rows[k, 1], rows[k, 3]) + wide
        limits[4], limits[5] = 0.0, length
        least = SHORTEST / max(length, SHORTEST)
        blocked, blocks = blocked_parts(shape, paths, near, query_box(order, nodes, around, box, near), limits)
        if count + blocks + 1 > len(found):
            found = enlarged(found, count, 2 * len(found) + blocks)
        at = 0.0
        if blocks > len(starts):
            starts = np.empty(2 * blocks)
        for b in range(blocks):
            starts[b] = blocked[b, 0]
        for b in order_of(starts[:blocks]):
            if blocked[b, 0] - at > least:
                found[count, 0], found[count, 1], found[count, 2] = k, at, blocked[b, 0]
                count += 1
            at = max(at, blocked[b, 1])
        if 1.0 - at > least:
            found[count, 0], found[count, 1], found[count, 2] = k, at, 1.0
            count += 1
    return found, count


_TREE = "float64[:, ::1], int64[::1], float64[:, ::1]"


@kernel(f"int64({_TREE}, float64, float64, float64, int64[::1], int64)")
def _collected(rows, order, nodes, x, y, limit, listed, stop):
    """Write into `listed`, from `stop` on, the rows nearer to a point than `limit`; return where they end."""
    leaves = (len(nodes) + 1) // 2
    stack = np.empty(64, np.int64)
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if box_distance(nodes, k, x, y) >= limit:
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        for place in range(first, min(first + LEAF, len(order))):
            if point_distance(rows, order[place], x, y) < limit:
                listed[stop] = order[place]
                stop += 1
    return stop


@kernel(
    "Tuple((float64, int64))(float64[:, ::1], int64[::1], float64[::1], int64, int64, float64, float64, float64)",
    counts=False,
)
def _nearest_listed(rows, listed, away, first, stop, x, y, limit):
    """Return (distance, row) of the listed row nearest to a point, (limit, -1) when none is nearer; write how far each
    is.
    """
    best, row = limit, -1
    for k in range(first, stop):
        away[k] = point_distance(rows, listed[k], x, y)
        if away[k] < best:
            best, row = away[k], listed[k]
    return best, row


@kernel("int64(int64[::1], float64[::1], int64, int64, float64, int64)", counts=False)
def _kept(listed, away, first, stop, limit, to):
    """Write those of a list that are nearer than `limit` to where `to` is; return where they end."""
    for k in range(first, stop):
        if away[k] < limit:
            listed[to] = listed[k]
            to += 1
    return to


@kernel(
    f"Tuple((float64[:, ::1], int64))({_TREE}, {_TREE}, {_TREE}, float64[::1], float64[::1], float64[::1], float64[:, "
    "::1])"
)
def squares_beyond(
    rows, order, nodes, gaps, gap_order, gap_nodes, path, path_order, path_nodes, radii, wide, limits, squares
):
    """Return (squares (n, 4): x, y, half side, nearest gap; how many) that hold all that a path leaves beyond the gaps
    of a level.

    A point beyond a gap is no farther from it than it is inside of the level. The trees are asked for the first squares
    alone. What is nearest to a point of a square is no farther from the centre than twice half the diagonal more than
    what is nearest to that; so each square hands on to its quarters a list of the few rows that matter to them.

    Args:
        rows...: the walls. gaps...: parts of the level. path...: what is cut. radii, wide: of its cutter, by row and by
            node; one radius.
        limits: distance of the level from the walls, half side of the smallest squares.
        squares: (m, 3) to begin with, of one size.
    """
    found, count = np.empty((256, 4)), 0
    depths = 2
    if len(squares) > 0:
        depths += math.ceil(math.log2(max(squares[0, 2] / limits[1], 1.0)))
    stack = np.empty((4 * depths + 4, 4))  # x, y, half side, how often the first square was quartered
    listed = np.empty(depths * (len(rows) + len(gaps) + len(path)), np.int64)
    away = np.empty(len(listed))
    ends = np.zeros((depths + 1, 4), np.int64)  # of the lists of walls, gaps and path of each depth
    for first in range(len(squares)):
        stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = (
            squares[first, 0],
            squares[first, 1],
            squares[first, 2],
            0.0,
        )
        top = 1
        while top > 0:
            top -= 1
            x, y, half, depth = stack[top, 0], stack[top, 1], stack[top, 2], int(stack[top, 3])
            far = half * math.sqrt(2.0)
            a, b, c, d = ends[depth, 0], ends[depth, 1], ends[depth, 2], ends[depth, 3]
            # first: it decides most squares, and is soon found
            if depth == 0:
                cut = beyond(path, radii, path_order, path_nodes, wide, x, y, (-far, far))
            else:
                away_from, at = _nearest_listed(path, listed, away, c, d, x, y, radii[0] + far)
                cut = far if at < 0 else away_from - radii[0]  # to the last bit: it is compared with that
            if cut <= -far:
                continue
            if depth == 0:
                wall = nearest(rows, order, nodes, x, y, math.inf)[0]
            else:
                wall = _nearest_listed(rows, listed, away, a, b, x, y, math.inf)[0]
            inside = wall - limits[0]
            if inside + far < 0.0:
                continue
            limit = max(inside, 0.0) + 2 * far
            if depth == 0:
                near, gap = nearest(gaps, gap_order, gap_nodes, x, y, limit)
            else:
                near, gap = _nearest_listed(gaps, listed, away, b, c, x, y, limit)
            if gap < 0:
                continue
            if half <= limits[1] or (half <= 4 * limits[1] and cut >= far and inside >= far):
                if count == len(found):
                    found = enlarged(found, count, 2 * count)
                found[count, 0], found[count, 1], found[count, 2], found[count, 3] = x, y, half, gap
                count += 1
                continue
            wall, near, reach = wall + 2 * far + SHORTEST, near + 2 * far + SHORTEST, radii[0] + far + SHORTEST
            if depth == 0:
                e = _collected(rows, order, nodes, x, y, wall, listed, 0)
                f = _collected(gaps, gap_order, gap_nodes, x, y, near, listed, e)
                g = _collected(path, path_order, path_nodes, x, y, reach, listed, f)
                ends[1, 0] = 0
            else:
                e = _kept(listed, away, a, b, wall, d)
                f = _kept(listed, away, b, c, near, e)
                g = _kept(listed, away, c, d, reach, f)
                ends[depth + 1, 0] = d
            ends[depth + 1, 1], ends[depth + 1, 2], ends[depth + 1, 3] = e, f, g
            for k in range(4):
                stack[top, 0], stack[top, 1] = x + half * (k % 2 - 0.5), y + half * (k // 2 - 0.5)
                stack[top, 2], stack[top, 3] = half / 2, depth + 1.0
                top += 1
    return found, count


@kernel("Tuple((float64[:, ::1], int64[::1]))(float64[:, ::1], int64[::1], int64)")
def outermost(squares, group, groups):
    """Return (corners (m, 2), their groups (m,)): of each group of squares those among which its hull's corners are.

    Squares that were quartered lie on one lattice, so their corners lie in rows; of a row only the two ends can be
    corners of the hull. There are many thousand times as many squares as rows where little is cut between rings.

    Args:
        squares: (n, 4) x, y, half side, and what does not matter here. group: (n,) of each, 0 ... groups - 1.
    """
    step = math.inf
    for k in range(len(squares)):
        step = min(step, 2 * squares[k, 2])
    low, high = np.full(groups, 2**62), np.full(groups, -(2**62))
    for k in range(len(squares)):
        y, half, g = squares[k, 1], squares[k, 2], group[k]
        low[g], high[g] = min(low[g], round((y - half) / step)), max(high[g], round((y + half) / step))
    first = np.zeros(groups + 1, np.int64)
    for g in range(groups):
        first[g + 1] = first[g] + max(high[g] - low[g] + 1, 0)
    ends = np.empty((first[groups], 4))  # left end's x and y, right end's
    ends[:, 0], ends[:, 2] = math.inf, -math.inf
    for k in range(len(squares)):
        x, half, g = squares[k, 0], squares[k, 2], group[k]
        for side in (-half, half):
            y = squares[k, 1] + side
            row = first[g] + round(y / step) - low[g]
            if x - half < ends[row, 0]:
                ends[row, 0], ends[row, 1] = x - half, y
            if x + half > ends[row, 2]:
                ends[row, 2], ends[row, 3] = x + half, y
    corners, owner, count = np.empty((2 * len(ends), 2)), np.empty(2 * len(ends), np.int64), 0
    for g in range(groups):
        for row in range(first[g], first[g + 1]):
            if ends[row, 0] <= ends[row, 2]:  # else no square's side is in it
                corners[count, 0], corners[count, 1] = ends[row, 0], ends[row, 1]
                corners[count + 1, 0], corners[count + 1, 1] = ends[row, 2], ends[row, 3]
                owner[count], owner[count + 1] = g, g
                count += 2
    return corners[:count].copy(), owner[:count].copy()


@kernel("void(float64[:, ::1], int64, int64, float64, float64, float64, float64, float64, float64[::1])")
def _tip(points, first, last, x, y, to_x, to_y, reach, way):
    """Write length and end of the shortest straight way from a place towards another that comes within `reach` of all
    points.
    """
    way[0], way[1], way[2] = math.inf, x, y
    ux, uy = to_x - x, to_y - y
    size = math.hypot(ux, uy)
    if size == 0.0:
        return
    ux, uy, length = ux / size, uy / size, 0.0
    for i in range(first, last):
        px, py = points[i, 0] - x, points[i, 1] - y
        along, off = px * ux + py * uy, py * ux - px * uy
        spare = reach * reach - off * off
        if spare < 0.0 or (along < 0.0 and along * along > spare):
            return
        length = max(length, along - math.sqrt(spare))
    way[0], way[1], way[2] = length, x + ux * length, y + uy * length


@kernel("void(float64[:, ::1], int64[::1], float64[:, :, ::1], float64, float64[:, :, ::1])")
def tips(points, first, starts, reach, ways):
    """Write the shortest straight ways that come within a distance of all points of a set, from places towards its
    middle and its far end.

    Args:
        points: (m, 2) of all sets; those of set k are first[k] ... first[k + 1] - 1.
        starts: (n, s, 2) places for each set. reach: mm.
        ways: (n, 2 s, 3) length of each way and where it ends, mm; infinite where none does.
    """
    for k in range(len(starts)):
        a, b = first[k], first[k + 1]
        low_x, low_y, high_x, high_y = math.inf, math.inf, -math.inf, -math.inf
        for i in range(a, b):
            low_x, high_x = min(low_x, points[i, 0]), max(high_x, points[i, 0])
            low_y, high_y = min(low_y, points[i, 1]), max(high_y, points[i, 1])
        for s in range(starts.shape[1]):
            x, y = starts[k, s, 0], starts[k, s, 1]
            far = a
            for i in range(a + 1, b):
                if math.hypot(points[i, 0] - x, points[i, 1] - y) > math.hypot(points[far, 0] - x, points[far, 1] - y):
                    far = i
            _tip(points, a, b, x, y, (low_x + high_x) / 2, (low_y + high_y) / 2, reach, ways[k, 2 * s])
            _tip(points, a, b, x, y, points[far, 0], points[far, 1], reach, ways[k, 2 * s + 1])
