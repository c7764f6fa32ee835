"""How often planes of passes cross facets: the work that passes make, counted before it is done."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..patches.facets import SurfaceFacets
from ..sections.compound import CuttingPlanes


@dataclass(frozen=True, slots=True)
class FacetCrossings:
    """A family of passes, counted.

    Attributes:
        planes: how many. crossings: facets that they cross, each as often as it is, about.
    """

    planes: int
    crossings: float


def facet_crossings(facets: SurfaceFacets, planes: CuttingPlanes) -> FacetCrossings:
    """Return how often planes cross facets, as if they lay evenly over all of them."""
    count = len(planes.offsets)
    if not count or not len(facets.triangles):
        return FacetCrossings(count, 0.0)
    c, s = planes.along
    across = facets.triangles[:, :, 1] * c - facets.triangles[:, :, 0] * s
    wide = across.max(axis=1) - across.min(axis=1)
    span = float(across.max() - across.min())
    return FacetCrossings(count, float(np.sum(wide)) / span * count if span > 0 else 0.0)
