"""How low a tool comes in corners, where it touches two surfaces at once: at single places, and never told too low.

Cells are too coarse there: the place at which a tool touches both sides lies between them, and a step beside it the
tool stands higher by as much as the steeper side rises. So cells only tell about where that place is. Round there the
tool is dropped on the surfaces themselves, closer and closer; what it cuts from these places is within its reach for
certain, and others might let it cut a little more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from ...simulation.cutter import Cutter
from ...simulation.field.workpiece import Grid
from .reach import FamilyReach, TipGrid

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
TipHeights = Callable[[Floats], Floats]
"""How low a cutter's tip comes at places (n, 2), mm, in the coordinates of the grid; -inf where nothing is in reach."""

LEVELS = (2, 8)
"""Parts of a cell that places lie apart, one look after the other."""

AROUND = 3
"""Steps to each side that a look goes."""

_AT_ONCE = 1 << 20
"""Heights that are looked at together."""
_NEAR = 1e-6
"""Of a radius: half the width over which a profile's slope is taken."""


@dataclass(frozen=True, eq=False)
class CornerReach:
    """What is within reach at n places.

    Attributes:
        low: (n,) the lowest that is cut there from places looked at, mm: not lower than the tool comes.
        rise: (n,) slope of the cutter over the place where that is, mm per mm, >= 0.
    """

    low: Floats
    rise: Floats

    def put(self, part: Ints, other: CornerReach) -> None:
        """Take what another one says of some places."""
        self.low[part], self.rise[part] = other.low, other.rise


Doubtful = Callable[[CornerReach, float], NDArray[np.bool_]]
"""Which places are worth a closer look, given what is known of them, and the step between places looked at, mm."""


def corner_reach(
    tips: TipHeights, cells: TipGrid, requested: FamilyReach, places: Floats, doubtful: Doubtful
) -> CornerReach:
    """Return how low a tool cuts at places (n, 2), without stock to leave.

    Args:
        cells: how low its tip comes by cells, which says where to look.
    """
    finest = LEVELS[-1]
    stand = _by_cells(cells, requested.cutter, places) * finest
    found = CornerReach(np.full(len(places), np.inf), np.zeros(len(places)))
    part = np.arange(len(places))
    for parts in LEVELS:
        look = _CloseLook(tips, cells.grid, requested, finest // parts)
        seen, stand[part] = look.at(places[part], stand[part])
        found.put(part, seen)
        part = np.nonzero(doubtful(found, cells.grid.pitch / parts))[0]
        if not len(part):
            break
    return found


@dataclass(frozen=True, eq=False)
class _CloseLook:
    """One look: the tool dropped some steps round where it was known to cut lowest.

    Attributes:
        grid: of the cells. stride: of one step, in the finest ones.
    """

    tips: TipHeights
    grid: Grid
    requested: FamilyReach
    stride: int

    def at(self, places: Floats, stand: Ints) -> tuple[CornerReach, Ints]:
        """Return what is within reach at places, and from where, in the finest steps from the first cell's centre."""
        starts, which = np.unique(stand, axis=0, return_inverse=True)
        around = (starts[:, None] + _square() * self.stride).reshape(-1, 2)
        found, number = np.unique(around, axis=0, return_inverse=True)
        centres = self._centres(found)
        heights, choices = self._tip(centres), number.reshape(len(starts), -1)
        cutter, best = self.requested.cutter, np.empty(len(places), np.int64)
        low, far = np.empty(len(places)), np.empty(len(places))
        for part in _portions(len(places), choices.shape[1]):
            mine = choices[which[part]]
            away = np.hypot(*(centres[mine] - places[part, None]).transpose(2, 0, 1))
            over = heights[mine] + cutter.lift + cutter.heights(away)
            lowest = (np.arange(len(mine)), np.argmin(over, axis=1))
            low[part], far[part], best[part] = over[lowest], away[lowest], mine[lowest]
        return CornerReach(low, _slopes(cutter, far)), found[best]

    def _centres(self, steps: Ints) -> Floats:
        grid = self.grid
        origin = np.array([grid.x0, grid.y0]) + grid.pitch / 2
        return np.asarray(origin + steps * (grid.pitch / LEVELS[-1]))

    def _tip(self, places: Floats) -> Floats:
        """Return heights of the tip at places; infinite where the tool may not be."""
        heights = np.maximum(self.tips(places), self.requested.lowest)
        if self.requested.area is not None:
            heights[~shapely.contains_xy(self.requested.area, places)] = np.inf
        return heights


def _by_cells(cells: TipGrid, cutter: Cutter, places: Floats) -> Ints:
    """Return the column and row (n, 2) of the cell from which a tool cuts lowest at each place, as cells have it."""
    grid = cells.grid
    offsets, profile = _disc(cutter, grid.pitch)
    own = ((places - (grid.x0, grid.y0)) / grid.pitch).astype(np.int64)
    found = np.empty_like(own)
    for part in _portions(len(places), len(offsets)):
        around = own[part, None] + offsets
        cols, rows = np.clip(around[..., 0], 0, grid.cols - 1), np.clip(around[..., 1], 0, grid.rows - 1)
        best = np.argmin(cells.heights[rows, cols] + profile, axis=1)
        found[part] = own[part] + offsets[best]
    return found


def _disc(cutter: Cutter, step: float) -> tuple[Ints, Floats]:
    """Return steps (m, 2) within a cutter's radius, and its profile there, mm."""
    most = int(cutter.radius / step)
    along = np.arange(-most, most + 1)
    offsets = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    profile = cutter.heights(np.hypot(*offsets.T) * step)
    return offsets[np.isfinite(profile)], profile[np.isfinite(profile)]


def _square() -> Ints:
    """Return the steps (m, 2) of one look."""
    along = np.arange(-AROUND, AROUND + 1)
    return np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)


def _portions(count: int, width: int) -> Iterator[slice]:
    """Yield parts of so many rows of a width that are looked at together."""
    rows = max(_AT_ONCE // width, 1)
    for first in range(0, count, rows):
        yield slice(first, first + rows)


def _slopes(cutter: Cutter, far: Floats) -> Floats:
    """Return how a cutter's profile rises at distances from its axis, mm per mm; at its rim as within it."""
    near = _NEAR * cutter.radius
    middle = np.clip(far, near, cutter.radius - near)
    return np.asarray((cutter.heights(middle + near) - cutter.heights(middle - near)) / (2 * near))
