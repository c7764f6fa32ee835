# mypy: allow-untyped-defs
"""Compiled: a plane curve as chords whose middles are near it."""

from __future__ import annotations

import math

import numpy as np

from ...core.jit import kernel
from ..kernels import enlarged
from .bezier_kernels import place


@kernel("Tuple((float64[:, ::1], int64))(float64[:, :, ::1], float64, int64)")
def chords(control, tolerance, finest):
    """Return (places along a curve (m, 2), how many), so that the middle of each stretch is near that of its chord.

    Every piece has two chords at least: an S has its middle on its chord.

    Args:
        control: (n, p + 1, 3) homogeneous control points of its pieces, mm.
        tolerance: mm.
        finest: halvings of a piece after which its chords are taken as they are.
    """
    found, count = np.empty((256, 2)), 0
    work, at = np.empty((control.shape[1], 3)), np.empty(4)
    # u, x, y of where stretches end that wait, the next on top
    ends, level = (
        np.empty((finest + 2, 3)),
        np.empty(finest + 2, np.int64),
    )
    last = control.shape[1] - 1
    for k in range(len(control)):
        u, x, y = float(k), control[k, 0, 0] / control[k, 0, 2], control[k, 0, 1] / control[k, 0, 2]
        ends[0, 0], ends[0, 1], ends[0, 2] = (
            k + 1.0,
            control[k, last, 0] / control[k, last, 2],
            control[k, last, 1] / control[k, last, 2],
        )
        level[0], top, depth = 0, 1, 0
        while top > 0:
            to_u, to_x, to_y, depth = ends[top - 1, 0], ends[top - 1, 1], ends[top - 1, 2], level[top - 1]
            middle = (u + to_u) / 2
            place(control, middle, work, at)
            off = math.hypot(at[0] - (x + to_x) / 2, at[1] - (y + to_y) / 2)
            if depth < finest and (depth == 0 or off > tolerance):
                # The middle becomes the next end, before the one that waits: chords come out in order.
                level[top - 1] = depth + 1
                ends[top, 0], ends[top, 1], ends[top, 2], level[top] = middle, at[0], at[1], depth + 1
                top += 1
                continue
            if count + 2 > len(found):
                found = enlarged(found, count, 2 * len(found))
            found[count, 0], found[count, 1] = x, y
            count += 1
            u, x, y = to_u, to_x, to_y
            top -= 1
    if len(control):
        found[count, 0], found[count, 1] = (
            control[-1, last, 0] / control[-1, last, 2],
            control[-1, last, 1] / control[-1, last, 2],
        )
        count += 1
    return found, count
