"""What of the walls a cutter's rim does not touch: inner corners, and places that are too narrow for it.

A cutter that follows a ring touches the wall at the foot of each of its places: as far to the right of travel as the
ring is from the walls. What of the walls no foot covers is a gap. Where the ring turns at one place from before a gap
to behind it, and the wall between turns no more than the ring does, the gap is an inner corner; every other one is a
place where the cutter does not fit in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import shapely

from ...geometry.distance import DistanceField
from ...geometry.near_points import all_within, places_of_each
from ...geometry.offset.offset import OffsetLevel
from ...geometry.outlines import Outlines
from ...geometry.primitives import (
    TURN,
    Indices,
    Rows,
    boxes,
    contour_rows,
    lengths,
    path_length,
    points_at,
    sample,
    sweeps,
)
from ...model.finding import Finding, FindingKind
from ...model.part import Contour, Region
from ...model.tool import Tool
from ...toolpath.coverage.areas import region_shapes
from ...toolpath.leads.contour_path import ContourPath, Floats, fractions_at, headings_at, left_of
from ...toolpath.machining_areas import MachiningArea
from ...toolpath.narrow_regions import ToolRoom

_LEAST = 1e-3
"""mm; shorter gaps are the paths' own error."""

_JUMP = 1e-4
"""mm between the feet before and after a joint that is a corner."""

_SAME = 2e-3
"""mm between a foot and the end of the gap that it stands at."""

_EXCESS = 0.6
"""Radians by which the walls of a corner may turn more than the ring does that touches both: they may be round towards
the cutter.
"""

_BOTTOM = 2.1
"""Radians; walls that turn more than this in more than one place face each other: what lies between is the bottom of a
slot.
"""

_BESIDE = 0.35
"""Radians by which the walls beside a sharp corner may turn."""


@dataclass(frozen=True, eq=False)
class WallGap:
    """A run of wall that the cutter does not touch, in the wall's direction: the area to machine on its left.

    Attributes:
        rows: (m, 8) the wall, cut to the gap.
        walls: indices of these rows among the area's.
        region: number of its region.
        bare: True when it begins or ends at a clamp or the frame.
        left: (k,) by how much the wall turns left at each of its joints and in each of its arcs, radians; right turns
            are left out.
        corner: (x, y) where the centre of the cutter turns that touches the wall before and behind it; None where there
            is none.
        excess: by how much more the wall turns left than the ring does there, radians; inf where there is no such
            place.
        turn: of the ring there, radians, in [0, pi].
    """

    rows: Rows
    walls: tuple[int, ...]
    region: int
    bare: bool
    left: Floats
    corner: tuple[float, float] | None = None
    excess: float = np.inf
    turn: float = 0.0

    @property
    def length(self) -> float:
        """Of the wall, mm."""
        return path_length(self.rows)

    @property
    def is_corner(self) -> bool:
        """True of inner corners; elsewhere the cutter does not fit in.

        A corner may be sharp or made by an arc or a chamfer, but not the bottom of a slot, whose walls face each other.
        """
        if self.corner is None or self.bare or self.excess > _EXCESS:
            return False
        return bool(self.left.sum() <= _BOTTOM or self.left.max() >= self.left.sum() - _BESIDE)


def gaps(level: OffsetLevel, area: MachiningArea) -> list[WallGap]:
    """Return all gaps in the walls of regions that a level's rings are in; clamps and the frame are no walls."""
    if not level.rings:
        return []
    known = {ring.region for ring in level.rings}
    spans = _covered(level, area)
    chains = _chains(_uncovered(spans, area, known), area)
    return _with_corners(_made(chains, area), level) if chains else []


def feet(rows: Rows, fraction: float, distance: float) -> Floats:
    """Return where a cutter touches the wall (n, 2) at a fraction of each row of a ring."""
    part = np.full(len(rows), fraction)
    touched: Floats = points_at(rows, part) - distance * left_of(headings_at(rows, part))
    return touched


class _WallSpans(NamedTuple):
    """Parts of rows of walls, sorted by both: the row, and from where to where, in [0, 1] along it."""

    row: Indices
    low: Floats
    high: Floats


class _WallPart(NamedTuple):
    """A part of a row of a wall, from where to where, in [0, 1] along it."""

    row: int
    low: float
    high: float


class _RingJoints(NamedTuple):
    """Joints at the ends of rows: where the cutter touches before and behind, the place, the left turn, radians."""

    before: Floats
    behind: Floats
    place: Floats
    turn: Floats


def _covered(level: OffsetLevel, area: MachiningArea) -> _WallSpans:
    """Return what each row of a level's rings covers of the walls."""
    rings, distance = np.concatenate([ring.rows for ring in level.rings]), level.distance
    region = np.repeat([ring.region for ring in level.rings], [len(ring.rows) for ring in level.rings])
    walls = area.distances.rows
    row = _touched(feet(rings, 0.5, distance), region, area)
    a, b = (fractions_at(walls[row], feet(rings, part, distance)) for part in (0.0, 1.0))
    low, high = np.minimum(a, b), np.maximum(a, b)
    order = np.lexsort((low, row))
    return _WallSpans(row[order], low[order], high[order])


def _touched(points: Floats, region: Indices, area: MachiningArea) -> Indices:
    """Return the wall row (n,) that each point lies on: where walls of two regions lie on each other, that of its own
    region.
    """
    row: Indices = area.distances.nearest(points)[1].copy()
    owner = area.primitives.region
    strange = np.flatnonzero(owner[row] != region)
    numbers = np.unique(region[strange])
    asking = (strange[each] for each in places_of_each(region[strange], numbers))
    for own, requested in zip(places_of_each(owner, numbers), asking, strict=True):
        if len(own):
            off, which = DistanceField.of(area.distances.rows[own]).nearest(points[requested])[:2]
            row[requested[off < _SAME]] = own[which[off < _SAME]]
    return row


def _uncovered(spans: _WallSpans, area: MachiningArea, known: set[int]) -> dict[int, list[tuple[float, float]]]:
    """Return for each row of the walls of some regions the parts of it that no span covers."""
    row, low, high = spans
    size = lengths(area.distances.rows)
    bounds = np.searchsorted(row, np.arange(len(size) + 1))
    found: dict[int, list[tuple[float, float]]] = {}
    for k in np.flatnonzero(~area.bare & np.isin(area.primitives.region, list(known))).tolist():
        least, at, free = _LEAST / max(size[k], 1e-300), 0.0, []
        for j in range(bounds[k], bounds[k + 1]):
            if low[j] - at > least:
                free.append((at, float(low[j])))
            at = max(at, float(high[j]))
        if 1 - at > least or at == 0.0:
            free.append((at, 1.0))
        if free:
            found[k] = free
    return found


def _chains(free: dict[int, list[tuple[float, float]]], area: MachiningArea) -> list[list[_WallPart]]:
    """Return runs that go on from row to row of the walls.

    Args:
        free: of each row its parts, from and to, as fractions.
    """
    walls = _FreeWalls(free, area.primitives.previous)
    chains = []
    for row, parts in free.items():
        for k in range(len(parts)):
            if k or not walls.goes_on_into(row):
                chains.append(walls.chain_from(row, k))
    for row in free:  # what is left are whole contours
        if row not in walls.used and walls.begins(row):
            chains.append(walls.chain_from(row, 0))
    return chains


class _FreeWalls:
    """Free parts of walls, and which of them have their place in a chain.

    Attributes:
        used: rows whose first part has its place.
    """

    def __init__(self, free: dict[int, list[tuple[float, float]]], previous: Indices) -> None:
        self.used: set[int] = set()
        self._free, self._previous = free, previous
        self._following = np.empty(len(previous), np.int64)
        self._following[previous] = np.arange(len(previous))

    def begins(self, row: int) -> bool:
        """Tell whether a row is free where it begins."""
        return row in self._free and self._free[row][0][0] == 0.0

    def goes_on_into(self, row: int) -> bool:
        """Tell whether the row before one is free up to its end, and this one from there on."""
        before = int(self._previous[row])
        return self.begins(row) and before in self._free and self._free[before][-1][1] == 1.0

    def chain_from(self, row: int, part: int) -> list[_WallPart]:
        """Return the run that begins with a part of a row, up to where a wall is not free."""
        if part == 0:
            self.used.add(row)
        chain = [_WallPart(row, *self._free[row][part])]
        while part == len(self._free[row]) - 1:
            row, part = int(self._following[row]), 0
            if not self.goes_on_into(row) or row in self.used:
                break
            self.used.add(row)
            chain.append(_WallPart(row, *self._free[row][0]))
        return chain


def _made(chains: Sequence[Sequence[_WallPart]], area: MachiningArea) -> list[WallGap]:
    """Return the gap that each run of parts of walls is, of those that are long enough."""
    parts = np.array([part for chain in chains for part in chain])
    first = np.append(0, np.cumsum([len(chain) for chain in chains]))
    walls, low, high = parts[:, 0].astype(np.int64), parts[:, 1], parts[:, 2]
    rows = area.distances.rows[walls]
    end = np.where((high == 1.0)[:, None], rows[:, 2:4], points_at(rows, high))
    rows[:, :2], rows[:, 2:4] = points_at(rows, low), end
    following = np.empty(len(area.primitives.previous), np.int64)
    following[area.primitives.previous] = np.arange(len(following))
    bare = (low == 0.0) & area.bare[area.primitives.previous[walls]], (high == 1.0) & area.bare[following[walls]]
    joints = np.maximum(_turns(rows[:-1], rows[1:]), 0.0)
    bends = np.where(rows[:, TURN] > 0, sweeps(rows), 0.0)
    long = np.add.reduceat(lengths(rows), first[:-1]) > _LEAST
    return [
        WallGap(
            rows[a:b],
            tuple(walls[a:b].tolist()),
            int(area.primitives.region[walls[b - 1]]),
            bool(bare[0][a] or bare[1][b - 1]),
            np.concatenate([joints[a : b - 1], bends[a:b]]),
        )
        for a, b in zip(first[:-1][long].tolist(), first[1:][long].tolist(), strict=True)
    ]


def _with_corners(found: Sequence[WallGap], level: OffsetLevel) -> list[WallGap]:
    """Return the gaps, each with the place where a ring turns from before it to behind it."""
    before, behind, joints, turn = _joints(Outlines.joined([ring.rows for ring in level.rings]), level.distance)
    jump = np.hypot(*(before - behind).T) > _JUMP
    if not jump.any() or not found:
        return list(found)
    before, behind, joints, turn = before[jump], behind[jump], joints[jump], turn[jump]
    ends = np.array([[*gap.rows[0, :2], *gap.rows[-1, 2:4]] for gap in found])
    corners = np.hstack([before, behind])
    place, corner_at = all_within(corners, ends, _SAME)
    off = np.hypot.reduce(corners[corner_at] - ends[place], axis=1)
    order = np.lexsort((off, place))[::-1]
    nearest = dict(zip(place[order].tolist(), corner_at[order].tolist(), strict=True))  # of several the last one stays
    result = []
    for number, gap in enumerate(found):
        if number not in nearest:
            result.append(gap)
            continue
        k = nearest[number]
        corner = float(joints[k, 0]), float(joints[k, 1])
        excess = float(gap.left.sum()) - float(turn[k])
        result.append(replace(gap, corner=corner, excess=excess, turn=float(turn[k])))
    return result


def _joints(rings: Outlines, distance: float) -> _RingJoints:
    """Return the joints of some rings."""
    rows = rings.rows
    after = rows[rings.following]
    turn = np.maximum(_turns(rows, after), 0.0)
    return _RingJoints(feet(rows, 1.0, distance), feet(after, 0.0, distance), rows[:, 2:4], turn)


def _turns(before: Rows, behind: Rows) -> Floats:
    """Return by how much (n,) a path turns left from the end of each row to the beginning of the one behind it,
    radians.
    """
    ahead, onward = headings_at(before, np.ones(len(before))), headings_at(behind, np.zeros(len(behind)))
    turn: Floats = np.arctan2(ahead[:, 0] * onward[:, 1] - ahead[:, 1] * onward[:, 0], (ahead * onward).sum(axis=1))
    return turn


# Where a cutter does not fit along the walls that it should follow: gaps, slots and necks that are too narrow, and
# clamps.


_DEPTH = 0.01
"""mm; a place that is no deeper than this beyond the cutter's rim is no slot."""

_TELL = 50
"""Places that are told one by one; the rest is counted."""

_PARTS = np.linspace(0.25, 0.75, 5)
"""Of a wall that is not reached: where it is measured how wide the place is."""

_CORNER = 0.1
"""Of the cutter's distance; a disc smaller than this is in a corner."""

_TOUCH = 1e-3
"""mm; a wall this near to a disc's rim is touched by it."""

_CHORD = 1e-2
"""mm; only how much of the walls clamps lie over depends on it."""


@dataclass(frozen=True)
class NarrowPlace:
    """A place that is too narrow for a cutter.

    Attributes:
        x, y: its middle, mm.
        width: of what would fit, about, mm.
        gap: the wall that is not reached.
        clamped: True when a clamp makes it so narrow.
    """

    x: float
    y: float
    width: float
    gap: WallGap
    clamped: bool


def narrow_places(found: Sequence[WallGap], area: MachiningArea, distance: float) -> list[NarrowPlace]:
    """Return the places where a cutter whose centre keeps `distance` mm from the walls does not fit in; inner corners
    are none.

    Walls that face each other are one place.
    """
    bare = DistanceField.of(area.distances.rows[area.bare]) if area.bare.any() else None
    tight = [gap for gap in found if not gap.is_corner and not _is_shallow(gap, distance)]
    places = []
    for gap, (x, y, radius) in zip(tight, _free_discs(tight, area.distances, distance), strict=True):
        if radius > distance - _TOUCH:  # as wide as the cutter, which so has been there
            continue
        clamped = gap.bare or (bare is not None and float(bare.nearest(np.array([[x, y]]))[0][0]) <= radius + _TOUCH)
        places.append(NarrowPlace(x, y, 2 * radius, gap, clamped))
    return _once(places)


def _is_shallow(gap: WallGap, distance: float) -> bool:
    if gap.corner is None:
        return False
    points = np.concatenate(
        [gap.rows[:, :2], ContourPath(gap.rows, closed=False).points(np.linspace(0, gap.length, 17))]
    )
    return float(np.hypot(*(points - np.array(gap.corner)).T).max()) - distance < _DEPTH


def _free_discs(found: Sequence[WallGap], field: DistanceField, most: float) -> list[tuple[float, float, float]]:
    """Return for each gap (x, y, radius) of a disc that touches its wall in its middle half: the largest, of necks the
    smallest.
    """
    if not found:
        return []
    paths = [ContourPath(gap.rows, closed=False) for gap in found]
    parts = [_PARTS * path.length for path in paths]
    points = np.concatenate([path.points(where) for path, where in zip(paths, parts, strict=True)])
    aside = left_of(np.concatenate([path.headings(where) for path, where in zip(paths, parts, strict=True)]))
    low, high = np.zeros(len(points)), np.full(len(points), most)
    for _ in range(30):
        radius = (low + high) / 2
        fits = field.nearest(points + aside * radius[:, None])[0] >= radius - 1e-6
        low, high = np.where(fits, radius, low), np.where(fits, high, radius)
    size = low.reshape(len(found), -1) - 1e-6 * np.abs(_PARTS - 0.5)  # of as large ones the one in the middle
    # a neck is as wide as it is at its narrowest; corners are no part of it
    open_ended = np.array([[gap.corner is None] for gap in found])
    size = np.where(
        open_ended & (size > _CORNER * most), -size - 2e-6 * np.abs(_PARTS - 0.5), np.where(open_ended, -np.inf, size)
    )
    best = np.argmax(size, axis=1)
    chosen = np.arange(len(found)) * len(_PARTS) + best
    centres = points[chosen] + aside[chosen] * low[chosen, None]
    return [(float(x), float(y), float(radius)) for (x, y), radius in zip(centres, low[chosen], strict=True)]


def _once(places: Sequence[NarrowPlace]) -> list[NarrowPlace]:
    """Return the places without those that are another one seen from the wall that faces it."""
    if len(places) < 2:
        return list(places)
    owner = np.repeat(np.arange(len(places)), [len(place.gap.rows) for place in places])
    rows = np.concatenate([place.gap.rows for place in places])
    around = shapely.STRtree(shapely.box(*boxes(rows).T))
    kept: dict[int, NarrowPlace] = {}
    for k, place in enumerate(places):
        reach = place.width / 2 + _TOUCH
        near = around.query(shapely.box(place.x - reach, place.y - reach, place.x + reach, place.y + reach))
        near = near[np.isin(owner[near], list(kept))]
        if not len(near) or DistanceField.of(rows[near]).nearest(np.array([[place.x, place.y]]))[0][0] > reach:
            kept[k] = place
    return list(kept.values())


def narrow_place_findings(places: Sequence[NarrowPlace], tool: Tool, distance: float, counts: bool) -> list[Finding]:
    """Return a finding for each place that is too narrow for a cutter.

    Args:
        distance: of the cutter's centre from the walls, mm.
        counts: True when nothing else tells of the metal that is left.
    """
    need = ToolRoom(tool, 2 * distance).text
    own = [place for place in places if not place.clamped]
    findings = []
    for place in own[:_TELL]:
        text = (
            f"Region {place.gap.region} has a {'neck' if place.gap.corner is None else 'slot'} at ({place.x:.3f}, "
            f"{place.y:.3f}), about {place.width:.3f} mm wide; {need}. {place.gap.length:.2f} mm of wall are not "
            "reached."
        )
        findings.append(Finding(FindingKind.NECK_TOO_NARROW, text, place.x, place.y, counts, amount=place.width))
    if len(own) > _TELL:
        more = (
            "1 more place along the walls is"
            if len(own) == _TELL + 1
            else f"{len(own) - _TELL} more places along the walls are"
        )
        findings.append(
            Finding(
                FindingKind.NECK_TOO_NARROW,
                f"{more} too narrow; {need}.",
                own[_TELL].x,
                own[_TELL].y,
                counts,
                amount=float(len(own) - _TELL),
            )
        )
    return findings


def clamp_findings(
    places: Sequence[NarrowPlace], walls: Sequence[Contour], clamps: Sequence[Region], tool: Tool
) -> list[Finding]:
    """Return a finding for each clamp that keeps a cutter off walls: those that it lies over, and those beside it that
    are not reached.

    Args:
        walls: contours as they are drawn.
    """
    if not clamps:
        return []
    shapes = [shapely.union_all(region_shapes([clamp], _CHORD)) for clamp in clamps]
    lost = [_under(shape, walls) for shape in shapes]
    for place in places:
        if place.clamped:
            k = int(np.argmin([shapely.distance(shape, shapely.Point(place.x, place.y)) for shape in shapes]))
            length, at = lost[k]
            lost[k] = length + place.gap.length, at or (place.x, place.y)
    return [
        Finding(
            FindingKind.LEFT_OUT,
            f"A keep-out area at ({at[0]:.3f}, {at[1]:.3f}) keeps T{tool.number} {tool.label} off about "
            f"{length:.2f} mm of the walls; move the clamp and cut the rest.",
            *at,
            amount=length,
        )
        for length, at in lost
        if at is not None and length > _DEPTH
    ]


def _under(shape: shapely.Geometry, walls: Sequence[Contour]) -> tuple[float, tuple[float, float] | None]:
    """Return (mm of walls under a clamp, a place of them)."""
    shapely.prepare(shape)
    lines = [shapely.LineString(points) for points in map(_closed_points, walls) if len(points) > 1]
    parts = [part for part in shapely.intersection(np.array(lines, dtype=object), shape) if shapely.length(part) > 0]
    if not parts:
        return 0.0, None
    place = shapely.line_interpolate_point(
        shapely.get_parts(shapely.line_merge(max(parts, key=shapely.length)))[0], 0.5, normalized=True
    )
    return float(sum(shapely.length(part) for part in parts)), (float(place.x), float(place.y))


def _closed_points(contour: Contour) -> Floats:
    rows = contour_rows(contour)
    return np.concatenate([sample(rows, _CHORD), rows[-1:, 2:4]])
