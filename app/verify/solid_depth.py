"""How deep places lie in a solid: the exact distance to its nearest triangle, over whole columns of metal that was cut
away.
"""

from __future__ import annotations

from dataclasses import dataclass
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
from ..simulation.field.triangle_tree import TriangleTree
from ..surfaces.meshes.edges import MeshEdges
from ..surfaces.meshes.sew import ROUNDED

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
