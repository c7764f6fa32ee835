"""How deep what of a tool does not cut goes into metal: its bodies are led along its motions as rapids that are only
asked.

A body follows the cutter, so it meets a motion's metal before or after the cutter has cut there:

- A rapid, or a motion that nowhere descends, is asked before it cuts. Flutes reach no metal above themselves, so what
  stands in the way of a body then is what it meets, exactly.
- A motion straight down is asked after it: what it cuts away, it cuts before the body gets there; what is beside,
  stays.
- Of any other that descends both are asked. What is met after it was met; before it metal may be met that the motion
  cuts away first. Where the two differ by more than `STEP` the motion is cut and asked in pieces that descend no more
  than that.

So a contact is told at most STEP too deep, never too little, and what is no contact is not told, as STEP is no more
than `TOUCH`. Curves are asked by chords within `CHORD` of them, and bodies are taken slimmer by TOUCH: what is met at a
cell's centre by more than TOUCH upwards and TOUCH + CHORD sideways is always told.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..model.motion import Floats, MotionKind
from ..simulation.bodies.bodies import Body
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course, Rapids, TrimOptions
from ..simulation.sweeps.pieces import PieceSplitter
from ..simulation.sweeps.trim import RapidHit, trim
from .course import inserted, picked, straight

CHORD = 0.004
"""mm that chords may keep from a curve; less than TOUCH, so that a wall which a curve has cut does not count as met."""

TOUCH = 0.01
"""mm; what goes no deeper into metal, upwards or sideways, is no contact."""

STEP = 0.01
"""mm that a piece may descend which is asked alone."""

MOST_STEPS = 4000
"""Pieces of one chord, at most; one that descends more than these steps is asked in higher ones."""

Rows = NDArray[np.intp]
Mask = NDArray[np.bool_]
Items = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Which body, and which chord."""

Key = tuple[int, int]
"""A motion's row, and which of its tool's bodies."""


@dataclass(frozen=True, slots=True)
class BodyContact:
    """A body in metal.

    Attributes:
        row: of the motion. body: which of its tool's bodies. x, y: where it is deepest, mm. z: of the body there, mm;
            the metal stands `depth` higher.
    """

    row: int
    body: int
    x: float
    y: float
    z: float
    depth: float


@dataclass(frozen=True, eq=False)
class MotionChords:
    """Straight ways, (n,) in the order of motions: start and end (n, 3) mm, and the row of the motion that each is
    of.
    """

    start: Floats
    end: Floats
    row: Rows

    def __len__(self) -> int:
        return len(self.row)

    def of(self, mask: NDArray[np.bool_]) -> MotionChords:
        """Return some of them."""
        return MotionChords(self.start[mask], self.end[mask], self.row[mask])


def chords_of(course: Course, rows: Rows) -> MotionChords:
    """Return the ways of some motions; `rows` rise."""
    splitter = PieceSplitter(picked(course, rows).motions, arcs_stay=False, chord=CHORD)
    pieces = splitter.pieces(0, len(rows))
    return MotionChords(pieces.start, pieces.end, rows[pieces.motion])


@dataclass(frozen=True)
class BodyContacts:
    """What was found.

    Attributes:
        touches: where bodies are deepest in metal, by motion and body.
        open: touches that may be as deep as this or less, or none, by motion and body: there were too many to ask step
            by step.
    """

    touches: dict[Key, BodyContact]
    open: dict[Key, BodyContact]


class _StepwiseContacts(NamedTuple):
    """What motions meet, by motion and body, and which of these could be afforded to ask."""

    contacts: dict[Key, BodyContact]
    keys: set[Key]


class _ChordHit(NamedTuple):
    """A chord that meets metal, by its number, and where."""

    chord: int
    hit: RapidHit


@dataclass(frozen=True, eq=False)
class BodyContactQuery:
    """What is asked: a program, the metal before it, the cutters and the bodies by T number."""

    workpiece: Workpiece
    course: Course
    cutters: Mapping[int, Cutter]
    bodies: Mapping[int, Sequence[Body]]

    def touches(
        self, chords: MotionChords, keys: Collection[Key], cells: float = math.inf, progress: Progress = NO_PROGRESS
    ) -> BodyContacts:
        """Return where bodies are in metal.

        Args:
            chords: of motions (`chords_of`), of all that are asked at least.
            keys: the motions and bodies that are asked.
            cells: that are looked at step by step, at most.

        Raises:
            Cancelled: the job was asked to stop.
        """
        items = self.items(chords, keys)
        if not len(items[0]):
            return BodyContacts({}, {})
        upright, slanted = self._sorts(chords)
        early, after = self._asked(chords, items, (~upright, upright | slanted), progress.part(0.0, 0.7))
        both = set(chords.row[slanted].tolist())
        doubtful = {
            key
            for key, touch in early.items()
            if key[0] in both and (key not in after or touch.depth - after[key].depth > STEP)
        }
        closer, requested = self._stepwise(chords, doubtful, cells, progress.part(0.7, 1.0))
        found = {key: touch for key, touch in {**after, **early}.items() if key not in doubtful}
        for key in doubtful & (closer.keys() | after.keys()):
            found[key] = max((each[key] for each in (closer, after) if key in each), key=lambda touch: touch.depth)
        return BodyContacts(found, {key: early[key] for key in doubtful - requested})

    def _sorts(self, chords: MotionChords) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Return which chords are of motions at feed rate straight down, and of other ones that descend."""
        way = chords.end - chords.start
        cuts = self.course.motions.kind[chords.row] != MotionKind.RAPID
        upright = (
            cuts
            & (self.course.motions.kind[chords.row] == MotionKind.LINE)
            & np.all(way[:, :2] == 0, axis=1)
            & (way[:, 2] < 0)
        )
        descends = np.isin(chords.row, chords.row[cuts & (way[:, 2] < 0)])
        return upright, descends & ~upright

    def _asked(
        self, chords: MotionChords, items: Items, when: tuple[Mask, Mask], progress: Progress
    ) -> tuple[dict[Key, BodyContact], ...]:
        """Return what items meet before their motion, and after it: the deepest by row and body; `when`: which chords
        are asked then.
        """
        body, chord = (np.concatenate([each[mask[items[1]]] for mask in when]) for each in items)
        late = np.repeat([False, True], [int(np.sum(mask[items[1]])) for mask in when])
        tools = self._first() + self._offset(chords.row[chord]) + body
        at = chords.row[chord] + late
        order = np.lexsort((~late, at))  # after one motion comes before the next
        chord, body, tools, at, late = chord[order], body[order], tools[order], at[order], late[order]
        paths = MotionChords(chords.start[chord], chords.end[chord], chords.row[chord])
        found: tuple[dict[Key, BodyContact], ...] = ({}, {})
        for k, hit in self._trimmed(at, paths, tools, np.zeros(0, np.intp), progress):
            _keep(found[int(late[k])], int(paths.row[k]), int(body[k]), hit)
        return found

    def _stepwise(self, chords: MotionChords, keys: set[Key], cells: float, progress: Progress) -> _StepwiseContacts:
        """Return what motions meet that are cut and asked by turns."""
        steps = np.clip(np.ceil((chords.start[:, 2] - chords.end[:, 2]) / STEP), 1, MOST_STEPS)
        keys = self.affordable(chords, keys, cells, steps)
        chords = chords.of(np.isin(chords.row, [row for row, _ in keys]))
        if not len(chords):
            return _StepwiseContacts({}, keys)
        descent = np.maximum(chords.start[:, 2] - chords.end[:, 2], 0.0)
        count = np.clip(np.ceil(descent / STEP), 1, MOST_STEPS).astype(int)
        chord, step = np.repeat(np.arange(len(count)), count), np.concatenate([np.arange(n) for n in count])
        ways = [
            chords.start[chord] + (chords.end - chords.start)[chord] * ((step + k) / count[chord])[:, None]
            for k in (0, 1)
        ]
        requested = MotionChords(ways[0], ways[1], chords.row[chord])
        body, piece = self.items(requested, keys)
        tools = np.concatenate(
            [self._first() + self._offset(requested.row[piece]) + body, self.course.tool[requested.row]]
        )
        order = np.lexsort(
            (np.repeat([0, 1], [len(piece), len(requested)]), np.concatenate([piece, np.arange(len(requested))]))
        )
        start, end = (np.concatenate([way[piece], way]) for way in ways)
        row = np.concatenate([requested.row[piece], requested.row])
        cuts = np.flatnonzero(order >= len(piece))
        found: dict[Key, BodyContact] = {}
        for k, hit in self._trimmed(
            row[order], MotionChords(start[order], end[order], row[order]), tools[order], cuts, progress
        ):
            _keep(found, int(row[order[k]]), int(body[order[k]]), hit)
        return _StepwiseContacts(found, keys)

    def _trimmed(
        self, at: Rows, chords: MotionChords, tools: NDArray[np.intp], cuts: Rows, progress: Progress
    ) -> list[_ChordHit]:
        """Return which chords meet metal; `cuts` are those that cut, the others are asked."""
        more = straight(chords.start, chords.end)
        kind = more.kind.copy()
        kind[cuts] = MotionKind.LINE
        last = int(at.max())
        course = picked(self.course, np.arange(last))
        rapids = np.flatnonzero(course.motions.kind == MotionKind.RAPID)
        course = replace(course, left_out=tuple(sorted({*course.left_out, *rapids.tolist()})))
        made, owner = inserted(course, at, replace(more, kind=kind), tools.astype(np.int32))
        shapes = [each.shape for bodies in self.bodies.values() for each in bodies]
        cutters = {**self.cutters, **dict(enumerate(shapes, self._first()))}
        hits = trim(self.workpiece, made, cutters, TrimOptions(Rapids.ASKED, TOUCH), progress).rapids
        return [_ChordHit(int(owner[hit.motion]), hit) for hit in hits]

    def affordable(
        self, chords: MotionChords, keys: Collection[Key], cells: float, times: Floats | None = None
    ) -> set[Key]:
        """Return as many of some keys as can be asked, those of narrow bodies first, others evenly spread over the
        motions.

        Args:
            cells: that may be looked at. times: (n,) that each chord is asked; None: twice.
        """
        body, chord = self.items(chords, keys)
        tool = self.course.tool[chords.row[chord]]
        radius = np.array(
            [self.bodies[number][each].shape.radius for number, each in zip(tool.tolist(), body.tolist(), strict=True)]
        )
        long = np.hypot(*(chords.end - chords.start)[chord, :2].T)
        grid = self.workpiece.grid
        cost = np.minimum((math.pi * radius + 2 * long) * radius / grid.pitch**2, grid.rows * grid.cols)
        cost = cost * (2.0 if times is None else times[chord])
        done: set[Key] = set()
        sorts = [
            np.flatnonzero((tool == number) & (body == each))
            for number, bodies in self.bodies.items()
            for each in range(len(bodies))
        ]
        for k, mine in enumerate(sorted(sorts, key=lambda mine: float(np.sum(cost[mine])))):
            needed, share = float(np.sum(cost[mine])), cells / (len(sorts) - k)
            rows = np.unique(chords.row[chord[mine]])
            rows = rows[:: max(1, math.ceil(needed / share))] if needed else rows
            cells -= float(np.sum(cost[mine[np.isin(chords.row[chord[mine]], rows)]]))
            done |= {(row, int(body[mine[0]])) for row in rows.tolist()}
        return done

    def items(self, chords: MotionChords, keys: Collection[Key]) -> Items:
        """Return which body, and which chord, for the chords of some motions and bodies."""
        body, chord = self._by_body(chords)
        most = max(map(len, self.bodies.values()), default=1)
        target = np.array([row * most + each for row, each in keys], np.int64)
        mine = np.isin(chords.row[chord] * most + body, target)
        return body[mine], chord[mine]

    def _by_body(self, chords: MotionChords) -> Items:
        """Return every body of every chord: which body, and which chord."""
        counts = np.zeros(int(self.course.tool.max(initial=0)) + 1, np.intp)
        for number, bodies in self.bodies.items():
            if number < len(counts):
                counts[number] = len(bodies)
        each = counts[self.course.tool[chords.row]]
        chord = np.repeat(np.arange(len(chords)), each)
        return np.arange(len(chord)) - np.repeat(np.cumsum(each) - each, each), chord

    def _first(self) -> int:
        """Return the first T number that stands for a body."""
        return int(max([*self.cutters, self.course.tool.max(initial=0)])) + 1

    def _offset(self, rows: Rows) -> NDArray[np.intp]:
        """Return the number, among all bodies, of the first one of each motion's tool."""
        first = np.zeros(self._first(), np.intp)
        done = 0
        for number, bodies in self.bodies.items():
            first[number] = done
            done += len(bodies)
        return first[self.course.tool[rows]]


def _keep(found: dict[Key, BodyContact], row: int, body: int, hit: RapidHit) -> None:
    """Keep the deepest touch of a motion and body."""
    old = found.get((row, body))
    if old is None or hit.depth > old.depth:
        found[row, body] = BodyContact(row, body, hit.x, hit.y, hit.z, hit.depth)
