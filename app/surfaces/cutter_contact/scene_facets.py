"""Built surfaces as facets: those of all of them in one tree, trimmed ones cut at their regions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...geometry.primitives import contour_rows, sample
from ...model.part import Region
from ...model.scene import KeptSide
from ..patches.build import BuiltSurface, BuiltTrim
from ..patches.facets import NONE, SurfaceFacets, joined, joined_parts
from ..patches.patch import patches_of
from ..patches.tessellate import tessellate
from ..patches.trim import trimmed_mesh, trimmed_patches

Floats = NDArray[np.float64]

_SHARE = 3e-4
"""Of the surfaces' extent: how far facets may be off them, at most."""
_COARSEST, _FINEST = 0.06, 1e-5
"""mm; limits of that, for scenes of any extent."""
_CHORD = 1e-6
"""mm by which chords may be off a region's arcs."""
_FAR = 1e7
"""mm; a box so wide stands for all of the plane."""


@dataclass(frozen=True, eq=False)
class SceneFacets:
    """All surfaces of a scene.

    Attributes:
        facets: of all that are machined, trimmed; owners count the scene's surfaces.
        uncut: the same as if nothing were trimmed: sections are cut where they leave a surface's area, exactly.
        areas: where in XY a trimmed surface counts, by its number.
    """

    facets: SurfaceFacets
    uncut: SurfaceFacets
    areas: Mapping[int, shapely.Geometry]


def scene_facets(
    built: Sequence[BuiltSurface], tolerance: float | None = None, progress: Progress = NO_PROGRESS
) -> SceneFacets:
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
            parts.append(SurfaceFacets.of_mesh(each.triangles, number))
    uncut = joined(parts)
    areas = {number: area_of(each.trims) for number, each in enumerate(built) if each.surface.enabled and each.trims}
    facets = _trimmed(uncut, areas, near, progress) if areas else uncut
    for number in areas:
        if not (facets.owner == number).any():
            raise GeometryError(
                f"Surface {built[number].surface.name}: its trims leave nothing of it; check their outlines."
            )
    return SceneFacets(facets, uncut, areas)


def _trimmed(
    facets: SurfaceFacets, areas: Mapping[int, shapely.Geometry], near: float, progress: Progress
) -> SurfaceFacets:
    """Return facets, those of some surfaces as areas leave them."""
    smooth = np.isin(facets.patches.owner, list(areas))
    parts = [facets.only(~np.isin(facets.owner, list(areas)))]
    for number, area in areas.items():
        mine = facets.only((facets.owner == number) & (facets.patch == NONE))
        parts.append(trimmed_mesh(mine, area))
    parts = [joined_parts(parts, facets.patches)]
    if smooth.any():
        whole, cut = trimmed_patches(facets.patches.only(smooth), areas, progress)
        parts += [tessellate(whole, near, progress), cut] if len(whole) else [cut]
    return joined(parts)


def _near(control: Floats, built: Sequence[BuiltSurface]) -> float:
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
        area = shapely.intersection(area, inside) if trim.keep is KeptSide.INSIDE else shapely.difference(area, inside)
    return area


def region_area(regions: Sequence[Region]) -> shapely.Geometry:
    """Return regions as polygons whose chords are within a thousandth of a micron of their arcs."""
    rings = [[sample(contour_rows(contour), _CHORD) for contour in region.contours] for region in regions]
    return shapely.union_all([shapely.make_valid(shapely.Polygon(outer, holes)) for outer, *holes in rings])
