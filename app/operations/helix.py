"""Turns about an axis, as rows: quarter arcs, which any control takes, with the height at the end of each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.primitives import Rows

Floats = NDArray[np.float64]

_QUARTER = math.pi / 2
"""Radians an arc: any control takes a quarter turn, and some no more."""


@dataclass(frozen=True, eq=False)
class HelixRows:
    """A way of quarter turns.

    Attributes:
        rows: (n, 8) arcs. heights: (n,) at the end of each, mm.
    """

    rows: Rows
    heights: Floats

    @property
    def start(self) -> tuple[float, float]:
        """Where it begins in the plane, mm."""
        return float(self.rows[0, 0]), float(self.rows[0, 1])

    @property
    def end(self) -> tuple[float, float]:
        """Where it ends in the plane, mm."""
        return float(self.rows[-1, 2]), float(self.rows[-1, 3])


def helix(
    centre: tuple[float, float], radius: float, heights: tuple[float, float], turns: float, ccw: bool
) -> HelixRows:
    """Return a helix about an axis, that begins to the right of it (at angle 0).

    Args:
        centre: mm. radius: of the tool's centre, mm, > 0.
        heights: where it begins and where it ends, mm.
        turns: how many, a multiple of a quarter, > 0. ccw: which way it goes, seen from above.
    """
    count = round(4 * turns)
    angles = np.arange(count + 1) * (_QUARTER if ccw else -_QUARTER)
    # exact on the axes, so that whole turns end where they begin
    cos, sin = np.round(np.cos(angles)), np.round(np.sin(angles))
    points = np.column_stack([centre[0] + radius * cos, centre[1] + radius * sin])
    rows = np.zeros((count, 8))
    rows[:, :2], rows[:, 2:4], rows[:, 4:6] = points[:-1], points[1:], centre
    rows[:, 6], rows[:, 7] = radius, 1.0 if ccw else -1.0
    ends = heights[0] + (heights[1] - heights[0]) * np.arange(1, count + 1) / count
    return HelixRows(rows, ends)


def half_circle(
    start: tuple[float, float], end: tuple[float, float], heights: tuple[float, float], ccw: bool
) -> HelixRows:
    """Return a half circle between two places along X, as two quarters, that meets a turn about either in its
    tangent.
    """
    middle = (start[0] + end[0]) / 2, start[1]
    radius = abs(end[0] - start[0]) / 2
    below = (end[0] > start[0]) == ccw
    top = middle[0], middle[1] + (-radius if below else radius)
    points = np.array([start, top, end])
    rows = np.zeros((2, 8))
    rows[:, :2], rows[:, 2:4], rows[:, 4:6] = points[:-1], points[1:], middle
    rows[:, 6], rows[:, 7] = radius, 1.0 if ccw else -1.0
    return HelixRows(rows, np.linspace(*heights, 3)[1:])
