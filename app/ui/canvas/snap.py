"""Where the mouse snaps to: ends, middles, centres and quadrants of what is drawn, then the grid."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from app.edit.sample import quadrants
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point


class SnapKind(IntEnum):
    """What a snap point is."""

    END = 0
    MIDDLE = 1
    CENTRE = 2
    QUADRANT = 3
    GRID = 4


@dataclass(frozen=True, slots=True)
class Snap:
    """The point that the mouse has snapped to, mm."""

    point: Point
    kind: SnapKind


@dataclass(frozen=True)
class SnapPoints:
    """Points (n, 2) in mm and their kinds (n,)."""

    points: NDArray[np.float64]
    kinds: NDArray[np.uint8]

    @classmethod
    def joined(cls, parts: Sequence[SnapPoints]) -> SnapPoints:
        """Return all points of several sets."""
        if not parts:
            return no_snap_points()
        return cls(np.concatenate([p.points for p in parts]), np.concatenate([p.kinds for p in parts]))


def no_snap_points() -> SnapPoints:
    """Return the empty set."""
    return SnapPoints(np.zeros((0, 2)), np.zeros(0, np.uint8))


def snap_points(curves: Iterable[Curve]) -> SnapPoints:
    """Return the snap points of some curves."""
    found = [pair for curve in curves for pair in _of(curve)]
    if not found:
        return no_snap_points()
    return SnapPoints(np.array([p for p, _ in found]), np.array([k for _, k in found], np.uint8))


def nearest(snaps: SnapPoints, at: Point, reach: float) -> Snap | None:
    """Return the snap point nearest to `at` within `reach` mm, or None; ends win over others that are as near within a third.

    Args:
        at: where the mouse is, mm.
        reach: largest distance, mm.
    """
    if not len(snaps.points):
        return None
    distance = np.hypot(snaps.points[:, 0] - at[0], snaps.points[:, 1] - at[1])
    best = int(np.argmin(np.where(snaps.kinds == SnapKind.END, distance - reach / 3, distance)))
    if distance[best] > reach:
        best = int(np.argmin(distance))
    if distance[best] > reach:
        return None
    x, y = snaps.points[best]
    return Snap((float(x), float(y)), SnapKind(int(snaps.kinds[best])))


def to_grid(at: Point, step: float) -> Point:
    """Return the grid point nearest to `at`; step in mm."""
    digits = max(0, 2 - math.floor(math.log10(step)))
    return (round(round(at[0] / step) * step, digits) + 0.0, round(round(at[1] / step) * step, digits) + 0.0)


def _of(curve: Curve) -> list[tuple[Point, SnapKind]]:
    if isinstance(curve, Circle):
        return [(curve.centre, SnapKind.CENTRE), *((p, SnapKind.QUADRANT) for p in quadrants(curve))]
    found = [(curve.start, SnapKind.END), (curve.end, SnapKind.END)]
    if isinstance(curve, Line):
        found.append((((curve.start[0] + curve.end[0]) / 2, (curve.start[1] + curve.end[1]) / 2), SnapKind.MIDDLE))
    elif isinstance(curve, Arc):
        turn = curve.start_angle + curve.sweep / 2
        (x, y), r = curve.centre, curve.radius
        found += [(curve.centre, SnapKind.CENTRE), ((x + r * math.cos(turn), y + r * math.sin(turn)), SnapKind.MIDDLE)]
        found += [(p, SnapKind.QUADRANT) for p in quadrants(curve)]
    elif isinstance(curve, Ellipse):
        found.append((curve.centre, SnapKind.CENTRE))
    return found
