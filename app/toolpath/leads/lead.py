"""Where a path along a wall begins, and how the cutter comes to the wall and leaves it again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...core.wording import in_plane, together
from ...geometry.distance import DistanceField
from ...geometry.primitives import CX, CY, TURN, X0, X1, Y0, Y1, Indices, R, Rows, points_at, turns
from ...model.entry import Lead, LeadKind
from ...model.finding import Finding, FindingKind
from ...model.operation import Operation
from ...model.tool import Tool
from . import contour_path_kernels as path_kernels
from .contour_path import ContourPath, ContourPaths, Floats, keep_clear, left_of

_SMALLEST = 0.125
"""Of the cutter's radius, or of a lead that is smaller than that: leads are halved down to it."""

_CORNER = 0.15
"""Radians; a joint that turns more than this is a corner."""

_TRIED = 6
"""Starts that are tried on each path."""

_SAME = 1e-3
"""mm; an arc whose radius is this near to the distance from the wall goes round a corner of it."""

_LEAST = 0.02
"""mm; a smaller lead is none."""

_LONGER = 1.25
"""Times the radius in the register: controls refuse a first move that is no longer than it."""


def lead_size(lead: Lead, tool: Tool) -> float:
    """Return the radius or length of a whole lead, mm."""
    return tool.radius if lead.radius is None else lead.radius


def straight_way(operation: Operation, tool: Tool) -> float:
    """Return how long the ways are on which the control begins and ends to offset an operation's path by the tool's
    radius, mm: longer than the most that the operator may enter; 0 = it does not.
    """
    return _LONGER * (tool.radius + operation.wear) if operation.offset_by_control else 0.0


@dataclass(frozen=True)
class LeadContext:
    """What leads go by.

    Attributes:
        field: distances from all walls and clamps.
        tool: the cutter.
        need: how far its centre keeps from them, mm.
        away: +1 where the wall is on the right of travel, and so room is on the left; -1 the other way round.
        lead: what is wanted.
        straight: how long the straight ways are, before an arc to the wall and behind one away from it, on which a
            control begins and ends to offset the path by the tool's radius, mm as it is programmed; 0 = there are none.
        spare: how much farther than `need` these ways keep off, mm.
    """

    field: DistanceField
    tool: Tool
    need: float
    away: float
    lead: Lead
    straight: float = 0.0
    spare: float = 0.0

    @property
    def size(self) -> float:
        """Radius or length of a whole lead, mm."""
        return lead_size(self.lead, self.tool)


@dataclass(frozen=True, eq=False)
class PathWithLeads:
    """A path with its beginning, its end and its leads.

    Attributes:
        start, stop: where it begins and ends, mm along the path; a closed one goes on past its beginning by the
            overlap.
        way_in, way_out: (0 to 2, 8) rows to the wall and away from it.
        share: how large the leads are against what was wanted; 0 = there are none.
        bent: True for arcs.
    """

    path: ContourPath
    start: float
    stop: float
    way_in: Rows
    way_out: Rows
    share: float
    bent: bool


class _LeadTry(NamedTuple):
    """Leads to be tried: arcs or straight lines, and how large, as a share of the size that was asked for."""

    bent: bool
    share: float


class _Beginning(NamedTuple):
    """Where a path may begin: its number, and the place, mm along it."""

    path: int
    start: float


class _ClearLeads(NamedTuple):
    """A beginning both of whose leads are clear all along; their rows (2 or 4, 8): to the wall, away from it."""

    begins: _Beginning
    ways: Rows


class _PathCorners(NamedTuple):
    """Corners of some closed paths, one path after the other.

    Attributes:
        at: (k,) mm along their path.
        first: (m + 1,) where those of each path begin.
    """

    at: Floats
    first: Indices


def runs(
    paths: Sequence[ContourPath],
    taken: Sequence[Sequence[tuple[float, float]]],
    around: LeadContext,
    wished: Sequence[Sequence[float]] = (),
) -> tuple[PathWithLeads, ...]:
    """Return each path with its beginning and its leads.

    A lead is tried at several beginnings of a closed path, the best first, then smaller, then as a straight line; every
    one is proven clear along all of its length. What does not fit is left out.

    Args:
        taken: for each path (from, to) that its beginning, its end and its leads keep out of, mm along it, such as
            tabs.
        wished: for each path beginnings that are better than all others, mm along it; () = none.
    """
    starts = _starts(paths, around, taken)
    for path, own, better in zip(paths, starts, wished, strict=False):
        own[:0] = better if path.closed else []
    joined = ContourPaths.of(paths)
    lengths = joined.lengths.tolist()
    made: dict[int, PathWithLeads] = {}
    for tried in _tries(around):
        if tried.share * around.size < _LEAST:
            continue
        # the best beginning of every path, then the next of those still without
        for turn in range(max(map(len, starts), default=0)):
            left = [k for k in range(len(paths)) if k not in made and turn < len(starts[k])]
            requested = [_Beginning(k, starts[k][turn]) for k in left]
            for (k, start), way in _fitting(joined, requested, around, tried):
                stop = _stop(paths[k], lengths[k], start, around)
                half = len(way) // 2
                made[k] = PathWithLeads(paths[k], start, stop, way[:half], way[half:], tried.share, tried.bent)
    none = np.zeros((0, 8))
    return tuple(
        made.get(k)
        or PathWithLeads(path, starts[k][0], _stop(path, lengths[k], starts[k][0], around), none, none, 0.0, bent=False)
        for k, path in enumerate(paths)
    )


def _fitting(
    paths: ContourPaths, requested: Sequence[_Beginning], around: LeadContext, tried: _LeadTry
) -> list[_ClearLeads]:
    """Return the beginnings both of whose leads are clear all along.

    Leads keep off as the path does: where it lies nearer itself, by what it may miss its distance, as near as it.
    """
    if not requested:
        return []
    number, start = np.array([each.path for each in requested]), np.array([each.start for each in requested])
    points, ahead = _spots(paths, number, start, around)
    ways = _ways(points, ahead, around, tried)
    near = around.field.nearest(points.reshape(-1, 2))[0].reshape(-1, 2).min(axis=1)
    need = np.repeat(np.minimum(around.need, near)[:, None], ways.shape[1], axis=1)
    if ways.shape[1] > 2:  # the outermost are the control's
        need[:, [0, -1]] = around.need + around.spare
    good = keep_clear(around.field, ways.reshape(-1, 8), need.ravel()).reshape(need.shape).all(axis=1)
    return [_ClearLeads(requested[k], ways[k]) for k in np.flatnonzero(good).tolist()]


def _spots(paths: ContourPaths, number: Indices, start: Floats, around: LeadContext) -> tuple[Floats, Floats]:
    """Return beginning and end (k, 2, 2) of paths that begin at places (k,), mm along them, and the directions
    there.
    """
    length, closed, rows = paths.lengths[number], paths.closed[number], paths.outlines.rows
    stop = np.where(closed, start + length + np.minimum(_overlap(around), length / 2), length)
    both, ends = np.repeat(number, 2), np.stack([start, stop], 1).ravel()
    points, ahead = (each.reshape(-1, 2, 2) for each in (paths.points(both, ends), paths.headings(both, ends)))
    outer = np.stack([rows[paths.outlines.first[number], :2], rows[paths.outlines.first[number + 1] - 1, 2:4]], 1)
    return np.where(closed[:, None, None], points, outer), ahead  # an open path's end is the end of its last row


def _ways(points: Floats, ahead: Floats, around: LeadContext, tried: _LeadTry) -> Rows:
    """Return the rows (k, 2 or 4, 8) to the wall and away from it; args as `_spots` returns them and `_fitting` takes
    them.
    """
    aside = left_of(ahead.reshape(-1, 2)).reshape(ahead.shape) * around.away
    size = tried.share * around.size
    rows = np.zeros((len(points), 2, 8))
    rows[:, 0, [X1, Y1]], rows[:, 1, :2] = points[:, 0], points[:, 1]
    if not tried.bent:
        rows[:, 0, :2], rows[:, 1, [X1, Y1]] = points[:, 0] + size * aside[:, 0], points[:, 1] + size * aside[:, 1]
        return rows
    centres = points + size * aside
    rows[:, 0, :2], rows[:, 1, [X1, Y1]] = centres[:, 0] - size * ahead[:, 0], centres[:, 1] + size * ahead[:, 1]
    rows[:, :, [CX, CY]], rows[:, :, TURN] = centres, around.away
    rows[:, :, R] = np.hypot(rows[:, :, X0] - rows[:, :, CX], rows[:, :, Y0] - rows[:, :, CY])
    return _with_straight_ways(rows, ahead, aside, around) if around.straight else rows


def _with_straight_ways(arcs: Rows, ahead: Floats, aside: Floats, around: LeadContext) -> Rows:
    """Return the rows (k, 4, 8) of arcs (k, 2, 8) with a straight way before and behind.

    As programmed, the ways are tangents of the arcs' own contours, which lie the tool's radius outside of the arcs.
    The tool begins on the contour and goes from there to beside the tangent's end, and so aslant; so it leaves.

    Args:
        ahead, aside: (k, 2, 2) directions of the path at beginning and end, and away from the wall there.
    """
    radius, rows = around.tool.radius, np.zeros((len(arcs), 4, 8))
    rows[:, 1], rows[:, 2] = arcs[:, 0], arcs[:, 1]
    rows[:, 0, [X1, Y1]], rows[:, 3, :2] = arcs[:, 0, :2], arcs[:, 1, [X1, Y1]]
    rows[:, 0, :2] = arcs[:, 0, :2] - radius * ahead[:, 0] + around.straight * aside[:, 0]
    rows[:, 3, [X1, Y1]] = arcs[:, 1, [X1, Y1]] + radius * ahead[:, 1] + around.straight * aside[:, 1]
    return rows


def _tries(around: LeadContext) -> list[_LeadTry]:
    """Return which leads to try, in this order."""
    if around.lead.kind is LeadKind.NONE:
        return []
    least = _SMALLEST * min(1.0, around.tool.radius / around.size)
    shares = [1.0]
    while shares[-1] / 2 >= least:
        shares.append(shares[-1] / 2)
    if around.straight:  # the arc, too, is offset by what the operator enters
        return [_LeadTry(True, share) for share in shares if share * around.size > around.spare]
    arcs = [_LeadTry(True, share) for share in shares] if around.lead.kind is LeadKind.ARC else []
    return arcs + [_LeadTry(False, share) for share in shares]


def _stop(path: ContourPath, length: float, start: float, around: LeadContext) -> float:
    """Return where a path of a length ends that begins at a place, mm along it."""
    return start + length + min(_overlap(around), length / 2) if path.closed else length


def _overlap(around: LeadContext) -> float:
    """Return how far a path is to go on over its beginning, mm."""
    return around.lead.overlap if around.lead.kind is not LeadKind.NONE else 0.0


def _starts(
    paths: Sequence[ContourPath], around: LeadContext, taken: Sequence[Sequence[tuple[float, float]]]
) -> list[list[float]]:
    """Return places where each path may begin, the best first: far from corners, on straight rows, where there is
    room.
    """
    found = [[0.0] for _ in paths]
    number = [k for k, path in enumerate(paths) if path.closed]
    closed = ContourPaths.of([paths[k] for k in number])
    corners = _corners(closed, around, _CORNER)
    owner, places = _middles(closed, corners)
    bounds = np.searchsorted(owner, np.arange(len(number) + 1))
    free = np.ones(len(places), np.bool_)
    for k, own in enumerate(number):
        if taken[own]:
            part = slice(bounds[k], bounds[k + 1])
            free[part] = ~_is_taken(paths[own], places[part], around, taken[own])
    owner, places = owner[free], places[free]
    order = np.lexsort((-_score(closed, owner, places, corners, around), owner))
    places, bounds = places[order], np.searchsorted(owner, np.arange(len(number) + 1))
    for k, own in enumerate(number):
        best = places[bounds[k] : bounds[k + 1]][:_TRIED].tolist()
        found[own] = best or [_freest(paths[own], taken[own])]
    return found


def _middles(paths: ContourPaths, corners: _PathCorners) -> tuple[Indices, Floats]:
    """Return (path, mm along it), path by path, of the middles of all rows, and of what lies between one corner and the
    next.
    """
    at, first = corners
    owner = np.repeat(np.arange(len(first) - 1), np.diff(first))
    following = np.append(at[1:], 0.0)[: len(at)]
    last = first[1:][np.diff(first) > 0] - 1
    following[last] = at[first[:-1][np.diff(first) > 0]] + paths.lengths[owner[last]]
    between = (at + (following - at) / 2) % paths.lengths[owner]
    both = np.concatenate([paths.outlines.owner, owner])
    order = np.argsort(both, kind="stable")
    return both[order], np.concatenate([paths.ends - paths.outlines.sizes / 2, between])[order]


def _score(paths: ContourPaths, path: Indices, places: Floats, corners: _PathCorners, around: LeadContext) -> Floats:
    """Return how good places are to begin at: up to 1 for the way to the next corner, as much for room, a little for
    straight rows.
    """
    row, _ = paths.rows_at(path, places)
    length = paths.lengths[path]
    far = _to_corners(path, places, corners, length)
    width = around.tool.diameter
    aside = paths.points(path, places) + left_of(paths.headings(path, places)) * around.away * around.size
    room = np.clip(around.field.nearest(aside)[0] - around.need, 0.0, around.size)
    straight = np.where(paths.outlines.rows[row, TURN] == 0, 0.25, 0.0)
    score: Floats = np.minimum(far / (2 * width), 1.0) + room / max(around.size, 1e-9) + straight
    return score + 0.01 * far / np.maximum(length, 1e-9)  # a tool as wide as its hole has a path of no length


def _to_corners(path: Indices, places: Floats, corners: _PathCorners, length: Floats) -> Floats:
    """Return how far it is from places to the nearest corner along their path, mm; all of the path where it has
    none.
    """
    at, first = corners
    count = np.diff(first)[path]
    after = np.empty(len(places), np.int64)
    path_kernels.counts_below(at, first, path, places, False, after)
    far, some = length.copy(), count > 0
    begin, k, count = first[:-1][path][some], after[some] % count[some], count[some]
    ahead, behind = at[begin + k] - places[some], places[some] - at[begin + (k - 1) % count]
    far[some] = np.minimum(ahead % length[some], behind % length[some])
    return far


def corners_of(path: ContourPath, around: LeadContext, least: float) -> Floats:
    """Return where the corners of a closed path are, in order, mm along it: joints that turn, and where it goes round
    corners of the wall.

    Args:
        least: a joint that turns less is none, radians.
    """
    return _corners(path.alone, around, least).at


def _corners(paths: ContourPaths, around: LeadContext, least: float) -> _PathCorners:
    """Return the corners of all of some closed paths."""
    rows, size, owner = paths.outlines.rows, paths.outlines.sizes, paths.outlines.owner
    begin = paths.ends - size
    rounding = (rows[:, TURN] == -around.away) & (np.abs(rows[:, R] - around.need) < _SAME)
    joint = turns(rows, paths.outlines.previous) > least
    at = np.concatenate([begin[joint], *(begin[rounding] + size[rounding] * part for part in (0.0, 0.5, 1.0))])
    path = np.concatenate([owner[joint], *[owner[rounding]] * 3])
    order = np.lexsort((at, path))
    at, path = at[order], path[order]
    new = np.ones(len(at), np.bool_)
    new[1:] = (np.diff(at) != 0) | (np.diff(path) != 0)
    return _PathCorners(at[new], np.searchsorted(path[new], np.arange(len(paths.closed) + 1)))


def reach(around: LeadContext) -> float:
    """Return how far along the path a lead and its cutter reach, mm."""
    return around.size + around.tool.radius if around.lead.kind is not LeadKind.NONE else 0.0


def _is_taken(
    path: ContourPath, places: Floats, around: LeadContext, taken: Sequence[tuple[float, float]]
) -> np.ndarray:
    """Return (m,) whether a path that begins at a place, overlap and leads and all, comes into what is taken."""
    beside = reach(around)
    found = np.zeros(len(places), np.bool_)
    for low, high in taken:
        width = high - low + 2 * beside + (_stop(path, path.length, 0.0, around) - path.length)
        first = low - beside - (_stop(path, path.length, 0.0, around) - path.length)
        found |= (places - first) % path.length <= width
    return found


def _freest(path: ContourPath, taken: Sequence[tuple[float, float]]) -> float:
    """Return the place farthest from everything that is taken."""
    if not taken:
        return 0.0
    middles = np.sort([(low + high) / 2 % path.length for low, high in taken])
    between = np.diff(np.append(middles, middles[0] + path.length))
    k = int(np.argmax(between))
    return float((middles[k] + between[k] / 2) % path.length)


def lead_findings(made: Sequence[PathWithLeads], around: LeadContext) -> list[Finding]:
    """Return one remark about leads that do not fit as they were asked for."""
    if around.lead.kind is LeadKind.NONE:
        return []
    requested = around.lead.kind is LeadKind.ARC
    none = [run for run in made if run.share == 0]
    other = [run for run in made if run.share > 0 and (run.share < 1 or run.bent != requested)]
    if not none and not other:
        return []
    x, y = points_at((none or other)[0].path.rows[:1], np.zeros(1))[0]
    said = [
        f"{len(some)} {'has' if len(some) == 1 else 'have'} {what}"
        for some, what in ((other, "smaller or straight leads"), (none, "no leads"))
        if some
    ]
    text = (
        f"Of {len(made)} {'path' if len(made) == 1 else 'paths'} of T{around.tool.number} {around.tool.label}, "
        f"{together(said)}, because walls and clamps leave no room for more; the first is at {in_plane(x, y)}."
    )
    return [Finding(FindingKind.LEFT_OUT, text, float(x), float(y), counts=False, amount=float(len(none) + len(other)))]


def overlap_findings(made: Sequence[PathWithLeads], around: LeadContext) -> list[Finding]:
    """Return one remark about closed paths so short that they go over their beginning by less than was asked."""
    requested = around.lead.overlap if around.lead.kind is not LeadKind.NONE else 0.0
    short = [run for run in made if run.path.closed and run.stop - run.start - run.path.length < requested - _SAME]
    if not short:
        return []
    x, y = points_at(short[0].path.rows[:1], np.zeros(1))[0]
    text = (
        f"Of {len(made)} {'path' if len(made) == 1 else 'paths'} of T{around.tool.number} {around.tool.label}, "
        f"{len(short)} {'goes' if len(short) == 1 else 'go'} on over the beginning by half the length, less than the "
        f"{requested:g} mm asked for; the first is at {in_plane(x, y)}."
    )
    return [Finding(FindingKind.LEFT_OUT, text, float(x), float(y), counts=False, amount=float(len(short)))]
