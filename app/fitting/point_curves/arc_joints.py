"""Where one arc of the true shape becomes another within a facet: the joint, found from the points on both sides.

A cubic spline over such a facet spreads the jump of the curvature over it and over its neighbours, and is off by some
tenth of the facets' sag. Two arcs that meet smoothly are five numbers: place and direction of the joint, and two
curvatures. They are believed where points on both sides lie on them far nearer than the jump of the curvature moves
them: a curvature that changes evenly, as on an ellipse, fits no two arcs so well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats

_WINDOWS = (4, 6)
"""Points on each side of a facet that tell the arcs, the more the better; a short arc has few."""
_JUMP = 1.0 / 16.0
"""Times jump of the curvature and square of a facet: about how far a spline is off there."""
_EVIDENCE = 4.0
"""Times how far points are off both arcs: by so much at least the jump must move them."""
_FLOOR = 0.25
"""Of how far points may be off: what the jump of the curvature moves by less is left to the spline."""
_EVEN, _APART = 0.15, 3.0
"""Of the jump: by so much the curvature may change from one point to the next on one side of the facet alone, where
both ends of the jump are so many times as far apart as these; by less where they are farther: over a facet longer than
those beside it a curvature that changes evenly is another, too.
"""
_BEYOND = 0.02
"""Of the facet: a joint that is so little beyond its end is that end."""
_END = 0.002
"""Of the facet: a joint that is so near to its end is that end, as two points so near tell of no curve."""


@dataclass(frozen=True, eq=False)
class ArcJoint:
    """An arc, or a line, that goes on smoothly into another.

    Attributes:
        place: (3,) where, mm. way: (3,) of both there, of length 1. aside: (3,) square to it, to the left.
        curvatures: before and behind, 1/mm, positive where the middle of the arc lies aside.
    """

    place: Floats
    way: Floats
    aside: Floats
    curvatures: tuple[float, float]

    def nearest(self, points: Floats) -> Floats:
        """Return the places (n, 3) of both arcs that are nearest to points (n, 3), mm."""
        apart = points - self.place
        along, left = apart @ self.way, apart @ self.aside
        flat = np.column_stack([along, left])
        bent = np.where(along < 0, *self.curvatures)
        off, slope = _off_arc(flat, bent)
        # the gradient of the distance points away from the arc; it is the same all along the way to it
        moved = flat - off[:, None] * slope
        found: Floats = self.place + moved[:, :1] * self.way + moved[:, 1:] * self.aside
        return found


def _off_arc(points: Floats, curvature: Floats) -> tuple[Floats, Floats]:
    """Return how far points (n, 2) lie to the left of arcs that leave 0, 0 along X, mm, and its gradient (n, 2)."""
    square = (points**2).sum(axis=1)
    spoke = np.sqrt(np.maximum(1 - 2 * points[:, 1] * curvature + curvature**2 * square, 1e-300))
    off = (2 * points[:, 1] - curvature * square) / (1 + spoke)
    slope = np.column_stack([-curvature * points[:, 0], 1 - curvature * points[:, 1]]) / spoke[:, None]
    return off, slope


def joint_between(before: Floats, behind: Floats, within: float) -> ArcJoint | None:
    """Return where an arc goes on smoothly into another between two points; None where there is no such joint.

    Args:
        before: (m, 3) the last one at the facet's beginning. behind: (n, 3) the first one at its end.
        within: how far points may be from the arcs, mm.
    """
    from . import arc_joint_kernels

    points = np.concatenate([before, behind])
    chord = behind[0] - before[-1]
    size = float(np.linalg.norm(chord))
    way = chord / size
    apart = points - before[-1]
    square = apart - (apart @ way)[:, None] * way
    aside = np.linalg.svd(square, full_matrices=False)[2][0]
    flat = np.column_stack([apart @ way, apart @ aside])
    if np.linalg.norm(square - flat[:, 1:] * aside, axis=1).max() > within:
        return None
    flat = np.ascontiguousarray(flat / size)
    count = len(before)
    found = np.array([0.5, 0.0, 0.0, _bent(flat[count - 3 : count]), _bent(flat[count : count + 3])])
    far = arc_joint_kernels.two_arcs(flat, count, found) * size
    jump = abs(found[4] - found[3]) * size * _JUMP
    inside = -_BEYOND <= found[0] <= 1 + _BEYOND
    if not inside or far > within or jump < max(_EVIDENCE * far, _FLOOR * within):
        return None
    c, s = np.cos(found[2]), np.sin(found[2])
    place = before[-1] + size * (found[0] * way + found[1] * aside)
    if not _END < found[0] < 1 - _END:
        place = (before[-1] if found[0] < 0.5 else behind[0]).copy()
    bent = float(found[3] / size), float(found[4] / size)
    return ArcJoint(place, c * way + s * aside, c * aside - s * way, bent)


def _bent(points: Floats) -> float:
    """Return the curvature of the circle through three points (3, 2), positive to the left."""
    a, b = points[1] - points[0], points[2] - points[1]
    whole = points[2] - points[0]
    sizes = float(np.linalg.norm(a) * np.linalg.norm(b) * np.linalg.norm(whole))
    return 2.0 * float(a[0] * b[1] - a[1] * b[0]) / max(sizes, 1e-300)


def arc_joints(points: Floats, straight: NDArray[np.bool_], within: float) -> tuple[list[ArcJoint], NDArray[np.int64]]:
    """Return the joints of arcs along points (n, 3), at most one a chord, and the chord that each is in, rising.

    Args:
        straight: (n - 1,) chords that are sides of the true shape. within: how far points may be from arcs, mm.
    """
    sides = np.flatnonzero(straight)
    joints: list[ArcJoint] = []
    chords: list[int] = []
    for k in _candidates(points, straight, within).tolist():
        at = int(np.searchsorted(sides, k))
        first = int(sides[at - 1]) + 1 if at else 0
        stop = int(sides[at]) + 1 if at < len(sides) else len(points)
        joint = _joint_at(points[first:stop], k - first, within)
        near = _BEYOND * float(np.linalg.norm(points[k + 1] - points[k]))
        if joint is not None and not (joints and np.linalg.norm(joints[-1].place - joint.place) <= near):
            joints.append(joint)
            chords.append(k)
    return joints, np.array(chords, np.int64)


def _joint_at(points: Floats, k: int, within: float) -> ArcJoint | None:
    """Return the joint between points k and k + 1 of a run without sides (n, 3), None where there is none: where the
    nearest points tell of one, by as many as lie on the arcs.
    """
    best = None
    for most in _WINDOWS:
        before, behind = points[max(k + 1 - most, 0) : k + 1], points[k + 1 : k + 1 + most]
        if min(len(before), len(behind)) < _WINDOWS[0]:
            return best
        joint = joint_between(before, behind, within)
        if joint is None:
            return best
        best = joint
    return best


def _candidates(points: Floats, straight: NDArray[np.bool_], within: float) -> NDArray[np.int64]:
    """Return the chords over which the curvature jumps while it hardly changes on either side."""
    ways = np.diff(points, axis=0)
    sizes = np.linalg.norm(ways, axis=1)
    if len(sizes) < 2 * _WINDOWS[0] - 1:
        return np.zeros(0, np.int64)
    ways = ways / sizes[:, None]
    bent = np.cross(ways[:-1], ways[1:]) / ((sizes[:-1] + sizes[1:]) / 2)[:, None]  # at points 1 to n - 2
    k = np.arange(3, len(sizes) - 3)
    jump = np.linalg.norm(bent[k + 1] - bent[k - 2], axis=1)
    far = (sizes[k - 1] + sizes[k] + sizes[k + 1]) / _APART
    left = np.linalg.norm(bent[k - 2] - bent[k - 3], axis=1) * np.maximum(far / sizes[k - 2], 1.0)
    right = np.linalg.norm(bent[k + 2] - bent[k + 1], axis=1) * np.maximum(far / sizes[k + 2], 1.0)
    per_size = _JUMP * sizes[k] ** 2
    floor = _FLOOR * within
    even = np.maximum(left, right) * per_size <= _EVEN * jump * per_size + floor
    found: NDArray[np.int64] = k[(jump * per_size >= floor) & even & ~straight[k]]
    return found
