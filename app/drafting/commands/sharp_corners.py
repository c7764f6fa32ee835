"""Corners of a parallel made sharp: the curves on both sides go on until they meet, where that runs into nothing
else.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.tolerances import WELD
from ...model.curves import Arc, Curve, Line, Point
from ..curves.intersections import intersection_points
from ..curves.shapes import middle_of
from .offset_piece import OffsetPiece, direction

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
