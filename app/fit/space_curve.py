"""Paths in space as Bézier pieces: what the judge of curves looks at, whatever made them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.errors import GeometryError
from app.fit.bezier import cut_at_knots
from app.fit.nurbs import flattened
from app.model.motion import MotionKind, Motions, Nurbs
from app.model.motion_path import ArcPaths, along_xyz, arc_paths

Floats = NDArray[np.float64]

DEGREE = 5
"""What holds lines, splines of degree 3 and 5, and arcs nearly enough; lower degrees are raised, which changes nothing."""
ARC_SLACK = 1e-9
"""An arc's pieces are nowhere farther than this from it, mm."""
CHORD_SLACK = 1e-6
"""What is no polynomial, or one of a higher degree, becomes chords so near, mm."""
_SIXTH = 46080.0
"""6! 2^6: a quintic that shares place, speed and acceleration at both ends is off by the sixth derivative over this at most."""


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
    control = raised(cut_at_knots(curve.points, curve.knots, curve.degree))
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def curve_of_points(points: Floats) -> SpaceCurve:
    """Return a polyline (n, 3), n >= 2, as a curve."""
    control = _straight(points[:-1], points[1:])
    return SpaceCurve(control, np.zeros(len(control), np.int64))


def curve_of_motions(motions: Motions, first: int = 0, stop: int | None = None) -> SpaceCurve:
    """Return the path of motions `first` to `stop`, `stop` excluded: lines and splines as they are, arcs within `ARC_SLACK`.

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
        raise GeometryError(f"motion {first + 1 + int(np.argmax(gap.max(axis=1)))} does not begin where the one before ended.")
    parts = list(_parts(motions, first, stop))
    owner = np.concatenate([rows for rows, _, _ in parts])
    order = np.argsort(owner, kind="stable")
    return SpaceCurve(np.concatenate([control for _, control, _ in parts])[order], owner[order], max(slack for _, _, slack in parts))


def joined(curves: Sequence[SpaceCurve]) -> SpaceCurve:
    """Return curves one after the other as one."""
    return SpaceCurve(
        np.concatenate([curve.control for curve in curves]), np.concatenate([curve.owner for curve in curves]),
        max(curve.slack for curve in curves),
    )  # fmt: skip


def _parts(motions: Motions, first: int, stop: int) -> Iterator[tuple[NDArray[np.int64], Floats, float]]:
    """Yield the pieces of lines, arcs and splines: rows, control points, slack."""
    rows = np.arange(first, stop)
    straight = rows[motions.kind[first:stop] <= MotionKind.LINE]
    yield straight, _straight(motions.start[straight], motions.end[straight]), 0.0
    arcs = arc_paths(motions)
    low, high = np.searchsorted(arcs.rows, (first, stop))
    for k in range(low, high):
        control = _arc(arcs, k, motions.start[arcs.rows[k]], motions.end[arcs.rows[k]])
        yield np.full(len(control), arcs.rows[k]), control, ARC_SLACK
    for row, spline in motions.splines.items():
        if first <= row < stop:
            curve = curve_of_nurbs(spline)
            yield np.full(len(curve), row), curve.control, curve.slack


def _straight(start: Floats, end: Floats) -> Floats:
    share = np.linspace(0.0, 1.0, DEGREE + 1)[None, :, None]
    control: Floats = start[:, None] * (1 - share) + end[:, None] * share
    return control


def _arc(arcs: ArcPaths, k: int, start: Floats, end: Floats) -> Floats:
    """Return an arc, helix or spiral as quintics that share place, speed and acceleration with it where they meet."""
    sweep, grow = arcs.sweep[k], arcs.end_radius[k] - arcs.start_radius[k]
    most = abs(sweep) ** 6 * max(arcs.start_radius[k], arcs.end_radius[k]) + 6 * abs(grow) * abs(sweep) ** 5
    count = max(math.ceil((most / (_SIXTH * ARC_SLACK)) ** (1 / 6)), math.ceil(abs(sweep)))
    at = np.linspace(0.0, 1.0, count + 1)
    angle, radius = arcs.angle[k] + sweep * at, arcs.start_radius[k] + grow * at
    cos, sin, zero = np.cos(angle), np.sin(angle), np.zeros(count + 1)
    out, side = np.stack([cos, sin, zero], axis=1), np.stack([-sin, cos, zero], axis=1)
    place = radius[:, None] * out
    place[:, :2] += arcs.centre[k]
    place[:, 2] = arcs.height[k] + arcs.rise[k] * at
    speed = grow * out + (radius * sweep)[:, None] * side
    speed[:, 2] = arcs.rise[k]
    accel = 2 * grow * sweep * side - (radius * sweep**2)[:, None] * out
    axes = np.broadcast_to(arcs.axes[k], place.shape)
    place, speed, accel = (along_xyz(own, axes) for own in (place, speed / count, accel / count**2))
    place[0], place[-1] = start, end
    b1 = place[:-1] + speed[:-1] / 5
    b4 = place[1:] - speed[1:] / 5
    b2 = 2 * b1 - place[:-1] + accel[:-1] / 20
    b3 = 2 * b4 - place[1:] + accel[1:] / 20
    return np.stack([place[:-1], b1, b2, b3, b4, place[1:]], axis=1)


def raised(control: Floats) -> Floats:
    """Return the same pieces (m, p + 1, 3) with degree 5, p <= 5: point k of one degree more is between points k - 1 and k."""
    while (degree := control.shape[1] - 1) < DEGREE:
        share = (np.arange(degree + 2) / (degree + 1))[:, None]
        before = np.pad(control, ((0, 0), (1, 0), (0, 0)))
        after = np.pad(control, ((0, 0), (0, 1), (0, 0)))
        control = share * before + (1 - share) * after
    return control
