"""A motion that is done in part: where the controlled point is, and the way that it has gone so far."""

from __future__ import annotations

import numpy as np

from .motion import Floats, MotionKind, Motions
from .motion_path import arc_paths, spline_points

_COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
_FULL = 2 * np.pi
"""Radians of a turn."""
_WHOLE = 1e-9
"""Turns; an arc that is so near to whole turns is taken as that."""


def place_on(motions: Motions, row: int, fraction: float) -> Floats:
    """Return (3,) where a motion is when a part of it is done, mm; of splines a part of the parameter's range."""
    part = part_of(motions, row, fraction)
    return np.asarray(part.end[-1] if len(part) else motions.start[row])


def part_of(motions: Motions, row: int, fraction: float) -> Motions:
    """Return the way that a motion has gone when a part of it is done: an arc stays an arc, a spline becomes chords.

    Args:
        motions: n motions. row: which one.
        fraction: how much of it, in [0, 1]; at 0 nothing is done.
    """
    if fraction <= 0:
        return Motions.none()
    if row in motions.splines:
        return _chords(motions, row, _spline_way(motions, row, fraction))
    one = Motions(*(getattr(motions, name)[row : row + 1] for name in _COLUMNS))
    if fraction >= 1:
        return one
    end, turns = one.start + (one.end - one.start) * fraction, one.turns
    if one.kind[0] in (MotionKind.ARC_CW, MotionKind.ARC_CCW):
        arcs = arc_paths(one)
        end = arcs.points(np.array([fraction]))[:, 0]
        swept = abs(float(arcs.sweep[0])) * fraction / _FULL
        turns = np.array([max(int(np.ceil(swept - _WHOLE)), 1)], np.int32)
        if abs(swept - round(swept)) < _WHOLE and round(swept):  # ends that are alike in the plane are whole turns
            end[0, arcs.axes[0, :2]] = one.start[0, arcs.axes[0, :2]]
    return Motions(one.start, end, one.centre, one.kind, one.plane, turns, one.feed, one.line, one.state)


def _spline_way(motions: Motions, row: int, fraction: float) -> Floats:
    """Return points along a spline up to a part of its parameter's range, (k, 3), k >= 2."""
    points = spline_points(motions.splines[row])
    at = np.linspace(0.0, 1.0, len(points))
    whole = points[at < fraction]
    last = np.array([np.interp(fraction, at, points[:, axis]) for axis in range(3)])
    return np.vstack([whole, last])


def _chords(motions: Motions, row: int, points: Floats) -> Motions:
    """Return straight motions from point to point in place of one motion."""
    rows = np.full(len(points) - 1, row)
    columns = {name: getattr(motions, name)[rows] for name in _COLUMNS}
    columns |= {
        "start": points[:-1].copy(),
        "end": points[1:].copy(),
        "kind": np.full(len(rows), MotionKind.LINE, np.uint8),
    }
    return Motions(**columns)
