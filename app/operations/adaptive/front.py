"""What a cutter meets of metal at a place: all but what its path has swept so far."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows, path_length, point_on, sweep_of
from ...toolpath.engagement.rim_kernels import (
    bound_along,
    covers_disc,
    last_on_arc,
    last_uncovered,
    shapes_near,
    uncovered,
)
from ...toolpath.engagement.swath_shapes import swath_shapes
from .cleared_discs import Point
from .limit import EngagementLimit

Floats = NDArray[np.float64]

_HAIR = 2e-3
"""Radians of the rim; less metal is none."""

_BARE = 0.01
"""Radians of the rim: thinner metal than it belongs to, 0.01 um for a cutter of 6 mm, is left to the last way along
the walls.
"""

_AIR = 0.01
"""Radians of a bound that is as good as none: the metal is as thin as above."""

_LOOKED, _SWEPT = 33, 2.0
"""Places that are looked at on an arc in which the cutter turns away from a wall, and radians of it."""

_RECENT = 4
"""Shapes added last among which the disc at the path's end is."""

_SQUARE = 2e-4
"""mm; half the side of squares that are not divided to see whether a disc is clear."""

_ABOUT = 0.8
"""Radii of the cutter: so far round a place shapes are looked up at once, and serve until the cutter has left it."""

_COARSE, _FINEST = 0.1, 1e-5
"""Length of the pieces that are bounded first, radii of the cutter, and of those that are not halved, mm."""


@dataclass
class MetalFront:
    """Where metal is met.

    Attributes:
        limit: of the cutter.
        table: (n, 9) what is clear, shapes of `rim_kernels`.
        _near, _place: those shapes that were asked for last, and where, mm.
    """

    limit: EngagementLimit
    table: Floats = field(default_factory=lambda: np.empty((0, 9)))
    _near: Floats = field(default_factory=lambda: np.empty((0, 9)))
    _place: Point = (math.inf, math.inf)

    def add_disc(self, x: float, y: float, radius: float) -> None:
        """Take a disc as clear."""
        self._add(np.array([[x, y, radius, 0.0, 0.0, math.inf, 0.0, 0.0, math.inf]]))

    def sweep(self, rows: Rows) -> None:
        """Take as clear what the cutter sweeps along rows (n, 8)."""
        shapes = swath_shapes(rows, self.limit.radius)
        if len(self.table):
            # where the path goes on, the cutter's disc there is known
            shapes = shapes[(shapes[:, :3] != self.table[-_RECENT:, None, :3]).any(axis=2).all(axis=0)]
        self._add(shapes)

    def _add(self, shapes: Floats) -> None:
        self.table = np.concatenate([self.table, shapes])
        self._place = (math.inf, math.inf)

    def forget(self, count: int) -> None:
        """Take nothing as clear but the first shapes."""
        self.table = self.table[:count]
        self._place = (math.inf, math.inf)

    def covers(self, disc: tuple[float, float, float]) -> bool:
        """Tell whether a disc (x, y, radius) is surely clear."""
        return bool(covers_disc(shapes_near(self.table, disc), disc, _SQUARE))

    def near(self, place: Point) -> Floats:
        """Return the shapes that the rim of a cutter may meet at a place."""
        about = _ABOUT * self.limit.radius
        if not math.dist(place, self._place) <= about:
            self._near, self._place = self._within(place, about), place
        return self._near

    def _within(self, place: Point, about: float) -> Floats:
        return np.asarray(shapes_near(self.table, (*place, self.limit.radius + about)))

    def is_clear(self, place: Point, ahead: float) -> bool:
        """Tell whether no metal stands before a cutter that goes in a direction, radians."""
        return self._last(place, ahead, _BARE) < 0.0

    def _last(self, place: Point, ahead: float, least: float) -> float:
        """Return up to where metal stands on the rim's front half, radians from its right end; -1 where none does."""
        return float(last_uncovered(self.near(place), *self._front(place, ahead), least))

    def _front(self, place: Point, ahead: float) -> tuple[tuple[float, float, float], tuple[float, float]]:
        """Return the rim, and where its front half begins and how far it goes, radians."""
        return (*place, self.limit.radius), (ahead - math.pi / 2, math.pi)

    def bare(self, place: Point, ahead: float) -> float:
        """Return how much of the rim's front half is in metal at a place, radians."""
        rim, half = self._front(place, ahead)
        return float(uncovered(self.near(place), rim, 0.0, half))

    def met(self, place: Point, ahead: float) -> float | None:
        """Return up to where metal stands on the rim's front half, radians from its right end; None where none does.

        Args:
            ahead: direction of travel, radians.
        """
        found = self._last(place, ahead, _HAIR)
        return found if found >= 0.0 else None

    def most(self, centre: Point, turn: float, ahead: float) -> tuple[float, float]:
        """Return the most that is met on an arc to the left, looked at in places, and the direction of travel there.

        Args:
            turn: its radius, mm.
            ahead: direction of travel at its beginning, radians.
        """
        scan = (_SWEPT / (_LOOKED - 1), _SWEPT, _HAIR)
        shapes = self._within(centre, turn)
        most, where = last_on_arc(shapes, (*centre, turn, ahead), self.limit.radius, scan)
        return max(float(most), 0.0), float(where)

    def is_air(self, row: Rows) -> bool:
        """Tell whether a row (8,) is over clear ground."""
        return self.bound(row, _AIR) <= _AIR

    def bound(self, row: Rows, enough: float) -> float:
        """Return a bound of the engaged angle along a row (8,), radians; no better than `enough` if it is below, and no
        more than the first that is above.
        """
        most = 0.0
        for part in _parts(row, self.limit.radius):
            most = max(most, self._bound(part, enough))
            if most > enough:
                break
        return most

    def _bound(self, row: Rows, enough: float) -> float:
        numbers = row.tolist()
        size, turn = path_length(row[None]), sweep_of(numbers)
        limits = (enough, _COARSE * self.limit.radius, _FINEST, enough)
        shapes = self._within(point_on(numbers, 0.5), size / 2)
        return float(bound_along(shapes, row, self.limit.radius, (turn, size), limits)[0])


def _parts(row: Rows, longest: float) -> Rows:
    """Return a row in parts (n, 8) of a length at most, mm: few shapes are near a short one."""
    count = max(1, math.ceil(path_length(row[None]) / longest))
    parts = np.repeat(row[None], count, axis=0)
    if count > 1:
        numbers = row.tolist()
        parts[:-1, 2:4] = parts[1:, :2] = [point_on(numbers, k / count) for k in range(1, count)]
    return parts
