# mypy: allow-untyped-defs
"""Compiled inner loops: how near two rows come to each other, in closed form, and whether paths keep their distance
from a drawing.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import DEPTH, LEAF, in_sector, point_distance
from .trim_kernels import ROWS, TREE, misses, misses_capsule, misses_row


@kernel("boolean(float64[:, ::1], int64, float64[:, ::1], int64)", counts=False)
def _lines_cross(a, i, b, j):
    ux, uy, vx, vy = a[i, 2] - a[i, 0], a[i, 3] - a[i, 1], b[j, 2] - b[j, 0], b[j, 3] - b[j, 1]
    wx, wy = b[j, 0] - a[i, 0], b[j, 1] - a[i, 1]
    before, after = ux * wy - uy * wx, ux * (wy + vy) - uy * (wx + vx)
    first, last = vy * wx - vx * wy, vy * (wx - ux) - vx * (wy - uy)
    return before * after < 0.0 and first * last < 0.0


@kernel("float64(float64[:, ::1], int64, float64[:, ::1], int64, float64)", counts=False)
def _line_and_arc(line, i, arc, j, best):
    """Return the smaller of `best` and the distances between inner points of a line and of an arc."""
    dx, dy = line[i, 2] - line[i, 0], line[i, 3] - line[i, 1]
    cx, cy, r, length2 = arc[j, 4], arc[j, 5], arc[j, 6], dx * dx + dy * dy
    if length2 == 0.0:
        return best
    t = ((cx - line[i, 0]) * dx + (cy - line[i, 1]) * dy) / length2
    x, y = line[i, 0] + t * dx, line[i, 1] + t * dy
    h = math.sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy))
    if h >= r:
        return min(best, h - r) if 0.0 < t < 1.0 and in_sector(arc, j, x, y) else best
    half = math.sqrt((r * r - h * h) / length2)
    for at in (t - half, t + half):
        if 0.0 < at < 1.0 and in_sector(arc, j, line[i, 0] + at * dx, line[i, 1] + at * dy):
            return 0.0
    return best


@kernel("float64(float64[:, ::1], int64, float64[:, ::1], int64, float64)", counts=False)
def _two_arcs(a, i, b, j, best):
    """Return the smaller of `best` and the distances between inner points of two arcs."""
    dx, dy = b[j, 4] - a[i, 4], b[j, 5] - a[i, 5]
    d, r, s = math.sqrt(dx * dx + dy * dy), a[i, 6], b[j, 6]
    if d < 1e-12:  # about one centre they are nearest where one of them ends
        return best
    ux, uy = dx / d, dy / d
    # nearest points of two circles lie on the line through their centres: four pairs
    for p in (-r, r):
        for q in (-s, s):
            if in_sector(a, i, a[i, 4] + p * ux, a[i, 5] + p * uy) and in_sector(
                b, j, b[j, 4] + q * ux, b[j, 5] + q * uy
            ):
                best = min(best, abs(d + q - p))
    if abs(r - s) < d < r + s:
        along = (d * d + r * r - s * s) / (2 * d)
        up = math.sqrt(max(r * r - along * along, 0.0))
        for side in (-up, up):
            x, y = a[i, 4] + along * ux - side * uy, a[i, 5] + along * uy + side * ux
            if in_sector(a, i, x, y) and in_sector(b, j, x, y):
                return 0.0
    return best


@kernel("float64(float64[:, ::1], int64, float64[:, ::1], int64)", counts=False)
def rows_distance(a, i, b, j):
    """Return the distance between row i of a and row j of b, mm; 0 where they cross. Arcs sweep less than pi."""
    best = min(point_distance(a, i, b[j, 0], b[j, 1]), point_distance(a, i, b[j, 2], b[j, 3]))
    best = min(best, point_distance(b, j, a[i, 0], a[i, 1]), point_distance(b, j, a[i, 2], a[i, 3]))
    if a[i, 7] == 0.0 and b[j, 7] == 0.0:
        return 0.0 if _lines_cross(a, i, b, j) else best
    if a[i, 7] == 0.0:
        return _line_and_arc(a, i, b, j, best)
    return _line_and_arc(b, j, a, i, best) if b[j, 7] == 0.0 else _two_arcs(a, i, b, j, best)


@kernel("boolean(float64[:, ::1], int64, float64[::1])", counts=False)
def probe_row(rows, i, probe):
    """Write what `misses` asks of row i, as `probe_piece` does; False for an arc of more than half a turn."""
    ux, uy = rows[i, 2] - rows[i, 0], rows[i, 3] - rows[i, 1]
    chord, r, turn = max(math.sqrt(ux * ux + uy * uy), 1e-300), rows[i, 6], rows[i, 7]
    if turn == 0.0:
        probe[0], probe[1], probe[2], probe[3] = rows[i, 0] + ux / 2, rows[i, 1] + uy / 2, ux / chord, uy / chord
        probe[4], probe[5], probe[6], probe[7], probe[8] = 0.0, 0.0, chord / 2, 0.0, chord / 2
        return True
    ax, ay, bx, by = rows[i, 0] - rows[i, 4], rows[i, 1] - rows[i, 5], rows[i, 2] - rows[i, 4], rows[i, 3] - rows[i, 5]
    # whichever is longer, so tells the direction better
    nx, ny = (turn * uy, -turn * ux) if chord > r else (ax + bx, ay + by)
    size = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / size, ny / size
    sine = min(chord / (2 * r), 1.0)
    sag = r * (1.0 - math.sqrt(1.0 - sine * sine))
    probe[0], probe[1] = rows[i, 4] + r * nx, rows[i, 5] + r * ny
    probe[2], probe[3], probe[4], probe[5] = -ny, nx, nx, ny
    probe[6], probe[7], probe[8] = r * sine, sag, math.sqrt(r * r * sine * sine + sag * sag)
    return turn * (ax * by - ay * bx) >= -1e-6 * r * r


@kernel(f"boolean(float64[:, ::1], int64, {ROWS}, {TREE}, float64[::1], int64[::1])", counts=False)
def keeps_clear(path, i, rows, boxes, order, nodes, capsules, probe, stack):
    """Return whether no point of row i of a path is nearer to any row than probe[9], the rest of which is the row's."""
    leaves = (len(nodes) + 1) // 2
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        k = stack[top]
        if misses(nodes, k, probe):
            continue
        if k < leaves - 1:
            stack[top], stack[top + 1] = 2 * k + 2, 2 * k + 1
            top += 2
            continue
        first = (k - leaves + 1) * LEAF
        if misses_capsule(capsules, k - leaves + 1, probe):
            continue
        for at in range(first, first + LEAF):
            j = order[at]
            if j >= 0 and not misses_row(rows, boxes, j, probe) and rows_distance(path, i, rows, j) < probe[9]:
                return False
    return True


@kernel(f"boolean(float64[:, ::1], int64[::1], {ROWS}, {TREE}, float64, float64)")
def measures_right(path, owners, rows, boxes, order, nodes, capsules, level, limit):
    """Return whether every point of every row of a path is as far from the drawing as the level, but for `limit`.

    No row of the drawing may come nearer to any point; where a row of the path begins, ends and has its middle, the row
    of the drawing that it belongs to, its owner, must be no farther either.
    """
    probe, stack = np.empty(10), np.empty(DEPTH, np.int64)
    probe[9] = level - limit
    for i in range(len(path)):
        if not probe_row(path, i, probe):
            return False
        own = owners[i]
        far = max(point_distance(rows, own, path[i, 0], path[i, 1]), point_distance(rows, own, path[i, 2], path[i, 3]))
        if max(far, point_distance(rows, own, probe[0], probe[1])) > level + limit:
            return False
        if not keeps_clear(path, i, rows, boxes, order, nodes, capsules, probe, stack):
            return False
    return True
