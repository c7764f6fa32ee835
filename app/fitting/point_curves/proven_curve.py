"""Points to curves: corners kept, and between them splines, each proven to be in the tube round its points.

Splines of degree 5 are written as cubics near them, since no control knows more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats, Nurbs
from ..fitted import FittedPath, Ints, RefusalReason, SplineRefusal, chained, lines_between, spline_motion
from .bspline import FitRound, SplineFit, fit_spline, fit_spline_behind
from .corners import corners
from .smoothness import of_curve, of_points
from .space_curve import curve_of_motions
from .tube import ToleranceTube

_REACH = 4.0
"""Corners are looked for over so many tolerances of the path."""

_ASTRAY = 0.5
"""Cosine of the angle that a spline may set out away from its points."""

LONGEST = 20_000
"""Points that are fitted at a time: a longer run is cut into pieces, as the text has it, each of which begins with the
direction and the curvature that the one before it ends with.
"""

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
        observer: is shown every round of every spline that is fitted, of a run in pieces those of the first.
        longest: points that are fitted at a time, >= 100.
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
    longest: int = LONGEST


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
    edges = _level_edges(points, options)
    if len(edges) > 2:
        return [part for a, b in pairwise(edges) for part in _fitted(points[a : b + 1], options, progress)]
    if options.level and np.ptp(points[:, 2]) > 0:
        return [_rest(points, options, progress, RefusalReason.LEVEL)]
    if len(points) <= options.degree + 1:
        return [_rest(points, options, progress, RefusalReason.SHORT)]
    made = _in_pieces(points, options.tube, options, progress)
    if isinstance(made, np.ndarray):
        edges = [0, *made.tolist(), len(points) - 1]
        parts = [part for a, b in pairwise(edges) for part in _fitted(points[a : b + 1], options, progress)]
    else:
        parts = _written(made, options)
        curves = [curve for part in parts for curve in part.motions.splines.values()]
        ends = [0, *(int(part.last[-1]) for part in parts)]
        runs = zip(curves, pairwise(np.cumsum(ends)), strict=True)
        if any(_hooked(curve, points[a : b + 1], _REACH * options.tube.widest) for curve, (a, b) in runs):
            blocks = sum(_blocks(part, options) for part in parts)
            return [_rest(points, options, progress, RefusalReason.HOOKED, blocks)]
    blocks = sum(_blocks(part, options) for part in parts)
    return parts if blocks < len(points) - 1 else [_rest(points, options, progress, RefusalReason.BLOCKS, blocks)]


def _level_edges(points: Floats, options: SplineOptions) -> list[int]:
    """Return the numbers of the points, the outer ones among them, between which a run is at one height and bends, or
    is not at one height, where the control knows splines at one height only.

    A level run of too few points for a spline, or one that is straight, goes with what rises beside it.
    """
    last = len(points) - 1
    if not options.level or np.ptp(points[:, 2]) == 0:
        return [0, last]
    level = np.diff(points[:, 2]) == 0
    runs = np.concatenate([[0], np.flatnonzero(np.diff(level)) + 1, [last]]).tolist()
    edges = {0, last}
    for a, b in pairwise(runs):
        if level[a] and b - a > options.degree and _bends(points[a : b + 1], options.tube.radius):
            edges |= {a, b}
    return sorted(edges)


def _bends(points: Floats, within: float) -> bool:
    """Tell whether points (n, 3) are farther than a length, mm, from the line through the outer two."""
    way, apart = points[-1] - points[0], points - points[0]
    square = max(float(way @ way), 1e-300)
    off = apart - (apart @ way / square)[:, None] * way
    return bool(np.linalg.norm(off, axis=1).max() > within)


def _in_pieces(
    points: Floats, tube: ToleranceTube, options: SplineOptions, progress: Progress
) -> list[SplineFit] | Ints:
    """Return one spline for a run of points, or for a long one several that join with one direction and one curvature;
    where there are none, the numbers of the points at which they need corners.

    Splines that are given as cubic ones near them keep no curvature where they join, so that these runs stay whole.
    """
    count = 1 if options.cubic else -(-(len(points) - 1) // options.longest)
    edges = np.linspace(0, len(points) - 1, count + 1).astype(int).tolist()
    made: list[SplineFit] = []
    for number, (a, b) in enumerate(pairwise(edges)):
        mine, far = points[a : b + 1], progress.part(number / count, (number + 1) / count)
        piece = (
            fit_spline_behind(made[-1].end, mine, tube, options.degree, far)
            if made
            else fit_spline(mine, tube, options.degree, far, options.observer)
        )
        if isinstance(piece, np.ndarray):
            return np.asarray(piece + a)
        made.append(piece)
    return made


def _written(made: list[SplineFit], options: SplineOptions) -> list[FittedPath]:
    """Return a motion for each spline; `last` counts its own points."""
    curves = [cubic_near(each.curve, options.cubic) if options.cubic else each.curve for each in made]
    return [
        FittedPath(spline_motion(curve), np.array([len(each.feet) - 1]))
        for curve, each in zip(curves, made, strict=True)
    ]


def _insisted(points: Floats, options: SplineOptions, progress: Progress) -> FittedPath:
    """Return one spline for all points between two corners, whatever it takes: smooth of the second order all along;
    where the control knows splines at one height only, one for each run at one height.

    Where none is found, places on the chords beside the points that would need a corner are points, too, until one
    rounds them within the tube: it has room for a curve at every bend, however small. Such places lie within the
    chord's region as wide as it is at the points.
    """
    edges = _level_edges(points, options)
    if len(edges) > 2:
        return chained([_insisted(points[a : b + 1], options, progress) for a, b in pairwise(edges)])
    if options.level and np.ptp(points[:, 2]) > 0:
        return _rest(points, options, progress, RefusalReason.LEVEL)
    dense, tube, own = points, options.tube, np.arange(len(points))
    while len(dense) <= options.degree + 1:
        chords = np.arange(len(dense) - 1)
        dense, own, tube = _with_middles(dense, chords), own + np.searchsorted(chords, own), ToleranceTube(tube.radius)
    for _ in range(_DENSER):
        made = _in_pieces(dense, tube, options, progress)
        if not isinstance(made, np.ndarray):
            path = chained(_written(made, options))
            return replace(path, last=np.searchsorted(own, path.last))
        beside = np.unique(np.clip(made[:, None] + np.arange(-_BESIDE, _BESIDE), 0, len(dense) - 2))
        dense, own, tube = _with_middles(dense, beside), own + np.searchsorted(beside, own), ToleranceTube(tube.radius)
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


_CUBIC, _QUINTIC = 3, 5
"""Degrees: what controls take, and what is approximated."""
_ROUNDS = 16
"""Rounds of halving spans at most: a cubic is off by the fourth power of its span."""
_AT = np.arange(_QUINTIC + 1) / _QUINTIC
"""Parameters of a span at which a piece of degree 5 is known by its values: as many as it has coefficients."""
_BINOMIAL = np.array([1, 5, 10, 10, 5, 1])
"""Of degree 5: the weights of its control points."""
_CONTROL = np.linalg.inv(_BINOMIAL * _AT[:, None] ** np.arange(6) * (1 - _AT[:, None]) ** np.arange(5, -1, -1))
"""From a quintic's values at six even parameters to its control points."""


def cubic_near(curve: Nurbs, near: float) -> Nurbs:
    """Return a cubic spline, smooth of the second order, that is nowhere farther than `near` from one of degree 5.

    It goes through the spline at its own knots, with its tangents at both ends; a span in which it is farther away,
    which the control points of their difference bound at every parameter, is halved.

    Args:
        curve: of degree 5, all weights 1, its knots clamped.
        near: mm, > 0.

    Raises:
        InputError: rounding alone is more than `near`.
    """
    from scipy.interpolate import BSpline, make_interp_spline

    given = BSpline(curve.knots, curve.points, _QUINTIC)
    slopes = given.derivative()
    breaks: Floats = np.unique(curve.knots)
    for _ in range(_ROUNDS):
        ends = [[(1, slopes(end))] for end in breaks[[0, -1]]]
        cubic = make_interp_spline(breaks, given(breaks), _CUBIC, bc_type=tuple(ends))
        at = breaks[:-1, None] + np.diff(breaks)[:, None] * _AT
        apart = np.einsum("ij,njk->nik", _CONTROL, given(at) - cubic(at))
        far = np.flatnonzero(np.sqrt(np.sum(apart**2, axis=2)).max(axis=1) > near)
        if len(far) == 0:
            points = np.array(cubic.c)
            points[[0, -1]] = curve.points[[0, -1]]
            return Nurbs(points, np.ones(len(points)), np.array(cubic.t), _CUBIC)
        breaks = np.insert(breaks, far + 1, (breaks[far] + breaks[far + 1]) / 2)
    raise InputError(
        f"No cubics come within {near:g} mm of a spline of degree 5; use {option('degree', '3')}, or a larger "
        "tolerance."
    )
