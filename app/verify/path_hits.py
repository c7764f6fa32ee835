"""Where cutters that are led along some ways, each when its motion is about to begin, meet metal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Grid, Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import RapidHit, trim
from .course import inserted, picked, straight
from .fine_stock import MOST, NARROW, CutterTravel, FineStock, fine_grids

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
