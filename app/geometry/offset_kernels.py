"""Compiled inner loops of the exact offset: elements at a level, and the parts of them that nothing comes nearer to.

Element e < n is row e moved to its left by the level; element n + i is the arc about the vertex at which row i
starts (only where the boundary turns right). A place on an element is a fraction u in [0, 1] of its length. A feature
that is not the nearest one of some point at a level is never again nearest beyond it, so the fractions that are left
at one level bound those of every higher one.
"""

from __future__ import annotations

import math

import numpy as np

from app.geometry.kernels import any_nearer, point_distance, query_box
from app.jit import kernel

CUSP = 1e-7  # radians; a turn this near to a half turn is one
SHORTEST = 1e-7  # mm; pieces below this are bridged by the stitching tolerance


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1])")
def vertex_arcs(rows, previous, vertices):
    """Write (start angle, sweep <= 0) of the arc about the start of each row; sweep 0 where the boundary turns left."""
    for i in range(len(rows)):
        k = previous[i]
        ux, uy = rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]
        if rows[k, 7] != 0.0:
            ux, uy = -rows[k, 7] * (rows[k, 3] - rows[k, 5]), rows[k, 7] * (rows[k, 2] - rows[k, 4])
        vx, vy = rows[i, 2] - rows[i, 0], rows[i, 3] - rows[i, 1]
        if rows[i, 7] != 0.0:
            vx, vy = -rows[i, 7] * (rows[i, 1] - rows[i, 5]), rows[i, 7] * (rows[i, 0] - rows[i, 4])
        turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)
        if abs(turn) > math.pi - CUSP:  # the boundary turns back on itself; its curvatures tell to which side
            leaving = rows[i, 7] / rows[i, 6] if rows[i, 7] != 0.0 else 0.0
            arriving = -rows[k, 7] / rows[k, 6] if rows[k, 7] != 0.0 else 0.0
            if arriving > leaving + 1e-12:
                turn = math.pi
            elif turn > 0.0:
                turn -= 2 * math.pi
        vertices[i, 0] = math.atan2(ux, -uy)
        vertices[i, 1] = turn if turn < -1e-9 else 0.0


@kernel("boolean(float64[:, ::1], float64[:, ::1], int64, float64, float64[::1])")
def element(rows, vertices, e, level, out):
    """Write element e at a level into out; False where it does not exist (an arc shrunk to nothing).

    out: a line is (0, ax, ay, bx, by); an arc (1, cx, cy, radius, start angle, sweep).
    """
    n = len(rows)
    if e >= n:
        i = e - n
        out[0], out[1], out[2], out[3] = 1.0, rows[i, 0], rows[i, 1], level
        out[4], out[5] = vertices[i, 0], vertices[i, 1]
        return vertices[i, 1] < 0.0
    if rows[e, 7] == 0.0:
        dx, dy = rows[e, 2] - rows[e, 0], rows[e, 3] - rows[e, 1]
        scale = level / math.hypot(dx, dy)
        out[0], out[1], out[2] = 0.0, rows[e, 0] - dy * scale, rows[e, 1] + dx * scale
        out[3], out[4] = rows[e, 2] - dy * scale, rows[e, 3] + dx * scale
        return True
    cx, cy = rows[e, 4], rows[e, 5]
    start = math.atan2(rows[e, 1] - cy, rows[e, 0] - cx)
    turn = math.atan2(rows[e, 3] - cy, rows[e, 2] - cx) - start
    out[0], out[1], out[2], out[3] = 1.0, cx, cy, rows[e, 6] - rows[e, 7] * level
    out[4] = start
    out[5] = turn % (2 * math.pi) if rows[e, 7] > 0.0 else -((-turn) % (2 * math.pi))
    return out[3] > SHORTEST


@kernel("UniTuple(float64, 2)(float64[::1], float64)")
def place(shape, u):
    """Return the point at fraction u of an element."""
    if shape[0] == 0.0:
        return shape[1] + u * (shape[3] - shape[1]), shape[2] + u * (shape[4] - shape[2])
    angle = shape[4] + u * shape[5]
    return shape[1] + shape[3] * math.cos(angle), shape[2] + shape[3] * math.sin(angle)


@kernel("int64(float64[::1], float64, float64, float64[::1], int64)")
def _cut_angles(shape, middle, half, cuts, count):
    """Append the fractions of an arc element at the angles middle - half and middle + half."""
    for angle in (middle - half, middle + half):
        ahead = (angle - shape[4]) if shape[5] > 0.0 else (shape[4] - angle)
        cuts[count] = (ahead % (2 * math.pi)) / abs(shape[5])
        count += 1
    return count


@kernel("int64(float64[::1], float64, float64, float64, float64[::1], int64)")
def _cut_circle(shape, cx, cy, r, cuts, count):
    """Append the fractions at which an element crosses a circle."""
    if shape[0] == 0.0:
        dx, dy = shape[3] - shape[1], shape[4] - shape[2]
        fx, fy = shape[1] - cx, shape[2] - cy
        a, b = dx * dx + dy * dy, fx * dx + fy * dy
        cross = fx * dy - fy * dx
        disc = r * r * a - cross * cross
        if disc >= 0.0 and a > 0.0:
            root = math.sqrt(disc)
            cuts[count], cuts[count + 1] = (-b - root) / a, (-b + root) / a
            count += 2
        return count
    dx, dy = cx - shape[1], cy - shape[2]
    d = math.hypot(dx, dy)
    if d < 1e-12:
        return count
    cosine = (d * d + shape[3] * shape[3] - r * r) / (2 * d * shape[3])
    if abs(cosine) > 1.0 + 1e-12:
        return count
    return _cut_angles(shape, math.atan2(dy, dx), math.acos(min(1.0, max(-1.0, cosine))), cuts, count)


@kernel("int64(float64[::1], float64[:, ::1], int64, float64, float64[::1], int64)")
def _cut_lines(shape, rows, j, level, cuts, count):
    """Append the fractions at which an element crosses the two parallels of line j at a level."""
    ux, uy = rows[j, 2] - rows[j, 0], rows[j, 3] - rows[j, 1]
    length = math.hypot(ux, uy)
    nx, ny = -uy / length, ux / length
    offset = (shape[1] - rows[j, 0]) * nx + (shape[2] - rows[j, 1]) * ny
    for side in (-level, level):
        if shape[0] == 0.0:
            rate = (shape[3] - shape[1]) * nx + (shape[4] - shape[2]) * ny
            if rate != 0.0:
                cuts[count] = (side - offset) / rate
                count += 1
            continue
        cosine = (side - offset) / shape[3]
        if abs(cosine) <= 1.0 + 1e-12:
            count = _cut_angles(shape, math.atan2(ny, nx), math.acos(min(1.0, max(-1.0, cosine))), cuts, count)
    return count


@kernel("int64(float64[::1], float64[:, ::1], int64, float64, float64, float64, float64[::1])")
def cut(shape, rows, j, level, u0, u1, cuts):
    """Write u0, the sorted fractions where row j's distance passes the level, u1 into cuts; return how many."""
    cuts[0] = u0
    count = 1
    if rows[j, 7] == 0.0:
        count = _cut_lines(shape, rows, j, level, cuts, count)
    else:
        count = _cut_circle(shape, rows[j, 4], rows[j, 5], rows[j, 6] + level, cuts, count)
        count = _cut_circle(shape, rows[j, 4], rows[j, 5], abs(rows[j, 6] - level), cuts, count)
    count = _cut_circle(shape, rows[j, 0], rows[j, 1], level, cuts, count)
    count = _cut_circle(shape, rows[j, 2], rows[j, 3], level, cuts, count)
    kept = 1
    for k in range(1, count):
        value = cuts[k]
        if not u0 < value < u1:
            continue
        at = kept
        while at > 1 and cuts[at - 1] > value:
            cuts[at] = cuts[at - 1]
            at -= 1
        cuts[at] = value
        kept += 1
    cuts[kept] = u1
    return kept + 1


@kernel("void(float64[::1], float64, float64, float64, float64[::1])")
def _reach(shape, u0, u1, level, box):
    """Write the box of an element's piece, widened by the level."""
    x0, y0 = place(shape, u0)
    x1, y1 = place(shape, u1)
    wide = level
    if shape[0] == 1.0:  # an arc is within its sagitta of the chord's box
        half = min(abs(shape[5]) * (u1 - u0) / 2, math.pi)
        wide += shape[3] * (1 - math.cos(half))
    box[0], box[1], box[2], box[3] = min(x0, x1) - wide, min(y0, y1) - wide, max(x0, x1) + wide, max(y0, y1) + wide


@kernel("Tuple((float64[:, ::1], int64))(float64[:, ::1], int64, float64, float64)")
def _push(blocked, count, u0, u1):
    if count == len(blocked):
        larger = np.empty((2 * count, 2))
        larger[:count] = blocked
        blocked = larger
    blocked[count, 0], blocked[count, 1] = u0, u1
    return blocked, count + 1


@kernel("int64(float64[::1], float64[:, ::1], int64[::1], int64, float64[::1])")
def _undecided(shape, rows, near, count, limits):
    """Keep in `near` the rows whose distance from the piece's middle lets them come within the level; return how many."""
    x, y = place(shape, (limits[2] + limits[3]) / 2)
    reach = limits[5] * (limits[3] - limits[2]) / 2
    kept = 0
    for c in range(count):
        if point_distance(rows, near[c], x, y) - reach < limits[0]:
            near[kept] = near[c]
            kept += 1
    return kept


@kernel("Tuple((float64[:, ::1], int64))(float64[::1], float64[:, ::1], int64[::1], int64, float64[::1])")
def blocked_parts(shape, rows, near, count, limits):
    """Return the parts (m, 2) of an element's piece to which a near row comes nearer than the level.

    limits: level, slack, u0, u1, shortest piece as a fraction, length of the whole element.
    """
    level, slack, u0, u1 = limits[0], limits[1], limits[2], limits[3]
    blocked, blocks = np.empty((16, 2)), 0
    cuts = np.empty(16)
    for c in range(count):
        j = near[c]
        m = cut(shape, rows, j, level, u0, u1, cuts)
        for k in range(m - 1):
            x, y = place(shape, (cuts[k] + cuts[k + 1]) / 2)
            if point_distance(rows, j, x, y) < level - slack:
                blocked, blocks = _push(blocked, blocks, cuts[k], cuts[k + 1])
                if cuts[k] == u0 and cuts[k + 1] == u1:
                    blocked[0] = blocked[blocks - 1]
                    return blocked, 1
    return blocked, blocks


@kernel("int64(float64[:, ::1], int64, int64, float64[::1], float64[:, ::1], int64)")
def _keep_rest(blocked, blocks, e, limits, pieces, count):
    """Append what is left of [u0, u1] after taking the blocked parts out; return the new count."""
    at, shortest = limits[2], limits[4]
    for k in np.argsort(blocked[:blocks, 0]):
        if blocked[k, 0] - at > shortest and count < len(pieces):
            pieces[count, 0], pieces[count, 1], pieces[count, 2] = e, at, blocked[k, 0]
            count += 1
        at = max(at, blocked[k, 1])
    if limits[3] - at > shortest and count < len(pieces):
        pieces[count, 0], pieces[count, 1], pieces[count, 2] = e, at, limits[3]
        count += 1
    return count


_TREE = "int64[::1], float64[:, ::1], float64[:, ::1]"


@kernel(f"int64(float64[:, ::1], float64[:, ::1], {_TREE}, float64[:, ::1], float64[::1], float64[:, ::1])")
def trim(rows, vertices, order, nodes, boxes, active, level_slack, pieces):
    """Write the pieces (element, u0, u1) of a level that no row comes nearer to; return how many.

    Args:
        order, nodes, boxes: the tree of rows that may block.
        active: (m, 3) pieces of a lower level.
        level_slack: level and slack, mm: nearer than level - slack is blocked.
        pieces: where to write; a return value of len(pieces) means that there was not enough room.
    """
    count = 0
    shape, box, limits = np.empty(6), np.empty(4), np.empty(6)
    near = np.empty(len(rows), np.int64)
    limits[0], limits[1] = level_slack[0], level_slack[1]
    for a in range(len(active)):
        e, limits[2], limits[3] = int(active[a, 0]), active[a, 1], active[a, 2]
        if not element(rows, vertices, e, limits[0], shape):
            continue
        length = math.hypot(shape[3] - shape[1], shape[4] - shape[2]) if shape[0] == 0.0 else abs(shape[5]) * shape[3]
        limits[4], limits[5] = SHORTEST / max(length, SHORTEST), length
        x, y = place(shape, (limits[2] + limits[3]) / 2)
        if any_nearer(rows, order, nodes, x, y, limits[0] - limits[1] - length * (limits[3] - limits[2]) / 2):
            continue
        _reach(shape, limits[2], limits[3], limits[0], box)
        found = query_box(order, nodes, boxes, box, near)
        others = 0
        for c in range(found):
            if near[c] != e:
                near[others] = near[c]
                others += 1
        others = _undecided(shape, rows, near, others, limits)
        blocked, blocks = blocked_parts(shape, rows, near, others, limits)
        count = _keep_rest(blocked, blocks, e, limits, pieces, count)
    return count


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, float64[:, ::1])")
def piece_rows(rows, vertices, pieces, level, out):
    """Write each piece (m, 3) at a level as a row (m, 8)."""
    shape = np.empty(6)
    for k in range(len(pieces)):
        element(rows, vertices, int(pieces[k, 0]), level, shape)
        out[k, 0], out[k, 1] = place(shape, pieces[k, 1])
        out[k, 2], out[k, 3] = place(shape, pieces[k, 2])
        out[k, 4:] = 0.0
        if shape[0] == 1.0:
            out[k, 4], out[k, 5], out[k, 6] = shape[1], shape[2], shape[3]
            out[k, 7] = 1.0 if shape[5] > 0.0 else -1.0
