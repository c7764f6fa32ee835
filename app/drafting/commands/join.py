"""The command `join`: small gaps close where the curves meet, and pieces that are one line, arc or ellipse become
one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

from ...core.errors import InputError
from ...core.tolerances import CURVE, JOIN, WELD
from ...core.wording import counted
from ...model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from ..curves.chains import CurveChain, chained
from ..curves.intersections import intersection_points
from ..expressions.arguments import Arguments
from .command import DraftingSession, ReplaceCurves
from .command_curves import chosen_curves
from .defects import End, meetings, point_of
from .properties import properties_of, with_property

_LARGEST = 10.0
"""mm; a wider gap is drawn on purpose."""
_WHOLE = math.tau - 1e-9
"""Radians; an arc that sweeps more is a whole circle."""


def join(words: Arguments, session: DraftingSession) -> ReplaceCurves:
    """Close the gaps among some curves, and make one of pieces that go on in one another; layers are not mixed."""
    within = words.length("how far apart ends may be") if words.accept("within") else JOIN
    if not WELD < within <= _LARGEST:
        raise InputError(
            f"Ends within {within:g} mm cannot be joined; the distance is greater than 0 and at most {_LARGEST:g} mm."
        )
    drawn = chosen_curves(words, session, "join")
    met, gaps = gaps_closed(drawn, within)
    layers = {e.id: e.layer for e in session.part.entities if e.id in drawn}
    chains, curves = chained(met), dict[int, Curve | None](met)
    for chain in chains:
        for numbers, _, made in _runs(chain, layers):
            curves.update(dict.fromkeys(numbers))
            curves[min(numbers)] = made
    pieces = {
        number: (curve,) if curve is not None else () for number, curve in curves.items() if curve is not drawn[number]
    }
    merged = sum(not made for made in pieces.values())
    left, loops = len(drawn) - merged, sum(chain.closed for chain in chains)
    became = f"{counted(len(drawn), 'curve')} became {left}" if merged else f"{counted(left, 'curve')} as before"
    shapes = f"{counted(loops, 'closed contour')}, {len(chains) - loops} open"
    return ReplaceCurves(pieces, "Join", f"{counted(gaps, 'gap')} closed, {became}; {shapes}.")


class CurvesWithoutGaps(NamedTuple):
    """Curves by number, and how many gaps between them were closed."""

    curves: dict[int, Curve]
    gaps: int


def gaps_closed(drawn: Mapping[int, Curve], within: float) -> CurvesWithoutGaps:
    """Return curves whose ends, where they are no farther apart than a distance, meet.

    Two lines or arcs go on, or back, to where they cross; other ends go to their middle, or to the end that cannot
    move.
    """
    curves, gaps = dict(drawn), 0
    for meeting in meetings(curves, within):
        points = [point_of(curves[number], last) for number, last in meeting]
        to = _meeting_point([curves[number] for number, _ in meeting], points, within)
        gaps += brought_to(to, curves, meeting, lambda number, last, to: _with_end(curves[number], last, to))
    return CurvesWithoutGaps(curves, gaps)


def brought_to(
    to: Point, curves: dict[int, Curve], meeting: list[End], with_end: Callable[[int, bool, Point], Curve | None]
) -> bool:
    """Move ends to a point, in place, where all of them can be; return whether they were apart and are no more.

    Args:
        with_end: returns a curve with its last point, or first one, elsewhere; None where that cannot be.
    """
    points = [point_of(curves[number], last) for number, last in meeting]
    moved = {number: curve for number, last in meeting if (curve := with_end(number, last, to)) is not None}
    if len(moved) < len(meeting):
        return False
    curves.update(moved)
    return any(math.dist(points[0], point) > WELD for point in points)


def _meeting_point(curves: list[Curve], points: list[Point], within: float) -> Point:
    fixed = [point for curve, point in zip(curves, points, strict=True) if "end" not in properties_of(curve)]
    if fixed or all(point == points[0] for point in points):
        return next(iter(fixed), points[0])
    if len(curves) == 2 and isinstance(curves[0], Line | Arc) and isinstance(curves[1], Line | Arc):
        crossing = [
            p
            for p in intersection_points(curves[0], curves[1], extended=True)
            if max(math.dist(p, end) for end in points) <= within
        ]
        if crossing:
            return min(crossing, key=lambda p: math.dist(p, points[0]) + math.dist(p, points[1]))
    return (sum(p[0] for p in points) / len(points), sum(p[1] for p in points) / len(points))


def _with_end(curve: Curve, last: bool, to: Point) -> Curve | None:
    """Return a curve with an end elsewhere, an arc on its circle where it can; None where it cannot be."""
    if point_of(curve, last) == to:
        return curve
    start, end = (curve.start, to) if last else (to, curve.end)
    if isinstance(curve, Arc) and start != end and abs(math.dist(to, curve.centre) - curve.radius) < WELD / 10:
        made = Arc(start, end, curve.centre, curve.ccw)
        return made if abs(made.sweep - curve.sweep) < math.pi else None
    try:
        return with_property(curve, "end" if last else "start", to)  # type: ignore[no-any-return]
    except InputError:
        return None


class _JoinedRun(NamedTuple):
    """Neighbours of a chain that are one curve: their numbers, the points where they met, the curve."""

    numbers: list[int]
    joints: list[Point]
    curve: Curve


def _runs(chain: CurveChain, layers: Mapping[int, str]) -> list[_JoinedRun]:
    """Return which neighbours of a chain are one curve."""
    runs = list[_JoinedRun]()
    for number, curve in zip(chain.numbers, chain.curves, strict=True):
        if (
            runs
            and layers[runs[-1].numbers[0]] == layers[number]
            and (longer := _one(runs[-1].curve, curve, runs[-1].joints)) is not None
        ):
            runs[-1] = _JoinedRun([*runs[-1].numbers, number], [*runs[-1].joints, curve.start], longer)
        else:
            runs.append(_JoinedRun([number], [], curve))
    if chain.closed and len(runs) > 1 and layers[runs[-1].numbers[0]] == layers[runs[0].numbers[0]]:
        (first, joints, begins), (last, more, ends) = runs[0], runs[-1]
        if (longer := _one(ends, begins, [*more, *joints])) is not None:
            runs[0] = _JoinedRun([*last, *first], [], longer)
            runs.pop()
    return [each for each in runs if len(each.numbers) > 1]


def _one(a: Curve, b: Curve, joints: list[Point]) -> Curve | None:
    """Return the curve that two are of which the second goes on where the first ends; None where they are two.

    Args:
        a, b: neighbours in the direction of travel.
        joints: where the pieces that they have been made of met; no joint may lie off the one curve by more than 1 µm.
    """
    if isinstance(a, Line) and isinstance(b, Line):
        return _one_line(a, b, joints)
    if isinstance(a, Arc) and isinstance(b, Arc):
        return _one_arc(a, b)
    if isinstance(a, Ellipse) and isinstance(b, Ellipse):
        return _one_ellipse(a, b)
    return None


def _one_line(a: Line, b: Line, joints: list[Point]) -> Line | None:
    (x, y), (ex, ey) = a.start, b.end
    dx, dy = ex - x, ey - y
    size = math.hypot(dx, dy)
    onward = (a.end[0] - x) * (ex - b.start[0]) + (a.end[1] - y) * (ey - b.start[1]) > 0
    if not onward or size <= WELD:
        return None
    return (
        Line(a.start, b.end)
        if all(abs((px - x) * dy - (py - y) * dx) <= CURVE * size for px, py in (*joints, a.end))
        else None
    )


def _one_arc(a: Arc, b: Arc) -> Arc | Circle | None:
    from ...geometry.arcs.arcs import equally_far  # not when the window opens

    if (
        a.ccw != b.ccw
        or math.dist(a.centre, b.centre) + abs(a.radius - b.radius) > CURVE
        or abs(a.sweep + b.sweep) > math.tau + 1e-6
    ):
        return None
    if math.dist(a.start, b.end) <= WELD:
        return Circle(a.centre, a.radius, a.ccw)
    return (
        Arc(a.start, b.end, equally_far(a.start, b.end, a.centre), a.ccw) if abs(a.sweep + b.sweep) < _WHOLE else None
    )


def _one_ellipse(a: Ellipse, b: Ellipse) -> Ellipse | None:
    if (a.centre, a.major, a.ratio, a.ccw) != (b.centre, b.major, b.ratio, b.ccw):
        return None
    more = b.end_parameter - b.start_parameter
    whole = a.end_parameter - a.start_parameter + more
    if whole > math.tau + 1e-9:
        return None
    whole = math.tau if whole > _WHOLE else whole
    first = a.start_parameter if a.ccw else a.end_parameter - whole
    return replace(a, start_parameter=first, end_parameter=first + whole)
