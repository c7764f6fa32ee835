"""Squares that hold all of an area that some cutters may not have covered; everything else is proven covered.

The distance from a path changes by no more than the way gone, so one exact distance, from a square's centre, can decide
the whole square: covered, when the cutter reaches its farthest corner; untouched, when it does not reach its nearest
point. What neither proves is divided in four, down to a fraction of the cutter's radius.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import Geometry as Shape

from app.geometry.distance import DistanceField
from app.geometry.primitives import Rows, within_half_turn
from app.progress import NO_PROGRESS, Progress

_FINEST = 8
"""The smallest squares' half side goes so many times into the smallest cutter's radius."""

_START = 32
"""Squares along the area's longer side at the beginning."""

Floats = NDArray[np.float64]


def uncertain(wanted: Shape, paths: Sequence[tuple[Rows, float]], progress: Progress = NO_PROGRESS) -> NDArray[np.object_]:
    """Return boxes (n,) that hold every point of a wanted area that is not proven covered.

    Args:
        wanted: polygons, mm.
        paths: (rows (m, 8) of a path, radius of its cutter, mm, > 0); rows may sweep up to a full turn.
        progress: looked at between sizes of squares.
    """
    if wanted.is_empty:
        return np.zeros(0, dtype=object)
    shapely.prepare(wanted)
    fields = [(DistanceField.of(within_half_turn(rows)), radius) for rows, radius in paths if len(rows)]
    finest = min((radius for _, radius in fields), default=math.inf) / _FINEST
    centres, half = _grid(wanted.bounds)
    kept = []
    while True:
        progress.step(0.0, "Measuring what is left")
        centres = centres[shapely.intersects(wanted, _boxes(centres, half))]
        q = half * math.sqrt(2)
        uncut = np.full(len(centres), math.inf)
        for field, radius in fields:
            uncut = np.minimum(uncut, field.nearest(centres, radius + 2 * q)[0] - radius)
        centres, uncut = centres[uncut > -q], uncut[uncut > -q]
        last = half <= finest
        whole = (uncut >= q) | last
        kept.append(_runs(centres[whole], half))
        if last:
            return np.concatenate(kept)
        half /= 2
        centres = quarters(centres[~whole], half)


def _boxes(centres: Floats, half: float) -> NDArray[np.object_]:
    low, high = centres - half, centres + half
    return np.asarray(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]), dtype=object)


def _runs(centres: Floats, half: float) -> NDArray[np.object_]:
    """Return boxes round squares of one size; those side by side share one."""
    if not len(centres):
        return np.zeros(0, dtype=object)
    column, row = np.round((centres - centres.min(axis=0)) / (2 * half)).astype(np.int64).T
    order = np.lexsort((column, row))
    column, row = column[order], row[order]
    first = np.concatenate([[True], (np.diff(row) != 0) | (np.diff(column) != 1)])
    last = np.concatenate([first[1:], [True]])
    low, high = centres[order][first] - half, centres[order][last] + half
    return np.asarray(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]), dtype=object)


def _grid(bounds: tuple[float, float, float, float]) -> tuple[Floats, float]:
    """Return (centres (n, 2), half side): binary fractions, so that edges of squares of all sizes meet to the last digit."""
    x0, y0, x1, y1 = bounds
    half = 2.0 ** math.ceil(math.log2(max(x1 - x0, y1 - y0) / _START / 2))
    x, y = (np.arange(math.floor(low / half / 2), math.ceil(high / half / 2)) * 2 * half + half for low, high in ((x0, x1), (y0, y1)))
    return np.stack(np.meshgrid(x, y), -1).reshape(-1, 2), half


def quarters(centres: Floats, half: float) -> Floats:
    """Return the centres of the four quarters, of half side `half`, of each square."""
    corners = np.array([[-half, -half], [half, -half], [-half, half], [half, half]])
    parts: Floats = (centres[:, None] + corners).reshape(-1, 2)
    return parts
