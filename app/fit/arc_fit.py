"""Points to lines and arcs, as few as keep within a tolerance of the polyline all along, both ways and in order."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.fit.corners import corners
from app.fit.fitted import FittedPath
from app.model.motion import Floats, MotionKind, Motions, Plane
from app.progress import NO_PROGRESS, Progress

Ints = NDArray[np.int64]

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""


@dataclass(frozen=True, slots=True)
class ArcOptions:
    """How lines and arcs are fitted.

    Attributes:
        tolerance: mm, > 0.
        corner: where the path turns by more than this its corner is kept, radians, in (0, pi].
        largest_radius: mm; what is flatter is a line.
        arcs: whether there may be any.
    """

    tolerance: float
    corner: float = math.radians(30.0)
    largest_radius: float = 1e5
    arcs: bool = True


def fit_arcs(points: Floats, options: ArcOptions, progress: Progress = NO_PROGRESS) -> FittedPath:
    """Return lines and arcs that begin and end at points; each is the longest that keeps within the tolerance from where it begins.

    Arcs lie in the plane X Y, Z X or Y Z; along its normal they rise in step with the angle (helices). None stands for fewer
    than three chords, and none turns by more than 230 degrees.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        options: tolerance, corners.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from app.fit import arc_fit_kernels as kernels

    at = corners(points, options.corner, _REACH * options.tolerance)
    views = [Plane.XY, Plane.ZX, Plane.YZ] if options.arcs else [Plane.XY]
    planes = np.ascontiguousarray(np.stack([points[:, plane.axes] for plane in views]))
    rows, heights = np.empty((len(points), 3), np.int64), np.empty(len(points))
    count = 0
    for k in range(len(at) - 1):
        progress.step(k / len(at), "Fitting lines and arcs")
        count += kernels.greedy(
            planes, at[k], at[k + 1], options.tolerance, options.largest_radius, int(options.arcs), rows[count:], heights[count:]
        )
    return _path(points, rows[:count], heights[:count], views)


def _path(points: Floats, rows: Ints, heights: Floats, views: list[Plane]) -> FittedPath:
    """Return what the kernel found as motions."""
    last, count = rows[:, 0].copy(), len(rows)
    start, end = points[np.concatenate([[0], last[:-1]])], points[last]
    arc = rows[:, 1] == 1
    kind = np.where(arc, np.where(heights > 0, MotionKind.ARC_CW, MotionKind.ARC_CCW), MotionKind.LINE).astype(np.uint8)
    plane = np.where(arc, np.array(views)[rows[:, 2]], Plane.XY).astype(np.uint8)
    axes = np.array([each.axes for each in Plane])[plane]
    row = np.arange(count)[:, None]
    a, b = start[row, axes], end[row, axes]
    chord = b[:, :2] - a[:, :2]
    size = np.hypot(chord[:, 0], chord[:, 1])
    flat = np.where(arc, heights, 1.0)
    up = np.where(arc, (0.25 * size**2 - flat**2) / (2 * flat) / np.where(arc, size, 1.0), 0.0)
    own = a.copy()
    own[:, 0] = (a[:, 0] + b[:, 0]) / 2 + up * chord[:, 1]
    own[:, 1] = (a[:, 1] + b[:, 1]) / 2 - up * chord[:, 0]
    centre = np.empty_like(own)
    centre[row, axes] = own
    centre[~arc] = np.nan
    whole = np.zeros(count, np.int32)
    motions = Motions(
        start, end, centre, kind, plane, arc.astype(np.int32), np.full(count, np.nan), whole, whole.copy(),
    )  # fmt: skip
    return FittedPath(motions, last)
