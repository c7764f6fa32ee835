"""Points to curves: corners kept, and between them splines, each proven to be in the tube round its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, Nurbs
from ..fitted import FittedPath, chained, lines_between, spline_motion
from .bspline import fit_spline
from .corners import corners
from .cubic_approximation import cubic_near
from .smoothness import of_curve, of_points
from .space_curve import curve_of_motions
from .tube import ToleranceTube

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""

_ASTRAY = 0.5
"""Cosine of the angle that a spline may set out away from its points."""


@dataclass(frozen=True)
class SplineOptions:
    """How splines are fitted.

    Attributes:
        tube: region round the points.
        degree: 3 or 5.
        cubic: a spline of degree 5 is given as a cubic one no farther from it than this, mm; 0: as it is.
        corner: where the path turns by more than this its corner is kept, radians, in (0, pi].
        blocks: how many blocks a spline takes; one that takes no fewer than its chords gives way.
        level: the control knows splines at one height only.
        rest: what stands where there is no spline: where the path rises or falls and must be level, where a spline
            would take no fewer blocks than chords; chords unless said otherwise.
    """

    tube: ToleranceTube
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
        parts.append(
            _between_corners(
                points[at[k] : at[k + 1] + 1], options, progress.part(k / (len(at) - 1), (k + 1) / (len(at) - 1))
            )
        )
    return chained(parts)


def _between_corners(points: Floats, options: SplineOptions, progress: Progress) -> FittedPath:
    """Return splines and the rest, which do not bend more than the points where they meet; else nothing but the
    rest.
    """
    path = chained(_fitted(points, options, progress))
    if not path.motions.splines or len(path.motions) == 1:
        return path
    bend = of_curve(curve_of_motions(path.motions), points[:0]).bend
    return path if bend <= of_points(points, points[:0]).bend else options.rest(points, progress)


def _fitted(points: Floats, options: SplineOptions, progress: Progress) -> list[FittedPath]:
    """Return what replaces the points between two corners, cut at further ones where it has to be."""
    if len(points) <= options.degree + 1 or (options.level and np.ptp(points[:, 2]) > 0):
        return [options.rest(points, progress)]
    made = fit_spline(points, options.tube, options.degree, progress)
    if isinstance(made, np.ndarray):
        edges = [0, *made.tolist(), len(points) - 1]
        parts = [part for a, b in pairwise(edges) for part in _fitted(points[a : b + 1], options, progress)]
    else:
        curve = cubic_near(made.curve, options.cubic) if options.cubic else made.curve
        parts = [FittedPath(spline_motion(curve), np.array([len(points) - 1]))]
        if _hooked(curve, points, _REACH * options.tube.widest):
            return [options.rest(points, progress)]
    return (
        parts if sum(_blocks(part, options) for part in parts) < len(points) - 1 else [options.rest(points, progress)]
    )


def _hooked(curve: Nurbs, points: Floats, reach: float) -> bool:
    """Tell whether a spline sets out or arrives where its points do not lead, seen over a length, mm: a hook within the
    tube.
    """
    for way, there in ((curve.points, points), (curve.points[::-1], points[::-1])):
        off = np.linalg.norm(there - there[0], axis=1)
        chord = there[int(np.argmax(off >= min(reach, off.max())))] - there[0]
        first = way[int(np.argmax(np.any(way != way[0], axis=1)))] - way[0]
        if chord @ first < _ASTRAY * np.linalg.norm(chord) * np.linalg.norm(first):
            return True
    return False


def _blocks(path: FittedPath, options: SplineOptions) -> int:
    splines = path.motions.splines
    return len(path.motions) - len(splines) + sum(options.blocks(curve) for curve in splines.values())


def _chords(points: Floats) -> FittedPath:
    return FittedPath(lines_between(points), np.arange(1, len(points)))
