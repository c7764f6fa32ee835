"""All points within a distance of shapes, by GEOS, whose own shortcuts are kept from showing."""

from __future__ import annotations

import math
from typing import cast

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

Flags = NDArray[np.bool_]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_GUARD = 0.02
"""Of the distance: GEOS drops corners that lie within a hundredth of it from the chord of their neighbours."""

_NEARER = 0.0012
"""Of the distance: so much nearer GEOS ends parallels that close together."""

_LOOKED = 4
"""Vertices of an outline that are looked at."""

_GRID = 1e-9
"""mm; overlays on a grid find an answer also where outlines run along one another."""

_AREAS = (shapely.GeometryType.POLYGON, shapely.GeometryType.MULTIPOLYGON)
_LINES = (shapely.GeometryType.LINESTRING, shapely.GeometryType.MULTILINESTRING)


def buffered(shapes: Shape | NDArray[np.object_], distance: float, quad_segs: int) -> Shape | NDArray[np.object_]:
    """Return for each shape all points within a distance of it; a negative one gives the points that deep inside.

    Two faults of GEOS are kept from showing. Before it begins it leaves out hollow corners that stand back by less than
    a hundredth of the distance: where a long edge meets one that is shorter than that, the long edge turns a little,
    and its parallel is off by up to 0.006 of the distance far from the corner. A vertex on the long edge beside the
    corner keeps the turn where the parallels of the neighbours cover it; what is left is below 0.0005 of the distance.
    And where an outline turns in less room than the distance, parallels may leave holes that are none: an outline of
    the result that lies too near is covered by what its nearest edges reach. Too near GEOS may come by 0.001 of the
    distance, where it ends parallels that close together.

    Args:
        shapes: areas or lines, one or (n,), mm.
        distance: mm.
        quad_segs: chords of a quarter circle.
    """
    flat = np.atleast_1d(np.asarray(shapes, dtype=object)).ravel()
    found = np.asarray(shapely.buffer(_guarded(flat, abs(distance)), distance, quad_segs=quad_segs), dtype=object)
    if distance:
        _cover_false_holes(found, flat, distance, quad_segs)
    return cast(Shape, found[0]) if isinstance(shapes, Shape) else found.reshape(np.shape(shapes))


def _cover_false_holes(
    found: NDArray[np.object_], shapes: NDArray[np.object_], distance: float, quad_segs: int
) -> None:
    """Mend in place those of the found shapes (n,) that have outlines nearer to the given shapes than the distance.

    Of each outline a few vertices are looked at: all of a false one's lie on parallels that others have passed.
    """
    d = abs(distance)
    nearest = d * (1 - _NEARER) - 2 * d * (1 - math.cos(math.pi / 4 / quad_segs))
    # shapes of one's own: to prepare what other threads look at as well is no good
    lines = np.asarray(shapely.boundary(shapes) if distance < 0 else shapely.reverse(shapes), dtype=object)
    parts, owner = shapely.get_parts(found, return_index=True)
    rings, part = shapely.get_rings(parts, return_index=True)
    if len(rings) == 0:
        return
    owner = owner[part]
    shapely.prepare(lines)
    count = shapely.get_num_coordinates(rings) - 1
    looked = [shapely.get_point(rings, (count * k // _LOOKED).astype(np.int64)) for k in range(_LOOKED)]
    false = np.any([shapely.distance(lines[owner], points) < nearest for points in looked], axis=0)
    for k in np.unique(owner[false]).tolist():
        sound = bool(shapely.is_valid(found[k]))
        edges = _edges(lines[k])
        if sound:
            bad = shapely.polygons(rings[false & (owner == k)])
            edges = edges[shapely.dwithin(edges[:, None], bad[None, :], d).any(axis=1)]
        covered = shapely.union_all(shapely.buffer(edges, d, quad_segs=quad_segs), grid_size=_GRID)
        mended = shapely.difference if distance < 0 else shapely.union
        found[k] = mended(found[k] if sound else shapes[k], covered, grid_size=_GRID)


def _edges(shape: Shape) -> NDArray[np.object_]:
    """Return the edges of a line or area as lines of their own."""
    parts = shapely.get_parts(shape)
    lines = [*shapely.get_rings(parts), *parts[shapely.get_type_id(parts) == shapely.GeometryType.LINESTRING]]
    points = [shapely.get_coordinates(line) for line in lines]
    return np.concatenate([shapely.linestrings(np.stack([each[:-1], each[1:]], axis=1)) for each in points])


def _guarded(shapes: NDArray[np.object_], distance: float) -> NDArray[np.object_]:
    """Return the same shapes with a vertex more on long edges beside short ones."""
    kinds = shapely.get_type_id(shapes)
    if not (np.isin(kinds, _AREAS).all() or np.isin(kinds, _LINES).all()):
        return shapes
    parts, owner = shapely.get_parts(shapes, return_index=True)
    full = np.bincount(owner, minlength=len(shapes)) > 0
    full[owner[shapely.is_empty(parts)]] = False  # shapely breaks down when it makes parts that are empty
    if not full.all():
        guarded = shapes.copy()
        if full.any():
            guarded[full] = _guarded(shapes[full], distance)
        return guarded
    kind, points, offsets = shapely.to_ragged_array(shapes, include_z=False)
    first, second = _beside_short(points, offsets[0], _GUARD * distance)
    if not (first.any() or second.any()):
        return shapes
    step = np.diff(points, axis=0, append=points[-1:])
    unit = step / np.maximum(np.hypot(*step.T), 1e-300)[:, None] * _GUARD * distance
    ends = np.roll(points, -1, axis=0)
    counts = 1 + first.astype(np.int64) + second
    places = np.cumsum(counts) - counts
    more = np.empty((int(counts.sum()), 2))
    more[places] = points
    more[places[first] + 1] = points[first] + unit[first]
    more[places[second] + counts[second] - 1] = ends[second] - unit[second]
    ahead = np.concatenate([[0], np.cumsum(counts)])
    return np.asarray(shapely.from_ragged_array(kind, more, (ahead[offsets[0]], *offsets[1:])), dtype=object)


def _beside_short(points: Floats, begins: Ints, short: float) -> tuple[Flags, Flags]:
    """Return for the edge from each point (n, 2) whether it is long and the edge before, or after, is short."""
    length = np.full(len(points), np.inf)
    length[:-1] = np.hypot(*np.diff(points, axis=0).T)
    begins = begins.astype(np.int64)
    some = begins[1:] > begins[:-1]
    heads, lasts = begins[:-1][some], begins[1:][some] - 1
    length[lasts] = np.inf  # no edge goes on from there
    before, after = np.roll(length, 1), np.roll(length, -1)
    before[heads] = np.inf
    closed = (points[heads] == points[lasts]).all(axis=1) & (lasts > heads)
    before[heads[closed]] = length[lasts[closed] - 1]
    after[lasts[closed] - 1] = length[heads[closed]]
    long = (length > 3 * short) & np.isfinite(length)
    return long & (before < short), long & (after < short)
