"""What of polygons lies in each of many boxes: each box is brought to the library with the rings that come near it
alone.

A plate with thousands of holes is one polygon. To intersect it with as many boxes, one after the other, takes as long
as both numbers multiplied.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from .areas import Shapes, each_with_each, unions

_FEW_POINTS = 1000
"""Of a ring; one of more points is cut in halves before boxes are cut out of it, until few boxes are left."""

_FEW_BOXES = 4

Indices = NDArray[np.int64]


def cut_out(shapes: Shapes, boxes: Shapes) -> tuple[Indices, Shapes]:
    """Return (box (k,), what of one polygon lies in it (k,)), nothing of polygons that have no part in a box.

    Args:
        shapes: (n,) polygons. boxes: (m,) rectangles along the axes; they may overlap.
    """
    rings, owner = shapely.get_rings(shapes, return_index=True)
    filled = np.asarray(shapely.polygons(rings), dtype=object)
    hole = owner[1:] == owner[:-1]  # a polygon's outline comes first
    hole = np.concatenate([[False], hole])
    box, ring = shapely.STRtree(filled).query(boxes)
    pieces = _pieces(filled, boxes, ring, box)
    there = ~shapely.is_empty(pieces)
    box, ring, pieces = box[there], ring[there], pieces[there]
    key, inner = box * len(shapes) + owner[ring], hole[ring]
    outer = np.flatnonzero(~inner)
    of, which = np.unique(key[outer], return_inverse=True)  # one outline a box and a polygon
    kept = outer[np.argsort(which, kind="stable")]
    within = np.flatnonzero(inner)[np.isin(key[inner], of)]
    holes = np.full(len(of), shapely.Polygon(), dtype=object)
    at, first = np.unique(np.searchsorted(of, np.sort(key[within])), return_index=True)
    order = within[np.argsort(key[within], kind="stable")]
    holes[at] = unions([pieces[some] for some in np.split(order, first[1:])]) if len(at) else []
    left = each_with_each(shapely.difference, pieces[kept], holes)
    some = ~shapely.is_empty(left)
    return box[kept][some], left[some]


def _pieces(filled: Shapes, boxes: Shapes, ring: Indices, box: Indices) -> Shapes:
    """Return what of rings (k,), filled, lies in a box (k,) of its own each."""
    pieces = np.empty(len(ring), dtype=object)
    long = shapely.get_num_coordinates(filled)[ring] > _FEW_POINTS
    pieces[~long] = each_with_each(shapely.intersection, filled[ring[~long]], boxes[box[~long]])
    requested = np.flatnonzero(long)
    requested = requested[np.argsort(ring[requested], kind="stable")]
    for some in np.split(requested, np.flatnonzero(np.diff(ring[requested])) + 1):
        if len(some):
            for part, number in _halved(filled[ring[some[0]]], boxes[box[some]], some):
                pieces[number] = shapely.intersection(part, boxes[box[number]])
    return pieces


def _halved(shape: Shape, boxes: Shapes, numbers: Indices) -> Iterator[tuple[Shape, Indices]]:
    """Yield (what of a shape is round some of the boxes, their numbers): few boxes, or few points."""
    if len(numbers) <= _FEW_BOXES or shapely.get_num_coordinates(shape) <= _FEW_POINTS:
        yield shape, numbers
        return
    bounds = shapely.bounds(boxes)
    middle = bounds[:, :2] + bounds[:, 2:]
    order = np.argsort(middle[:, int(np.ptp(middle[:, 1]) > np.ptp(middle[:, 0]))], kind="stable")
    for half in (order[: len(order) // 2], order[len(order) // 2 :]):
        round_it = shapely.box(*bounds[half, :2].min(axis=0), *bounds[half, 2:].max(axis=0))
        yield from _halved(shapely.intersection(shape, round_it), boxes[half], numbers[half])
