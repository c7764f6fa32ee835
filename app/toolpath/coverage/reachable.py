"""Can a cutter's centre be anywhere near a place? Decided by exact distances, in squares that are divided where it is
doubtful.

Polygons of chords let a cutter through gaps that are some micrometres too narrow for it; what they take to be within
reach is asked here once more. The distance from the walls changes by no more than the way gone, so its value in a
square's middle bounds it all over.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core import tolerances
from ...geometry.distance import DistanceField
from ...geometry.primitives import pack
from ...model.part import Region
from . import reachable_kernels as kernels

_MOST = 200_000
"""Squares for one point; points that need more count as within reach."""

_SLIVER = 0.25
"""Share of a cutter's radius below which a piece of metal is a sliver."""

_NOMINAL = tolerances.NOMINAL - 2 * tolerances.FIT
"""mm; a cutter that is too large by exactly `NOMINAL` does not fit, whatever rounding and doubt make of it: no path
goes there.
"""

_NEAR = 0.01
"""mm; so near to an area metal may lie in it, whatever chords make of its walls."""


@dataclass(frozen=True, eq=False)
class CutterInArea:
    """A cutter in an area.

    Attributes:
        regions: that it stays in.
        wall: how far its centre stays from walls, mm.
        radius: mm.
    """

    regions: tuple[Region, ...]
    wall: float
    radius: float

    def reaches(self, points: NDArray[np.float64], fields: Fields, spare: float = -_NOMINAL) -> bool:
        """Tell whether its centre may be somewhere within its radius of some point; True also where that stays in
        doubt.

        Args:
            points: (n, 2); they are asked together, as the same squares decide of points near one another.
            spare: how much farther from the walls than asked it has to stay, mm.
        """
        field, wall, most = fields.of(self.regions), self.wall + spare, _MOST * len(points)
        points = np.ascontiguousarray(points, np.float64)
        return bool(
            len(points)
            and kernels.within_reach(
                field.rows, field.order, field.nodes, points, self.radius, wall, tolerances.FIT, most
            )
        )


class Fields:
    """Distances from the walls of areas, made once each."""

    def __init__(self) -> None:
        self._kept: list[tuple[Region, ...]] = []
        self._made: dict[int, DistanceField] = {}

    def of(self, regions: tuple[Region, ...]) -> DistanceField:
        """Return the distances from all contours of some regions."""
        if id(regions) not in self._made:
            self._kept.append(regions)  # so that no other ones get its id
            self._made[id(regions)] = DistanceField.of(pack(regions).rows)
        return self._made[id(regions)]


def reached(points: NDArray[np.float64], cutters: Sequence[CutterInArea], fields: Fields, size: float) -> bool:
    """Tell whether some cutter reaches one of some points (n, 2) of a piece of metal whose largest disc has a diameter
    `size`, mm.

    A sliver counts where a cutter does that stays 1 um farther from the walls, as its paths may: in a neck that grows
    narrow slowly, a micrometre decides on tenths of a millimetre.
    """
    # a cutter of an area that the piece does not lie in has no say in what a sliver is
    cutters = [each for each in cutters if _holds(fields.of(each.regions), points)]
    spare = -_NOMINAL if any(size > _SLIVER * cutter.radius for cutter in cutters) else tolerances.LEVEL
    return any(cutter.reaches(points, fields, spare) for cutter in cutters)


def _holds(field: DistanceField, points: NDArray[np.float64]) -> bool:
    """Tell whether one of some points (n, 2) lies in an area, or so near to it that it may."""
    return bool(np.any(field.inside(points) | (field.nearest(points)[0] <= _NEAR)))
