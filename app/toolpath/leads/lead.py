"""Where a path along a wall begins, and how the cutter comes to the wall and leaves it again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...geometry.distance import DistanceField
from ...geometry.primitives import TURN, R, Rows, lengths, points_at, turns
from ...model.entry import Lead, LeadKind
from ...model.finding import Finding, FindingKind
from ...model.tool import Tool
from .contour_path import Floats, Path, keep_clear, left_of, line_row, quarter_arc

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


def lead_size(lead: Lead, tool: Tool) -> float:
    """Return the radius or length of a whole lead, mm."""
    return tool.radius if lead.radius is None else lead.radius


@dataclass(frozen=True)
class Around:
    """What leads go by.

    Attributes:
        field: distances from all walls and clamps.
        tool: the cutter.
        need: how far its centre keeps from them, mm.
        away: +1 where the wall is on the right of travel, and so room is on the left; -1 the other way round.
        lead: what is wanted.
    """

    field: DistanceField
    tool: Tool
    need: float
    away: float
    lead: Lead

    @property
    def size(self) -> float:
        """Radius or length of a whole lead, mm."""
        return lead_size(self.lead, self.tool)


@dataclass(frozen=True, eq=False)
class Run:
    """A path with its beginning, its end and its leads.

    Attributes:
        start, stop: where it begins and ends, mm along the path; a closed one goes on past its beginning by the overlap.
        way_in, way_out: (0 or 1, 8) rows to the wall and away from it.
        share: how large the leads are against what was wanted; 0 = there are none.
        bent: True for arcs.
    """

    path: Path
    start: float
    stop: float
    way_in: Rows
    way_out: Rows
    share: float
    bent: bool


def runs(paths: Sequence[Path], taken: Sequence[Sequence[tuple[float, float]]], around: Around,
         wished: Sequence[Sequence[float]] = ()) -> tuple[Run, ...]:
    """Return each path with its beginning and its leads.

    A lead is tried at several beginnings of a closed path, the best first, then smaller, then as a straight line; every one is
    proven clear along all of its length. What does not fit is left out.

    Args:
        taken: for each path (from, to) that its beginning, its end and its leads keep out of, mm along it, such as tabs.
        wished: for each path beginnings that are better than all others, mm along it; () = none.
    """
    starts = [_starts(path, around, blocked) for path, blocked in zip(paths, taken, strict=True)]
    for path, own, better in zip(paths, starts, wished, strict=False):
        own[:0] = better if path.closed else []
    spots = [_Spot.at(path, k, start, around) for k, path in enumerate(paths) for start in starts[k]]
    need = np.repeat(_needs(spots, around), 2)
    made: dict[int, Run] = {}
    for bent, share in _tries(around):
        waiting = [k for k, spot in enumerate(spots) if spot.number not in made]
        if share * around.size < _LEAST or not waiting:
            continue
        ways = [spots[k].ways(around, (bent, share)) for k in waiting]
        both = (2 * np.array(waiting)[:, None] + np.arange(2)).ravel()
        good = keep_clear(around.field, np.concatenate([way for pair in ways for way in pair]), need[both])
        for k, way, first, second in zip(waiting, ways, good[::2].tolist(), good[1::2].tolist(), strict=True):
            if first and second and spots[k].number not in made:
                spot = spots[k]
                made[spot.number] = Run(paths[spot.number], spot.start, _stop(paths[spot.number], spot.start, around), *way, share, bent)
    none = np.zeros((0, 8))
    return tuple(made.get(k) or Run(path, starts[k][0], _stop(path, starts[k][0], around), none, none, 0.0, False)
                 for k, path in enumerate(paths))  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Spot:
    """A place where a path may begin.

    Attributes:
        number: of the path. start: how far along it, mm.
        points, ahead: (2, 2) beginning and end of the path that begins there, and its directions.
    """

    number: int
    start: float
    points: Floats
    ahead: Floats

    @staticmethod
    def at(path: Path, number: int, start: float, around: Around) -> _Spot:
        ends = np.array([start, _stop(path, start, around)])
        points, ahead = path.points(ends), path.headings(ends)
        if not path.closed:  # an open path's end is the end of its last row
            points = np.array([path.rows[0, :2], path.rows[-1, 2:4]])
        return _Spot(number, start, points, ahead)

    def ways(self, around: Around, how: tuple[bool, float]) -> tuple[Rows, Rows]:
        """Return the rows (1, 8) to the wall and away from it, (arc, share of the size)."""
        points, ahead, aside = self.points, self.ahead, left_of(self.ahead) * around.away
        bent, share = how
        size = share * around.size
        if not bent:
            return line_row(points[0] + size * aside[0], points[0])[None], line_row(points[1], points[1] + size * aside[1])[None]
        centres = points + size * aside
        return (quarter_arc(centres[0] - size * ahead[0], points[0], centres[0], around.away)[None],
                quarter_arc(points[1], centres[1] + size * ahead[1], centres[1], around.away)[None])  # fmt: skip


def _needs(spots: Sequence[_Spot], around: Around) -> Floats:
    """Return how far leads keep off (n,): where the path itself lies nearer, by what it may miss its distance, as near as it."""
    if not spots:
        return np.zeros(0)
    near = around.field.nearest(np.concatenate([spot.points for spot in spots]))[0].reshape(-1, 2).min(axis=1)
    need: Floats = np.minimum(around.need, near)
    return need


def _tries(around: Around) -> list[tuple[bool, float]]:
    """Return (arc, share of the size) in the order of trying."""
    if around.lead.kind is LeadKind.NONE:
        return []
    least = _SMALLEST * min(1.0, around.tool.radius / around.size)
    shares = [1.0]
    while shares[-1] / 2 >= least:
        shares.append(shares[-1] / 2)
    arcs = [(True, share) for share in shares] if around.lead.kind is LeadKind.ARC else []
    return arcs + [(False, share) for share in shares]


def _stop(path: Path, start: float, around: Around) -> float:
    if not path.closed:
        return path.length
    wanted = around.lead.overlap if around.lead.kind is not LeadKind.NONE else 0.0
    return start + path.length + min(wanted, path.length / 2)


def _starts(path: Path, around: Around, taken: Sequence[tuple[float, float]]) -> list[float]:
    """Return places where a path may begin, the best first: far from corners, on straight rows, where there is room."""
    if not path.closed:
        return [0.0]
    size = lengths(path.rows)
    corners = corners_of(path, around, _CORNER)
    places = path.ends - size / 2
    if len(corners):
        between = np.diff(np.append(corners, corners[0] + path.length))
        places = np.concatenate([places, (corners + between / 2) % path.length])
    places = places[~_is_taken(path, places, around, taken)]
    if not len(places):
        return [_freest(path, taken)]
    score = _score(path, places, corners, around)
    order = np.argsort(-score, kind="stable")[:_TRIED]
    return [float(place) for place in places[order]]


def _score(path: Path, places: Floats, corners: Floats, around: Around) -> Floats:
    """Return how good places are to begin at: up to 1 for the way to the next corner, as much for room, a little for straight rows."""
    row, _ = path.rows_at(places)
    far = np.full(len(places), path.length)
    if len(corners):
        after = np.searchsorted(corners, places) % len(corners)
        far = np.minimum((corners[after] - places) % path.length, (places - corners[after - 1]) % path.length)
    width = around.tool.diameter
    aside = path.points(places) + left_of(path.headings(places)) * around.away * around.size
    room = np.clip(around.field.nearest(aside)[0] - around.need, 0.0, around.size)
    straight = np.where(path.rows[row, TURN] == 0, 0.25, 0.0)
    score: Floats = np.minimum(far / (2 * width), 1.0) + room / max(around.size, 1e-9) + straight
    return score + 0.01 * far / max(path.length, 1e-9)  # a tool as wide as its hole has a path of no length


def corners_of(path: Path, around: Around, least: float) -> Floats:
    """Return where the corners of a closed path are, in order, mm along it: joints that turn, and where it goes round corners of the wall.

    Args:
        least: a joint that turns less is none, radians.
    """
    size = lengths(path.rows)
    begin = path.ends - size
    rounding = (path.rows[:, TURN] == -around.away) & (np.abs(path.rows[:, R] - around.need) < _SAME)
    round_them = [begin[rounding] + size[rounding] * part for part in (0.0, 0.5, 1.0)]
    found: Floats = np.unique(np.concatenate([begin[turns(path.rows) > least], *round_them]))
    return found


def reach(around: Around) -> float:
    """Return how far along the path a lead and its cutter reach, mm."""
    return around.size + around.tool.radius if around.lead.kind is not LeadKind.NONE else 0.0


def _is_taken(path: Path, places: Floats, around: Around, taken: Sequence[tuple[float, float]]) -> np.ndarray:
    """Return (m,) whether a path that begins at a place, overlap and leads and all, comes into what is taken."""
    beside = reach(around)
    found = np.zeros(len(places), np.bool_)
    for low, high in taken:
        width = high - low + 2 * beside + (_stop(path, 0.0, around) - path.length)
        first = low - beside - (_stop(path, 0.0, around) - path.length)
        found |= (places - first) % path.length <= width
    return found


def _freest(path: Path, taken: Sequence[tuple[float, float]]) -> float:
    """Return the place farthest from everything that is taken."""
    if not taken:
        return 0.0
    middles = np.sort([(low + high) / 2 % path.length for low, high in taken])
    between = np.diff(np.append(middles, middles[0] + path.length))
    k = int(np.argmax(between))
    return float((middles[k] + between[k] / 2) % path.length)


def about_leads(made: Sequence[Run], around: Around) -> list[Finding]:
    """Return one remark about leads that do not fit as they were asked for."""
    if around.lead.kind is LeadKind.NONE:
        return []
    wanted = around.lead.kind is LeadKind.ARC
    none = [run for run in made if run.share == 0]
    other = [run for run in made if run.share > 0 and (run.share < 1 or run.bent != wanted)]
    if not none and not other:
        return []
    x, y = points_at((none or other)[0].path.rows[:1], np.zeros(1))[0]
    said = [f"{len(some)} {'has' if len(some) == 1 else 'have'} {what}"
            for some, what in ((other, "smaller or straight leads"), (none, "no leads")) if some]  # fmt: skip
    text = (f"Of {len(made)} {'path' if len(made) == 1 else 'paths'} of T{around.tool.number} {around.tool.label}, {' and '.join(said)}, "
            f"because walls and clamps leave no room for more; the first is at ({x:.3f}, {y:.3f}).")
    return [Finding(FindingKind.LEFT_OUT, text, float(x), float(y), counts=False, amount=float(len(none) + len(other)))]


def about_overlaps(made: Sequence[Run], around: Around) -> list[Finding]:
    """Return one remark about closed paths so short that they go over their beginning by less than was asked."""
    wanted = around.lead.overlap if around.lead.kind is not LeadKind.NONE else 0.0
    short = [run for run in made if run.path.closed and run.stop - run.start - run.path.length < wanted - _SAME]
    if not short:
        return []
    x, y = points_at(short[0].path.rows[:1], np.zeros(1))[0]
    text = (f"Of {len(made)} {'path' if len(made) == 1 else 'paths'} of T{around.tool.number} {around.tool.label}, {len(short)} "
            f"{'goes' if len(short) == 1 else 'go'} on over the beginning by half the length, less than the {wanted:g} mm asked for; "
            f"the first is at ({x:.3f}, {y:.3f}).")
    return [Finding(FindingKind.LEFT_OUT, text, float(x), float(y), counts=False, amount=float(len(short)))]
