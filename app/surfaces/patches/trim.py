"""Surfaces cut where trims end them, so that nothing but what is left of them is ever touched.

A patch that an outline crosses is halved until its parts are off it, and those are patches in their own right, whole to
their sides; or until they are so fine that triangles stand for them within a hair: those are cut along the outline.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from .facets import SurfaceFacets, joined, joined_parts
from .patch import Patches, joined_patches
from .tessellate import MOST_FACETS, facets_alone, halves, second_derivatives

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

AT_OUTLINES = 3e-5
"""mm; triangles along outlines are not farther from their surfaces. What chords are proven against them by allows for
it.
"""
_HAIR = 1e-9
"""mm; an outline that runs along a box may cut off so much of it by rounding."""
_LITTLE = 1e-3
"""Of a box: more is never taken for rounding."""
_UPRIGHT = 1e-9
"""Of a unit normal; a facet whose normal rises no more stands upright, and nothing is touched on it from above."""


def trimmed_patches(
    patches: Patches, areas: Mapping[int, shapely.Geometry], progress: Progress = NO_PROGRESS
) -> tuple[Patches, SurfaceFacets]:
    """Return the patches that trims leave whole, some of them divided, and facets along the outlines.

    Args:
        areas: where in XY the surface of each of them counts, by its number.

    Raises:
        GeometryError: outlines would want more than MOST_FACETS. Cancelled: the job was asked to stop.
    """
    done, cuts, count = [patches.only(np.zeros(len(patches), np.bool_))], [SurfaceFacets.none(patches)], 0
    todo, inside = patches, np.array([areas[owner] for owner in patches.owner.tolist()], np.object_)
    while len(todo):
        progress.step(0.0, "Trimming")
        inside, whole, crossed = _left(todo, inside)
        done.append(todo.only(whole))
        todo, inside = todo.only(crossed), inside[crossed]
        alone = facets_alone(todo)
        near = ~np.isin(np.arange(len(todo)), alone.patch[alone.error > AT_OUTLINES])
        alone = alone.only(near[alone.patch])
        count += len(alone)
        if count + 2 * len(todo) > MOST_FACETS:
            raise GeometryError(
                f"facets along the trims' outlines would be more than {MOST_FACETS:,}; make the outlines shorter."
            )
        own = replace(todo.only(near), whole=np.zeros(near.sum(), np.bool_))
        cuts.append(cut(replace(alone, patch=(np.cumsum(near) - 1)[alone.patch], patches=own), inside[alone.patch]))
        todo, source = _halved(todo.only(~near))
        inside = inside[~near][source]
    return joined_patches(done), joined(cuts)


def _left(patches: Patches, inside: NDArray[np.object_]) -> tuple[NDArray[np.object_], Bools, Bools]:
    """Return what areas leave of the boxes round patches, and which are whole and which are crossed by an outline."""
    places = (patches.control[..., :2] / patches.control[..., 3:]).reshape(len(patches), -1, 2)
    low, high = places.min(axis=1) - _HAIR, places.max(axis=1) + _HAIR
    boxes = shapely.box(*low.T, *high.T)
    left = shapely.intersection(inside, boxes)
    for n in np.flatnonzero(shapely.get_type_id(left) == shapely.GeometryType.GEOMETRYCOLLECTION).tolist():
        left[n] = shapely.union_all([part for part in shapely.get_parts(left[n]) if part.geom_type == "Polygon"])
    every, there = shapely.area(boxes), shapely.area(left)
    whole = every - there <= np.minimum(2 * _HAIR * shapely.length(boxes), _LITTLE * every)
    return left, whole, ~whole & (there > 0)


def _halved(patches: Patches) -> tuple[Patches, Ints]:
    """Return the halves of patches, across where they bend more, and the number of the patch that each is of."""
    uu, uv, vv = second_derivatives(patches.control).T
    places = patches.control[..., :3] / patches.control[..., 3:]
    u, v = (np.linalg.norm(np.diff(places, axis=axis), axis=-1).sum(axis=axis).max(axis=1) for axis in (1, 2))
    share = u / np.maximum(u + v, 1e-300)
    along_u = uu + 2 * share * uv >= vv + 2 * (1 - share) * uv
    parts, source = [], []
    for axis, rows in ((0, np.flatnonzero(along_u)), (1, np.flatnonzero(~along_u))):
        part = patches.only(rows)
        first, second = halves(part.control, axis)
        below, above = part.spans.copy(), part.spans.copy()
        below[:, 2 * axis + 1] = above[:, 2 * axis] = part.spans[:, 2 * axis : 2 * axis + 2].mean(axis=1)
        parts += [replace(part, control=first, spans=below), replace(part, control=second, spans=above)]
        source += [rows, rows]
    return joined_patches(parts), np.concatenate(source)


def trimmed_mesh(facets: SurfaceFacets, area: shapely.Geometry) -> SurfaceFacets:
    """Return what an area leaves of facets that are the surface themselves."""
    shapely.prepare(area)
    ends = [
        np.stack([places[:-1], places[1:]], axis=1)
        for ring in shapely.get_rings(shapely.get_parts(area))
        for places in (shapely.get_coordinates(ring),)
    ]
    sides = shapely.STRtree(shapely.linestrings(np.concatenate([np.zeros((0, 2, 2)), *ends])))
    border = np.zeros(len(facets), np.bool_)
    border[sides.query(shapely.polygons(facets.triangles[:, :, :2]), predicate="dwithin", distance=_HAIR)[0]] = True
    kept = facets.only(~border & shapely.intersects_xy(area, *facets.triangles[:, 0, :2].T))
    crossed = facets.only(border)
    return joined_parts([kept, cut(crossed, np.full(len(crossed), area, np.object_))], facets.patches)


def cut(facets: SurfaceFacets, inside: NDArray[np.object_]) -> SurfaceFacets:
    """Return what areas (n,) in XY leave of n facets, in triangles within their own planes; patches are not asked."""
    a, b, c = facets.triangles.swapaxes(0, 1)
    normal = np.cross(b - a, c - a)
    upright = np.abs(normal[:, 2]) <= _UPRIGHT * np.linalg.norm(normal, axis=1)
    flat = np.flatnonzero(~upright)
    source, shares = _cut_flat(facets.triangles[flat, :, :2], inside[flat])
    sources, found = [flat[source]], [shares]
    for n in np.flatnonzero(upright).tolist():
        shares = _cut_upright(facets.triangles[n], inside[n])
        sources.append(np.full(len(shares), n))
        found.append(shares)
    source, shares = np.concatenate(sources), np.concatenate(found)
    error = facets.error[source]
    return replace(
        facets.only(source),
        triangles=np.einsum("nkc,ncd->nkd", shares, facets.triangles[source]),
        corners=np.einsum("nkc,ncd->nkd", shares, facets.corners[source]),
        bulge=np.repeat(error[:, None], 2, axis=1),
    )


def _cut_flat(triangles: Floats, inside: NDArray[np.object_]) -> tuple[Ints, Floats]:
    """Return what areas (n,) leave of triangles (n, 3, 2) in triangles: of which each is, and shares (k, 3, 3) of its
    corners.
    """
    parts, source = shapely.get_parts(shapely.intersection(inside, shapely.polygons(triangles)), return_index=True)
    polygons = (shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & (shapely.area(parts) > 0)
    parts, source = parts[polygons], source[polygons]
    pieces, which = shapely.get_parts(shapely.constrained_delaunay_triangles(parts), return_index=True)
    source = source[which]
    at = shapely.get_coordinates(pieces).reshape(-1, 4, 2)[:, :3]
    return source, _shares(triangles[source], at)


def _cut_upright(triangle: Floats, inside: shapely.Geometry) -> Floats:
    """Return what an area leaves of an upright triangle (3, 3), as shares (k, 3, 3) of its corners."""
    flat = triangle[:, :2]
    sides = flat - flat[[1, 2, 0]]
    way = sides[np.argmax(np.linalg.norm(sides, axis=1))]
    length = np.linalg.norm(way)
    if length == 0:
        return np.eye(3)[None] if shapely.intersects_xy(inside, *flat[0]) else np.zeros((0, 3, 3))
    along = (flat - flat[0]) @ way / length
    seen = np.column_stack([along, triangle[:, 2]])
    ends = flat[0] + np.outer([along.min(), along.max()], way / length)
    # walls on the outline are kept
    near = shapely.intersection(shapely.buffer(inside, _HAIR), shapely.LineString(ends))
    spans = [
        (shapely.get_coordinates(part) - flat[0]) @ way / length for part in shapely.get_parts(near) if part.length > 0
    ]
    bars = [shapely.box(span.min(), seen[:, 1].min() - 1, span.max(), seen[:, 1].max() + 1) for span in spans]
    return _cut_flat(seen[None], np.array([shapely.union_all(bars)], np.object_))[1]


def _shares(triangles: Floats, at: Floats) -> Floats:
    """Return places (n, k, 2) of triangles (n, 3, 2) as shares (n, k, 3) of their corners."""
    a, b, c = (triangles[:, k, None] for k in range(3))
    first, second, place = b - a, c - a, at - a
    twice = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    one = (place[..., 0] * second[..., 1] - place[..., 1] * second[..., 0]) / twice
    other = (first[..., 0] * place[..., 1] - first[..., 1] * place[..., 0]) / twice
    return np.clip(np.stack([1 - one - other, one, other], axis=-1), 0.0, 1.0)
