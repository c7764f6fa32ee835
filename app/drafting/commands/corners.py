"""Corners of two curves: rounded by an arc that touches both, made sharp, or cut across. Curves in, curves out.

One length is the same as none, WELD. A side that the digits of a drawing leave too short by more is refused and not
stretched, unlike a gap that a tool fits by its name (`tolerances.NOMINAL`): there a path errs within its tolerance,
here the drawing itself would.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ...core.errors import InputError
from ...core.tolerances import WELD
from ...model.curves import Arc, Circle, Curve, Line, Point
from ..curves.intersections import intersection_points, lies_on, nearest_point
from .drafting import beside, between, touch_of, way_ahead
from .split import split

_CLOSE = 1e-9
"""Radians; an arc that is less than a half turn by less touches curves that lie side by side, where there is no
corner.
"""

_SMOOTH = 1e-3
"""Radians; the sine of a bend below which two curves go on in one another. Curves are drawn, and written, with such
bends.
"""

Side = Line | Arc | Circle


class Filleted(NamedTuple):
    """Two curves, shortened or lengthened, and the arc between."""

    first: Side
    arc: Arc
    second: Side


class _FoundFillet(NamedTuple):
    """A fillet, and how far it begins and ends from the places that were pointed at, mm."""

    away: float
    made: Filleted


class _CutLine(NamedTuple):
    """A line that was cut back, and where it ends now."""

    line: Line
    end: Point


def fillet(a: Side, b: Side, radius: float, near: tuple[Point, Point]) -> Filleted:
    """Return two curves shortened or lengthened to an arc that touches both, and the arc; circles stay whole.

    Args:
        near: where each curve was pointed at; these sides stay, and of all arcs that touch the one nearest to them is
            taken. Places so near the corner that the arc cuts them off stand for their sides of the corner.

    Raises:
        InputError: no arc of this radius touches both on these sides.
    """
    if isinstance(a, Circle) and not isinstance(b, Circle):
        second, arc, first = fillet(b, a, radius, (near[1], near[0]))
        return Filleted(first, Arc(arc.end, arc.start, arc.centre, not arc.ccw), second)
    found = _fillets(a, b, radius, near) or _fillets(a, b, radius, _beyond_corner(a, b, near))
    if not found:
        raise InputError(
            f"No arc of radius {radius:.3f} mm touches both curves here; use another radius, or point at other sides."
        )
    return min(found, key=lambda each: each.away).made


def sharp(a: Line | Arc, b: Line | Arc, near: tuple[Point, Point]) -> tuple[Line | Arc, Line | Arc]:
    """Return two curves shortened or lengthened to where they meet, the sides that were pointed at kept.

    Raises:
        InputError: they do not meet, however far they go on.
    """
    for corner in sorted(
        intersection_points(a, b, extended=True), key=lambda p: math.dist(p, near[0]) + math.dist(p, near[1])
    ):
        first, second = _shortened(a, corner, near[0]), _shortened(b, corner, near[1])
        if first is not None and second is not None:
            return first, second
    raise InputError(
        "Both curves do not meet, however far they go on; point at other sides, or choose curves that meet."
    )


def is_smooth(a: Line | Arc, b: Line | Arc, joint: Point) -> bool:
    """Return whether two curves go on in one another without a corner at an end that they share."""
    turn = _heading(a, joint).conjugate() * -_heading(b, joint)
    return turn.real > 0 and abs(turn.imag) < _SMOOTH * abs(turn)


def chamfer(a: Line, b: Line, sizes: tuple[float, float], near: tuple[Point, Point]) -> tuple[Line, Line, Line]:
    """Return two lines cut back from their corner, and the line across.

    Args:
        sizes: how far the corner is cut back along each, mm. near: where each line was pointed at; these sides stay.

    Raises:
        InputError: the lines are parallel, or shorter than what is cut off.
    """
    corner = intersection_points(a, b, extended=True)
    if not corner:
        raise InputError("Parallel lines have no corner to chamfer; choose lines that meet.")
    ends = [_cut_back(line, corner[0], size, at) for line, size, at in zip((a, b), sizes, near, strict=True)]
    (first, p), (second, q) = ends
    return first, Line(p, q), second


def _cut_back(line: Line, corner: Point, size: float, near: Point) -> _CutLine:
    far = max((line.start, line.end), key=lambda p: math.dist(p, corner))
    if between(line, corner) and math.dist(corner, near) > WELD:
        toward = (near[0] - corner[0], near[1] - corner[1])
        far = max((line.start, line.end), key=lambda p: (p[0] - corner[0]) * toward[0] + (p[1] - corner[1]) * toward[1])
    room = math.dist(corner, far)
    if not WELD <= size < room - WELD:
        raise InputError(f"The chamfer is {size:.3f} mm and the line {room:.3f} mm from its corner; use less.")
    at = (corner[0] + (far[0] - corner[0]) * size / room, corner[1] + (far[1] - corner[1]) * size / room)
    return _CutLine(Line(at, line.end) if far == line.end else Line(line.start, at), at)


def _beyond_corner(a: Side, b: Side, near: tuple[Point, Point]) -> tuple[Point, Point]:
    """Return the ends, away from the corner of two curves, of the sides that were pointed at; the places themselves
    without a corner.
    """
    corners = intersection_points(a, b, extended=True)
    if not corners:
        return near
    corner = min(corners, key=lambda p: math.dist(p, near[0]) + math.dist(p, near[1]))
    first, second = (_far_end(curve, corner, at) for curve, at in zip((a, b), near, strict=True))
    return first, second


def _far_end(curve: Side, corner: Point, near: Point) -> Point:
    if isinstance(curve, Circle):
        return near
    side: Curve = curve
    if between(curve, corner):
        side = min(split(curve, [corner]), key=lambda piece: math.dist(nearest_point(piece, near), near))
    return max((side.start, side.end), key=lambda p: math.dist(p, corner))


def _fillets(a: Side, b: Side, radius: float, near: tuple[Point, Point]) -> list[_FoundFillet]:
    """Return every fillet on these sides."""
    found = []
    for centre in _centres(a, b, radius):
        touch = touch_of(a, centre, radius), touch_of(b, centre, radius)
        first, second = _kept(a, touch[0], near[0]), _kept(b, touch[1], near[1])
        if first is None or second is None or math.dist(*touch) < WELD:
            continue
        arc = Arc(touch[0], touch[1], centre, _turns_left(first, touch, centre))
        if abs(arc.sweep) < math.pi - _CLOSE and _goes_on(second, arc):
            away = math.dist(touch[0], near[0]) + math.dist(touch[1], near[1])
            found.append(_FoundFillet(away, Filleted(first, arc, second)))
    return found


def _centres(a: Side, b: Side, radius: float) -> list[Point]:
    """Return the centres of circles that touch both curves extended: where their parallels at the radius meet."""
    return [
        p
        for one in _parallels(a, radius)
        for other in _parallels(b, radius)
        for p in intersection_points(one, other, extended=True)
    ]


def _parallels(curve: Side, away: float) -> list[Curve]:
    if not isinstance(curve, Line):
        return [Circle(curve.centre, r) for r in (curve.radius + away, abs(curve.radius - away)) if r > WELD]
    return list(beside(curve, away))


def _kept(curve: Side, at: Point, near: Point) -> Side | None:
    return curve if isinstance(curve, Circle) else _shortened(curve, at, near)


def _shortened(curve: Line | Arc, at: Point, near: Point) -> Line | Arc | None:
    """Return the part of a curve, extended, that ends at a point and holds the place pointed at; None where nothing
    would stay.
    """
    place = touch_of(curve, near)
    if math.dist(at, place) < WELD:
        place = max((curve.start, curve.end), key=lambda p: math.dist(p, at))
    if isinstance(curve, Line):
        dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
        onward = (place[0] - at[0]) * dx + (place[1] - at[1]) * dy > 0
        far = curve.end if onward else curve.start
        left = (far[0] - at[0]) * dx + (far[1] - at[1]) * dy
        if (left > 0) is not onward or math.dist(far, at) < WELD:
            return None
        return Line(at, far) if onward else Line(far, at)
    keeps_end = way_ahead(curve, at, forward=False) if not lies_on(curve, at) else 0.0
    if lies_on(curve, at):
        kept = min(split(curve, [at]), key=lambda p: math.dist(nearest_point(p, near), near), default=None)
        return kept if isinstance(kept, Arc) else None
    to_end = way_ahead(curve, at, forward=True)
    start, end = (at, curve.end) if keeps_end < to_end else (curve.start, at)
    return Arc(start, end, curve.centre, curve.ccw) if math.dist(start, end) > WELD else None


def _heading(curve: Line | Arc, at: Point) -> complex:
    """Return the direction of a curve at one of its ends, going away from the rest of the curve."""
    outward = 1 if math.dist(at, curve.end) < math.dist(at, curve.start) else -1
    if isinstance(curve, Line):
        return complex(curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]) * outward
    spoke = complex(at[0] - curve.centre[0], at[1] - curve.centre[1])
    return spoke * (1j if curve.sweep > 0 else -1j) * outward


def _turns_left(kept: Side, touch: tuple[Point, Point], centre: Point) -> bool:
    """Return whether the arc between two touching points runs counter-clockwise: on from what it follows, of circles
    the short way.
    """
    spoke, other = (complex(p[0] - centre[0], p[1] - centre[1]) for p in touch)
    if isinstance(kept, Circle):
        return (spoke.conjugate() * other).imag > 0
    return (_heading(kept, touch[0]).conjugate() * -spoke).imag > 0


def _goes_on(kept: Side, arc: Arc) -> bool:
    """Return whether an arc runs on into a curve at its end without turning back."""
    if isinstance(kept, Circle):
        return True
    spoke = complex(arc.end[0] - arc.centre[0], arc.end[1] - arc.centre[1])
    way = spoke * (1j if arc.sweep > 0 else -1j)
    return (way.conjugate() * -_heading(kept, arc.end)).real > 0
