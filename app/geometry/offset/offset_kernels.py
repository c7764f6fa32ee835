# mypy: allow-untyped-defs
"""Compiled inner loops of the exact offset: elements at a level, and where a row's distance passes it.

Element e < n is row e moved to its left by the level; element n + i is the arc about the vertex at which row i
starts (only where the boundary turns right). A place on an element is a fraction u in [0, 1] of its length.
"""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import enlarged, point_distance

CUSP = 1e-7  # radians; a turn this near to a half turn is one
SHORTEST = 1e-7  # mm; pieces below this are bridged by the stitching tolerance


@kernel("float64(float64[:, ::1], int64, int64)", counts=False)
def vertex_turn(rows, k, i):
    """Return the turn from the end of row k to the start of row i, radians, in [-2 pi, pi]; a half turn to either
    side.
    """
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
            return math.pi
        if turn > 0.0:
            return turn - 2 * math.pi
    return turn


@kernel("void(float64[:, ::1], int64[::1], float64[:, ::1])")
def element_angles(rows, previous, angles):
    """Write (start angle, signed sweep) of every element (2 n, 2); 0, 0 for lines and where the boundary turns left."""
    n = len(rows)
    angles[:] = 0.0
    for i in range(n):
        if rows[i, 7] != 0.0:
            start = math.atan2(rows[i, 1] - rows[i, 5], rows[i, 0] - rows[i, 4])
            turn = math.atan2(rows[i, 3] - rows[i, 5], rows[i, 2] - rows[i, 4]) - start
            angles[i, 0], angles[i, 1] = start, rows[i, 7] * ((rows[i, 7] * turn) % (2 * math.pi))
        k = previous[i]
        turn = vertex_turn(rows, k, i)
        if turn < -1e-9:
            ux, uy = rows[k, 2] - rows[k, 0], rows[k, 3] - rows[k, 1]
            if rows[k, 7] != 0.0:
                ux, uy = -rows[k, 7] * (rows[k, 3] - rows[k, 5]), rows[k, 7] * (rows[k, 2] - rows[k, 4])
            angles[n + i, 0], angles[n + i, 1] = math.atan2(ux, -uy), turn


@kernel("boolean(float64[:, ::1], float64[:, ::1], int64, float64, float64[::1])", counts=False)
def element(rows, angles, e, level, shape):
    """Write element e at a level into shape; False where it does not exist (an arc shrunk to nothing).

    shape: a line is (0, ax, ay, bx, by, length); an arc (1, cx, cy, radius, start angle, sweep).
    """
    n = len(rows)
    if e >= n:
        i = e - n
        shape[0], shape[1], shape[2], shape[3] = 1.0, rows[i, 0], rows[i, 1], level
        shape[4], shape[5] = angles[e, 0], angles[e, 1]
        return angles[e, 1] < 0.0
    if rows[e, 7] == 0.0:
        dx, dy = rows[e, 2] - rows[e, 0], rows[e, 3] - rows[e, 1]
        length = math.sqrt(dx * dx + dy * dy)
        scale = level / length
        shape[0], shape[1], shape[2] = 0.0, rows[e, 0] - dy * scale, rows[e, 1] + dx * scale
        shape[3], shape[4], shape[5] = rows[e, 2] - dy * scale, rows[e, 3] + dx * scale, length
        return True
    shape[0], shape[1], shape[2], shape[3] = 1.0, rows[e, 4], rows[e, 5], rows[e, 6] - rows[e, 7] * level
    shape[4], shape[5] = angles[e, 0], angles[e, 1]
    return shape[3] > SHORTEST


@kernel("float64(float64[::1])", counts=False)
def length_of(shape):
    """Return the length of an element, mm."""
    return shape[5] if shape[0] == 0.0 else abs(shape[5]) * shape[3]


@kernel("UniTuple(float64, 2)(float64[::1], float64)", counts=False)
def place(shape, u):
    """Return the point at fraction u of an element."""
    if shape[0] == 0.0:
        return shape[1] + u * (shape[3] - shape[1]), shape[2] + u * (shape[4] - shape[2])
    angle = shape[4] + u * shape[5]
    return shape[1] + shape[3] * math.cos(angle), shape[2] + shape[3] * math.sin(angle)


@kernel("int64(float64[::1], float64, float64, float64[::1], int64)", counts=False)
def _cut_angles(shape, middle, half, cuts, count):
    """Append the fractions of an arc element at the angles middle - half and middle + half."""
    for angle in (middle - half, middle + half):
        ahead = (angle - shape[4]) if shape[5] > 0.0 else (shape[4] - angle)
        while ahead < 0.0:  # a turn or two; a remainder would take longer than all the rest
            ahead += 2 * math.pi
        while ahead >= 2 * math.pi:
            ahead -= 2 * math.pi
        cuts[count] = ahead / abs(shape[5])
        count += 1
    return count


@kernel("int64(float64[::1], float64, float64, float64, float64[::1], int64)", counts=False)
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
    d = math.sqrt(dx * dx + dy * dy)
    if d < 1e-12:
        return count
    cosine = (d * d + shape[3] * shape[3] - r * r) / (2 * d * shape[3])
    if abs(cosine) > 1.0 + 1e-12:
        return count
    return _cut_angles(shape, math.atan2(dy, dx), math.acos(min(1.0, max(-1.0, cosine))), cuts, count)


@kernel("int64(float64[::1], float64[:, ::1], int64, float64, float64[::1], int64)", counts=False)
def _cut_lines(shape, rows, j, level, cuts, count):
    """Append the fractions at which an element crosses the two parallels of line j at a level."""
    ux, uy = rows[j, 2] - rows[j, 0], rows[j, 3] - rows[j, 1]
    length = math.sqrt(ux * ux + uy * uy)
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


@kernel("int64(float64[::1], float64[:, ::1], int64, float64, float64, float64, float64[::1])", counts=False)
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
    # sorted as they come in: there are ten at most
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


@kernel("Tuple((float64[:, ::1], int64))(float64[:, ::1], int64, float64, float64)")
def push(blocked, count, u0, u1):
    """Add a part to those that are blocked, which stay sorted by where they begin."""
    if count == len(blocked):
        blocked = enlarged(blocked, count, 2 * count)
    at = count
    while at > 0 and blocked[at - 1, 0] > u0:
        blocked[at, 0], blocked[at, 1] = blocked[at - 1, 0], blocked[at - 1, 1]
        at -= 1
    blocked[at, 0], blocked[at, 1] = u0, u1
    return blocked, count + 1


@kernel(
    "Tuple((float64[:, ::1], int64))(float64[:, ::1], int64, float64[::1], float64[:, ::1], int64, float64[::1], "
    "float64[::1])"
)
def block(blocked, blocks, shape, rows, j, span, cuts):
    """Add the parts of an element's piece to which row j comes nearer than the level. span: u0, u1, level, level -
    slack.
    """
    m = cut(shape, rows, j, span[2], span[0], span[1], cuts)
    for k in range(m - 1):
        x, y = place(shape, (cuts[k] + cuts[k + 1]) / 2)
        if point_distance(rows, j, x, y) < span[3]:
            blocked, blocks = push(blocked, blocks, cuts[k], cuts[k + 1])
    return blocked, blocks


@kernel("Tuple((float64[:, ::1], int64))(float64[::1], float64[:, ::1], int64[::1], int64, float64[::1])")
def blocked_parts(shape, rows, near, count, limits):
    """Return the parts (m, 2) of an element's piece to which a near row comes nearer than the level.

    limits: level, slack, u0, u1.
    """
    blocked, blocks, cuts, span = np.empty((16, 2)), 0, np.empty(16), np.empty(4)
    span[0], span[1], span[2], span[3] = limits[2], limits[3], limits[0], limits[0] - limits[1]
    for c in range(count):
        blocked, blocks = block(blocked, blocks, shape, rows, near[c], span, cuts)
        if blocks > 0 and blocked[0, 0] == limits[2] and blocked[0, 1] == limits[3]:
            return blocked, 1
    return blocked, blocks


@kernel("void(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, float64[:, ::1])")
def piece_rows(rows, angles, pieces, level, out):
    """Write each piece (m, 3) at a level as a row (m, 8)."""
    shape = np.empty(6)
    for k in range(len(pieces)):
        element(rows, angles, int(pieces[k, 0]), level, shape)
        out[k, 0], out[k, 1] = place(shape, pieces[k, 1])
        out[k, 2], out[k, 3] = place(shape, pieces[k, 2])
        out[k, 4:] = 0.0
        if shape[0] == 1.0:
            out[k, 4], out[k, 5], out[k, 6] = shape[1], shape[2], shape[3]
            out[k, 7] = 1.0 if shape[5] > 0.0 else -1.0
