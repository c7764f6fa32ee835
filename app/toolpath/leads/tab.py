"""Tabs: where a path goes over bridges of metal that hold what is cut out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.wording import in_plane
from ...geometry.distance import DistanceField
from ...geometry.primitives import points_at
from ...model.contour_operation import ContourOperation
from ...model.curves import Point
from ...model.entry import LeadKind, Tabs
from ...model.finding import Finding, FindingKind
from ...model.moves import Tab
from ...model.operation import LEAST_LENGTH
from ...model.stock_box import StockBox
from ...model.tool import Tool
from .contour_path import ContourPath, Floats, fractions_at
from .lead import LeadContext, PathWithLeads, corners_of, reach

_CORNER = 0.3
"""Radians; a tab keeps off joints that turn more than this."""

_AT_CORNER = 0.5
"""mm that a tab keeps off a corner where the control turns round by itself."""

_FINE = 16
"""Places to the least distance between tabs, among which the nearest to the even one is taken."""

_COARSER = 4
"""Of the places at which tabs may be, one in so many is looked at where only their count is asked for."""

_NEAR = 2.0
"""Least distances between tabs from the even places, within which is looked first."""

_ROUNDING = 1e-9
"""mm along a path: places that differ by no more are one."""

_TURNS = 32
"""Directions in which is looked for where a cutter's rim is farthest from the walls."""

_HOLD = 0.5
"""mm of stock beyond the slot that a tab needs to hold on to."""

_BESIDE = 2.0
"""mm of stock beyond the slot that are advised."""

_LONGEST = 3.0
"""Times the way over a straight tab; what a bend of the path makes it longer by ends there."""

_ROUNDS = 100
"""Ways over a tab that are tried, each longer than the one before by what the metal lacks."""

_LOOKS = 65
"""Places of a path beside a tab that are held against the tab's other end."""

_SHORT = 1e-6
"""mm by which metal may be narrower than asked for."""

_TOLD = 1e-3
"""mm by which metal may be narrower than asked for before that is told: the path is looked at in places."""

_FAR = 5.0
"""Tool diameters; a place by hand that is farther than this from every path is told."""


class TabEnds(NamedTuple):
    """Where paths end before tabs and go on behind them, and as much of them as may come nearer to the other end.

    Attributes:
        middles: (k, 2) of the tabs, mm.
        before, after: (k, n, 2) points of the path away from each end, the end itself first, mm.
    """

    middles: Floats
    before: Floats
    after: Floats

    def nearest(self, points: Floats) -> TabEnds:
        """Return for each of points (m, 2) the ends of the tab whose middle is nearest to it."""
        same = np.argmin(_far(points[:, None], self.middles), axis=1)
        return TabEnds(self.middles[same], self.before[same], self.after[same])

    def apart(self, other: TabEnds) -> Floats:
        """Return how far what is before each tab (m,) is from what is behind it on another path, or on this one, mm.

        One of the two nearest places is an end: a path goes away from its own, but past an acute corner it comes back
        to the other.
        """
        ahead = np.minimum(_far(self.before[:, :1], other.after), _far(other.after[:, :1], self.before))
        found: Floats = ahead.min(axis=1)
        return found


def _far(a: Floats, b: Floats) -> Floats:
    """Return the distances of points (..., 2), mm."""
    found: Floats = np.hypot(a[..., 0] - b[..., 0], a[..., 1] - b[..., 1])
    return found


@dataclass(frozen=True)
class TabShape:
    """What all tabs of an operation have in common.

    Attributes:
        tabs: what was asked for.
        tool: the cutter.
        top: height of their tops, mm, <= -0.001.
        finished: of a path that leaves metal for one nearer to the wall, the ends of that one's ways over the same
            tabs: at a bend the ends of both lie otherwise, and the metal between one's and the other's is to be as
            wide as asked for, too; None: there is no such path.
        kept: what `halves` found, by path and places: where tabs fit, what stands of them and the ways over them are
            all asked of the same.
    """

    tabs: Tabs
    tool: Tool
    top: float
    finished: TabEnds | None = None
    kept: dict[tuple[ContourPath, bytes], Floats] = field(default_factory=dict, init=False, repr=False, compare=False)

    @staticmethod
    def of(operation: ContourOperation, tool: Tool) -> TabShape:
        """Return the shape of an operation's tabs; none is higher than the stock's top."""
        return TabShape(operation.tabs, tool, min(operation.tabs.height - operation.cut.floor, -LEAST_LENGTH))

    @property
    def half(self) -> float:
        """How far before and behind its middle a straight path goes over a tab, mm: half the metal, and the cutter's
        radius.
        """
        return (self.tabs.width + self.tool.diameter) / 2

    def halves(self, path: ContourPath, places: Floats) -> Floats:
        """Return how far before and behind each middle (m,) a path goes over a tab there, mm.

        What stands is as wide as what the cutter's centre goes along before and behind it is apart, less its diameter.
        A bend brings the two ends nearer to one another than they are along the path, and behind an acute corner the
        path comes back to the end before it, so the way over the tab is made longer until the metal is as wide as
        asked for; where no way is, the widest is taken.
        """
        key = path, places.tobytes()
        if key not in self.kept:
            found = np.full(len(places), self.half)
            short = self.tabs.width - self._metal(path, places, found)
            bent = np.flatnonzero(short > _SHORT)
            if len(bent):
                found[bent] = self._longer(path, places[bent])
            self.kept[key] = found
        return self.kept[key].copy()

    def metal(self, path: ContourPath, places: Floats) -> Floats:
        """Return how wide the metal of tabs with these middles (m,) is where it is narrowest, mm."""
        return self._metal(path, places, self.halves(path, places))

    def _metal(self, path: ContourPath, places: Floats, halves: Floats) -> Floats:
        """Return what stands (m,) between the ends of ways over tabs, mm; on an open path that a way leaves the metal
        goes on.
        """
        ends = self.ends(path, places, halves)
        apart = ends.apart(ends)
        if self.finished is not None and len(self.finished.middles):
            finished = self.finished.nearest(ends.middles)
            apart = np.minimum(apart, np.minimum(ends.apart(finished), finished.apart(ends)))
        beyond = (places <= halves) | (places + halves >= path.length)
        metal: Floats = np.where(beyond & (not path.closed), np.inf, apart - self.tool.diameter)
        return metal

    def ends(self, path: ContourPath, places: Floats, halves: Floats) -> TabEnds:
        """Return the ends of ways over tabs, with as much of the path beside them as the ends can be apart, and no more
        than its half in all: what is beyond lies on the other side of what is cut out.
        """
        most = np.clip(path.length / 2 - 2 * halves, 0.0, 2 * halves)
        on = most[:, None] * np.linspace(0.0, 1.0, _LOOKS)
        low, high = (places - halves)[:, None] - on, (places + halves)[:, None] + on
        points = path.points(np.concatenate([places, low.ravel(), high.ravel()]))
        before, after = points[len(places) :].reshape(2, len(places), _LOOKS, 2)
        return TabEnds(points[: len(places)], before, after)

    def _longer(self, path: ContourPath, places: Floats) -> Floats:
        """Return the shortest ways (m,) that leave metal as wide as asked for, half of each, mm; else those that leave
        the widest.
        """
        longest = _LONGEST * self.half * (1 if self.finished is None else 2)  # keeps off what is longer itself
        most = min(longest, (path.length - self.tool.diameter) / 2)
        half = np.full(len(places), self.half)
        best, widest = half, np.full(len(places), -np.inf)
        for _ in range(_ROUNDS):
            metal = self._metal(path, places, half)
            best, widest = np.where(metal > widest, half, best), np.maximum(metal, widest)
            short = self.tabs.width - metal
            unfinished = (short > _SHORT / 2) & (half < most)
            if not unfinished.any():
                break
            # metal grows by no more than the way does at both ends, so this passes no way that is long enough
            half = np.where(unfinished, np.minimum(half + short / 2, most), half)
        return best


def by_hand(
    paths: Sequence[ContourPath], shape: TabShape, shifts: Sequence[Point], walls: DistanceField | None
) -> tuple[list[list[float]], list[Finding]]:
    """Return for each path where tabs are put by hand, mm along it, at what is nearest to each place, on every copy;
    and which are not.

    A path that is too short for a tab gets none; it counts where a part comes loose there.

    Args:
        walls: what the paths follow; a place goes to the wall nearest to it, and then to the path along that.
    """
    found: list[list[float]] = [[] for _ in paths]
    reported: list[Finding] = []
    if not shape.tabs.places or not paths or walls is None:
        return found, reported
    places = np.array([(x + dx, y + dy) for dx, dy in shifts for x, y in shape.tabs.places])
    row = walls.nearest(places)[1]
    feet = points_at(walls.rows[row], fractions_at(walls.rows[row], places))
    near = [path.nearest(feet) for path in paths]
    owner = np.argmin(np.array([distance for _, distance in near]), axis=0)
    for k, path in enumerate(owner.tolist()):
        least = 2 * shape.half + shape.tool.diameter
        if paths[path].length > least:
            found[path].append(float(near[path][0][k]))
            continue
        x, y = places[k].tolist()
        text = (
            f"The tab by hand at {in_plane(x, y)} is left out: the path of T{shape.tool.number} {shape.tool.label} "
            f"nearest to it is {paths[path].length:.3f} mm long, and it takes more than {least:.3f} mm."
        )
        reported.append(
            Finding(FindingKind.LEFT_OUT, text, x, y, counts=paths[path].area < 0, amount=paths[path].length)
        )
    return found, reported


class SpreadTabs(NamedTuple):
    """Where tabs are spread on a path, mm along it, and whether there would be more if metal stood beside all of it."""

    places: list[float]
    lacks_metal: bool


def spread(run: PathWithLeads, own: Sequence[float], shape: TabShape, around: LeadContext) -> SpreadTabs:
    """Return where an operation's tabs go on a path that goes round something, besides those that are put there by
    hand.

    A path that clamps cut open gets as many as a whole one; open lines get none. They are spread evenly over what the
    leads leave, then each is moved off corners as little as possible. Between two tabs at least a cutter's width is
    cut; where that leaves no room for all of them there are fewer.

    Args:
        own: where tabs by hand are.
        around: what the leads went by; of a path on the lines, which keeps 0 mm off them, the lines.
    """
    path, half, beside = run.path, shape.half, reach(around)
    if not shape.tabs.count or not goes_round(path):
        return SpreadTabs([], False)
    overlap = run.stop - run.start - path.length
    free = path.length - overlap - 2 * (beside + half)
    apart = 2 * half + shape.tool.diameter
    count = min(shape.tabs.count, int(free / apart) + 1 if free >= 0 else 0)
    if count <= 0:
        return SpreadTabs([], False)
    first = run.start + overlap + beside + half
    even = run.start + overlap / 2 + (np.arange(count) + 0.5) * path.length / count
    if even[0] < first or even[-1] > first + free:
        even = np.linspace(first, first + free, count) if count > 1 else np.array([first + free / 2])
    corners = corners_of(path, around, _CORNER)
    clear = half + (_AT_CORNER if around.straight else 0.0)
    spans = _off_corners(path, clear, corners if path.closed else np.unique([0.0, *corners]))
    good = np.concatenate([np.append(np.arange(low, high, apart / _FINE), high) for low, high in spans])
    good = np.concatenate([good % path.length, even[_in_spans(even, spans, path.length)] % path.length])
    good = good[(good - first) % path.length <= free + _ROUNDING]
    held = _with_metal_beyond(path, good, around)
    room = _Room(path, shape, first - half, first + free + half)
    made = _placed(even, held, own, room)
    dropped = len(made) < count and len(held) < len(good)
    return SpreadTabs(made, dropped and len(_placed(even, good[::_COARSER], own, room)) > len(made))


def _placed(even: Floats, good: Floats, own: Sequence[float], room: _Room) -> list[float]:
    """Return the good places that are taken for the even ones, those of wide metal that lie near them, if they do."""
    path, most = room.path, _NEAR * (2 * room.shape.half + room.shape.tool.diameter)
    near = good[(_apart(good[:, None], even, path.length) <= most).any(axis=1)]
    made = _nearest_to(even, room.fitting(near), own, room)  # what is farther takes long to look at
    places = np.array(made)
    if len(made) == len(even) and room.wide(places).all() and (_apart(places, even, path.length) <= most).all():
        return made
    return _nearest_to(even, room.fitting(good), own, room)


def _with_metal_beyond(path: ContourPath, places: Floats, around: LeadContext) -> Floats:
    """Return the places of a path round a part beside which metal stands on the far side of its cut, to which a tab
    there is tied; where there is none, all, as of a path within a contour, where what comes loose is waste.

    Round whatever wall, a neighbour's or that of the path's own far side, a path of the same kind clears all that lies
    within the distance that its centre keeps and the cutter's radius, and its leads as much more as they are long. A
    path on the lines has its own line beside it: no other one is to be as near to what lies beyond, on either side.
    """
    if path.area >= 0 or not len(places):
        return places
    points, radius = path.points(places), around.tool.radius
    away = path.headings(places)[:, ::-1] * (-around.away, around.away)
    sides = (1.0,) if around.need else (1.0, -1.0)
    for leads in (_clear_of_leads(around), 0.0):
        far = radius + leads + _HOLD
        beyond: Floats = np.min([around.field.nearest(points + side * far * away)[0] for side in sides], axis=0)
        held: NDArray[np.bool_] = beyond >= max(around.need, _HOLD) + radius + leads - _SHORT
        if held.any():
            return places[held]
    return places


def _clear_of_leads(around: LeadContext) -> float:
    """Return how far leads go away from a path, mm."""
    return around.straight + (around.size if around.lead.kind is not LeadKind.NONE else 0.0)


class _Room(NamedTuple):
    """Where tabs may be on a path: from one place to another, mm along it, which may be past its end."""

    path: ContourPath
    shape: TabShape
    start: float
    stop: float

    def fitting(self, places: Floats) -> Floats:
        """Return which middles leave room for all of a tab: of those as wide as asked for, if there are any, else of
        those that leave metal at all.
        """
        halves, length = self.shape.halves(self.path, places), self.path.length
        before = (places - self.start) % length
        inside = (before >= halves - _ROUNDING) & (before + halves <= self.stop - self.start + _ROUNDING)
        places = places[inside]
        metal = self.shape.metal(self.path, places)
        wide = self._is_wide(metal)
        return places[wide if wide.any() else metal > _SHORT]

    def wide(self, places: Floats) -> NDArray[np.bool_]:
        """Return which tabs with these middles (m,) are as wide as asked for."""
        return self._is_wide(self.shape.metal(self.path, places))

    def _is_wide(self, metal: Floats) -> NDArray[np.bool_]:
        found: NDArray[np.bool_] = metal >= self.shape.tabs.width - _TOLD
        return found


def _nearest_to(even: Floats, good: Floats, own: Sequence[float], room: _Room) -> list[float]:
    """Return for each even place the nearest good one, as long as a cutter's width is cut between two tabs.

    Args:
        own: where tabs by hand are.
    """
    path, shape = room.path, room.shape
    halves = shape.halves(path, good)
    made: list[float] = []
    for requested in even.tolist():
        for each in (*made, *own) if not made else made[-1:]:
            beside = float(shape.halves(path, np.array([each]))[0]) + shape.tool.diameter
            clear = _apart(good, each, path.length) >= halves + beside - _ROUNDING
            good, halves = good[clear], halves[clear]
        if len(good):
            made.append(float(good[int(np.argmin(_apart(good, requested, path.length)))]))
    return made


def goes_round(path: ContourPath) -> bool:
    """Tell whether a path cuts something out: it is closed, or was before clamps cut it open."""
    return path.closed or path.area != 0


def _apart(places: Floats, other: float | Floats, length: float) -> Floats:
    """Return how far places are from another one, or others, along a closed path, mm."""
    return np.abs((places - other + length / 2) % length - length / 2)


def _in_spans(places: Floats, spans: Sequence[tuple[float, float]], length: float) -> NDArray[np.bool_]:
    within: NDArray[np.bool_] = np.any([(places - low) % length <= high - low for low, high in spans], axis=0)
    return within


def _off_corners(path: ContourPath, half: float, corners: Floats) -> list[tuple[float, float]]:
    """Return (from, to), mm along a closed path, where a tab's middle may be with no corner under it; all of it where
    there is none.
    """
    edges = zip(corners, np.append(corners[1:], corners[:1] + path.length), strict=True)
    return [(float(a) + half, float(b) - half) for a, b in edges if b - a >= 2 * half] or [(0.0, path.length)]


def tabs_at(path: ContourPath, places: Sequence[float], shape: TabShape) -> list[Tab]:
    """Return the record of tabs on a path."""
    where = np.array(places, dtype=np.float64)
    widths = shape.tabs.width + 2 * (shape.halves(path, where) - shape.half)
    return [
        Tab(x, y, width, shape.top, shape.tool.diameter, holds_part=path.area < 0)
        for (x, y), width in zip(path.points(where).tolist(), widths.tolist(), strict=True)
    ]


def tab_findings(
    made: Sequence[PathWithLeads],
    tabs: Sequence[Sequence[float]],
    lacks_metal: Sequence[bool],
    shape: TabShape,
    operation: ContourOperation,
) -> list[Finding]:
    """Return what there is to say about tabs: which paths have fewer than asked for, and tabs that are as high as the
    cut is deep.

    It counts where a path round a part, from which it comes loose, has none at all; of one that clamps cut open, where
    no piece has any.

    Args:
        lacks_metal: of each path whether it would have more if metal stood beside all of it.
    """
    held = {run.path.ring for run, places in zip(made, tabs, strict=True) if places and not run.path.closed}
    few: dict[tuple[bool, bool], list[ContourPath]] = {}
    for run, places, lacking in zip(made, tabs, lacks_metal, strict=True):
        path = run.path
        if goes_round(path) and len(places) < shape.tabs.count:
            alone = not places and path.area < 0 and (path.closed or path.ring not in held)
            few.setdefault((alone, lacking), []).append(path)
    findings = [_too_few(few[each], shape, *each) for each in sorted(few, reverse=True)]
    if shape.tabs.enabled and shape.tabs.height >= operation.cut.floor:
        findings.append(
            Finding(
                FindingKind.LEFT_OUT,
                f"Tabs of {shape.tabs.height:g} mm are as high as the cut is deep "
                f"({operation.cut.floor:g} mm), so there the whole metal stays.",
                counts=False,
            )
        )
    return findings


def narrow_tab_findings(
    made: Sequence[PathWithLeads], tabs: Sequence[Sequence[float]], shape: TabShape
) -> list[Finding]:
    """Return what there is to say about tabs whose path bends too tightly for metal as wide as asked for.

    It counts where nothing stands at all.
    """
    narrow: list[tuple[float, float, float]] = []
    for run, places in zip(made, tabs, strict=True):
        where = np.array(places, dtype=np.float64)
        metal, points = shape.metal(run.path, where), run.path.points(where)
        short = metal < shape.tabs.width - _TOLD
        narrow += [(wide, x, y) for wide, (x, y) in zip(metal[short].tolist(), points[short].tolist(), strict=True)]
    if not narrow:
        return []
    least, x, y = min(narrow)
    of = f"of T{shape.tool.number} {shape.tool.label}"
    who = f"1 tab {of} is" if len(narrow) == 1 else f"{len(narrow)} tabs {of} are"
    text = (
        f"{who} narrower than asked for, as the path bends too tightly there: "
        f"{max(least, 0.0):.3f} mm instead of {shape.tabs.width:g} mm at {in_plane(x, y)}."
    )
    return [Finding(FindingKind.LEFT_OUT, text, x, y, counts=least <= 0, amount=max(least, 0.0))]


def _too_few(paths: Sequence[ContourPath], shape: TabShape, loose: bool, lacks_metal: bool) -> Finding:
    """Return what there is to say of paths with fewer tabs than asked for.

    Args:
        loose: a part comes loose there.
        lacks_metal: it is for want of metal that tabs would be tied to, not of length.
    """
    x, y = paths[0].rows[0, :2]
    what = "no tab though a part comes loose there" if loose else f"fewer than {shape.tabs.count} tabs"
    who = f"of T{shape.tool.number} {shape.tool.label}"
    if lacks_metal:
        text = (
            f"1 path {who} has {what}, because no metal stands on the far side of the cut; it begins at "
            f"{in_plane(x, y)}."
            if len(paths) == 1
            else f"{len(paths)} paths {who} have {what}, because no metal stands on the far side of the cut; the first "
            f"begins at {in_plane(x, y)}."
        )
    else:
        text = (
            f"1 path {who} has {what}, because it is too short for them; it begins at {in_plane(x, y)}."
            if len(paths) == 1
            else f"{len(paths)} paths {who} have {what}, because they are too short for them; the first begins at "
            f"{in_plane(x, y)}."
        )
    return Finding(FindingKind.LEFT_OUT, text, float(x), float(y), counts=loose, amount=float(len(paths)))


def unheld_findings(tabs: Sequence[Tab], walls: DistanceField, box: StockBox) -> list[Finding]:
    """Return the remark that tabs round a part hold nothing, as the stock ends where they would hold on to it.

    Args:
        tabs: of paths round parts. walls: of these parts. box: the stock.
    """
    turn = np.linspace(0.0, math.tau, _TURNS, endpoint=False)
    ahead = np.stack([np.cos(turn), np.sin(turn)], 1)
    loose = []
    for tab in tabs:
        rim = (tab.x, tab.y) + ahead * tab.diameter / 2
        x, y = rim[np.argmax(walls.nearest(rim)[0])].tolist()
        if not (box.x0 + _HOLD < x < box.x1 - _HOLD and box.y0 + _HOLD < y < box.y1 - _HOLD):
            loose.append(tab)
    if not loose:
        return []
    first, who = loose[0], f"{len(loose)} of {len(tabs)} tabs" if len(tabs) > 1 else "The tab"
    text = (
        f"{who} would hold nothing, the first at ({first.x:.3f}, {first.y:.3f}): the stock ends within the cutter's "
        f"{first.diameter:g} mm beside the part. Give it a margin of {first.diameter + _BESIDE:g} mm."
    )
    return [Finding(FindingKind.LEFT_OUT, text, first.x, first.y, counts=False, amount=float(len(loose)))]


def far_tab_findings(paths: Sequence[ContourPath], shape: TabShape, shifts: Sequence[Point]) -> list[Finding]:
    """Return a finding for each place by hand that is far from every path, where it may not be what was meant; on
    copies too.

    The tab is made all the same, on what is nearest, since one too many holds and one too few does not.
    """
    if not shape.tabs.places or not paths:
        return []
    findings = []
    for x, y in shape.tabs.places:
        points = np.array([(x + dx, y + dy) for dx, dy in shifts])
        far = np.min([path.nearest(points)[1] for path in paths], axis=0)
        worst = int(np.argmax(far))
        if far[worst] > _FAR * shape.tool.diameter:
            px, py = points[worst].tolist()
            text = (
                f"The tab by hand at ({px:.3f}, {py:.3f}) is {far[worst]:.1f} mm from the nearest path of "
                f"T{shape.tool.number} {shape.tool.label}; it goes onto that, if it is long enough. Check its place."
            )
            findings.append(Finding(FindingKind.LEFT_OUT, text, px, py, amount=float(far[worst])))
    return findings


def ends_of(runs: Sequence[PathWithLeads], tabs: Sequence[Sequence[float]], shape: TabShape) -> TabEnds:
    """Return the ends of the ways over all tabs, mm along each path."""
    found = [TabEnds(np.zeros((0, 2)), np.zeros((0, _LOOKS, 2)), np.zeros((0, _LOOKS, 2)))]
    for run, places in zip(runs, tabs, strict=True):
        where = np.array(places, dtype=np.float64)
        found.append(shape.ends(run.path, where, shape.halves(run.path, where)))
    return TabEnds(*(np.concatenate(each) for each in zip(*found, strict=True)))


def spans_of(path: ContourPath, places: Sequence[float], shape: TabShape) -> list[tuple[float, float]]:
    """Return (from, to) of tabs along a path, mm; on a closed one they may go past its ends."""
    halves = shape.halves(path, np.array(places, dtype=np.float64)).tolist() if places else []
    spans = [(place - half, place + half) for place, half in zip(places, halves, strict=True)]
    return spans if path.closed else [(max(low, 0.0), min(high, path.length)) for low, high in spans]


def under_tabs(path: ContourPath, where: Floats, spans: Sequence[tuple[float, float]]) -> np.ndarray:
    """Return (m,) whether places along a path are under a tab."""
    found = np.zeros(len(where), np.bool_)
    for low, high in spans:
        found |= (where - low) % path.length < high - low if path.closed else (where >= low) & (where <= high)
    return found
