"""Depth passes: every stroke at one height after the other, with the tool kept down where that is quicker than to lift
it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...geometry.distance import DistanceField
from ...model.entry import EntryKind
from ...model.moves import Purpose
from ..build import MovesBuilder, Stroke, StrokeLabel, merged
from ..entry.entry import Descent, EntryContext, descent
from ..entry.entry_findings import EntryFallbacks
from ..entry.hole import DrilledHole, from_hole, in_hole
from ..entry.links import PassLink, way_back, way_straight
from ..entry.side_entry import from_cleared

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
        self.builder.straight((x, y, self.levels.travel), Purpose.RAPID, self.label)
        if self.levels.retract < self.levels.travel and not self._beside_clamp(x, y):
            self.builder.straight((x, y, self.levels.retract), Purpose.RAPID, self.label)

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

    def _beside_clamp(self, x: float, y: float) -> bool:
        clamps, wide = self.levels.clamps, self.levels.wide
        return clamps is not None and float(clamps.nearest(np.array([[x, y]]))[0][0]) <= wide
