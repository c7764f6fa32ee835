"""V-carving: straight moves along the medial axis, as deep as the cone is when it touches the walls at the surface."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.buffer import buffered
from ...geometry.distance import DistanceField
from ...geometry.medial_axis.axis import MedialAxis, medial_axes
from ...geometry.offset.offset import Ring, offset_levels
from ...geometry.primitives import CX, Primitives, R, Rows, sample, within_half_turn
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.moves import Purpose
from ...model.operation import Operation
from ...model.tool import Tool
from ...toolpath.build import MovesBuilder, Stroke, StrokeLabel
from ...toolpath.depth import DepthLevels
from ...toolpath.operation_context import OperationContext, check_depth, levels_of
from ..engrave.open_line import clear_parts, runs_of_parts
from .branches import AxisBranch, Floats, JoinedBranches, between, branches, joined
from .graph import end_discs, graph_of, prune, trails

_TOLD = 20
"""Places that are told one by one."""

_SAME = 1e-9
"""mm; lengths that differ by no more are equal."""

_CLEARED = 1e-3
"""mm; stock to leave that is so near to how wide the cone is clears the floor that it leaves."""

RIDGE = 0.1
"""mm; the height of the ridges that the cone leaves where the flat tool does not reach the floor."""

_SLACK = 1e-6
"""mm by which passes overlap, so that digits leave no gap between them."""


@dataclass(frozen=True)
class VCutter:
    """A V cutter.

    Attributes:
        tip: radius of the flat at its end, mm; less by as much as it reaches over edges on purpose.
        rate: mm of radius per mm of height: the tangent of half the tip's angle.
        widest: radius where the cone ends, mm.
    """

    tip: float
    rate: float
    widest: float

    def radius(self, depth: float) -> float:
        """Return how wide it is at the surface when its tip is so deep, mm."""
        return self.tip + depth * self.rate

    def depth(self, radius: Floats) -> Floats:
        """Return how deep its tip is when it is so wide at the surface, mm; never above it."""
        return np.maximum(radius - self.tip, 0.0) / self.rate


def cone_of(job: Job, operation: Operation) -> VCutter:
    """Return the cone of an operation's tool.

    Raises:
        ParameterError: the tool has none, or is not as wide at the operation's depth.
    """
    tool = job.cutter(operation)
    cone = VCutter(tool.tip_diameter / 2, math.tan(tool.tip_angle / 2), tool.radius)
    deepest = float(cone.depth(np.array([cone.widest]))[0])
    if operation.cut.depth > deepest + _SAME:
        raise ParameterError(
            f"Depth is {operation.cut.depth:g} mm, but the cone of T{tool.number} {tool.label} is {deepest:.3f} mm "
            "high: it would cut with its shank; reduce the depth, or take a wider cutter."
        )
    return cone


@dataclass(frozen=True, eq=False)
class CarvedPass:
    """The ways of one depth pass.

    Attributes:
        trails: along the medial axis.
        rings: at the pass's height, where the area is wider than the cone.
    """

    z: float
    trails: tuple[AxisBranch, ...]
    rings: tuple[Ring, ...]


def vcarve(context: OperationContext, index: int, progress: Progress) -> None:
    """Carve the area of an operation."""
    job = context.job
    operation = job.operations[index]
    area, cut, tool = context.areas.of(operation), operation.cut, job.tool(operation.cut.tool)
    cone = cone_of(job, operation)
    if area is None:
        return
    check_depth(job, cut)
    levels, label = levels_of(context, cut), StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    passes = list(carved(area.primitives, cone, levels.passes, progress.part(0.0, 0.7)))
    if (flat := flat_tool_of(job, operation)) is not None and passes[-1].rings:
        passes.append(floor_corners(area.primitives, cone, -passes[-1].z, flat.radius, progress.part(0.7, 0.9)))
        context.findings.extend(_ridges(passes[-1], tool, flat))
    context.findings.extend(_too_wide(job, operation, cone, passes[-1].rings))
    context.findings.extend(_cut_into(job, operation, cone))
    writer = PassWriter(context.builder, label, levels, cone)
    for k, each in enumerate(passes):
        progress.step(0.9 + 0.1 * k / len(passes), "Depth passes")
        writer.cut(each, context.at)
        if context.builder.at[0] == context.builder.at[0]:
            context.at = context.builder.at[:2]
        context.strokes += len(each.trails) + len(each.rings)


def carved(primitives: Primitives, cone: VCutter, heights: Sequence[float], progress: Progress) -> Iterator[CarvedPass]:
    """Yield the ways of each depth pass: what of the axis is deeper than the pass before, and at the pass's own height
    the ring from which the cone touches the walls.

    Raises:
        GeometryError: the medial axis is not proven right.
        Cancelled: by progress.
    """
    whole, lone = _followed(medial_axes(primitives, progress.part(0.0, 0.6)))
    lone += _round_ones(primitives)
    radii = [cone.radius(-z) for z in heights]
    rings = offset_levels(primitives, radii, progress.part(0.6, 1.0))
    low = max(cone.tip, _SAME)
    for z, high, level in zip(heights, radii, rings, strict=True):
        parts = between(whole, low - _SLACK, high)
        points = [AxisBranch(disc[None]) for disc in lone if low - _SLACK <= disc[2] <= high]
        yield CarvedPass(z, (*trails(graph_of(parts)), *points), level.rings)
        low = high


def _followed(axes: Sequence[MedialAxis]) -> tuple[list[AxisBranch], list[Floats]]:
    """Return the branches of axes that are worth going, and the discs (3,) of nodes that nothing else leads to: once
    for all regions that are alike, and moved to each.
    """
    whole: list[AxisBranch] = []
    lone: list[Floats] = []
    known: dict[int, tuple[JoinedBranches, list[Floats]]] = {}
    for axis in axes:
        # the axes keep their pieces alive, so that no other ones get the same id
        if id(axis.pieces) not in known:
            graph = graph_of(branches(replace(axis, middle=np.zeros(2))))
            single = prune(graph)
            kept = sorted({k for own in graph.at for k in own})
            known[id(axis.pieces)] = joined([graph.branches[k] for k in kept]), single
        (discs, upto), single = known[id(axis.pieces)]
        there = np.append(axis.middle, 0.0)
        discs = discs + there
        whole += [AxisBranch(discs[a:b]) for a, b in pairwise(upto.tolist())]
        lone += [disc + there for disc in single]
    return whole, lone


def flat_tool_of(job: Job, operation: Operation) -> Tool | None:
    """Return the tool that clears the floor of a carving before it; None where none is asked for."""
    wanted = operation.prepared_by(job.tool(operation.cut.tool))
    return job.tool(wanted[0].cut.tool) if wanted else None


def floor_corners(primitives: Primitives, cone: VCutter, depth: float, flat: float, progress: Progress) -> CarvedPass:
    """Return the ways at the greatest depth over what of the floor a flat tool does not reach: in its corners and where
    it is narrow.

    Rings inside the one from which the cone touches the walls, so near to one another that no ridge between them is
    higher than `RIDGE`, where they are farther from the flat tool's centre than it is wide, or nearer by half a step,
    so that what stands beside the flat tool's edge has them as near as elsewhere; and the medial axis there.

    Args:
        depth: greatest, mm. flat: radius of the flat tool, mm.

    Raises:
        Cancelled: by progress.
    """
    wall = cone.radius(depth)
    step = 2 * max(cone.tip, 0.0) + 2 * RIDGE * cone.rate
    inner = wall - cone.tip + flat
    levels = [*np.arange(wall + step, inner - _SAME, step).tolist(), inner]
    made = offset_levels(primitives, levels, progress.part(0.0, 0.4), frame=False)
    reached = [ring.rows for ring in made[-1].rings]
    field = DistanceField.of(within_half_turn(np.concatenate(reached))) if reached else None
    edge = flat - step / 2
    rings = tuple(piece for level in made[:-1] for ring in level.rings for piece in _beyond_flat(ring, field, edge))
    whole = [branch for axis in medial_axes(primitives, progress.part(0.4, 1.0)) for branch in branches(axis)]
    parts = between(whole, wall - _SLACK, inner)
    return CarvedPass(-depth, tuple(trails(graph_of(parts))), rings)


def _ridges(corners: CarvedPass, tool: Tool, flat: Tool) -> Iterator[Finding]:
    """Yield that the cone leaves ridges on what of the floor it goes over in rings."""
    if corners.rings:
        x, y = corners.rings[0].rows[0, :2].tolist()
        text = (
            f"T{tool.number} {tool.label} goes over what T{flat.number} {flat.label} does not reach of the floor, and "
            f"leaves ridges of up to {RIDGE:g} mm there, the first at {in_plane(x, y)}; a narrower flat tool leaves "
            "fewer."
        )
        yield Finding(FindingKind.RIDGE, text, x, y, counts=False, amount=RIDGE)


def _beyond_flat(ring: Ring, field: DistanceField | None, flat: float) -> Iterator[Ring]:
    """Yield what of a ring is farther than so many mm from all places of a flat tool's centre."""
    if field is None:
        yield ring
        return
    row, low, high = clear_parts(ring.rows, field, flat - _SLACK, bounded=False)
    yield from (replace(ring, rows=piece) for piece in runs_of_parts(ring.rows, row, low, high))


def _round_ones(primitives: Primitives) -> list[Floats]:
    """Return the disc of each region that is one: its medial axis is a point."""
    numbers, group = np.unique(primitives.region, return_inverse=True)
    order = np.argsort(group, kind="stable")
    rows = primitives.rows[order]
    firsts = np.searchsorted(group[order], np.arange(len(numbers)))
    if not len(numbers):
        return []
    least, most = (bound.reduceat(rows[:, CX:], firsts) for bound in (np.minimum, np.maximum))
    # columns: centre, radius, turn
    alike = ((most - least)[:, :3].max(axis=1) < _SAME) & (least[:, 3] > 0)
    return [rows[first, CX : R + 1].copy() for first in firsts[alike].tolist()]


@dataclass(eq=False)
class PassWriter:
    """Appends the moves of passes."""

    builder: MovesBuilder
    label: StrokeLabel
    levels: DepthLevels
    cone: VCutter

    def cut(self, each: CarvedPass, at: tuple[float, float]) -> None:
        """Append a pass: whichever way begins nearest comes next, from its nearer end."""
        x, y, _ = self.builder.at
        at = at if x != x else (x, y)
        self._trails(list(nearest_next(each.trails, at)), each.z)
        for ring in each.rings:
            self._ring(ring, each.z)

    def _trails(self, ways: Sequence[AxisBranch], z: float) -> None:
        discs, upto = joined(ways)
        heights = np.maximum(-self.cone.depth(discs[:, 2]), z)
        # from each disc to the next, also from the last one of a way to the next way, where nothing goes along
        rows = np.zeros((max(len(discs) - 1, 0), 8))
        rows[:, :2], rows[:, 2:4] = discs[:-1, :2], discs[1:, :2]
        feed = self._feeds(rows, heights)
        purpose = np.full(len(rows), Purpose.CONTOUR, np.uint8)
        for first, stop in pairwise(upto.tolist()):
            x, y = discs[first, :2].tolist()
            self._down(x, y, float(heights[first]))
            if stop - first > 1:
                own = slice(first, stop - 1)
                self.builder.along(Stroke(rows[own], purpose[own], 0), heights[first + 1 : stop], self.label, feed[own])
            self._up()

    def _ring(self, ring: Ring, z: float) -> None:
        self._down(float(ring.rows[0, 0]), float(ring.rows[0, 1]), z)
        stroke = Stroke(ring.rows, np.full(len(ring.rows), Purpose.CONTOUR, np.uint8), 0)
        heights = np.full(len(ring.rows) + 1, z)
        self.builder.along(stroke, heights[1:], self.label, self._feeds(ring.rows, heights))
        self._up()

    def _feeds(self, rows: Rows, heights: Floats) -> Floats:
        """Return the feed rate (n,) along rows between heights (n + 1,), down no faster than a plunge, mm/min."""
        fall = heights[:-1] - heights[1:]
        size = np.hypot(np.hypot(*(rows[:, 2:4] - rows[:, :2]).T), fall)
        steep = np.maximum(fall, 0.0) / np.maximum(size, 1e-12)
        feed = np.minimum(self.label.feed, self.label.plunge_rate / np.maximum(steep, 1e-9))
        return np.maximum(feed, min(self.label.feed, self.label.plunge_rate))

    def _down(self, x: float, y: float, z: float) -> None:
        for height in self.levels.over(x, y):
            self.builder.straight((x, y, height), Purpose.RAPID, self.label)
        self.builder.straight((x, y, z), Purpose.PLUNGE, self.label)

    def _up(self) -> None:
        x, y, _ = self.builder.at
        self.builder.straight((x, y, self.levels.travel), Purpose.RAPID, self.label)


def nearest_next(trails: Sequence[AxisBranch], at: tuple[float, float]) -> Iterator[AxisBranch]:
    """Yield ways, whichever begins nearest to where the one before ends next, from its nearer end.

    Args:
        at: where the first one is gone to from, mm.
    """
    if not trails:
        return
    from ...geometry.kernels import build_tree  # compiled code: loaded where it is used
    from .order_kernels import nearest_order

    ends = np.ascontiguousarray(end_discs(trails)[:, :2])
    first = np.empty(len(trails), np.int64)
    nearest_order(ends, *build_tree(np.hstack([ends, ends])), *at, first)
    for end in first.tolist():
        yield trails[end // 2].backwards() if end % 2 else trails[end // 2]


def _too_wide(job: Job, operation: Operation, cone: VCutter, rings: Sequence[Ring]) -> list[Finding]:
    """Return where the area is wider than the V at its greatest depth, so that it leaves ridges on the floor."""
    cut, tool = operation.cut, job.tool(operation.cut.tool)
    wide = cut.depth * cone.rate
    clears = [each for each in _beside(job, operation) if each.CLEARS and abs(each.cut.floor - cut.depth) < _SAME]
    if any(abs(each.cut.stock_to_leave - wide) < _CLEARED for each in clears):
        return []
    floors = _floors(rings, cone.tip) if rings else []
    found = []
    for floor in sorted(floors, key=lambda each: -each.area)[:_TOLD]:
        x, y = shapely.get_coordinates(shapely.point_on_surface(floor))[0].tolist()
        text = (
            f"At {in_plane(x, y)} the area is wider than T{tool.number} {tool.label} at its greatest depth, "
            f"{cut.depth:g} mm: {floor.area:.3f} mm2 of floor are left to a flat tool; name one as its flat_tool, or "
            f"clear them first by a pocket operation of the same depth with {wide:.4f} mm of stock to leave."
        )
        found.append(Finding(FindingKind.LEFT_OUT, text, x, y, amount=float(floor.area)))
    return found


def _beside(job: Job, operation: Operation) -> list[Operation]:
    """Return the operations of a job that mill the same curves with upright walls."""
    return [
        each
        for each in job.operations
        if each.cut.enabled
        and not (each.CARVES or each.HOLES)
        and each.wall_side is operation.wall_side
        and each.cut.curves == operation.cut.curves
    ]


def _cut_into(job: Job, operation: Operation, cone: VCutter) -> list[Finding]:
    """Return which operations leave too little on the walls, and so cut into what is to be carved."""
    found = []
    for each in _beside(job, operation):
        wide = min(each.cut.floor, operation.cut.depth) * cone.rate
        if each.cut.stock_to_leave < wide - _CLEARED:
            text = (
                f"The {each.WORD} operation of T{each.cut.tool} leaves {each.cut.stock_to_leave:g} mm on the walls, "
                f"and so cuts into the slanted ones of the {operation.WORD} operation, which are {wide:.4f} mm wide as "
                f"deep as that; leave {wide:.4f} mm."
            )
            found.append(Finding(FindingKind.GOUGE, text, amount=wide - each.cut.stock_to_leave))
    return found


def _floors(rings: Sequence[Ring], tip: float) -> list[shapely.Polygon]:
    """Return what rings bound, without what a flat tip clears on its way along them."""
    outer = [shapely.Polygon(sample(ring.rows, 1e-3)) for ring in rings if ring.area > 0]
    inner = [shapely.Polygon(sample(ring.rows, 1e-3)) for ring in rings if ring.area <= 0]
    filled = shapely.difference(shapely.union_all(outer), shapely.union_all(inner))
    left = buffered(filled, -tip, 64) if tip else filled
    return [part for part in shapely.get_parts(left).tolist() if part.area > 1e-6]
