"""What lies between the points that method D goes by: cubic splines through them, as points close to one another.

Effective points lie on the true shape, the chords between them do not: these are what the facets have made of it. A
curve that is held to the chords comes back to the facets, so it is held to a spline through the points, of the second
order of smoothness and off a smooth shape by the fourth power of their distances (C. de Boor, A Practical Guide to
Splines, chapter V). What nobody can tell from the points stays a chord: a side much longer than what is beside it, and
one that the spline would leave by more than the tolerance has left. Where one arc becomes another the spline is two,
which have the joint and its direction in common.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...model.motion import Floats
from .arc_joints import arc_joints
from .line_joints import LineJoint, joint_behind

Flags = NDArray[np.bool_]

_SIDE = 6.0
"""A chord longer than so many times both its neighbours is a side of the true shape."""
_SMOOTH = 1.15
"""A curve of radius r that goes on smoothly from a side turns its first chord, of length h, by h / 2r at most, and the
next, of length k, by (h + k) / 2r from that: their ratio may be so many times what that says.
"""
_JOINT = 20.0
"""Times how near chords are to the spline: by so much points may be off the arc that goes on from a side."""
_LOOKED_AT = 8
"""Places a chord at which it is seen how far the spline leaves it."""
_LEAST = 4
"""Parts of a chord that is no side, at least: fewer would be no evidence of an arc."""


@dataclass(frozen=True)
class SplineLimits:
    """How near splines are to points and to the chords between them.

    Attributes:
        fine: how far the spline may be from the chords of what is returned, mm, > 0.
        between: how far the spline may leave the chord of two points, mm, >= 0; else the chord stays.
    """

    fine: float
    between: float


def through_points(
    points: Floats, corners: NDArray[np.int64], limits: SplineLimits, sides: Flags | None = None
) -> Floats:
    """Return points (m, 3) of splines through points, those themselves among them, mm.

    Args:
        points: (n, 3) mm, n >= 2, no two in a row alike.
        corners: numbers of the points at which splines end, rising, the first and the last among them.
        limits: how near to points and chords.
        sides: (n - 1,) which chords are sides of the true shape, where that is known of more than these points: those
            within facets are as far apart as a program happens to have them. None: as the chords tell.
    """
    sides = sides_between(points, corners) if sides is None else sides
    closed = len(corners) == 2 and len(points) > 3 and bool(np.all(points[0] == points[-1])) and _goes_on(points)
    parts = [points[:1]]
    for a, b in pairwise(corners.tolist()):
        parts.append(_between_corners(points[a : b + 1], sides[a:b], closed, limits)[1:])
    return np.concatenate(parts)


def _goes_on(points: Floats) -> bool:
    """Tell whether a closed path turns at its seam by no more than it does elsewhere."""
    ways = np.diff(points, axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    cosines = np.einsum("ij,ij->i", ways[:-1], ways[1:])
    return bool(ways[-1] @ ways[0] >= cosines.min() - 1e-9)


def _between_corners(points: Floats, sides: Flags, closed: bool, limits: SplineLimits) -> Floats:
    fine = limits.fine
    joints = joints_beside(points, sides, _JOINT * fine)
    points, sides = np.insert(points, joints.chords + 1, joints.places, axis=0), np.insert(sides, joints.ends, True)
    points, sides, ways = _with_arc_joints(points, sides, _JOINT * fine)
    straight = sides.copy()
    while True:
        filled, off = _filled(points, _ChordKinds(sides, straight, ways), closed, fine)
        wide = (off > limits.between) & ~straight
        if not wide.any():
            return filled
        straight |= wide


def _with_arc_joints(points: Floats, sides: Flags, within: float) -> tuple[Floats, Flags, Floats]:
    """Return points with the joints of arcs among them, which chords are sides, and the direction (n, 3) in which the
    curve goes by each point, NaN where no joint tells it.
    """
    joints, chords = arc_joints(points, sides, within)
    ways = np.full_like(points, np.nan)
    for joint, k in zip(reversed(joints), chords[::-1].tolist(), strict=True):
        same = [end for end in (k, k + 1) if np.all(points[end] == joint.place)]
        if same:
            ways[same] = joint.way
            continue
        points, sides = np.insert(points, k + 1, joint.place, axis=0), np.insert(sides, k, False)
        ways = np.insert(ways, k + 1, joint.way, axis=0)
    return points, sides, ways


@dataclass(frozen=True, eq=False)
class SideJoints:
    """Joints at which sides of the true shape become arcs within the facets beside them.

    Attributes:
        joints: j of them. ends: (j,) the end of its side that is next to each. chords: (j,) the facet that it is in.
    """

    joints: tuple[LineJoint, ...]
    ends: NDArray[np.int64]
    chords: NDArray[np.int64]

    @property
    def places(self) -> Floats:
        """Where they are, (j, 3) mm."""
        return np.array([each.place for each in self.joints]).reshape(-1, 3)


def joints_beside(points: Floats, sides: Flags, within: float) -> SideJoints:
    """Return the joints beside the sides among the chords (n - 1,) between points (n, 3).

    Args:
        within: how far points may be from an arc, mm.
    """
    joints, ends, chords = [], [], []
    for k in np.flatnonzero(sides).tolist():
        for end, step in ((k + 1, 1), (k, -1)):
            beside = points[end + 1 :] if step > 0 else points[:end][::-1]
            others = sides[end:] if step > 0 else sides[:end][::-1]
            free = int(np.argmax(others)) if others.any() else len(beside)  # points up to the next side
            joint = joint_behind(points[[end - step, end]], beside[:free], within) if free else None
            if joint is not None:
                joints.append(joint)
                ends.append(end)
                chords.append(end if step > 0 else end - 1)
    return SideJoints(tuple(joints), np.array(ends, np.int64), np.array(chords, np.int64))


def sides_between(points: Floats, corners: NDArray[np.int64]) -> Flags:
    """Tell which chords (n - 1,) between points (n, 3) are sides, each run from corner to corner on its own; corners as
    of `through_points`.
    """
    return np.concatenate([sides_among(points[a : b + 1]) for a, b in pairwise(corners.tolist())])


def sides_among(points: Floats) -> Flags:
    """Tell which chords (n - 1,) between points (n, 3), n >= 2, are sides of the true shape and stand for no arc."""
    size = np.linalg.norm(np.diff(points, axis=0), axis=1)
    alone = len(size) == 1
    beside = np.concatenate([size[:1] if alone else size[1:2], size, size if alone else size[-2:-1]])
    sides: Flags = size > _SIDE * np.maximum(beside[:-2], beside[2:])
    return sides


@dataclass(frozen=True, eq=False)
class _ChordKinds:
    """Which chords (n,) are sides of the true shape, and which stay straight, for this or another reason; and the
    direction of the curve at their ends (n + 1, 3), NaN where it is not known.
    """

    sides: Flags
    straight: Flags
    ways: Floats


def _filled(points: Floats, kinds: _ChordKinds, closed: bool, fine: float) -> tuple[Floats, Floats]:
    """Return points of splines over the chords that are not straight, and how far each chord is left, mm."""
    straight, sides = kinds.straight, kinds.sides
    parts, off = [points[:1]], np.zeros(len(straight))
    known = np.isfinite(kinds.ways[:, 0])
    edges = [0, *(np.flatnonzero(np.diff(straight) | known[1:-1]) + 1).tolist(), len(straight)]
    for a, b in pairwise(edges):
        if straight[a] or (b - a < 2 and not (known[a] and known[b])):
            parts.append(points[a + 1 : b + 1])
            continue
        first = kinds.ways[a] if known[a] else None
        last = -kinds.ways[b] if known[b] else None
        if a > 0 and sides[a - 1]:
            first = _leaving(points[a - 1 : a + 3])
        if b < len(sides) and sides[b]:
            last = _leaving(points[b - 2 : b + 2][::-1])
        ends = "periodic" if closed and b - a == len(straight) else _end_conditions(first, last)
        part, off[a:b] = _run(points[a : b + 1], ends, fine)
        parts.append(part)
    return np.concatenate(parts), off


def _leaving(points: Floats) -> Floats | None:
    """Return the direction (3,) in which a spline leaves a side: the side's own, if the chords behind it turn from it
    as those of a curve do that goes on from it smoothly; None where they turn by more, or cannot tell.

    Args:
        points: both ends of the side, and the two points behind it, (4, 3) mm.
    """
    ways = np.diff(points, axis=0)
    sizes = np.linalg.norm(ways, axis=1)
    ways = ways / sizes[:, None]
    first, next_one = (float(np.arccos(np.clip(ways[k] @ ways[k + 1], -1.0, 1.0))) for k in (0, 1))
    return ways[0] if first <= _SMOOTH * next_one * sizes[1] / (sizes[1] + sizes[2]) else None


def _end_conditions(first: Floats | None, last: Floats | None) -> object:
    """Return a spline's conditions at its ends, where it has directions there; `last` points backwards."""
    free = "not-a-knot"
    return (free if first is None else (1, first), free if last is None else (1, -last))


def _run(points: Floats, ends: object, fine: float) -> tuple[Floats, Floats]:
    """Return points of one spline behind the first of its points, and how far it leaves each chord, mm."""
    from scipy.interpolate import CubicSpline

    chords = np.diff(points, axis=0)
    size = np.linalg.norm(chords, axis=1)
    along = np.concatenate([[0.0], np.cumsum(size)])
    curve = CubicSpline(along, points, bc_type=ends)
    share = (np.arange(_LOOKED_AT) + 0.5) / _LOOKED_AT
    seen = curve(along[:-1, None] + size[:, None] * share) - points[:-1, None]
    ahead = np.einsum("ijk,ik->ij", seen, chords / size[:, None])
    squares = np.einsum("ijk,ijk->ij", seen, seen) - ahead**2
    off = np.sqrt(np.maximum(squares.max(axis=1), 0.0))
    # a chord of a curve that is left by d is left by d / n² where it is one of n
    count = np.where(off > fine, np.maximum(np.ceil(np.sqrt(off / fine)), _LEAST), 1).astype(np.int64)
    chord = np.repeat(np.arange(len(size)), count)
    step = np.arange(1, len(chord) + 1) - np.repeat(np.cumsum(count) - count, count)
    made: Floats = curve(along[chord] + size[chord] * step / count[chord])
    made[np.cumsum(count) - 1] = points[1:]
    return made, off
