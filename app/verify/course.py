"""What of a program can be cut: motions whose ways are known, and where the program first comes to a known place."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..gcode.interpreter.program import NcProgram
from ..gcode.timing.extent import at_home, from_nowhere_of, nowhere_of
from ..geometry.kernels import build_tree, query_box
from ..geometry.sample import Box
from ..model.motion import Floats, MotionKind, Motions
from ..model.motion_path import reach
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Grid, StockShape, Workpiece
from ..simulation.sweeps.course import Course, Rapids, TrimOptions
from ..simulation.sweeps.trim import RapidHit, trim

COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
"""Of motions, a row for each."""


@dataclass(frozen=True, eq=False)
class KnownCourse:
    """The course of a program, as far as its places are known.

    Attributes:
        course: motions that begin, along an axis, at a place that nobody knows, begin where they end along it. Left out
            are those that end at such a place, curves that begin at one, and the rapid that first comes to a known
            place.
        first: row of the motion that first ends at a known place; the number of motions where none does.
        nowhere: (n, 3) whether each motion ends, along an axis, at a place that nobody knows.
        home: (n, 3) whether that is because it is a place of the machine.
        begins: whether the motion of `first` starts at a known place too.
    """

    course: Course
    first: int
    nowhere: NDArray[np.bool_]
    home: NDArray[np.bool_]
    begins: bool = False


def course_of(program: NcProgram) -> KnownCourse:
    """Return what of a program can be cut; before it sets an axis, and at a place of the machine, nobody knows where it
    is.
    """
    motions, nowhere = program.motions, nowhere_of(program)
    unknown = np.asarray(nowhere.any(axis=1))
    from_nowhere = from_nowhere_of(program, nowhere)
    curved = motions.kind >= MotionKind.ARC_CW
    start, moved = motions.start, from_nowhere & ~curved[:, None] & (motions.start != motions.end)
    if moved.any():  # else it is not held twice
        start = np.where(moved, motions.end, start)
    first = int(np.argmin(unknown)) if not unknown.all() else len(unknown)
    left_out = unknown | (curved & from_nowhere.any(axis=1))
    begins = bool(first < len(unknown) and not from_nowhere[first].any())
    if first < len(unknown) and motions.kind[first] == MotionKind.RAPID and not begins:
        left_out[first] = True
    motions = replace(motions, start=start, known_from=(0, 0, 0))
    tools = tuple(state.tool for state in program.states)
    return KnownCourse(
        Course.of(motions, tools, tuple(np.flatnonzero(left_out).tolist())), first, nowhere, at_home(program), begins
    )


def picked(course: Course, rows: NDArray[np.intp]) -> Course:
    """Return some motions of a course, in their order; `rows` rise."""
    motions = course.motions
    columns = {name: getattr(motions, name)[rows] for name in COLUMNS}
    splines = {
        int(np.searchsorted(rows, row)): motions.splines[row]
        for row in set(motions.splines).intersection(rows.tolist())
    }
    left_out = np.flatnonzero(np.isin(rows, course.left_out))
    return Course(replace(motions, splines=splines, **columns), course.tool[rows], tuple(left_out.tolist()))


def straight(start: Floats, end: Floats, kind: MotionKind = MotionKind.RAPID) -> Motions:
    """Return straight motions between (n, 3) places, mm."""
    count = len(start)
    small, whole = np.zeros(count, np.uint8), np.zeros(count, np.int32)
    return Motions(
        start=start.copy(),
        end=end.copy(),
        centre=np.full((count, 3), np.nan),
        kind=np.full(count, kind, np.uint8),
        plane=small,
        turns=whole,
        feed=np.zeros(count),
        line=whole,
        state=whole,
    )


class InsertedMotions(NamedTuple):
    """A course, and for each of its motions which of the inserted ones it is, -1: none."""

    course: Course
    owner: NDArray[np.intp]


def inserted(course: Course, at: NDArray[np.intp], more: Motions, tool: NDArray[np.int32]) -> InsertedMotions:
    """Return a course with more motions in it.

    Args:
        at: (n,) row of the course that each comes before, in any order; those before one row keep their order.
        more: n straight motions. tool: (n,) T number of each.
    """
    columns = {name: np.insert(getattr(course.motions, name), at, getattr(more, name), axis=0) for name in COLUMNS}
    owner = np.insert(np.full(len(course.motions), -1, np.intp), at, np.arange(len(more)))
    place = np.flatnonzero(owner < 0)
    splines = {int(place[row]): spline for row, spline in course.motions.splines.items()}
    left_out = tuple(place[list(course.left_out)].tolist())
    made = Course(
        replace(course.motions, splines=splines, **columns), np.insert(course.tool, at, tool).astype(np.int32), left_out
    )
    return InsertedMotions(made, owner)


# The metal at any place and any time, as finely as need be: what goes between the cells of the whole stock is looked
# at closer.


NARROW = 1.5
"""Cells of radius below which a cutter may go unseen between the cells' centres."""

FINE = 4.0
"""Cells of a closer look in the radius of what is led along a way."""

SIDE, LONG = 192, 20_000
"""Cells of one look along its shorter and its longer side, at most."""

LOOKS = 256
"""Looks at one way, at most; a longer one is looked at in as many places, spread evenly; `FineStock.wholly` says so."""

MOST = 3000
"""Ways of one kind that are looked at closer in a program."""


@dataclass(frozen=True, eq=False)
class CutterTravel:
    """Where a cutter is led, straight from point to point, when a motion is about to begin.

    Attributes:
        row: of the motion. points: (k, 3) mm, k >= 1. cutter: that is led there.
    """

    row: int
    points: Floats
    cutter: Cutter

    def radius(self, top: float) -> float:
        """Return how wide the cutter is at most below a height, mm."""
        return self.cutter.radius_at(top - float(self.points[:, 2].min()) - self.cutter.lift)

    def course(self) -> Course:
        """Return the way as rapids of T1."""
        points = self.points if len(self.points) > 1 else np.repeat(self.points, 2, axis=0)
        return Course(straight(points[:-1], points[1:]), np.ones(len(points) - 1, np.int32))


@dataclass(frozen=True, eq=False)
class FineStock:
    """What programs are cut out of.

    Attributes:
        stock: before all of them. courses: of the programs up to the one that is looked at, which is the last.
        cutters: by T number.
    """

    stock: StockShape
    courses: tuple[Course, ...]
    cutters: Mapping[int, Cutter]

    def over(self, grid: Grid, row: int) -> Workpiece:
        """Return the metal over a grid when a motion of the last program is about to begin."""
        stock = self.stock.over(grid)
        for k, course in enumerate(self.courses):
            rows = self.near(k, grid.box)
            rows = rows if k < len(self.courses) - 1 else rows[rows < row]
            if len(rows):
                stock = trim(stock, picked(course, rows), self.cutters, TrimOptions(Rapids.IGNORED)).workpiece
        return stock

    def met(self, way: CutterTravel, top: float, pitch: float) -> RapidHit | None:
        """Return where a way goes deepest into metal, None where it meets none.

        Args:
            top: no metal is higher, mm.
            pitch: of the cells, mm, where the cutter is wide.
        """
        deepest: RapidHit | None = None
        course = way.course()
        for grid in fine_grids(way, top, pitch, self.stock.box):
            stock = self.over(grid, way.row)
            for hit in trim(stock, course, {1: way.cutter}).rapids:
                if deepest is None or hit.depth > deepest.depth:
                    deepest = replace(hit, motion=way.row, cells=max(1, round(hit.cells * (grid.pitch / pitch) ** 2)))
        return deepest

    @staticmethod
    def wholly(way: CutterTravel, top: float, pitch: float) -> bool:
        """Return whether `met` looks at all of a way."""
        radius = way.radius(top)
        return radius <= 0 or len(_pieces(way, min(radius / FINE, pitch))) <= LOOKS

    def near(self, k: int, box: Box) -> NDArray[np.intp]:
        """Return the rows of a course that may cut in a box."""
        return self._reaches[k].meeting(box)

    @cached_property
    def _reaches(self) -> list[_ReachTree]:
        """Of each course the boxes that its motions cut in."""
        return [self._reach(course) for course in self.courses]

    def _reach(self, course: Course) -> _ReachTree:
        low, high = reach(course.motions)
        radius = np.full(len(course.motions), -math.inf)
        for number, cutter in self.cutters.items():
            radius[course.tool == number] = cutter.radius
        radius[course.motions.kind == MotionKind.RAPID] = -math.inf
        radius[list(course.left_out)] = -math.inf
        return _ReachTree.of(np.hstack([low[:, :2] - radius[:, None], high[:, :2] + radius[:, None]]))


@dataclass(frozen=True, eq=False)
class _ReachTree:
    """Boxes that motions cut in, in a tree: very many places are asked about on a large stock.

    Attributes:
        rows: (n,) numbers of the motions that cut anything, rising. boxes: (n, 4) of these, mm.
        order, nodes: the tree over them, see `app.geometry.kernels`.
    """

    rows: NDArray[np.intp]
    boxes: Floats
    order: NDArray[np.int64]
    nodes: Floats

    @staticmethod
    def of(boxes: Floats) -> _ReachTree:
        """Return it for boxes (m, 4) of all motions, mm; those of motions that cut nothing are not finite."""
        rows = np.flatnonzero(np.isfinite(boxes).all(axis=1))
        kept = np.ascontiguousarray(boxes[rows])
        if not len(rows):
            return _ReachTree(rows, kept, np.zeros(0, np.int64), np.zeros((0, 4)))
        return _ReachTree(rows, kept, *build_tree(kept))

    def meeting(self, box: Box) -> NDArray[np.intp]:
        """Return the motions whose boxes meet or touch a box, in their order."""
        found = np.empty(len(self.rows), np.int64)
        count = query_box(self.order, self.nodes, self.boxes, np.array(box, np.float64), found) if len(found) else 0
        return self.rows[np.sort(found[:count])]


def fine_grids(way: CutterTravel, top: float, pitch: float, stock: Box) -> Iterator[Grid]:
    """Yield grids that a way is seen on: what of it is below the top and over the stock, in pieces that are not too
    large.
    """
    radius = way.radius(top)
    if radius <= 0:
        return
    fine = min(radius / FINE, pitch)
    pieces = _pieces(way, fine)
    step = max(1, math.ceil(len(pieces) / LOOKS))
    for start, end in pieces[::step]:
        low, high = np.minimum(start, end), np.maximum(start, end)
        if low[2] + way.cutter.lift >= top:
            continue
        x0, y0 = np.maximum(low[:2] - radius, stock[:2]).tolist()
        x1, y1 = np.minimum(high[:2] + radius, stock[2:]).tolist()
        if x1 > x0 and y1 > y0:
            yield Grid(x0, y0, fine, max(1, math.ceil((y1 - y0) / fine)), max(1, math.ceil((x1 - x0) / fine)))


def _pieces(way: CutterTravel, fine: float) -> list[tuple[Floats, Floats]]:
    """Return a way in pieces that are looked at one by one."""
    return [piece for start, end in _legs(way.points) for piece in _chopped(start, end, fine)]


def _legs(points: Floats) -> Iterator[tuple[Floats, Floats]]:
    yield from pairwise(points) if len(points) > 1 else ((points[0], points[0]),)


def _chopped(start: Floats, end: Floats, fine: float) -> Iterator[tuple[Floats, Floats]]:
    """Yield a leg in pieces whose boxes have few cells."""
    wide, tall = np.abs(end[:2] - start[:2]).tolist()
    count = max(1, math.ceil(min(wide, tall) / (SIDE * fine)), math.ceil(max(wide, tall) / (LONG * fine)))
    at = start + (end - start) * np.linspace(0.0, 1.0, count + 1)[:, None]
    yield from pairwise(at)
