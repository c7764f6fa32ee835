"""Exact distance between tool path and walls in closed form: a second opinion that shares no code with the path makers.

Two plane curves that do not cross are nearest at an end of one of them, or where both have the same normal: at the
foot of an arc's centre on a line, or on the line through two arcs' centres. Where they cross, the distance is 0. So a
few candidate points on the first curve, measured against the second, hold the exact minimum. Rows of curves are
those of `app.geometry.primitives`, of any sweep.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.primitives import CX, TURN, R

Floats = NDArray[np.float64]

_ON = 1e-12
"""Radians by which a direction may miss an arc's end and still count as on it."""


def curve_distance(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return the least distance of each pair of curves, and where on the first curve it is.

    Args:
        first, second: (n, 8) rows; line k of one belongs to line k of the other.

    Returns:
        Distances (n,), mm, and points (n, 2), mm.
    """
    points = np.stack(
        [
            first[:, :2],
            first[:, 2:4],
            nearest_on(first, second[:, :2]),
            nearest_on(first, second[:, 2:4]),
            *_common_normals(first, second),
            *_crossings(first, second),
        ],
        axis=1,
    )
    count = points.shape[1]
    flat, owner = points.reshape(-1, 2), np.repeat(np.arange(len(first)), count)
    flat = nearest_on(first[owner], flat)
    distance = np.hypot(*(flat - nearest_on(second[owner], flat)).T).reshape(-1, count)
    best = np.argmin(distance, axis=1)
    each = np.arange(len(first))
    return distance[each, best], flat.reshape(-1, count, 2)[each, best]


def nearest_on(rows: Floats, points: Floats) -> Floats:
    """Return the point (n, 2) of each row that is nearest to its point; NaN points give the row's start."""
    points = np.where(np.isfinite(points), points, rows[:, :2])
    line = _nearest_on_line(rows, points)
    arc = rows[:, TURN] != 0
    if not np.any(arc):
        return line
    line[arc] = _nearest_on_arc(rows[arc], points[arc])
    return line


def _nearest_on_line(rows: Floats, points: Floats) -> Floats:
    along = rows[:, 2:4] - rows[:, :2]
    square = np.sum(along**2, axis=1)
    part = np.sum((points - rows[:, :2]) * along, axis=1) / np.where(square > 0, square, 1)
    foot = rows[:, :2] + along * np.clip(part, 0, 1)[:, None]
    return np.where((part >= 1)[:, None], rows[:, 2:4], foot)


def _nearest_on_arc(rows: Floats, points: Floats) -> Floats:
    centre, radius = rows[:, CX:R], rows[:, R]
    away = points - centre
    length = np.hypot(away[:, 0], away[:, 1])
    unit = away / np.where(length > 0, length, 1)[:, None]
    ends = np.stack([rows[:, :2], rows[:, 2:4]], axis=1)
    to_ends = np.hypot(*np.moveaxis(ends - points[:, None], 2, 0))
    nearer = ends[np.arange(len(rows)), np.argmin(to_ends, axis=1)]
    on = (length > 0) & _passes(rows, np.arctan2(unit[:, 1], unit[:, 0]))
    return np.where(on[:, None], centre + unit * radius[:, None], nearer)


def _passes(rows: Floats, direction: Floats) -> NDArray[np.bool_]:
    """Tell whether each arc passes a direction as seen from its centre, radians."""
    a = np.arctan2(rows[:, 1] - rows[:, 5], rows[:, 0] - rows[:, 4])
    b = np.arctan2(rows[:, 3] - rows[:, 5], rows[:, 2] - rows[:, 4])
    turn = rows[:, TURN]
    sweep = (turn * (b - a)) % (2 * np.pi)
    sweep = np.where(np.all(rows[:, :2] == rows[:, 2:4], axis=1), 2 * np.pi, sweep)
    ahead = (turn * (direction - a) + _ON) % (2 * np.pi)
    return ahead <= sweep + 2 * _ON


def _common_normals(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return two points (n, 2) of the first curve's carrier whose normals may be the second's too; NaN where none."""
    arc1, arc2 = first[:, TURN] != 0, second[:, TURN] != 0
    centre1, centre2 = first[:, CX:R], second[:, CX:R]
    along = np.where(arc2[:, None], centre2 - centre1, _perpendicular(second[:, 2:4] - second[:, :2]))
    length = np.hypot(along[:, 0], along[:, 1])
    unit = along / np.where(length > 0, length, np.nan)[:, None]
    reach = unit * first[:, [R]]
    foot = _nearest_on_line(first, centre2)
    nothing = np.full_like(foot, np.nan)
    straight = np.where(arc2[:, None], foot, nothing)
    return (np.where(arc1[:, None], centre1 + reach, straight), np.where(arc1[:, None], centre1 - reach, nothing))


def _perpendicular(vectors: Floats) -> Floats:
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _crossings(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Return up to two points (n, 2) where the carriers (line, circle) of the curves cross; NaN where they do not."""
    arc1, arc2 = (first[:, TURN] != 0)[:, None], (second[:, TURN] != 0)[:, None]
    lines = _line_line(first, second)
    circle_of_second = _line_circle(first, second[:, CX:R], second[:, R])
    circle_of_first = _line_circle(second, first[:, CX:R], first[:, R])
    circles = _circle_circle(first, second)
    found = []
    for k in (0, 1):
        with_line = np.where(arc2, circle_of_second[k], lines if k == 0 else np.nan)
        found.append(np.where(arc1, np.where(arc2, circles[k], circle_of_first[k]), with_line))
    return found[0], found[1]


def _line_line(first: Floats, second: Floats) -> Floats:
    u, v = first[:, 2:4] - first[:, :2], second[:, 2:4] - second[:, :2]
    across = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    between = second[:, :2] - first[:, :2]
    part = (between[:, 0] * v[:, 1] - between[:, 1] * v[:, 0]) / np.where(across != 0, across, np.nan)
    return first[:, :2] + u * part[:, None]


def _line_circle(rows: Floats, centre: Floats, radius: Floats) -> tuple[Floats, Floats]:
    u = rows[:, 2:4] - rows[:, :2]
    square = np.sum(u**2, axis=1)
    square = np.where(square > 0, square, np.nan)
    foot = rows[:, :2] + u * (np.sum((centre - rows[:, :2]) * u, axis=1) / square)[:, None]
    inside = radius**2 - np.sum((foot - centre) ** 2, axis=1)
    half = np.sqrt(np.where(inside >= 0, inside, np.nan) / square)
    return foot + u * half[:, None], foot - u * half[:, None]


def _circle_circle(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    between = second[:, CX:R] - first[:, CX:R]
    square = np.sum(between**2, axis=1)
    square = np.where(square > 0, square, np.nan)
    part = (square + first[:, R] ** 2 - second[:, R] ** 2) / (2 * square)
    inside = first[:, R] ** 2 / square - part**2
    half = np.sqrt(np.where(inside >= 0, inside, np.nan))
    foot = first[:, CX:R] + between * part[:, None]
    side = _perpendicular(between) * half[:, None]
    return foot + side, foot - side
