"""What kind a boundary point is: do surfaces cross there, touch, or does one end."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..patches.facets import SurfaceFacets
from .compound import BoundaryKind

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SIDE = 1e-7
"""Parameters so near to 0 or 1 are on a surface's side."""
_PARALLEL = 1e-6
"""Sine of the angle between surfaces that touch rather than cross."""


def kinds_of(facets: SurfaceFacets, facet: tuple[Ints, Ints], parameters: tuple[Floats, Floats]) -> NDArray[np.uint8]:
    """Return the kind (m,) of places where two facets (m,) each are touched, at parameters (m, 2) of their surfaces."""
    edge = _on_side(facets, facet[0], parameters[0]) | _on_side(facets, facet[1], parameters[1])
    across = np.linalg.norm(np.cross(_normals(facets, facet[0]), _normals(facets, facet[1])), axis=1)
    kind = np.where(across <= _PARALLEL, BoundaryKind.TANGENT, BoundaryKind.CROSSING)
    return np.asarray(np.where(edge, BoundaryKind.EDGE, kind), np.uint8)


def _on_side(facets: SurfaceFacets, facet: Ints, parameters: Floats) -> NDArray[np.bool_]:
    """Return which places are on a side of their surface where it ends: neither a seam nor a pole."""
    ends = _ends(facets)
    owner = facets.owner[facet]
    near = np.column_stack(
        [
            parameters[:, 0] <= _SIDE,
            parameters[:, 0] >= 1 - _SIDE,
            parameters[:, 1] <= _SIDE,
            parameters[:, 1] >= 1 - _SIDE,
        ]
    )
    return np.asarray((near & ends[owner]).any(axis=1))


def _ends(facets: SurfaceFacets) -> NDArray[np.bool_]:
    """Return at which sides (u = 0, u = 1, v = 0, v = 1) each surface (n, 4) ends."""
    count = int(facets.owner.max()) + 1
    found = np.ones((count, 4), np.bool_)
    patches = facets.patches
    for owner in np.unique(patches.owner).tolist():
        rows = np.flatnonzero(patches.owner == owner)
        for axis in (0, 1):
            low, high = rows[patches.spans[rows, 2 * axis] == 0], rows[patches.spans[rows, 2 * axis + 1] == 1]
            first = [patches.control[row].take(0, axis=axis) for row in low]
            last = [patches.control[row].take(-1, axis=axis) for row in high]
            seam = len(first) == len(last) and all(_alike(a, b) for a, b in zip(first, last, strict=True))
            for side, nets in ((2 * axis, first), (2 * axis + 1, last)):
                places = np.concatenate([net[:, :3] / net[:, 3:] for net in nets])
                pole = np.ptp(places, axis=0).max() <= 1e-9 * (1 + np.abs(places).max())
                found[owner, side] = not (seam or pole)
    return found


def _alike(a: Floats, b: Floats) -> bool:
    return bool(np.abs(a - b).max() <= 1e-9 * (1 + np.abs(a).max()))


def _normals(facets: SurfaceFacets, facet: Ints) -> Floats:
    t = facets.triangles[facet]
    normal = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300))
