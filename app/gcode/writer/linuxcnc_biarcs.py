"""What LinuxCNC drives along where a program has G5.2: not the spline, but arcs that touch it, two a step of its
parameter.

It takes four steps a control point, evenly over the knots' range, and joins the points there by two arcs that leave and
arrive along the spline's own tangents and meet half way; where there is no such pair it goes straight. No tolerance is
asked. Behaviour: LinuxCNC 2.9, as its interpreter's canonical commands show.
"""

from __future__ import annotations

import math

import numpy as np

from ...fitting.fitted import FittedPath, chained, lines_between
from ...model.motion import Floats, MotionKind, Motions, Nurbs, Plane

STEPS = 4
"""Steps a control point."""
_STRAIGHT = 1e-12
"""Of a length, and of a sine: what is less is a line."""
_LEAST_TURN = 1e-5
"""Radians; where a step turns by less, the control's own formula divides by nothing, or by next to it."""


def driven(curve: Nurbs) -> Motions:
    """Return the motions that LinuxCNC makes of a planar spline.

    Args:
        curve: in a plane of constant Z, with evenly spaced knots, clamped.
    """
    points, along = _steps(curve)
    parts = [_pair(points[k], points[k + 1], along[k], along[k + 1]) for k in range(len(points) - 1)]
    return chained(parts).motions


def turns_all_along(curve: Nurbs) -> bool:
    """Tell whether every step of a planar spline turns, as it must where the control is to find its arcs."""
    _, along = _steps(curve)
    sizes = np.hypot(along[:, 0], along[:, 1])
    cross = along[:-1, 0] * along[1:, 1] - along[:-1, 1] * along[1:, 0]
    return bool(np.all(np.abs(cross) > _LEAST_TURN * sizes[:-1] * sizes[1:]))


def _steps(curve: Nurbs) -> tuple[Floats, Floats]:
    """Return the places (n, 3) that the control joins, and the directions (n, 2) there."""
    from scipy.interpolate import BSpline

    homogeneous = BSpline(
        curve.knots, np.column_stack([curve.points * curve.weights[:, None], curve.weights]), curve.degree
    )
    at = np.linspace(curve.knots[0], curve.knots[-1], STEPS * len(curve.points) + 1)
    value, slope = homogeneous(at), homogeneous.derivative()(at)
    points = value[:, :3] / value[:, 3:]
    points[0], points[-1] = curve.points[0], curve.points[-1]
    along = (slope[:, :2] - points[:, :2] * slope[:, 3:]) / value[:, 3:]
    return points, along


def _pair(start: Floats, end: Floats, leaving: Floats, arriving: Floats) -> FittedPath:
    """Return two arcs, or a line where there is no pair of them."""
    straight = FittedPath(lines_between(np.vstack([start, end])), np.array([1]))
    sizes = np.hypot(*leaving), np.hypot(*arriving)
    if min(sizes) == 0:
        return straight
    one, two = leaving / sizes[0], arriving / sizes[1]
    way = start[:2] - end[:2]
    a, b, c = 2 * (float(one @ two) - 1), 2 * float(way @ (one + two)), float(way @ way)
    if abs(a) < _STRAIGHT:
        length = -c / b if b else 0.0
    else:
        inner = b * b - 4 * a * c
        if inner < 0:
            return straight
        roots = (-b - math.sqrt(inner)) / (2 * a), (-b + math.sqrt(inner)) / (2 * a)
        if min(roots) > 0:
            return straight
        length = max(roots)
    if not length > 0:
        return straight
    handles = start[:2] + length * one, end[:2] - length * two
    middle = np.append((handles[0] + handles[1]) / 2, start[2])
    parts = [_arc(start, middle, one), _arc(middle, end, handles[1] - handles[0])]
    return chained(parts)


def _arc(start: Floats, end: Floats, leaving: Floats) -> FittedPath:
    """Return the arc that leaves along a direction, or the line where that leads straight to the end."""
    line = lines_between(np.vstack([start, end]))
    chord, size = end[:2] - start[:2], float(np.hypot(*leaving))
    side = (leaving[0] * chord[1] - leaving[1] * chord[0]) / size if size > 0 else 0.0
    if abs(side) <= _STRAIGHT * max(float(np.hypot(*chord)), 1e-300):
        return FittedPath(line, np.array([1]))
    radius = float(chord @ chord) / (2 * side)
    centre = start.copy()
    centre[:2] += radius * np.array([-leaving[1], leaving[0]]) / size
    kind = MotionKind.ARC_CCW if radius > 0 else MotionKind.ARC_CW
    motion = Motions(
        start=line.start,
        end=line.end,
        centre=centre[None],
        kind=np.array([kind], np.uint8),
        plane=np.array([Plane.XY], np.uint8),
        turns=np.ones(1, np.int32),
        feed=line.feed,
        line=line.line,
        state=line.state,
    )
    return FittedPath(motion, np.array([1]))
