"""A smooth surface of heights through scattered places: a bicubic B-spline, as coarse as the places themselves allow.

How many spans it has is not asked of the places that it goes by, which ever more spans come ever nearer to, but of
places that were left out: half of them find the surface, the other half say how far it is off, and the other way round.
That figure is no proof, but it is measured on what the surface has not seen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...model.motion import Floats

_SPANS = (2, 3, 4, 6, 8, 12, 16, 24, 32, 48)
"""Along the longer side, tried one after the other."""
_ROUGH = 24
"""Spans at most of a surface that says roughly where places are."""
_STIFF = (1e-7, 1e-6, 1e-5, 1e-4, 1e-3)
"""Weights of the third differences of control points, which hold the surface where there are no places."""
_ASTRAY = 8.0
"""Times the median of what is left: places farther off than that are left out, they are no corners."""
_ROUNDS = 4
"""Times that this is asked: one that is far off pulls its neighbours with it at first."""
_LEAST = 1e-4
"""mm; no place that is nearer than that times `_ASTRAY` is left out."""
_BELIEVED = 0.9
"""Of the places that were left out: the others may be no corners, or lie beyond all that were not left out."""
_LIGHT, RIM = 1e-3, 0.1
"""Of the weight of all places together: what all points weigh that have places round them, and usually those at the
rim, which nothing else holds.
"""
_WORSE = 3
"""Numbers of spans in a row that are worse than the best: finer ones are not tried."""


@dataclass(frozen=True)
class Box:
    """Where a surface of heights is: u0 to u1 along, v0 to v1 across, mm."""

    u0: float
    u1: float
    v0: float
    v1: float


@dataclass(frozen=True, eq=False)
class HoldingPoints:
    """Points (m, 3) near to a surface, u, v, z, mm; rim: of the weight of all places, what they would weigh together
    were all of them at the rim.
    """

    points: Floats
    rim: float = RIM


@dataclass(frozen=True, eq=False)
class HeightSpline:
    """z = f(u, v), bicubic and twice smooth.

    Attributes:
        knots_u: (m + 4,) evenly, mm. knots_v: (n + 4,). control: (m, n) mm.
    """

    knots_u: Floats
    knots_v: Floats
    control: Floats

    def heights(self, places: Floats) -> Floats:
        """Return the heights (k,) at places (k, 2), mm; beyond the box those of its rim."""
        from . import height_kernels

        found = np.empty(len(places))
        plane = np.ascontiguousarray(places[:, :2], np.float64)
        height_kernels.heights(plane, self.knots_u, self.knots_v, np.ascontiguousarray(self.control), found)
        return found

    def slopes(self, places: Floats) -> Floats:
        """Return the slopes (k, 2) along u and v at places (k, 2)."""
        from scipy.interpolate import BSpline

        u = np.clip(places[:, 0], self.knots_u[3], self.knots_u[-4])
        v = np.clip(places[:, 1], self.knots_v[3], self.knots_v[-4])
        du = BSpline(self.knots_u, self.control, 3).derivative()(u)
        dv = BSpline(self.knots_v, self.control.T, 3).derivative()(v)
        along = np.einsum("ij,ij->i", du, _basis(v, self.knots_v).toarray())
        return np.column_stack([along, np.einsum("ij,ij->i", dv, _basis(u, self.knots_u).toarray())])

    def holds(self, places: Floats) -> NDArray[np.bool_]:
        """Tell which places (k, 2) are in the box: beyond it heights go on level, and are no part of the surface."""
        u, v = places[:, 0], places[:, 1]
        along = (u >= self.knots_u[3]) & (u <= self.knots_u[-4])
        inside: NDArray[np.bool_] = along & (v >= self.knots_v[3]) & (v <= self.knots_v[-4])
        return inside


@dataclass(frozen=True, eq=False)
class FittedHeights:
    """A surface of heights, and what is known of it.

    Attributes:
        spline: it. spans: along u and v.
        left_out_mm: how far nine tenths of the places that it was not found by were from it, root of the mean square,
            along Z, mm.
        used: (n,) which places it goes by: others are no corners.
    """

    spline: HeightSpline
    spans: tuple[int, int]
    left_out_mm: float
    used: NDArray[np.bool_]


def fit_heights(
    places: Floats, weights: Floats, holding: HoldingPoints, box: Box, progress: Progress = NO_PROGRESS
) -> FittedHeights:
    """Return a smooth surface by places.

    Args:
        places: (n, 3) u, v, z, mm, which lie on the surface, n >= 16. weights: (n,) of them, about 1.
        holding: points near to it, which hold it where there are no places.
        box: that it is over; all places and points lie in there.
        progress: told of how much is done.

    Raises:
        GeometryError: there are too few places.
        Cancelled: the job was asked to stop.
    """
    if len(places) < 16:
        raise GeometryError(f"a surface by {len(places)} places; expected 16 or more.")
    points, rim = holding.points, holding.rim
    light = np.where(have_places_round(places, points), _LIGHT, rim) * float(weights.sum()) / max(len(points), 1)
    used = np.ones(len(places), np.bool_)
    work = _FitTask(places, weights, points, light, box)
    for turn in range(_ROUNDS):
        best = work.best(used, progress.part(turn / _ROUNDS, (turn + 1) / _ROUNDS))
        off = np.abs(best.spline.heights(places[:, :2]) - places[:, 2])
        near = off <= _ASTRAY * max(float(np.median(off)), _LEAST)
        if np.array_equal(near, used):
            break
        used = near
    return best


def rough_heights(places: Floats, box: Box) -> HeightSpline:
    """Return a surface near places (n, 3), n >= 100, which nothing is left out to find: each of its control points has
    four of them, as far as they lie evenly.
    """
    work = _FitTask(places, np.ones(len(places)), places[:0], np.zeros(0), box)
    spans = [work.shares(each) for each in _SPANS if each <= _ROUGH]
    u, v = max((s for s in spans if (s[0] + 3) * (s[1] + 3) <= len(places) / 4), default=spans[0])
    return work.equations(np.arange(len(places)), u, v).solved(_STIFF[2])


def have_places_round(places: Floats, points: Floats) -> NDArray[np.bool_]:
    """Tell which points (m, 2) or (m, 3) have places (n, 3) round them, seen from above."""
    hull = shapely.convex_hull(shapely.MultiPoint(places[:, :2]))
    shapely.prepare(hull)
    inside: NDArray[np.bool_] = shapely.contains_xy(hull, points[:, 0], points[:, 1])
    return inside


@dataclass(frozen=True, eq=False)
class _SurfaceEquations:
    """Normal equations of a surface by places: one matrix for how far it is off, one for how much it is bent.

    Attributes:
        knots: along u and v. off, bent: (m, n, 7, 7), by control point and by how far the other one is from it along u
            and v, less 3. right: (m, n).
    """

    knots: tuple[Floats, Floats]
    off: Floats
    bent: Floats
    right: Floats

    def solved(self, stiff: float) -> HeightSpline:
        """Return the surface of least squares, as little bent as these let it; heights are nan where none is."""
        from scipy.sparse import csc_matrix
        from scipy.sparse.linalg import splu

        known, indices, begins = self._pattern
        size = self.right.size
        matrix = csc_matrix(((self.off + stiff * self.bent)[known], indices, begins), (size, size))
        try:
            control = splu(matrix).solve(self.right.ravel())
        except RuntimeError:  # singular: too few places for so many spans
            control = np.full(size, math.nan)
        return HeightSpline(*self.knots, control.reshape(self.right.shape))

    @cached_property
    def _pattern(self) -> tuple[NDArray[np.bool_], NDArray[np.int32], NDArray[np.int32]]:
        """Which numbers of the matrices there are, in which row each is, and where each column begins."""
        rows = [np.arange(count)[:, None] + np.arange(-3, 4) for count in self.right.shape]
        there = [(each >= 0) & (each < count) for each, count in zip(rows, self.right.shape, strict=True)]
        known = there[0][:, None, :, None] & there[1][None, :, None, :]
        indices = (rows[0][:, None, :, None] * self.right.shape[1] + rows[1][None, :, None, :])[known]
        begins = np.concatenate([[0], known.sum(axis=(2, 3)).ravel().cumsum()])
        return known, indices.astype(np.int32), begins.astype(np.int32)


@dataclass(frozen=True, eq=False)
class _FitTask:
    """What surfaces are found by.

    Attributes:
        places: (n, 3) u, v, z, mm. weights: (n,) of each.
        points, light: (m, 3) that hold the surface beside the places, mm, and (m,) their weights.
        box: of u and v.
    """

    places: Floats
    weights: Floats
    points: Floats
    light: Floats
    box: Box

    def best(self, used: NDArray[np.bool_], progress: Progress) -> FittedHeights:
        """Return the surface that places which were left out are nearest to."""
        rows = np.flatnonzero(used)
        rows = rows[np.lexsort((self.places[rows, 0], np.round(self.places[rows, 1], 1)))]
        halves = rows[::2], rows[1::2]
        least, chosen, worse = math.inf, (2, 2, _STIFF[-1]), 0
        for tried, spans in enumerate(_SPANS):
            progress.step(tried / len(_SPANS), f"Fitting a surface of {spans} spans")
            u, v = self.shares(spans)
            if (u + 3) * (v + 3) > len(rows) / 2 and tried:
                break
            off, stiff = self._stiffness(halves, u, v)
            worse = 0 if off < least else worse + 1
            if off < least:
                least, chosen = off, (u, v, stiff)
            if worse == _WORSE:
                break
        u, v, stiff = chosen
        return FittedHeights(self.equations(rows, u, v).solved(stiff), (u, v), least, used)

    def shares(self, spans: int) -> tuple[int, int]:
        """Return the spans along u and v, of which the longer side has so many."""
        long, wide = self.box.u1 - self.box.u0, self.box.v1 - self.box.v0
        longer = max(long, wide)
        return max(2, round(spans * long / longer)), max(2, round(spans * wide / longer))

    def _stiffness(self, halves: tuple[NDArray[np.int64], NDArray[np.int64]], u: int, v: int) -> tuple[float, float]:
        """Return how far places are, mm, from the surface of u x v spans that the others make, and how stiff it is."""
        both = [self.equations(mine, u, v) for mine in halves]
        found = []
        for stiff in _STIFF:
            offs = []
            for equations, other in zip(both, halves[::-1], strict=True):
                spline = equations.solved(stiff)
                offs.append(spline.heights(self.places[other, :2]) - self.places[other, 2])
            squares = np.sort(np.concatenate(offs) ** 2)
            mean = float(squares[: math.ceil(_BELIEVED * len(squares))].mean())
            found.append((math.sqrt(mean) if math.isfinite(mean) else math.inf, stiff))
        return min(found)

    def equations(self, rows: NDArray[np.int64], u: int, v: int) -> _SurfaceEquations:
        """Return the equations of the surface of u x v spans by some places, however stiff it is."""
        from . import height_kernels

        knots = _even(self.box.u0, self.box.u1, u), _even(self.box.v0, self.box.v1, v)
        asked = np.concatenate([self.places[rows], self.points])
        weights = np.concatenate([self.weights[rows], self.light])
        shape = u + 3, v + 3
        off, bent, right = np.zeros((*shape, 7, 7)), np.zeros((*shape, 7, 7)), np.zeros(shape)
        height_kernels.add_places(asked, weights, *knots, off, right)
        share = float(weights.sum()) / (shape[0] * shape[1])
        bent[:, :, :, 3] += share * _third(shape[0])[:, None]
        bent[:, :, 3] += share * _third(shape[1])[None]
        return _SurfaceEquations(knots, off, bent, right)


def _even(low: float, high: float, spans: int) -> Floats:
    """Return knots of a cubic spline of so many spans, evenly, three beyond each end."""
    return np.asarray(low + (high - low) / spans * np.arange(-3, spans + 4), np.float64)


def _basis(at: Floats, knots: Floats):  # type: ignore[no-untyped-def]  # scipy's sparse rows of four values each
    from scipy.interpolate import BSpline

    return BSpline.design_matrix(np.clip(at, knots[3], knots[-4]), knots, 3)


def _third(count: int) -> Floats:
    """Return of the squares of all third differences of control points in a row their matrix (count, 7): by control
    point and by how far the other one is from it, less 3.
    """
    found = np.zeros((count, 7))
    weights = (-1.0, 3.0, -3.0, 1.0)
    for a, own in enumerate(weights):
        for b, other in enumerate(weights):
            found[a : count - 3 + a, 3 + b - a] += own * other
    return found
