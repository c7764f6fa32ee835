"""Whether tabs stand in the end: an operation leaves them, but another one may cut them off, and what they hold comes
loose.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

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
    contour_rows,
    fraction_on,
    point_on,
    within_half_turn,
)
from ..model.finding import Finding, FindingKind
from ..model.motion import Floats
from ..model.moves import Area
from ..simulation.cutter import Cutter, sure_spacing
from ..simulation.sweeps.probe import PathProbe
from .parts import FlatPart

_ACROSS = 17
"""Places at least across the middle of a tab, from wall to wall of the cut, that are asked for their height."""

_WITHIN = 0.95
"""Of the cutter's radius to either side of its path: so far out a tab is asked for, as its ends are round."""

_BEYOND = 0.1
"""mm beyond either end of a tab, where metal must stand for it to be tied to."""

_NOTCH = 0.5
"""mm below a tab's top; what a pointed cutter takes no deeper is narrower than it is looked at, and leaves most of it.
"""

_AT_WALL = 1e-6
"""mm; a tab's middle that is no farther from a wall lies on it, as where the path is on the lines."""


def cut_off_tabs(
    part: FlatPart, path: PathProbe, cutters: Iterable[Cutter], where: Callable[[int], str], lines: Sequence[int]
) -> Iterator[Finding]:
    """Yield the tabs across whose middle, or at whose end, something is cut below their top, so that they hold less
    than they were made for, or nothing.

    It counts where a part hangs on a tab, not waste.

    Args:
        path: all motions that cut, program coordinates.
        cutters: of these motions.
        where: says in words where the motion of a row is.
        lines: of each motion.
    """
    if not part.tabs:
        return
    across = _places_across(part, sure_spacing(cutters, _NOTCH))
    points = across - np.array(part.origin[:2])
    found = path.lowest(points.reshape(-1, 2))
    heights, motions = (each.reshape(across.shape[:2]) for each in found)
    tops = np.array([tab.top for tab in part.tabs]) - part.origin[2]
    deep = tops - heights.min(axis=1)
    off = np.flatnonzero(deep > part.tolerance)
    holds_part = np.array([tab.holds_part for tab in part.tabs])
    for counts in (True, False):
        some = off[holds_part[off] == counts]
        if len(some):
            k = int(some[np.argmax(deep[some])])
            place = int(np.argmin(heights[k]))
            motion, tab = int(motions[k, place]), part.tabs[k]
            told = _CutOff(len(some), float(tops[k]), float(heights[k, place]), where(motion), int(lines[motion]))
            yield told.finding((tab.x - part.origin[0], tab.y - part.origin[1]), counts)


class _CutOff(NamedTuple):
    """How many tabs are cut off, and of the worst of them: its top and how deep is cut across it or at its end, mm,
    program coordinates, and where in the program, in words and as a line.
    """

    tabs: int
    top: float
    height: float
    where: str
    line: int

    def finding(self, place: Sequence[float], counts: bool) -> Finding:
        """Return it in words, with the middle of the worst tab, mm."""
        x, y = place
        what = "1 tab does" if self.tabs == 1 else f"{self.tabs} tabs do"
        text = (
            f"{what} not stand, the worst at {in_plane(x, y)}: its top is at Z {self.top:.3f}, and {self.where} cuts "
            f"down to Z {self.height:.3f} across it or at its end. Give tabs at the same places to all "
            "operations that come there, or let one operation with a finish width go along the wall."
        )
        return Finding(FindingKind.TAB, text, x, y, counts, amount=self.top - self.height, line=self.line)


def _places_across(part: FlatPart, spacing: float) -> Floats:
    """Return of each tab places across the cut that it stands in, (tabs, n, 2) mm, part coordinates: from beyond its
    one end to beyond its other one, within it no farther apart than a spacing, mm.
    """
    middles = np.array([(tab.x, tab.y) for tab in part.tabs])
    radii = np.array([tab.diameter / 2 for tab in part.tabs])[:, None]
    count = max(_ACROSS, math.ceil(2 * _WITHIN * float(radii.max()) / spacing) + 1)
    within = radii * np.linspace(-_WITHIN, _WITHIN, count)
    along = np.hstack([-radii - _BEYOND, within, radii + _BEYOND])
    walls = _walls(part)
    distances, nearest = walls.nearest(middles)
    rows = walls.rows[nearest]
    normals = np.array([_normal(*each) for each in zip(rows, middles, distances.tolist(), strict=True)])
    places: Floats = middles[:, None] + along[:, :, None] * normals[:, None]
    return places


def _walls(part: FlatPart) -> DistanceField:
    """Return the walls along which operations of a part go; where nobody knows which, all of them."""
    followed = [
        area
        for operation, area in zip(part.job.operations, part.areas, strict=False)
        if operation.FOLLOWS_WALLS and operation.cut.enabled
    ] or [Area(part.regions, part.lines)]
    contours = [contour for area in followed for region in area.regions for contour in region.contours]
    contours += [line for area in followed for line in area.lines]
    return DistanceField.of(np.concatenate([within_half_turn(contour_rows(contour)) for contour in contours]))


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
