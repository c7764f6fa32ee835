"""Points to curves: corners kept, and between them splines, each proven to be in the tube round its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, Nurbs
from ..fitted import FittedPath, Ints, RefusalReason, SplineRefusal, chained, lines_between, spline_motion
from .bspline import FitRound, fit_spline
from .corners import corners
from .cubic_approximation import cubic_near
from .smoothness import of_curve, of_points
from .space_curve import curve_of_motions
from .tube import ToleranceTube

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""

_ASTRAY = 0.5
"""Cosine of the angle that a spline may set out away from its points."""

_DENSER, _BESIDE = 24, 2
"""Where a spline has to be, so often so many chords on either side of a bend are halved that none holds yet."""


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
        insist: one spline from corner to corner, however many blocks it takes; the rest stands only where the control
            cannot be told of one.
        observer: is shown every round of every spline that is fitted.
    """

    tube: ToleranceTube
    degree: int = 3
    cubic: float = 0.0
    corner: float = np.radians(30.0)
    blocks: Callable[[Nurbs], int] = lambda curve: len(curve.points)
    level: bool = False
    rest: Callable[[Floats, Progress], FittedPath] = lambda points, _: _chords(points)
    insist: bool = False
    observer: Callable[[FitRound], None] | None = None


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
    if options.insist:
        return _insisted(points, options, progress)
    path = chained(_fitted(points, options, progress))
    if not path.motions.splines or len(path.motions) == 1:
        return path
    bend = of_curve(curve_of_motions(path.motions), points[:0]).bend
    if bend <= of_points(points, points[:0]).bend:
        return path
    return _rest(points, options, progress, RefusalReason.BENT, _blocks(path, options))


def _rest(
    points: Floats, options: SplineOptions, progress: Progress, reason: RefusalReason, blocks: int = 0
) -> FittedPath:
    """Return what stands where there is no spline, and why."""
    made = options.rest(points, progress)
    return replace(made, refusals=(SplineRefusal(reason, blocks, len(made.motions)),))


def _fitted(points: Floats, options: SplineOptions, progress: Progress) -> list[FittedPath]:
    """Return what replaces the points between two corners, cut at further ones where it has to be."""
    if options.level and np.ptp(points[:, 2]) > 0:
        return [_rest(points, options, progress, RefusalReason.LEVEL)]
    if len(points) <= options.degree + 1:
        return [_rest(points, options, progress, RefusalReason.SHORT)]
    made = fit_spline(points, options.tube, options.degree, progress, options.observer)
    if isinstance(made, np.ndarray):
        edges = [0, *made.tolist(), len(points) - 1]
        parts = [part for a, b in pairwise(edges) for part in _fitted(points[a : b + 1], options, progress)]
    else:
        curve = cubic_near(made.curve, options.cubic) if options.cubic else made.curve
        parts = [FittedPath(spline_motion(curve), np.array([len(points) - 1]))]
        if _hooked(curve, points, _REACH * options.tube.widest):
            return [_rest(points, options, progress, RefusalReason.HOOKED, _blocks(parts[0], options))]
    blocks = sum(_blocks(part, options) for part in parts)
    return parts if blocks < len(points) - 1 else [_rest(points, options, progress, RefusalReason.BLOCKS, blocks)]


def _insisted(points: Floats, options: SplineOptions, progress: Progress) -> FittedPath:
    """Return one spline for all points between two corners, whatever it takes: smooth of the second order all along.

    Where none is found, places on the chords beside the points that would need a corner are points, too, until one
    rounds them within the tube: it has room for a curve at every bend, however small. Such places lie within the
    chord's region as wide as it is at the points.
    """
    if options.level and np.ptp(points[:, 2]) > 0:
        return _rest(points, options, progress, RefusalReason.LEVEL)
    dense, tube = points, options.tube
    while len(dense) <= options.degree + 1:
        dense, tube = _with_middles(dense, np.arange(len(dense) - 1)), ToleranceTube(tube.radius)
    for _ in range(_DENSER):
        made = fit_spline(dense, tube, options.degree, progress, options.observer)
        if not isinstance(made, np.ndarray):
            curve = cubic_near(made.curve, options.cubic) if options.cubic else made.curve
            return FittedPath(spline_motion(curve), np.array([len(points) - 1]))
        beside = np.unique(np.clip(made[:, None] + np.arange(-_BESIDE, _BESIDE), 0, len(dense) - 2))
        dense, tube = _with_middles(dense, beside), ToleranceTube(tube.radius)
    return _rest(points, options, progress, RefusalReason.UNPROVEN)


def _with_middles(points: Floats, chords: Ints) -> Floats:
    """Return points (n, 3) with the middles of some chords, by number, among them."""
    middles = (points[chords] + points[chords + 1]) / 2
    return np.ascontiguousarray(np.insert(points, chords + 1, middles, axis=0))


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
