"""Two NC programs side by side: which motions are the same, and what differs between them.

Motions that are alike within the tolerance are aligned first. A stretch that is left over is measured as a path: a line
written as two halves, an arc as a fan of chords are "the same path, other blocks" and no difference of the motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import together
from ...model.motion import Floats, MotionKind, Motions
from ...model.motion_path import lengths
from ..checks.path_distance import LargestDistance, Polyline, PolylinePaths, farthest, leash
from ..interpreter.program import EventKind, ModalState, NcProgram
from .align import AlignmentTable, MatchedRun, align

FEED = 0.1
"""mm/min; feeds that differ by less are the same: F words have one decimal."""
TIME_DIGITS = 9
"""Of a dwell, s; 351 thousandths are not the last bit of 0.351."""
CHORD = 1 / 20
"""Chords that stand for arcs keep to them within this part of the tolerance."""

Rows = NDArray[np.int64]


class Pause(NamedTuple):
    """A dwell, or a stop; seconds of a dwell, else 0."""

    kind: EventKind
    seconds: float


class _PausesOnWay(NamedTuple):
    """Dwells and stops before some motions, and where the tool stands at each; None = nowhere."""

    places: list[Floats | None]
    events: tuple[Pause, ...]


class _MotionStretch(NamedTuple):
    """Motions that move, all rapids or none, `stop` excluded."""

    rapid: bool
    first: int
    stop: int


class _ComparedGap(NamedTuple):
    """What a stretch that could not be aligned is, and pairs of motions that run along the same path in it."""

    difference: ProgramDifference
    pairs: list[Rows]


class _SideBySide(NamedTuple):
    """(2, k) motions of both programs that run along the same path at the same time, and (k,) how far each time, mm."""

    pairs: Rows
    length: Floats


class DifferenceKind(Enum):
    """What differs."""

    SAME_PATH = "same path, other blocks"
    PATH = "another path"
    RAPID = "rapid or feed"
    MISSING = "missing"
    EXTRA = "extra"
    FEED = "feed"
    TOOL = "tool"
    SPINDLE = "spindle"
    COOLANT = "coolant"
    WORK_OFFSET = "work offset"
    LENGTH_OFFSET = "tool length"
    PATH_MODE = "path mode"
    PAUSE = "dwell or stop"


@dataclass(frozen=True, slots=True)
class ProgramSpan:
    """A stretch of one program.

    Attributes:
        first, stop: motions, `stop` excluded; alike where the program has none there.
        first_line, last_line: 1-based lines of its text; of a stretch without motions, the line of the motion before
            it.
    """

    first: int
    stop: int
    first_line: int
    last_line: int


@dataclass(frozen=True, slots=True)
class ProgramDifference:
    """One stretch in which the programs differ.

    Attributes:
        a, b: where, in each program.
        distance: largest distance of the paths there, both ways, mm; 0 where the motions are alike.
        place: where on the path of a the distance is largest, mm; None where there is no distance to tell.
        text: what differs, in a sentence without its end.
    """

    kind: DifferenceKind
    a: ProgramSpan
    b: ProgramSpan
    distance: float = 0.0
    place: tuple[float, float, float] | None = None
    text: str = ""


@dataclass(frozen=True)
class ProgramDifferences:
    """What comparing two programs gives.

    Attributes:
        items: in the order of program a.
        runs: motions that are the same in both, in order.
        tolerance: what counted as the same, mm.
    """

    items: tuple[ProgramDifference, ...]
    runs: tuple[MatchedRun, ...]
    tolerance: float

    @property
    def same_motion(self) -> bool:
        """Whether both programs cut the same: they differ at most in how paths are written as blocks."""
        return all(item.kind is DifferenceKind.SAME_PATH for item in self.items)

    @property
    def largest_distance(self) -> float:
        """Largest distance of the paths where they differ, mm."""
        return max((item.distance for item in self.items), default=0.0)


def compare(
    a: NcProgram, b: NcProgram, tolerance: float = tolerances.LEVEL, progress: Progress = NO_PROGRESS
) -> ProgramDifferences:
    """Return what differs between two programs.

    Args:
        a, b: as the reader gives them.
        tolerance: paths no farther apart than this are the same, mm, > 0.
        progress: told of how much is done.

    Raises:
        Cancelled: the job was asked to stop.
    """
    runs = align(_table(a.motions, tolerance), _table(b.motions, tolerance), tolerance, progress.part(0.0, 0.5))
    return _Comparison(a, b, tolerance).differences(runs, progress.part(0.5, 1.0))


def _table(motions: Motions, tolerance: float) -> AlignmentTable:
    """Return what must be alike of motions that are the same."""
    curves = np.zeros(len(motions), np.int64)
    for row, spline in motions.splines.items():
        curves[row] = hash(
            (spline.degree, *np.round(np.concatenate([spline.points.ravel(), spline.weights]) / tolerance).tolist())
        )
    round_ = (motions.kind == MotionKind.ARC_CW) | (motions.kind == MotionKind.ARC_CCW)
    numbers = np.hstack([motions.start, motions.end, np.nan_to_num(motions.centre)])
    return AlignmentTable(
        numbers,
        np.column_stack([motions.kind, np.where(round_, motions.plane, 0), motions.turns, curves]).astype(np.int64),
    )


@dataclass(frozen=True)
class _ComparedProgram:
    """One program, with what the comparison asks of it again and again.

    Attributes:
        length: (n,) of each motion, mm.
        events: kind and value of what happens before a motion.
    """

    program: NcProgram
    paths: PolylinePaths
    length: Floats
    events: dict[int, tuple[Pause, ...]]

    @staticmethod
    def of(program: NcProgram, chord: float) -> _ComparedProgram:
        events: dict[int, tuple[Pause, ...]] = {}
        for event in program.events:
            if event.kind not in (EventKind.TOOL_CHANGE, EventKind.END):
                events[event.before] = (
                    *events.get(event.before, ()),
                    Pause(event.kind, round(event.value, TIME_DIGITS)),
                )
        return _ComparedProgram(program, PolylinePaths(program.motions, chord), lengths(program.motions), events)

    def span(self, first: int, stop: int) -> ProgramSpan:
        """Return where motions stand in the text."""
        line = self.program.motions.line
        if stop > first:
            return ProgramSpan(first, stop, int(line[first:stop].min()), int(line[first:stop].max()))
        before = int(line[first - 1]) if first else 1
        return ProgramSpan(first, stop, before, before)

    def stretches(self, first: int, stop: int) -> list[_MotionStretch]:
        """Return the stretches of rapids and of other motions that move between two motions."""
        rows = first + np.flatnonzero(self.length[first:stop] > 0)
        if not len(rows):
            return []
        rapid = self.program.motions.kind[rows] == MotionKind.RAPID
        edges = [0, *(np.flatnonzero(rapid[1:] != rapid[:-1]) + 1).tolist(), len(rows)]
        return [_MotionStretch(bool(rapid[i]), int(rows[i]), int(rows[j - 1]) + 1) for i, j in pairwise(edges)]

    def pauses(self, first: int, last: int) -> _PausesOnWay:
        """Return what happens before motions, last included."""
        rows = sorted(row for row in self.events if first <= row <= last)
        events = tuple(event for row in rows for event in self.events[row])
        return _PausesOnWay([self.place(row) for row in rows for _ in self.events[row]], events)

    def place(self, row: int) -> Floats | None:
        """Return (3,) where the tool stands before a motion; None where the program has no motion."""
        motions = self.program.motions
        if not len(motions):
            return None
        place: Floats = motions.start[row] if row < len(motions) else motions.end[-1]
        return place

    def state(self, row: int) -> ModalState:
        """Return what is in force while a motion is done."""
        return self.program.states[int(self.program.motions.state[row])]


class _Comparison:
    """Two programs on the way to their differences."""

    def __init__(self, a: NcProgram, b: NcProgram, tolerance: float) -> None:
        self._tolerance = tolerance
        self._a, self._b = (_ComparedProgram.of(program, tolerance * CHORD) for program in (a, b))

    def differences(self, runs: tuple[MatchedRun, ...], progress: Progress) -> ProgramDifferences:
        """Return everything that differs, given the motions that are the same."""
        items: list[ProgramDifference] = []
        pairs = [np.stack([run.a + np.arange(run.count), run.b + np.arange(run.count)]) for run in runs]
        size = (len(self._a.length), len(self._b.length))
        edges = chain([(0, 0)], *(((run.a, run.b), (run.a + run.count, run.b + run.count)) for run in runs), [size])
        for before, after in list(pairwise(edges))[::2]:
            if before != after:
                progress.step(before[0] / max(size[0], 1), "measuring")
                item, same = self._gap(before, after)
                items.append(item)
                pairs += same
        gaps = list(items)
        items += self._changes(np.concatenate(pairs, axis=1)) if pairs else []
        items += self._pauses(runs, gaps)
        return ProgramDifferences(
            tuple(sorted(items, key=lambda item: (item.a.first, item.b.first))), runs, self._tolerance
        )

    def _gap(self, before: tuple[int, int], after: tuple[int, int]) -> _ComparedGap:
        """Return what a stretch that could not be aligned is."""
        spans = self._a.span(before[0], after[0]), self._b.span(before[1], after[1])
        parts_a, parts_b = self._a.stretches(before[0], after[0]), self._b.stretches(before[1], after[1])
        if not parts_a or not parts_b:
            return _ComparedGap(self._one_sided(spans, bool(parts_a), bool(parts_b)), [])
        if [each.rapid for each in parts_a] != [each.rapid for each in parts_b]:
            parts_a, parts_b = self._telling(self._a, parts_a), self._telling(self._b, parts_b)
            if [each.rapid for each in parts_a] != [each.rapid for each in parts_b] or self._leash(
                spans
            ) > self._tolerance:
                return _ComparedGap(self._apart(spans, whole=True), [])
        lines = [
            (self._a.paths.polyline(p.first, p.stop), self._b.paths.polyline(q.first, q.stop))
            for p, q in zip(parts_a, parts_b, strict=True)
        ]
        longest = max((leash(*each) for each in lines), default=self._leash(spans))
        if longest > self._tolerance:
            return _ComparedGap(self._apart(spans, whole=False), [])
        counts = f"{spans[0].stop - spans[0].first} and {spans[1].stop - spans[1].first} motions"
        item = ProgramDifference(DifferenceKind.SAME_PATH, *spans, longest, None, f"the same path in {counts}")
        return _ComparedGap(item, [self._together(_side_by_side(*each)) for each in lines])

    def _together(self, found: _SideBySide) -> Rows:
        """Return the pairs without those that are between one end and the same end in the other program: where lengths
        differ in their last digits, each program comes to its end a little before or after the other.
        """
        pairs, length = found
        if not pairs.shape[1]:
            return pairs
        before, after = pairs[:, :-2], pairs[:, 2:]
        ends = self._a.program.motions.end[before[0]], self._b.program.motions.end[before[1]]
        one_end = np.linalg.norm(ends[0] - ends[1], axis=1) <= self._tolerance
        shortest = np.minimum(
            np.minimum(self._a.length[before[0]], self._a.length[after[0]]),
            np.minimum(self._b.length[before[1]], self._b.length[after[1]]),
        )
        between = np.all(before != after, axis=0) & one_end & (length[1:-1] < shortest / 2)
        kept = np.ones(pairs.shape[1], bool)
        kept[1:-1] = ~between
        return pairs[:, kept]

    def _leash(self, spans: tuple[ProgramSpan, ProgramSpan]) -> float:
        return leash(
            *(side.paths.polyline(span.first, span.stop) for side, span in zip((self._a, self._b), spans, strict=True))
        )

    def _telling(self, side: _ComparedProgram, parts: list[_MotionStretch]) -> list[_MotionStretch]:
        """Return stretches without those that are all within the tolerance of where they begin; what follows one
        another is one.
        """
        found: list[_MotionStretch] = []
        for part in parts:
            points = side.paths.polyline(part.first, part.stop).points
            if float(np.linalg.norm(np.ptp(points, axis=0))) > self._tolerance:
                joins = found and found[-1].rapid == part.rapid
                found[-1:] = [found[-1]._replace(stop=part.stop)] if joins else [*found[-1:], part]
        return found

    def _one_sided(self, spans: tuple[ProgramSpan, ProgramSpan], in_a: bool, in_b: bool) -> ProgramDifference:
        """Return what a stretch is of which one program has nothing."""
        if not in_a and not in_b:
            return ProgramDifference(DifferenceKind.SAME_PATH, *spans, text="motions that do not move")
        kind, side, span = (
            (DifferenceKind.MISSING, self._a, spans[0]) if in_a else (DifferenceKind.EXTRA, self._b, spans[1])
        )
        away = self._away(side, span, (self._a if side is self._b else self._b).place(spans[1 if in_a else 0].first))
        if away <= self._tolerance:
            return ProgramDifference(
                DifferenceKind.SAME_PATH, *spans, away, None, "motions that stay within the tolerance of a place"
            )
        length = float(side.length[span.first : span.stop].sum())
        x, y, z = side.program.motions.end[span.stop - 1].tolist()
        text = f"{span.stop - span.first} motions, {length:.3f} mm, only in the {'first' if in_a else 'second'}"
        return ProgramDifference(kind, *spans, 0.0, (x, y, z), text)

    @staticmethod
    def _away(side: _ComparedProgram, span: ProgramSpan, place: Floats | None) -> float:
        """Return how far a stretch of one program goes from the place where the other stands meanwhile, mm."""
        points = side.paths.polyline(span.first, span.stop).points
        return float(np.linalg.norm(points - (points[0] if place is None else place), axis=1).max())

    def _apart(self, spans: tuple[ProgramSpan, ProgramSpan], whole: bool) -> ProgramDifference:
        """Return how far two paths are apart; `whole`: they do not rapid and feed at the same places."""
        lines = [
            side.paths.polyline(span.first, span.stop) for side, span in zip((self._a, self._b), spans, strict=True)
        ]
        found: LargestDistance = farthest(lines[0], lines[1])
        if whole and leash(lines[0], lines[1]) <= self._tolerance:
            return ProgramDifference(
                DifferenceKind.RAPID,
                *spans,
                found.distance,
                found.a,
                "the same path, but rapid in one and fed in the other",
            )
        text = f"{found.distance:.3f} mm apart at X {found.a[0]:.3f} Y {found.a[1]:.3f} Z {found.a[2]:.3f}"
        return ProgramDifference(
            DifferenceKind.PATH,
            *spans,
            found.distance,
            found.a,
            text if found.distance > self._tolerance else "the same places in another order or sense",
        )

    def _changes(self, pairs: Rows) -> Iterator[ProgramDifference]:
        """Yield where motions along the same path have another feed, or something else in force."""
        pairs = pairs[:, np.argsort(pairs[0], kind="stable")]
        a, b = self._a.program, self._b.program
        feeds = a.motions.feed[pairs[0]], b.motions.feed[pairs[1]]
        differ = ~(np.abs(feeds[0] - feeds[1]) <= FEED) & ~(np.isnan(feeds[0]) & np.isnan(feeds[1]))
        yield from self._grouped(DifferenceKind.FEED, pairs, differ & (a.motions.kind[pairs[0]] != MotionKind.RAPID))
        for kind, reported in _IN_FORCE.items():
            names: dict[str, int] = {}
            codes = [
                np.array([names.setdefault(reported(state), len(names)) for state in side.states])[
                    side.motions.state[rows]
                ]
                for side, rows in zip((a, b), pairs, strict=True)
            ]
            yield from self._grouped(kind, pairs, codes[0] != codes[1])

    def _grouped(self, kind: DifferenceKind, pairs: Rows, differ: NDArray[np.bool_]) -> Iterator[ProgramDifference]:
        """Yield one difference for each group of neighbours that differ."""
        edges = np.flatnonzero(np.diff(np.concatenate([[0], differ.astype(np.int8), [0]])))
        for first, stop in edges.reshape(-1, 2).tolist():
            rows_a, rows_b = pairs[:, first:stop]
            text = self._told(kind, int(rows_a[0]), int(rows_b[0]))
            spans = self._a.span(int(rows_a[0]), int(rows_a[-1]) + 1), self._b.span(int(rows_b[0]), int(rows_b[-1]) + 1)
            yield ProgramDifference(kind, *spans, text=text)

    def _told(self, kind: DifferenceKind, a: int, b: int) -> str:
        """Return what the first motions of a group have."""
        if kind is DifferenceKind.FEED:
            first, second = (_feed(float(side.program.motions.feed[row])) for side, row in ((self._a, a), (self._b, b)))
        else:
            first, second = _IN_FORCE[kind](self._a.state(a)), _IN_FORCE[kind](self._b.state(b))
        return f"{first} in the first, {second} in the second"

    def _pauses(self, runs: tuple[MatchedRun, ...], gaps: list[ProgramDifference]) -> Iterator[ProgramDifference]:
        """Yield dwells and stops that only one program has, or has elsewhere: before motions that are the same, or
        along the same path.
        """
        if not self._a.events and not self._b.events:
            return
        size = MatchedRun(len(self._a.length), len(self._b.length), 1)
        along = {(gap.a.stop, gap.b.stop): gap for gap in gaps if gap.kind is DifferenceKind.SAME_PATH}
        for gap in along.values():
            yield from self._unlike((gap.a.first, gap.a.stop), (gap.b.first, gap.b.stop))
        for run in (*runs, size):
            skipped = int((run.a, run.b) in along)
            rows = {row - run.a for row in self._a.events} | {row - run.b for row in self._b.events}
            for ahead in sorted(row for row in rows if skipped <= row < run.count):
                yield from self._unlike((run.a + ahead,) * 2, (run.b + ahead,) * 2)

    def _unlike(self, in_a: tuple[int, int], in_b: tuple[int, int]) -> Iterator[ProgramDifference]:
        """Yield what differs of the dwells and stops before the motions of two stretches, ends included."""
        (places_a, events_a), (places_b, events_b) = self._a.pauses(*in_a), self._b.pauses(*in_b)
        spans = self._a.span(*in_a), self._b.span(*in_b)
        if events_a != events_b:
            text = f"{_pause(events_a)} in the first, {_pause(events_b)} in the second"
            yield ProgramDifference(DifferenceKind.PAUSE, *spans, text=text)
        elif any(self._elsewhere(*each) for each in zip(places_a, places_b, strict=True)):
            yield ProgramDifference(DifferenceKind.PAUSE, *spans, text=f"{_pause(events_a)} at another place")

    def _elsewhere(self, one: Floats | None, other: Floats | None) -> bool:
        return one is not None and other is not None and float(np.linalg.norm(one - other)) > self._tolerance


def _side_by_side(a: Polyline, b: Polyline) -> _SideBySide:
    """Return the motions that run along the same path at the same time."""
    ends: Floats = np.sort(np.concatenate([path.along / (path.along[-1] or 1.0) for path in (a, b)]))
    ends = ends[np.concatenate([[True], ends[1:] > ends[:-1]])]
    middle = (ends[1:] + ends[:-1]) / 2
    owners = [
        path.owner[np.clip(np.searchsorted(path.along, middle * path.along[-1]), 1, len(path.along) - 1)]
        for path in (a, b)
    ]
    pairs = np.stack(owners)
    if not pairs.shape[1]:
        return _SideBySide(pairs, np.empty(0))
    fresh = np.flatnonzero(np.concatenate([[True], np.any(pairs[:, 1:] != pairs[:, :-1], axis=0)]))
    return _SideBySide(pairs[:, fresh], np.add.reduceat(np.diff(ends), fresh) * a.along[-1])


def _pause(events: tuple[Pause, ...]) -> str:
    return ", ".join(f"{kind.value} {s:g} s" if s else kind.value for kind, s in events) or "none"


def _feed(value: float) -> str:
    return "no feed" if np.isnan(value) else f"F {value:.1f} mm/min"


def _tool(state: ModalState) -> str:
    return f"T{state.tool}" if state.tool else "no tool"


def _spindle(state: ModalState) -> str:
    if not state.spindle:
        return "spindle off"
    return f"S {state.speed:g} {'M3' if state.spindle > 0 else 'M4'}{' G96' if state.constant_surface else ''}"


def _coolant(state: ModalState) -> str:
    return together(name for name, on in (("flood", state.flood), ("mist", state.mist)) if on) or "no coolant"


def _work_offset(state: ModalState) -> str:
    return state.work_offset


def _length_offset(state: ModalState) -> str:
    return f"G43 H{state.length_offset}" if state.length_offset else "no length (G49)"


def _path_mode(state: ModalState) -> str:
    """Return the path mode with its P in mm, to two digits: one tolerance written in mm and in inch is the same."""
    words = [word for word in state.path.split() if not word.startswith("P")]
    if words[0] == "G64" and state.path_tolerance is not None:
        words.insert(1, f"P {state.path_tolerance:.2g} mm")
    return " ".join(words)


_IN_FORCE: dict[DifferenceKind, Callable[[ModalState], str]] = {
    DifferenceKind.TOOL: _tool,
    DifferenceKind.SPINDLE: _spindle,
    DifferenceKind.COOLANT: _coolant,
    DifferenceKind.WORK_OFFSET: _work_offset,
    DifferenceKind.LENGTH_OFFSET: _length_offset,
    DifferenceKind.PATH_MODE: _path_mode,
}
