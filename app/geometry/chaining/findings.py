"""Sentences about what chaining removed, joined, or left open."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.curves import Circle, Line, Point, Primitive
from ...model.finding import Finding, FindingKind
from ...model.job import LARGEST_JOIN
from ...model.part import Contour
from ..primitives import boxes, contour_rows
from .pieces import ChainPiece, Overlap, length_of

LIMIT = 20
"""So many places of one kind are named one by one; the rest is counted."""


def at(point: Point) -> str:
    """Return a place as text, mm."""
    return f"({point[0]:.3f}, {point[1]:.3f})".replace("-0.000", "0.000")


def size_of(contour: Contour) -> str:
    """Return how wide and high a contour is, as text, mm."""
    (x0, y0), (x1, y1) = _corners(contour)
    return f"{_tidy(x1 - x0)} x {_tidy(y1 - y0)} mm"


def named(contour: Contour) -> str:
    """Return what a contour is called: by its layer, its size and its lower left corner, for these are what a CAD
    program shows.
    """
    return f"The contour on layer {contour.layer}, {size_of(contour)} from {at(_corners(contour)[0])},"


def _corners(contour: Contour) -> tuple[Point, Point]:
    around = boxes(contour_rows(contour))
    (x0, y0), (x1, y1) = around[:, :2].min(axis=0).tolist(), around[:, 2:].max(axis=0).tolist()
    return (x0, y0), (x1, y1)


def _tidy(length: float) -> str:
    return f"{length:.3f}".rstrip("0").rstrip(".")


def limited(findings: Sequence[Finding], what: str) -> list[Finding]:
    """Return the first findings of a kind and one more that counts the rest."""
    rest = findings[LIMIT:]
    if not rest:
        return list(findings)
    ids = tuple(dict.fromkeys(k for finding in rest for k in finding.entity_ids))
    more = Finding(
        rest[0].kind,
        f"{len(rest)} more {what}.",
        rest[0].x,
        rest[0].y,
        any(f.counts for f in rest),
        ids,
        float(len(rest)),
    )
    return [*findings[:LIMIT], more]


def _lower(name: str) -> str:
    return name[0].lower() + name[1:].rstrip(",")


def _noun(primitive: Primitive) -> str:
    return "line" if isinstance(primitive, Line) else "circle" if isinstance(primitive, Circle) else "arc"


def _names(a: ChainPiece, b: ChainPiece) -> str:
    one, other = _noun(a.primitives[0]), _noun(b.primitives[0])
    if one == other:
        return f"{one.capitalize()}s {a.entity} and {b.entity}"
    return f"{one.capitalize()} {a.entity} and {other} {b.entity}"


@dataclass(frozen=True, slots=True)
class SharedPiece:
    """An overlap and the pieces that it joins."""

    first: ChainPiece
    second: ChainPiece
    overlap: Overlap


def overlap_findings(
    shared: Iterable[SharedPiece], contours: Sequence[Contour], join_tolerance: float
) -> list[Finding]:
    """Return a finding for each overlap; one that was removed, joined, or is the wall of two outlines is a remark."""
    place = {entity: k for k, contour in enumerate(contours) for entity in contour.entity_ids}
    found = []
    for each in shared:
        a, b, overlap = each.first, each.second, each.overlap
        middle = ((overlap.start[0] + overlap.end[0]) / 2, (overlap.start[1] + overlap.end[1]) / 2)
        one, other = place.get(a.entity), place.get(b.entity)
        counts = False
        if overlap.removed:
            what = f"; {_noun(b.primitives[0])} {b.entity} adds nothing and is left out."
        elif overlap.trimmed:
            what = "; one was cut to where the other ends."
        elif one is None or other is None:
            continue
        elif one != other and contours[one].closed and contours[other].closed:
            what = f"; {_lower(named(contours[one]))} and {_lower(named(contours[other]))} share this stretch."
        elif overlap.length <= join_tolerance + tolerances.WELD:
            what = "; their ends were joined."
        else:
            length = rounded_up(overlap.length)
            joined = f", or join with a tolerance of {length} mm if that is small enough for the part"
            what = f"; trim one{joined * (float(length) <= LARGEST_JOIN)}."
            counts = True
        text = f"{_names(a, b)} overlap by {overlap.length:.3f} mm from {at(overlap.start)} to {at(overlap.end)}{what}"
        found.append(Finding(FindingKind.OVERLAP, text, *middle, counts, (a.entity, b.entity), overlap.length))
    return limited(found, "overlapping curves")


def repeat_findings(doubles: Sequence[tuple[Contour, Contour]]) -> list[Finding]:
    """Return a remark for each closed contour that was drawn twice, (kept, removed)."""
    found = []
    for _, double in doubles:
        x, y = double.primitives[0].start
        length = sum(length_of(p) for p in double.primitives)
        found.append(
            Finding(
                FindingKind.OVERLAP,
                f"The contour at {at((x, y))}, {length:.3f} mm long, is drawn twice; one is left out.",
                x,
                y,
                False,
                double.entity_ids,
                length,
            )
        )
    return limited(found, "contours that are drawn twice")


class ClosedGap(NamedTuple):
    """A gap that was closed: its width, mm, and where."""

    width: float
    place: Point


def gap_findings(gaps: Sequence[ClosedGap]) -> list[Finding]:
    """Return one remark on all gaps that were closed."""
    if not gaps:
        return []
    widest, place = max(gaps)
    count = "1 gap was" if len(gaps) == 1 else f"{len(gaps)} gaps were"
    return [
        Finding(
            FindingKind.GAP_CLOSED,
            f"{count} closed; the widest, {widest:.4f} mm, is at {at(place)}.",
            *place,
            False,
            (),
            widest,
        )
    ]


def junction_findings(branches: Sequence[Junction]) -> list[Finding]:
    """Return a finding for each point where an odd number of ends meet; where an even number does, outlines only
    touch.
    """
    found = []
    for branch in branches:
        if branch.odd:
            ends, ids = len(branch.entity_ids), tuple(dict.fromkeys(branch.entity_ids))
            text = f"{ends} ends meet at {at(branch.place)}; one of them belongs to no outline: delete or complete it."
            found.append(Finding(FindingKind.SELF_INTERSECTION, text, *branch.place, True, ids, float(ends)))
    return limited(found, "points where one end too many meets others")


def rounded_up(gap: float) -> str:
    """Return the next of 1, 2, 5 times a power of ten above the gap, as text."""
    scale = 10.0 ** math.floor(math.log10(max(gap, tolerances.WELD)))
    return f"{next((m * scale for m in (1, 2, 5) if m * scale >= gap - tolerances.WELD), 10 * scale):g}"


# Walk from curve to curve: which end goes on where, also at points where three or more meet.


Nodes = NDArray[np.int64]


class Step(NamedTuple):
    """A piece by its number, and whether it is travelled forward."""

    piece: int
    forward: bool


class PiecePath(NamedTuple):
    """Pieces one after the other, and whether they close."""

    steps: list[Step]
    closed: bool


class TracedPaths(NamedTuple):
    """Every path, by its first piece, and every point where more than two ends meet."""

    paths: list[PiecePath]
    branches: list[Junction]


@dataclass(frozen=True)
class Junction:
    """A point where more than two ends meet.

    Attributes:
        place: where, mm.
        entity_ids: the curves whose ends meet there, one for each end.
    """

    place: Point
    entity_ids: tuple[int, ...]

    @property
    def odd(self) -> bool:
        """Whether one end is left over when outlines pass through."""
        return len(self.entity_ids) % 2 == 1


def paths(pieces: Sequence[ChainPiece], nodes: Nodes) -> TracedPaths:
    """Return how the pieces go on in one another.

    End 2 k is the start of piece k and end 2 k + 1 its end.
    """
    at: dict[int, list[int]] = {}
    for end, node in enumerate(nodes.ravel().tolist()):
        if node >= 0:
            at.setdefault(node, []).append(end)
    partner: dict[int, int] = {}
    crowded = [ends for ends in at.values() if len(ends) > 2]
    spurs = _bridges(at) if crowded else set()
    for ends in at.values():
        couples = [(ends[0], ends[1])] if len(ends) == 2 else _couples(ends, pieces, spurs)
        for a, b in couples:
            partner[a], partner[b] = b, a
    found = [PiecePath([Step(k, True)], True) for k, piece in enumerate(pieces) if piece.is_circle]
    found += _walks(len(pieces), partner, {k for k, piece in enumerate(pieces) if piece.is_circle})
    return TracedPaths(sorted(found, key=lambda path: min(path.steps)), [_branch(pieces, ends) for ends in crowded])


def _branch(pieces: Sequence[ChainPiece], ends: Sequence[int]) -> Junction:
    first = pieces[ends[0] // 2]
    return Junction(first.start if ends[0] % 2 == 0 else first.end, tuple(pieces[end // 2].entity for end in ends))


def _walks(count: int, partner: dict[int, int], done: set[int]) -> list[PiecePath]:
    """Follow partners: first from ends that have none, then round the loops that are left."""
    found = []
    seen = set(done)
    loose = [end for end in range(2 * count) if end not in partner]
    for first in [*loose, *range(0, 2 * count, 2)]:
        if first // 2 in seen:
            continue
        steps: list[Step] = []
        end = first
        while end // 2 not in seen:
            seen.add(end // 2)
            steps.append(Step(end // 2, end % 2 == 0))
            if (end ^ 1) not in partner:
                break
            end = partner[end ^ 1]
        closed = first in partner
        found.append(PiecePath(steps if closed else _forward(steps), closed))
    return found


def _forward(steps: list[Step]) -> list[Step]:
    """Return an open path in the direction of the piece that was drawn first."""
    return steps if min(steps).forward else [Step(k, not forward) for k, forward in reversed(steps)]


class _CoupleCost(NamedTuple):
    """What speaks against two ends going on in one another, the weightiest first; and the ends."""

    spurs: int
    apart: int
    turn: float
    a: int
    b: int


def _couples(ends: list[int], pieces: Sequence[ChainPiece], spurs: set[int]) -> list[tuple[int, int]]:
    """Pair the ends that meet at one point.

    Curves that belong to a loop come before those that belong to none. Where an even number meets, a curve stays with
    the one that was drawn next from its end on (two outlines that touch stay two); else the smallest turn wins.
    """
    directions = {end: _away(pieces[end // 2], end % 2 == 0) for end in ends}

    def cost(a: int, b: int) -> _CoupleCost:
        (ax, ay), (bx, by) = directions[a], directions[b]
        turn = math.pi - abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
        apart = int(len(ends) % 2 == 1 or a % 2 == 0 or b != a + 1)
        return _CoupleCost((a // 2 in spurs) + (b // 2 in spurs), apart, round(turn, 9), a, b)

    couples = []
    free = set(ends)
    for *_, a, b in sorted(cost(a, b) for a in ends for b in ends if a < b):
        if a in free and b in free:
            couples.append((a, b))
            free -= {a, b}
    return couples


def _away(piece: ChainPiece, from_start: bool) -> Point:
    """Return the direction (of any length) in which a piece leaves one of its ends."""
    if from_start:
        return tangent(piece.primitives[0], True)
    x, y = tangent(piece.primitives[-1], False)
    return -x, -y


def tangent(primitive: Primitive, at_start: bool) -> Point:
    """Return the direction of travel (of any length) at the start or the end of a primitive."""
    if isinstance(primitive, Line):
        return primitive.end[0] - primitive.start[0], primitive.end[1] - primitive.start[1]
    x, y = primitive.start if at_start or isinstance(primitive, Circle) else primitive.end
    x, y = x - primitive.centre[0], y - primitive.centre[1]
    return (-y, x) if primitive.ccw else (y, -x)


def _bridges(at: dict[int, list[int]]) -> set[int]:
    """Return the pieces that lie on no loop: Tarjan (1974), "A note on finding the bridges of a graph", without
    recursion.
    """
    node_of = {end: node for node, ends in at.items() for end in ends}
    order: dict[int, int] = {}
    low: dict[int, int] = {}
    bridges: set[int] = set()
    for root in at:
        if root in order:
            continue
        order[root] = low[root] = len(order)
        stack = [(root, -1, iter(at[root]))]
        while stack:
            node, came, ends = stack[-1]
            end = next(ends, None)
            if end is None:
                stack.pop()
                if stack:
                    parent = stack[-1][0]
                    low[parent] = min(low[parent], low[node])
                    if low[node] > order[parent]:
                        bridges.add(came)
            elif end // 2 != came:
                other = node_of[end ^ 1]
                if other in order:
                    low[node] = min(low[node], order[other])
                else:
                    order[other] = low[other] = len(order)
                    stack.append((other, end // 2, iter(at[other])))
    return bridges
