"""Gouges in a solid: how deep each place is, measured on the solid and on the motions themselves, not on the cells that
show it.

The cells tell where metal of the solid was cut away. At the centres of those that seem deepest the exact depth is
asked, points on the walls tell what lies between the cells, and from the deepest ones on it is climbed: the program's
height at any place, and the solid's distance there, are closed forms. So what is told is the depth of a place that was
cut; that nothing else is deeper by more than a cell's way, the certificate says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from shapely import (
    STRtree,
    area,
    box,
    buffer,
    constrained_delaunay_triangles,
    covers,
    get_coordinates,
    get_exterior_ring,
    get_parts,
    length,
    linestrings,
    multilinestrings,
    point_on_surface,
    polygonize,
    polygons,
    union_all,
)

from ..core.pool import pool
from ..core.progress import NO_PROGRESS, Progress
from ..model.motion import Floats
from ..simulation.field.solid import SolidStock
from ..simulation.field.target import frozen
from ..simulation.field.triangle_tree import TriangleTree
from ..simulation.field.workpiece import Heights, Workpiece
from ..surfaces.meshes.edges import MeshEdges
from ..surfaces.meshes.sew import ROUNDED
from .judge import MOST, CellPlace
from .judgement import Spot, SpotKind
from .parts import SolidPart
from .wall_probe import Probe, WallProbe, stock_at

ASKED = 4000
"""Cells of a place that the solid is asked at, half of them those that seem deepest, the others spread; of all places
ten times as many.
"""

APART = 1.0
"""mm between gouges in walls that are told one by one."""

STARTS, NEAR = 12, 0.5
"""Places that the depth of the deepest gouge is climbed from, so far apart, mm; that of each other one from its own
deepest.
"""

ROUNDS, ROUNDS_OF_OTHERS, SIDE = 24, 12, 2
"""Times that the places round the best one so far are asked, on (2 SIDE + 1)² places, nearer and nearer."""


@dataclass(frozen=True, eq=False)
class SolidGouges:
    """What measures gouges in a solid.

    Attributes:
        part: the solid. lowest: gives the height that is cut down to, and by whom. before: the stock.
        heights: (rows, cols) that are left, on the stock's grid. gouged: which of the cells are. around: the solid, as
            in `TargetHeights`.
        lines: NC line of each motion.
        depths: gives what tells how deep places lie in the solid; asked where something is.
    """

    part: SolidPart
    lowest: Probe
    before: Workpiece
    heights: Heights
    gouged: NDArray[np.bool_]
    around: Heights
    lines: NDArray[np.int32]
    depths: Callable[[], DepthInSolid]

    def spots(self, places: Sequence[CellPlace], walls: WallProbe | None) -> list[Spot]:
        """Return the gouges with their depths, the deepest first.

        Args:
            places: of cells. walls: looks for what lies at walls between the cells; what it finds in places of cells is
                that place's.
        """
        home, most = self._homes(places), min(ASKED, max(64, 10 * ASKED // max(len(places), 10)))
        found = [self._of_cells(place, most) for place in places]
        depths = np.array([*(spot.depth_mm for spot in found), 0.0])  # the last one is that of no place
        if walls is not None:
            narrow = self._narrow(walls, lambda points: depths[self._home(home, points)])
            numbers = self._home(home, np.array([(spot.x, spot.y) for spot in narrow]).reshape(-1, 2)).tolist()
            for spot, number in zip(narrow, numbers, strict=True):
                if number < 0:
                    found.append(spot)
                elif spot.depth_mm > found[number].depth_mm:
                    found[number] = replace(spot, area_mm2=places[number].area_mm2, disc_mm=places[number].disc_mm)
        if not found:
            return []
        found.sort(key=lambda spot: -spot.depth_mm)
        found[:MOST] = [self._climbed(spot, np.array([(spot.x, spot.y)]), ROUNDS_OF_OTHERS) for spot in found[:MOST]]
        found.sort(key=lambda spot: -spot.depth_mm)
        found[0] = self._climbed(found[0], self._starts(found, places), ROUNDS)
        return [spot for spot in found if spot.depth_mm > self.part.tolerance]

    def _narrow(self, walls: WallProbe, deep: Callable[[Floats], Floats]) -> list[Spot]:
        """Return gouges in walls that are deeper than what is known round them, one within APART, the deepest first."""
        cut = walls.cut_places(deep)
        if not len(cut):
            return []
        columns, fine = CutColumns(cut.places, cut.heights, stock_at(self.before, cut.places)), self.part.tolerance / 10
        depth = self.depths().of(columns, fine=fine)
        self._measure(
            depth, columns, np.flatnonzero((depth <= self.part.tolerance) & (depth > self.part.tolerance - 2 * fine))
        )
        order = np.argsort(-depth, kind="stable")
        order = order[depth[order] > self.part.tolerance]
        reported = order[apart(cut.places[order])]
        self._measure(depth, columns, reported)
        return [
            self._spot(cut.places[k], float(cut.heights[k]), float(depth[k]), int(cut.motion[k]))
            for k in reported.tolist()
        ]

    def _measure(self, depth: Floats, columns: CutColumns, some: NDArray[np.int64]) -> None:
        """Measure the depths of some columns as finely as can be."""
        depth[some] = np.maximum(depth[some], self.depths().of(columns.only(some)))

    def _spot(self, place: Floats, z: float, depth: float, motion: int) -> Spot:
        line = int(self.lines[motion]) if motion >= 0 else 0
        return Spot(SpotKind.GOUGE, float(place[0]), float(place[1]), z, depth, 0.0, 0.0, line, motion)

    def _homes(self, places: Sequence[CellPlace]) -> NDArray[np.int64]:
        """Return the number of the place of each cell, -1: none, with a cell round each place."""
        import cv2

        if not places:
            return np.full(self.gouged.shape, -1, np.int64)
        count, labels = cv2.connectedComponents(self.gouged.astype(np.uint8), connectivity=8)
        numbers = np.full(count, -1, np.int64)
        for number, place in enumerate(places):
            numbers[labels[place.cell]] = number
        return numbers[cv2.dilate(labels.astype(np.float32), np.ones((3, 3), np.uint8)).astype(np.int64)]

    def _home(self, home: NDArray[np.int64], points: Floats) -> NDArray[np.int64]:
        """Return the number of the place that each point (m, 2) lies in, -1: none."""
        grid = self.before.grid
        cols, rows = (
            np.floor((points[:, axis] - start) / grid.pitch).astype(np.int64)
            for axis, start in ((0, grid.x0), (1, grid.y0))
        )
        return home[np.clip(rows, 0, grid.rows - 1), np.clip(cols, 0, grid.cols - 1)]

    def _of_cells(self, place: CellPlace, most: int) -> Spot:
        """Return a place's deepest cell of those that are asked."""
        cells = self._asked(place, most)
        depth = self.depths().of(self._columns(cells), fine=self.part.tolerance / 10)
        worst = int(np.argmax(depth))
        at = np.array([self.before.grid.place(int(cells[worst]))])
        z, motion = self.lowest(at)
        spot = self._spot(
            at[0], float(min(z[0], self.heights.ravel()[cells[worst]])), float(depth[worst]), int(motion[0])
        )
        return replace(spot, area_mm2=place.area_mm2, disc_mm=place.disc_mm)

    def _asked(self, place: CellPlace, most: int) -> NDArray[np.int64]:
        """Return cells of a place: those that seem deepest by the cells round them, and others spread over it."""
        from ..simulation.field.judge_kernels import ways_out

        if len(place.cells) <= most:
            return place.cells
        seems = np.zeros(len(place.cells))
        ways_out(frozen(self.around), frozen(self.heights), place.cells, (self.before.grid.pitch, 0.0), seems)
        order = np.argsort(-seems, kind="stable")
        return np.unique(
            np.concatenate([place.cells[order[: most // 2]], place.cells[:: 1 + 2 * len(place.cells) // most]])
        )

    def _columns(self, cells: NDArray[np.int64]) -> CutColumns:
        """Return what was cut away over the centres of cells."""
        grid = self.before.grid
        rows, cols = np.divmod(cells, grid.cols)
        places = np.column_stack([grid.x0 + (cols + 0.5) * grid.pitch, grid.y0 + (rows + 0.5) * grid.pitch])
        return CutColumns(
            places, *(each.ravel()[cells].astype(np.float64) for each in (self.heights, self.before.heights))
        )

    def _starts(self, found: Sequence[Spot], places: Sequence[CellPlace]) -> Floats:
        """Return where to climb from (k, 2): the deepest spots, and cells that are nearly as deep as the deepest, apart
        from them.
        """
        best = found[0].depth_mm
        starts = [(spot.x, spot.y) for spot in found[:STARTS] if spot.depth_mm > best - 2 * self.before.grid.pitch]
        for place in places[:STARTS]:
            columns = self._columns(self._asked(place, ASKED // 4))
            depth = self.depths().of(columns, best - 2 * self.before.grid.pitch, self.part.tolerance)
            for k in np.argsort(-depth, kind="stable")[:ASKED].tolist():
                x, y = columns.places[k].tolist()
                if len(starts) >= 2 * STARTS or depth[k] < best - 2 * self.before.grid.pitch:
                    break
                if all(math.hypot(x - a, y - b) > NEAR for a, b in starts):
                    starts.append((x, y))
        return np.array(starts)

    def _climbed(self, spot: Spot, starts: Floats, rounds: int) -> Spot:
        """Return the deepest place that is found between the cells from some places (k, 2) on."""
        side = np.arange(-SIDE, SIDE + 1) / SIDE
        around = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
        places, reach, each = starts, self.before.grid.pitch, len(around)
        best = np.full(len(starts), -1.0)
        for _ in range(rounds):
            requested = (places[:, None] + around * reach).reshape(-1, 2)
            z, motion = self.lowest(requested)
            depth = self.depths().of(
                CutColumns(requested, np.where(motion >= 0, z, np.inf), stock_at(self.before, requested))
            )
            deepest = np.argmax(depth.reshape(-1, each), axis=1) + np.arange(len(places)) * each
            better = depth[deepest] > best
            places, best = np.where(better[:, None], requested[deepest], places), np.where(better, depth[deepest], best)
            k = int(deepest[int(np.argmax(depth[deepest]))])
            if depth[k] > spot.depth_mm:
                (x, y), row = requested[k].tolist(), int(motion[k])
                spot = replace(
                    spot, x=x, y=y, z=float(z[k]), depth_mm=float(depth[k]), motion=row, line=int(self.lines[row])
                )
            reach *= 0.6
        return spot


def apart(places: Floats) -> NDArray[np.int64]:
    """Return which of some places (m, 2), in order, are farther than APART from all of these before them."""
    from .clearance_kernels import told_apart

    cells = np.floor(places / APART).astype(np.int64)
    cells -= cells.min(axis=0, initial=0) - 1
    high = int(cells[:, 1].max(initial=0)) + 2
    squares, own = np.unique(cells[:, 0] * high + cells[:, 1], return_inverse=True)
    beside = squares[:, None] + np.array([dx * high + dy for dx in (-1, 0, 1) for dy in (-1, 0, 1)])
    at = np.minimum(np.searchsorted(squares, beside), len(squares) - 1)
    around = np.where(squares[at] == beside, at, -1)
    reported = np.empty(len(places), np.int64)
    return reported[
        : told_apart(np.ascontiguousarray(places), own.ravel(), np.ascontiguousarray(around), APART, reported)
    ]


# How deep places lie in a solid: the exact distance to its nearest triangle, over whole columns of metal that was cut
# away.


FINE = 1e-5
"""mm by which the depth of a column may be told too small."""

ASIDE = 1.3e-7
"""mm by which a line is moved, so that it hardly ever runs along an upright triangle."""


@dataclass(frozen=True, eq=False)
class CutColumns:
    """Upright pieces of metal that were cut away, (m,) each.

    Attributes:
        places: (m, 2) x, y, mm. low, high: their ends, mm; where high is below low there is nothing.
    """

    places: Floats
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.low)

    def only(self, rows: NDArray[np.int64] | slice) -> CutColumns:
        """Return some of them."""
        return CutColumns(self.places[rows], self.low[rows], self.high[rows])


class _ColumnParts(NamedTuple):
    """Parts of columns: which column each is of, and x, y, low, high (k, 4), mm."""

    column: NDArray[np.int64]
    segments: Floats


class DepthInSolid:
    """Answers how deep metal was cut into a solid with stock to leave on it."""

    def __init__(self, solid: SolidStock, leave: float = 0.0, progress: Progress = NO_PROGRESS) -> None:
        """Find what bounds the solid's bodies together.

        Raises:
            Cancelled: by progress.
        """
        self._solid, self._leave = solid, leave
        self._tree = solid.tree if solid.shells == 1 else TriangleTree.of(outer_faces(solid, progress))

    def of(self, columns: CutColumns, known: float = 0.0, fine: float = FINE) -> Floats:
        """Return how deep the deepest place of each column lies below the surface of what is wanted, mm, >= 0.

        Args:
            known: columns that are no deeper than this, mm, are of no interest: for them less may be told.
            fine: by so much a depth may be told too small, mm.
        """
        depth = np.zeros(len(columns))
        column, segments = self._in_solid(columns)
        if len(column):
            deepest = self._tree.deepest(segments, np.full(len(segments), max(known - self._leave, 0.0)), fine)
            np.maximum.at(depth, column, deepest + self._leave)
        if self._leave:
            skin = np.flatnonzero((depth == 0) & (columns.high > columns.low))
            places = np.column_stack([columns.places[skin], columns.low[skin]])
            depth[skin] = np.maximum(self._leave - self._tree.distances(places), 0.0)
        return depth

    def _in_solid(self, columns: CutColumns) -> _ColumnParts:
        """Return what of columns lies in the solid, by the winding number."""
        point, heights, up = self._solid.tree.met(columns.places + np.array([ASIDE, ASIDE * 0.7]))
        order = np.lexsort((heights, point))
        point, heights, up = point[order], heights[order], up[order]
        winds = np.cumsum(-up)  # a face that looks down begins a solid, one that looks up ends it
        winds -= (winds + up)[np.searchsorted(point, point)]  # each column begins at 0, whatever came of the one before
        inside = np.flatnonzero((winds[:-1] > 0.5) & (point[:-1] == point[1:]))
        column = point[inside]
        low, high = (
            np.maximum(heights[inside], columns.low[column]),
            np.minimum(heights[inside + 1], columns.high[column]),
        )
        some = high > low
        return _ColumnParts(column[some], np.column_stack([columns.places[column], low, high])[some])


# The surface of bodies taken together: of faces that lie partly within, or on, another body, what is free.
#
# Bodies of one file may go through one another, or touch in part of a side. What of their faces has metal on both
# sides is no surface, and nothing is near to it.


Ints = NDArray[np.int64]

BEFORE = 1.3e-7
"""mm before a face at which it is asked whether there is metal, at the least; sides that touch are as far apart as
files round.
"""

_GRID = 1e-8
"""mm; where faces cross is rounded to so much, so that lines that meet do meet. Far below `FINE`."""

_BEYOND, _NARROW = 4.0, 2.0
"""Times as far as sides that touch are apart: lines go on behind their ends, so that what ends on another line's side
crosses it; and parts of faces that are no wider are none.
"""

_LEAST = 1e-12
"""mm2; smaller triangles of a part are none."""

_TEXT = "Bodies together"

_PORTION, _TOGETHER = 256, 4
"""Faces that are worked on in one go, and how many goes are given to the cores between two looks at whether to stop."""


class _CrossingLines(NamedTuple):
    """Lines along which other bodies' faces come through just before faces, m of them.

    Attributes:
        face: (m,) that each one cuts, ascending. ends: (m, 2, 2) in the axes of that face, mm.
    """

    face: Ints
    ends: Floats


def outer_faces(solid: SolidStock, progress: Progress = NO_PROGRESS) -> Floats:
    """Return the triangles (k, 3, 3) that bound the metal of all bodies of a solid together, mm.

    A face is cut where other bodies' faces come through just before it. Each part has metal before it, or none, all
    over, and goes or stays.

    Args:
        solid: of closed bodies, right side out.

    Raises:
        Cancelled: by progress.
    """
    progress.step(0.0, _TEXT)
    faces = _Faces(solid)
    lines = faces.meeting(progress.part(0.0, 0.3))
    cut, first = np.unique(lines.face, return_index=True)
    ends = np.append(first[1:], len(lines.face))
    whole = np.ones(len(solid.triangles), np.bool_)
    whole[cut] = False
    rows = np.flatnonzero(whole)
    rows = rows[faces.free(rows, solid.triangles[rows].mean(axis=1))]
    parts = [solid.triangles[rows]]

    def free_parts(begin: int) -> Floats:
        some = slice(begin, begin + _PORTION)
        mine = slice(first[begin], ends[some][-1])
        return faces.free_parts(cut[some], _CrossingLines(lines.face[mine], lines.ends[mine]))

    for begin in range(0, len(cut), _TOGETHER * _PORTION):
        progress.step(0.3 + 0.7 * begin / len(cut), _TEXT)
        begins = range(begin, min(begin + _TOGETHER * _PORTION, len(cut)), _PORTION)
        parts += pool().map(free_parts, begins)
    return np.concatenate(parts)


class _Faces:
    """The faces of a solid's bodies, and what is before them."""

    def __init__(self, solid: SolidStock) -> None:
        self._triangles, self._tree = solid.triangles, solid.tree
        self._before = max(BEFORE, ROUNDED * float(np.abs(solid.triangles).max()))
        normal = np.cross(self._triangles[:, 1] - self._triangles[:, 0], self._triangles[:, 2] - self._triangles[:, 0])
        self._normal = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        self._body = _bodies(self._triangles)

    def free(self, rows: Ints, places: Floats) -> NDArray[np.bool_]:
        """Return whether there is no metal before places (m, 3) on faces (m,), by the winding number there."""
        before = places + self._before * self._normal[rows]
        point, heights, up = self._tree.met(before[:, :2])
        below = heights < before[point, 2]
        return np.asarray(np.bincount(point, np.where(below, -up, 0.0), len(before)) < 0.5)

    def meeting(self, progress: Progress) -> _CrossingLines:
        """Return the lines along which faces of other bodies come through just before each face."""
        room = 2 * self._before
        low, high = self._triangles.min(axis=1) - room, self._triangles.max(axis=1) + room
        near = _near_others(low, high, self._body)
        boxes = box(low[near, 0], low[near, 1], high[near, 0], high[near, 1])
        tree, found = STRtree(boxes), [_CrossingLines(np.zeros(0, np.int64), np.zeros((0, 2, 2)))]
        for begin in range(0, len(near), _PORTION):
            progress.step(begin / len(near), _TEXT)
            one, other = near[tree.query(boxes[begin : begin + _PORTION]) + np.array([[begin], [0]])]
            meet = (
                (self._body[one] != self._body[other])
                & (low[one, 2] <= high[other, 2])
                & (low[other, 2] <= high[one, 2])
            )
            order = np.argsort(one[meet], kind="stable")
            found.append(self._crossings(one[meet][order], other[meet][order]))
        return _CrossingLines(
            np.concatenate([each.face for each in found]), np.concatenate([each.ends for each in found])
        )

    def _axes(self, faces: Ints) -> Floats:
        """Return two unit vectors (n, 2, 3) along each face."""
        along = self._triangles[faces, 1] - self._triangles[faces, 0]
        along /= np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
        return np.stack([along, np.cross(self._normal[faces], along)], axis=1)

    def _flat(self, faces: Ints, points: Floats) -> Floats:
        """Return points (n, m, 3) in the axes of their faces (n,), (n, m, 2)."""
        away = points - self._triangles[faces, :1]
        return np.asarray(away @ self._axes(faces).transpose(0, 2, 1))

    def _crossings(self, faces: Ints, others: Ints) -> _CrossingLines:
        """Return the lines along which others (n,) come through just before faces (n,)."""
        away = self._triangles[others] - self._triangles[faces, :1]
        away = np.einsum("nkj,nj->nk", away, self._normal[faces]) - self._before
        through = (away.min(axis=1) < 0) & (away.max(axis=1) > 0) & self._normal[faces].any(axis=1)
        faces, others, away = faces[through], others[through], away[through]
        flat = self._flat(faces, self._triangles[others])
        above = away > 0
        alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)  # the corner that has a side for itself
        rows, ends = np.arange(len(faces)), []
        for step in (1, 2):
            other = (alone + step) % 3
            share = away[rows, alone] / (away[rows, alone] - away[rows, other])
            ends.append(flat[rows, alone] + share[:, None] * (flat[rows, other] - flat[rows, alone]))
        way = ends[1] - ends[0]
        way *= _BEYOND * self._before / np.maximum(np.linalg.norm(way, axis=1), 1e-300)[:, None]
        return _CrossingLines(faces, np.stack([ends[0] - way, ends[1] + way], axis=1))

    def free_parts(self, faces: Ints, lines: _CrossingLines) -> Floats:
        """Return what of faces (n,) is free (k, 3, 3), given the lines that cut them."""
        axes, corner = self._axes(faces), self._triangles[faces, 0]
        own = polygons(self._flat(faces, self._triangles[faces]))
        cutting = multilinestrings(linestrings(lines.ends), indices=np.searchsorted(faces, lines.face))
        noded = union_all(np.column_stack([get_exterior_ring(own), cutting]), grid_size=_GRID, axis=1)
        cells, face = get_parts(polygonize(noded[:, None], axis=1), return_index=True)
        inner = point_on_surface(cells)
        mine = covers(buffer(own, _GRID)[face], inner) & (area(cells) > _NARROW * self._before * length(cells))
        cells, face, inner = cells[mine], face[mine], inner[mine]
        places = corner[face] + np.einsum("mk,mkj->mj", get_coordinates(inner), axes[face])
        free = self.free(faces[face], places)
        cells, face = cells[free], face[free]
        triangles, cell = get_parts(constrained_delaunay_triangles(cells), return_index=True)
        kept = area(triangles) > _LEAST
        flat, face = get_coordinates(triangles[kept]).reshape(-1, 4, 2)[:, :3], face[cell[kept]]
        return np.asarray(corner[face, None] + flat @ axes[face])


def _bodies(triangles: Floats) -> Ints:
    """Return the number of the body of each triangle: those hang together by edges of two triangles."""
    from scipy.sparse import coo_array  # an eighth of a second, for several bodies alone
    from scipy.sparse.csgraph import connected_components

    edges = MeshEdges.of(triangles)
    order = np.argsort(edges.edge, kind="stable")
    pairs = order[edges.count[edges.edge[order]] == 2].reshape(-1, 2) // 3
    size = len(triangles)
    _, number = connected_components(coo_array((np.ones(len(pairs)), pairs.T), shape=(size, size)), directed=False)
    return np.asarray(number, np.int64)


def _near_others(low: Floats, high: Floats, body: Ints) -> Ints:
    """Return the triangles whose boxes meet the box of another body as a whole."""
    count = int(body.max(initial=0)) + 1
    least, most = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(least, body, low)
    np.maximum.at(most, body, high)
    boxes = box(least[:, 0], least[:, 1], most[:, 0], most[:, 1])
    one, other = STRtree(boxes).query(boxes)
    meet = (one != other) & np.all(least[one] <= most[other], axis=1) & np.all(least[other] <= most[one], axis=1)
    found = np.zeros(len(body), np.bool_)
    order = np.argsort(body, kind="stable")
    begin, end = (np.searchsorted(body[order], np.arange(count), side) for side in ("left", "right"))
    for a, b in zip(one[meet].tolist(), other[meet].tolist(), strict=True):
        mine = order[begin[a] : end[a]]
        found[mine[np.all((low[mine] <= most[b]) & (high[mine] >= least[b]), axis=1)]] = True
    return np.flatnonzero(found)
