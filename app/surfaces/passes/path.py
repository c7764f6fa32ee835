"""The path of a cutter over a compound surface: along every plane as low as it comes, each chord proven, told apart by
surface.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.pool import pool
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import in_plane
from ...model.tool import Tool
from ..cutter_contact.drop_cutter import shape_of
from ..patches.facets import SurfaceFacets, surface_parameters
from ..sections.boundary_kinds import kinds_of
from ..sections.compound import BoundaryKind, BoundaryPoints, CompoundSurface, CuttingPlanes, SectionRun
from ..sections.planes import Stretch, extent_on, stretches
from .simplification import PathSimplification, simplified

Floats = NDArray[np.float64]

ALLOWED = 9.99e-5
"""mm; no chord goes deeper into a surface, measured square to the cutter: that is proven for each. Rounding has the
rest of 1e-4.
"""
_WHILE_MADE = 9.7e-5
"""mm; paths are made with less, so that their written text is proven again with a hair to spare."""
_FINE = 1e-7
"""mm; so near to where it could be a path is made first, and facets so near to their surfaces are taken for these."""
_PART, _LEAST, _MOST = 0.05, 1e-4, 0.25
"""Of the tolerance, mm, and of the tolerance at most: so far above where it could be a path may be before points are
left out.
"""
_TWICE = 2.0
"""Times as high as in its middle a chord may be elsewhere, over a path that bends upwards all along it."""
_ROOM = 4096
"""Points that there is room for at first, on a line; four times as many where these are too few."""
_CHORDS = 2_000
"""Chords that are proven in one call, between two looks at whether to stop."""
_NEAR = 1e-9
"""mm, and of a unit direction: what is less is 0."""
_BESIDE, _STORED, _BESIDE_MOST = 1e-7, 2.0**-23, 4e-5
"""mm, and of the coordinates of meshes, by which a cutter's upright side may go into a wall, mm at most: so one that a
pass touches all along its way is passed by, as deep as it goes, and what files round makes it no obstacle. What chords
may go in is less by as much.
"""
_ASIDE, _SWINGS, _STEEP = 0.75, 8, 2.0
"""Of the grid: how far places that are rounded to it are from the line at most; so often as a line turns from steeply
up to steeply down, or back, it may swing beside a wall because of that; and the slope from which on it is steep.
"""
_SHORT = 0.05
"""mm; shorter stretches beside the surfaces are none."""


_THEN = 1.5
"""Times the memory of points as they are followed that all passes take at a time: what is made of them is held beside
them.
"""


@dataclass(frozen=True, eq=False)
class Overrun:
    """How a cutter's centre leaves the box round the surfaces, to reach their feet.

    Attributes:
        far: beyond the box, mm, >= 0.
        places: (n, 2) corners of the surfaces, XY, mm; None: of all that the cutter follows, a floor among it.
        box: x0, y0, x1, y1, mm: it stays in there as well, infinite where nothing is in the way.
        floor: the tip goes no lower out there, mm; nor lower than anywhere within the surfaces' box.
    """

    far: float
    places: Floats | None = None
    box: tuple[float, float, float, float] = (-math.inf, -math.inf, math.inf, math.inf)
    floor: float = -math.inf


@dataclass(frozen=True, slots=True)
class FollowOptions:
    """How a cutter follows surfaces.

    Attributes:
        leave: metal left on them on purpose, mm, >= 0.
        tolerance: so far above where it could be the tip may go, square to its way, mm, > 0.
        grid: places are rounded to it, tips up to it, mm, as they will be written; 0: not at all.
    """

    leave: float = 0.0
    tolerance: float = 0.01
    grid: float = 0.0


class Follower:
    """One tool over surfaces, along any line."""

    def __init__(self, facets: SurfaceFacets, tool: Tool, options: FollowOptions = FollowOptions()) -> None:
        from .point_kernels import GRID

        self.facets, self.options = facets, options
        self.tolerance = min(max(_PART * options.tolerance, _LEAST), _MOST * options.tolerance)
        tree = facets.tree
        self._held = tree.held
        self._order, self._leave = tree.order, options.leave
        self._shape = shape_of(tool, options.leave)
        stored = float(np.abs(facets.triangles[facets.patch < 0]).max(initial=0.0))
        self._room = min(max(_BESIDE, _STORED * stored), _BESIDE_MOST)
        least = max(1e-6, 2 * options.grid)
        self._rules = np.array(
            [
                max(tool.radius / 2, 4 * least),
                self.tolerance,
                _WHILE_MADE - self._room,
                least,
                options.grid,
                float(facets.error.max()),
                _FINE,
            ]
        )

        self._exact = self._rules.copy()
        self._exact[GRID] = 0.0

    def along(self, planes: CuttingPlanes, plane: int, part: Stretch) -> Floats:
        """Return the rows (n, COLUMNS) of points on a plane, facets by their numbers."""
        return self._rows(np.array([*planes.place(plane, 0.0), *planes.along, *part]))

    def between(self, start: tuple[float, float], end: tuple[float, float]) -> Floats | None:
        """Return points (n, 3) of the way straight from one place to another, as low as the surfaces let the tip; None:
        it has a gap, or cannot be proven.
        """
        from . import point_kernels as k

        far = math.dist(start, end)
        try:
            rows = self._rows(np.array([*start, (end[0] - start[0]) / far, (end[1] - start[1]) / far, 0.0, far]))
        except GeometryError:
            return None
        if not (len(rows) > 1 and rows[0, k.S] == 0.0 and rows[-1, k.S] == far) or (rows[1:, k.NEW] == k.BEGINS).any():
            return None
        (rows,) = self.thinned([rows], ((end[0] - start[0]) / far, (end[1] - start[1]) / far))
        return rows[:, k.X : k.Z + 1].copy()

    def thinned(
        self, rows: Sequence[Floats], along: tuple[float, float], progress: Progress = NO_PROGRESS
    ) -> list[Floats]:
        """Return rows along lines of one direction with as few points as the tolerance allows."""
        room = self.options.tolerance - _TWICE * self.tolerance
        return simplified(
            rows, PathSimplification(along, room, self.options.grid, self.facets.owner, self._proven), progress
        )

    def _proven(self, chords: Floats, progress: Progress) -> NDArray[np.bool_]:
        return self.proven(chords, progress, _WHILE_MADE)

    def proven(self, chords: Floats, progress: Progress = NO_PROGRESS, allowed: float = ALLOWED) -> NDArray[np.bool_]:
        """Return which ways (m, 6) of the tip, from a place to a place, go nowhere deeper than allowed into what is to
        be left.
        """
        from . import way_kernels

        lowered = np.ascontiguousarray(chords - np.array([0, 0, self._leave, 0, 0, self._leave]))
        found = np.zeros(len(chords), np.bool_)
        spans = [(first, min(first + _CHORDS, len(chords))) for first in range(0, len(chords), _CHORDS)]
        waiting = [
            pool().submit(way_kernels.clear_all, self._held, self._shape, lowered, *span, allowed, found)
            for span in spans
        ]
        for n, each in enumerate(waiting):
            each.result()
            progress.step((n + 1) / len(waiting), "Proving")
        return found

    def _rows(self, line: Floats) -> Floats:
        """Return the rows of points along a line.

        A wall that is just touched all along is passed by. Where places are rounded off the line, as on all that do not
        run along X or Y, it would be touched or not as they are rounded, and the cutter swing up and down all its
        length: where it does, the line itself is followed, by a cutter that is so much wider.
        """
        from . import point_kernels as k

        rows = self._followed(line, self._beside(-self._room), self._rules)
        aside = _ASIDE * self.options.grid if np.abs(line[2:4]).min() > _NEAR else 0.0
        if aside and (swings := _swings(rows)) > _SWINGS:
            wider = self._rounded(self._followed(line, self._beside(self._room + aside), self._exact))
            rows = wider if _swings(wider) < swings else rows
        for column in (k.FACET, k.LEFT):
            facet = rows[:, column].astype(np.int64)
            rows[:, column] = np.where(facet >= 0, self._order[np.maximum(facet, 0)], -1)
        rows[:, [k.Z, k.TRUE_Z]] += self._leave
        return rows

    def _beside(self, room: float) -> Floats:
        """Return the cutter with so much room between its upright side and walls, mm; < 0: its side, not its lower
        side, may go into them.
        """
        from ..cutter_contact.contact_kernels import BEND, CONE, DISC, RADIUS

        shape = self._shape.copy()
        if room > 0.0 or shape[CONE] == 0.0:
            shape[RADIUS] += room
        if room > 0.0:
            shape[[DISC, BEND]] += room
        return shape

    def _rounded(self, rows: Floats) -> Floats:
        """Return rows of points as they will be written: in X and Y to the nearest place of the grid, in Z upwards."""
        from . import point_kernels as k

        grid = self.options.grid
        rows[:, [k.X, k.Y]] = np.round(rows[:, [k.X, k.Y]] / grid) * grid
        rows[:, k.Z] = np.ceil(rows[:, k.Z] / grid - 1e-6) * grid
        return rows

    def _followed(self, line: Floats, shape: Floats, rules: Floats) -> Floats:
        """Return the rows of points of a cutter along a line, as the kernel gives them.

        Raises:
            GeometryError: a chord cannot be proven.
        """
        from . import follow_kernels
        from . import point_kernels as k

        room = _ROOM
        while True:
            out = np.empty((room, k.COLUMNS))
            count = follow_kernels.follow(self._held, shape, line, rules, out)
            if count >= 0:
                found: Floats = out[:count].copy()
                return found
            if count == follow_kernels.NO_PROOF or room > 1 << 24:
                x, y = line[:2] + line[4] * line[2:4]
                raise GeometryError(f"the pass from {in_plane(x, y)} could not be proven; make its tolerance larger.")
            room *= 4


def _swings(rows: Floats) -> int:
    """Return how often rows of points go steeply down after they went steeply up, or up after down."""
    from . import point_kernels as k

    rise, along = np.diff(rows[:, k.Z]), np.diff(rows[:, k.S])
    steep = (np.abs(rise) > _STEEP * along) & (rows[1:, k.NEW] != k.BEGINS)
    return int(np.count_nonzero(np.diff(np.sign(rise[steep]))))


class PlaneStretch(NamedTuple):
    """A stretch of a cutting plane, by the plane's number."""

    plane: int
    part: Stretch


class _FollowedStretches(NamedTuple):
    """Stretches of planes, and the rows of points on each."""

    stretches: list[PlaneStretch]
    rows: list[Floats]


def cutter_path(
    follower: Follower,
    planes: CuttingPlanes,
    area: shapely.Geometry | None = None,
    progress: Progress = NO_PROGRESS,
    overrun: Overrun = Overrun(0.0),
) -> CompoundSurface:
    """Return the path of a cutter's tip over surfaces: one run or more on each plane, rising along it.

    Its centre stays within the box round the surfaces, seen along the planes, but for the overrun. Where it passes from
    one surface to another, a boundary point is solved for: there it touches both.

    Args:
        area: where the cutter's centre may be, XY; None: everywhere.
        overrun: how far it leaves the box. Planes beside the box on which it then touches nothing are left out.

    Raises:
        GeometryError: a chord could not be proven.
        Cancelled: the job was asked to stop.
    """
    facets = follower.facets
    places = facets.triangles[:, :, :2].reshape(-1, 2) if overrun.places is None else overrun.places
    whole, across = extent_on(planes, places)
    beside = [overrun.far > 0 and not across[0] - _NEAR <= offset <= across[1] + _NEAR for offset in planes.offsets]
    jobs = [
        PlaneStretch(plane, part)
        for plane in range(len(beside))
        if not beside[plane]
        for part in stretches(planes, plane, whole, area)
    ]
    rows = _followed(follower, planes, jobs, progress.part(0.0, 0.7 if overrun.far > 0 else 0.8))
    if overrun.far > 0:
        outer = whole[0] - overrun.far, whole[1] + overrun.far
        allowed = _allowed(planes, outer, overrun, area)
        more = [
            PlaneStretch(plane, part)
            for plane, beyond in enumerate(beside)
            for piece in ((outer,) if beyond else ((outer[0], whole[0]), (whole[1], outer[1])))
            for part in stretches(planes, plane, piece, allowed)
            if part[1] - part[0] > _SHORT
        ]
        lowest = max(overrun.floor, min((float(each[:, _z()].min()) for each in rows if len(each)), default=-math.inf))
        more, outside = _outside(follower, planes, more, lowest, progress.part(0.7, 0.8))
        jobs, rows = _in_a_row([*jobs, *more], [*rows, *outside])
    kept, numbers = _used(planes, beside, [plane for (plane, _), each in zip(jobs, rows, strict=True) if len(each) > 1])
    chosen = [k for k, (plane, _) in enumerate(jobs) if plane in numbers]
    few = follower.thinned([rows[k] for k in chosen], planes.along, progress.part(0.8, 1.0))
    return _compound(facets, kept, [numbers[jobs[k].plane] for k in chosen], few)


def _z() -> int:
    from .point_kernels import Z

    return Z


def _allowed(
    planes: CuttingPlanes, outer: Stretch, overrun: Overrun, area: shapely.Geometry | None
) -> shapely.Geometry:
    """Return where the centre may be in the overrun."""
    far = (
        max(abs(outer[0]), abs(outer[1]))
        + max(map(abs, planes.offsets), default=0.0)
        + max(map(abs, planes.origin))
        + 1.0
    )
    box = shapely.box(*(min(max(side, -far), far) for side in overrun.box))
    return box if area is None else shapely.intersection(box, area)


def _followed(
    follower: Follower, planes: CuttingPlanes, jobs: Sequence[PlaneStretch], progress: Progress
) -> list[Floats]:
    """Return the rows of points of each stretch of a plane."""
    waiting = [pool().submit(follower.along, planes, plane, part) for plane, part in jobs]
    rows: list[Floats] = []
    held, look = 0, 4
    try:
        for n, each in enumerate(waiting):
            rows.append(each.result())
            held += rows[-1].nbytes
            if n + 1 == look:
                look *= 4
                planes.ask_memory(_THEN * held * len(waiting) / (n + 1) - held)
            progress.step((n + 1) / len(waiting), "Following the surfaces")
    except BaseException:
        for each in waiting:
            each.cancel()
        raise
    return rows


def _outside(
    follower: Follower, planes: CuttingPlanes, jobs: Sequence[PlaneStretch], lowest: float, progress: Progress
) -> _FollowedStretches:
    """Return stretches of planes as far as the tip is no lower than a height on them, and the rows of points there."""
    rows = _followed(follower, planes, jobs, progress)
    short: list[PlaneStretch] = []
    for (plane, _), each in zip(jobs, rows, strict=True):
        short += [PlaneStretch(plane, part) for part in _above(each, lowest, follower.tolerance)]
    return _FollowedStretches(short, _followed(follower, planes, short, NO_PROGRESS))


def _above(rows: Floats, lowest: float, tolerance: float) -> list[Stretch]:
    """Return from where to where points are above a height; where a chord goes below it, so early that the true path
    does not.
    """
    from . import point_kernels as k

    found: list[Stretch] = []
    start = None
    for n, row in enumerate(rows):
        begins, here = n == 0 or row[k.NEW] == k.BEGINS, row[k.Z] >= lowest
        if begins and start is not None:
            found.append((start, float(rows[n - 1, k.S])))
        start = None if begins else start
        if begins and here:
            start = float(row[k.S])
        elif not begins and here != (rows[n - 1, k.Z] >= lowest):
            drop = float(row[k.Z] - rows[n - 1, k.Z])
            share = min(max((lowest + tolerance - float(rows[n - 1, k.Z])) / drop, 0.0), 1.0)
            at = float(rows[n - 1, k.S] + share * (row[k.S] - rows[n - 1, k.S]))
            found += [] if start is None else [(start, at)]
            start = at if here else None
    if start is not None:
        found.append((start, float(rows[-1, k.S])))
    return [part for part in found if part[1] - part[0] > _SHORT]


def _in_a_row(jobs: Sequence[PlaneStretch], rows: Sequence[Floats]) -> _FollowedStretches:
    """Return the stretches in the order of their planes and along them, those joined that meet at one point."""
    from . import point_kernels as k

    found: list[PlaneStretch] = []
    made: list[Floats] = []
    for n in sorted(range(len(jobs)), key=lambda n: jobs[n]):
        (plane, part), own = jobs[n], rows[n]
        last = made[-1] if made and found[-1].plane == plane else own[:0]
        if len(last) and len(own) and abs(last[-1, k.S] - own[0, k.S]) <= _NEAR and last[-1, k.Z] == own[0, k.Z]:
            own = own[1:]
            made[-1] = np.concatenate([last, own])
        else:
            found.append(PlaneStretch(plane, part))
            made.append(own)
    return _FollowedStretches(found, made)


def _used(
    planes: CuttingPlanes, beside: Sequence[bool], touched: Sequence[int]
) -> tuple[CuttingPlanes, dict[int, int]]:
    """Return the planes without those beside the surfaces on which nothing is touched, and the new number of each."""
    kept = [plane for plane in range(len(beside)) if not beside[plane] or plane in set(touched)]
    return replace(planes, offsets=tuple(planes.offsets[plane] for plane in kept)), {
        plane: n for n, plane in enumerate(kept)
    }


def _compound(
    facets: SurfaceFacets, planes: CuttingPlanes, numbers: Sequence[int], parts: Sequence[Floats]
) -> CompoundSurface:
    """Return rows of points as runs and boundary points."""
    from . import point_kernels as k

    runs: list[SectionRun] = []
    for plane, rows in zip(numbers, parts, strict=True):
        starts = np.flatnonzero(rows[:, k.NEW] == k.BEGINS)
        for first, stop in pairwise([*starts.tolist(), len(rows)]):
            points, owner = (
                rows[first:stop, k.X : k.Z + 1],
                facets.owner[rows[first : stop - 1, k.FACET].astype(np.int64)],
            )
            apart = (np.diff(points, axis=0) != 0).any(axis=1)  # a boundary point may be written where its neighbour is
            if apart.any():
                runs.append(SectionRun(plane, points[np.append(apart, True)], owner[apart]))
    return CompoundSurface(planes, tuple(runs), _boundaries(facets, planes, numbers, parts))


class _Passage(NamedTuple):
    """Where the path on a plane passes from a surface to another: rows of points on both, one without a jump."""

    plane: int
    here: Floats
    there: Floats
    jump: bool


def _boundaries(
    facets: SurfaceFacets, planes: CuttingPlanes, numbers: Sequence[int], parts: Sequence[Floats]
) -> BoundaryPoints:
    """Return where the path passes from surface to surface: where it touches both, and where it jumps from one to the
    other.
    """
    from . import point_kernels as k

    found: list[_Passage] = []
    for plane, rows in zip(numbers, parts, strict=True):
        met = rows[:, k.NEW] == k.BOUNDARY
        left, right = rows[:, k.LEFT].astype(np.int64), rows[:, k.FACET].astype(np.int64)
        for n in np.flatnonzero(met).tolist():
            found.append(_Passage(plane, rows[n], rows[n], jump=False))
        corners = np.flatnonzero(rows[:, k.NEW] == k.CORNER)
        for n in corners[(corners > 0) & (corners < len(rows) - 1)].tolist():
            if not met[n + 1] and facets.owner[right[n - 1]] != facets.owner[left[n + 1]]:
                found.append(_Passage(plane, rows[n - 1], rows[n + 1], jump=True))
    found.sort(key=lambda each: (each.plane, each.here[k.MET]))
    if not found:
        return BoundaryPoints.none()
    where = np.array([each.plane for each in found])
    here, there = np.array([each.here for each in found]), np.array([each.there for each in found])
    jump = np.array([each.jump for each in found])
    one = np.where(jump, here[:, k.FACET], here[:, k.LEFT]).astype(np.int64)
    other = np.where(jump, there[:, k.LEFT], there[:, k.FACET]).astype(np.int64)
    at_one = np.where(jump[:, None], here[:, [k.U, k.V]], here[:, [k.LEFT_U, k.LEFT_V]])
    at_other = np.where(jump[:, None], there[:, [k.LEFT_U, k.LEFT_V]], there[:, [k.U, k.V]])
    place = np.array(
        [(*planes.place(p, s), z) for p, s, z in zip(where.tolist(), here[:, k.MET], here[:, k.TRUE_Z], strict=True)]
    )
    end = np.array(
        [(*planes.place(p, s), z) for p, s, z in zip(where.tolist(), there[:, k.MET], there[:, k.TRUE_Z], strict=True)]
    )
    sides = (surface_parameters(facets, one, at_one), surface_parameters(facets, other, at_other))
    kind = np.where(jump, BoundaryKind.JUMP, kinds_of(facets, (one, other), sides))
    return BoundaryPoints(where, facets.owner[one], facets.owner[other], place, end, *sides, kind.astype(np.uint8))
