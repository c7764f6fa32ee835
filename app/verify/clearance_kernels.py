# mypy: allow-untyped-defs
"""Compiled: the exact least distance of pairs of lines and arcs, see `app.verify.verdict`.

A row is start, end, centre, radius and turn (0 a line, +1 or -1 an arc); an arc that ends where it begins is a circle.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel
from ..geometry.kernels import DEPTH, INF, LEAF, point_distance

_ROW, _ROWS, _FOUND = "float64[:]", "float64[:, ::1]", "float64[::1]"

_ON = 1e-12
"""Radians by which a direction may miss an arc's end and still count as on it."""

_ROUNDING = 1e-12
"""mm; more than two boxes' distance is off by."""

_MOST = 8
"""Places on the first curve one of which is the nearest."""


@kernel(f"UniTuple(float64, 2)({_ROW}, float64, float64)", counts=False)
def _on_line(row, x, y):
    """Return the point of the straight way between a row's ends that is nearest to a place."""
    dx, dy = row[2] - row[0], row[3] - row[1]
    square = dx * dx + dy * dy
    part = ((x - row[0]) * dx + (y - row[1]) * dy) / (square if square > 0.0 else 1.0)
    if part >= 1.0:
        return row[2], row[3]
    part = max(part, 0.0)
    return row[0] + dx * part, row[1] + dy * part


@kernel(f"UniTuple(float64, 2)({_ROW}, float64, float64)", counts=False)
def _on_arc(row, x, y):
    """Return the point of an arc that is nearest to a place."""
    dx, dy = x - row[4], y - row[5]
    length, turn = math.hypot(dx, dy), row[7]
    if length > 0.0:
        a = math.atan2(row[1] - row[5], row[0] - row[4])
        b = math.atan2(row[3] - row[5], row[2] - row[4])
        whole = row[0] == row[2] and row[1] == row[3]
        sweep = 2.0 * math.pi if whole else (turn * (b - a)) % (2.0 * math.pi)
        if (turn * (math.atan2(dy, dx) - a) + _ON) % (2.0 * math.pi) <= sweep + 2.0 * _ON:
            return row[4] + dx / length * row[6], row[5] + dy / length * row[6]
    if math.hypot(row[0] - x, row[1] - y) <= math.hypot(row[2] - x, row[3] - y):
        return row[0], row[1]
    return row[2], row[3]


@kernel(f"UniTuple(float64, 2)({_ROW}, float64, float64)", counts=False)
def _on(row, x, y):
    """Return the point of a row that is nearest to a place; of none, its start."""
    if not (math.isfinite(x) and math.isfinite(y)):
        x, y = row[0], row[1]
    return _on_arc(row, x, y) if row[7] != 0.0 else _on_line(row, x, y)


@kernel(f"UniTuple(float64, 4)({_ROW}, float64, float64, float64)", counts=False)
def _line_circle(row, cx, cy, radius):
    """Return the two places where the line that carries a row crosses a circle; NaN where it does not."""
    dx, dy = row[2] - row[0], row[3] - row[1]
    square = dx * dx + dy * dy
    if not square > 0.0:
        return math.nan, math.nan, math.nan, math.nan
    part = ((cx - row[0]) * dx + (cy - row[1]) * dy) / square
    x, y = row[0] + dx * part, row[1] + dy * part
    inside = radius * radius - ((x - cx) * (x - cx) + (y - cy) * (y - cy))
    if not inside >= 0.0:
        return math.nan, math.nan, math.nan, math.nan
    half = math.sqrt(inside / square)
    return x + dx * half, y + dy * half, x - dx * half, y - dy * half


@kernel(f"UniTuple(float64, 4)({_ROW}, {_ROW})", counts=False)
def _circle_circle(first, second):
    """Return the two places where two arcs' circles cross; NaN where they do not."""
    dx, dy = second[4] - first[4], second[5] - first[5]
    square = dx * dx + dy * dy
    if not square > 0.0:
        return math.nan, math.nan, math.nan, math.nan
    # |p - c1| = r1 and |p - c2| = r2, subtracted: a line square to c1 c2, (d^2 + r1^2 - r2^2) / 2 d from c1; part is
    # that as a share of d. The places lie on it, sqrt(r1^2 - (part d)^2) to either side.
    part = (square + first[6] * first[6] - second[6] * second[6]) / (2.0 * square)
    inside = first[6] * first[6] / square - part * part
    if not inside >= 0.0:
        return math.nan, math.nan, math.nan, math.nan
    half, x, y = math.sqrt(inside), first[4] + dx * part, first[5] + dy * part
    return x - dy * half, y + dx * half, x + dy * half, y - dx * half


@kernel(f"UniTuple(float64, 4)({_ROW}, {_ROW})", counts=False)
def _crossings(first, second):
    """Return up to two places where the carriers (line, circle) of the curves cross; NaN where they do not."""
    if first[7] != 0.0:
        if second[7] != 0.0:
            return _circle_circle(first, second)
        return _line_circle(second, first[4], first[5], first[6])
    if second[7] != 0.0:
        return _line_circle(first, second[4], second[5], second[6])
    ux, uy, vx, vy = first[2] - first[0], first[3] - first[1], second[2] - second[0], second[3] - second[1]
    across = ux * vy - uy * vx
    if across == 0.0:
        return math.nan, math.nan, math.nan, math.nan
    part = ((second[0] - first[0]) * vy - (second[1] - first[1]) * vx) / across
    return first[0] + ux * part, first[1] + uy * part, math.nan, math.nan


@kernel(f"UniTuple(float64, 4)({_ROW}, {_ROW})", counts=False)
def _common_normals(first, second):
    """Return two places of the first curve's carrier whose normals may be the second's too; NaN where none."""
    if first[7] == 0.0:
        if second[7] == 0.0:
            return math.nan, math.nan, math.nan, math.nan
        x, y = _on_line(first, second[4], second[5])
        return x, y, math.nan, math.nan
    dx, dy = second[4] - first[4], second[5] - first[5]
    if second[7] == 0.0:
        dx, dy = -(second[3] - second[1]), second[2] - second[0]
    length = math.hypot(dx, dy)
    if not length > 0.0:
        return math.nan, math.nan, math.nan, math.nan
    dx, dy = dx / length * first[6], dy / length * first[6]
    return first[4] + dx, first[5] + dy, first[4] - dx, first[5] - dy


@kernel(f"UniTuple(float64, 3)({_ROW}, {_ROW}, {_ROWS})", counts=False)
def _pair_distance(a, b, tried):
    """Return the least distance of two curves, mm, and where on the first one it is; `tried` is room for places."""
    # Where two curves are nearest, one of them ends, or they have one normal, or they cross: eight places of the first
    # curve. Each is laid on both curves before it is measured, so one that is on neither is never too near.
    tried[0, 0], tried[0, 1], tried[1, 0], tried[1, 1] = a[0], a[1], a[2], a[3]
    tried[2, 0], tried[2, 1] = _on(a, b[0], b[1])
    tried[3, 0], tried[3, 1] = _on(a, b[2], b[3])
    tried[4, 0], tried[4, 1], tried[5, 0], tried[5, 1] = _common_normals(a, b)
    tried[6, 0], tried[6, 1], tried[7, 0], tried[7, 1] = _crossings(a, b)
    least, near_x, near_y = INF, a[0], a[1]
    for m in range(_MOST):
        if m > 3 and not (math.isfinite(tried[m, 0]) and math.isfinite(tried[m, 1])):
            continue
        x, y = _on(a, tried[m, 0], tried[m, 1])
        px, py = _on(b, x, y)
        distance = math.hypot(x - px, y - py)
        if distance < least:
            least, near_x, near_y = distance, x, y
    return least, near_x, near_y


@kernel(f"void({_ROWS}, {_ROWS}, int64[::1], int64[::1], {_FOUND}, {_ROWS})")
def pair_distances(first, second, one, other, distances, places):
    """Write the least distance of each pair of curves, mm, and where on the first curve it is.

    Args:
        one, other: (n,) rows of both that make a pair. distances: (n,) out. places: (n, 2) out.
    """
    tried = np.empty((_MOST, 2))
    for k in range(len(one)):
        distances[k], places[k, 0], places[k, 1] = _pair_distance(first[one[k]], second[other[k]], tried)


@kernel("float64(float64[:, ::1], int64, float64[:, ::1], int64)", counts=False)
def _boxes_apart(boxes, m, others, k):
    """Return the distance of two boxes, mm; 0 where they meet."""
    dx = max(others[k, 0] - boxes[m, 2], boxes[m, 0] - others[k, 2], 0.0)
    dy = max(others[k, 1] - boxes[m, 3], boxes[m, 1] - others[k, 3], 0.0)
    return math.sqrt(dx * dx + dy * dy)


@kernel(f"void({_ROWS}, {_ROWS}, {_FOUND}, {_ROWS}, {_ROWS}, int64[::1], {_ROWS}, {_FOUND}, {_ROWS})")
def nearest_walls(rows, boxes, within, walls, wall_boxes, order, nodes, distances, places):
    """Write how far the nearest of the walls is from each row, mm, and where on the row; no place, and the distance
    `within`, where none is nearer than that.

    Args:
        rows, boxes: (n, 8) and (n, 4). within: (n,) mm.
        walls, wall_boxes, order, nodes: (m, 8) and (m, 4), and their tree.
        distances: (n,) out. places: (n, 2) out.
    """
    leaves, stack, tried = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty((_MOST, 2))
    for m in range(len(rows)):
        best, stack[0], top = within[m], 0, 1
        while top > 0:
            top -= 1
            k = stack[top]
            if _boxes_apart(boxes, m, nodes, k) - _ROUNDING >= best:
                continue
            if k < leaves - 1:
                near = 2 * k + 1
                if _boxes_apart(boxes, m, nodes, near + 1) < _boxes_apart(boxes, m, nodes, near):
                    near += 1
                stack[top], stack[top + 1] = 4 * k + 3 - near, near
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                w = order[place]
                if _boxes_apart(boxes, m, wall_boxes, w) - _ROUNDING >= best:
                    continue
                distance, x, y = _pair_distance(rows[m], walls[w], tried)
                if distance < best:
                    best, places[m, 0], places[m, 1] = distance, x, y
        distances[m] = best


# Compiled: how far a cone that goes up or down along a straight move reaches beyond walls, in closed form.


_GENTLE = 1 - 1e-12
"""Of what a move gains of width a mm of its way: at 1 no place is ahead of a foot far enough, and the root is not
defined.
"""

_CANDIDATES = 12
"""Places on a move at which it may be nearest to a wall: `_candidates` numbers them."""


@kernel("float64(float64[:, ::1], int64, float64)", counts=False)
def _width(moves, m, share):
    """Return how wide the cone is at the surface at a fraction of a move, mm; above it, the less."""
    z = moves[m, 2] + (moves[m, 5] - moves[m, 2]) * share
    return min(moves[m, 6] - z * moves[m, 7], moves[m, 8])


@kernel("void(float64[:, ::1], int64, float64[:, ::1], int64, float64[::1])", counts=False)
def _candidates(moves, m, walls, w, shares):
    """Write the fractions of a move one of which is where it reaches farthest beyond a wall: its ends, the best places
    for the wall's ends and its centre, as wide as the cone grows and as wide as it stays behind its rim, where it is
    over the wall's circle or crosses the line through the wall's ends, and where it gets as wide as its rim.
    """
    wx, wy = moves[m, 3] - moves[m, 0], moves[m, 4] - moves[m, 1]
    size = max(math.hypot(wx, wy), 1e-300)
    rise = (moves[m, 2] - moves[m, 5]) * moves[m, 7]
    slope = min(max(rise / size, -_GENTLE), _GENTLE)
    # as far ahead of the wall's foot as the width gains by the way: distance and width change alike there
    steep = slope / math.sqrt(1 - slope * slope)
    arc = walls[w, 7] != 0.0
    shares[0], shares[1] = 0.0, 1.0
    for k in range(3):
        column = 2 * k if k < 2 or arc else 0
        ox, oy = walls[w, column] - moves[m, 0], walls[w, column + 1] - moves[m, 1]
        along, aside = (ox * wx + oy * wy) / size, abs(ox * wy - oy * wx) / size
        shares[2 + k] = (along + aside * steep) / size
        shares[9 + k] = along / size
        if k == 2:
            reach = math.sqrt(max(walls[w, 6] * walls[w, 6] - aside * aside, 0.0)) if arc else 0.0
            shares[5], shares[6] = (along - reach) / size, (along + reach) / size
    sx, sy = walls[w, 2] - walls[w, 0], walls[w, 3] - walls[w, 1]
    ox, oy = walls[w, 0] - moves[m, 0], walls[w, 1] - moves[m, 1]
    across = wx * sy - wy * sx
    # the axis crosses the line through both ends of the wall there: no distance is left
    shares[7] = (ox * sy - oy * sx) / across if across != 0.0 else 0.0
    shares[8] = (moves[m, 8] - moves[m, 6] + moves[m, 2] * moves[m, 7]) / rise if rise != 0.0 else 0.0


@kernel(
    "void(float64[:, ::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], float64[::1], "
    "float64[:, ::1])"
)
def reaches(moves, walls, boxes, order, nodes, depth, places):
    """Write how far each move's cone reaches beyond the wall that it reaches beyond most, mm (< 0: it keeps clear of
    all by as much), and where, (n, 2).

    Below a node of the walls' tree the cone reaches beyond none by more than it is wide less the distance of the boxes.

    Args:
        moves: (n, 9) start and end of the tip, radius of the flat, mm of radius per mm of height, radius of the rim.
        walls: (m, 8) lines and arcs below half a turn. boxes: (m, 4) of them. order, nodes: their tree.
    """
    leaves, stack, shares = (len(nodes) + 1) // 2, np.empty(DEPTH, np.int64), np.empty(_CANDIDATES)
    box = np.empty((1, 4))
    for m in range(len(moves)):
        box[0, 0], box[0, 2] = min(moves[m, 0], moves[m, 3]), max(moves[m, 0], moves[m, 3])
        box[0, 1], box[0, 3] = min(moves[m, 1], moves[m, 4]), max(moves[m, 1], moves[m, 4])
        most = max(_width(moves, m, 0.0), _width(moves, m, 1.0))
        best, stack[0], top = -INF, 0, 1
        while top > 0:
            top -= 1
            k = stack[top]
            if most - _boxes_apart(box, 0, nodes, k) < best:
                continue
            if k < leaves - 1:
                one, other = 2 * k + 1, 2 * k + 2
                if _boxes_apart(box, 0, nodes, other) < _boxes_apart(box, 0, nodes, one):
                    one, other = other, one
                stack[top], stack[top + 1] = other, one
                top += 2
                continue
            first = (k - leaves + 1) * LEAF
            for place in range(first, min(first + LEAF, len(order))):
                w = order[place]
                if most - _boxes_apart(box, 0, boxes, w) < best:
                    continue
                _candidates(moves, m, walls, w, shares)
                # between two neighbouring candidates the reach is monotone, so one of them is where it is greatest
                for i in range(len(shares)):
                    share = min(max(shares[i], 0.0), 1.0)
                    x = moves[m, 0] + (moves[m, 3] - moves[m, 0]) * share
                    y = moves[m, 1] + (moves[m, 4] - moves[m, 1]) * share
                    reach = _width(moves, m, share) - point_distance(walls, w, x, y)
                    if reach > best:
                        best, places[m, 0], places[m, 1] = reach, x, y
        depth[m] = best


# Compiled loop that tells of places one by one, each so far from all told before it.


@kernel("int64(float64[:, ::1], int64[::1], int64[:, ::1], float64, int64[::1])")
def told_apart(places, own, around, apart, told):
    """Write which places are farther than `apart` from all that are told before them; return how many.

    Args:
        places: (m, 2), those to be told first in front.
        own: (m,) number of the square of side `apart` that each lies in.
        around: (n, 9) of each square itself and of those that touch it, -1: no place lies in it.
        apart: mm.
        told: (m,) numbers of the places.
    """
    last, before = np.full(len(around), -1, np.int64), np.empty(len(places), np.int64)
    count = 0
    for k in range(len(places)):
        alone = True
        # Squares are as wide as the distance: what is nearer lies in the same square or in one that touches it.
        for c in range(9):
            square = around[own[k], c]
            other = last[square] if square >= 0 else -1
            while other >= 0 and alone:
                alone = math.hypot(places[k, 0] - places[other, 0], places[k, 1] - places[other, 1]) > apart
                other = before[other]
        if alone:
            before[k], last[own[k]] = last[own[k]], k
            told[count] = k
            count += 1
    return count
