"""Areas of many parts put together, cut and taken from one another: only parts whose boxes meet are brought to the
library.

An overlay takes what n log n takes for all edges of both its operands, though most parts of a drawing have nothing to
do with most others. Parts of one area have no inside in common; they may touch.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from ...core.pool import in_bands

Shapes = NDArray[np.object_]

_WORTH_TWO_CORES = 32
"""Overlays from which a second core is worth its start."""

_GRID = 1e-9
"""mm; where rounding leaves the library without an answer, one on this grid is found."""


def united(shapes: Iterable[Shape] | Shapes | Shape) -> Shape:
    """Return what any of some areas covers."""
    parts = _parts(shapes)
    if len(parts) < 2:
        return gathered(parts)
    first, second = shapely.STRtree(parts).query(parts)
    if np.all(first == second):
        return gathered(parts)
    try:
        return shapely.disjoint_subset_union_all(parts)
    except shapely.errors.GEOSException:
        return shapely.union_all(shapely.make_valid(parts), grid_size=_GRID)


def common(one: Shape, other: Shape) -> Shape:
    """Return what two areas have in common; lines and points along which they only touch are none of it."""
    a, b = _parts(one), _parts(other)
    if not len(a) or not len(b):
        return shapely.Polygon()
    second, first = shapely.STRtree(a).query(b)[[0, 1]]
    return gathered(each_with_each(shapely.intersection, a[first], b[second]))


def without(one: Shape, other: Shape) -> Shape:
    """Return what of an area another one does not cover."""
    a, b = _parts(one), _parts(other)
    if not len(a) or not len(b):
        return gathered(a)
    second, first = shapely.STRtree(a).query(b)
    order = np.argsort(first, kind="stable")
    met, at = np.unique(first[order], return_index=True)
    left = a.copy()
    taken = np.empty(len(met), dtype=object)
    taken[:] = [gathered(b[rows]) for rows in np.split(second[order], at[1:])]
    left[met] = each_with_each(shapely.difference, a[met], taken)
    return gathered(left)


def each_with_each(overlay: Callable[..., Shapes], one: Shapes, other: Shapes) -> Shapes:
    """Return the overlay of each shape (n,) with the one (n,) beside it, on all cores."""

    def overlaid(band: slice) -> Shapes:
        try:
            return overlay(one[band], other[band])
        except shapely.errors.GEOSException:
            return overlay(shapely.make_valid(one[band]), shapely.make_valid(other[band]), grid_size=_GRID)

    return np.concatenate(in_bands(overlaid, len(one), _WORTH_TWO_CORES))


def unions(lots: Sequence[Shapes]) -> Shapes:
    """Return what the shapes of each lot cover together, (n,), on all cores."""

    def covered(band: slice) -> Shapes:
        found = np.empty(len(lots[band]), dtype=object)
        found[:] = [shapely.union_all(lot) for lot in lots[band]]
        return found

    return np.concatenate(in_bands(covered, len(lots), _WORTH_TWO_CORES))


def opened(shapes: Shapes, by: float) -> Shapes:
    """Return what is left of areas (n,) that are shrunk by so much, mm, and grown again with sharp corners, without
    those that vanish; on all cores.
    """

    def reached(band: slice) -> Shapes:
        some = shapes[band]
        kept = shapely.buffer(some, -by, join_style="mitre")
        there = ~shapely.is_empty(kept)  # to intersect nothing with lines and areas at once makes GEOS give up
        grown = shapely.buffer(kept[there], by, join_style="mitre")
        return np.asarray(shapely.intersection(grown, some[there]), dtype=object)

    return np.concatenate(in_bands(reached, len(shapes), _WORTH_TWO_CORES))


def _parts(shapes: Iterable[Shape] | Shapes | Shape) -> Shapes:
    """Return the polygons of which areas consist."""
    several = shapes if isinstance(shapes, (Shape, np.ndarray)) else list(shapes)
    return _polygons(shapely.get_parts(several))


def _polygons(shapes: Shapes) -> Shapes:
    """Return the polygons among shapes and their parts."""
    parts = shapely.get_parts(shapely.get_parts(shapes))
    return np.asarray(
        parts[(shapely.get_type_id(parts) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(parts)], dtype=object
    )


def gathered(shapes: Shapes) -> Shape:
    """Return the polygons among shapes, which have no inside in common, as one area."""
    parts = _polygons(shapes)
    if not len(parts):
        return shapely.Polygon()
    return parts[0] if len(parts) == 1 else shapely.multipolygons(parts)
