"""Snap points that take more than one curve to find: where near curves meet, feet and tangent points of the base, the
nearest point.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np

from ....drafting.curves.intersections import intersection_points, lies_on, nearest_point, tangent_points
from ....drafting.curves.perpendiculars import perpendicular_feet
from ....geometry.sample import Box, Points, sample, spline_points
from ....model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from .snap import Snap, SnapKind, snaps_of

MOST = 6
"""So many of the curves under the mouse are cut with one another."""


@dataclass(frozen=True, slots=True)
class Neighbourhood:
    """What the mouse is close to.

    Attributes:
        at: where it is, mm. reach: what counts as close, mm.
        curves: those within reach, nearest first. guides: construction lines within reach.
        base: where the tool comes from, mm, or None.
    """

    at: Point
    reach: float
    curves: Sequence[Curve]
    base: Point | None = None
    guides: Sequence[Curve] = ()

    @property
    def box(self) -> Box:
        """x0, y0, x1, y1 of what is within reach, mm."""
        return (self.at[0] - self.reach, self.at[1] - self.reach, self.at[0] + self.reach, self.at[1] + self.reach)


def neighbour_snaps(near: Neighbourhood, kinds: frozenset[SnapKind]) -> list[Snap]:
    """Return the snap points of these kinds that near curves give together, or with the base."""
    found: list[Snap] = []
    curves = [*near.curves[:MOST], *near.guides]
    if SnapKind.INTERSECTION in kinds:
        found += (
            Snap(p, SnapKind.INTERSECTION)
            for a, b in combinations(curves, 2)
            for p in intersection_points(a, b, within=near.box)
        )
    if near.base is not None and SnapKind.PERPENDICULAR in kinds:
        found += (
            Snap(p, SnapKind.PERPENDICULAR)
            for curve in curves
            if _may_stand_square(curve, near)
            for p in _feet(curve, near.base)
        )
    if near.base is not None and SnapKind.TANGENT in kinds:
        found += (Snap(p, SnapKind.TANGENT) for curve in curves for p in _tangents(curve, near.base))
    if SnapKind.NEAREST in kinds:
        found += (Snap(nearest_on(curve, near.at), SnapKind.NEAREST) for curve in curves[:1])
    return found


def forced(near: Neighbourhood, kind: SnapKind, snaps: Iterable[Snap]) -> Snap | None:
    """Return the point of one kind that near curves have, wherever on them it lies, or that is itself near; None
    without one.

    Args:
        snaps: snap points of curves alone that lie within reach.
    """
    own = [snap for curve in near.curves for snap in snaps_of(curve)] if kind <= SnapKind.QUADRANT else []
    found = [snap for snap in (*snaps, *own, *neighbour_snaps(near, frozenset({kind}))) if snap.kind is kind]
    return min(found, key=lambda snap: math.dist(snap.point, near.at), default=None)


def distance_to(curve: Curve, at: Point) -> float:
    """Return how far a point is from a curve, mm; for ellipses and splines from the chords of their samples."""
    if isinstance(curve, Line | Arc | Circle):
        return math.dist(nearest_point(curve, at), at)
    points = _samples(curve)
    a, d = points[:-1], np.diff(points, axis=0)
    square = np.einsum("ij,ij->i", d, d)
    share = np.clip(np.einsum("ij,ij->i", np.asarray(at) - a, d) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return float(np.hypot(*(a + share[:, None] * d - at).T).min())


def nearest_on(curve: Curve, at: Point) -> Point:
    """Return the point of a curve nearest to a point, mm; it lies on the curve to the last digit."""
    if isinstance(curve, Spline):
        return _nearest_on_spline(curve, at)
    return nearest_point(curve, at)


@lru_cache(4096)
def _samples(curve: Curve) -> Points:
    return sample(curve)


def _chords(curve: Curve, near: Neighbourhood) -> Points:
    """Return the chords of a curve's samples that lie within reach: (n, 2, 2), mm."""
    points = _samples(curve)
    low, high = np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])
    (x, y), r = near.at, near.reach
    rows = np.flatnonzero((low[:, 0] <= x + r) & (high[:, 0] >= x - r) & (low[:, 1] <= y + r) & (high[:, 1] >= y - r))
    return np.stack([points[rows], points[rows + 1]], axis=1)


def _may_stand_square(curve: Curve, near: Neighbourhood) -> bool:
    """Return whether the way from the base to an ellipse or spline stands square on it within reach; True for other
    curves.
    """
    if not isinstance(curve, Ellipse | Spline) or near.base is None:
        return True
    chords = _chords(curve, near)
    along = np.einsum("ij,ikj->ik", chords[:, 1] - chords[:, 0], chords - near.base)
    return along.size > 0 and bool(along.min() <= 0 <= along.max())


@lru_cache(256)
def _feet(curve: Curve, base: Point) -> tuple[Point, ...]:
    """Return the points of a curve where the way from the base stands square on it."""
    if isinstance(curve, Line):
        dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
        along = ((base[0] - curve.start[0]) * dx + (base[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
        return ((curve.start[0] + along * dx, curve.start[1] + along * dy),) if 0 <= along <= 1 else ()
    if isinstance(curve, Arc | Circle):
        (x, y), away = curve.centre, math.dist(base, curve.centre)
        if away == 0:
            return ()
        ux, uy = (base[0] - x) / away * curve.radius, (base[1] - y) / away * curve.radius
        return tuple(p for p in ((x + ux, y + uy), (x - ux, y - uy)) if lies_on(curve, p))
    return tuple(perpendicular_feet(curve, base))


@lru_cache(256)
def _tangents(curve: Curve, base: Point) -> tuple[Point, ...]:
    return tuple(tangent_points(curve, base))


def _nearest_on_spline(curve: Spline, at: Point) -> Point:
    """Narrow down the parameter with many points at a time: one call a point would take milliseconds."""
    knots = np.unique(curve.knots)
    t = np.append(np.linspace(knots[:-1], knots[1:], 12, endpoint=False, axis=1).ravel(), knots[-1])
    for _ in range(8):
        points = spline_points(curve, t)
        row = int(np.argmin(np.hypot(points[:, 0] - at[0], points[:, 1] - at[1])))
        t = np.linspace(t[max(row - 1, 0)], t[min(row + 1, len(t) - 1)], 25)
    return (float(points[row, 0]), float(points[row, 1]))
