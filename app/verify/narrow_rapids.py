"""Rapids of cutters that are narrower than the cells: what the cells' centres have not seen is looked at closer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core.progress import NO_PROGRESS, Progress
from ..core.tolerances import LEVEL
from ..model.motion import MotionKind
from ..model.motion_path import reach
from ..simulation.cutter import Cutter
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.course import Course
from ..simulation.sweeps.trim import RapidHit
from .fine_stock import MOST, NARROW, CutterTravel, FineStock

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class NarrowRapids:
    """The rapids of a program that go through metal, in their order, and how many could not, or not wholly, be looked
    at closer.
    """

    rapids: tuple[RapidHit, ...]
    unseen: int = 0


def narrow_rapids(
    course: Course, stock: FineStock, before: Workpiece, seen: tuple[RapidHit, ...], progress: Progress = NO_PROGRESS
) -> NarrowRapids:
    """Return the rapids that go through metal.

    Args:
        course: of the last program of `stock`. before: the metal before it. seen: those that the cells have shown.

    Raises:
        Cancelled: the job was asked to stop.
    """
    top, pitch = float(before.heights.max()), before.grid.pitch
    rows = np.flatnonzero(
        _in_question(course, stock, top, pitch) & ~np.isin(np.arange(len(course.motions)), [hit.motion for hit in seen])
    )
    rows = rows[~_goes_where_it_was(course, rows)]
    hits, unseen = list(seen), max(0, len(rows) - MOST)
    for k, row in enumerate(rows[:MOST].tolist()):
        progress.step(k / len(rows), "Looking at rapids")
        ends = np.array([course.motions.start[row], course.motions.end[row]])
        way = CutterTravel(row, ends, stock.cutters[int(course.tool[row])])
        hit = stock.met(way, top, pitch)
        hits += [hit] if hit is not None else []
        unseen += hit is None and not stock.wholly(way, top, pitch)
    return NarrowRapids(tuple(sorted(hits, key=lambda hit: hit.motion)), unseen)


def _in_question(course: Course, stock: FineStock, top: float, pitch: float) -> Mask:
    """Return which motions are rapids below the top, over the stock, of cutters that are narrow down there."""
    motions, (x0, y0, x1, y1) = course.motions, stock.stock.box
    low, high = reach(motions)
    radius, up_to = _widths(course, stock.cutters, pitch)
    over = (
        (low[:, 0] - radius < x1) & (low[:, 1] - radius < y1) & (high[:, 0] + radius > x0) & (high[:, 1] + radius > y0)
    )
    below = top - low[:, 2]
    requested = (motions.kind == MotionKind.RAPID) & over & (below > LEVEL) & (below < up_to)
    requested[list(course.left_out)] = False
    return np.asarray(requested)


def _widths(
    course: Course, cutters: Mapping[int, Cutter], pitch: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return of each motion's cutter the radius, and the height over the tip up to which it is narrow, mm; without one:
    none.
    """
    radius, up_to = np.zeros(len(course.motions)), np.zeros(len(course.motions))
    for number, cutter in cutters.items():
        mine = course.tool == number
        radius[mine], up_to[mine] = cutter.radius, float(cutter.heights(np.array([NARROW * pitch]))[0]) + cutter.lift
    return radius, up_to


def _goes_where_it_was(course: Course, rows: NDArray[np.intp]) -> Mask:
    """Return which rapids go upright over a place where their cutter has cut as deep before."""
    motions = course.motions
    upright = np.all(motions.start[:, :2] == motions.end[:, :2], axis=1)
    requested = rows[upright[rows]]
    if not len(requested):
        return np.zeros(len(rows), np.bool_)
    cuts = motions.kind != MotionKind.RAPID
    cuts[list(course.left_out)] = False
    cuts &= upright | np.append(~cuts[1:], True)
    cuts[requested] = True
    asked, looked_at = np.isin(np.arange(len(motions)), requested), np.flatnonzero(cuts)
    deepest: dict[tuple[int, float, float], float] = {}
    clear: list[int] = []
    low = np.minimum(motions.start[looked_at, 2], motions.end[looked_at, 2])
    each = (looked_at, asked[looked_at], course.tool[looked_at], *motions.end[looked_at].T, low)
    for row, question, tool, x, y, z, lower in zip(*(values.tolist() for values in each), strict=True):
        if not question:
            deepest[tool, x, y] = min(deepest.get((tool, x, y), np.inf), z)
        elif deepest.get((tool, x, y), np.inf) <= lower:
            clear.append(row)
    return np.isin(rows, clear)
