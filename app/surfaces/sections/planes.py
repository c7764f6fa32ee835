"""The family of cutting planes: from one line on the XY plane and a rule, all that meet the surfaces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from ...core.errors import ParameterError
from .compound import CuttingPlanes

Floats = NDArray[np.float64]
Stretch = tuple[float, float]

MOST_PLANES = 100_000
"""Planes, at most; more are a slip in the spacing."""
_NEAR = 1e-9
"""Of a pitch: so much beyond the surfaces a plane still meets them."""
_PART = 1 << 17
"""Places at a time, so that no copy of all of them is made."""


def extent_on(planes: CuttingPlanes, places: Floats) -> tuple[Stretch, Stretch]:
    """Return the stretch along the planes, and across them, in which places (n, 2) lie, mm."""
    ends = [_extent(planes, places[first : first + _PART]) for first in range(0, len(places), _PART)]
    low, high = np.min([low for low, _ in ends], axis=0), np.max([high for _, high in ends], axis=0)
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _extent(planes: CuttingPlanes, places: Floats) -> tuple[Floats, Floats]:
    """Return (low, high), each along and across the planes, mm."""
    c, s = planes.along
    dx, dy = places[:, 0] - planes.origin[0], places[:, 1] - planes.origin[1]
    both = np.stack([dx * c + dy * s, dy * c - dx * s])
    return both.min(axis=1), both.max(axis=1)


def even_planes(origin: tuple[float, float], angle: float, pitch: float, places: Floats) -> CuttingPlanes:
    """Return planes at one distance from each other, one of them through a place, as many as meet places (n, 2).

    Args:
        origin: x, y, mm. angle: of the planes to the X axis, radians. pitch: mm, > 0.

    Raises:
        ParameterError: there would be more than MOST_PLANES.
    """
    bare = CuttingPlanes(origin, angle, ())
    _, (low, high) = extent_on(bare, places)
    first, last = math.ceil(low / pitch - _NEAR), math.floor(high / pitch + _NEAR)
    if last - first >= MOST_PLANES:
        raise ParameterError(
            f"A pitch of {pitch:g} mm makes {last - first + 1:,} passes, but {MOST_PLANES:,} are the most; "
            "use a larger one."
        )
    offsets = [min(max(k * pitch, low), high) for k in range(first, last + 1)]
    return CuttingPlanes(origin, angle, tuple(offsets) or ((low + high) / 2,))


def stretches(planes: CuttingPlanes, plane: int, whole: Stretch, area: shapely.Geometry | None) -> Sequence[Stretch]:
    """Return from where to where, along one plane, it lies over an area; None: everywhere."""
    if area is None:
        return (whole,)
    line = shapely.LineString([planes.place(plane, whole[0]), planes.place(plane, whole[1])])
    within = shapely.get_parts(shapely.intersection(area, line))
    c, s = planes.along
    found = []
    for part in within:
        if part.geom_type == "LineString" and not part.is_empty:
            at = [(x - planes.origin[0]) * c + (y - planes.origin[1]) * s for x, y in part.coords]
            found.append((min(at), max(at)))
    return sorted(found)


def widened(planes: CuttingPlanes, places: Floats, far: float, step: float) -> CuttingPlanes:
    """Return planes with more of them on both sides, up to so far beyond places (n, 2), mm, one step from one
    another.
    """
    _, (low, high) = extent_on(planes, places)
    first, last = planes.offsets[0], planes.offsets[-1]
    before, after = (max(0, math.floor((room + far) / step + _NEAR)) for room in (first - low, high - last))
    if before + after >= MOST_PLANES:
        raise ParameterError(f"An overrun of {far:g} mm makes more than {MOST_PLANES:,} passes; use a smaller one.")
    offsets = (
        *(first - k * step for k in range(before, 0, -1)),
        *planes.offsets,
        *(last + k * step for k in range(1, after + 1)),
    )
    return replace(planes, offsets=offsets)
