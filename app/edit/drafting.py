"""What draughtsmen do with curves that meet: trim, extend, break, fillet, chamfer. Curves in, curves out."""

from __future__ import annotations

import math
from collections.abc import Iterable

from app.edit.meet import foot, has, meets
from app.edit.sample import Box, bounds
from app.edit.shapes import shown
from app.edit.split import split
from app.errors import InputError
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point
from app.tolerances import WELD

_CLOSE = 1e-9


def trimmed(curve: Curve, at: Point, edges: Iterable[Curve]) -> tuple[Curve, ...]:
    """Return what stays of a curve when the piece at a point is taken out, up to the nearest edges on both sides.

    Raises:
        InputError: no edge meets the curve.
    """
    box = _grown(bounds(curve))
    cuts = [p for edge in edges if _may_reach(edge, box) for p in meets(curve, edge)]
    pieces = split(curve, cuts)
    if len(pieces) == 1 and not _closed(curve):
        raise InputError(f"Nothing crosses the curve near {shown(at)}; draw an edge across it, or delete it.")
    if len(pieces) == 1:
        raise InputError("A closed curve must be crossed twice to be trimmed; draw another edge across it.")
    gone = min(pieces, key=lambda piece: math.dist(foot(piece, at), at))
    pieces = split(curve, [gone.start, gone.end])  # not at the edges beyond these two
    nearest = min(pieces, key=lambda piece: math.dist(foot(piece, at), at))
    return tuple(piece for piece in pieces if piece is not nearest)


def _grown(box: Box) -> Box:
    return (box[0] - WELD, box[1] - WELD, box[2] + WELD, box[3] + WELD)


def _may_reach(curve: Curve, box: Box) -> bool:
    """Return False where a curve surely has no point in a box: quickly, for ten thousand of them."""
    x0, y0, x1, y1 = box
    if isinstance(curve, Line):
        (ax, ay), (bx, by) = curve.start, curve.end
        return not ((ax < x0 and bx < x0) or (ax > x1 and bx > x1) or (ay < y0 and by < y0) or (ay > y1 and by > y1))
    if isinstance(curve, Arc | Circle):
        (x, y), r = curve.centre, curve.radius
        return x + r >= x0 and x - r <= x1 and y + r >= y0 and y - r <= y1
    return True


def extended(curve: Curve, at: Point, edges: Iterable[Curve]) -> Curve:
    """Return a line or arc whose end nearest to a point goes on to the first edge.

    Raises:
        InputError: the curve is neither, or no edge lies ahead.
    """
    if not isinstance(curve, Line | Arc):
        raise InputError("Only lines and arcs can be extended; draw on from the end of other curves.")
    forward = math.dist(at, curve.end) <= math.dist(at, curve.start)
    found = [p for edge in edges for p in _met_ahead(curve, edge) if not _between(curve, p)]
    ends = curve.start, curve.end  # an arc that went on to its own other end would be a circle
    ahead = [(way, p) for p in found if (way := _way_ahead(curve, p, forward)) > WELD and min(math.dist(p, end) for end in ends) > WELD]
    if not ahead:
        raise InputError(f"No edge lies ahead of the end at {shown(curve.end if forward else curve.start)}; draw one, or give the length.")
    to = min(ahead)[1]
    start, end = (curve.start, to) if forward else (to, curve.end)
    return Line(start, end) if isinstance(curve, Line) else Arc(start, end, curve.centre, curve.ccw)


def broken(curve: Curve, first: Point, second: Point | None) -> tuple[Curve, ...]:
    """Return a curve in two pieces at a point, or without what lies between two points.

    Of a closed curve what lies from the first point to the second in its direction goes.

    Raises:
        InputError: the point lies at an end, or a closed curve is broken at one point.
    """
    a = foot(curve, first)
    if second is None:
        if _closed(curve):
            raise InputError("A closed curve is broken at two points; give another one.")
        pieces = split(curve, [a])
        if len(pieces) < 2:
            raise InputError(f"{shown(a)} is an end of the curve; give a point between its ends.")
        return pieces
    b = foot(curve, second)
    if math.dist(a, b) < WELD:
        raise InputError("Both points are the same place of the curve; give two, or one alone.")
    pieces = split(curve, [a, b])
    if _closed(curve):
        return tuple(p for p in pieces if math.dist(p.start, a) >= WELD)
    return tuple(p for p in pieces if not {_is_at(p.start, a, b), _is_at(p.end, a, b)} >= {1, 2})


def _is_at(point: Point, a: Point, b: Point) -> int:
    return 1 if math.dist(point, a) < WELD else 2 if math.dist(point, b) < WELD else 0


def fillet(a: Line | Arc, b: Line | Arc, radius: float, near: tuple[Point, Point]) -> tuple[Line | Arc, Arc, Line | Arc]:
    """Return two curves shortened or lengthened to an arc that touches both, and the arc.

    Args:
        near: where each curve was pointed at; these sides stay, and of all arcs that touch the one nearest to them is taken.
            Places so near the corner that the arc cuts them off stand for their sides of the corner.

    Raises:
        InputError: no arc of this radius touches both on these sides.
    """
    found = _fillets(a, b, radius, near) or _fillets(a, b, radius, _beyond_corner(a, b, near))
    if not found:
        raise InputError(f"No arc of radius {radius:.3f} mm touches both curves here; use a smaller radius, or point at other sides.")
    _, first, arc, second = min(found, key=lambda each: each[0])
    return first, arc, second


def _beyond_corner(a: Line | Arc, b: Line | Arc, near: tuple[Point, Point]) -> tuple[Point, Point]:
    """Return the ends, away from the corner of two curves, of the sides that were pointed at; the places themselves without a corner."""
    corners = meets(a, b, extended=True)
    if not corners:
        return near
    corner = min(corners, key=lambda p: math.dist(p, near[0]) + math.dist(p, near[1]))
    first, second = (_far_end(curve, corner, at) for curve, at in zip((a, b), near, strict=True))
    return first, second


def _far_end(curve: Line | Arc, corner: Point, near: Point) -> Point:
    side: Curve = curve
    if _between(curve, corner):
        side = min(split(curve, [corner]), key=lambda piece: math.dist(foot(piece, near), near))
    return max((side.start, side.end), key=lambda p: math.dist(p, corner))


def _fillets(
    a: Line | Arc, b: Line | Arc, radius: float, near: tuple[Point, Point]
) -> list[tuple[float, Line | Arc, Arc, Line | Arc]]:
    """Return (how far from the places pointed at, first, arc, second) of every fillet on these sides."""
    found = []
    for centre in _centres(a, b, radius):
        touch = _touch(a, centre, radius), _touch(b, centre, radius)
        kept = _shortened(a, touch[0], near[0]), _shortened(b, touch[1], near[1])
        if kept[0] is None or kept[1] is None or math.dist(*touch) < WELD:
            continue
        arc = Arc(touch[0], touch[1], centre, _turns_left(kept[0], touch[0], centre))
        if abs(arc.sweep) < math.pi - _CLOSE and _goes_on(kept[1], arc):
            found.append((math.dist(touch[0], near[0]) + math.dist(touch[1], near[1]), kept[0], arc, kept[1]))
    return found


def chamfer(a: Line, b: Line, sizes: tuple[float, float], near: tuple[Point, Point]) -> tuple[Line, Line, Line]:
    """Return two lines cut back from their corner, and the line across.

    Args:
        sizes: how far the corner is cut back along each, mm. near: where each line was pointed at; these sides stay.

    Raises:
        InputError: the lines are parallel, or shorter than what is cut off.
    """
    corner = meets(a, b, extended=True)
    if not corner:
        raise InputError("Parallel lines have no corner to chamfer; choose lines that meet.")
    ends = [_cut_back(line, corner[0], size, at) for line, size, at in zip((a, b), sizes, near, strict=True)]
    (first, p), (second, q) = ends
    return first, Line(p, q), second


def parallel(curve: Line | Arc | Circle, away: float, side: Point) -> Curve:
    """Return the parallel of a line, arc or circle at a distance, on the side of a point.

    Raises:
        InputError: the inner parallel is none.
    """
    if isinstance(curve, Line):
        return min(_beside(curve, away), key=lambda line: math.dist(_touch(line, side), side))
    outside = math.dist(side, curve.centre) > curve.radius
    radius = curve.radius + (away if outside else -away)
    if radius < WELD:
        raise InputError(f"The radius is {curve.radius:.3f} mm; its inner parallel must be nearer than that.")
    if isinstance(curve, Circle):
        return Circle(curve.centre, radius, curve.ccw)
    (x, y), grown = curve.centre, radius / curve.radius
    start, end = ((x + (p[0] - x) * grown, y + (p[1] - y) * grown) for p in (curve.start, curve.end))
    return Arc(start, end, curve.centre, curve.ccw)


def _cut_back(line: Line, corner: Point, size: float, near: Point) -> tuple[Line, Point]:
    far = max((line.start, line.end), key=lambda p: math.dist(p, corner))
    if _between(line, corner) and math.dist(corner, near) > WELD:
        toward = (near[0] - corner[0], near[1] - corner[1])
        far = max((line.start, line.end), key=lambda p: (p[0] - corner[0]) * toward[0] + (p[1] - corner[1]) * toward[1])
    room = math.dist(corner, far)
    if not WELD <= size < room - WELD:
        raise InputError(f"The chamfer is {size:.3f} mm and the line {room:.3f} mm from its corner; use less.")
    at = (corner[0] + (far[0] - corner[0]) * size / room, corner[1] + (far[1] - corner[1]) * size / room)
    return (Line(at, line.end) if far == line.end else Line(line.start, at)), at


def _closed(curve: Curve) -> bool:
    if isinstance(curve, Ellipse):
        return curve.end_parameter - curve.start_parameter > math.tau - 1e-9
    return isinstance(curve, Circle)


def _met_ahead(curve: Line | Arc, edge: Curve) -> list[Point]:
    """Return where a line or arc without ends meets an edge."""
    if isinstance(edge, Line | Arc | Circle):
        return [p for p in meets(curve, edge, extended=True) if has(edge, p)]
    return meets(_whole(curve), edge)


def _whole(curve: Line | Arc) -> Curve:
    """Return the circle of an arc, or a line so long that it reaches everything drawn."""
    if isinstance(curve, Arc):
        return Circle(curve.centre, curve.radius)
    size = math.dist(curve.start, curve.end)
    ux, uy = (curve.end[0] - curve.start[0]) / size * 1e5, (curve.end[1] - curve.start[1]) / size * 1e5
    return Line((curve.start[0] - ux, curve.start[1] - uy), (curve.end[0] + ux, curve.end[1] + uy))


def _between(curve: Curve, point: Point) -> bool:
    return has(curve, point) and min(math.dist(point, curve.start), math.dist(point, curve.end)) > WELD


def _way_ahead(curve: Line | Arc, point: Point, forward: bool) -> float:
    """Return how far beyond an end a point of the endless line or whole circle lies, along it."""
    end, other = (curve.end, curve.start) if forward else (curve.start, curve.end)
    if isinstance(curve, Line):
        size = math.dist(curve.start, curve.end)
        return ((point[0] - end[0]) * (end[0] - other[0]) + (point[1] - end[1]) * (end[1] - other[1])) / size
    (x, y) = curve.centre
    turn = math.atan2(point[1] - y, point[0] - x) - math.atan2(end[1] - y, end[0] - x)
    return curve.radius * ((turn if forward == (curve.sweep > 0) else -turn) % math.tau)


def _centres(a: Line | Arc, b: Line | Arc, radius: float) -> list[Point]:
    """Return the centres of circles that touch both curves extended: where their parallels at the radius meet."""
    return [p for one in _parallels(a, radius) for other in _parallels(b, radius) for p in meets(one, other, extended=True)]


def _parallels(curve: Line | Arc, away: float) -> list[Curve]:
    if isinstance(curve, Arc):
        return [Circle(curve.centre, r) for r in (curve.radius + away, abs(curve.radius - away)) if r > WELD]
    return list(_beside(curve, away))


def _beside(line: Line, away: float) -> tuple[Line, Line]:
    size = math.dist(line.start, line.end)
    ox, oy = -(line.end[1] - line.start[1]) / size * away, (line.end[0] - line.start[0]) / size * away
    (ax, ay), (bx, by) = line.start, line.end
    return Line((ax + ox, ay + oy), (bx + ox, by + oy)), Line((ax - ox, ay - oy), (bx - ox, by - oy))


def _touch(curve: Line | Arc, centre: Point, radius: float = 0.0) -> Point:
    """Return the point of the endless line or whole circle that is nearest to a centre.

    Of a circle that another of `radius` about the centre holds within itself it is the farthest point: there they touch.
    """
    if isinstance(curve, Arc):
        away = math.dist(centre, curve.centre)
        (x, y), r = curve.centre, curve.radius
        if abs(away + r - radius) < abs(abs(away - r) - radius):
            r = -r
        return (x + (centre[0] - x) / away * r, y + (centre[1] - y) / away * r) if away > 0 else curve.start
    dx, dy = curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]
    along = ((centre[0] - curve.start[0]) * dx + (centre[1] - curve.start[1]) * dy) / (dx * dx + dy * dy)
    return (curve.start[0] + along * dx, curve.start[1] + along * dy)


def _shortened(curve: Line | Arc, at: Point, near: Point) -> Line | Arc | None:
    """Return the part of a curve, extended, that ends at a point and holds the place pointed at; None where nothing would stay."""
    place = _touch(curve, near)
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
    keeps_end = _way_ahead(curve, at, False) if not has(curve, at) else 0.0
    if has(curve, at):
        kept = min(split(curve, [at]), key=lambda p: math.dist(foot(p, near), near), default=None)
        return kept if isinstance(kept, Arc) else None
    to_end = _way_ahead(curve, at, True)
    start, end = (at, curve.end) if keeps_end < to_end else (curve.start, at)
    return Arc(start, end, curve.centre, curve.ccw) if math.dist(start, end) > WELD else None


def _heading(curve: Line | Arc, at: Point) -> complex:
    """Return the direction of a curve at one of its ends, going away from the rest of the curve."""
    outward = 1 if math.dist(at, curve.end) < math.dist(at, curve.start) else -1
    if isinstance(curve, Line):
        return complex(curve.end[0] - curve.start[0], curve.end[1] - curve.start[1]) * outward
    spoke = complex(at[0] - curve.centre[0], at[1] - curve.centre[1])
    return spoke * (1j if curve.sweep > 0 else -1j) * outward


def _turns_left(kept: Line | Arc, at: Point, centre: Point) -> bool:
    way, spoke = _heading(kept, at), complex(centre[0] - at[0], centre[1] - at[1])
    return (way.conjugate() * spoke).imag > 0


def _goes_on(kept: Line | Arc, arc: Arc) -> bool:
    """Return whether an arc runs on into a curve at its end without turning back."""
    spoke = complex(arc.end[0] - arc.centre[0], arc.end[1] - arc.centre[1])
    way = spoke * (1j if arc.sweep > 0 else -1j)
    return (way.conjugate() * -_heading(kept, arc.end)).real > 0
