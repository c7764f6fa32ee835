"""Contour paths: the contour tool follows every wall at its radius (step 120, A to A'), inside or outside, or its
centre the lines.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import shapely

from ...core.errors import ParameterError
from ...core.progress import Progress
from ...core.wording import in_plane
from ...geometry.distance import DistanceField
from ...geometry.near_points import near
from ...geometry.offset.offset import OffsetLevel, Ring, offset_levels
from ...geometry.primitives import TURN, Indices, R, Rows, boxes, lengths, points_at, reversed_rows
from ...model.contour_operation import ContourOperation
from ...model.entry import Lead, LeadKind
from ...model.finding import Finding, FindingKind
from ...model.moves import Purpose
from ...model.operation import Direction, Side
from ...model.stock_box import stock_box
from ...model.tool import Tool
from ...toolpath.bitmap_check import check_on_bitmap
from ...toolpath.build import Stroke, started_at
from ...toolpath.drawn_contours import selected
from ...toolpath.leads.contour_path import ContourPath, ContourPaths, Floats
from ...toolpath.leads.lead import LeadContext, PathWithLeads, lead_findings, overlap_findings, runs, straight_way
from ...toolpath.leads.tab import (
    TabShape,
    by_hand,
    ends_of,
    far_tab_findings,
    narrow_tab_findings,
    spans_of,
    spread,
    tab_findings,
    tabs_at,
    under_tabs,
    unheld_findings,
)
from ...toolpath.machining_areas import MachiningArea, MachiningAreas, wall_paths
from ...toolpath.narrow_regions import finest, too_small
from ...toolpath.operation_context import OperationContext, PreparedStrokes, passes_of
from ..engrave.open_line import line_paths
from ..from_outside import emit_prepared, open_stock
from .dogbone import CornerRelief, corner_reliefs, inserted, recorded, refused_relief_findings
from .gaps import WallGap, clamp_findings, gaps, narrow_place_findings, narrow_places

_FAR = 4.0
"""Finish widths; where a finish path is farther than this from what was roughed, it is cut at all depths."""

_SAME_RADIUS = 2e-3
"""mm; an arc must be larger by as much than what a control offsets it by, so that rounding leaves an arc of it."""

_THIN = 0.1
"""Of the cutter's diameter; no more than this is taken off at the full depth of several passes in one."""


@dataclass(frozen=True, eq=False)
class _ContourJob:
    """A contour operation and what it works on."""

    context: OperationContext
    index: int
    operation: ContourOperation
    area: MachiningArea
    tool: Tool

    @property
    def wall(self) -> float:
        """How far the cutter's centre keeps from the walls, mm."""
        return self.tool.radius + self.operation.cut.stock_to_leave

    @property
    def is_thick(self) -> bool:
        """True when the metal left for finishing is too wide to be cut at the full depth in one pass, where there are
        several.
        """
        return passes_of(self.context, self.index) > 1 and self.operation.finish_width > _THIN * self.tool.diameter * (
            1 + 1e-9
        )

    def around(self, distance: float) -> LeadContext:
        """Return what leads of paths at a distance from the walls go by."""
        away = 1.0 if self.operation.cut.direction is Direction.CLIMB else -1.0
        lead = Lead(LeadKind.NONE) if self.operation.side is Side.ON else self.operation.lead
        straight = straight_way(self.operation, self.tool)
        return LeadContext(self.area.distances, self.tool, distance, away, lead, straight, self.operation.wear)


@dataclass(frozen=True, eq=False)
class _ContourStrokes:
    """Paths with their beginnings and leads, their strokes, and where their tabs are, mm along each."""

    runs: tuple[PathWithLeads, ...]
    strokes: tuple[Stroke, ...]
    tabs: tuple[tuple[float, ...], ...]


def contour(context: OperationContext, index: int, progress: Progress) -> None:
    """Carry out a contour operation."""
    prepared = prepared_contour(context, index, progress.part(0.0, 0.7))
    if prepared is not None:
        emit_prepared(context, index, prepared, progress.part(0.7, 1.0))


def prepared_contour(context: OperationContext, index: int, progress: Progress) -> PreparedStrokes | None:
    """Steps 120 and 130: offset every contour by the contour tool's radius, and fill the area it bounds; or follow the
    lines.

    Every path gets its beginning, its leads, its tabs and its dog-bones here. What lies inside other contours is cut
    before them. A finish pass follows what was roughed at the finish width; spring passes run the last path again, at
    the floor.
    """
    operation = context.job.operations[index]
    assert isinstance(operation, ContourOperation)
    area = context.areas.of(operation)
    if area is None:
        return None
    work = _ContourJob(context, index, operation, area, context.job.tool(operation.cut.tool))
    _check_arcs(work)
    rough = None
    if operation.side is Side.ON:
        paths, reported = line_paths(area, work.tool, operation.cut.direction, progress.part(0.0, 0.7))
        context.findings.extend(reported)
        finish = _finish(work, paths, ())
    else:
        levels = _levels(work, progress.part(0.0, 0.7))
        found = _looked_at(work, levels[0], progress)
        paths = wall_paths(levels[0], area, operation.cut.direction)
        finish = _finish(work, paths, _bones(work, found, levels[0], progress))
        if len(levels) > 1:
            ways = _bones(work, gaps(levels[1], area), levels[1], progress) if operation.dog_bones else ()
            rough = _rough(work, wall_paths(levels[1], area, operation.cut.direction), levels[1].distance, finish, ways)
            context.findings.extend(_about_thick(work))
    context.findings.extend(overlap_findings(finish.runs, work.around(work.wall)))
    progress.step(1.0, "Contours")
    return PreparedStrokes(area, _together(work, finish, rough), open_stock(context, operation, area))


def _check_arcs(work: _ContourJob) -> None:
    """Refuse inner arcs of the contour that a control cannot offset by the tool's radius and all that is entered.

    Raises:
        ParameterError: there is one.
    """
    operation = work.operation
    if not operation.offset_by_control:
        return
    rows = work.area.primitives.rows[~work.area.bare]
    least = work.wall + operation.wear
    small = np.flatnonzero((rows[:, TURN] > 0) & (rows[:, R] < least + _SAME_RADIUS))
    if len(small):
        row = rows[small[np.argmin(rows[small, R])]]
        x, y = points_at(row[None], np.array([0.5]))[0]
        raise ParameterError(
            f"The contour has an inner arc of radius {row[R]:.4g} mm at {in_plane(x, y)}, in which a control cannot "
            f"offset it by up to {least:.4g} mm (the radius of T{work.tool.number}, stock to leave and wear range); "
            'take a smaller tool or wear_range, or compensation = "computer".'
        )


def _about_thick(work: _ContourJob) -> list[Finding]:
    """Return the remark that the finish pass is stepped down though it was asked for once, at the floor."""
    if work.operation.finish_each_pass or not work.is_thick:
        return []
    width, tool = work.operation.finish_width, work.tool
    text = (
        f"The finish pass of T{tool.number} {tool.label} takes {width:g} mm, more than {100 * _THIN:g} % of the "
        "cutter's diameter; too much for the full depth at once, so it is cut at every depth."
    )
    return [Finding(FindingKind.ENGAGEMENT, text, counts=False, amount=width)]


def _levels(work: _ContourJob, progress: Progress) -> tuple[OffsetLevel, ...]:
    width = work.operation.finish_width
    levels = (
        (work.area.frame(work.wall, progress),)
        if not width
        else offset_levels(work.area.primitives, [work.wall, work.wall + width], progress, frame=True)
    )
    work.context.note(levels)
    return levels


def _looked_at(work: _ContourJob, level: OffsetLevel, progress: Progress) -> list[WallGap]:
    """Return what of the walls the cutter does not touch; say where it does not fit, and whether the bitmap agrees
    (step 130).
    """
    context, area = work.context, work.area
    progress.step(0.7, "Fill")
    context.on_bitmap = check_on_bitmap(area.distances, level, context.observer)
    context.findings.extend(context.on_bitmap.findings())
    found, reported = wall_findings(context.areas, work.operation, area, level)
    context.findings.extend(reported)
    return found


def wall_findings(
    areas: MachiningAreas, operation: ContourOperation, area: MachiningArea, level: OffsetLevel
) -> tuple[list[WallGap], list[Finding]]:
    """Return what of the walls an operation's cutter does not touch, and what there is to say of it: regions, necks and
    slots, clamps.

    What is too narrow for one operation counts only where no other one follows the same walls with a finer tool. Necks
    and slots inside count for nothing: what is out of reach there is measured on the floor.

    Args:
        level: the rings of its centre.
    """
    job, drawn, tool = areas.job, areas.drawn, areas.job.tool(operation.cut.tool)
    found = gaps(level, area)
    places = narrow_places(found, area, level.distance)
    least = finest(job, operation)
    counts = operation.side is Side.OUTSIDE and least >= 2 * level.distance - 1e-9
    walls = selected(drawn, operation.cut.curves).closed
    reported = [
        *too_small(area.regions, level, tool, least),
        *narrow_place_findings(places, tool, level.distance, counts),
        *clamp_findings(places, walls, drawn.clamps, tool),
    ]
    return found, reported


def _bones(
    work: _ContourJob, found: Sequence[WallGap], level: OffsetLevel, progress: Progress
) -> tuple[CornerRelief, ...]:
    if not work.operation.dog_bones:
        return ()
    made, refused = corner_reliefs(found, work.area, level.distance, progress)
    work.context.dog_bones.extend(recorded(made, work.tool.diameter))
    work.context.findings.extend(refused_relief_findings(refused))
    return made


def _finish(work: _ContourJob, paths: Sequence[ContourPath], ways: Sequence[CornerRelief]) -> _ContourStrokes:
    """Return the paths along the walls themselves, with tabs where some are asked for."""
    if work.operation.tabs.enabled:
        return _finish_over_tabs(work, paths, ways)
    around = work.around(work.wall)
    made = runs(paths, [()] * len(paths), around)
    work.context.findings.extend(lead_findings(made, around))
    tabs = ((),) * len(paths)
    return _ContourStrokes(made, strokes_of(made, tabs, StrokeExtras(corner_reliefs=ways)), tabs)


def _finish_over_tabs(work: _ContourJob, paths: Sequence[ContourPath], ways: Sequence[CornerRelief]) -> _ContourStrokes:
    """Return the paths along the walls with tabs by hand and automatic ones, and say which of them do not hold."""
    context, shape = work.context, TabShape.of(work.operation, work.tool)
    walls = _followed(work, paths)
    own, left_out = by_hand(paths, shape, context.job.copies.shifts, walls)
    context.findings.extend(left_out)
    taken = [spans_of(path, places, shape) for path, places in zip(paths, own, strict=True)]
    around = work.around(work.wall)
    made = runs(paths, taken, around)
    beside = around
    if work.operation.side is Side.ON and walls is not None:
        beside = replace(around, field=walls, need=0.0)
    by_path = [spread(run, places, shape, beside) for run, places in zip(made, own, strict=True)]
    tabs = tuple((*places, *found.places) for places, found in zip(own, by_path, strict=True))
    context.findings.extend(lead_findings(made, around))
    context.findings.extend(far_tab_findings(paths, shape, context.job.copies.shifts))
    context.findings.extend(tab_findings(made, tabs, [found.lacks_metal for found in by_path], shape, work.operation))
    context.findings.extend(narrow_tab_findings(made, tabs, shape))
    bridges = [tab for run, places in zip(made, tabs, strict=True) for tab in tabs_at(run.path, places, shape)]
    context.tabs.extend(bridges)
    if work.operation.side is Side.OUTSIDE and walls is not None:
        box = stock_box(context.job, context.regions)
        context.findings.extend(unheld_findings(bridges, walls, box))
    extras = StrokeExtras(shape, ways)
    return _ContourStrokes(made, strokes_of(made, tabs, extras), tabs)


def _followed(work: _ContourJob, paths: Sequence[ContourPath]) -> DistanceField | None:
    """Return what the paths follow: real walls, or themselves."""
    if work.operation.side is not Side.ON:
        return DistanceField.of(work.area.distances.rows[~work.area.bare]) if not work.area.bare.all() else None
    return DistanceField.of(np.concatenate([path.rows for path in paths])) if paths else None


def _rough(
    work: _ContourJob,
    paths: Sequence[ContourPath],
    distance: float,
    finish: _ContourStrokes,
    ways: Sequence[CornerRelief],
) -> _ContourStrokes:
    """Return the paths that leave the finish width, with their tabs where the finish path has its own."""
    width = work.operation.finish_width
    shape = TabShape.of(work.operation, work.tool)
    finished = ends_of(finish.runs, finish.tabs, shape)
    shape = replace(shape, finished=finished)
    tabs: list[list[float]] = [[] for _ in paths]
    if len(finished.middles) and paths:
        tabs = _places_beside(paths, finished.middles, _FAR * width)
    taken = [spans_of(path, places, shape) for path, places in zip(paths, tabs, strict=True)]
    made = runs(paths, taken, work.around(distance), _beginnings(paths, finish, _FAR * width))
    told = narrow_tab_findings(finish.runs, finish.tabs, replace(shape, finished=None))
    roughed = narrow_tab_findings(made, tabs, shape)  # of the same tabs, unless nothing of one stands here alone
    work.context.findings.extend(each for each in roughed if not told or (each.counts and not told[0].counts))
    extras = StrokeExtras(shape, ways)
    return _ContourStrokes(
        made,
        strokes_of(made, tabs, extras),
        tuple(map(tuple, tabs)),
    )


def _beginnings(paths: Sequence[ContourPath], finish: _ContourStrokes, most: float) -> list[list[float]]:
    """Return for each path that is roughed where finish paths begin beside it, so that the leads of both lie over one
    another.
    """
    wished: list[list[float]] = [[] for _ in paths]
    if paths and finish.runs:
        points = np.concatenate([run.path.points(np.array([run.start])) for run in finish.runs])
        for each in _points_beside(paths, points, most):
            wished[each.path].extend(each.where.tolist())
    return wished


class _PointsBeside(NamedTuple):
    """Points that lie beside a path.

    Attributes:
        path: its number.
        number: (m,) of the points, rising.
        where: (m,) how far along the path is what of it is nearest to each, mm.
        far: (m,) how far off that is, mm.
    """

    path: int
    number: Indices
    where: Floats
    far: Floats


def _points_beside(paths: Sequence[ContourPath], points: Floats, most: float) -> Iterator[_PointsBeside]:
    """Yield for each path the points (n, 2) that lie within a distance of it, mm, by an index: paths may be many."""
    reach = most * (1 + 1e-9)
    around = np.array([(*(box := boxes(path.rows))[:, :2].min(axis=0), *box[:, 2:].max(axis=0)) for path in paths])
    index = shapely.STRtree(shapely.points(points))
    pairs = near(index, shapely.box(*(around + np.array([-reach, -reach, reach, reach])).T))
    path, number = pairs[:, np.lexsort(pairs[::-1])]
    bounds = np.searchsorted(path, np.arange(len(paths) + 1))
    for k in np.unique(path).tolist():
        own = number[bounds[k] : bounds[k + 1]]
        where, far = paths[k].nearest(points[own])
        beside = far <= most
        yield _PointsBeside(k, own[beside], where[beside], far[beside])


def _places_beside(paths: Sequence[ContourPath], points: Floats, most: float) -> list[list[float]]:
    """Return for each path how far along it are the points (n, 2) that lie beside it and nearer to no other one, mm."""
    owner, place = np.full(len(points), -1), np.zeros(len(points))
    least = np.full(len(points), np.inf)
    for each in _points_beside(paths, points, most):
        better = each.far < least[each.number]
        number = each.number[better]
        owner[number], place[number], least[number] = each.path, each.where[better], each.far[better]
    found: list[list[float]] = [[] for _ in paths]
    for k in np.flatnonzero(owner >= 0).tolist():
        found[int(owner[k])].append(float(place[k]))
    return found


def _together(work: _ContourJob, finish: _ContourStrokes, rough: _ContourStrokes | None) -> list[Stroke]:
    """Return all strokes in groups: what is roughed, its finish path, and that once more for each spring pass.

    Paths that lie in others have a lower rank, so that a part is cut out last. A finish path that does not run beside
    what was roughed, such as in a neck that only it fits into, is cut at every depth, and so nowhere through full metal
    in one pass; so is every finish path that takes off more than thin metal.
    """
    operation = work.operation
    top = max((run.path.rank for run in finish.runs), default=0) if operation.side is not Side.INSIDE else 0
    roughed = _by_finish(finish, rough) if rough else [[] for _ in finish.runs]
    stepped = operation.finish_each_pass or work.is_thick
    beside = _beside(finish.runs, rough.runs, operation.finish_width) if rough else [False] * len(finish.runs)
    strokes: list[Stroke] = []
    for k, (run, stroke) in enumerate(zip(finish.runs, finish.strokes, strict=True)):
        last = replace(stroke, at_floor=beside[k] and not stepped)
        group = [*roughed[k], last, *[replace(stroke, at_floor=True)] * operation.spring_passes]
        rank = top - run.path.rank if operation.side is not Side.INSIDE else 0
        strokes.extend(replace(each, follows=j > 0, rank=rank) for j, each in enumerate(group))
    return strokes


def _by_finish(finish: _ContourStrokes, rough: _ContourStrokes) -> list[list[Stroke]]:
    """Return for each finish path the strokes that are roughed for it: those that begin nearest to it."""
    found: list[list[Stroke]] = [[] for _ in finish.runs]
    if not rough.runs:
        return found
    paths = [run.path.rows for run in finish.runs]
    number = np.repeat(np.arange(len(paths)), [len(rows) for rows in paths])
    begins = np.array([run.path.rows[0, :2] for run in rough.runs])
    row = DistanceField.of(np.concatenate(paths)).nearest(begins)[1]
    for stroke, k in zip(rough.strokes, number[row].tolist(), strict=True):
        found[k].append(stroke)
    return found


def _beside(finish: Sequence[PathWithLeads], rough: Sequence[PathWithLeads], width: float) -> list[bool]:
    """Tell for each finish path whether all of it runs beside what was roughed."""
    if not rough:
        return [False] * len(finish)
    field = DistanceField.of(np.concatenate([run.path.rows for run in rough]))
    found = []
    for run in finish:
        where = np.arange(0.0, run.path.length, max(width, run.path.length / 2000))
        found.append(bool((field.nearest(run.path.points(where))[0] <= _FAR * width).all()))
    return found


def contour_strokes(rings: Sequence[Ring], direction: Direction) -> tuple[Stroke, ...]:
    """Return one closed stroke a ring that is no exact level, such as those of pixels; it has no leads, tabs or
    dog-bones.

    The wall is on the right of a ring's own direction, so climb milling keeps it. Each starts in the middle of its
    longest line, away from corners.

    Args:
        rings: rings at tool radius + stock to leave from the walls.
    """
    strokes = []
    for ring in rings:
        rows = ring.rows if direction is Direction.CLIMB else reversed_rows(ring.rows)
        size = lengths(rows) * np.where(rows[:, TURN] == 0, 1.0, 1e-3)
        rows = started_at(rows, int(np.argmax(size)), 0.5)
        strokes.append(Stroke(rows, np.full(len(rows), Purpose.CONTOUR, np.uint8), ring.region))
    return tuple(strokes)


# A path along a wall becomes a stroke: leads at its ends, its rows cut at tabs, dog-bones in its corners.


_NONE = np.zeros(0)
"""Places along a path where it is broken: none."""

_POINT = 0.01
"""mm; a shorter path is a plunge, which has neither tabs nor corners."""


@dataclass(frozen=True)
class StrokeExtras:
    """What a path along a wall goes over and into.

    Attributes:
        tabs: what they have in common; None: none.
        corner_reliefs: ways into corners.
    """

    tabs: TabShape | None = None
    corner_reliefs: Sequence[CornerRelief] = ()


def strokes_of(
    runs: Sequence[PathWithLeads], tabs: Sequence[Sequence[float]], extras: StrokeExtras
) -> tuple[Stroke, ...]:
    """Return the strokes of some paths.

    Args:
        tabs: their middles on each path, mm along it.
    """
    if not runs:
        return ()
    joined = ContourPaths.of([run.path for run in runs])
    spans = [
        spans_of(run.path, places, extras.tabs) if places and extras.tabs else []
        for run, places in zip(runs, tabs, strict=True)
    ]
    start, stop = np.array([run.start for run in runs]), np.array([run.stop for run in runs])
    point = joined.lengths < _POINT
    start, stop = np.where(point, 0.0, start), np.where(point, 1.0, stop)
    breaks = [_breaks(run.path, own) if own else _NONE for run, own in zip(runs, spans, strict=True)]
    found, middle = joined.spans(start, stop, breaks)
    strokes = []
    for k, run in enumerate(runs):
        mine = slice(*found.first[k : k + 2].tolist())
        strokes.append(
            Stroke(run.path.rows, np.full(len(run.path.rows), Purpose.CONTOUR, np.uint8), run.path.region)
            if point[k]
            else _stroke(run, _CutRows(found.rows[mine], middle[mine]), spans[k], extras)
        )
    return tuple(strokes)


class _CutRows(NamedTuple):
    """Rows of a path, and how far along it the middle of each is, mm."""

    rows: Rows
    middle: Floats


def _stroke(run: PathWithLeads, cut: _CutRows, spans: Sequence[tuple[float, float]], extras: StrokeExtras) -> Stroke:
    """Return the stroke of a path.

    Args:
        cut: from beginning to end.
        spans: (from, to) of its tabs, mm.
    """
    reliefs = extras.corner_reliefs
    rows, where, relief = inserted(*cut, reliefs) if reliefs else (*cut, np.zeros(len(cut.rows)))
    over = under_tabs(run.path, where, spans) if spans else np.zeros(len(where), np.bool_)
    purpose = np.where(relief, Purpose.DOG_BONE, np.where(over, Purpose.TAB, Purpose.CONTOUR))
    ends = [np.full(len(way), Purpose.LEAD) for way in (run.way_in, run.way_out)]
    least_z = None
    if extras.tabs and over.any():
        free = [np.full(len(way), -np.inf) for way in (run.way_in, run.way_out)]
        least_z = np.concatenate([free[0], np.where(over, extras.tabs.top, -np.inf), free[1]])
    return Stroke(
        np.concatenate([run.way_in, rows, run.way_out]),
        np.concatenate([ends[0], purpose, ends[1]]).astype(np.uint8),
        run.path.region,
        least_z,
    )


def _breaks(path: ContourPath, spans: Sequence[tuple[float, float]]) -> Floats:
    ends = np.array([end for span in spans for end in span], dtype=np.float64)
    return ends % path.length if path.closed else ends
