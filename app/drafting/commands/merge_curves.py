"""One curve in the place of two that overlap: of lines on one straight line, of arcs on one circle."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...model.curves import Arc, Circle, Line, Point
from .defects import turn_of

_WHOLE = math.tau - 1e-9
"""Radians; an arc that sweeps more is a whole circle."""


def merged(
    stays: Line | Arc | Circle, goes: Line | Arc | Circle, ends: Sequence[Point], tolerance: float
) -> Line | Arc | Circle | None:
    """Return the curve that two which overlap are together, in the direction of the first; None where they are not one.

    Args:
        ends: of the curves that both have been made of, mm; none may lie farther from the one curve than the tolerance.
        tolerance: mm.
    """
    if isinstance(stays, Line) and isinstance(goes, Line):
        return _line(stays, goes, ends, tolerance)
    if isinstance(stays, Line) or isinstance(goes, Line):
        return None
    return _round(stays, goes, ends, tolerance)


def _line(stays: Line, goes: Line, ends: Sequence[Point], tolerance: float) -> Line | None:
    (x, y), size = stays.start, math.dist(stays.start, stays.end)
    ux, uy = (stays.end[0] - x) / size, (stays.end[1] - y) / size

    def way(point: Point) -> float:
        return (point[0] - x) * ux + (point[1] - y) * uy

    along = sorted((stays.start, stays.end, goes.start, goes.end), key=way)
    made = Line(along[0], along[-1])
    long, dx, dy = math.dist(made.start, made.end), made.end[0] - made.start[0], made.end[1] - made.start[1]
    off = max(abs((px - made.start[0]) * dy - (py - made.start[1]) * dx) / long for px, py in ends)
    apart = min(way(goes.start), way(goes.end)) > size + tolerance or max(way(goes.start), way(goes.end)) < -tolerance
    return made if off <= tolerance and not apart else None


def _round(stays: Arc | Circle, goes: Arc | Circle, ends: Sequence[Point], tolerance: float) -> Arc | Circle | None:
    from ...geometry.arcs.arcs import equally_far  # not when the window opens

    (first, turn), (other, there) = turn_of(stays), turn_of(goes)
    ahead, behind = (other - first) % math.tau, (first - other) % math.tau
    if ahead <= turn:
        from_stays, to_stays, whole = True, ahead + there <= turn, max(turn, ahead + there)
    elif behind <= there:
        from_stays, to_stays, whole = False, behind + turn >= there, max(there, behind + turn)
    else:
        return None
    if whole > _WHOLE:
        return Circle(stays.centre, stays.radius, stays.ccw)
    begin, end = _begin(stays if from_stays else goes), _end(stays if to_stays else goes)
    centre = equally_far(begin, end, stays.centre)
    made = Arc(begin, end, centre) if stays.ccw else Arc(end, begin, centre, ccw=False)
    off = max(abs(math.dist(p, made.centre) - made.radius) for p in ends)
    return made if max(off, math.dist(made.centre, stays.centre)) <= tolerance else None


def _begin(curve: Arc | Circle) -> Point:
    """Return where a curve begins counter-clockwise."""
    return curve.start if curve.ccw else curve.end


def _end(curve: Arc | Circle) -> Point:
    return curve.end if curve.ccw else curve.start
