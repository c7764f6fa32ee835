"""Closed ways along walls, corners rounded: places of them by their distance from the beginning, and what is uncut."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...geometry.distance import DistanceField
from ...geometry.primitives import Rows, fraction_on, lengths, point_on, within_half_turn
from ...toolpath.linking.bridge import part_of
from .cleared_discs import Point
from .front import MetalFront
from .pursuit import Heading

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_LOOKED = 0.1
"""Radii of the cutter between places along walls that are looked at."""


@dataclass(frozen=True, eq=False)
class WallPath:
    """A closed way along a wall.

    Attributes:
        rows: (n, 8) that touch one another, arcs of less than half a turn.
        spacing: of the places that are looked at, mm, about.
    """

    rows: Rows
    spacing: float

    @staticmethod
    def of(path: Rows, radius: float) -> WallPath:
        """Take a closed path (n, 8) of a cutter."""
        return WallPath(within_half_turn(path), _LOOKED * radius)

    @cached_property
    def ends(self) -> Floats:
        """(n + 1,) where rows begin, and the length of all, mm."""
        return np.concatenate([np.zeros(1), np.cumsum(lengths(self.rows))])

    @property
    def length(self) -> float:
        """Of the whole way, mm."""
        return float(self.ends[-1])

    @cached_property
    def places(self) -> Floats:
        """(m,) the places that are looked at, mm from the beginning."""
        count = max(8, math.ceil(self.length / self.spacing))
        return np.arange(count, dtype=np.float64) * (self.length / count)

    @cached_property
    def headings(self) -> tuple[Heading, ...]:
        """What they are as places and directions of travel."""
        return tuple(self.heading(float(at)) for at in self.places)

    @cached_property
    def points(self) -> Floats:
        """(m, 2) where they are, mm."""
        return np.array([each.place for each in self.headings])

    def _row(self, at: float) -> tuple[int, float]:
        """Return (row, fraction of it) at a distance from the beginning."""
        at %= self.length
        row = min(int(np.searchsorted(self.ends, at, "right")) - 1, len(self.rows) - 1)
        return row, float((at - self.ends[row]) / (self.ends[row + 1] - self.ends[row]))

    def heading(self, at: float) -> Heading:
        """Return the place and the direction of travel at a distance from the beginning, mm."""
        number, part = self._row(at)
        row = self.rows[number].tolist()
        x, y = point_on(row, part)
        if row[7] == 0:
            return Heading(x, y, math.atan2(row[3] - row[1], row[2] - row[0]))
        return Heading(x, y, math.atan2(y - row[5], x - row[4]) + row[7] * math.pi / 2)

    def nearest(self, place: Point) -> tuple[float, float]:
        """Return (mm from the beginning, mm away) of what is nearest to a place."""
        away, found = self._field.nearest(np.array([place]))
        row = int(found[0])
        part = fraction_on(self.rows[row].tolist(), place)
        return float(self.ends[row] + part * (self.ends[row + 1] - self.ends[row])), float(away[0])

    @cached_property
    def _field(self) -> DistanceField:
        return DistanceField.of(self.rows)

    def span(self, start: float, end: float) -> Rows:
        """Return the rows from one distance to another, not less, one, going on past the beginning."""
        made: list[Rows] = []
        lap = math.floor(start / self.length) * self.length
        row, _ = self._row(start)
        at = start
        while at < end - 1e-9:
            first = lap + float(self.ends[row])
            size = float(self.ends[row + 1] - self.ends[row])
            made.append(part_of(self.rows[row], max(0.0, (at - first) / size), min(1.0, (end - first) / size)))
            at = first + size
            row += 1
            if row == len(self.rows):
                row, lap = 0, lap + self.length
        return np.concatenate(made) if made else np.zeros((0, 8))

    def uncut(self, front: MetalFront, before: Flags, near: Floats) -> Flags:
        """Return (m,) at which of the places metal stands.

        Args:
            before: (m,) where it stood before something was cut.
            near: the box of that, mm: least x and y, largest x and y.
        """
        still = before.copy()
        asked = before & (self.points >= near[:2]).all(axis=1) & (self.points <= near[2:]).all(axis=1)
        for k in np.flatnonzero(asked):
            here = self.headings[k]
            still[k] = not front.is_clear(here.place, here.ahead)
        return still
