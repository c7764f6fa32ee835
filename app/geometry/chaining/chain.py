"""Chain loose curves, in any order and direction, into contours; say where they do not meet, overlap or cross."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.curves import Arc, Point
from ...model.finding import Finding, FindingKind
from ...model.part import Contour, Entity
from ..arcs.arcs import equally_far
from ..primitives import CX, TURN, X1, R, Rows, distances, rows_of_each
from .findings import (
    LIMIT,
    SharedPiece,
    at,
    gap_findings,
    junction_findings,
    limited,
    named,
    open_findings,
    overlap_findings,
    repeat_findings,
)
from .join import Nodes, join_ends, nodes_of, reach_of
from .pieces import (
    ChainPiece,
    Overlap,
    covered,
    near_pairs,
    off_circle,
    pieces_from,
    repeated,
    shared_stretches,
    twin_contours,
)
from .trace import PiecePath, paths


@dataclass(frozen=True, slots=True)
class ChainingResult:
    """What a drawing's curves chain into.

    Attributes:
        contours: closed and open ones, by their first curve; not turned to any orientation.
        findings: what was removed, joined, left open, or crosses.
    """

    contours: tuple[Contour, ...] = ()
    findings: tuple[Finding, ...] = ()


def chain(entities: Sequence[Entity], join_tolerance: float = tolerances.JOIN) -> ChainingResult:
    """Return the contours that some curves form.

    Ellipses and splines become lines and arcs within 1 um. Curves drawn twice, and curves that lie wholly on another,
    are removed unless an outline needs them; drawn twice means within the join tolerance all along, of which at most
    the default counts here. Ends nearer than the join tolerance are moved to meet exactly; arcs stay
    true arcs. Where three or more ends meet, loops are closed first, then the smallest turn wins.

    Args:
        entities: curves in any order and direction.
        join_tolerance: loose ends within this distance are joined, mm, >= 0.

    Returns:
        Closed contours end exactly where they begin, and every primitive begins exactly where the one before ends.
        Overlaps that are longer than the tolerance are left as they are and reported, but for arcs of one circle whose
        loose ends lie on one another: these are cut to meet.
    """
    drawn = pieces_from(entities)
    nodes = nodes_of(drawn.pieces, join_tolerance)
    thinned = _thinned(drawn.pieces, nodes, join_tolerance)
    pieces, nodes, gaps = join_ends(thinned.pieces, thinned.nodes)
    found, branches = paths(pieces, nodes)
    contours, doubles = _once([_contour(pieces, path) for path in found], join_tolerance)
    odd = [branch.place for branch in branches if branch.odd]
    findings = [
        *drawn.findings,
        *overlap_findings(thinned.overlaps, contours, join_tolerance),
        *repeat_findings(doubles),
        *gap_findings(gaps),
        *junction_findings(branches),
        *open_findings(contours, join_tolerance),
        *crossings(contours, odd),
    ]
    return ChainingResult(tuple(contours), tuple(findings))


class _PiecesWithNodes(NamedTuple):
    """Pieces, and (n, 2) the points where they begin and end."""

    pieces: list[ChainPiece]
    nodes: Nodes


class _ThinnedPieces(NamedTuple):
    """Pieces without those that only repeat others, their nodes, and all overlaps that were found on the way."""

    pieces: list[ChainPiece]
    nodes: Nodes
    overlaps: list[SharedPiece]


class _SingleContours(NamedTuple):
    """Contours, and pairs of one that was kept and one that repeated it."""

    contours: list[Contour]
    doubles: list[tuple[Contour, Contour]]


def _thinned(pieces: list[ChainPiece], nodes: Nodes, join_tolerance: float) -> _ThinnedPieces:
    """Return what is left without curves that only repeat others."""
    reach = min(tolerances.CURVE, max(join_tolerance, tolerances.WELD))
    repeats = repeated(pieces, nodes, reach_of(join_tolerance))
    shared = [SharedPiece(pieces[o.first], pieces[o.second], o) for o in repeats]
    known = {(s.first.entity, s.second.entity) for s in shared}
    pieces, nodes = _without(pieces, nodes, repeats)
    stretches = shared_stretches(pieces, reach)
    new = [o for o in stretches if (pieces[o.first].entity, pieces[o.second].entity) not in known]
    overlaps = covered(pieces, nodes, new, reach)
    drawn = pieces
    pieces, nodes, overlaps = trimmed(pieces, nodes, overlaps)
    shared += [SharedPiece(drawn[o.first], drawn[o.second], o) for o in overlaps]
    return _ThinnedPieces(*_without(pieces, nodes, overlaps), shared)


def _without(pieces: list[ChainPiece], nodes: Nodes, overlaps: Sequence[Overlap]) -> _PiecesWithNodes:
    gone = {overlap.second for overlap in overlaps if overlap.removed}
    kept = [k for k in range(len(pieces)) if k not in gone]
    return _PiecesWithNodes([pieces[k] for k in kept], nodes[kept] if len(nodes) else nodes)


def _contour(pieces: Sequence[ChainPiece], path: PiecePath) -> Contour:
    members = [pieces[k] if forward else pieces[k].reversed() for k, forward in path.steps]
    return Contour(
        tuple(p for piece in members for p in piece.primitives),
        path.closed,
        pieces[min(path.steps).piece].layer,
        tuple(piece.entity for piece in members),
        max(piece.deviation for piece in members),
    )


def _once(contours: list[Contour], join_tolerance: float) -> _SingleContours:
    """Return the contours without closed ones that repeat another."""
    twins = twin_contours(contours, max(reach_of(join_tolerance), tolerances.CURVE))
    kept = [c for k, c in enumerate(contours) if k not in twins]
    return _SingleContours(kept, [(contours[j], contours[k]) for k, j in twins.items()])


# Two arcs of one circle whose loose ends run past one another: one is trimmed to where the other ends.


class TrimmedPieces(NamedTuple):
    """Pieces, their nodes, and the overlaps between them."""

    pieces: list[ChainPiece]
    nodes: Nodes
    overlaps: list[Overlap]


def trimmed(pieces: Sequence[ChainPiece], nodes: Nodes, overlaps: Sequence[Overlap]) -> TrimmedPieces:
    """Return pieces and nodes with arcs that overlap at loose ends cut to meet there, and the overlaps with that noted.

    The shape stays as it was drawn, so that no tolerance is asked: each of both ends lies on the other arc, within
    1 um, and no other curve ends there.
    """
    made, joined, noted = list(pieces), nodes.copy(), []
    gone = {overlap.second for overlap in overlaps if overlap.removed}
    kept = np.array([k not in gone for k in range(len(pieces))], dtype=bool)
    for overlap in overlaps:
        done = False
        if not {overlap.first, overlap.second} & gone:
            for pair in ((overlap.first, overlap.second), (overlap.second, overlap.first)):
                done |= _cut(made, joined, pair, kept)
        noted.append(replace(overlap, trimmed=done))
    return TrimmedPieces(made, joined, noted)


def _cut(pieces: list[ChainPiece], nodes: Nodes, pair: tuple[int, int], kept: NDArray[np.bool_]) -> bool:
    """Let the second arc begin where the first one ends, both seen counter-clockwise, in place; False if they do not
    overlap so.
    """
    one, other = (pieces[k].primitives[0] for k in pair)
    if any(len(pieces[k].primitives) > 1 for k in pair) or not isinstance(one, Arc) or not isinstance(other, Arc):
        return False
    end_side, start_side = int(one.ccw), int(not other.ccw)
    last, first = nodes[pair[0], end_side], nodes[pair[1], start_side]
    alive = nodes[kept]
    if last == first or (alive == last).sum() != 1 or (alive == first).sum() != 1:
        return False
    place, begin = (one.end if one.ccw else one.start), (other.start if other.ccw else other.end)
    shared = (_angle(place, other.centre) - _angle(begin, other.centre)) % math.tau
    if shared >= abs(one.sweep) or shared >= abs(other.sweep):
        return False
    rest = other.end if other.ccw else other.start
    centre = equally_far(place, rest, other.centre)
    short = Arc(place, rest, centre, True) if other.ccw else Arc(rest, place, centre, False)
    if (
        math.dist(centre, other.centre) > tolerances.CURVE + other.radius * 1e-9
        or off_circle(short, other) > 2 * tolerances.CURVE
    ):
        return False
    pieces[pair[1]] = replace(
        pieces[pair[1]], primitives=(short,), deviation=pieces[pair[1]].deviation + off_circle(short, other)
    )
    nodes[pair[1], start_side] = last
    return True


def _angle(point: Point, centre: Point) -> float:
    return math.atan2(point[1] - centre[1], point[0] - centre[0])


# Where contours cross or touch themselves and one another: closed forms on pairs whose boxes meet.


Floats = NDArray[np.float64]

Indices = NDArray[np.int64]

_PARALLEL = tolerances.WELD / 4
"""mm; lines that part by less all along, and circles whose centres do, cross nowhere that could be told."""

_NAMED = 3
"""So many places of one pair of contours are named in its sentence."""


@dataclass(frozen=True)
class _Table:
    """All rows of some contours.

    Attributes:
        contour: (n,) index of the contour of each row.
        before, after: (n,) neighbouring rows in the contour, -1 at an open end.
    """

    rows: Rows
    contour: Indices
    before: Indices
    after: Indices


def crossings(contours: Sequence[Contour], branches: Sequence[Point] = ()) -> list[Finding]:
    """Return a finding for each pair of contours, or contour with itself, that cross (counts) or touch (a remark).

    Args:
        contours: closed and open ones.
        branches: points of which it has been said that too many ends meet there; what only touches there is passed
            over.
    """
    table = _table(contours)
    i, j = near_pairs(table.rows, tolerances.WELD)
    points, i, j = contacts(table.rows, i, j)
    keep = ~_is_joint(table, points, i, j)
    points, i, j = points[keep], i[keep], j[keep]
    crossing = _crosses(table, points, i, j)
    said = {_cell(place) for place in branches}
    found = []
    for sort in (True, False):
        groups: dict[tuple[int, int], list[Point]] = {}
        for k in np.flatnonzero(crossing == sort):
            if not sort and _cell((points[k, 0], points[k, 1])) in said:
                continue
            pair = sorted((int(table.contour[i[k]]), int(table.contour[j[k]])))
            groups.setdefault((pair[0], pair[1]), []).append((float(points[k, 0]), float(points[k, 1])))
        sentences = [_sentence(contours, pair, _distinct(places), sort) for pair, places in sorted(groups.items())]
        found += limited(sentences, "places where contours cross" if sort else "places where contours touch")
    return found


def _sentence(contours: Sequence[Contour], pair: tuple[int, int], places: list[Point], crossing: bool) -> Finding:
    a, b = pair
    verb = "cross" if crossing else "touch"
    one, other = named(contours[a]), named(contours[b])
    who = f"{one} {verb}es itself" if a == b else f"{one} and {other[0].lower()}{other[1:]} {verb}"
    where = ", ".join(at(place) for place in places[:_NAMED])
    more = f" and {len(places) - _NAMED} more places" if len(places) > _NAMED else ""
    advice = " Trim or move one of them." if crossing else ""
    ids = contours[a].entity_ids if a == b else contours[a].entity_ids + contours[b].entity_ids
    text = f"{who} at {where}{more}.{advice}"
    return Finding(FindingKind.SELF_INTERSECTION, text, *places[0], crossing, ids[: 10 * LIMIT], float(len(places)))


def _distinct(places: list[Point]) -> list[Point]:
    """Return each place once; one contact is found in up to four pairs of rows."""
    return list({_cell(place): place for place in places}.values())


def _cell(place: Point) -> tuple[int, int]:
    return round(place[0] * 1e4), round(place[1] * 1e4)


def _table(contours: Sequence[Contour]) -> _Table:
    rows = [np.zeros((0, 8)), *rows_of_each(contours)]
    counts = np.array([len(each) for each in rows[1:]], np.int64)
    number, first = np.repeat(np.arange(len(contours)), counts), np.cumsum(counts) - counts
    before, after = np.arange(len(number)) - 1, np.arange(len(number)) + 1
    some, closed = counts > 0, np.array([each.closed for each in contours], np.bool_)
    last = first + counts - 1
    before[first[some]] = np.where(closed, last, -1)[some]
    after[last[some]] = np.where(closed, first, -1)[some]
    return _Table(np.concatenate(rows), number, before, after)


class Contacts(NamedTuple):
    """Points (m, 2) where rows meet, and the numbers of both rows."""

    points: Floats
    first: Indices
    second: Indices


def contacts(rows: Rows, i: Indices, j: Indices) -> Contacts:
    """Return where rows i and j meet; a pair may meet twice.

    A point counts where it lies within WELD of both rows, ends included. Curves that miss one another by less touch at
    one point. Rows that run along one another, and so meet nowhere in particular, have none: their ends say it.
    """
    line_i, line_j = rows[i, TURN] == 0, rows[j, TURN] == 0
    found: list[Contacts] = []
    both = line_i & line_j
    found.append(Contacts(_lines_meet(rows[i[both]], rows[j[both]]), i[both], j[both]))
    for mask, a, b in ((line_i & ~line_j, i, j), (line_j & ~line_i, j, i)):
        found += [Contacts(points, a[mask], b[mask]) for points in _line_meets_arc(rows[a[mask]], rows[b[mask]])]
    arcs = ~line_i & ~line_j
    found += [Contacts(points, i[arcs], j[arcs]) for points in _arcs_meet(rows[i[arcs]], rows[j[arcs]])]
    points = np.concatenate([each.points for each in found])
    a, b = np.concatenate([each.first for each in found]), np.concatenate([each.second for each in found])
    good = np.isfinite(points).all(axis=1)
    points, a, b = points[good], a[good], b[good]
    good = (distances(rows[a], points) <= tolerances.WELD) & (distances(rows[b], points) <= tolerances.WELD)
    return Contacts(points[good], a[good], b[good])


def _lines_meet(a: Rows, b: Rows) -> Floats:
    """Return where the endless lines meet, NaN where they part by less than _PARALLEL over the longer of both."""
    u, v, w = a[:, 2:4] - a[:, :2], b[:, 2:4] - b[:, :2], b[:, :2] - a[:, :2]
    across, long_u, long_v = _cross(u, v), np.hypot(*u.T), np.hypot(*v.T)
    flat = np.abs(across) <= _PARALLEL * np.minimum(long_u, long_v)
    with np.errstate(divide="ignore", invalid="ignore"):
        points = a[:, :2] + u * (_cross(w, v) / across)[:, None]
    return np.where(flat[:, None], np.nan, points)


def _line_meets_arc(line: Rows, arc: Rows) -> list[Floats]:
    along = line[:, 2:4] - line[:, :2]
    unit = along / np.maximum(np.hypot(*along.T), 1e-300)[:, None]
    arm = arc[:, CX:R] - line[:, :2]
    foot = line[:, :2] + unit * (arm * unit).sum(axis=1)[:, None]
    off = np.abs(_cross(unit, arm))
    return _either_side(foot, unit, (arc[:, R] - off) * (arc[:, R] + off))


def _arcs_meet(a: Rows, b: Rows) -> list[Floats]:
    """Return where whole circles meet, NaN where they are of one centre; those that miss one another: where a comes
    nearest.
    """
    between = b[:, CX:R] - a[:, CX:R]
    gap, radius, other = np.hypot(*between.T), a[:, R], b[:, R]
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = between / gap[:, None]
        reach = (gap + (radius - other) * (radius + other) / gap) / 2
    reach = np.where(gap > _PARALLEL, np.clip(reach, -radius, radius), np.nan)
    foot = a[:, CX:R] + unit * reach[:, None]
    return _either_side(foot, np.stack([-unit[:, 1], unit[:, 0]], axis=1), (radius - reach) * (radius + reach))


def _either_side(foot: Floats, unit: Floats, height2: Floats) -> list[Floats]:
    """Return foot - h unit and foot + h unit; the foot alone where the height is none."""
    height = np.sqrt(np.maximum(height2, 0.0))[:, None]
    return [foot - height * unit, np.where(height > 0, foot + height * unit, np.nan)]


def _is_joint(table: _Table, points: Floats, i: Indices, j: Indices) -> NDArray[np.bool_]:
    """Return which contacts are just the joint of neighbours."""
    result = np.zeros(len(i), dtype=bool)
    for a, b in ((i, j), (j, i)):
        result |= (table.after[a] == b) & (np.hypot(*(points - table.rows[a, X1 : X1 + 2]).T) <= 2 * tolerances.WELD)
    return result


def _curvature(rows: Rows) -> Floats:
    return np.where(rows[:, TURN] == 0, 0.0, 1.0 / np.maximum(rows[:, R], 1e-300))


def _crosses(table: _Table, points: Floats, i: Indices, j: Indices) -> NDArray[np.bool_]:
    """Return which contacts are crossings: one contour leaves on either side of the other, deeper than 1 um."""
    a_in, a_out = _ways(table, points, i)
    b_in, b_out = _ways(table, points, j)
    sides = _within(a_out, a_in, b_out) != _within(a_out, a_in, b_in)
    slant = (
        np.min([np.abs(_cross(p, q)) for p in (a_in, a_out) for q in (b_in, b_out)], axis=0) if len(i) else np.zeros(0)
    )
    bend = np.maximum(_curvature(table.rows[i]) + _curvature(table.rows[j]), 1e-9)
    result: NDArray[np.bool_] = sides & (slant > 1e-6) & (slant**2 / (2 * bend) > tolerances.CURVE)
    return result


def _ways(table: _Table, points: Floats, i: Indices) -> tuple[Floats, Floats]:
    """Return the unit directions away from a point of row i, backward and forward; NaN where an open contour ends."""
    rows = table.rows[i]
    forward, backward = _tangent(rows, points), -_tangent(rows, points)
    at_start = np.hypot(*(points - rows[:, :2]).T) <= 2 * tolerances.WELD
    at_end = np.hypot(*(points - rows[:, X1 : X1 + 2]).T) <= 2 * tolerances.WELD
    before, after = table.before[i], table.after[i]
    backward = np.where(
        at_start[:, None], np.where((before >= 0)[:, None], -_tangent(table.rows[before], points), np.nan), backward
    )
    forward = np.where(
        at_end[:, None], np.where((after >= 0)[:, None], _tangent(table.rows[after], points), np.nan), forward
    )
    return backward, forward


def _tangent(rows: Rows, points: Floats) -> Floats:
    arm = points - rows[:, CX:R]
    along = np.where(
        (rows[:, TURN] == 0)[:, None],
        rows[:, 2:4] - rows[:, :2],
        np.stack([-arm[:, 1], arm[:, 0]], axis=1) * rows[:, [TURN]],
    )
    result: Floats = along / np.maximum(np.hypot(*along.T), 1e-300)[:, None]
    return result


def _within(first: Floats, last: Floats, way: Floats) -> NDArray[np.bool_]:
    """Return whether directions lie in the sector that opens counter-clockwise from first to last."""

    def turn(v: Floats) -> Floats:
        angle: Floats = np.arctan2(_cross(first, v), (first * v).sum(axis=1)) % (2 * np.pi)
        return angle

    result: NDArray[np.bool_] = turn(way) < turn(last)
    return result


def _cross(u: Floats, v: Floats) -> Floats:
    result: Floats = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return result
