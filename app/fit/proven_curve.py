"""Points to curves: corners kept, and between them splines, each proven to be in the tube round its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.fit.bspline import fit_spline
from app.fit.corners import corners
from app.fit.cubic_near import cubic_near
from app.fit.fitted import FittedPath, chained, lines_between, spline_motion
from app.fit.tube import Tube
from app.model.motion import Floats, Nurbs
from app.progress import NO_PROGRESS, Progress

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""


@dataclass(frozen=True)
class SplineOptions:
    """How splines are fitted.

    Attributes:
        tube: region round the points.
        degree: 3 or 5.
        cubic: a spline of degree 5 is given as a cubic one no farther from it than this, mm; 0: as it is.
        corner: where the path turns by more than this its corner is kept, radians, in (0, pi].
        blocks: how many blocks a spline takes; one that takes more than its chords gives way to these.
        level: the control knows splines at one height only.
        rest: what stands where there is no spline: where the path rises or falls and must be level, where a spline would
            take more blocks than chords; chords unless said otherwise.
    """

    tube: Tube
    degree: int = 3
    cubic: float = 0.0
    corner: float = np.radians(30.0)
    blocks: Callable[[Nurbs], int] = lambda curve: len(curve.points)
    level: bool = False
    rest: Callable[[Floats, Progress], FittedPath] = lambda points, _: _chords(points)


def fit_splines(points: Floats, options: SplineOptions, progress: Progress = NO_PROGRESS) -> FittedPath:
    """Return splines from corner to corner, and the rest where there is none.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        options: tube, degree, corners.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    at = corners(points, options.corner, _REACH * options.tube.widest)
    parts: list[FittedPath] = []
    for k in range(len(at) - 1):
        progress.step(k / (len(at) - 1))
        parts += _fitted(points[at[k] : at[k + 1] + 1], options, progress.part(k / (len(at) - 1), (k + 1) / (len(at) - 1)))
    return chained(parts)


def _fitted(points: Floats, options: SplineOptions, progress: Progress) -> list[FittedPath]:
    """Return what replaces the points between two corners, cut at further ones where it has to be."""
    if len(points) <= options.degree + 1 or (options.level and np.ptp(points[:, 2]) > 0):
        return [options.rest(points, progress)]
    made = fit_spline(points, options.tube, options.degree, progress)
    if isinstance(made, np.ndarray):
        edges = [0, *made.tolist(), len(points) - 1]
        return [part for a, b in pairwise(edges) for part in _fitted(points[a : b + 1], options, progress)]
    curve = cubic_near(made.curve, options.cubic) if options.cubic else made.curve
    if options.blocks(curve) > len(points) - 1:
        return [options.rest(points, progress)]
    return [FittedPath(spline_motion(curve), np.array([len(points) - 1]))]


def _chords(points: Floats) -> FittedPath:
    return FittedPath(lines_between(points), np.arange(1, len(points)))
