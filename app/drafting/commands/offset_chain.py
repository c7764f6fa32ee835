"""The parallel of a whole chain of curves: corners joined, arcs stay arcs, and what would come too near is cut out.

Every line and arc is moved aside, and every corner that opens is bridged by an arc about it. All these are cut where
they meet, and a piece stays where nothing of the chain is nearer than the distance; at last corners are made sharp
where there is room.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import chain as flattened
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.tolerances import RIDGE, WELD
from ...geometry.sample import bounds
from ...model.curves import Arc, Circle, Curve, Line, Point, reversed_curve
from ...model.part import Contour
from ..curves.chains import CurveChain, chained
from ..curves.intersections import intersection_points, nearest_point
from ..curves.shapes import curve_length, middle_of
from .explode import simple
from .offset_piece import OffsetPiece, direction
from .split import split

_NEAR = WELD / 100
"""By so much, mm, a piece may come nearer than the distance: more than a foot is off by rounding a kilometre from zero.
Less than WELD, as what goes on beyond the place where two parallels cross comes nearer by no more than its length times
their bend.
"""

_SLIGHT = 2e-3
"""A turn, rad, so slight that what two parallels overlap there could not be told from what stays."""

_BACK = 1e-9
"""A turn, rad, that is less than a half turn by less goes straight back; a length cannot say that, as both sides may be
long.
"""


class ParallelPiece(NamedTuple):
    """A piece of a parallel, and the number of the curve that it goes along."""

    along: int
    curve: Line | Arc


def chain_parallel(contour: CurveChain, away: float, side: Point, rounded: bool = False) -> list[ParallelPiece]:
    """Return the parallel of a chain at a distance, on the side of a point; empty where nothing is that far from it.

    Args:
        contour: ellipses and splines are followed within 1 µm.
        away: mm, > 0.
        side: decides by the place of the chain nearest to it.
        rounded: corners that open stay arcs; else their sides go on until they meet, up to five times the distance.

    Returns:
        Pieces in the chain's direction.
    """
    pieces = _pieces(contour)
    if not pieces:
        return []
    left = _is_left(pieces, contour.closed, side)
    pieces = pieces if left else _turned(pieces)
    found = _kept(pieces, contour.closed, away)
    groups = [
        [found[number] for number in each.numbers]
        for each in chained(dict(enumerate(m.curve for m in found)))
        if not _thin(each)
    ]
    made = (
        list(flattened.from_iterable(groups))
        if rounded
        else sharpened(groups, away, lambda a, b: _near(_boxes(a), _boxes(b)))
    )
    return [ParallelPiece(m.source, m.curve) for m in (made if left else _turned(made))]


def _pieces(contour: CurveChain) -> list[OffsetPiece]:
    """Return a chain as lines and arcs that meet exactly."""
    found = list[OffsetPiece]()
    for number, curve in zip(contour.numbers, contour.curves, strict=True):
        for piece in simple(curve):
            if not isinstance(piece, Circle) and (
                made := _between(piece, found[-1].curve.end if found else piece.start, piece.end)
            ):
                found.append(OffsetPiece(made, number))
    if contour.closed and found and (made := _between(found[-1].curve, found[-1].curve.start, found[0].curve.start)):
        found[-1] = OffsetPiece(made, found[-1].source)
    return found


def _between(piece: Line | Arc, start: Point, end: Point) -> Line | Arc | None:
    """Return a line or arc from and to points that lie within WELD of its ends; None where it is shorter than that."""
    from ...geometry.arcs.arcs import equally_far  # not when the window opens
    from ...geometry.chaining.pieces import straightened  # not when the window opens

    if math.dist(start, end) <= WELD:
        return None
    if isinstance(piece, Line):
        return Line(start, end)
    made = straightened(Arc(start, end, equally_far(start, end, piece.centre), piece.ccw))
    return made if isinstance(made, Line | Arc) else None


def _turned(pieces: Sequence[OffsetPiece]) -> list[OffsetPiece]:
    back = [(reversed_curve(m.curve), m) for m in reversed(pieces)]
    return [OffsetPiece(curve, m.source, m.corner) for curve, m in back if isinstance(curve, Line | Arc)]


def _is_left(pieces: Sequence[OffsetPiece], closed: bool, side: Point) -> bool:
    """Return whether a point lies left of a chain, as seen from the place nearest to it."""
    feet = [nearest_point(m.curve, side) for m in pieces]
    best = min(range(len(feet)), key=lambda k: math.dist(feet[k], side))
    at, curve = feet[best], pieces[best].curve
    way = direction(curve, at)
    for end, other in ((curve.start, best - 1), (curve.end, best + 1)):
        if math.dist(at, end) <= WELD and (closed or 0 <= other < len(pieces)):
            way += direction(pieces[other % len(pieces)].curve, end)
    return (way.conjugate() * complex(side[0] - at[0], side[1] - at[1])).imag >= 0


def _kept(pieces: Sequence[OffsetPiece], closed: bool, away: float) -> list[OffsetPiece]:
    """Return what of the parallels to the left keeps the distance from all of a chain."""
    raw = _raw(pieces, closed, away)
    edges: list[Curve] = [m.curve for m in (*raw, *_raw(_turned(pieces), closed, away))]
    if not closed:
        edges += [Circle(pieces[0].curve.start, away), Circle(pieces[-1].curve.end, away)]
    cuts: dict[int, list[Point]] = {}
    known: dict[tuple[int, int], list[Point]] = {}
    for i, j in _near(_boxes(m.curve for m in raw), _boxes(edges)):
        if i != j:
            pair = (i, j) if i < j else (j, i)
            if pair not in known:
                known[pair] = intersection_points(edges[pair[0]], edges[pair[1]])
            cuts.setdefault(i, []).extend(known[pair] or _ends_on(raw[i].curve, edges[j]))
    parts = [(m, piece) for k, m in enumerate(raw) for piece in split(m.curve, cuts.get(k, ()))]
    middles = np.array([middle_of(piece) for _, piece in parts]).reshape(-1, 2)
    around = np.hstack([middles - away, middles + away])
    gone = set[int]()
    for k, source in _near(around, _boxes(m.curve for m in pieces)):
        middle = (float(middles[k, 0]), float(middles[k, 1]))
        if k not in gone and math.dist(nearest_point(pieces[source].curve, middle), middle) < away - _NEAR:
            gone.add(k)
    return [
        OffsetPiece(piece, m.source, m.corner if piece == m.curve else None)
        for k, (m, piece) in enumerate(parts)
        if k not in gone and isinstance(piece, Line | Arc)
    ]


def _raw(pieces: Sequence[OffsetPiece], closed: bool, away: float) -> list[OffsetPiece]:
    """Return the parallels to the left of lines and arcs, and arcs about the corners that open there."""
    moved = [_aside(m.curve, away) for m in pieces]
    corners = list[OffsetPiece]()
    for k, (a, b) in enumerate(pairwise([*pieces, pieces[0]] if closed else pieces)):
        following = (k + 1) % len(pieces)
        one, other = moved[k], moved[following]
        before, after = direction(a.curve, a.curve.end), direction(b.curve, b.curve.start)
        turn = math.atan2((before.conjugate() * after).imag, (before.conjugate() * after).real)
        start, end = _beside(a.curve.end, before, away), _beside(b.curve.start, after, away)
        if (turn < 0 or abs(turn) > math.pi - _BACK) and math.dist(start, end) > WELD:
            corners.append(OffsetPiece(Arc(start, end, a.curve.end, ccw=False), a.source, a.curve.end))
            continue
        if one is None or other is None or k == following or turn > _SLIGHT:
            continue
        to = min([*intersection_points(one, other, extended=True), end], key=lambda p: math.dist(p, end))
        moved[k], moved[following] = _between(one, one.start, to), _between(other, to, other.end)
    return [
        *(OffsetPiece(curve, m.source) for curve, m in zip(moved, pieces, strict=True) if curve is not None),
        *corners,
    ]


def _aside(curve: Line | Arc, away: float) -> Line | Arc | None:
    """Return a line or arc moved to its left; None for an arc that is as narrow as that."""
    start, end = (
        _beside(curve.start, direction(curve, curve.start), away),
        _beside(curve.end, direction(curve, curve.end), away),
    )
    if isinstance(curve, Line):
        return Line(start, end)
    inside = curve.ccw and curve.radius <= away + WELD
    return None if inside or math.dist(start, end) <= WELD else Arc(start, end, curve.centre, curve.ccw)


def _beside(point: Point, way: complex, away: float) -> Point:
    return (point[0] - way.imag * away, point[1] + way.real * away)


def _ends_on(curve: Curve, edge: Curve) -> list[Point]:
    """Return the ends of an edge that lie on a curve: of two that run along one another these are where to cut."""
    return [
        p
        for p in (edge.start, edge.end)
        if not isinstance(edge, Circle) and math.dist(nearest_point(curve, p), p) < WELD
    ]


def _boxes(curves: Iterable[Curve]) -> NDArray[np.float64]:
    return np.array([bounds(curve) for curve in curves]).reshape(-1, 4)


def _near(boxes: NDArray[np.float64], others: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Return the pairs of boxes, one of each list, that meet."""
    import shapely  # not when the window opens

    tree = shapely.STRtree(shapely.box(*others.T))
    pairs = tree.query(shapely.box(*(boxes + [-WELD, -WELD, WELD, WELD]).T))
    return [(int(i), int(j)) for i, j in pairs.T]


def _thin(each: CurveChain) -> bool:
    """Return whether a chain is a loop without width: walls as far apart as twice the distance leave such."""
    from ...geometry.primitives import contour_rows, signed_area

    length = sum(map(curve_length, each.curves))
    if not each.closed:
        return length <= 10 * WELD
    return abs(signed_area(contour_rows(Contour(each.curves)))) <= RIDGE * length / 2  # type: ignore[arg-type]


_FARTHEST = 5.0
"""How many distances the tip of a corner may lie from the corner that it goes round."""

Near = Callable[[Sequence[Curve], Sequence[Curve]], list[tuple[int, int]]]


@dataclass(frozen=True, slots=True)
class _Tip:
    """Where the neighbours of an arc about a corner meet.

    Attributes:
        before, arc, after: places of the three in the list of all.
        ways: what is added to the neighbours up to the tip.
    """

    before: int
    arc: int
    after: int
    at: Point
    ways: tuple[Line | Arc, Line | Arc]


def sharpened(groups: Sequence[Sequence[OffsetPiece]], away: float, near: Near) -> list[OffsetPiece]:
    """Return the pieces of a parallel with sharp corners in place of arcs that go round corners, where there is room
    for them.

    Args:
        groups: chains of pieces in the direction of travel.
        away: the distance of the parallel, mm.
        near: gives the pairs of curves, one of each list, whose boxes meet.
    """
    pieces, tips, first = list[OffsetPiece](), list[_Tip](), 0
    for group in groups:
        pieces += group
        closed = math.dist(group[0].curve.start, group[-1].curve.end) <= WELD
        for k in range(len(group)) if closed else range(1, len(group) - 1):
            before, after = first + (k - 1) % len(group), first + (k + 1) % len(group)
            if group[k].corner is not None and len({before, first + k, after}) == 3:
                tips += _tip(pieces, (before, first + k, after), away)
        first += len(group)
    gone = set[int]()
    for tip in _free(tips, [m.curve for m in pieces], near):
        one, other = pieces[tip.before], pieces[tip.after]
        pieces[tip.before] = replace(one, curve=replace(one.curve, end=tip.at))
        pieces[tip.after] = replace(other, curve=replace(other.curve, start=tip.at))
        gone.add(tip.arc)
    return [m for k, m in enumerate(pieces) if k not in gone]


def _tip(pieces: Sequence[OffsetPiece], places: tuple[int, int, int], away: float) -> list[_Tip]:
    """Return the tip in place of an arc, if there is one."""
    (a, arc, b) = (pieces[place] for place in places)
    if a.corner is not None or b.corner is not None or arc.corner is None:
        return []
    middle = middle_of(arc.curve)
    for at in sorted(intersection_points(a.curve, b.curve, extended=True), key=lambda p: math.dist(p, middle)):
        if (
            math.dist(at, arc.corner) > _FARTHEST * away
            or min(math.dist(at, a.curve.end), math.dist(at, b.curve.start)) <= WELD
        ):
            continue
        ways = _onward(a.curve, a.curve.end, at, forward=True), _onward(b.curve, b.curve.start, at, forward=False)
        if ways[0] is not None and ways[1] is not None:
            return [_Tip(*places, at, (ways[0], ways[1]))]
    return []


def _onward(curve: Line | Arc, end: Point, at: Point, forward: bool) -> Line | Arc | None:
    """Return what leads from an end of a curve on to a point of the endless line or whole circle; None where it lies
    behind.
    """
    way = direction(curve, end) * (1 if forward else -1)
    if (way.conjugate() * complex(at[0] - end[0], at[1] - end[1])).real <= 0:
        return None
    start, to = (end, at) if forward else (at, end)
    if isinstance(curve, Line):
        return Line(start, to)
    made = Arc(start, to, curve.centre, curve.ccw)
    return made if abs(made.sweep) < math.pi / 2 and abs(made.sweep + curve.sweep) < math.tau - 1e-6 else None


def _free(tips: Sequence[_Tip], curves: Sequence[Curve], near: Near) -> list[_Tip]:
    """Return the tips that run into nothing: neither into other pieces nor into other tips."""
    ways = [way for tip in tips for way in tip.ways]
    blocked: NDArray[np.bool_] = np.zeros(len(tips), dtype=bool)
    if not tips:
        return []
    for i, j in near(ways, curves):
        tip = tips[i // 2]
        if (
            not blocked[i // 2]
            and j not in (tip.before, tip.arc, tip.after)
            and intersection_points(ways[i], curves[j])
        ):
            blocked[i // 2] = True
    for i, j in near(ways, ways):
        if i // 2 < j // 2 and not (blocked[i // 2] and blocked[j // 2]) and intersection_points(ways[i], ways[j]):
            blocked[[i // 2, j // 2]] = True
    return [tip for tip, shut in zip(tips, blocked, strict=True) if not shut]
