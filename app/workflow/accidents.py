"""What goes wrong on the way, whatever the part is: rapids in metal, a start in it, plunges, the table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.dexel.cutter import Cutter
from app.dexel.trim import Course, Cut, Rapids, TrimOptions, trim
from app.dexel.workpiece import Workpiece
from app.model.finding import Finding, FindingKind
from app.model.motion import MotionKind, Motions
from app.model.motion_path import reach
from app.progress import NO_PROGRESS, Progress
from app.tolerances import LEVEL
from app.workflow.course import KnownCourse

NAMED = 50
"""Accidents of one kind that are told one by one."""

UPRIGHT = 1e-3
"""mm sideways per mm down, up to which a motion goes straight down."""

PIN = 0.25
"""Part of a cutter's radius, round its axis, in which it does not cut if it does not cut at its centre."""


@dataclass(frozen=True, eq=False)
class Stage:
    """One program of a setup: what it is cut along, out of what, with what, and what it leaves."""

    known: KnownCourse
    before: Workpiece
    cut: Cut
    cutters: Mapping[int, Cutter]

    @property
    def motions(self) -> Motions:
        """Of the program."""
        return self.known.course.motions


def accidents(stage: Stage, progress: Progress = NO_PROGRESS) -> tuple[Finding, ...]:
    """Return what goes wrong while a program is cut; places in program coordinates.

    Raises:
        Cancelled: the job was asked to stop.
    """
    return (*_start(stage), *_rapids(stage), *_plunges(stage, progress), *_below_table(stage))


def _start(stage: Stage) -> Iterator[Finding]:
    """Yield that the program begins with the tool in the metal."""
    first, course = stage.known.first, stage.known.course
    if first == len(stage.motions):
        return
    cutter = stage.cutters.get(int(course.tool[first]))
    place = stage.motions.end[first]
    depth = _depth_at(stage.before, cutter, place) if cutter is not None else 0.0
    if depth > LEVEL:
        x, y, z = place.tolist()
        line = int(stage.motions.line[first])
        text = (f"The first place that the program names, X {x:.3f} Y {y:.3f} Z {z:.3f} in NC line {line}, is {depth:.3f} mm deep in the "
                "stock; go above the stock first (G0 Z...), or tell the stock as it is.")
        yield Finding(FindingKind.START_IN_STOCK, text, x, y, amount=depth, line=line)


def _depth_at(workpiece: Workpiece, cutter: Cutter, place: np.ndarray) -> float:
    """Return how deep a cutter that stands at a place is in the metal, mm."""
    grid = workpiece.grid
    across, up = (np.abs(centres - at) <= cutter.radius for centres, at in ((grid.xs(), place[0]), (grid.ys(), place[1])))
    if not across.any() or not up.any():
        return 0.0
    radii = np.hypot(grid.xs()[across][None, :] - place[0], grid.ys()[up][:, None] - place[1])
    metal = workpiece.heights[np.ix_(up, across)]
    return max(0.0, float(np.max(np.where(metal > workpiece.floor, metal - (place[2] + cutter.heights(radii)), 0.0))))


def _rapids(stage: Stage) -> Iterator[Finding]:
    """Yield the rapids that go through metal, the first ones one by one."""
    motions, hits = stage.motions, stage.cut.rapids
    for hit in hits[:NAMED]:
        line = int(motions.line[hit.motion])
        text = (f"A rapid goes through metal, {hit.depth:.3f} mm deep at ({hit.x:.3f}, {hit.y:.3f}, {hit.z:.3f}), NC line {line}; "
                "do not run this program.")
        yield Finding(FindingKind.RAPID_IN_MATERIAL, text, hit.x, hit.y, amount=hit.depth, line=line)
    if len(hits) > NAMED:
        yield Finding(FindingKind.RAPID_IN_MATERIAL, f"{len(hits) - NAMED} more rapids go through metal; do not run this program.",
                      amount=float(len(hits) - NAMED))  # fmt: skip


def _plunges(stage: Stage, progress: Progress) -> Iterator[Finding]:
    """Yield the motions straight down into metal of mills that do not cut at their centre."""
    motions, course = stage.motions, stage.known.course
    blunt = [number for number, cutter in stage.cutters.items() if not cutter.centre_cutting]
    way = motions.end - motions.start
    down = (motions.kind == MotionKind.LINE) & (way[:, 2] < 0) & (np.hypot(way[:, 0], way[:, 1]) <= UPRIGHT * -way[:, 2])
    down &= np.isin(course.tool, blunt)
    down[list(course.left_out)] = False
    if len(stage.cut.engaged):
        down &= stage.cut.engaged > 0
    rows = np.flatnonzero(down)
    if not len(rows):
        return
    asked = _with_pins(course, rows, int(max(stage.cutters)) + 1)
    pins = {int(max(stage.cutters)) + 1 + k: Cutter(stage.cutters[k].radius * PIN, stage.cutters[k].radius * PIN) for k in blunt}
    hits = trim(stage.before, asked, {**stage.cutters, **pins}, TrimOptions(Rapids.ASKED), progress).rapids
    inserted = rows + np.arange(len(rows))
    for hit in hits:
        at = int(np.searchsorted(inserted, hit.motion))
        if at == len(rows) or inserted[at] != hit.motion:
            continue
        row = int(rows[at])
        line, number = int(motions.line[row]), int(course.tool[row])
        x, y, _ = motions.end[row].tolist()
        text = (f"T{number} goes straight down into metal at ({x:.3f}, {y:.3f}), NC line {line}, and does not cut at its centre; "
                "ramp in, or use a cutter that does.")
        yield Finding(FindingKind.PLUNGE, text, x, y, amount=hit.depth, line=line)


def _with_pins(course: Course, rows: np.ndarray, first: int) -> Course:
    """Return the course with each of some motions asked, before it is cut, by the dead centre of its cutter: T `first` + its T."""
    motions, count = course.motions, len(course.motions)
    order = np.insert(np.arange(count), rows, rows)
    pins = np.zeros(len(order), bool)
    pins[rows + np.arange(len(rows))] = True
    place = np.flatnonzero(~pins)
    columns = {name: getattr(motions, name)[order] for name in ("start", "end", "centre", "plane", "turns", "feed", "line", "state")}
    kind = np.where(pins, MotionKind.RAPID, motions.kind[order]).astype(np.uint8)
    splines = {int(place[row]): spline for row, spline in motions.splines.items()}
    tool = (course.tool[order] + np.where(pins, first, 0)).astype(np.int32)
    return Course(replace(motions, kind=kind, splines=splines, **columns), tool, tuple(place[list(course.left_out)].tolist()))


def _below_table(stage: Stage) -> Iterator[Finding]:
    """Yield that the tool goes below the stock, where the table is."""
    low = reach(stage.motions)[0][:, 2].copy()
    low[list(stage.known.course.left_out)] = np.inf
    floor = stage.before.floor
    below = np.flatnonzero(low < floor - LEVEL)
    if not len(below):
        return
    row = int(np.argmin(low))
    x, y, _ = stage.motions.end[row].tolist()
    line, depth = int(stage.motions.line[below[0]]), floor - float(low[row])
    motions = "1 motion goes" if len(below) == 1 else f"{len(below)} motions go"
    text = (f"{motions} below the stock's underside, Z {floor:.3f}, where the table is: {depth:.3f} mm at ({x:.3f}, {y:.3f}), the first in "
            f"NC line {line}; put something under the stock, or cut less deep.")
    yield Finding(FindingKind.BELOW_TABLE, text, x, y, amount=depth, line=line)
