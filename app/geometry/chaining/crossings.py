"""Where contours cross or touch themselves and one another: closed forms on pairs whose boxes meet."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...model.curves import Point
from ...model.finding import Finding, FindingKind
from ...model.part import Contour
from ..primitives import CX, TURN, X1, R, Rows, contour_rows, distances
from .findings import LIMIT, at, limited, named
from .overlap import near_pairs

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
    rows = [np.zeros((0, 8)), *(contour_rows(each) for each in contours)]
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
