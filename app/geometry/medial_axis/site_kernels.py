# mypy: allow-untyped-defs
"""Compiled: discs that touch the boundary of a region at one foot and at one other site, in closed form.

Elements and sites are numbered alike: e < n is row e, n + i is the vertex at which row i starts (only where the
boundary turns right). A foot is a fraction u in [0, 1] of an element: of a line's length, of an arc's angle, of the
angle between the two normals of a vertex. `links` (2, n) are the rows before and after each row; `turns` (n,) by how
much the boundary turns where a row starts, radians.
"""

from __future__ import annotations

import math

from ...core.jit import kernel

SMOOTH = 1e-6  # radians; a vertex that turns less is none
TOUCHING = 1e15  # 1/mm; the curvature of a disc that is a point


@kernel("UniTuple(float64, 4)(float64[:, ::1], float64[:, ::1], int64, float64)", counts=False)
def foot(rows, angles, e, u):
    """Return (x, y, nx, ny): the foot at u of element e, and the unit normal there that points into the region."""
    n = len(rows)
    if e >= n:
        angle = angles[e, 0] + angles[e, 1] * u
        return rows[e - n, 0], rows[e - n, 1], math.cos(angle), math.sin(angle)
    if rows[e, 7] == 0.0:
        dx, dy = rows[e, 2] - rows[e, 0], rows[e, 3] - rows[e, 1]
        length = math.sqrt(dx * dx + dy * dy)
        return rows[e, 0] + dx * u, rows[e, 1] + dy * u, -dy / length, dx / length
    angle = angles[e, 0] + angles[e, 1] * u
    ux, uy = math.cos(angle), math.sin(angle)
    return rows[e, 4] + rows[e, 6] * ux, rows[e, 5] + rows[e, 6] * uy, -rows[e, 7] * ux, -rows[e, 7] * uy


@kernel("float64(float64[:, ::1], int64, float64, float64, float64, float64)", counts=False)
def _to_line(rows, s, px, py, nx, ny):
    dx, dy = rows[s, 2] - rows[s, 0], rows[s, 3] - rows[s, 1]
    length = math.sqrt(dx * dx + dy * dy)
    mx, my = -dy / length, dx / length
    ax, ay, bx, by = px - rows[s, 0], py - rows[s, 1], px - rows[s, 2], py - rows[s, 3]
    height = ax * mx + ay * my if ax * ax + ay * ay < bx * bx + by * by else bx * mx + by * my
    # r (1 - n.m) = height, and 1 - n.m = |n - m|^2 / 2, which loses no digits where both are nearly parallel
    qx, qy = nx - mx, ny - my
    apart = qx * qx + qy * qy
    if height <= 1e-13:
        return TOUCHING if height > -1e-13 and apart > 1e-13 else -1.0
    return 0.5 * apart / height


@kernel("float64(float64[:, ::1], int64, int64, float64, float64, float64, float64)", counts=False)
def curvature(rows, e, s, px, py, nx, ny):
    """Return 1 / radius of the disc that touches element e at a foot and the endless line, whole circle or vertex s;
    <= 0 where there is none. A counter-clockwise arc is its own site: its discs end at its centre.
    """
    n = len(rows)
    if s == e:
        return 1.0 / rows[e, 6]
    if s >= n:
        wx, wy = px - rows[s - n, 0], py - rows[s - n, 1]
        square = wx * wx + wy * wy
        return -2.0 * (nx * wx + ny * wy) / square if square > 1e-24 else -1.0
    if rows[s, 7] == 0.0:
        return _to_line(rows, s, px, py, nx, ny)
    wx, wy, r, turn = px - rows[s, 4], py - rows[s, 5], rows[s, 6], rows[s, 7]
    far = math.sqrt(wx * wx + wy * wy)
    under = (r - far) * (r + far) * turn
    over = 2.0 * (nx * wx + ny * wy + turn * r) * turn
    if over <= 1e-12 * r:
        return -1.0
    if under <= 1e-13 * r:
        return TOUCHING if under > -1e-13 * r and over > 1e-7 * r else -1.0
    return over / under


@kernel("boolean(float64[:, ::1], int64, float64, float64, float64)", counts=False)
def spans(rows, s, x, y, crack):
    """Return whether the foot of a point on row s, taken as an endless curve, lies within the row, or beyond its ends
    by no more than `crack`, mm.
    """
    if rows[s, 7] == 0.0:
        dx, dy = rows[s, 2] - rows[s, 0], rows[s, 3] - rows[s, 1]
        along, square = (x - rows[s, 0]) * dx + (y - rows[s, 1]) * dy, dx * dx + dy * dy
        slack = 1e-13 * square + crack * math.sqrt(square)  # discs slip through cracks between rows
        return -slack <= along <= square + slack
    turn, vx, vy = rows[s, 7], x - rows[s, 4], y - rows[s, 5]
    ax, ay, bx, by = rows[s, 0] - rows[s, 4], rows[s, 1] - rows[s, 5], rows[s, 2] - rows[s, 4], rows[s, 3] - rows[s, 5]
    slack = -(1e-13 * rows[s, 6] + crack) * (abs(vx) + abs(vy))
    return turn * (ax * vy - ay * vx) >= slack and turn * (vx * by - vy * bx) >= slack


@kernel("boolean(float64[:, ::1], float64[:, ::1], int64, int64, float64)", counts=False)
def touches(rows, angles, e, s, u):
    """Return whether the disc at u of element e touches site s itself, not what extends it, to 1e-8 mm."""
    if s >= len(rows) or s == e:
        return True
    px, py, nx, ny = foot(rows, angles, e, u)
    k = curvature(rows, e, s, px, py, nx, ny)
    if k <= 0.0:
        return False
    x, y = px + nx / k, py + ny / k
    if spans(rows, s, x, y, 0.0):
        return True
    if rows[s, 7] == 0.0:
        dx, dy = rows[s, 2] - rows[s, 0], rows[s, 3] - rows[s, 1]
        length = math.sqrt(dx * dx + dy * dy)
        along = ((x - rows[s, 0]) * dx + (y - rows[s, 1]) * dy) / length
        return -1e-8 <= along <= length + 1e-8
    vx, vy = x - rows[s, 4], y - rows[s, 5]
    far = math.sqrt(vx * vx + vy * vy)
    if far < 1e-9:
        return True
    fx, fy = rows[s, 4] + vx / far * rows[s, 6], rows[s, 5] + vy / far * rows[s, 6]
    return min(math.hypot(fx - rows[s, 0], fy - rows[s, 1]), math.hypot(fx - rows[s, 2], fy - rows[s, 3])) < 1e-8


@kernel("boolean(float64[:, ::1], int64[:, ::1], float64[::1], int64, int64)", counts=False)
def never_bounds(rows, links, turns, e, s):
    """Return whether site s can never bound the cell of element e: itself, its ends, its smooth neighbours (curves
    with a common tangent have no common disc elsewhere), its own circle.
    """
    n = len(rows)
    if e >= n:
        return s in (e, e - n, links[0, e - n])
    if s >= n:
        return s in (n + e, n + links[1, e])
    if s == e:
        return True
    same = abs(rows[e, 4] - rows[s, 4]) + abs(rows[e, 5] - rows[s, 5]) + abs(rows[e, 6] - rows[s, 6]) < 1e-9
    if rows[e, 7] != 0.0 and rows[s, 7] == rows[e, 7] and same:
        return True
    return (s == links[0, e] and turns[e] < SMOOTH) or (s == links[1, e] and turns[s] < SMOOTH)


@kernel("int64(int64[:, ::1], int64, int64, int64)", counts=False)
def common_vertex(links, n, a, b):
    """Return the row that starts at the vertex two sites share, -1 for none."""
    if a >= n and b >= n:
        return -1
    if a >= n or b >= n:
        row, vertex = min(a, b), max(a, b) - n
        return vertex if row in (vertex, links[0, vertex]) else -1
    if links[1, a] == b:
        return b
    return a if links[1, b] == a else -1


@kernel("UniTuple(float64, 2)(float64[:, ::1], int64, boolean)", counts=False)
def _tangent(rows, i, at_end):
    if rows[i, 7] == 0.0:
        dx, dy = rows[i, 2] - rows[i, 0], rows[i, 3] - rows[i, 1]
        length = math.sqrt(dx * dx + dy * dy)
        return dx / length, dy / length
    j = 2 if at_end else 0
    scale = rows[i, 7] / rows[i, 6]
    return -(rows[i, j + 1] - rows[i, 5]) * scale, (rows[i, j] - rows[i, 4]) * scale


@kernel("float64(float64[:, ::1], float64[:, ::1], int64, int64, int64, int64, float64)", counts=False)
def governs(rows, angles, e, a, b, vertex, u):
    """Return a number that is > 0 where site a bounds the cell of element e at u, < 0 where b does.

    Sites that share a smooth or reflex `vertex` (else -1) have curvatures that only touch: there the disc's centre
    passes the normal at the vertex instead.
    """
    px, py, nx, ny = foot(rows, angles, e, u)
    f, g = curvature(rows, e, a, px, py, nx, ny), curvature(rows, e, b, px, py, nx, ny)
    if vertex < 0:
        return (f - g) / (abs(f) + abs(g))
    k = max(f, g)
    if k <= 0.0:
        return 0.0
    row = a if a < len(rows) else b
    ends_there = vertex != row
    tx, ty = _tangent(rows, row, ends_there)
    past = (px + nx / k - rows[vertex, 0]) * tx + (py + ny / k - rows[vertex, 1]) * ty
    within = -past if ends_there else past
    return within * k if row == a else -within * k
