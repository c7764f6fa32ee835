"""Contour paths: the contour tool follows every wall at its radius (step 120, A to A'), inside or outside, or its
centre the lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.progress import Progress
from ...geometry.distance import DistanceField
from ...geometry.offset.offset import Level, Ring, offset_levels
from ...geometry.primitives import TURN, lengths, reversed_rows
from ...model.entry import Lead, LeadKind
from ...model.finding import Finding, FindingKind
from ...model.moves import Purpose
from ...model.operation import ContourOperation, Direction, Side
from ...model.stock_box import stock_box
from ...model.tool import Tool
from ...toolpath.bitmap_check import check_on_bitmap
from ...toolpath.build import Stroke, started_at
from ...toolpath.leads.contour_path import Path
from ...toolpath.leads.lead import Around, Run, about_leads, about_overlaps, runs
from ...toolpath.leads.tab import TabShape, about_far, about_tabs, about_unheld, by_hand, spans_of, spread, tabs_at
from ...toolpath.narrow import finest, too_small
from ...toolpath.selected import selected
from ...toolpath.setting import Setting, emit, passes_of
from ...toolpath.sheets import Sheet, Sheets
from ...toolpath.side import wall_paths
from ..engrave.open_line import line_paths
from .dogbone import Bone, about_refused, bones, recorded
from .fit import about_clamps, about_narrow, narrow_places
from .gaps import Gap, gaps
from .stroke import Extras, strokes_of

_FAR = 4.0
"""Finish widths; where a finish path is farther than this from what was roughed, it is cut at all depths."""

_THIN = 0.1
"""Of the cutter's diameter; no more than this is taken off at the full depth of several passes in one."""


@dataclass(frozen=True, eq=False)
class _Work:
    """A contour operation and what it works on."""

    setting: Setting
    index: int
    operation: ContourOperation
    sheet: Sheet
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
        return passes_of(self.setting, self.index) > 1 and self.operation.finish_width > _THIN * self.tool.diameter * (
            1 + 1e-9
        )

    def around(self, distance: float) -> Around:
        """Return what leads of paths at a distance from the walls go by."""
        away = 1.0 if self.operation.cut.direction is Direction.CLIMB else -1.0
        lead = Lead(LeadKind.NONE) if self.operation.side is Side.ON else self.operation.lead
        return Around(self.sheet.distances, self.tool, distance, away, lead)


@dataclass(frozen=True, eq=False)
class _Made:
    """Paths with their beginnings and leads, their strokes, and where their tabs are, mm along each."""

    runs: tuple[Run, ...]
    strokes: tuple[Stroke, ...]
    tabs: tuple[tuple[float, ...], ...]


def contour(setting: Setting, index: int, progress: Progress) -> None:
    """Steps 120 and 130: offset every contour by the contour tool's radius, and fill the area it bounds; or follow the
    lines.

    Every path gets its beginning, its leads, its tabs and its dog-bones here. What lies inside other contours is cut
    before them. A finish pass follows what was roughed at the finish width; spring passes run the last path again, at
    the floor.
    """
    operation = setting.job.operations[index]
    assert isinstance(operation, ContourOperation)
    sheet = setting.sheets.of(operation)
    if sheet is None:
        return
    work = _Work(setting, index, operation, sheet, setting.job.tool(operation.cut.tool))
    rough = None
    if operation.side is Side.ON:
        paths, told = line_paths(sheet, work.tool, operation.cut.direction, progress.part(0.0, 0.5))
        setting.findings.extend(told)
        finish = _finish(work, paths, ())
    else:
        levels = _levels(work, progress.part(0.0, 0.5))
        found = _looked_at(work, levels[0], progress)
        paths = wall_paths(levels[0], sheet, operation.cut.direction)
        finish = _finish(work, paths, _bones(work, found, levels[0], progress))
        if len(levels) > 1:
            ways = _bones(work, gaps(levels[1], sheet), levels[1], progress) if operation.dog_bones else ()
            rough = _rough(
                work, wall_paths(levels[1], sheet, operation.cut.direction), levels[1].distance, finish, ways
            )
            setting.findings.extend(_about_thick(work))
    setting.findings.extend(about_overlaps(finish.runs, work.around(work.wall)))
    progress.step(0.7, "Contours")
    emit(setting, index, sheet, _together(work, finish, rough), progress.part(0.7, 1.0))


def _about_thick(work: _Work) -> list[Finding]:
    """Return the remark that the finish pass is stepped down though it was asked for once, at the floor."""
    if work.operation.finish_each_pass or not work.is_thick:
        return []
    width, tool = work.operation.finish_width, work.tool
    text = (
        f"The finish pass of T{tool.number} {tool.label} takes {width:g} mm, more than {100 * _THIN:g} % of the "
        "cutter's diameter; too much for the full depth at once, so it is cut at every depth."
    )
    return [Finding(FindingKind.ENGAGEMENT, text, counts=False, amount=width)]


def _levels(work: _Work, progress: Progress) -> tuple[Level, ...]:
    width = work.operation.finish_width
    levels = (
        (work.sheet.frame(work.wall, progress),)
        if not width
        else offset_levels(work.sheet.primitives, [work.wall, work.wall + width], progress, frame=True)
    )
    work.setting.note(levels)
    return levels


def _looked_at(work: _Work, level: Level, progress: Progress) -> list[Gap]:
    """Return what of the walls the cutter does not touch; say where it does not fit, and whether the bitmap agrees
    (step 130).
    """
    setting, sheet = work.setting, work.sheet
    progress.step(0.5, "Fill")
    setting.on_bitmap = check_on_bitmap(sheet.distances, level, setting.observer)
    setting.findings.extend(setting.on_bitmap.findings())
    found, told = about_walls(setting.sheets, work.operation, sheet, level)
    setting.findings.extend(told)
    return found


def about_walls(
    sheets: Sheets, operation: ContourOperation, sheet: Sheet, level: Level
) -> tuple[list[Gap], list[Finding]]:
    """Return what of the walls an operation's cutter does not touch, and what there is to say of it: regions, necks and
    slots, clamps.

    What is too narrow for one operation counts only where no other one follows the same walls with a finer tool. Necks
    and slots inside count for nothing: what is out of reach there is measured on the floor.

    Args:
        level: the rings of its centre.
    """
    job, drawn, tool = sheets.job, sheets.drawn, sheets.job.tool(operation.cut.tool)
    found = gaps(level, sheet)
    places = narrow_places(found, sheet, level.distance)
    least = finest(job, operation)
    counts = operation.side is Side.OUTSIDE and least >= 2 * level.distance - 1e-9
    walls = selected(drawn, operation.cut.curves).closed
    told = [
        *too_small(sheet.regions, level, tool, least),
        *about_narrow(places, tool, level.distance, counts),
        *about_clamps(places, walls, drawn.clamps, tool),
    ]
    return found, told


def _bones(work: _Work, found: Sequence[Gap], level: Level, progress: Progress) -> tuple[Bone, ...]:
    if not work.operation.dog_bones:
        return ()
    made, refused = bones(found, work.sheet, level.distance, progress)
    work.setting.dog_bones.extend(recorded(made, work.tool.diameter))
    work.setting.findings.extend(about_refused(refused))
    return made


def _finish(work: _Work, paths: Sequence[Path], ways: Sequence[Bone]) -> _Made:
    """Return the paths along the walls themselves, with tabs by hand and automatic ones."""
    setting, wanted = work.setting, work.operation.tabs
    shape = TabShape.of(work.operation, work.tool)
    own, left_out = by_hand(paths, shape, setting.job.copies.shifts, _followed(work, paths))
    setting.findings.extend(left_out)
    taken = [spans_of(path, places, shape.half) for path, places in zip(paths, own, strict=True)]
    around = work.around(work.wall)
    made = runs(paths, taken, around)
    tabs = tuple((*places, *spread(run, places, shape, around)) for run, places in zip(made, own, strict=True))
    setting.findings.extend(about_leads(made, around))
    if wanted.wanted:
        setting.findings.extend(about_far(paths, shape, setting.job.copies.shifts))
        setting.findings.extend(about_tabs(made, tabs, shape, work.operation))
        bridges = [tab for run, places in zip(made, tabs, strict=True) for tab in tabs_at(run.path, places, shape)]
        setting.tabs.extend(bridges)
        walls = _followed(work, paths)
        if work.operation.side is Side.OUTSIDE and walls is not None:
            box = stock_box(setting.job, setting.regions)
            setting.findings.extend(about_unheld(bridges, walls, box))
    extras = Extras(shape.half, shape.top, ways)
    return _Made(made, strokes_of(made, tabs, extras), tabs)


def _followed(work: _Work, paths: Sequence[Path]) -> DistanceField | None:
    """Return what the paths follow: real walls, or themselves."""
    if work.operation.side is not Side.ON:
        return DistanceField.of(work.sheet.distances.rows[~work.sheet.bare]) if not work.sheet.bare.all() else None
    return DistanceField.of(np.concatenate([path.rows for path in paths])) if paths else None


def _rough(work: _Work, paths: Sequence[Path], distance: float, finish: _Made, ways: Sequence[Bone]) -> _Made:
    """Return the paths that leave the finish width, with their tabs where the finish path has its own."""
    shape = TabShape.of(work.operation, work.tool)
    width = work.operation.finish_width
    tabs: list[list[float]] = [[] for _ in paths]
    middles = [
        run.path.points(np.array(places)) for run, places in zip(finish.runs, finish.tabs, strict=True) if places
    ]
    if middles and paths:
        points = np.concatenate(middles)
        near = [path.nearest(points) for path in paths]
        for k, owner in enumerate(np.argmin(np.array([far for _, far in near]), axis=0).tolist()):
            if near[owner][1][k] <= _FAR * width:
                tabs[owner].append(float(near[owner][0][k]))
    taken = [spans_of(path, places, shape.half) for path, places in zip(paths, tabs, strict=True)]
    made = runs(paths, taken, work.around(distance), _beginnings(paths, finish, _FAR * width))
    extras = Extras(shape.half, shape.top, ways)
    return _Made(
        made,
        strokes_of(made, tabs, extras),
        tuple(map(tuple, tabs)),
    )


def _beginnings(paths: Sequence[Path], finish: _Made, most: float) -> list[list[float]]:
    """Return for each path that is roughed where finish paths begin beside it, so that the leads of both lie over one
    another.
    """
    wished: list[list[float]] = [[] for _ in paths]
    if paths and finish.runs:
        points = np.concatenate([run.path.points(np.array([run.start])) for run in finish.runs])
        for path, own in zip(paths, wished, strict=True):
            where, far = path.nearest(points)
            own.extend(where[far <= most].tolist())
    return wished


def _together(work: _Work, finish: _Made, rough: _Made | None) -> list[Stroke]:
    """Return all strokes in groups: what is roughed, its finish path, and that once more for each spring pass.

    Paths that lie in others have a lower rank, so that a part is cut out last. A finish path that does not run beside
    what was roughed, such as in a neck that only it fits into, is cut at every depth, and so nowhere through full metal
    in one pass; so is every finish path that takes off more than thin metal.
    """
    operation = work.operation
    top = max((run.path.rank for run in finish.runs), default=0) if operation.side is not Side.INSIDE else 0
    owners = _owners(finish, rough) if rough else []
    stepped = operation.finish_each_pass or work.is_thick
    beside = _beside(finish.runs, rough.runs, operation.finish_width) if rough else [False] * len(finish.runs)
    strokes: list[Stroke] = []
    for k, (run, stroke) in enumerate(zip(finish.runs, finish.strokes, strict=True)):
        before = [rough.strokes[j] for j, owner in enumerate(owners) if owner == k] if rough else []
        last = replace(stroke, at_floor=beside[k] and not stepped)
        group = [*before, last, *[replace(stroke, at_floor=True)] * operation.spring_passes]
        rank = top - run.path.rank if operation.side is not Side.INSIDE else 0
        strokes.extend(replace(each, follows=j > 0, rank=rank) for j, each in enumerate(group))
    return strokes


def _owners(finish: _Made, rough: _Made) -> list[int]:
    """Return for each path that is roughed which finish path it belongs to: the nearest."""
    if not rough.runs:
        return []
    points = np.array([run.path.rows[0, :2] for run in rough.runs])
    far = np.array([run.path.nearest(points)[1] for run in finish.runs])
    return [int(k) for k in np.argmin(far, axis=0)]


def _beside(finish: Sequence[Run], rough: Sequence[Run], width: float) -> list[bool]:
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
