"""Depth passes: every stroke at one height after the other, with the tool kept down where that is quicker than to lift
it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..geometry.distance import DistanceField
from ..geometry.primitives import fraction_on, point_on
from ..model.curves import Point
from ..model.entry import EntryKind
from ..model.moves import Moves, Purpose
from ..model.tool import Tool
from .build import MovesBuilder, Stroke, StrokeLabel, merged
from .entry.entry import (
    Descent,
    EntryContext,
    EntryFallbacks,
    PassLink,
    descent,
    keeps_off_walls,
    way_back,
    way_straight,
)
from .linking.bridge import fraction_at

_SAME = 1e-9
"""mm; heights and places that differ by less are one."""


def pass_heights(depth: float, stepdown: float, finish: float = 0.0) -> tuple[float, ...]:
    """Return the heights of equal depth passes, mm, from the top down, the last one at -depth.

    Args:
        depth: mm, > 0.
        stepdown: largest depth of one pass, mm, > 0.
        finish: thickness of a last pass of its own, mm, in [0, depth); 0 = none.
    """
    rough = depth - finish
    count = max(1, math.ceil(rough / stepdown - 1e-9))
    return (*(-rough * k / count for k in range(1, count + 1)), *((-depth,) if finish > 0 else ()))


@dataclass(frozen=True, eq=False)
class DepthLevels:
    """Heights that an operation goes at, mm.

    Attributes:
        passes: of its cuts, from the top down.
        travel: at which the tool is clear of everything.
        retract: from which it goes down slowly.
        clamps: distances from what stands up to below `travel`; None = nothing does.
        wide: so near to these may the tool not be where it comes down quickly, mm.
    """

    passes: tuple[float, ...]
    travel: float
    retract: float
    clamps: DistanceField | None = None
    wide: float = 0.0

    def over(self, x: float, y: float) -> tuple[float, ...]:
        """Return the heights at which the tool comes over a place, one after the other: beside a clamp it does not come
        down quickly.
        """
        near = self.clamps is not None and float(self.clamps.nearest(np.array([[x, y]]))[0][0]) <= self.wide
        return (self.travel,) if near or self.retract >= self.travel else (self.travel, self.retract)


@dataclass(eq=False)
class DepthPasses:
    """Cuts strokes of one operation at all its depths.

    Attributes:
        holes: that the tool may go straight down in.
        entries: what is to say of the ways into the metal.
    """

    builder: MovesBuilder
    label: StrokeLabel
    ground: EntryContext
    levels: DepthLevels
    holes: Sequence[DrilledHole] = ()
    entries: EntryFallbacks = field(default_factory=EntryFallbacks)
    _last: tuple[Stroke, float] | None = None
    """What was cut last, and at which height, while the tool is still where it ended."""
    _slotted: set[int] = field(default_factory=set)
    """Strokes of the group that have no cut ground beside them; as they go deeper they will have none either."""

    def cut(self, groups: Sequence[Sequence[Stroke]], progress: Progress = NO_PROGRESS) -> None:
        """Append groups of strokes, each group at all depths before the next, its strokes one after the other at each.

        Raises:
            Cancelled: by progress.
        """
        for k, group in enumerate(groups):
            strokes = [from_hole(stroke, self.holes, self.ground) for stroke in group]
            self._cut_group(strokes, progress.part(k / len(groups), (k + 1) / len(groups)))
        self._lift()

    def _cut_group(self, strokes: list[Stroke], progress: Progress) -> None:
        ready: dict[int, Stroke] = {}
        self._slotted.clear()
        count = len(self.levels.passes) * len(strokes)
        for done, z in enumerate(self.levels.passes):
            for k, stroke in enumerate(strokes):
                progress.step((done * len(strokes) + k) / count, "Depth passes")
                if stroke.at_floor and z != self.levels.passes[-1]:
                    continue
                begun = self._enter(stroke, z)
                if k not in ready or begun is not stroke:
                    strokes[k], ready[k] = begun, merged(begun)
                self.builder.cut(ready[k], z, self.label)
                self.ground.cleared.add(self.ground.tool, begun.rows, begun.heights(z))
                self._last = begun, z

    def _enter(self, stroke: Stroke, z: float) -> Stroke:
        """Bring the tool to where a stroke begins, down to its height there; return the stroke as it is to be cut from
        there.
        """
        first = stroke.begins_at(z)
        drilled = in_hole(stroke.start, self.holes)
        if not drilled and id(stroke) not in self._slotted and self._floor(stroke) > first + _SAME:
            beside = from_cleared(stroke, first, self.ground)
            if beside is stroke:
                self._slotted.add(id(stroke))
            else:
                self._come_to(beside)
                self._go_to_height(beside, first, first + self.levels.retract)
                self.builder.cut(beside.part(0, 1), first, self.label)
                self.ground.cleared.add(self.ground.tool, beside.rows[:1], np.array([first]))
                return stroke
        self._come_to(stroke)
        if self._floor(stroke) <= first + _SAME:
            self._go_to_height(stroke, first, first + self.levels.retract)
            return stroke
        requested = self.ground.entry.kind
        found = descent(stroke, first, EntryKind.PLUNGE if drilled else requested, self.ground)
        self.entries.note(requested, requested if drilled else found.kind, stroke.start)
        self._descend(found, first)
        return found.stroke

    def _descend(self, way: Descent, z: float) -> None:
        retract = self.levels.retract
        if not len(way.heights):
            self._go_to_height(way.stroke, z, way.top + retract)
            return
        self._go_to_height(way.path, way.top, way.top + retract)
        self.builder.ramp(way.path, way.heights, self.label)
        if way.well is not None:
            self.ground.cleared.wells[way.well.disc] = way.well.floor

    def _floor(self, stroke: Stroke) -> float:
        """Return down to which height the ground is cut where a stroke begins, mm."""
        return self.ground.cleared.floor(self.ground.tool, stroke.start)

    def _go_to_height(self, stroke: Stroke, z: float, slow: float) -> None:
        """Go straight to a height over a stroke's beginning: up quickly; down at feed rate to `slow`, then at plunge
        rate.
        """
        x, y = stroke.start
        height = self.builder.at[2]
        if height < z - _SAME:
            self.builder.straight((x, y, z), Purpose.RAPID, self.label)
            return
        if height > slow + _SAME and slow > z:
            self.builder.straight((x, y, slow), Purpose.PLUNGE, self.label.fast, stroke.region)
        if height > z + _SAME:
            self.builder.straight((x, y, z), Purpose.PLUNGE, self.label, stroke.region)

    def _come_to(self, stroke: Stroke) -> None:
        """Bring the tool over a stroke's beginning: along the ground where there is a way that is quicker, else through
        the air.
        """
        if self._last is not None:
            ways = self._ways_to(stroke, *self._last)
            for way in ways:
                self._follow(way)
            if ways:
                return
            self._lift()
        x, y = stroke.start
        for height in self.levels.over(x, y):
            self.builder.straight((x, y, height), Purpose.RAPID, self.label)

    def _ways_to(self, stroke: Stroke, last: Stroke, z: float) -> tuple[PassLink, ...]:
        """Return the ways one after the other: straight, or first back along what was cut last; none where the air is
        quicker.
        """
        x, y, height = self.builder.at
        if math.dist((x, y), stroke.start) < _SAME:
            return (PassLink(stroke.part(0, 0), height),)
        air = (self.levels.travel, self.levels.retract)
        straight = way_straight(stroke, (x, y, height), air, self.ground, self.label.feed)
        if straight is not None:
            return (straight,)
        again = math.dist(last.start, stroke.start) < _SAME
        on = None
        if not again:  # asked before the way back, which takes longer to make: mostly the next stroke is far off
            here = (*last.start, last.begins_at(z))
            on = way_straight(stroke, here, air, self.ground, self.label.feed)
        along = (again or on is not None) and not self.ground.worn
        back = way_back(last, z, air, self.label.feed) if along else None
        if back is None:
            return ()
        return (back,) if on is None else (back, on)

    def _follow(self, way: PassLink) -> None:
        x, y, height = self.builder.at
        if way.height > height + _SAME:
            self.builder.straight((x, y, way.height), Purpose.RAPID, self.label)
        if len(way.path.rows):
            self.builder.cut(merged(way.path), way.height, self.label)

    def _lift(self) -> None:
        if self._last is not None:
            x, y, _ = self.builder.at
            self.builder.straight((x, y, self.levels.travel), Purpose.RAPID, self.label)
            self._last = None


# Entries through holes that were drilled before.


_WIDE = 0.5
"""Of the cutter's diameter that a hole must be wide at least: its centre, which cuts badly, meets no metal then."""

_FAR = 10.0
"""Cutter's diameters from a hole to where a path begins at most."""

_TRIED = 8
"""Holes that are tried for one path."""

_NEAR = 1e-6
"""mm; holes and heights that differ by no more are alike."""


@dataclass(frozen=True, slots=True)
class DrilledHole:
    """A drilled hole: its centre and radius, and the height of the drill's tip at its bottom, mm."""

    x: float
    y: float
    radius: float
    bottom: float

    @property
    def place(self) -> Point:
        """Its centre, mm."""
        return self.x, self.y


def drilled(moves: Moves, tools: Mapping[int, Tool]) -> tuple[DrilledHole, ...]:
    """Return the holes that moves drill."""
    deepest: dict[tuple[float, float, int], float] = {}
    for k in np.flatnonzero(moves.purpose == Purpose.DRILL).tolist():
        x, y, z = moves.end[k].tolist()
        place = (x, y, int(moves.tool[k]))
        deepest[place] = min(deepest.get(place, math.inf), z)
    return tuple(DrilledHole(x, y, tools[tool].radius, z) for (x, y, tool), z in deepest.items() if z < 0)


def usable(holes: Sequence[DrilledHole], ground: EntryContext, floor: float) -> tuple[DrilledHole, ...]:
    """Return the holes that a cutter can go straight down in to a height, mm."""
    return tuple(
        hole for hole in holes if hole.radius >= _WIDE * ground.tool.radius - _NEAR and hole.bottom <= floor + _NEAR
    )


def from_hole(stroke: Stroke, holes: Sequence[DrilledHole], ground: EntryContext) -> Stroke:
    """Return a stroke that begins in a hole and goes straight to where it began before, or the stroke itself where that
    cannot be.
    """
    if not holes:
        return stroke
    places = np.array([hole.place for hole in holes])
    loop = stroke.closed and stroke.least_z is None and not np.any(stroke.purpose == Purpose.LEAD)
    if loop:
        away, row = DistanceField.of(stroke.rows).nearest(places)
    else:
        away, row = np.hypot(*(places - np.array(stroke.start)).T), np.zeros(len(places), np.int64)
    for k in np.argsort(away, kind="stable")[:_TRIED].tolist():
        if away[k] > _FAR * ground.tool.diameter:
            break
        begun = stroke
        if loop:
            before, after = stroke.split(int(row[k]), fraction_at(stroke.rows[row[k]], places[k]))
            begun = after.and_then(before)
        if away[k] < _NEAR:
            return begun
        if ground.beside and keeps_off_walls(holes[k].place, begun.start, ground):
            slot = replace(
                begun,
                rows=np.array([[*holes[k].place, *begun.start, 0.0, 0.0, 0.0, 0.0]]),
                purpose=np.array([Purpose.LINK], np.uint8),
                least_z=None,
            )
            return slot.and_then(begun)
    return stroke


def in_hole(place: Point, holes: Sequence[DrilledHole]) -> bool:
    """Tell whether a place is the centre of a hole."""
    return any(math.dist(place, hole.place) < _NEAR for hole in holes)


# Entries from the side: straight down on ground that is cut as deep near a path's beginning, and on to it from there.


_AWAY = (0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0)
"""Distances from the beginning that are tried, in cutter's radii."""

_DIRECTIONS = 8
"""Directions round the beginning in which one is tried."""

_AROUND = [
    (part, math.cos(angle), math.sin(angle))
    for part in _AWAY
    for angle in (math.tau * k / _DIRECTIONS for k in range(_DIRECTIONS))
]
"""A distance and a direction (x, y) each: the same round every beginning."""


def from_cleared(stroke: Stroke, z: float, ground: EntryContext) -> Stroke:
    """Return a stroke that begins on ground cut down to z near by and goes straight to where it began before.

    The stroke itself where there is no such ground, or a wall is in the way.
    """
    if not ground.beside:
        return stroke
    start = stroke.start
    places = _places(start, z, ground)
    for k in ground.cleared.clear_places(ground.tool, places, z):
        place = places[k]
        if keeps_off_walls(place, start, ground):
            row = np.array([[*place, *start, 0.0, 0.0, 0.0, 0.0]])
            way = replace(stroke, rows=row, purpose=np.array([Purpose.LINK], np.uint8), least_z=None)
            return way.and_then(stroke)
    return stroke


def _places(start: Point, z: float, ground: EntryContext) -> list[Point]:
    """Return places round a path's beginning, the nearest first, and the nearest one of all that were cut along; none
    if all are far.
    """
    radius = ground.tool.radius
    gap, row = ground.cleared.nearest(start, z)
    if row is None or gap > (_AWAY[-1] - 1) * radius:
        return []
    x, y = start
    places = [(x + part * radius * cos, y + part * radius * sin) for part, cos, sin in _AROUND]
    nearest = row.tolist()
    return sorted([*places, point_on(nearest, fraction_on(nearest, start))], key=lambda place: math.dist(place, start))
