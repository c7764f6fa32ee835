"""Mills that do not cut at their centre, led down into metal where their dead centre stays over the same place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.motion import Floats, MotionKind, Plane
from ..model.motion_path import arc_paths
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course
from .course import picked
from .fine_stock import CutterTravel, FineStock
from .path_hits import hits_along

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
