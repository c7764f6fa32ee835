"""Method E's curve: a least-squares B-spline with as few spans as keep it, proven, in the tube round its points.

Spans in which the proof fails are halved, until it holds everywhere; then all are made as long as lets each use up the
same share of the tolerance. Along the way every point's place on the curve is moved to the nearest one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Nurbs
from .space_curve import DEGREE, SpaceCurve
from .tube import ToleranceTube

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

_GRID = 2**20
"""Knots are whole numbers up to it, so that words of a few digits hold them."""
_SPAN = 32
"""Chords of a span to begin with, at least."""
_ANGLE, _LEAST = 0.8, 4
"""A span to begin with turns by so much, radians; so many spans are tried however little the path turns."""
_SEEN = 4096
"""Points, about, by which a path is judged for how much it turns."""
_ROUNDS = 40
"""Rounds of halving spans that fail, at most; then the path gets a corner where it still does."""
_BETWEEN = np.array([0.25, 0.5, 0.75])
"""Where on a chord the curve is drawn to it, lightly, so that it does not swing out between points."""
_LIGHT = 0.05
"""What a place between points weighs beside a point."""
_SPREADINGS = 8
"""How often breaks are spread anew, for fewer spans."""
_MENDINGS = 6
"""Rounds in which spread breaks may be halved until all is proven; else they are given up."""
_USE = 0.7
"""How much of the tolerance a span is to use up at first."""
_LESS = 0.7
"""By so much less of it when that cannot be proven."""
_TORN = 8.0
"""By so much more than their distance the places of two samples may be apart, if that is more than the tolerance."""
_STRETCH = (0.4, 1.3)
"""How much denser breaks may become at once."""


@dataclass(frozen=True, eq=False)
class FitRound:
    """One round of the text's figure 4: a curve was made, and looked at.

    Attributes:
        control: (k, 3) control points, mm. pieces: (m, 6, 3) of its spans.
        feet: (n,) places on the pieces that answer to the points.
        farthest: distance of a point from its place, mm, the largest.
        outside: how many points are farther than the region is wide at them.
        unproven: numbers of the chords whose stretch of curve is not proven to be in its region.
        spread: whether all points were near and all chords proven before, and control points are now taken away.
    """

    control: Floats
    pieces: Floats
    feet: Floats
    farthest: float
    outside: int
    unproven: Ints
    spread: bool


@dataclass(frozen=True, eq=False)
class SplineEnd:
    """How a spline ends, for another one that goes on from it with the same direction and curvature.

    Attributes:
        slope, second: (3,) first and second derivative by a parameter that runs as the length along the points, mm.
    """

    slope: Floats
    second: Floats

    def lead(self, start: Floats, knots: Floats, degree: int) -> Floats:
        """Return the first three control points (3, 3) of a spline that begins so.

        Args:
            start: (3,) where. knots: with clamped ends, mm along the points. degree: of it, >= 2.
        """
        p, first, next_ = degree, knots[degree + 1] - knots[degree], knots[degree + 2] - knots[degree]
        turned = self.slope + self.second * first / (p - 1)  # of the derivative, the second control point
        second = start + self.slope * first / p
        return np.ascontiguousarray([start, second, second + turned * next_ / p])

    @staticmethod
    def of(control: Floats, knots: Floats, degree: int) -> SplineEnd:
        """Return how a spline with clamped ends, knots in mm, ends."""
        p, last = degree, knots[-1]
        first, next_ = last - knots[-p - 2], last - knots[-p - 3]
        slope = p * (control[-1] - control[-2]) / first
        before = p * (control[-2] - control[-3]) / next_
        return SplineEnd(slope, (p - 1) * (slope - before) / first)


@dataclass(frozen=True, eq=False)
class SplineFit:
    """A B-spline in the tube round its points.

    Attributes:
        curve: its ends are the outer points; smooth of the second order (degree 3) or the fourth (degree 5) within. Its
            knots are whole numbers.
        feet: (n,) places on its Bézier pieces that answer to the points, in [0, number of pieces].
        end: how it ends.
    """

    curve: Nurbs
    feet: Floats
    end: SplineEnd


@dataclass(frozen=True, eq=False)
class _SplineState:
    """A spline on its way.

    Attributes:
        breaks: (m + 1,) parameters between spans.
        places: (s,) parameters of the samples.
        control, pieces: of the spline and of its spans.
        bad: (n - 1,) chords that are not proven.
    """

    breaks: Floats
    places: Floats
    control: Floats
    pieces: Floats
    feet: Floats
    bad: Mask


class _Samples:
    """Points to fit: the given ones, and lighter ones on their chords."""

    def __init__(self, points: Floats) -> None:
        n = len(points)
        share = np.concatenate([[0.0], _BETWEEN])
        chords = points[:-1, None] + (points[1:] - points[:-1])[:, None] * share[None, :, None]
        self.points = np.ascontiguousarray(np.concatenate([chords.reshape(-1, 3), points[-1:]]))
        self.every = len(share)
        self.own = np.arange(n) * self.every
        self.weights = np.full(len(self.points), _LIGHT)
        self.weights[self.own] = 1.0
        steps = np.sqrt(np.sum(np.diff(self.points, axis=0) ** 2, axis=1))
        self.along = np.concatenate([[0.0], np.cumsum(steps)])


def fit_spline(
    points: Floats,
    tube: ToleranceTube,
    degree: int = 3,
    progress: Progress = NO_PROGRESS,
    observer: Callable[[FitRound], None] | None = None,
) -> SplineFit | Ints:
    """Return a spline in the tube round points; where there is none, the numbers of the points at which it needs
    corners.

    Args:
        points: (n, 3) mm, n >= 3, no two in a row alike.
        tube: region round their chords.
        degree: 3 or 5.
        progress: told of rounds; may cancel.
        observer: is shown every round.
    """
    return _FitStretch(points, tube, degree, progress, observer).fitted()


def fit_spline_behind(
    before: SplineEnd, points: Floats, tube: ToleranceTube, degree: int = 3, progress: Progress = NO_PROGRESS
) -> SplineFit | Ints:
    """Return a spline as `fit_spline` does that begins as another one has ended, or where it needs corners."""
    work = _FitStretch(points, tube, degree, progress, None)
    work.before = before
    return work.fitted()


class _FitStretch:
    """One stretch of points and what its spline has to keep to."""

    def __init__(
        self,
        points: Floats,
        tube: ToleranceTube,
        degree: int,
        progress: Progress,
        observer: Callable[[FitRound], None] | None,
    ) -> None:
        self._observer, self._spreads = observer, False
        self.before: SplineEnd | None = None
        self._points = np.ascontiguousarray(points, np.float64)
        self._samples, self._degree, self._progress = _Samples(self._points), degree, progress
        self._tube, self._squares = tube, tube.squares(1e-9)
        self.unit: float = self._samples.along[-1] / _GRID

    def knots(self, breaks: Floats) -> Floats:
        """Return the knots of spans that end at breaks."""
        return np.concatenate([np.repeat(breaks[0], self._degree), breaks, np.repeat(breaks[-1], self._degree)])

    def fitted(self) -> SplineFit | Ints:
        """Return a proven spline with few spans; or where corners are needed."""
        state = self.halved()
        if not isinstance(state, _SplineState):
            return state
        state = self.spread(state)
        knots = self.knots(np.rint(state.breaks / self.unit))
        curve = Nurbs(state.control, np.ones(len(state.control)), knots, self._degree)
        return SplineFit(curve, state.feet, SplineEnd.of(state.control, self.knots(state.breaks), self._degree))

    def halved(self) -> _SplineState | Ints:
        """Return a proven spline, made by halving spans that fail; or where corners are needed."""
        along, count = self._samples.along, len(self._points) - 1
        spans = max(1, min(round(count / _SPAN), round(self._turn() / _ANGLE) + _LEAST))
        breaks, places = np.linspace(0.0, along[-1], spans + 1), along
        for k in range(_ROUNDS):
            self._progress.step(0.0, f"fitting a curve: round {k + 1}")
            state = self._solved(breaks, places)
            if not state.bad.any():
                return state
            places = state.places
            finer = self._finer(state)
            if finer is None:
                break
            breaks = finer
        return self._corners(state)

    def _turn(self) -> float:
        """Return by how much the path turns in all, seen at some thousand points at most, radians."""
        some = self._points[:: max(1, len(self._points) // _SEEN)]
        steps = np.diff(some, axis=0)
        steps /= np.maximum(np.linalg.norm(steps, axis=1), 1e-300)[:, None]
        return float(np.sum(np.arccos(np.clip(np.einsum("ij,ij->i", steps[:-1], steps[1:]), -1.0, 1.0))))

    def _corners(self, state: _SplineState) -> Ints:
        """Return the inner points of unproven chords where the path turns the most: one of each run of such chords."""
        steps = np.diff(self._points, axis=0)
        steps /= np.linalg.norm(steps, axis=1)[:, None]
        turn = np.full(len(self._points), -1.0)
        turn[1:-1] = 1.0 - np.einsum("ij,ij->i", steps[:-1], steps[1:])
        near = np.zeros(len(turn) + 1, bool)
        near[1:-1] = state.bad
        touched = near[1:] | near[:-1]
        touched[0] = touched[-1] = False
        edges = np.flatnonzero(np.diff(np.concatenate([[False], touched, [False]]).astype(np.int8)))
        at = [first + int(np.argmax(turn[first:stop])) for first, stop in edges.reshape(-1, 2).tolist()]
        return np.array(at or [len(turn) // 2])

    def _finer(self, state: _SplineState) -> Floats | None:
        """Return breaks with each span halved that holds an unproven chord; None where nothing can be halved."""
        inner = state.feet
        low = np.clip(inner[:-1].astype(np.int64), 0, len(state.pieces) - 1)
        high = np.clip(np.ceil(inner[1:]).astype(np.int64) - 1, low, len(state.pieces) - 1)
        failed = np.zeros(len(state.pieces) + 1, np.int64)
        np.add.at(failed, low[state.bad], 1)
        np.add.at(failed, high[state.bad] + 1, -1)
        spans = np.flatnonzero(np.cumsum(failed)[:-1] > 0)
        first = np.searchsorted(state.places, state.breaks[spans], side="right")
        last = np.searchsorted(state.places, state.breaks[spans + 1], side="left") - 1
        some = last - first >= 1
        if not some.any():
            return None
        at = state.places[(first[some] + last[some]) // 2]
        return np.unique(np.concatenate([state.breaks, at]))

    def _solved(self, breaks: Floats, places: Floats) -> _SplineState:
        """Return the least-squares spline over breaks, its samples' places moved to the nearest, and what is not
        proven.
        """
        from . import bspline_kernels

        breaks = np.unique(np.rint(breaks / self.unit)) * self.unit
        samples, spans, start = self._samples, len(breaks) - 1, self._points[0]
        lead = start[None] if self.before is None else self.before.lead(start, self.knots(breaks), self._degree)
        control, pieces = np.empty((spans + self._degree, 3)), np.empty((spans, DEGREE + 1, 3))
        feet, moved, bad = np.empty(len(self._points)), np.empty(len(places)), np.empty(len(self._points) - 1, np.bool_)
        bspline_kernels.tried(
            breaks,
            self._degree,
            samples.points,
            places,
            samples.weights,
            samples.every,
            *self._squares,
            lead,
            control,
            pieces,
            feet,
            moved,
            bad,
        )
        if self._observer is not None:
            self._observer(self._round(control, pieces, feet, bad))
        return _SplineState(breaks, self._mended(moved), control, pieces, feet, bad)

    def _round(self, control: Floats, pieces: Floats, feet: Floats, bad: Mask) -> FitRound:
        """Return what there is to see of a round."""
        places = SpaceCurve(pieces, np.zeros(len(pieces), np.int64)).at(feet)
        off = np.sqrt(np.sum((places - self._points) ** 2, axis=1))
        outside = int(np.sum(off > self._tube.radius))
        return FitRound(
            control, pieces, feet, float(off.max()), outside, np.flatnonzero(bad).astype(np.int64), self._spreads
        )

    def _mended(self, places: Floats) -> Floats:
        """Return places of samples, spread again where two lie so far apart that nothing holds the curve between
        them.
        """
        along = self._samples.along
        gaps = np.diff(places)
        torn = np.flatnonzero(gaps > np.maximum(_TORN * np.diff(along), self._tube.radius))
        if not len(torn):
            return places
        free = np.zeros(len(places), bool)
        for k in torn.tolist():
            free[slice(*np.searchsorted(along, (along[k] - 2 * gaps[k], along[k + 1] + 2 * gaps[k])))] = True
        free[0] = free[-1] = False
        return np.asarray(np.interp(along, along[~free], places[~free]))

    def spread(self, state: _SplineState) -> _SplineState:
        """Return a proven spline whose spans are as long as lets their curves be equally far from the points, if it has
        fewer.
        """
        best, share, self._spreads = state, _USE, True
        for _ in range(_SPREADINGS):
            self._progress.step(0.4, f"fitting a curve: {len(best.pieces)} spans")
            made = self._halved_from(self._evened(state, share), state.places)
            if made is None:
                share *= _LESS
                continue
            state = made  # though it has more: from there it often comes to fewer
            best = made if len(made.pieces) < len(best.pieces) else best
        return best

    def _evened(self, state: _SplineState, share: float) -> Floats:
        """Return breaks so that every span is expected to use up a share of the tolerance (after de Boor's newknot)."""
        use = self._off(state) / (share * self._tube.radius)
        density = np.clip(use ** (1 / (self._degree + 1)), *_STRETCH)
        total = np.concatenate([[0.0], np.cumsum(density)])
        goals = np.linspace(0.0, total[-1], max(1, int(np.ceil(total[-1]))) + 1)
        breaks: Floats = np.interp(goals, total, state.breaks)
        return breaks

    def _halved_from(self, breaks: Floats, places: Floats) -> _SplineState | None:
        """Return a proven spline made from breaks by halving spans that fail; None where it takes too much."""
        for _ in range(_MENDINGS):
            made = self._solved(breaks, places)
            if not made.bad.any():
                return made
            places, finer = made.places, self._finer(made)
            if finer is None:
                return None
            breaks = finer
        return None

    def _off(self, state: _SplineState) -> Floats:
        """Return how far the curve of each span is found from its chords, mm."""
        from . import tube_feet_kernels

        off = np.empty(len(state.pieces))
        tube_feet_kernels.off_chords(state.pieces, self._points, state.feet, off)
        return off
