"""How high the ridges are that neighbouring straight passes leave on a plane, for any cutter."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ...simulation.cutter import Cutter

Floats = NDArray[np.float64]

MOST = 0.1
"""Of the cutter's radius: what stands higher between passes on a slope is metal that they have not come to, and no
ridge.
"""

_SLOPES = np.tan(np.radians(np.linspace(0.0, 85.0, 86)))
"""mm up per mm sideways at which ridges are tabled: every degree up to 85."""
_PLACES = 801
"""Across the cutter, where its profile is asked: its rim's steep end is told to a four-hundredth of its radius."""


def ridges(cutter: Cutter, spacing: float, slopes: Floats) -> Floats:
    """Return how far ridges stand out of planes, square to them, mm; on slopes at most MOST of the cutter's radius,
    where a level has less.

    Passes farther apart than the cutter is wide leave no ridges but what was there: 0.

    Args:
        spacing: of the passes seen from above, mm, > 0.
        slopes: any shape, mm up per mm across the passes, >= 0.

    Along a pass the plane is taken as level; where it rises that way as well, ridges are lower.
    """
    table = np.array([_ridge(cutter, spacing, slope) for slope in _SLOPES.tolist()])
    return np.asarray(np.interp(slopes, _SLOPES, np.minimum(table, max(table[0], MOST * cutter.radius))))


def _ridge(cutter: Cutter, spacing: float, slope: float) -> float:
    """Return the height of the place that both of two neighbouring passes cut least, square to the plane that they
    touch.
    """
    if spacing > 2 * cutter.radius:
        return 0.0
    across = np.linspace(-cutter.radius, cutter.radius, _PLACES)
    over = cutter.heights(np.abs(across)) - slope * across
    touch = float(across[int(np.argmin(over))])
    between = np.linspace(touch, touch + spacing, _PLACES)
    first = cutter.heights(np.abs(between))
    second = cutter.heights(np.abs(between - spacing)) + slope * spacing
    height = float(np.max(np.minimum(first, second) - slope * between)) - float(over.min())
    return max(height, 0.0) / math.hypot(1.0, slope)
