"""Descents that harm a mill: straight down where it does not cut at its centre, or at the feed for going sideways."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.motion import Floats, MotionKind, Plane
from ..model.motion_path import arc_paths
from ..model.tool import Tool
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Grid, Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import RapidHit, trim
from .course import MOST, NARROW, CutterTravel, FineStock, fine_grids, inserted, picked, straight

PIN = 0.25
"""Part of a cutter's radius, round its axis, in which it does not cut if it does not cut at its centre."""

RAMP = 0.5
"""mm down per mm sideways, from which on a motion is no ramp."""

UPRIGHT = 10.0
"""mm down per mm sideways, from which on a motion counts as upright, whatever follows it."""

WINDS = 6.0
"""Times the radius that it keeps within, that a way is long if it goes round or to and fro; once round is 2 pi
times.
"""

TURN = 32
"""Chords of a whole turn of a helix."""

NONE = 0
"""The sort of motions that go into no run."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Plunge:
    """Motions down into metal, over one place.

    Attributes:
        motion: row of the first one that goes into metal. tool: T number.
        x, y: where they end, mm. depth: of the metal over that, mm. aside: radius that the axis keeps within in the
            metal, mm.
    """

    motion: int
    tool: int
    x: float
    y: float
    depth: float
    aside: float


@dataclass(frozen=True)
class Plunges:
    """Those of a program, in their order, and how many ways down could not be looked at closer."""

    found: tuple[Plunge, ...]
    unseen: int = 0


@dataclass(frozen=True, eq=False)
class _Run:
    """Motions down, one after the other.

    Attributes:
        rows: of the motions. row: the motion that each leg of the way belongs to.
        way: of the dead centre, before they cut.
    """

    rows: range
    row: list[int]
    way: CutterTravel


def plunges(stock: FineStock, before: Workpiece, progress: Progress = NO_PROGRESS) -> Plunges:
    """Return where the last program of some plunges with a dead centre.

    A mill that goes sideways by no more than the radius of its dead centre leaves metal under it that nothing cuts,
    whether it goes straight, slanted, round or to and fro.

    Args:
        before: the metal before that program.

    Raises:
        Cancelled: the job was asked to stop.
    """
    course = stock.courses[-1]
    runs = list(_runs(course, stock.cutters, float(before.heights.max())))
    if not runs:
        return Plunges(())
    paths = hits_along(stock, before, [run.way for run in runs], progress)
    heights = ((k, max(hit.z + hit.depth for hit in hits)) for k, hits in sorted(paths.hits.items()))
    found = [_plunge(runs[k], height, int(course.tool[runs[k].rows.start])) for k, height in heights]
    return Plunges(tuple(each for each in found if each.aside < stock.cutters[each.tool].radius * PIN), paths.unseen)


def _runs(course: Course, cutters: Mapping[int, Cutter], top: float) -> Iterator[_Run]:
    """Yield the motions that may plunge, in their order."""
    motions = course.motions
    pins = np.zeros(int(course.tool.max(initial=0)) + 1)
    for number, cutter in cutters.items():
        if number < len(pins) and not cutter.centre_cutting:
            pins[number] = cutter.radius * PIN
    pin, way = pins[course.tool], motions.end - motions.start
    down = (motions.kind != MotionKind.RAPID) & (way[:, 2] < 0) & (motions.end[:, 2] < top - LEVEL) & (pin > 0)
    down[list(course.left_out)] = False
    if not down.any():
        return
    aside = np.hypot(way[:, 0], way[:, 1])
    steep = (-way[:, 2] > RAMP * aside) | _turns_within(course, pin)
    alike = np.select([~down, -way[:, 2] > UPRIGHT * aside, steep], [NONE, 1, 2], 3)
    for first, last in alike_runs(alike, course.tool):
        radius = float(pin[first])
        if _stays(motions.start[first : last + 1], motions.end[first : last + 1], top, radius, not steep[first]):
            yield _run(course, range(first, last + 1), Cutter(radius, radius))


def _turns_within(course: Course, pin: Floats) -> Mask:
    """Return which motions are helices that are narrower than the dead centre."""
    motions = course.motions
    arc = ((motions.kind == MotionKind.ARC_CW) | (motions.kind == MotionKind.ARC_CCW)) & (motions.plane == Plane.XY)
    from_centre = np.hypot(*(motions.start - motions.centre)[:, :2].T)
    return np.asarray(arc & (from_centre < pin))


def alike_runs(sort: NDArray[np.int64], tool: NDArray[np.int32]) -> list[tuple[int, int]]:
    """Return the first and the last row of unbroken runs of one sort and one tool; those of no sort are left out."""
    if not len(sort):
        return []
    first = np.flatnonzero(np.concatenate([[True], (np.diff(sort) != 0) | (np.diff(tool) != 0)]))
    last = np.concatenate([first[1:], [len(sort)]]) - 1
    some = sort[first] != NONE
    return list(zip(first[some].tolist(), last[some].tolist(), strict=True))


def _stays(start: Floats, end: Floats, top: float, radius: float, shallow: bool) -> bool:
    """Return whether motions may keep within a radius below the top; shallow ones must go to and fro, or round, for
    that.
    """
    part = np.clip((top - end[:, 2]) / (start[:, 2] - end[:, 2]), 0.0, 1.0)[:, None]
    places = np.concatenate([end + (start - end) * part, end])[:, :2]
    aside = float(np.max(places.max(axis=0) - places.min(axis=0))) / 2
    return aside < radius and (not shallow or float(np.sum(np.hypot(*(end - start)[:, :2].T))) >= WINDS * aside)


def _run(course: Course, rows: range, pin: Cutter) -> _Run:
    """Return motions with the way of their axis; helices by chords."""
    mine = picked(course, np.arange(rows.start, rows.stop))
    arcs = arc_paths(mine.motions)
    count = TURN * max(1, int(np.ceil(np.max(np.abs(arcs.sweep), initial=0.0) / (2 * np.pi)))) if len(arcs) else 1
    chords = dict(zip(arcs.rows.tolist(), arcs.points(np.linspace(0.0, 1.0, count + 1)), strict=True))
    legs = [chords[k][1:] if k in chords else mine.motions.end[k : k + 1] for k in range(len(rows))]
    row = np.repeat(np.asarray(rows), [len(leg) for leg in legs]).tolist()
    return _Run(rows, row, CutterTravel(rows.start, np.concatenate([mine.motions.start[:1], *legs]), pin))


def _plunge(run: _Run, height: float, tool: int) -> Plunge:
    """Return a run as what it is below the height of the metal."""
    points, deep = run.way.points, run.way.points[1:, 2] < height
    start, end = points[:-1][deep], points[1:][deep]
    part = np.minimum((height - end[:, 2]) / np.maximum(start[:, 2] - end[:, 2], LEVEL * LEVEL), 1.0)[:, None]
    places = np.concatenate([end + (start - end) * part, end])[:, :2]
    middle = (places.max(axis=0) + places.min(axis=0)) / 2
    aside = float(np.max(np.hypot(*(places - middle).T)))
    x, y, z = points[-1].tolist()
    return Plunge(run.row[int(np.argmax(deep))], tool, x, y, height - z, aside)


# Descents into metal at the feed that is meant for going sideways.
#
# A mill goes down where little of it cuts, at its axis, and so is fed down more slowly. How slowly the program's
# header may say; else the program itself does, where it goes down more slowly elsewhere. One that has a single feed
# for everything is told only of what is deep.


STEEP = math.tan(math.radians(60.0))
"""mm down per mm sideways from which on a motion goes down rather than along; ramps and helices are no such."""

SHARE = 0.8
"""Of the greatest feed sideways: a slower descent tells of a plunge rate, a faster one does not."""

MORE = 1.02
"""Times the plunge rate that F words may be off it."""

DEEP, DEEP_MM = 0.25, 0.5
"""Of the diameter, and mm: the metal under the axis, in the way of a descent, that makes it a plunge."""

ALONE, ALONE_MM = 1.0, 3.0
"""The same, where the program has one feed for everything."""

STEP = 0.01
"""mm; shorter motions between two descents are part of one: paths down a wall have such in their last decimals."""

LEAST = 0.3
"""mm; shorter descents tell of no plunge rate."""


@dataclass(frozen=True, slots=True)
class FastPlunge:
    """The deepest of a tool's descents into metal that are too fast.

    Attributes:
        motion: its first row. tool: T number.
        x, y: where it is deepest, mm. depth: of the metal under the axis there, mm.
        feed: straight down, of it, mm/min. rate: that the tool may be fed down with, mm/min; None: nobody says.
        count: of such descents.
    """

    motion: int
    tool: int
    x: float
    y: float
    depth: float
    feed: float
    rate: float | None
    count: int


@dataclass(frozen=True, slots=True)
class FastPlunges:
    """What a look for fast descents has found.

    Attributes:
        found: of each tool the deepest.
        unseen: fast descents that may go into metal, and were not looked at to the end; their depths are not known.
    """

    found: tuple[FastPlunge, ...] = ()
    unseen: int = 0


def fast_plunges(
    stock: FineStock,
    before: Workpiece,
    tools: Mapping[int, Tool],
    rates: Mapping[int, float],
    progress: Progress = NO_PROGRESS,
) -> FastPlunges:
    """Return, by tool, the descents of the last program of some that are too fast for it.

    Args:
        before: the metal before that program. tools: by T number.
        rates: that the program's header names, mm/min, by T number.

    Raises:
        Cancelled: the job was asked to stop.
    """
    course, top = stock.courses[-1], float(before.heights.max())
    known = _rates(stock, tools, rates, top)
    motions = course.motions
    down = _feed_down(motions.end - motions.start, motions.feed)
    fast = _fast_descents(course, down, known, top)
    spans = [
        span for span in alike_runs(fast.astype(np.int64), course.tool) if _may_be_deep(stock, tools, known, span, top)
    ]
    if not spans:
        return FastPlunges()
    ways = _along_axes(course, spans, tools, before.grid.pitch)
    deepest: dict[int, list[FastPlunge]] = {}
    looked = hits_along(stock, before, ways, progress)
    for k, hits in looked.hits.items():
        (first, last), hit = spans[k], max(hits, key=lambda each: each.depth)
        number = int(course.tool[first])
        if hit.depth >= _least(tools[number], known[number]):
            feed, (x, y) = float(down[first : last + 1].max()), _at_height(ways[k].points, hit.z)
            deepest.setdefault(number, []).append(
                FastPlunge(motion=first, tool=number, x=x, y=y, depth=hit.depth, feed=feed, rate=known[number], count=1)
            )
    worst = (
        replace(max(found, key=lambda each: each.depth), count=sum(each.count for each in found))
        for found in deepest.values()
    )
    return FastPlunges(tuple(worst), looked.unseen)


def _fast_descents(
    course: Course, down: NDArray[np.float64], rates: Mapping[int, float | None], top: float
) -> NDArray[np.bool_]:
    """Return which motions go down below the top faster than their tool may, with short steps between such.

    Args:
        down: part of the feeds that leads down, mm/min.
        rates: mm/min, by T number; None: no rate is known to be slow enough.
    """
    limit = np.full(int(course.tool.max(initial=0)) + 1, math.inf)
    for number, rate in rates.items():
        limit[number] = MORE * rate if rate is not None else 0.0
    motions = course.motions
    way = motions.end - motions.start
    fast = _descends(way, motions.kind) & (down > limit[course.tool]) & (motions.end[:, 2] < top - LEVEL)
    fast[list(course.left_out)] = False
    return fast | _between(fast, way)


def _along_axes(
    course: Course, spans: Sequence[tuple[int, int]], tools: Mapping[int, Tool], pitch: float
) -> list[CutterTravel]:
    """Return the ways down (first and last row each) of pins along the tools' axes.

    Metal under the axis that a cell would not show makes no plunge, so no closer look is taken.
    """
    wide, motions = NARROW * pitch, course.motions
    radius = {number: max(tool.radius * PIN, min(wide, tool.radius)) for number, tool in tools.items()}
    ways = []
    for first, last in spans:
        points = np.concatenate([motions.start[first : first + 1], motions.end[first : last + 1]])
        pin = radius[int(course.tool[first])]
        ways.append(CutterTravel(first, points, Cutter(pin, pin)))
    return ways


def _at_height(points: Floats, z: float) -> tuple[float, float]:
    """Return where on a way down (n, 3) it is at a height."""
    x, y = (float(np.interp(-z, -points[:, 2], points[:, column])) for column in (0, 1))
    return x, y


def _feed_down(way: Floats, feed: Floats) -> Floats:
    """Return the part of the feed that goes down, mm/min: a plunge rate bounds that alone, so a steep way to the side
    may be gone faster.
    """
    return np.asarray(feed * -way[:, 2] / np.maximum(np.linalg.norm(way, axis=1), 1e-12))


def _descends(way: Floats, kind: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Return which motions at feed rate go down, straight or nearly."""
    return np.asarray(
        (kind == MotionKind.LINE) & (way[:, 2] < 0) & (-way[:, 2] > STEEP * np.hypot(way[:, 0], way[:, 1]))
    )


def _between(fast: NDArray[np.bool_], way: Floats) -> NDArray[np.bool_]:
    """Return which motions are short steps between fast descents."""
    short = ~fast & (np.linalg.norm(way, axis=1) <= STEP)
    rows = np.arange(len(fast))
    before = np.maximum.accumulate(np.where(short, -1, rows))
    behind = np.minimum.accumulate(np.where(short, len(fast), rows)[::-1])[::-1]
    inner = short & (before >= 0) & (behind < len(fast))
    found = np.zeros(len(fast), np.bool_)
    found[inner] = fast[before[inner]] & fast[behind[inner]]
    return found


def _rates(
    stock: FineStock, tools: Mapping[int, Tool], rates: Mapping[int, float], top: float
) -> dict[int, float | None]:
    """Return the plunge rate of each mill that cuts, None where nothing tells of it."""
    course = stock.courses[-1]
    motions, way = course.motions, course.motions.end - course.motions.start
    sideways = (
        (motions.kind != MotionKind.RAPID)
        & (np.hypot(way[:, 0], way[:, 1]) > STEEP * np.abs(way[:, 2]))
        & (motions.end[:, 2] < top)
    )
    down = _descends(way, motions.kind) & (way[:, 2] < -LEAST)
    found: dict[int, float | None] = {}
    for number, tool in tools.items():
        mine = (course.tool == number) & (motions.feed > 0)
        along, slowly = motions.feed[mine & sideways], motions.feed[mine & down]
        if tool.kind.drills or number not in stock.cutters or not len(slowly) or not (len(along) or number in rates):
            continue
        least = float(slowly.min())
        found[number] = rates.get(number, least if len(along) and least < SHARE * float(along.max()) else None)
    return found


def _least(tool: Tool, rate: float | None) -> float:
    """Return how much metal under a tool's axis makes a descent a plunge, mm."""
    return max(DEEP * tool.diameter, DEEP_MM) if rate is not None else max(ALONE * tool.diameter, ALONE_MM)


def _may_be_deep(
    stock: FineStock, tools: Mapping[int, Tool], known: Mapping[int, float | None], span: tuple[int, int], top: float
) -> bool:
    """Return whether motions go down so far below the top that they may go deep into metal."""
    course, (first, last) = stock.courses[-1], span
    number = int(course.tool[first])
    low, high = float(course.motions.end[last, 2]), min(float(course.motions.start[first, 2]), top)
    return number in known and high - low >= _least(tools[number], known[number])


# Where cutters that are led along some ways, each when its motion is about to begin, meet metal.


TOGETHER = 512
"""Cells along the sides of the squares in which ways are looked at together."""

FEW = 4
"""Ways of such a square that are looked at one by one."""


@dataclass(frozen=True)
class PathHits:
    """What ways meet.

    Attributes:
        hits: of each way that meets metal, by its number, those of its legs.
        unseen: how many ways of narrow cutters could not be looked at closer.
    """

    hits: Mapping[int, tuple[RapidHit, ...]]
    unseen: int = 0


def hits_along(
    stock: FineStock, before: Workpiece, ways: Sequence[CutterTravel], progress: Progress = NO_PROGRESS
) -> PathHits:
    """Return where ways beside the last program of some meet metal, those of cutters narrower than a cell looked at
    closer.

    Args:
        before: the metal before that program.

    Raises:
        Cancelled: the job was asked to stop.
    """
    top, pitch = float(before.heights.max()), before.grid.pitch
    requested, cutters, owner = _with_ways(stock.courses[-1], stock.cutters, ways)
    found: dict[int, tuple[RapidHit, ...]] = {}
    for hit in trim(before, requested, cutters, progress=progress.part(0.0, 0.5)).rapids:
        if owner[hit.motion] >= 0:
            found[owner[hit.motion]] = (*found.get(owner[hit.motion], ()), hit)
    narrow = {k: way for k, way in enumerate(ways) if k not in found and way.cutter.radius < NARROW * pitch}
    closer = _closer(stock, narrow, _MetalSizes(top, pitch), progress.part(0.5, 1.0))
    return PathHits({**found, **{k: (hit,) for k, hit in closer.hits.items()}}, closer.unseen)


class _MetalSizes(NamedTuple):
    """Height of the metal's top, and the cells of the whole stock, mm."""

    top: float
    pitch: float


class _CloserHits(NamedTuple):
    """Where ways go deepest into metal, by their numbers, and how many could not be looked at."""

    hits: dict[int, RapidHit]
    unseen: int


class _SeenOn(NamedTuple):
    """A way by its number, and a grid that it is seen on."""

    way: int
    grid: Grid


class _GridCell(NamedTuple):
    """Grids of one pitch that lie near one another."""

    pitch: float
    column: int
    row: int


class _AskedCourse(NamedTuple):
    """A course that is asked along some ways too, all cutters, and to which way each motion belongs, -1: to none."""

    course: Course
    cutters: dict[int, Cutter]
    owner: list[int]


def _closer(stock: FineStock, ways: Mapping[int, CutterTravel], sizes: _MetalSizes, progress: Progress) -> _CloserHits:
    """Return where some ways go deepest into metal, looked at closer.

    Many ways near one another are looked at on one grid, as fine as one of their own would be: what the motions round
    them have cut is then cut once, and not once a way.

    Args:
        ways: by their numbers.
    """
    together: dict[_GridCell, list[_SeenOn]] = {}
    alone: list[int] = []
    for k, way in ways.items():
        grids = list(fine_grids(way, *sizes, stock.stock.box))
        if len(grids) == 1:
            (grid,) = grids
            side = TOGETHER * grid.pitch
            x, y = (math.floor(sum(grid.box[axis::2]) / 2 / side) for axis in (0, 1))
            together.setdefault(_GridCell(grid.pitch, x, y), []).append(_SeenOn(k, grid))
        elif grids:
            alone.append(k)
    batches = [some for some in together.values() if len(some) > FEW]
    alone = sorted([*alone, *(k for some in together.values() if len(some) <= FEW for k, _ in some)])
    found: dict[int, RapidHit] = {}
    count = len(batches) + len(alone)
    for done, some in enumerate(batches):
        progress.step(done / count, "Looking at plunges")
        found.update(_met_together(stock, ways, some, sizes.pitch))
    for done, k in enumerate(alone[:MOST]):
        progress.step((len(batches) + done) / count, "Looking at plunges")
        hit = stock.met(ways[k], *sizes)
        if hit is not None:
            found[k] = hit
    return _CloserHits(found, max(0, len(alone) - MOST))


def _met_together(
    stock: FineStock, ways: Mapping[int, CutterTravel], some: Sequence[_SeenOn], pitch: float
) -> dict[int, RapidHit]:
    """Return where ways, by their numbers, go deepest into metal.

    Args:
        some: numbers of ways with grids of one pitch that they are seen on, near one another.
        pitch: of the cells of the whole stock, mm.
    """
    boxes, fine = np.array([grid.box for _, grid in some]), some[0].grid.pitch
    (x0, y0), (x1, y1) = boxes[:, :2].min(axis=0).tolist(), boxes[:, 2:].max(axis=0).tolist()
    grid = Grid(x0, y0, fine, max(1, math.ceil((y1 - y0) / fine)), max(1, math.ceil((x1 - x0) / fine)))
    rows = stock.near(len(stock.courses) - 1, grid.box)
    moved = [replace(ways[k], row=int(np.searchsorted(rows, ways[k].row))) for k, _ in some]
    requested, cutters, owner = _with_ways(picked(stock.courses[-1], rows), stock.cutters, moved)
    deepest: dict[int, RapidHit] = {}
    for hit in trim(stock.over(grid, 0), requested, cutters).rapids:
        k = some[owner[hit.motion]].way
        if owner[hit.motion] >= 0 and (k not in deepest or hit.depth > deepest[k].depth):
            cells = max(1, round(hit.cells * (fine / pitch) ** 2))
            deepest[k] = replace(hit, motion=ways[k].row, cells=cells)
    return deepest


def _with_ways(course: Course, cutters: Mapping[int, Cutter], ways: Sequence[CutterTravel]) -> _AskedCourse:
    """Return a course that is asked along some ways too."""
    radii = sorted({way.cutter.radius for way in ways})
    first = int(max([*cutters, course.tool.max(initial=0)])) + 1
    all_cutters = {**cutters, **{first + k: Cutter(radius, radius) for k, radius in enumerate(radii)}}
    parts = [way.course().motions for way in ways]
    sizes = [len(part) for part in parts]
    more = straight(np.concatenate([part.start for part in parts]), np.concatenate([part.end for part in parts]))
    tool = np.repeat([first + radii.index(way.cutter.radius) for way in ways], sizes).astype(np.int32)
    made, owner = inserted(course, np.repeat([way.row for way in ways], sizes), more, tool)
    way_of = np.append(np.repeat(np.arange(len(ways)), sizes), -1)
    return _AskedCourse(made, all_cutters, way_of[owner].tolist())
