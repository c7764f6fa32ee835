"""Shanks and holders in metal, motion by motion, and how far a tool must stick out at least so that its holder meets
none.

Time is cut into blocks of motions. The metal after a block stands all through it, so what a body meets there it surely
meets; the metal before it is all that it may meet. Where the two agree nothing else is asked; only the motions between
are asked one by one, on the metal as it is then (`body_contacts`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..model.motion import Floats
from ..model.motion_path import reach
from ..model.tool import Tool
from ..simulation.bodies.bodies import Body, BodyPaths, HeightPyramid, HolderPart, bodies_of, shape_rows
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course, Rapids, TrimOptions
from ..simulation.sweeps.trim import trim
from .body_contacts import STEP, TOUCH, BodyContact, BodyContactQuery, Key, MotionChords, Rows, chords_of
from .course import picked

BLOCKS, FEW = 32, 6
"""Blocks of time, at most; and where no body, as it stands, comes as low as the stock's top."""

CELLS = 3e9
"""Cells that are looked at for what the blocks leave open, at most: some seconds."""

ROUNDS = (16, 64, 256, 1024)
"""Motions that are asked at a time for how far a tool must stick out."""

DIGIT = 10
"""Parts of a mm that a stick-out is rounded up to."""


@dataclass(frozen=True, slots=True)
class HolderContact:
    """A shank or a holder in metal, through motions that follow one another or are in metal near each other.

    Attributes:
        tool: T number. part: what of it. first: row of the first motion. count: of motions in metal.
        motion: row of the motion that goes deepest. x, y: where, mm. z: of the part there, mm; the metal stands `depth`
            higher.
    """

    tool: int
    part: HolderPart
    first: int
    count: int
    motion: int
    x: float
    y: float
    z: float
    depth: float


@dataclass(frozen=True)
class HolderReport:
    """What was found.

    Attributes:
        contacts: in the order of motions.
        least: by T number, of tools whose holder is known, the stick-out from which on it meets no metal, mm, rounded
            up to 0.1.
        unseen: motions of which it is not known whether a shank or holder meets metal: there are too many to ask each.
    """

    contacts: tuple[HolderContact, ...] = ()
    least: Mapping[int, float] = field(default_factory=dict)
    unseen: int = 0

    def followed(self, then: HolderReport, motions: int) -> HolderReport:
        """Return this and the look at the next program as one; `motions` came before that."""
        moved = (replace(each, first=each.first + motions, motion=each.motion + motions) for each in then.contacts)
        least = {
            number: max(look.least.get(number, 0.0) for look in (self, then)) for number in {**self.least, **then.least}
        }
        return HolderReport((*self.contacts, *moved), least, self.unseen + then.unseen)


def holder_contacts(
    course: Course,
    before: Workpiece,
    cutters: Mapping[int, Cutter],
    tools: Mapping[int, Tool],
    progress: Progress = NO_PROGRESS,
) -> HolderReport:
    """Return where shanks and holders meet metal in a program, and how far tools must stick out.

    A contact is told at most `STEP` too deep, and none that is deeper than `TOUCH` at a cell's centre is missed, but
    for those among `unseen`. A least stick-out is never too small by more than `TOUCH`; it is too large by less than
    0.1 mm, and by STEP, unless more motions are in doubt than can be asked.

    Args:
        before: the metal before the program.
        cutters, tools: by T number.

    Raises:
        Cancelled: the job was asked to stop.
    """
    used = set(np.unique(course.tool).tolist()) & cutters.keys()
    bodies = {number: found for number, tool in tools.items() if number in used and (found := bodies_of(tool))}
    look = _HolderCheck(course, before, cutters, {number: tools[number] for number in bodies}, bodies)
    return look.done(progress) if bodies else HolderReport()


class _HolderCheck:
    """One look at a program."""

    def __init__(
        self,
        course: Course,
        before: Workpiece,
        cutters: Mapping[int, Cutter],
        tools: Mapping[int, Tool],
        bodies: Mapping[int, tuple[Body, ...]],
    ) -> None:
        self._course, self._before, self._cutters, self._tools, self._bodies = course, before, cutters, tools, bodies
        self._first, done = {}, 0
        for number, each in bodies.items():
            self._first[number], done = done, done + len(each)
        self._shapes = shape_rows([body.shape for each in bodies.values() for body in each], TOUCH)
        self._owner = np.repeat(list(bodies), [len(each) for each in bodies.values()])
        self._is_holder = np.array([body.part is HolderPart.HOLDER for each in bodies.values() for body in each])
        self._stands = np.array([float(tools[number].stick_out) for number in self._owner.tolist()])
        self._least = {
            number: 0.0 for number, each in bodies.items() if any(body.part is HolderPart.HOLDER for body in each)
        }
        self._touched: dict[Key, BodyContact] = {}
        self._open: set[Key] = set()
        self._may: dict[int, float] = {}

    def done(self, progress: Progress) -> HolderReport:
        """Look."""
        rows = self._in_question()
        if not len(rows):
            return HolderReport(least=self._least)
        chords = chords_of(self._course, rows)
        self._through_blocks(chords, progress.part(0.0, 0.5))
        unseen = self._close(chords, progress.part(0.5, 0.75))
        self._settle_least(chords, progress.part(0.75, 1.0))
        least = {number: math.ceil(value * DIGIT - 1e-6) / DIGIT for number, value in self._least.items()}
        return HolderReport(self._contacts(), least, unseen)

    def _in_question(self) -> Rows:
        """Return the motions in which a body may meet metal, or might if the holder stood on the tip."""
        motions, top = self._course.motions, float(self._before.heights.max())
        low, high = reach(motions)
        x0, y0, x1, y1 = self._before.grid.box
        requested = np.zeros(len(motions), bool)
        for number, each in self._bodies.items():
            wide = max(body.shape.radius for body in each)
            lift = 0.0 if number in self._least else min(body.shape.lift for body in each)
            over = ((low[:, :2] - wide < (x1, y1)) & (high[:, :2] + wide > (x0, y0))).all(axis=1)
            requested |= (self._course.tool == number) & over & (low[:, 2] + lift < top - TOUCH)
        requested[list(self._course.left_out)] = False
        return np.flatnonzero(requested)

    def _through_blocks(self, chords: MotionChords, progress: Progress) -> None:
        """Look at all motions on the metal before and after blocks of them."""
        rows, top = np.unique(chords.row), float(self._before.heights.max())
        lifts = [
            min((self._shapes[self._owner == number, 3]), default=0.0) for number in range(int(self._owner.max()) + 1)
        ]
        touches = (
            np.minimum(chords.start, chords.end)[:, 2] + np.array(lifts)[self._course.tool[chords.row]] < top - TOUCH
        )
        count = min(BLOCKS if touches.any() else FEW, len(rows))
        edges = [0, *(int(part[0]) for part in np.array_split(rows, count)[1:]), int(rows[-1]) + 1]
        edge = np.searchsorted(chords.row, edges)
        stock, before = self._before, HeightPyramid.of(self._before)
        for k, (first, last) in enumerate(pairwise(edges)):
            part = progress.part(k / (len(edges) - 1), (k + 1) / (len(edges) - 1))
            stock = trim(
                stock, picked(self._course, np.arange(first, last)), self._cutters, TrimOptions(Rapids.IGNORED), part
            ).workpiece
            after = HeightPyramid.of(stock)
            mine = np.arange(edge[k], edge[k + 1])
            self._look(before, after, chords, mine)
            before = after

    def _look(self, before: HeightPyramid, after: HeightPyramid, chords: MotionChords, mine: NDArray[np.intp]) -> None:
        """Look at a block's chords."""
        body, chord = self._items(chords.row[mine])
        every = BodyPaths(
            np.column_stack([chords.start[mine], chords.end[mine]]), self._shapes, chord, body, np.zeros(len(body))
        )
        low, top = np.minimum(chords.start[mine], chords.end[mine])[chord, 2], float(before.heights[-1])
        near = np.flatnonzero(low + self._shapes[body, 3] < top - TOUCH)
        paths, row, body = every.of(near), chords.row[mine][chord[near]], body[near]
        surely, cell = after.deeper(paths, np.full(len(paths), TOUCH))
        for k in np.flatnonzero(cell >= 0).tolist():
            self._keep(self._touch(after, int(row[k]), int(body[k]), int(cell[k]), float(surely[k])))
        _, cell = before.deeper(paths, np.where(cell >= 0, surely + STEP, TOUCH))
        self._open |= {(int(row[k]), int(body[k])) for k in np.flatnonzero(cell >= 0).tolist()}
        items = np.flatnonzero(
            top - low - self._shapes[every.shape, 3] + self._stands[every.shape] > self._needed()[every.shape]
        )
        items = items[np.argsort(low[items], kind="stable")]
        if len(items):
            self._look_for_least(before, after, every.of(items), chords.row[mine][chord[items]])

    def _look_for_least(self, before: HeightPyramid, after: HeightPyramid, paths: BodyPaths, row: Rows) -> None:
        """Note how far tools must stick out for a block's chords, surely and at most; items go from low to high."""
        low, least = replace(paths, low=-self._stands[paths.shape]), self._needed()
        after.deepest(low, least)
        for number in self._least:
            self._least[number] = float(least[(self._owner == number) & self._is_holder].max())
        depth, cell = before.deeper(low, self._needed()[paths.shape])
        for k in np.flatnonzero(cell >= 0).tolist():
            self._may[int(row[k])] = max(float(depth[k]), self._may.get(int(row[k]), -math.inf))

    def _needed(self) -> Floats:
        """Return, by body, how far its tool must surely stick out, mm; infinite of shanks."""
        return np.array(
            [
                self._least[number] if holds else math.inf
                for number, holds in zip(self._owner, self._is_holder, strict=True)
            ]
        )

    def _items(self, rows: Rows) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return every body of every chord: its number among all bodies, and the chord."""
        tool = self._course.tool[rows]
        parts = [(shape, np.flatnonzero(tool == number)) for shape, number in enumerate(self._owner.tolist())]
        chord = np.concatenate([found for _, found in parts])
        body = np.repeat([shape for shape, _ in parts], [len(found) for _, found in parts])
        order = np.argsort(chord, kind="stable")
        return body[order].astype(np.int64), chord[order].astype(np.int64)

    def _touch(self, stock: HeightPyramid, row: int, shape: int, cell: int, depth: float) -> BodyContact:
        x, y = stock.metal.grid.place(cell)
        height = float(stock.metal.heights.ravel()[cell])
        depth = min(depth, height - stock.metal.floor)
        return BodyContact(row, shape - self._first[int(self._owner[shape])], x, y, height - depth, depth)

    def _keep(self, touch: BodyContact) -> None:
        key = (touch.row, touch.body)
        if key not in self._touched or touch.depth > self._touched[key].depth:
            self._touched[key] = touch

    def _close(self, chords: MotionChords, progress: Progress) -> int:
        """Ask the motions that the blocks leave open, those first that may meet nothing; return how many of these are
        left.
        """
        asking = BodyContactQuery(self._before, self._course, self._cutters, self._bodies)
        keys = {(row, shape - self._first[int(self._owner[shape])]) for row, shape in self._open}
        unsure, left = keys - self._touched.keys(), set[Key]()
        for k, some in enumerate((unsure, keys - unsure)):
            part = progress.part(k / 2, (k + 1) / 2)
            afforded = asking.affordable(chords, some, CELLS / 2)
            requested = asking.touches(
                chords.of(np.isin(chords.row, [row for row, _ in afforded])), afforded, CELLS / 2, part
            )
            for touch in requested.touches.values():
                self._keep(touch)
            left |= (some - afforded) | requested.open.keys()
        return len({row for row, _ in left - self._touched.keys()})

    def _settle_least(self, chords: MotionChords, progress: Progress) -> None:
        """Ask the motions for which tools may have to stick out farther than is sure, those first that may ask for
        most.
        """
        for k, count in enumerate(ROUNDS):
            rows = self._doubtful()[:count]
            if not rows:
                return
            bodies = {
                number: tuple(
                    body.lifted(least - self._tools[number].stick_out)
                    for body in self._bodies[number]
                    if body.part is HolderPart.HOLDER
                )
                for number, least in self._least.items()
            }
            asking = BodyContactQuery(self._before, self._course, self._cutters, bodies)
            some = chords.of(np.isin(chords.row, rows))
            keys = {(row, each) for row in rows for each in range(len(bodies[int(self._course.tool[row])]))}
            afforded = asking.affordable(some, keys, CELLS / len(ROUNDS))
            requested = asking.touches(
                some, afforded, CELLS / len(ROUNDS), progress.part(k / len(ROUNDS), (k + 1) / len(ROUNDS))
            )
            sure = self._least.copy()
            for touch in (*requested.touches.values(), *requested.open.values()):
                number = int(self._course.tool[touch.row])
                self._least[number] = max(self._least[number], sure[number] + touch.depth)
            for row in {row for row, _ in keys} - {row for row, _ in keys - afforded}:
                del self._may[row]
        for row in self._doubtful():
            number = int(self._course.tool[row])
            self._least[number] = max(self._least[number], self._may[row])

    def _doubtful(self) -> list[int]:
        """Return the motions that may ask for more than is sure, by how much."""
        over = {row: may - self._least[int(self._course.tool[row])] for row, may in self._may.items()}
        return sorted((row for row, by in over.items() if by > TOUCH), key=over.__getitem__, reverse=True)

    def _contacts(self) -> tuple[HolderContact, ...]:
        """Return what was met, each contact with all of its motions."""
        found: list[HolderContact] = []
        for part in HolderPart:
            runs: list[list[BodyContact]] = []
            for touch in self._deepest(part):
                if runs and self._goes_on(runs[-1][-1], touch):
                    runs[-1].append(touch)
                else:
                    runs.append([touch])
            for run in runs:
                worst = max(run, key=lambda touch: touch.depth)
                number = int(self._course.tool[worst.row])
                found.append(
                    HolderContact(
                        tool=number,
                        part=part,
                        first=run[0].row,
                        count=len(run),
                        motion=worst.row,
                        x=worst.x,
                        y=worst.y,
                        z=worst.z,
                        depth=worst.depth,
                    )
                )
        return tuple(sorted(found, key=lambda each: each.first))

    def _deepest(self, part: HolderPart) -> list[BodyContact]:
        """Return the deepest touch of a part in each motion."""
        bodies = {
            (number, k) for number, each in self._bodies.items() for k, body in enumerate(each) if body.part is part
        }
        tool, deepest = self._course.tool.tolist(), dict[int, BodyContact]()
        for (row, body), touch in self._touched.items():
            if (tool[row], body) in bodies and (row not in deepest or touch.depth > deepest[row].depth):
                deepest[row] = touch
        return [deepest[row] for row in sorted(deepest)]

    def _goes_on(self, one: BodyContact, then: BodyContact) -> bool:
        """Return whether two touches of a part are of one contact: of one tool, and of motions that follow, or near
        each other.
        """
        number = int(self._course.tool[one.row])
        if number != self._course.tool[then.row]:
            return False
        wide = max(body.shape.radius for body in self._bodies[number])
        return then.row == one.row + 1 or math.hypot(then.x - one.x, then.y - one.y) <= wide
