"""Rays that draw the mouse: at steps of an angle from the base, straight from points passed before, and along lines
that end there.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

from ....core.tolerances import WELD
from ....drafting.curves.intersections import intersection_points
from ....model.curves import Curve, Line, Point

_PX = 5.0
_MOST = 4
_STRAIGHT = (0.0, 90.0, 180.0, 270.0)


@dataclass(frozen=True, slots=True)
class TrackingRay:
    """A ray.

    Attributes:
        start: mm. angle: degrees in [0, 360).
        word: what it is called beside the mouse.
    """

    start: Point
    angle: float
    word: str

    @property
    def way(self) -> Point:
        """Unit vector; exact for quarter turns."""
        if self.angle % 90 == 0:
            return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(self.angle // 90) % 4]
        turn = math.radians(self.angle)
        return (math.cos(turn), math.sin(turn))

    def at(self, along: float) -> Point:
        """Return the point at a distance from the start, mm."""
        return (self.start[0] + along * self.way[0], self.start[1] + along * self.way[1])

    def seen_from(self, point: Point) -> tuple[float, float]:
        """Return how far along the ray a point lies and how far beside it, mm."""
        dx, dy = point[0] - self.start[0], point[1] - self.start[1]
        (ux, uy) = self.way
        return dx * ux + dy * uy, abs(dx * uy - dy * ux)


@dataclass(frozen=True, slots=True)
class AcquiredPoint:
    """A point that the mouse has rested on.

    Attributes:
        point: mm. angles: degrees, of the lines that end there, onward.
    """

    point: Point
    angles: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class TrackedPoint:
    """Where rays have drawn the mouse: one, two that cross there, or one that meets a curve there."""

    point: Point
    rays: tuple[TrackingRay, ...]
    on_curve: bool = False

    @property
    def crosses(self) -> bool:
        """True where the point is a crossing."""
        return self.on_curve or len(self.rays) > 1

    @property
    def word(self) -> str:
        """What it is called beside the mouse."""
        return " \u00d7 ".join([f"{ray.word} {ray.angle:.4g}°" for ray in self.rays] + ["curve"] * self.on_curve)


def acquired(point: Point, curves: Iterable[Curve]) -> AcquiredPoint:
    """Return a point to be tracked, with the ways onward of the lines among some curves that end there."""
    angles = []
    for curve in curves:
        if isinstance(curve, Line):
            for end, other in ((curve.start, curve.end), (curve.end, curve.start)):
                if math.dist(end, point) < WELD:
                    angles.append(math.degrees(math.atan2(end[1] - other[1], end[0] - other[0])) % 360)
    return AcquiredPoint(point, tuple(dict.fromkeys(angles)))


def with_acquired(known: tuple[AcquiredPoint, ...], new: AcquiredPoint) -> tuple[AcquiredPoint, ...]:
    """Return the points to be tracked with another, the latest few; one that is known already is forgotten instead."""
    others = tuple(a for a in known if a.point != new.point)
    return others if len(others) < len(known) else (*others, new)[-_MOST:]


def rays(base: Point | None, step: float | None, points: Sequence[AcquiredPoint]) -> list[TrackingRay]:
    """Return the rays that there are.

    Args:
        base: where the tool comes from. step: between rays from the base, degrees, or None for none.
    """
    found = []
    if base is not None and step is not None:
        found += [TrackingRay(base, k * step, "Polar") for k in range(round(360 / step))]
    for known in points:
        found += [TrackingRay(known.point, angle, "Extension") for angle in known.angles if angle not in _STRAIGHT]
        found += [
            TrackingRay(known.point, angle, "Extension" if angle in known.angles else "Aligned") for angle in _STRAIGHT
        ]
    return found


def tracked(
    at: Point, candidates: Sequence[TrackingRay], scale: float, digits: int, curves: Sequence[Curve] = ()
) -> TrackedPoint | None:
    """Return where rays draw the mouse, or None where none is near; where rays cross, or meet a curve, is preferred.

    Args:
        at: where the mouse is, mm. scale: px per mm.
        curves: near the mouse.
        digits: decimals that the length along a single ray is rounded to.
    """
    reach = _PX / scale
    near = [
        (beside, ray)
        for ray in candidates
        for along, beside in [ray.seen_from(at)]
        if beside <= reach and along > reach
    ]
    near.sort(key=lambda pair: pair[0])
    for (_, a), (_, b) in combinations(near, 2):
        if a.start != b.start:
            crossing = intersection_points(Line(a.start, a.at(1.0)), Line(b.start, b.at(1.0)), extended=True)
            if crossing and math.dist(crossing[0], at) <= 2 * reach:
                return TrackedPoint(_tidy(crossing[0]), (a, b))
    met = [(math.dist(p, at), p, ray) for _, ray in near for curve in curves for p in _meets(ray, curve, at, 2 * reach)]
    if met:
        _, point, ray = min(met, key=lambda each: each[0])
        return TrackedPoint(point, (ray,), on_curve=True)
    if not near:
        return None
    ray = near[0][1]
    return TrackedPoint(_tidy(ray.at(round(ray.seen_from(at)[0], digits))), (ray,))


def _meets(ray: TrackingRay, curve: Curve, at: Point, reach: float) -> list[Point]:
    """Return where a ray meets a curve within reach of a point."""
    stretch = Line(ray.start, ray.at(ray.seen_from(at)[0] + 2 * reach))
    box = (at[0] - reach, at[1] - reach, at[0] + reach, at[1] + reach)
    return [
        p
        for p in intersection_points(stretch, curve, within=box)
        if math.dist(p, at) <= reach and math.dist(p, ray.start) > WELD
    ]


def _tidy(point: Point) -> Point:
    return (round(point[0], 9) + 0.0, round(point[1], 9) + 0.0)
