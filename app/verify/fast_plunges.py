"""Descents into metal at the feed that is meant for going sideways.

A mill goes down where little of it cuts, at its axis, and so is fed down more slowly. How slowly the program's header
may say; else the program itself does, where it goes down more slowly elsewhere. One that has a single feed for
everything is told only of what is deep.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.motion import Floats, MotionKind
from ..model.tool import Tool
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from .fine_stock import NARROW, CutterTravel, FineStock
from .path_hits import hits_along
from .plunges import PIN, alike_runs

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
        feed: of it, mm/min. rate: that the tool may be fed down with, mm/min; None: nobody says.
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
    limit = np.full(int(course.tool.max(initial=0)) + 1, math.inf)
    for number, rate in known.items():
        limit[number] = MORE * rate if rate is not None else 0.0
    motions = course.motions
    fast = (
        _descends(motions.end - motions.start, motions.kind)
        & (motions.feed > limit[course.tool])
        & (motions.end[:, 2] < top - LEVEL)
    )
    fast[list(course.left_out)] = False
    fast |= _between(fast, motions.end - motions.start)
    spans = [
        span for span in alike_runs(fast.astype(np.int64), course.tool) if _may_be_deep(stock, tools, known, span, top)
    ]
    if not spans:
        return FastPlunges()
    # metal under the axis that a cell would not show makes no plunge, so no closer look is taken
    wide = NARROW * before.grid.pitch
    radius = {number: max(tool.radius * PIN, min(wide, tool.radius)) for number, tool in tools.items()}
    ways = [
        CutterTravel(
            first,
            np.concatenate([motions.start[first : first + 1], motions.end[first : last + 1]]),
            Cutter(radius[int(course.tool[first])], radius[int(course.tool[first])]),
        )
        for first, last in spans
    ]
    deepest: dict[int, list[FastPlunge]] = {}
    looked = hits_along(stock, before, ways, progress)
    for k, hits in looked.hits.items():
        (first, last), hit = spans[k], max(hits, key=lambda each: each.depth)
        number = int(course.tool[first])
        if hit.depth >= _least(tools[number], known[number]):
            feed, (x, y) = float(motions.feed[first : last + 1].max()), _at_height(ways[k].points, hit.z)
            deepest.setdefault(number, []).append(FastPlunge(first, number, x, y, hit.depth, feed, known[number], 1))
    worst = (
        replace(max(found, key=lambda each: each.depth), count=sum(each.count for each in found))
        for found in deepest.values()
    )
    return FastPlunges(tuple(worst), looked.unseen)


def _at_height(points: Floats, z: float) -> tuple[float, float]:
    """Return where on a way down (n, 3) it is at a height."""
    x, y = (float(np.interp(-z, -points[:, 2], points[:, column])) for column in (0, 1))
    return x, y


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
