"""Built surfaces as facets: those of all of them in one tree, trimmed ones cut at their regions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from app.errors import GeometryError
from app.geometry.primitives import contour_rows, sample
from app.model.part import Region
from app.model.scene import Side
from app.progress import NO_PROGRESS, Progress
from app.surface.build import Built, BuiltTrim
from app.surface.facets import NONE, Facets, joined
from app.surface.patch import patches_of
from app.surface.tessellate import tessellate

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SHARE = 3e-4
"""Of the surfaces' extent: how far facets may be off them, at most."""
_COARSEST, _FINEST = 0.06, 1e-5
_CHORD = 1e-6
"""mm by which chords may be off a region's arcs."""
_FAR = 1e7


@dataclass(frozen=True, eq=False)
class SceneFacets:
    """All surfaces of a scene.

    Attributes:
        facets: of all that are machined; owners count the scene's surfaces.
        areas: where in XY a trimmed surface counts, by its number.
    """

    facets: Facets
    areas: Mapping[int, shapely.Geometry]


def scene_facets(built: Sequence[Built], tolerance: float | None = None, progress: Progress = NO_PROGRESS) -> SceneFacets:
    """Return the facets of surfaces.

    Args:
        built: in the order of the scene; those that are not machined are left out.
        tolerance: how far facets may be off, mm; None: as the surfaces' extent asks for.

    Raises:
        GeometryError: no surface is machined, or nothing is left of one.
        Cancelled: the job was asked to stop.
    """
    if not any(each.surface.enabled for each in built):
        raise GeometryError("no surface is machined; add a surface, or switch one on.")
    patches = patches_of([each.splines if each.surface.enabled else () for each in built])
    near = tolerance if tolerance is not None else _near(patches.control, built)
    parts = [tessellate(patches, near, progress)] if len(patches) else []
    for number, each in enumerate(built):
        if each.surface.enabled and each.triangles is not None:
            parts.append(Facets.of_mesh(each.triangles, number))
    facets = joined(parts)
    areas = {number: area_of(each.trims) for number, each in enumerate(built) if each.surface.enabled and each.trims}
    for number, area in areas.items():
        facets = _trimmed(facets, number, area, built[number].surface.name)
    return SceneFacets(facets, areas)


def _near(control: Floats, built: Sequence[Built]) -> float:
    """Return how far facets may be off: a part of the surfaces' extent."""
    places = [(control[..., :3] / control[..., 3:]).reshape(-1, 3)]
    places += [each.triangles.reshape(-1, 3) for each in built if each.triangles is not None]
    every = np.concatenate(places)
    return float(np.clip(_SHARE * np.ptp(every, axis=0).max(), _FINEST, _COARSEST))


def area_of(trims: Sequence[BuiltTrim]) -> shapely.Geometry:
    """Return where in XY trims leave a surface."""
    area: shapely.Geometry = shapely.box(-_FAR, -_FAR, _FAR, _FAR)
    for trim in trims:
        inside = region_area(trim.regions)
        area = shapely.intersection(area, inside) if trim.keep is Side.INSIDE else shapely.difference(area, inside)
    return area


def region_area(regions: Sequence[Region]) -> shapely.Geometry:
    """Return regions as polygons whose chords are within a thousandth of a micron of their arcs."""
    rings = [[sample(contour_rows(contour), _CHORD) for contour in region.contours] for region in regions]
    return shapely.union_all([shapely.make_valid(shapely.Polygon(outer, holes)) for outer, *holes in rings])


def _trimmed(facets: Facets, number: int, area: shapely.Geometry, name: str) -> Facets:
    """Return facets, those of one surface cut where it ends; each a little beyond, by as much as it may be off."""
    shapely.prepare(area)
    mine = np.flatnonzero(facets.owner == number)
    flat = shapely.polygons(facets.triangles[mine, :, :2])
    border = np.zeros(len(mine), np.bool_)
    border[_near_outline(area, flat, np.maximum(facets.error[mine], 1e-12))] = True
    whole = ~border & shapely.intersects_xy(area, *facets.triangles[mine, 0, :2].T)
    pieces = [_clipped(facets, int(n), area) for n in mine[border].tolist()]
    kept = np.concatenate([np.flatnonzero(facets.owner != number), mine[whole]])
    cut = [piece for piece in pieces if piece is not None]
    if not whole.any() and not cut:
        raise GeometryError(f"Surface {name}: its trims leave nothing of it; check their outlines.")
    rest = facets.only(kept)
    if not cut:
        return rest
    source = np.concatenate([np.full(len(shares), n) for n, shares in cut])
    shares = np.concatenate([shares for _, shares in cut])
    corners = np.einsum("nkc,ncd->nkd", shares, facets.corners[source])
    triangles = np.einsum("nkc,ncd->nkd", shares, facets.triangles[source])
    smooth = np.flatnonzero(facets.patch[source] != NONE)
    if len(smooth):
        at = corners[smooth].reshape(-1, 2)
        places = facets.patches.points(np.repeat(facets.patch[source[smooth]], 3), at[:, 0], at[:, 1])
        triangles[smooth] = places.reshape(-1, 3, 3)
    return Facets(np.concatenate([rest.triangles, triangles]), np.concatenate([rest.owner, np.full(len(source), number)]),
                  np.concatenate([rest.patch, facets.patch[source]]), np.concatenate([rest.corners, corners]),
                  np.concatenate([rest.error, facets.error[source]]),
                  np.concatenate([rest.bulge, np.repeat(facets.error[source, None], 2, axis=1)]), facets.patches)  # fmt: skip


def _near_outline(area: shapely.Geometry, flat: NDArray[np.object_], far: Floats) -> Ints:
    """Return which polygons (n,) are nearer than `far` (n,) to the outline of an area."""
    ends = [np.stack([places[:-1], places[1:]], axis=1) for ring in shapely.get_rings(shapely.get_parts(area))
            for places in (shapely.get_coordinates(ring),)]  # fmt: skip
    sides = shapely.STRtree(shapely.linestrings(np.concatenate(ends)))
    return np.unique(sides.query(flat, predicate="dwithin", distance=far)[0])


def _clipped(facets: Facets, n: int, area: shapely.Geometry) -> tuple[int, Floats] | None:
    """Return a facet's number and shares (k, 3, 3) of its corners at the corners of what an area leaves of it; None: nothing."""
    a, b, c = facets.triangles[n, :, :2]
    twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if abs(twice) <= 1e-12:  # upright: it is kept whole where its middle is kept
        return (n, np.eye(3)[None]) if shapely.intersects_xy(area, *facets.triangles[n, :, :2].mean(axis=0)) else None
    near = shapely.intersection(area, shapely.buffer(shapely.Polygon([a, b, c]), 4 * facets.error[n] + 1e-9))
    grown = shapely.buffer(near, facets.error[n]) if facets.error[n] else near
    left = shapely.intersection(grown, shapely.Polygon([a, b, c]))
    polygons = [part for part in shapely.get_parts(left) if part.geom_type == "Polygon" and part.area > 0]
    triangles = [part for polygon in polygons for part in shapely.get_parts(shapely.constrained_delaunay_triangles(polygon))]
    if not triangles:
        return None
    at = shapely.get_coordinates(triangles).reshape(-1, 4, 2)[:, :3]
    second = ((at[..., 0] - a[0]) * (c[1] - a[1]) - (at[..., 1] - a[1]) * (c[0] - a[0])) / twice
    third = ((b[0] - a[0]) * (at[..., 1] - a[1]) - (b[1] - a[1]) * (at[..., 0] - a[0])) / twice
    return n, np.clip(np.stack([1 - second - third, second, third], axis=-1), 0.0, 1.0)
