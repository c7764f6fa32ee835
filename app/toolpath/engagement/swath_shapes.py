"""What a cutter sweeps along lines and arcs, as the convex shapes of `rim_kernels`.

A line sweeps a rectangle: a strip of the cutter's width, cut by the disc through the rectangle's corners, which at no
height within the strip reaches beyond the round ends of what is swept. An arc sweeps a ring, which is not convex: in
pieces of it lie wedges, from a point between the ring's bounds to the two ends of the piece's outer rim, with the rim
itself as third side. At every end of a piece stands the cutter's disc.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows, sweep_of

Floats = NDArray[np.float64]

_PIECE = 1.0
"""Radii of the cutter that the outer rim of a wedge is long at most."""

_WIDEST = 0.6
"""Radians of an arc that one wedge takes at most."""

_DEEP = 1.7
"""Radii of the cutter that a wedge is deep, of the two that are swept."""


def swath_shapes(rows: Rows, radius: float) -> Floats:
    """Return shapes (n, 9), all within what a cutter sweeps along rows, their outer bounds the swath's own.

    Args:
        rows: (m, 8). radius: of the cutter, mm.
    """
    made: dict[tuple[float, ...], None] = {}
    for row in rows.tolist():
        made.update(dict.fromkeys(_of_line(row, radius) if row[7] == 0 else _of_arc(row, radius)))
    return np.array(list(made)).reshape(-1, 9)


def _disc(x: float, y: float, radius: float) -> tuple[float, ...]:
    return (x, y, radius, 0.0, 0.0, math.inf, 0.0, 0.0, math.inf)


def _of_line(row: list[float], radius: float) -> list[tuple[float, ...]]:
    x0, y0, x1, y1 = row[:4]
    ends = [_disc(x0, y0, radius), _disc(x1, y1, radius)]
    long = math.hypot(x1 - x0, y1 - y0)
    if long == 0.0:
        return ends[:1]
    nx, ny = (y1 - y0) / long, (x0 - x1) / long
    height = nx * x0 + ny * y0
    strip = (nx, ny, height + radius, -nx, -ny, radius - height)
    return [*ends, ((x0 + x1) / 2, (y0 + y1) / 2, math.hypot(long / 2, radius), *strip)]


def _of_arc(row: list[float], radius: float) -> list[tuple[float, ...]]:
    cx, cy, turn = row[4:7]
    sweep = sweep_of(row)
    first = math.atan2(row[1] - cy, row[0] - cx)
    if sweep < 0:
        first, sweep = first + sweep, -sweep
    reach = turn + radius
    count = math.ceil(max(sweep / _WIDEST, sweep * reach / (_PIECE * radius), 1.0))
    half = sweep / count / 2
    # the wedge's tip: deep, within the ring, and no side of the wedge may come nearer to the centre than it does
    tip = min(max(reach - _DEEP * radius, abs(turn - radius) + 1e-9), reach * math.cos(half))
    made = [_disc(row[0], row[1], radius), _disc(row[2], row[3], radius)]
    for k in range(count):
        ahead = first + (2 * k + 1) * half
        if k:
            made.append(_disc(cx + turn * math.cos(ahead - half), cy + turn * math.sin(ahead - half), radius))
        made.append(_wedge((cx, cy, reach), tip, ahead, half))
    return made


def _wedge(rim: tuple[float, float, float], tip: float, ahead: float, half: float) -> tuple[float, ...]:
    """Return the wedge from a point `tip` mm from the rim's centre to the rim, `half` radians to both sides."""
    cx, cy, reach = rim
    x, y = cx + tip * math.cos(ahead), cy + tip * math.sin(ahead)
    along, across = reach * math.cos(half) - tip, reach * math.sin(half)
    spread = math.atan2(across, along)
    right, left = ahead - spread - math.pi / 2, ahead + spread + math.pi / 2
    n, m = (math.cos(right), math.sin(right)), (math.cos(left), math.sin(left))
    return (cx, cy, reach, *n, n[0] * x + n[1] * y, *m, m[0] * x + m[1] * y)
