"""Step 407: where arcs and lines meet with slight bends no circle is meant but a free curve; it becomes smooth.

Round each such bend a biarc leads from one piece into the next, from the middle of an arc, where its points tell best
how the curve runs, to the middle of the next. So the curve is one of arcs, which machines understand, without a corner.
Bends at which that leads too far from the points stay. What bends more is a vertex; what bends less than `_LEAST`
is left alone: it would cost nearness and win nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import TURN, turns
from .smoothed_path import PieceKind, SmoothedPath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

NO_BEND = math.radians(0.1)
"""What bends less is tangent."""

_LEAST = math.radians(1.0)
_MOST = math.radians(20.0)
"""Bends between these become smooth: less stays as it is, more is a vertex that is meant."""


def without_bends(path: SmoothedPath, points: Floats, limit: float) -> SmoothedPath:
    """Return a closed path of lines and arcs without its slight bends, as far as its points allow.

    Args:
        points: what the path was made from, three times over.
        limit: points may be so far from the new path, counted as in `joint_kernels.deviations`.
    """
    from . import joint_kernels, rest_kernels

    count, turn, arc = len(path.rows), turns(path.rows, np.arange(-1, len(path.rows) - 1)), path.rows[:, TURN] != 0
    bent = (path.joined == joint_kernels.CROSSING) & (turn > _LEAST) & (turn < _MOST) & (arc | np.roll(arc, 1))
    anchors = np.empty((count, 2, 4)), np.empty((count, 2), np.int64)
    rest_kernels.anchor(points, (path.ends, path.rows), bent, anchors)
    while bent.any():
        made, origin = _smoothed(path, points, anchors, bent)
        if made is None:
            continue
        worst = np.empty((len(origin), 2))
        joint_kernels.deviations(points, made.ends, made.carriers, made.rows, worst)
        failed = origin[worst[:, 1] > limit]
        if not (bent[failed] | bent[(failed + 1) % count]).any():
            return replace(made, deviation=float(worst[:, 0].max()))
        bent[failed] = bent[(failed + 1) % count] = False
    return path


def _smoothed(
    path: SmoothedPath, points: Floats, anchors: tuple[Floats, Ints], bent: Mask
) -> tuple[SmoothedPath | None, Ints]:
    """Return a path with biarcs round its bends, and the number of the old row that each row is part of or leads to.

    Where a bend has no biarc, there is no path, and the bend is taken off the list.
    """
    from . import joint_kernels, rest_kernels

    most = 4 * len(bent)
    ends, rows, carriers = np.empty(most + 1, np.int64), np.zeros((most, 8)), np.empty((most, 5))
    origin, free = np.empty(most, np.int64), np.empty(most, np.bool_)
    count = rest_kernels.smoothed(
        points, (path.ends, path.rows, path.carriers, *anchors), bent, (ends, rows, carriers), (origin, free)
    )
    if not count:
        return None, origin
    origin, free = origin[:count], free[:count]
    begins_anew = origin != np.roll(origin, 1)
    joined = np.where(begins_anew & ~bent[origin], path.joined[origin], joint_kernels.TANGENT).astype(np.uint8)
    kinds = np.where(free, PieceKind.SPLINE, path.kinds[origin])
    return replace(
        path, rows=rows[:count], kinds=kinds, ends=ends[: count + 1], joined=joined, carriers=carriers[:count]
    ), origin
