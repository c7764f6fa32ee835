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

from ...core.progress import Progress
from ...simulation.cutter import Cutter
from ...simulation.field.target import cutter_profile
from .reach import FamilyReach, TipGrid

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
TipHeights = Callable[[Floats, Progress], Floats]
"""How low a cutter's tip comes at places (n, 2), mm, in the coordinates of the grid, and never less than it does; -inf
where nothing is in reach.
"""

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


@dataclass(frozen=True, eq=False)
class CornerTool:
    """A tool over surfaces and what it leaves on them.

    Attributes:
        requested: where it may go. tips: how low its tip comes. cells: the same by cells, which says where to look.
    """

    requested: FamilyReach
    tips: TipHeights
    cells: TipGrid

    def tip(self, places: Floats, progress: Progress) -> Floats:
        """Return heights of the tip at places (n, 2); infinite where the tool may not be."""
        heights = np.maximum(self.tips(places, progress), self.requested.lowest)
        if self.requested.area is not None:
            heights[~shapely.contains_xy(self.requested.area, places)] = np.inf
        return heights

    def centres(self, steps: Ints) -> Floats:
        """Return places (n, 2), so many of the finest steps from the first cell's centre."""
        grid = self.cells.grid
        origin = np.array([grid.x0, grid.y0]) + grid.pitch / 2
        return np.asarray(origin + steps * (grid.pitch / LEVELS[-1]))


def corner_reach(tool: CornerTool, places: Floats, doubtful: Doubtful, progress: Progress) -> CornerReach:
    """Return how low a tool cuts at places (n, 2).

    Raises:
        Cancelled: the job was asked to stop.
    """
    finest, pitch = LEVELS[-1], tool.cells.grid.pitch
    stand = _by_cells(tool, places) * finest
    found = CornerReach(np.full(len(places), np.inf), np.zeros(len(places)))
    part = np.arange(len(places))
    for level, parts in enumerate(LEVELS):
        share = progress.part(level / len(LEVELS), (level + 1) / len(LEVELS))
        seen, stand[part] = _looked(tool, places[part], stand[part], finest // parts, share)
        found.put(part, seen)
        part = np.nonzero(doubtful(found, pitch / parts))[0]
        if not len(part):
            break
    return found


def _looked(tool: CornerTool, places: Floats, stand: Ints, stride: int, progress: Progress) -> tuple[CornerReach, Ints]:
    """Return what is within reach at places, and from where.

    Args:
        stand: from where each was cut lowest so far, as of `CornerTool.centres`. stride: of one step round that.
    """
    starts, which = np.unique(stand, axis=0, return_inverse=True)
    found, number = np.unique((starts[:, None] + _square() * stride).reshape(-1, 2), axis=0, return_inverse=True)
    centres, cutter = tool.centres(found), tool.requested.cutter
    heights, choices = tool.tip(centres, progress), number.reshape(len(starts), -1)
    low, far, best = np.empty(len(places)), np.empty(len(places)), np.empty(len(places), np.int64)
    for part in _portions(len(places), choices.shape[1]):
        mine = choices[which[part]]
        away = np.hypot(*(centres[mine] - places[part, None]).transpose(2, 0, 1))
        over = heights[mine] + cutter.lift + cutter.heights(away)
        lowest = (np.arange(len(mine)), np.argmin(over, axis=1))
        low[part], far[part], best[part] = over[lowest], away[lowest], mine[lowest]
    return CornerReach(low, _slopes(cutter, far)), found[best]


def _by_cells(tool: CornerTool, places: Floats) -> Ints:
    """Return the column and row (n, 2) of the cell from which a tool cuts lowest at each place, as cells have it."""
    grid, heights = tool.cells.grid, tool.cells.heights
    profile = cutter_profile(tool.requested.cutter, grid.pitch)
    within = np.isfinite(profile)
    offsets, profile = np.argwhere(within)[:, ::-1] - len(profile) // 2, profile[within]
    own = ((places - (grid.x0, grid.y0)) / grid.pitch).astype(np.int64)
    found = np.empty_like(own)
    for part in _portions(len(places), len(offsets)):
        around = own[part, None] + offsets
        cols, rows = np.clip(around[..., 0], 0, grid.cols - 1), np.clip(around[..., 1], 0, grid.rows - 1)
        found[part] = own[part] + offsets[np.argmin(heights[rows, cols] + profile, axis=1)]
    return found


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
