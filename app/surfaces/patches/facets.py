"""Triangles that stand for surfaces, each with the part of the surface that it stands for and how far that may be from
it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import GeometryError
from .patch import Patches, joined_patches, patches_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LEAF = 4
"""Facets of a leaf."""
NONE = -1
"""Patch of a facet that is the surface itself, as those of meshes are."""
_PART = 1 << 16
"""Facets that are looked at together: what is needed meanwhile stays near the processor, and small."""
_BITS = 16
"""Of a coordinate in the number that facets are sorted by, so that those beside one another lie together."""
_STEEP = 4.0
"""mm up per mm sideways; an upright facet rises by any length and counts as of so much."""


@dataclass(frozen=True, eq=False)
class SurfaceFacets:
    """n facets of surfaces.

    Attributes:
        triangles: (n, 3, 3) corners on the surface, mm.
        owner: (n,) number of the surface that each is of.
        patch: (n,) number of the patch that it stands for a part of, NONE where it is the surface itself.
        corners: (n, 3, 2) parameters of its corners in that patch, each from 0 to 1.
        error: (n,) no place of that part is farther than this from the triangle's place of the same parameters, mm.
        bulge: (n, 2) nor farther than this below and above the triangle, square to it, on the side that its corners are
            told to, mm; >= 0.
        patches: of all surfaces.
    """

    triangles: Floats
    owner: Ints
    patch: Ints
    corners: Floats
    error: Floats
    bulge: Floats
    patches: Patches

    def __post_init__(self) -> None:
        if not np.isfinite(self.triangles).all():
            raise GeometryError("a surface has corners that are not finite.")

    def __len__(self) -> int:
        return len(self.owner)

    @staticmethod
    def of_mesh(triangles: Floats, owner: int = 0) -> SurfaceFacets:
        """Return the facets of triangles (n, 3, 3) that are the surface themselves."""
        count = len(triangles)
        if not count:
            raise GeometryError("surfaces of no triangles; at least one was expected.")
        return SurfaceFacets(
            np.ascontiguousarray(triangles, np.float64),
            np.full(count, owner, np.int64),
            np.full(count, NONE, np.int64),
            np.zeros((count, 3, 2)),
            np.zeros(count),
            np.zeros((count, 2)),
            patches_of(()),
        )

    @staticmethod
    def none(patches: Patches) -> SurfaceFacets:
        """Return no facets, of patches of the same degrees."""
        return SurfaceFacets(
            np.zeros((0, 3, 3)),
            np.zeros(0, np.int64),
            np.zeros(0, np.int64),
            np.zeros((0, 3, 2)),
            np.zeros(0),
            np.zeros((0, 2)),
            patches.only(np.zeros(len(patches), np.bool_)),
        )

    def only(self, rows: Ints | NDArray[np.bool_]) -> SurfaceFacets:
        """Return some of them."""
        return replace(
            self,
            triangles=self.triangles[rows],
            owner=self.owner[rows],
            patch=self.patch[rows],
            corners=self.corners[rows],
            error=self.error[rows],
            bulge=self.bulge[rows],
        )

    @cached_property
    def tree(self) -> FacetTree:
        """The facets in a tree."""
        return _tree(self)


def surface_parameters(facets: SurfaceFacets, facet: Ints, at: Floats) -> Floats:
    """Return a surface's parameters (m, 2), from 0 to 1, of places of facets (m,) at their patches' parameters; NaN on
    meshes.

    Places that are not known, NaN, are taken as the middle of their facet.
    """
    patch = facets.patch[facet]
    if not len(facets.patches):
        return np.full((len(facet), 2), np.nan)
    inner = np.where(np.isnan(at), facets.corners[facet].mean(axis=1), at)
    return np.where((patch >= 0)[:, None], facets.patches.of_surface(np.maximum(patch, 0), inner), np.nan)


def joined(parts: Sequence[SurfaceFacets]) -> SurfaceFacets:
    """Return facets of one or more sets of patches as those of one set.

    Raises:
        GeometryError: patches of different degrees.
    """
    patches = [part.patches for part in parts if len(part.patches)]
    if len({each.degrees for each in patches}) > 1:
        raise GeometryError("patches of different degrees do not go together; make them by one call of `patches_of`.")
    before = np.cumsum([0, *(len(part.patches) for part in parts)])
    numbers = [
        np.where(part.patch >= 0, part.patch + first, NONE) for part, first in zip(parts, before.tolist(), strict=False)
    ]
    numbered = [replace(part, patch=number) for part, number in zip(parts, numbers, strict=True)]
    return joined_parts(numbered, joined_patches(patches) if patches else patches_of(()))


def joined_parts(parts: Sequence[SurfaceFacets], patches: Patches) -> SurfaceFacets:
    """Return facets of the same patches as one."""

    def every(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(part, name) for part in parts])

    if len(parts) == 1:
        return replace(parts[0], patches=patches)
    return SurfaceFacets(
        every("triangles"), every("owner"), every("patch"), every("corners"), every("error"), every("bulge"), patches
    )


@dataclass(frozen=True, eq=False)
class FacetTree:
    """A balanced binary tree over facets that lie near one another.

    Attributes:
        boxes: (2^k - 1, 8) of what each node's facets stand for: x0, y0, x1, y1, top, and a plane that nothing of it is
            above: its slopes along X and Y and its height at the origin. The root first; children of i are 2 i + 1 and
            2 i + 2.
        triangles: (n, 9) in the order of the leaves. corners: (n, 6), patch, error, owner: (n,), bulge: (n, 2)
            likewise; patch is NONE where that is not whole: such facets stand for themselves, and for all that is
            within their error.
        order: (n,) their numbers.
        control: (patches, p + 1, q + 1, 4).
    """

    boxes: Floats
    triangles: Floats
    corners: Floats
    patch: Ints
    error: Floats
    bulge: Floats
    owner: Ints
    order: Ints
    control: Floats

    @property
    def held(self) -> tuple[Floats | Ints | int, ...]:
        """What kernels take, see `cutter_contact.facet_tree_kernels`."""
        return (
            self.boxes,
            self.triangles,
            self.corners,
            self.patch,
            self.error,
            self.owner,
            self.control,
            LEAF,
            self.bulge,
        )


def _tree(facets: SurfaceFacets) -> FacetTree:
    error = facets.error
    low, high = _lowest(facets.triangles) - error[:, None], _highest(facets.triangles) + error[:, None]
    order = np.argsort(_interleaved((low + high) / 2), kind="stable")
    leaves = _padded(len(order)) // LEAF
    boxes = np.full((leaves * LEAF, 5), np.inf)
    boxes[:, 2:] = -np.inf
    boxes[: len(order)] = np.column_stack([low[:, :2], high])[order]
    levels = [_merged(boxes.reshape(leaves, LEAF, 5))]
    while len(levels[-1]) > 1:
        levels.append(_merged(levels[-1].reshape(-1, 2, 5)))
    triangles = np.ascontiguousarray(facets.triangles.reshape(-1, 9)[order])
    error = _taken(error, order)
    slopes, counts = _slopes(triangles.reshape(-1, 3, 3)), [len(level) for level in levels[::-1]]
    planes = np.concatenate([_planes(triangles.reshape(-1, 3, 3), error, slopes, count) for count in counts])
    patch = np.where(np.append(facets.patches.whole, False)[facets.patch], facets.patch, NONE)
    return FacetTree(
        boxes=np.column_stack([np.concatenate(levels[::-1]), planes]),
        triangles=triangles,
        corners=np.ascontiguousarray(_taken(facets.corners.reshape(-1, 6), order)),
        patch=patch[order],
        error=error,
        bulge=_taken(facets.bulge, order),
        owner=facets.owner[order],
        order=order,
        control=facets.patches.control,
    )


def _taken(values: Floats, order: Ints) -> Floats:
    """Return values in another order; zeros alone, as meshes have them, are given anew: what nobody writes takes no
    memory.
    """
    return values[order] if values.any() else np.zeros((len(order), *values.shape[1:]))


def _merged(boxes: Floats) -> Floats:
    """Return the boxes (k, 5) round groups (k, m, 5) of them."""
    return np.concatenate([_lowest(boxes[:, :, :2]), _highest(boxes[:, :, 2:])], axis=1)


def _lowest(groups: Floats) -> Floats:
    """Return the least of each group's values, (k, ...) of (k, m, ...): of small groups many times as quick as numpy's
    own reduction.
    """
    return reduce(np.minimum, np.moveaxis(groups, 1, 0))


def _highest(groups: Floats) -> Floats:
    """Return the greatest of each group's values, (k, ...) of (k, m, ...)."""
    return reduce(np.maximum, np.moveaxis(groups, 1, 0))


def _planes(triangles: Floats, error: Floats, slopes: Floats, nodes: int) -> Floats:
    """Return planes (nodes, 3) that nothing of equal shares of the facets is above: slopes along X and Y, height at the
    origin.

    Args:
        slopes: of each facet (n, 2).
    """
    share = _padded(len(triangles)) // nodes
    starts = np.arange(0, len(triangles), share)
    mean = np.add.reduceat(slopes, starts) / np.diff([*starts, len(triangles)])[:, None]
    planes = np.full((nodes, 3), -np.inf)
    planes[:, :2] = 0.0
    planes[: len(starts), :2] = mean
    above = np.empty(len(triangles))
    for first in range(0, len(triangles), _PART):
        some = slice(first, first + _PART)
        own = mean[np.arange(first, min(first + _PART, len(triangles))) // share]
        over = _highest(triangles[some, :, 2] - np.einsum("nc,nkc->nk", own, triangles[some, :, :2]))
        above[some] = over + error[some] * np.sqrt(1 + (own**2).sum(axis=1))
    planes[: len(starts), 2] = np.maximum.reduceat(above, starts)
    return planes


def _padded(count: int) -> int:
    """Return how many places for facets the leaves of a tree of so many have."""
    return LEAF << max(0, int(np.ceil(np.log2(-(-count // LEAF)))))


def _slopes(triangles: Floats) -> Floats:
    """Return how steeply facets rise along X and Y (n, 2); upright ones count as of a slope of _STEEP."""
    slopes = np.empty((len(triangles), 2))
    for first in range(0, len(triangles), _PART):
        some = triangles[first : first + _PART]
        normal = np.cross(some[:, 1] - some[:, 0], some[:, 2] - some[:, 0])
        up = np.where(normal[:, 2] < 0, -1.0, 1.0)[:, None] * normal
        least = np.hypot(up[:, 0], up[:, 1]) / _STEEP
        slopes[first : first + _PART] = -up[:, :2] / np.maximum(np.maximum(up[:, 2], least), 1e-300)[:, None]
    return slopes


def _interleaved(places: Floats) -> NDArray[np.uint64]:
    """Return numbers (n,) by whose order places (n, 3) follow one another closely (Morton 1966)."""
    span = max(float(np.ptp(places, axis=0).max()), 1e-300)
    cells = np.minimum((places - places.min(axis=0)) / span * 2**_BITS, 2**_BITS - 1).astype(np.uint64)
    found = np.zeros(len(places), np.uint64)
    for bit in range(_BITS):
        for axis in range(3):
            found |= ((cells[:, axis] >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return found
