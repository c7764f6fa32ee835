"""Compiled: the exact least distance of pairs of lines and arcs, see `app.verify.clearance`.

A row is start, end, centre, radius and turn (0 a line, +1 or -1 an arc); an arc that ends where it begins is a circle.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.jit import kernel

_ROW, _ROWS, _FOUND = "float64[:]", "float64[:, ::1]", "float64[::1]"
_ON = 1e-12
"""Radians by which a direction may miss an arc's end and still count as on it."""
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


@kernel(f"void({_ROWS}, {_ROWS}, int64[::1], int64[::1], {_FOUND}, {_ROWS})")
def pair_distances(first, second, one, other, distances, places):
    """Write the least distance of each pair of curves, mm, and where on the first curve it is.

    Args:
        one, other: (n,) rows of both that make a pair. distances: (n,) out. places: (n, 2) out.
    """
    tried = np.empty((_MOST, 2))
    # Where two curves are nearest, one of them ends, or they have one normal, or they cross: eight places of the first
    # curve. Each is laid on both curves before it is measured, so one that is on neither is never too near.
    for k in range(len(one)):
        a, b = first[one[k]], second[other[k]]
        tried[0, 0], tried[0, 1], tried[1, 0], tried[1, 1] = a[0], a[1], a[2], a[3]
        tried[2, 0], tried[2, 1] = _on(a, b[0], b[1])
        tried[3, 0], tried[3, 1] = _on(a, b[2], b[3])
        tried[4, 0], tried[4, 1], tried[5, 0], tried[5, 1] = _common_normals(a, b)
        tried[6, 0], tried[6, 1], tried[7, 0], tried[7, 1] = _crossings(a, b)
        distances[k] = math.inf
        for m in range(_MOST):
            if m > 3 and not (math.isfinite(tried[m, 0]) and math.isfinite(tried[m, 1])):
                continue
            x, y = _on(a, tried[m, 0], tried[m, 1])
            px, py = _on(b, x, y)
            distance = math.hypot(x - px, y - py)
            if distance < distances[k]:
                distances[k], places[k, 0], places[k, 1] = distance, x, y
