"""What a job is to clear, floor by floor: from its areas, its tools and their depths, before any path is looked at.

A tool of radius r that keeps a stock to leave reaches the opening of an area by its disc. Pockets and rest machining
want all that any tool reaches that goes as deep; a contour what its path along the walls covers; a path on a line what
lies within its cutter's radius. Operations whose floors lie at one height are asked together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...geometry.buffer import buffered
from ...geometry.primitives import contour_rows, sample
from ...model.job import Job
from ...model.moves import Area, DogBone, Program, Tab
from ...model.operation import Operation, Side
from ...model.part import Contour
from .areas import CutterInArea, common, grown, region_shapes, united, without

CHORD = 1e-3
"""mm; arcs are measured as chords that stay within this of them."""

FITS = 2e-3
"""mm by which a gap may be narrower than a tool that still counts as fitting: chords make it so by up to 1 um a
side.
"""

_SAME = 1e-9
"""mm between floors that are one."""

_BARE = 2e-3
"""mm; a path's outline this near to the offset of a clamp follows the clamp."""


@dataclass(frozen=True, eq=False)
class FloorTarget:
    """What is to be cleared at one floor, part coordinates.

    Attributes:
        depth: of the floor, mm below Z 0.
        floor: within the walls and their stock to leave.
        reach: of it, what some tool of the job reaches; where `out_of_reach` is known, that may be among it.
        target: of that, what is to be cleared; the same holds.
        whole: True where all of it is wanted, not paths alone.
        cutters: whose reach it is.
        out_of_reach: what of the floor no tool reaches, where that is known already.
    """

    depth: float
    floor: Shape
    reach: Shape
    target: Shape
    whole: bool
    cutters: tuple[CutterInArea, ...] = ()
    out_of_reach: Shape | None = None

    @cached_property
    def beyond(self) -> Shape:
        """What of the floor no tool reaches."""
        return without(self.floor, self.reach) if self.out_of_reach is None else self.out_of_reach


def floor_targets(program: Program, job: Job, off: float = 0.0) -> tuple[FloorTarget, ...]:
    """Return what a job has to clear, the shallowest floor first.

    Args:
        program: its areas, regions, tabs and dog-bones; not its moves.
        off: reach is that of tools that keep so much farther from the walls than asked, mm.
    """
    cutting = _cutting(program, job)
    made = _Shapes(job, off)
    floors: list[list[_ClearingOperation]] = []
    for work in sorted(cutting, key=lambda each: each.depth):
        if floors and work.depth - floors[-1][0].depth < _SAME:
            floors[-1].append(work)
        else:
            floors.append([work])
    found = [_wanted(group, cutting, made) for group in floors]
    return tuple(_without_tabs(each, program.tabs, program.dog_bones) for each in found if not each.floor.is_empty)


def cutters_of(program: Program, job: Job) -> tuple[float, tuple[CutterInArea, ...]]:
    """Return the deepest floor of a job, mm, and the cutters that reach farthest at that."""
    cutting, made = _cutting(program, job), _Shapes(job, 0.0)
    depth = max(each.depth for each in cutting)
    return depth, _cutters([each for each in cutting if each.depth > depth - _SAME and each.covers], made)


def areas_of_operations(program: Program, job: Job) -> tuple[Area, ...]:
    """Return the area of each operation of a job; where a program tells none, its regions are those of all."""
    if program.areas:
        return program.areas
    return tuple(Area(program.regions, whole=each.CLEARS) for each in job.operations)


@dataclass(frozen=True, eq=False)
class _ClearingOperation:
    """An operation that clears something, and where."""

    operation: Operation
    area: Area

    @property
    def depth(self) -> float:
        """Of its floor, mm."""
        return self.operation.cut.floor

    @property
    def covers(self) -> bool:
        """True where its tool may go all over its area."""
        return not self.area.lines


def _cutting(program: Program, job: Job) -> list[_ClearingOperation]:
    areas = areas_of_operations(program, job)
    return [
        _ClearingOperation(operation, area)
        for operation, area in zip(job.operations, areas, strict=True)
        if operation.cut.enabled and area.regions and operation.LEVELS
    ]


@dataclass
class _Shapes:
    """Polygons of areas and what tools reach of them; alike ones are made once.

    Attributes:
        job: whose tools these are.
        off: mm that a centre keeps off walls more than radius and stock to leave say.
    """

    job: Job
    off: float
    _made: dict[tuple[int, float, float], NDArray[np.object_]] = field(default_factory=dict)
    _floors: dict[tuple[int, float], Shape] = field(default_factory=dict)
    _kept: list[Area] = field(default_factory=list)

    def plain(self, area: Area) -> NDArray[np.object_]:
        """Return the area's regions as polygons; they stay apart."""
        return self._once(area, 0.0, 0.0)

    def inner(self, work: _ClearingOperation) -> NDArray[np.object_]:
        """Return where the centre of the operation's tool may be."""
        return self._once(work.area, self.wall(work) - FITS, 0.0)

    def floor(self, work: _ClearingOperation) -> Shape:
        """Return what of the operation's area is within the stock to leave on its walls."""
        shapes, leave = self.plain(work.area), work.operation.cut.stock_to_leave
        key = id(work.area.regions), leave
        if key not in self._floors:
            floor = united(grown(shapes, -leave, CHORD) if leave else shapes)
            self._floors[key] = without(floor, _polygons(work.area.air)) if work.area.air else floor
        return self._floors[key]

    def reach(self, work: _ClearingOperation) -> Shape:
        """Return what the operation's tool can cut without touching a wall: the opening by its disc."""
        return united(
            self._once(work.area, self.wall(work) - FITS, self.job.tool(work.operation.cut.tool).radius - FITS)
        )

    def reach_within(self, work: _ClearingOperation, floor: Shape, other: _ClearingOperation) -> Shape:
        """Return what the operation's tool can cut of the floor of another one.

        Where their areas differ it has to keep to both, and one that follows walls goes along its own alone: how far
        the frame round these goes says nothing.
        """
        if work.area.regions is other.area.regions:
            return common(self.reach(work), floor)
        plain = self.plain(work.area), self.plain(other.area)
        if _apart(*(shapely.total_bounds(shapes) for shapes in plain)):
            return shapely.Polygon()
        both = common(*map(united, plain))
        if both.is_empty:
            return both
        parts, radius = shapely.get_parts(both), self.job.tool(work.operation.cut.tool).radius
        parts = parts[shapely.area(parts) > 0]
        opened = grown(grown(parts, FITS - self.wall(work), CHORD), radius - FITS, CHORD)
        own = _along_walls(work, self) if work.operation.FOLLOWS_WALLS else self.reach(work)
        return common(common(united(opened), floor), own)

    def wall(self, work: _ClearingOperation) -> float:
        """Return how far the centre of the operation's tool stays from walls, mm."""
        return self.job.tool(work.operation.cut.tool).radius + work.operation.cut.stock_to_leave + self.off

    def _once(self, area: Area, less: float, more: float) -> NDArray[np.object_]:
        key = id(area.regions), less, more
        if key not in self._made:
            self._kept.append(area)  # so that no other area gets its id
            if more:
                self._made[key] = np.asarray(grown(self._once(area, less, 0.0), more, CHORD), dtype=object)
            elif less:
                self._made[key] = np.asarray(grown(self._once(area, 0.0, 0.0), -less, CHORD), dtype=object)
            else:
                self._made[key] = region_shapes(area.regions, CHORD)
        return self._made[key]


def _apart(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Tell whether two boxes (4,), or none, have nothing in common."""
    return not bool(np.all(one[:2] < other[2:]) and np.all(other[:2] < one[2:]))


def _wanted(group: Sequence[_ClearingOperation], cutting: Sequence[_ClearingOperation], made: _Shapes) -> FloorTarget:
    """Return what the operations of one floor want."""
    depth = max(each.depth for each in group)
    covering = [each for each in cutting if each.depth > depth - _SAME and each.covers]
    farthest, cutters = _farthest(covering, made.job), _cutters(covering, made)
    within: dict[
        int, tuple[Shape, Shape]
    ] = {}  # floors by their identity, and what of each is reached: operations often share one
    target, lines = [], []
    for work in group:
        if work.area.lines:
            lines.append(_on_lines(work, made))
            continue
        floor = made.floor(work)
        if work.operation.wall_side is Side.OUTSIDE:
            floor = common(floor, _band(work, made))
        if id(floor) not in within:
            within[id(floor)] = floor, united([made.reach_within(each, floor, work) for each in farthest])
        target.append(_along_walls(work, made) if work.operation.FOLLOWS_WALLS else within[id(floor)][1])
    requested = united([*{id(each): each for each in target}.values(), *lines])
    floor, reached = (united([*(pair[k] for pair in within.values()), *lines]) for k in (0, 1))
    whole = any(each.operation.CLEARS for each in group)
    return FloorTarget(depth, floor, reached, requested, whole, cutters)


def _cutters(works: Sequence[_ClearingOperation], made: _Shapes) -> tuple[CutterInArea, ...]:
    """Return the cutters that reach farthest of those of some operations."""
    return tuple(
        CutterInArea(each.area.regions, made.wall(each), made.job.tool(each.operation.cut.tool).radius)
        for each in _farthest(works, made.job)
    )


def _farthest(works: Sequence[_ClearingOperation], job: Job) -> list[_ClearingOperation]:
    """Return the operations whose tools reach farthest in their areas: what any other one reaches, one of these
    does.
    """

    def size(work: _ClearingOperation) -> tuple[float, float]:
        return job.tool(work.operation.cut.tool).radius, work.operation.cut.stock_to_leave

    kept: list[_ClearingOperation] = []
    for work in sorted(works, key=size):
        if not any(
            each.area.regions is work.area.regions and all(a <= b for a, b in zip(size(each), size(work), strict=True))
            for each in kept
        ):
            kept.append(work)
    return kept


def _along_walls(work: _ClearingOperation, made: _Shapes) -> Shape:
    """Return what the tool covers when its centre follows the walls, but not clamps."""
    radius, wall = made.job.tool(work.operation.cut.tool).radius, made.wall(work)
    return united(buffered(_beside_bare(made.inner(work), work, wall), radius - FITS, 64))


def _band(work: _ClearingOperation, made: _Shapes) -> Shape:
    """Return what the tool would cover if it could follow all walls: what lies as near to one as it is wide."""
    wide = work.operation.cut.stock_to_leave + made.job.tool(work.operation.cut.tool).diameter
    return united(buffered(_beside_bare(made.plain(work.area), work, 0.0), wide, 64))


def _beside_bare(shapes: NDArray[np.object_], work: _ClearingOperation, distance: float) -> NDArray[np.object_]:
    """Return the outlines of shapes (n,), but for what runs along clamps or the frame, a distance from them, mm."""
    outlines = np.asarray(shapely.boundary(shapes), dtype=object)
    if not work.area.bare:
        return outlines
    bare = shapely.union_all([_line(contour) for contour in work.area.bare])
    return np.asarray(shapely.difference(outlines, shapely.buffer(bare, distance + _BARE, quad_segs=64)), dtype=object)


def _on_lines(work: _ClearingOperation, made: _Shapes) -> Shape:
    """Return what the tool covers when its centre is on lines, where no clamp is in the way; nothing for tools that are
    not flat.
    """
    tool = made.job.tool(work.operation.cut.tool)
    if not tool.kind.square:
        return shapely.Polygon()
    lines = shapely.intersection(
        shapely.union_all([_line(contour) for contour in work.area.lines]), shapely.union_all(made.inner(work))
    )
    return buffered(lines, tool.radius - FITS, 64)


def _polygons(contours: Sequence[Contour]) -> Shape:
    """Return outlines that do not cross as one shape."""
    return united([shapely.Polygon(sample(contour_rows(contour), CHORD)) for contour in contours])


def _line(contour: Contour) -> Shape:
    """Return a contour as a line of chords."""
    rows = contour_rows(contour)
    return shapely.LineString(np.concatenate([sample(rows, CHORD), rows[-1:, 2:4]]))


def _without_tabs(found: FloorTarget, tabs: Sequence[Tab], dog_bones: Sequence[DogBone]) -> FloorTarget:
    """Return what is wanted without the metal that stands in tabs, and with what dog-bones cut into walls."""
    deep = [tab for tab in tabs if tab.top > -found.depth + _SAME]
    # half the way over it, and the cutter's radius: also where the path is bent
    reach = [tab.width / 2 + tab.diameter for tab in deep]
    held = united([shapely.Point(tab.x, tab.y).buffer(radius) for tab, radius in zip(deep, reach, strict=True)])
    bones = united([dog_bone_shape(dog_bone) for dog_bone in dog_bones])
    floor = without(found.floor, without(bones, found.reach)) if dog_bones else found.floor
    return replace(found, floor=floor, target=without(found.target, held) if deep else found.target)


def dog_bone_shape(dog_bone: DogBone) -> Shape:
    """Return what the cutter covers in a dog-bone."""
    return shapely.LineString([(dog_bone.x0, dog_bone.y0), (dog_bone.x1, dog_bone.y1)]).buffer(
        dog_bone.diameter / 2, quad_segs=64
    )
