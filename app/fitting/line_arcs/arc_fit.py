"""Points to lines and arcs, as few as keep within a tolerance of the polyline all along, both ways and in order."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, Plane
from ..fitted import FittedPath, arcs_between, chained
from ..point_curves.corners import corners
from ..point_curves.tube import ToleranceTube
from .flat_fit import FlatFit

Ints = NDArray[np.int64]

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""
BEND = math.radians(0.5)
"""A joint may turn by so much, or as much as the points do there, where nothing else is asked for."""
_MANY = 150
"""Joints of more pieces than the search has found are not moved: that takes longer than the search, and with so many it
has saved none yet.
"""


@dataclass(frozen=True, slots=True)
class ArcOptions:
    """How lines and arcs are fitted.

    Attributes:
        tolerance: at the points, mm, > 0.
        corner: where the path turns by more than this its corner is kept, radians, in (0, pi].
        largest_radius: mm; what is flatter is a line.
        arcs: whether there may be any.
        middle: half way between two points, mm, >= tolerance; None: the same.
        bend: pieces of one plane may turn by so much where they meet, radians, in (0, pi], where that saves pieces.
    """

    tolerance: float
    corner: float = math.radians(30.0)
    largest_radius: float = 1e5
    arcs: bool = True
    middle: float | None = None
    bend: float = BEND

    @property
    def tube(self) -> ToleranceTube:
        """The region round the points."""
        return ToleranceTube(self.tolerance, self.middle)


def fit_arcs(points: Floats, options: ArcOptions, progress: Progress = NO_PROGRESS) -> FittedPath:
    """Return lines and arcs that stand for points, few of them, and nearly tangent where the points do not bend.

    Each is the longest that keeps within the tolerance from the point where it begins. What lies in one plane, X Y, Z X
    or Y Z, then has its joints moved within the tolerance: by a shortest path over places for them, the fewest pieces
    that bend by no more than is allowed, and by moving those of the longest pieces until they meet without a bend, with
    as many more as that takes; whichever has fewer. Other arcs are helices: along the plane's normal they rise in step
    with the angle. No arc turns by more than 230 degrees.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        options: tolerance, corners.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    at = corners(points, options.corner, _REACH * options.tube.widest)
    parts = []
    for k in range(len(at) - 1):
        share = progress.part(k / (len(at) - 1), (k + 1) / (len(at) - 1))
        parts.append(_between_corners(points[at[k] : at[k + 1] + 1], options, share))
    return chained(parts)


def _between_corners(points: Floats, options: ArcOptions, progress: Progress) -> FittedPath:
    progress.step(0.0, "Fitting lines and arcs")
    greedy = _greedy(points, options)
    if not options.arcs or len(greedy) < 2:
        return greedy.path(points)
    parts = []
    for first, stop, plane in _runs(points, greedy):
        share = progress.part(first / len(greedy), stop / len(greedy))
        part = greedy.part(first, stop)
        a, b = part.at[0], part.at[-1]
        smooth = _flat(points[a : b + 1], options, plane, share) if plane is not None and len(part) > 1 else None
        parts.append(smooth or part.path(points))
    return chained(parts)


@dataclass(frozen=True, eq=False)
class _Greedy:
    """Pieces from point to point.

    Attributes:
        at: (m + 1,) their ends' points. plane: (m,). half: (m,) half of the sweep, radians, positive to the left; 0 a
            line.
    """

    at: Ints
    plane: NDArray[np.uint8]
    half: Floats

    def __len__(self) -> int:
        return len(self.half)

    def part(self, first: int, stop: int) -> _Greedy:
        """Return some of them."""
        return _Greedy(self.at[first : stop + 1], self.plane[first:stop], self.half[first:stop])

    def path(self, points: Floats) -> FittedPath:
        """Return them as motions between these points."""
        return FittedPath(arcs_between(points[self.at], self.half, self.plane), self.at[1:] - self.at[0])


def _greedy(points: Floats, options: ArcOptions) -> _Greedy:
    """Return the longest pieces, one after the other."""
    from . import arc_fit_kernels as kernels

    level = np.ptp(points, axis=0) == 0
    views = [plane for plane in Plane if not level[list(plane.axes[:2])].any()] if options.arcs else []
    views = views or [Plane.XY]
    planes = np.ascontiguousarray(np.stack([points[:, plane.axes] for plane in views]))
    rows, heights = np.empty((len(points), 3), np.int64), np.empty(len(points))
    count = kernels.greedy(
        planes,
        0,
        len(points) - 1,
        options.tolerance,
        options.tube.swell,
        options.largest_radius,
        int(options.arcs),
        rows,
        heights,
    )
    at = np.concatenate([[0], rows[:count, 0]])
    plane = np.array(views, np.uint8)[rows[:count, 2]]
    axes = np.array([each.axes for each in Plane])[plane]
    row = np.arange(count)
    chords = points[at[1:]] - points[at[:-1]]
    sizes = np.hypot(chords[row, axes[:, 0]], chords[row, axes[:, 1]])
    arc = rows[:count, 1] == kernels.ARC
    half = np.where(arc, -2 * np.arctan2(heights[:count], 0.5 * sizes), 0.0)
    return _Greedy(at, plane, half)


def _runs(points: Floats, greedy: _Greedy) -> list[tuple[int, int, Plane | None]]:
    """Return pieces that follow one another in one plane: the first, the one behind the last, and the plane; None: they
    lie in none.
    """
    arc = greedy.half != 0
    moves = np.concatenate([np.zeros((1, 3), np.int64), np.cumsum(np.diff(points, axis=0) != 0, axis=0)])[greedy.at]
    level = np.diff(moves, axis=0) == 0
    within = np.column_stack([level[:, plane.axes[2]] & (~arc | (greedy.plane == plane)) for plane in Plane])
    runs: list[tuple[int, int, Plane | None]] = []
    first, now = 0, within[0]
    for k in range(1, len(greedy) + 1):
        both = now & within[k] if k < len(greedy) else np.zeros(3, bool)
        if k == len(greedy) or both.any() != now.any():
            runs.append((first, k, Plane(int(np.argmax(now))) if now.any() else None))
            first, both = k, within[k] if k < len(greedy) else both
        now = both
    return runs


def _flat(points: Floats, options: ArcOptions, plane: Plane, progress: Progress) -> FittedPath | None:
    """Return few pieces in a plane, proven to keep to the tolerance; None where they are not, or would not be fewer
    than chords.

    What bends more is taken only where it takes fewer pieces.
    """
    flat, strict = (
        FlatFit(points, plane, options.tube, _REACH * options.tube.widest, options.largest_radius),
        min(options.bend, BEND),
    )
    best = flat.fewest(strict, len(points) - 1)
    count = len(best) if best is not None else len(points) - 1
    moved = None
    if best is None or len(best) <= _MANY:
        moved = flat.moved(strict, count + 1 if best is not None and best.bend > strict else count, progress)
    best = moved.better(best) if moved is not None else best
    if options.bend > strict:
        bent = flat.fewest(options.bend, len(best) if best is not None else count)
        best = bent or best
    return best.path if best is not None else None
