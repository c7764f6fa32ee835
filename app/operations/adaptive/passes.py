"""Runs as moves, at all depths: down into metal once a part and depth, everything else over clear ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...core.progress import Progress
from ...geometry.primitives import lengths, within_half_turn
from ...model.moves import Purpose
from ...toolpath.build import MovesBuilder, Stroke, StrokeLabel
from ...toolpath.depth import DepthLevels
from ...toolpath.entry.entry import EntryContext, EntryFallbacks, descent
from .path_builder import CutRun
from .plan import ConnectedPath

FASTER = 4.0
"""Times the feed rate at which the cutter goes over clear ground."""

_FASTEST = 5000.0
"""mm/min, and no faster."""

_STOPS = 1.0
"""s that a lift costs beside its length."""

_SEED = 2
"""Rows at the beginning of a part that widen the hole in which the cutter has come down."""

_SAME = 1e-9
"""mm; heights that differ by less are the same."""


def clear_feed(label: StrokeLabel) -> float:
    """Return the feed over clear ground, mm/min."""
    return max(label.feed, min(FASTER * label.feed, _FASTEST))


def farthest(label: StrokeLabel, levels: DepthLevels) -> float:
    """Return how far the cutter goes over clear ground in the time that a lift takes, mm."""
    high = levels.travel - levels.passes[-1]
    return clear_feed(label) * (2 * high / _FASTEST + _STOPS / 60)


@dataclass(eq=False)
class DiscPasses:
    """Cuts parts at all depths.

    Attributes:
        lift: how high the cutter goes over clear ground, mm.
        entries: what is to say of the ways into the metal.
    """

    builder: MovesBuilder
    label: StrokeLabel
    ground: EntryContext
    levels: DepthLevels
    lift: float
    entries: EntryFallbacks = field(default_factory=EntryFallbacks)

    def cut(self, parts: Sequence[ConnectedPath], progress: Progress) -> None:
        """Append parts, each at all depths before the next.

        Raises:
            Cancelled: by progress.
        """
        count = len(parts) * len(self.levels.passes)
        for k, part in enumerate(parts):
            for n, z in enumerate(self.levels.passes):
                progress.step((k * len(self.levels.passes) + n) / count, "Depth passes")
                for run in part.runs:
                    self._run(run, z, part.region, run is part.runs[0])

    def _run(self, run: CutRun, z: float, region: int, into_metal: bool) -> None:
        stroke = Stroke(run.rows, np.where(run.clear, Purpose.LINK, Purpose.POCKET).astype(np.uint8), region)
        if into_metal:
            stroke.purpose[:_SEED] = Purpose.PLUNGE
        x, y = stroke.start
        for height in self.levels.over(x, y):
            self.builder.straight((x, y, height), Purpose.RAPID, self.label)
        if into_metal and self.ground.cleared.floor(self.ground.tool, (x, y)) > z + _SAME:
            self._enter(stroke, z)
        else:
            self._down(x, y, z, z + self.levels.retract, region)
        self.builder.along(stroke, self._heights(run, z), self.label, self._feeds(run, into_metal))
        rows = within_half_turn(run.rows[~run.clear])
        self.ground.cleared.add(self.ground.tool, rows, np.full(len(rows), z))
        x, y, _ = self.builder.at
        self.builder.straight((x, y, self.levels.travel), Purpose.RAPID, self.label)

    def _enter(self, stroke: Stroke, z: float) -> None:
        requested = self.ground.entry.kind
        way = descent(stroke, z, requested, self.ground)
        self.entries.note(requested, way.kind, stroke.start)
        x, y = stroke.start
        if not len(way.heights):
            self._down(x, y, z, way.top + self.levels.retract, stroke.region)
            return
        self._down(x, y, way.top, way.top + self.levels.retract, stroke.region)
        self.builder.ramp(way.path, way.heights, self.label)
        if way.well is not None:
            self.ground.cleared.wells[way.well[0]] = way.well[1]

    def _down(self, x: float, y: float, z: float, slow: float, region: int) -> None:
        """Go straight down: quickly to a height, then at plunge rate."""
        height = self.builder.at[2]
        if height > slow + _SAME and slow > z:
            self.builder.straight((x, y, slow), Purpose.PLUNGE, self.label.fast, region)
        if height > z + _SAME:
            self.builder.straight((x, y, z), Purpose.PLUNGE, self.label, region)

    def _heights(self, run: CutRun, z: float) -> np.ndarray:
        """Return (n,) at which height each row ends: over clear ground lifted, where the first and the last row of the
        way are long enough to rise and to fall.
        """
        heights, size = np.full(len(run.rows), z), lengths(run.rows)
        edge = np.flatnonzero(np.diff(run.clear.astype(np.int8), prepend=0, append=0))
        for first, stop in edge.reshape(-1, 2).tolist():
            if stop - first > 1 and min(size[first], size[stop - 1]) >= self.lift > 0:
                heights[first : stop - 1] = min(z + self.lift, self.levels.retract)
        return heights

    def _feeds(self, run: CutRun, into_metal: bool) -> np.ndarray:
        fast = clear_feed(self.label)
        feeds = np.where(run.clear, fast, np.minimum(run.times * self.label.feed, fast))
        if into_metal:
            feeds[:_SEED] = max(self.label.feed / 2, min(self.label.plunge_rate, self.label.feed))
        return feeds


def nearest_first(parts: Sequence[ConnectedPath], at: tuple[float, float]) -> list[ConnectedPath]:
    """Return parts so that each is the one that begins nearest to where the one before it ends."""
    left, order = list(parts), []
    while left:
        part = min(left, key=lambda each: math.dist(at, each.runs[0].rows[0, :2]))
        left.remove(part)
        order.append(part)
        x, y = part.runs[-1].rows[-1, 2:4].tolist()
        at = (x, y)
    return order
