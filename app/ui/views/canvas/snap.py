"""Where the mouse snaps to on curves alone: ends, middles, centres, quadrants, points; and the grid."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum
from functools import lru_cache

from ....geometry.sample import quadrants
from ....model.curves import Arc, Circle, Curve, Ellipse, Line, Point


class SnapKind(IntEnum):
    """What a snap point is."""

    END = 0
    MIDDLE = 1
    CENTRE = 2
    QUADRANT = 3
    GRID = 4
    NODE = 5
    INTERSECTION = 6
    PERPENDICULAR = 7
    TANGENT = 8
    NEAREST = 9
    ORIGIN = 10


CHOICES = (
    SnapKind.END,
    SnapKind.MIDDLE,
    SnapKind.CENTRE,
    SnapKind.QUADRANT,
    SnapKind.NODE,
    SnapKind.INTERSECTION,
    SnapKind.PERPENDICULAR,
    SnapKind.TANGENT,
    SnapKind.NEAREST,
)
"""Kinds that are switched one by one, in the order in which they are offered."""

USUAL = frozenset(CHOICES) - {SnapKind.NEAREST}
"""Kinds that are on at first: NEAREST would hold the mouse on every curve that it passes."""

SNAP_WORDS = {
    "end": SnapKind.END,
    "mid": SnapKind.MIDDLE,
    "cen": SnapKind.CENTRE,
    "qua": SnapKind.QUADRANT,
    "nod": SnapKind.NODE,
    "int": SnapKind.INTERSECTION,
    "per": SnapKind.PERPENDICULAR,
    "tan": SnapKind.TANGENT,
    "nea": SnapKind.NEAREST,
}
"""Typed while a point is asked for, each lets the next click take that kind alone."""

SNAP_NAMES = {
    SnapKind.END: "End",
    SnapKind.MIDDLE: "Middle",
    SnapKind.CENTRE: "Centre",
    SnapKind.QUADRANT: "Quadrant",
    SnapKind.GRID: "",
    SnapKind.NODE: "Point",
    SnapKind.INTERSECTION: "Intersection",
    SnapKind.PERPENDICULAR: "Perpendicular",
    SnapKind.TANGENT: "Tangent",
    SnapKind.NEAREST: "On curve",
    SnapKind.ORIGIN: "Origin",
}


@dataclass(frozen=True, slots=True)
class Snap:
    """The point that the mouse has snapped to, mm."""

    point: Point
    kind: SnapKind


def best(snaps: Iterable[Snap], at: Point, reach: float) -> Snap | None:
    """Return the snap nearest to `at` within `reach` mm, or None.

    Ends win over others that are as near within a third of the reach; feet and tangent points give way by as much, and
    the nearest point of a curve to everything.

    Args:
        at: where the mouse is, mm.
        reach: largest distance, mm.
    """
    within = [snap for snap in snaps if math.dist(snap.point, at) <= reach]
    return min(within, key=lambda s: math.dist(s.point, at) + _HANDICAP.get(s.kind, 0.0) * reach, default=None)


_HANDICAP = {SnapKind.END: -1 / 3, SnapKind.PERPENDICULAR: 1 / 3, SnapKind.TANGENT: 1 / 3, SnapKind.NEAREST: 2.0}


def to_grid(at: Point, step: float) -> Point:
    """Return the grid point nearest to `at`; step in mm."""
    digits = max(0, 5 - math.floor(math.log10(step)))
    return (round(round(at[0] / step) * step, digits) + 0.0, round(round(at[1] / step) * step, digits) + 0.0)


@lru_cache(maxsize=1 << 15)
def snaps_of(curve: Curve) -> tuple[Snap, ...]:
    """Return the snap points of one curve; they are kept, for the mouse asks for the same ones at every step."""
    if isinstance(curve, Circle):
        return (Snap(curve.centre, SnapKind.CENTRE), *(Snap(p, SnapKind.QUADRANT) for p in quadrants(curve)))
    found = [Snap(p, SnapKind.END) for p in dict.fromkeys((curve.start, curve.end))]
    if isinstance(curve, Line):
        found.append(Snap(((curve.start[0] + curve.end[0]) / 2, (curve.start[1] + curve.end[1]) / 2), SnapKind.MIDDLE))
    elif isinstance(curve, Arc):
        turn = curve.start_angle + curve.sweep / 2
        (x, y), r = curve.centre, curve.radius
        found += [
            Snap(curve.centre, SnapKind.CENTRE),
            Snap((x + r * math.cos(turn), y + r * math.sin(turn)), SnapKind.MIDDLE),
        ]
        found += [Snap(p, SnapKind.QUADRANT) for p in quadrants(curve)]
    elif isinstance(curve, Ellipse):
        found += [Snap(curve.centre, SnapKind.CENTRE), *(Snap(p, SnapKind.QUADRANT) for p in axis_ends(curve))]
    return tuple(found)


def axis_ends(curve: Ellipse) -> list[Point]:
    """Return the ends of an ellipse's axes that lie on it."""
    span = curve.end_parameter - curve.start_parameter
    quarters = (k * math.pi / 2 for k in range(4))
    return [curve.at(t) for t in quarters if (t - curve.start_parameter) % math.tau <= span]
