"""Programs along time: when each motion is done, where the tool is meanwhile, and how much metal it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...gcode.timing.duration import Duration
from ...model.motion import Floats, Motions
from ...model.motion_part import place_on
from ...model.motion_path import lengths

Ints = NDArray[np.int32]


@dataclass(frozen=True, slots=True)
class TimelinePlace:
    """A place on the way.

    Attributes:
        motion: how many motions are done. fraction: how much of the next one, in [0, 1).
    """

    motion: int
    fraction: float = 0.0


@dataclass(frozen=True, eq=False)
class TimelineColumns:
    """A timeline in columns, as it is plotted.

    Attributes:
        mean, most: (columns,) cross-section of the cut, mm²: metal taken by length gone, in the mean and of the motion
            with the most.
        removed: (columns + 1,) metal taken so far at the columns' borders, mm³.
    """

    mean: Floats
    most: Floats
    removed: Floats


@dataclass(frozen=True, eq=False)
class Timeline:
    """n motions of programs that are run one after the other.

    Attributes:
        programs: their motions. first: (programs + 1,) where those of each begin.
        begins, ends: (n,) s from the start; in the gaps between them the control waits: dwells, tool changes.
        total: s until the last program has ended.
        tool, line: (n,) T number, and 1-based line in its own file.
        length: (n,) mm. volume: (n,) mm³ that each takes; empty if nobody knows.
        nowhere: (n,) whether each ends at a place that nobody knows, such as one of the machine.
    """

    programs: tuple[Motions, ...]
    first: NDArray[np.int64]
    begins: Floats
    ends: Floats
    total: float
    tool: Ints
    line: Ints
    length: Floats
    volume: Floats
    nowhere: NDArray[np.bool_]

    @staticmethod
    def of(
        programs: Sequence[Motions], times: Sequence[Duration], tool: Ints, volume: Floats, nowhere: NDArray[np.bool_]
    ) -> Timeline:
        """Return the timeline of programs.

        Args:
            programs: motions of each, anchored. times: how long each takes.
            tool: (n,) T number of each motion of all programs. volume: (n,) mm³, or empty. nowhere: (n,) see above.
        """
        starts = np.cumsum([0.0, *(each.total for each in times)])
        ends = np.concatenate([start + each.ends for start, each in zip(starts, times, strict=False)])
        moving = np.concatenate([each.moving for each in times])
        line = np.concatenate([motions.line for motions in programs])
        first = np.cumsum([0, *(len(motions) for motions in programs)])
        return Timeline(
            programs=tuple(programs),
            first=first,
            begins=ends - moving,
            ends=ends,
            total=float(starts[-1]),
            tool=tool,
            line=line,
            length=np.concatenate([lengths(motions) for motions in programs]),
            volume=volume,
            nowhere=nowhere,
        )

    def __len__(self) -> int:
        return len(self.ends)

    @property
    def last(self) -> TimelinePlace:
        """When all motions are done."""
        return TimelinePlace(len(self))

    def at(self, time: float) -> TimelinePlace:
        """Return the moment at a time, s; while the control waits nothing changes. Within a motion time and way go
        alike.
        """
        motion = int(np.searchsorted(self.ends, time, "right"))
        if motion >= len(self):
            return self.last
        begin, end = float(self.begins[motion]), float(self.ends[motion])
        return TimelinePlace(motion, max(time - begin, 0.0) / (end - begin) if end > begin else 0.0)

    def wait_at(self, time: float) -> float:
        """Return how long the control waits in all where it waits at a time, s; 0 where it moves."""
        row = int(np.searchsorted(self.ends, time, "right"))
        begin = float(self.ends[row - 1]) if row else 0.0
        end = float(self.begins[row]) if row < len(self) else self.total
        return end - begin if begin <= time < end else 0.0

    def at_share(self, share: float) -> TimelinePlace:
        """Return the moment when a share of the time is gone in which anything moves."""
        moving = self._moving
        if not len(moving) or share >= 1.0:
            return self.last
        gone = share * float(moving[-1])
        row = int(np.searchsorted(moving, gone, "right"))
        if row >= len(self):
            return self.last
        own = float(self.ends[row] - self.begins[row])
        return TimelinePlace(row, max(gone - (float(moving[row]) - own), 0.0) / own if own > 0 else 0.0)

    def time(self, moment: TimelinePlace) -> float:
        """Return when a moment is, s: with no motion begun as soon as the one before has ended."""
        if moment.fraction > 0 and moment.motion < len(self):
            begin, end = self.begins[moment.motion], self.ends[moment.motion]
            return float(begin + (end - begin) * moment.fraction)
        return float(self.ends[min(moment.motion, len(self)) - 1]) if moment.motion > 0 and len(self) else 0.0

    def place(self, moment: TimelinePlace) -> Floats | None:
        """Return (3,) where the tip is, mm; None where there is no motion, or the place is not known."""
        if not len(self):
            return None
        row, fraction = (moment.motion, moment.fraction) if moment.fraction > 0 else (max(moment.motion - 1, 0), 1.0)
        if moment == TimelinePlace(0):
            fraction = 0.0
        motions, own = self.own(row)
        if self.nowhere[row] or (fraction < 1 and own > 0 and self.nowhere[row - 1]):
            return None
        place = place_on(motions, own, fraction)
        return place if bool(np.all(np.isfinite(place))) else None

    def program_of(self, row: int) -> tuple[int, int]:
        """Return the index of the program that a motion belongs to, and its row there."""
        program = int(np.searchsorted(self.first, row, "right")) - 1
        return program, row - int(self.first[program])

    def own(self, row: int) -> tuple[Motions, int]:
        """Return the motions of the program that a motion belongs to, and its row there."""
        program, own = self.program_of(row)
        return self.programs[program], own

    def current(self, moment: TimelinePlace) -> int:
        """Return the row of the motion that is being done, or was done last; the first one at the start."""
        return min(moment.motion if moment.fraction > 0 else max(moment.motion - 1, 0), max(len(self) - 1, 0))

    @cached_property
    def tool_changes(self) -> NDArray[np.int64]:
        """Motions that are done before each change of the tool, rising; the start and the end are none."""
        return np.flatnonzero(np.diff(self.tool)) + 1

    @cached_property
    def line_ends(self) -> NDArray[np.int64]:
        """Motions that are done behind each line that moves the tool, rising."""
        new = np.diff(self.line) != 0
        borders = self.first[1:-1] - 1
        new[borders[(borders >= 0) & (borders < len(new))]] = True
        return np.append(np.flatnonzero(new) + 1, len(self)) if len(self) else np.zeros(0, np.int64)

    @cached_property
    def _moving(self) -> Floats:
        """(n,) s of motion behind each, waits left out."""
        return np.cumsum(self.ends - self.begins)

    @cached_property
    def removed(self) -> Floats:
        """(n,) mm³ taken behind each motion."""
        return np.cumsum(self.volume) if len(self.volume) else np.zeros(len(self))

    def removed_at(self, moment: TimelinePlace) -> float:
        """Return the metal taken so far, mm³; within a motion it goes with the way."""
        done = float(self.removed[moment.motion - 1]) if moment.motion > 0 and len(self) else 0.0
        more = float(self.volume[moment.motion]) * moment.fraction if moment.fraction > 0 and len(self.volume) else 0.0
        return done + more

    def sampled(self, columns: int) -> TimelineColumns:
        """Return what is plotted along time, evenly in some columns, >= 1."""
        if not len(self) or self.total <= 0:
            return TimelineColumns(np.zeros(columns), np.zeros(columns), np.zeros(columns + 1))
        borders = np.linspace(0.0, self.total, columns + 1)
        knots = np.column_stack([self.begins, self.ends]).ravel()
        removed, gone = (
            np.interp(borders, knots, np.column_stack([total - own, total]).ravel())
            for total, own in ((self.removed, self._volume), (np.cumsum(self.length), self.length))
        )
        taken, way = np.diff(removed), np.diff(gone)
        mean = np.divide(taken, way, out=np.zeros(columns), where=way > 1e-9)
        section = np.divide(self._volume, self.length, out=np.zeros(len(self)), where=self.length > 1e-9)
        most = np.zeros(columns)
        first, last = (
            np.clip((at * columns / self.total).astype(np.int64), 0, columns - 1) for at in (self.begins, self.ends)
        )
        np.maximum.at(most, first, section)
        np.maximum.at(most, last, section)
        return TimelineColumns(mean, np.maximum(most, mean), removed)

    @property
    def _volume(self) -> Floats:
        return self.volume if len(self.volume) else np.zeros(len(self))
