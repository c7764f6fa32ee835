"""The surface of bodies taken together: of faces that lie partly within, or on, another body, what is free.

Bodies of one file may go through one another, or touch in part of a side. What of their faces has metal on both sides
is no surface, and nothing is near to it.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from shapely import (
    Polygon,
    STRtree,
    area,
    box,
    constrained_delaunay_triangles,
    get_coordinates,
    get_parts,
    length,
    linestrings,
    point_on_surface,
    polygonize,
    union_all,
)

from ..model.motion import Floats
from ..simulation.field.solid import SolidStock
from ..simulation.field.solid_rays import SolidRays
from ..surfaces.meshes.edges import MeshEdges
from ..surfaces.meshes.sew import ROUNDED

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


def outer_faces(solid: SolidStock) -> Floats:
    """Return the triangles (k, 3, 3) that bound the metal of all bodies of a solid together, mm.

    A face is cut where other bodies' faces come through just before it. Each part has metal before it, or none, all
    over, and goes or stays.

    Args:
        solid: of closed bodies, right side out.
    """
    faces = _Faces(solid)
    lines = {face: found for face, others in faces.meeting() if len(found := faces.crossings(face, others))}
    whole = np.ones(len(solid.triangles), np.bool_)
    whole[list(lines)] = False
    rows = np.flatnonzero(whole)
    rows = rows[faces.free(rows, solid.triangles[rows].mean(axis=1))]
    return np.concatenate([solid.triangles[rows], *(faces.free_parts(face, found) for face, found in lines.items())])


class _Faces:
    """The faces of a solid's bodies, and what is before them."""

    def __init__(self, solid: SolidStock) -> None:
        self._triangles, self._rays = solid.triangles, SolidRays(solid)
        self._before = max(BEFORE, ROUNDED * float(np.abs(solid.triangles).max()))
        normal = np.cross(self._triangles[:, 1] - self._triangles[:, 0], self._triangles[:, 2] - self._triangles[:, 0])
        self._normal = normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
        self._body = _bodies(self._triangles)

    def free(self, rows: Ints | int, places: Floats) -> NDArray[np.bool_]:
        """Return whether there is no metal before places (m, 3) on faces, by the winding number there."""
        before = places + self._before * self._normal[rows]
        point, heights, up = self._rays.met(before[:, :2])
        below = heights < before[point, 2]
        return np.asarray(np.bincount(point, np.where(below, -up, 0.0), len(before)) < 0.5)

    def meeting(self) -> Iterator[tuple[int, Ints]]:
        """Yield the triangles whose boxes meet those of triangles of other bodies, and these."""
        room = 2 * self._before
        low, high = self._triangles.min(axis=1) - room, self._triangles.max(axis=1) + room
        near = _near_others(low, high, self._body)
        boxes = box(low[near, 0], low[near, 1], high[near, 0], high[near, 1])
        one, other = near[STRtree(boxes).query(boxes)]
        meet = (
            (self._body[one] != self._body[other]) & (low[one, 2] <= high[other, 2]) & (low[other, 2] <= high[one, 2])
        )
        one, other = one[meet], other[meet]
        order = np.argsort(one, kind="stable")
        faces, first = np.unique(one[order], return_index=True)
        yield from zip(faces.tolist(), np.split(other[order], first[1:]), strict=False)

    def _axes(self, face: int) -> Floats:
        """Return two unit vectors (2, 3) along a face."""
        along = self._triangles[face, 1] - self._triangles[face, 0]
        along /= np.linalg.norm(along)
        return np.stack([along, np.cross(self._normal[face], along)])

    def crossings(self, face: int, others: Ints) -> Floats:
        """Return the lines (m, 2, 2), in the axes of a face, along which others come through just before it."""
        corner, normal = self._triangles[face, 0], self._normal[face]
        away = (self._triangles[others] - corner) @ normal - self._before
        through = np.flatnonzero((away.min(axis=1) < 0) & (away.max(axis=1) > 0))
        if not len(through) or not np.any(normal):
            return np.zeros((0, 2, 2))
        flat, away = (self._triangles[others[through]] - corner) @ self._axes(face).T, away[through]
        above = away > 0
        alone = np.argmax(above == (above.sum(axis=1) == 1)[:, None], axis=1)  # the corner that has a side for itself
        rows, ends = np.arange(len(through)), []
        for step in (1, 2):
            other = (alone + step) % 3
            share = away[rows, alone] / (away[rows, alone] - away[rows, other])
            ends.append(flat[rows, alone] + share[:, None] * (flat[rows, other] - flat[rows, alone]))
        way = ends[1] - ends[0]
        way *= _BEYOND * self._before / np.maximum(np.linalg.norm(way, axis=1), 1e-300)[:, None]
        return np.stack([ends[0] - way, ends[1] + way], axis=1)

    def free_parts(self, face: int, lines: Floats) -> Floats:
        """Return what of a face is free (k, 3, 3), given the lines that cut it."""
        axes, corner = self._axes(face), self._triangles[face, 0]
        own = Polygon((self._triangles[face] - corner) @ axes.T)
        cells = get_parts(polygonize(get_parts(union_all([own.exterior, *linestrings(lines)], grid_size=_GRID))))
        inner = point_on_surface(cells)
        mine = own.buffer(_GRID).covers(inner) & (area(cells) > _NARROW * self._before * length(cells))
        free = self.free(face, corner + get_coordinates(inner) @ axes)
        pieces = get_parts(get_parts(constrained_delaunay_triangles(cells[mine & free])))
        pieces = pieces[area(pieces) > _LEAST]
        return np.asarray(corner + get_coordinates(pieces).reshape(-1, 4, 2)[:, :3] @ axes)


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
