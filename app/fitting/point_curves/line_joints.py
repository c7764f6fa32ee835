"""Where a line of the true shape becomes an arc within a facet: the joint, found from the points about that facet.

A facet whose ends lie on a line and on the arc behind it stands for a piece of both. A cubic spline over it would
spread the jump of the curvature over the whole facet. The line is known by its ends, the arc by the points behind the
facet; that it leaves the line smoothly leaves two numbers free, its radius and the place of the joint along the line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.motion import Floats

_AFTER = 4.5
"""Times the facet over the joint: points so far behind it say which arc that is. Further on may be another."""
_LEAST = 3
"""Points that make an arc of two free numbers, with one over that may contradict."""
_TRIALS = 65
"""Places of the joint that are tried over a facet, before the best one is narrowed down."""
_NARROWED = 40
"""Steps, each of which leaves two thirds: in all a ten-millionth of what lies between two trials."""
_INNER = 0.03
"""Of the facet: a joint that is nearer to its end is that end."""


@dataclass(frozen=True, eq=False)
class LineJoint:
    """A line that goes on smoothly into an arc.

    Attributes:
        place: (3,) where, mm. way: (3,) of the line there, of length 1. aside: (3,) square to it, to the arc's middle.
        radius: of the arc, mm.
    """

    place: Floats
    way: Floats
    aside: Floats
    radius: float

    def nearest(self, points: Floats) -> Floats:
        """Return the places (n, 3) of line and arc that are nearest to points (n, 3), mm."""
        middle = self.place + self.radius * self.aside
        along = (points - self.place) @ self.way
        spokes = points - middle
        on_arc = middle + self.radius * spokes / np.linalg.norm(spokes, axis=1)[:, None]
        found: Floats = np.where(along[:, None] > 0, on_arc, self.place + along[:, None] * self.way)
        return found


@dataclass(frozen=True, eq=False)
class _FlatPoints:
    """Points beside a line, in the plane of both: along the line and away from it, (n,) mm."""

    along: Floats
    away: Floats

    def radius(self, joint: float) -> float:
        """Return the radius of the arc that leaves the line at a place along it, of least squares, mm."""
        weight = 2 * float(self.away @ self.away)
        return float(self.away @ ((self.along - joint) ** 2 + self.away**2)) / weight

    def off(self, joint: float) -> float:
        """Return how far these points are from that arc at most, mm."""
        radius = self.radius(joint)
        return float(np.abs(np.hypot(self.along - joint, self.away - radius) - abs(radius)).max())


def joint_behind(line: Floats, points: Floats, within: float) -> LineJoint | None:
    """Return where a line goes on smoothly into an arc; None where it does not between its end and the first of the
    points.

    Args:
        line: (2, 3) its ends, the second one that of the facet over the joint.
        points: (n, 3) behind it, in their order, the first one the other end of that facet.
        within: how far points may be from the arc, mm.
    """
    far = np.linalg.norm(np.diff(points, axis=0, prepend=line[1:]), axis=1).cumsum()
    some = points[far <= _AFTER * far[0]]
    if len(some) < _LEAST:
        return None
    way = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    apart = some - line[1]
    along = apart @ way
    square = apart - along[:, None] * way
    aside = square[-1] / max(float(np.linalg.norm(square[-1])), 1e-300)
    flat = _FlatPoints(along, square @ aside)
    beside = float(np.linalg.norm(square - flat.away[:, None] * aside, axis=1).max())
    if beside > within or not np.all(np.diff(along) > 0) or flat.away[0] <= within:
        return None
    joint = _best(flat)
    inside = _INNER * along[0] < joint < (1 - _INNER) * along[0]
    if not inside or flat.off(joint) > within:
        return None
    return LineJoint(line[1] + joint * way, way, aside, flat.radius(joint))


def _best(flat: _FlatPoints) -> float:
    """Return the place of the joint along the line from which the points are the least off."""
    trials = np.linspace(0.0, float(flat.along[0]), _TRIALS)
    k = int(np.argmin([flat.off(float(each)) for each in trials]))
    low, high = float(trials[max(k - 1, 0)]), float(trials[min(k + 1, _TRIALS - 1)])
    for _ in range(_NARROWED):  # what is least has one valley between the neighbours of the best trial
        a, b = low + (high - low) / 3, high - (high - low) / 3
        if flat.off(a) <= flat.off(b):
            high = b
        else:
            low = a
    return (low + high) / 2
