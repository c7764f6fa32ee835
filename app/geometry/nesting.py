"""Which of some closed loops lie in which."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from .outlines import Outlines, polygons
from .primitives import Rows

_CHORD = 0.01
"""mm; only which loop lies in which depends on it."""


def lying_in(loops: Sequence[Rows]) -> NDArray[np.int64]:
    """Return (2, n) pairs of loops of which the first lies in the second, by their indices.

    A loop lies in every larger one that holds a point within it, so loops that touch from inside count, and of two that
    cross the smaller one may lie in the other.

    Args:
        loops: closed, rows (k, 8) each.
    """
    if len(loops) < 2:
        return np.zeros((2, 0), np.int64)
    outlines = Outlines.joined(loops)
    shapes = np.asarray(shapely.points(outlines.rows[outlines.first[:-1], :2]), dtype=object)
    number, wide = polygons(outlines, np.arange(len(outlines)), _CHORD)
    shapes[number] = wide
    places = np.asarray(shapely.points(outlines.rows[outlines.first[:-1], :2]), dtype=object)
    whole = number[shapely.is_valid(wide)]
    places[whole] = shapely.point_on_surface(shapes[whole])
    held = shapely.STRtree(shapes).query(places, predicate="within")
    size = shapely.area(shapes)
    found: NDArray[np.int64] = held[:, (held[0] != held[1]) & (size[held[0]] < size[held[1]])]
    return found


def ranks(loops: Sequence[Rows]) -> list[int]:
    """Return how many of some closed loops of rows lie round each of them."""
    return [int(count) for count in np.bincount(lying_in(loops)[0], minlength=len(loops))]
