"""Chamfers: the cone goes along the walls at one depth, and up into corners and narrow places, as in V-carving.

The chamfer is W wide on the top; the cone, of half angle a and flat tip f, touches the drawn wall W / tan a below the
surface and goes t deeper with its tip. So it is f + t tan a wide where it touches the wall, which is how far its axis
keeps off, and W more at the surface. Where the walls leave less room than that, it comes up until it touches them as
high: a V-carving whose cone is W narrower than the real one.

A ball touches the wall and the top at the two ends of the chamfer and hollows it between them. It stays at one height:
where walls leave less room than it keeps off them, as at inner corners, the edge stays sharp, which the proof tells.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import Ring, offset_levels
from ...geometry.primitives import CX, TURN, R, Rows, contour_rows, lengths, points_at, reversed_rows, within_half_turn
from ...model.chamfer_operation import ChamferOperation
from ...model.curves import Line
from ...model.finding import Finding, FindingKind
from ...model.job import Job
from ...model.operation import Direction, Side
from ...model.part import Contour
from ...model.tool import Tool
from ...toolpath.build import StrokeLabel
from ...toolpath.drawn_contours import selected
from ...toolpath.machining_areas import MachiningArea, MachiningAreas
from ...toolpath.narrow_regions import too_small
from ...toolpath.operation_context import OperationContext, levels_of
from ..engrave.open_line import clear_parts, runs_of_parts
from ..vcarve.branches import AxisBranch
from ..vcarve.paths import CarvedPass, PassWriter, VCutter, carved

Floats = NDArray[np.float64]

_SAME = 1e-9
"""mm; lengths that differ by no more are equal."""
_BEYOND = 1e-3
"""mm of the metal behind the end of a line, more than the chamfer is wide, that the cutter need not keep off."""
_STRAIGHT = 1e-6
"""Radians by which rows of one straight edge may turn."""
_DENSE = 0.01
"""mm between the cones of a way into a corner, of which a part is left out: between two of them a wall comes nearer by
less than 0.1 um.
"""
_WELD = 1e-6
"""mm; places that are no farther apart are one."""


@dataclass(frozen=True)
class ChamferCutter:
    """The cone of a chamfer, or its ball.

    Attributes:
        narrowed: the V-carving cone that is as much narrower as the chamfer is wide.
        round: whether it is a ball, which stays at its depth.
        depth: of the tip, mm. off: how far the axis keeps off the walls, mm. top: how wide it is at the surface, mm.
    """

    narrowed: VCutter
    round: bool
    depth: float
    off: float
    top: float


def cutter_of(job: Job, operation: ChamferOperation) -> ChamferCutter:
    """Return the cone of an operation's tool, or its ball.

    Raises:
        ParameterError: the tool is neither, its cone is too low, the chamfer too large for the ball, or the tip would
            go below the stock and its waste.
    """
    tool = job.cutter(operation)
    if (ball := operation.ball(tool)) is not None:
        _check_stock(job, tool, ball.depth)
        top = ball.off + operation.width
        return ChamferCutter(VCutter(ball.off, 1.0, tool.radius), round=True, depth=ball.depth, off=ball.off, top=top)
    tip, rate, depth = tool.tip_diameter / 2, math.tan(tool.tip_angle / 2), operation.deepest(tool)
    top = tip + depth * rate
    if top > tool.radius + _SAME:
        raise ParameterError(
            f"A chamfer of {operation.width:g} mm with the tip {operation.tip_offset:g} mm below it needs a cone of "
            f"{2 * top:.3f} mm, and T{tool.number} {tool.label} is {tool.diameter:g} mm wide; take a wider cutter, "
            "or less of either."
        )
    _check_stock(job, tool, depth)
    return ChamferCutter(
        VCutter(tip - operation.width, rate, tool.radius), round=False, depth=depth, off=top - operation.width, top=top
    )


def _check_stock(job: Job, tool: Tool, depth: float) -> None:
    """Refuse a tip that would go below the stock and its waste."""
    if depth > job.stock.thickness + job.stock.under + _SAME:
        raise ParameterError(
            f"The tip of T{tool.number} {tool.label} would go {depth:.3f} mm deep, and the stock is "
            f"{job.stock.thickness:g} mm thick; make the chamfer narrower, or the tip offset less."
        )


def chamfer(context: OperationContext, index: int, progress: Progress) -> None:
    """Break the edges of an operation's contours.

    Raises:
        ParameterError: the cone is too low, or the stock too thin.
        GeometryError: the medial axis is not proven right.
        Cancelled: by progress.
    """
    job = context.job
    operation = job.operations[index]
    assert isinstance(operation, ChamferOperation)
    cone, tool = cutter_of(job, operation), job.tool(operation.cut.tool)
    area = context.areas.of(operation)
    if area is None:
        context.findings.extend(_nothing_open(operation, tool))
        return
    if cone.round:
        (level,) = offset_levels(area.primitives, [cone.off], progress.part(0.0, 0.8))
        whole = CarvedPass(-cone.depth, (), level.rings)
        context.findings.extend(too_small(area.regions, level, tool, 2 * cone.off))
    else:
        (whole,) = carved(area.primitives, cone.narrowed, (-cone.depth,), progress.part(0.0, 0.8))
    followed = _followed(whole, area, operation)
    progress.step(0.8, "Neighbour walls")
    around = _Around(_neighbours(context.areas, operation), _held(context.areas), _behind_lines(area, operation))
    kept, lost = _beside(followed, around, tool, cone)
    context.findings.extend(_stopped_short(lost, tool, cone))
    label = StrokeLabel(index, tool.number, tool.feed_rate, tool.plunge_rate)
    writer = PassWriter(context.builder, label, levels_of(context, operation.cut), cone.narrowed)
    writer.cut(kept, context.at)
    if context.builder.at[0] == context.builder.at[0]:
        context.at = context.builder.at[:2]
    context.strokes += len(kept.trails) + len(kept.rings)


def _nothing_open(operation: ChamferOperation, tool: Tool) -> Iterator[Finding]:
    """Yield that the edges of open lines are to be broken, and there is none."""
    if operation.takes_open:
        text = (
            f"T{tool.number} {tool.label} has no edge to break: with open_side = {operation.open_side.value} it takes "
            "open lines alone, and none is chosen; leave that out for closed contours."
        )
        yield Finding(FindingKind.LEFT_OUT, text)


def _followed(whole: CarvedPass, area: MachiningArea, operation: ChamferOperation) -> CarvedPass:
    """Return the ways along walls: not those along clamps or the frame, nor past the ends of open lines."""
    trails = tuple(way for way in whole.trails if not _at_bare(way, area))
    rings: Iterable[Ring] = (ring for ring in whole.rings if not area.follows_bare(ring.rows).all())
    if operation.takes_open:
        rings = [run for ring in rings for run in _along_lines(ring, area)]
    if operation.cut.direction is Direction.CONVENTIONAL:
        rings = (replace(ring, rows=reversed_rows(ring.rows)) for ring in rings)
    return CarvedPass(whole.z, trails, tuple(rings))


def _along_lines(ring: Ring, area: MachiningArea) -> Iterator[Ring]:
    """Yield what of a ring runs beside open lines: from the foot of one end to that of the other."""
    rows, before = area.primitives.rows, area.primitives.previous
    ends = rows[area.bare != area.bare[before], :2]
    past = area.follows_bare(ring.rows)
    for end in ends:
        past |= (ring.rows[:, TURN] != 0) & (np.hypot(*(ring.rows[:, CX:R] - end).T) < _WELD)
    if past.all():
        return
    first = int(np.argmax(past))
    turned, past = np.roll(ring.rows, -first, axis=0), np.roll(past, -first)
    edges = np.flatnonzero(np.diff(np.concatenate([[True], past, [True]]).astype(np.int8)))
    yield from (replace(ring, rows=turned[a:b]) for a, b in edges.reshape(-1, 2).tolist())


def _at_bare(way: AxisBranch, area: MachiningArea) -> bool:
    return bool(area.bare.any() and area.bare[area.distances.nearest(way.discs[:, :2])[1]].any())


class _Around(NamedTuple):
    """Rows of what the cutter keeps off: contours that are not chamfered, clamps, and what is behind open lines."""

    neighbours: Rows
    held: Rows
    behind: Rows


def _neighbours(areas: MachiningAreas, operation: ChamferOperation) -> Rows:
    """Return the rows of all other contours, among them open lines that other operations chamfer."""
    drawn, chosen = areas.drawn, selected(areas.drawn, operation.cut.curves)
    own = {id(contour) for contour in (chosen.open if operation.takes_open else chosen.closed)}
    edges = [
        line
        for each in areas.job.operations
        if each.cut.enabled and operation.takes_open and each.takes_open and each.wall_side is Side.INSIDE
        for line in selected(drawn, each.cut.curves).open
    ]
    return _rows([contour for contour in (*drawn.closed, *edges) if id(contour) not in own])


def _held(areas: MachiningAreas) -> Rows:
    return _rows([contour for region in areas.drawn.clamps for contour in region.contours])


def _rows(contours: Sequence[Contour]) -> Rows:
    return within_half_turn(np.concatenate([np.zeros((0, 8)), *map(contour_rows, contours)]))


def _behind_lines(area: MachiningArea, operation: ChamferOperation) -> Rows:
    """Return the straight rows that bound the metal behind open lines, but for what a chamfer takes off at their ends.

    A cutter that keeps off the rest by as much as it is wide on the top takes no more off there than the chamfer does,
    by the triangle's inequality. Only the edge that begins at an end is its own: what else is as near is the metal
    behind another line.
    """
    if not operation.takes_open:
        return _rows([])
    rows, before = area.primitives.rows, area.primitives.previous
    lengths_of, straight = lengths(rows), area.bare & (rows[:, TURN] == 0)
    taken = np.zeros((len(rows), 2))  # of each row, mm, at its beginning and at its end
    following = np.argsort(before)
    for k in np.flatnonzero(area.bare != area.bare[before]).tolist():
        ahead = bool(area.bare[k])
        begins, links = (k, following) if ahead else (int(before[k]), before)
        for each in _edge_at(begins, links, rows, operation.width):
            taken[each.row, 0 if ahead else 1] = each.length
    shares = taken / np.maximum(lengths_of, _WELD)[:, None]
    left = np.flatnonzero(straight & (lengths_of - taken.sum(axis=1) > _WELD))
    starts, ends = points_at(rows[left], shares[left, 0]), points_at(rows[left], 1 - shares[left, 1])
    return _rows(
        [
            Contour((Line(tuple(a), tuple(b)),), closed=False)
            for a, b in zip(starts.tolist(), ends.tolist(), strict=True)
        ]
    )


class _TakenOff(NamedTuple):
    """A row, and how much of it a chamfer takes off at the end of a line, mm."""

    row: int
    length: float


def _edge_at(row: int, links: NDArray[np.int64], rows: Rows, width: float) -> Iterator[_TakenOff]:
    """Yield what a chamfer of a width takes off the straight rows of the edge that begins with one.

    Args:
        links: from each row to the next one on the edge.
    """
    first, left = rows[row, 2:4] - rows[row, :2], width + _BEYOND
    while left > 0 and rows[row, TURN] == 0:
        way = rows[row, 2:4] - rows[row, :2]
        long = float(np.hypot(*way))
        if abs(first[0] * way[1] - first[1] * way[0]) > _STRAIGHT * long * np.hypot(*first):
            return
        yield _TakenOff(row, min(long, left))
        row, left = int(links[row]), left - long


def _beside(
    ways: CarvedPass, around: _Around, tool: Tool, cone: ChamferCutter
) -> tuple[CarvedPass, list[tuple[float, float, float]]]:
    """Return the ways on which the cone keeps off all round it, and (x, y, length, mm) of the others."""
    lost: list[tuple[float, float, float]] = []
    for rows, wide in ((around.neighbours, cone.top), (around.behind, cone.top), (around.held, tool.radius)):
        if len(rows):
            field = DistanceField.of(rows)
            ways = CarvedPass(
                ways.z, tuple(_clear_trails(ways, field, wide, cone, lost)), tuple(_clear(ways, field, wide, lost))
            )
    return ways, lost


def _clear_trails(
    ways: CarvedPass, field: DistanceField, wide: float, cone: ChamferCutter, lost: list[tuple[float, float, float]]
) -> Iterator[AxisBranch]:
    """Yield what of the ways into corners keeps off some walls; `wide`: where they are deepest, mm."""
    for way in ways.trails:
        clear = _clear_discs(way.discs, field, wide - cone.off)
        if clear.all():
            yield way
            continue
        discs, given = _dense(way.discs)
        clear = _clear_discs(discs, field, wide - cone.off)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], clear, [False]]).astype(np.int8))).reshape(-1, 2)
        places = [np.unique([a, *given[(given > a) & (given < b)], b - 1]) for a, b in edges.tolist()]
        kept = [AxisBranch(discs[each]) for each in places if len(each) > 1]
        x, y = discs[np.argmin(clear), :2].tolist()
        lost.append((x, y, way.length - sum(each.length for each in kept)))
        yield from kept


def _clear_discs(discs: Floats, field: DistanceField, wider: float) -> NDArray[np.bool_]:
    """Tell which discs, so much wider than they are, mm, keep off some walls."""
    clear: NDArray[np.bool_] = field.nearest(discs[:, :2])[0] >= discs[:, 2] + wider - _WELD
    return clear


def _dense(discs: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Return discs no farther apart than `_DENSE`, and which of them are those that are given."""
    counts = np.maximum(np.ceil(np.hypot(*np.diff(discs[:, :2], axis=0).T) / _DENSE), 1).astype(np.int64)
    parts = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(discs[:-1], discs[1:], counts, strict=True)]
    return np.concatenate([*parts, discs[-1:]]), np.concatenate([[0], np.cumsum(counts)])


def _clear(
    ways: CarvedPass, field: DistanceField, wide: float, lost: list[tuple[float, float, float]]
) -> Iterator[Ring]:
    """Yield what of the rings keeps off some walls."""
    for ring in ways.rings:
        row, low, high = clear_parts(ring.rows, field, wide, bounded=False)
        whole = np.zeros(len(ring.rows))
        np.add.at(whole, row, high - low)
        if (whole > 1 - _SAME).all():
            yield ring
            continue
        size = lengths(ring.rows)
        worst = int(np.argmax((1 - whole) * size))
        mine = row == worst
        gaps = np.concatenate([[0.0], np.column_stack([low[mine], high[mine]]).ravel(), [1.0]]).reshape(-1, 2)
        widest = gaps[[np.argmax(gaps[:, 1] - gaps[:, 0])]].mean(axis=1)
        x, y = points_at(ring.rows[[worst]], widest)[0].tolist()
        lost.append((x, y, float(((1 - whole) * size).sum())))
        yield from (replace(ring, rows=piece) for piece in runs_of_parts(ring.rows, row, low, high))


def _stopped_short(lost: Sequence[tuple[float, float, float]], tool: Tool, cone: ChamferCutter) -> Iterator[Finding]:
    """Yield where the chamfer stops short."""
    if lost:
        x, y, _ = max(lost, key=lambda each: each[2])
        length = sum(each[2] for each in lost)
        short = f"T{tool.number} {tool.label} stops short of {length:.3f} mm of the edges, at {in_plane(x, y)} for one"
        text = (
            f"{short}: a wall that is not chamfered, or a clamp, is nearer than the {cone.top:.3f} mm that the ball "
            "reaches; take a narrower chamfer or a smaller ball."
            if cone.round
            else f"{short}: a wall that is not chamfered, or a clamp, is nearer than the {cone.top:.3f} mm that the "
            "cone reaches; take less tip offset, a narrower chamfer or a more pointed cone."
        )
        yield Finding(FindingKind.LEFT_OUT, text, x, y, amount=length)
