"""Whether tabs stand in the end: an operation leaves them, but another one may cut them off, and what they hold comes
loose.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.wording import in_plane
from ..geometry.distance import DistanceField
from ..geometry.primitives import (
    CX,
    CY,
    TURN,
    X0,
    X1,
    Y0,
    Y1,
    Rows,
    contour_rows,
    fraction_on,
    point_on,
    within_half_turn,
)
from ..model.finding import Finding, FindingKind
from ..model.motion import Floats
from ..model.moves import Area, Tab
from ..simulation.sweeps.probe import LowestReach
from .parts import FlatPart

_ACROSS = 17
"""Places across the middle of a tab, from wall to wall of the cut, that are asked for their height."""

_WITHIN = 0.95
"""Of the cutter's radius to either side of its path: so far out a tab is asked for, as its ends are round."""

_AT_WALL = 1e-6
"""mm; a tab's middle that is no farther from a wall lies on it, as where the path is on the lines."""


def cut_off_tabs(
    part: FlatPart, lowest: Callable[[Floats], LowestReach], where: Callable[[int], str]
) -> Iterator[Finding]:
    """Yield the tabs across whose middle something is cut below their top, so that they hold less than they were made
    for, or nothing.

    It counts where a tab is beside a contour and holds what lies in it; what a tab within a contour holds is waste.

    Args:
        lowest: heights that all motions reach at points (m, 2), program coordinates.
        where: says in words where the motion of a row is.
    """
    if not part.tabs:
        return
    across, waste = _TabWalls.of(part).beside(part.tabs)
    points = across - np.array(part.origin[:2])
    found = lowest(points.reshape(-1, 2))
    heights, motions = (each.reshape(len(part.tabs), _ACROSS) for each in found)
    tops = np.array([tab.top for tab in part.tabs]) - part.origin[2]
    deep = tops - heights.min(axis=1)
    off = np.flatnonzero(deep > part.tolerance)
    for counts in (True, False):
        some = off[waste[off] != counts]
        if len(some):
            k = int(some[np.argmax(deep[some])])
            place = int(np.argmin(heights[k]))
            told = _CutOff(len(some), float(tops[k]), float(heights[k, place]), where(int(motions[k, place])))
            yield told.finding(points[k, _ACROSS // 2].tolist(), counts)


class _CutOff(NamedTuple):
    """How many tabs are cut off, and of the worst of them: its top and how deep is cut across it, mm, program
    coordinates, and where in the program.
    """

    tabs: int
    top: float
    height: float
    where: str

    def finding(self, place: Sequence[float], counts: bool) -> Finding:
        """Return it in words, with the middle of the worst tab, mm."""
        x, y = place
        what = "1 tab does" if self.tabs == 1 else f"{self.tabs} tabs do"
        text = (
            f"{what} not stand, the worst at {in_plane(x, y)}: its top is at Z {self.top:.3f}, and {self.where} cuts "
            f"down to Z {self.height:.3f} across it. Give tabs at the same places (tab_places) to all operations that "
            "come there, or let one operation with a finish width go along the wall."
        )
        return Finding(FindingKind.TAB, text, x, y, counts, amount=self.top - self.height)


class _TabPlaces(NamedTuple):
    """Of each tab places across the cut that it stands in, from one side to the other, (tabs, _ACROSS, 2) mm, part
    coordinates, and whether what it holds is waste.
    """

    across: Floats
    waste: NDArray[np.bool_]


class _TabWalls(NamedTuple):
    """The walls beside which tabs may be: rows (n, 8), and (n,) whether they lie round what is cut out as waste."""

    rows: Rows
    around: NDArray[np.bool_]

    @staticmethod
    def of(part: FlatPart) -> _TabWalls:
        """Return the walls along which operations of a part go; where nobody knows which, all of them."""
        followed = [
            area
            for operation, area in zip(part.job.operations, part.areas, strict=False)
            if operation.FOLLOWS_WALLS and operation.cut.enabled
        ] or [Area(part.regions, part.lines)]
        sides = [(region.boundary, True) for area in followed for region in area.regions]
        sides += [(each, False) for area in followed for region in area.regions for each in region.islands]
        sides += [(each, False) for area in followed for each in area.lines]
        rows = [within_half_turn(contour_rows(contour)) for contour, _ in sides]
        return _TabWalls(np.concatenate(rows), np.repeat([around for _, around in sides], [len(each) for each in rows]))

    def beside(self, tabs: Sequence[Tab]) -> _TabPlaces:
        """Return which walls tabs are beside."""
        middles = np.array([(tab.x, tab.y) for tab in tabs])
        distances, nearest = DistanceField.of(self.rows).nearest(middles)
        rows = self.rows[nearest]
        normals = np.array([_normal(*each) for each in zip(rows, middles, distances.tolist(), strict=True)])
        along = np.linspace(-_WITHIN, _WITHIN, _ACROSS) * np.array([tab.diameter / 2 for tab in tabs])[:, None]
        return _TabPlaces(middles[:, None] + along[:, :, None] * normals[:, None], self.around[nearest])


def _normal(row: Floats, middle: Floats, distance: float) -> Floats:
    """Return the direction (2,) from the nearest place of a wall to a tab's middle, or square to the wall in it."""
    values = row.tolist()
    foot = np.array(point_on(values, fraction_on(values, (float(middle[0]), float(middle[1])))))
    if distance > _AT_WALL:
        way = middle - foot
    elif row[TURN]:
        way = foot - row[CX : CY + 1]
    else:
        way = np.array([row[Y0] - row[Y1], row[X1] - row[X0]])
    found: Floats = way / np.hypot(*way)
    return found
