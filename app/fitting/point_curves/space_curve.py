"""Paths in space as Bézier pieces: what the judge of curves looks at, whatever made them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...geometry.arcs.bezier import cut_at_knots, elevated
from ...geometry.arcs.nurbs import flattened
from ...model.motion import MotionKind, Motions, Nurbs
from ...model.motion_path import ArcPaths, along_xyz, arc_paths

Floats = NDArray[np.float64]

DEGREE = 5
"""What holds lines, splines of degree 3 and 5, and arcs nearly enough; lower degrees are raised, which changes
nothing.
"""
ARC_SLACK = 1e-9
"""An arc's pieces are nowhere farther than this from it, mm."""
CHORD_SLACK = 1e-6
"""What is no polynomial, or one of a higher degree, becomes chords so near, mm."""
_SIXTH = 46080.0
"""6! 2^6: a quintic that shares place, speed and acceleration at both ends is off by the sixth derivative over this at
most.
"""


@dataclass(frozen=True, eq=False)
class SpaceCurve:
    """A curve of m polynomial Bézier pieces one after the other; its parameter u runs from 0 to m.

    Attributes:
        control: (m, 6, 3) control points, mm, m >= 1.
        owner: (m,) what each piece came from: row of the motion, or 0.
        slack: the meant curve is nowhere farther from this one than so much, mm, the same place along each compared.
    """

    control: Floats
    owner: NDArray[np.int64]
    slack: float = 0.0

    def __len__(self) -> int:
        return len(self.control)

    def at(self, u: Floats) -> Floats:
        """Return points (k, 3), mm, for parameters (k,) in [0, m]."""
        piece = np.clip(u.astype(np.int64), 0, len(self) - 1)
        t = (u - piece)[:, None, None]
        b = self.control[piece]
        while b.shape[1] > 1:
            b = b[:, :-1] * (1 - t) + b[:, 1:] * t
        points: Floats = b[:, 0]
        return points


def curve_of_nurbs(curve: Nurbs) -> SpaceCurve:
    """Return the same curve; one with unlike weights, or of a degree above 5, as chords within `CHORD_SLACK`."""
    if curve.degree > DEGREE or np.ptp(curve.weights) > 0:
        chords = curve_of_points(flattened(curve, CHORD_SLACK))
        return SpaceCurve(chords.control, chords.owner, CHORD_SLACK)
    control = elevated(cut_at_knots(curve.points, curve.knots, curve.degree), DEGREE)
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def curve_of_points(points: Floats) -> SpaceCurve:
    """Return a polyline (n, 3), n >= 2, as a curve."""
    control = _straight(points[:-1], points[1:])
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def curve_of_motions(motions: Motions, first: int = 0, stop: int | None = None) -> SpaceCurve:
    """Return the path of motions `first` to `stop`, `stop` excluded: lines and splines as they are, arcs within
    `ARC_SLACK`.

    Args:
        motions: in any planes; helices and spirals too.

    Raises:
        GeometryError: there is none, or one does not begin where the one before ended.
    """
    stop = len(motions) if stop is None else stop
    if stop <= first:
        raise GeometryError("a curve of no motions; at least one was expected.")
    gap = np.abs(motions.start[first + 1 : stop] - motions.end[first : stop - 1])
    if gap.size and gap.max() > ARC_SLACK:
        raise GeometryError(
            f"motion {first + 1 + int(np.argmax(gap.max(axis=1)))} does not begin where the one before ended."
        )
    parts = list(_parts(motions, first, stop))
    owner = np.concatenate([rows for rows, _, _ in parts])
    order = np.argsort(owner, kind="stable")
    return SpaceCurve(
        np.concatenate([control for _, control, _ in parts])[order], owner[order], max(slack for _, _, slack in parts)
    )


def joined(curves: Sequence[SpaceCurve]) -> SpaceCurve:
    """Return curves one after the other as one."""
    return SpaceCurve(
        np.concatenate([curve.control for curve in curves]),
        np.concatenate([curve.owner for curve in curves]),
        max(curve.slack for curve in curves),
    )


def _parts(motions: Motions, first: int, stop: int) -> Iterator[tuple[NDArray[np.int64], Floats, float]]:
    """Yield the pieces of lines, arcs and splines: rows, control points, slack."""
    rows = np.arange(first, stop)
    straight = rows[motions.kind[first:stop] <= MotionKind.LINE]
    yield straight, _straight(motions.start[straight], motions.end[straight]), 0.0
    arcs = arc_paths(motions, first, stop)
    if len(arcs):
        yield *_arcs(arcs, motions.start[arcs.rows], motions.end[arcs.rows]), ARC_SLACK
    for row in (first + np.flatnonzero(motions.kind[first:stop] == MotionKind.SPLINE)).tolist():
        curve = curve_of_nurbs(motions.splines[row])
        yield np.full(len(curve), row), curve.control, curve.slack


def _straight(start: Floats, end: Floats) -> Floats:
    share = np.linspace(0.0, 1.0, DEGREE + 1)[None, :, None]
    control: Floats = start[:, None] * (1 - share) + end[:, None] * share
    return control


def _arcs(arcs: ArcPaths, start: Floats, end: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Return arcs, helices and spirals as quintics that share place, speed and acceleration with them where they meet.

    Args:
        arcs: m of them. start, end: (m, 3) mm.

    Returns:
        Of each piece the row that it is of, and its control points.
    """
    turn, grow = np.abs(arcs.sweep), arcs.end_radius - arcs.start_radius
    most = turn**6 * np.maximum(arcs.start_radius, arcs.end_radius) + 6 * np.abs(grow) * turn**5
    count = np.maximum(np.ceil((most / (_SIXTH * ARC_SLACK)) ** (1 / 6)), np.ceil(turn)).astype(np.int64)
    of = np.repeat(np.arange(len(arcs)), count + 1)  # of each place: an arc of k pieces has k + 1
    behind = np.cumsum(count + 1)
    at = (np.arange(len(of)) - (behind - count - 1)[of]) / count[of]
    place, speed, accel = (along_xyz(own, arcs.axes[of]) for own in _moving(arcs, grow, of, at))
    place[behind - count - 1], place[behind - 1] = start, end
    before, after = np.delete(np.arange(len(of)), behind - 1), np.delete(np.arange(len(of)), behind - count - 1)
    step = count[of][:, None]
    speed, accel = speed / step, accel / step**2
    b1, b4 = place[before] + speed[before] / 5, place[after] - speed[after] / 5
    b2 = 2 * b1 - place[before] + accel[before] / 20
    b3 = 2 * b4 - place[after] + accel[after] / 20
    return arcs.rows[of[before]], np.stack([place[before], b1, b2, b3, b4, place[after]], axis=1)


def _moving(arcs: ArcPaths, grow: Floats, of: NDArray[np.int64], at: Floats) -> tuple[Floats, Floats, Floats]:
    """Return place, speed and acceleration (n, 3) along arcs `of`, each at a part `at` of it, in the axes of its
    plane.
    """
    sweep, grows, zero = arcs.sweep[of][:, None], grow[of][:, None], np.zeros(len(of))
    angle, radius = arcs.angle[of] + arcs.sweep[of] * at, (arcs.start_radius[of] + grow[of] * at)[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    out, side = np.stack([cos, sin, zero], axis=1), np.stack([-sin, cos, zero], axis=1)
    place = radius * out
    place[:, :2] += arcs.centre[of]
    place[:, 2] = arcs.height[of] + arcs.rise[of] * at
    speed = grows * out + radius * sweep * side
    speed[:, 2] = arcs.rise[of]
    return place, speed, 2 * grows * sweep * side - radius * sweep**2 * out
