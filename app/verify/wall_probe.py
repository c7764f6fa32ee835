"""Gouges in a solid's walls that are narrower than the cells: points just inside each wall are asked one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.options import option
from ..model.finding import Finding, FindingKind
from ..model.motion import Floats
from ..simulation.field.solid import SolidStock
from ..simulation.field.triangle_tree import TriangleTree
from ..simulation.field.workpiece import Workpiece
from ..simulation.sweeps.probe import LowestReach
from .parts import SolidPart

STEEP = 0.45
"""Z of a triangle's normal up to which it is a wall: 63 degrees and more."""

MOST_POINTS = 60_000
"""Points on all walls; where half a cell apart would be more, they lie farther apart, and narrower gouges may go
unseen.
"""

STRIDES = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
"""Of a cell: how far on a gouge in a wall is followed straight into the solid; farther in the cells show it."""

HALVINGS = 12
"""How a gouge's end is found between the last place where it was and the first where it is no more."""

ASIDE = 1e-4
"""mm from a wall at which its top is asked."""

FINER = 0.1
"""Of the tolerance: a gouge that is deeper than what is known by less is not looked at."""

Probe = Callable[[Floats], LowestReach]
"""Gives the height that is left at points (m, 2)."""


@dataclass(frozen=True, eq=False)
class CutPlaces:
    """Places in a solid that were cut.

    Attributes:
        places: (m, 2) x, y, mm. heights: (m,) that are cut down to there. motion: (m,) by whom.
    """

    places: Floats
    heights: Floats
    motion: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.heights)


@dataclass(frozen=True, eq=False)
class WallProbe:
    """What a probe of walls needs.

    Attributes:
        part: whose walls. lowest: gives the height that is cut down to, and by whom.
        before: the stock; on its grid, half a cell apart, lie the points.
    """

    part: SolidPart
    lowest: Probe
    before: Workpiece

    def cut_places(self, deep: Callable[[Floats], Floats]) -> CutPlaces:
        """Return places in the walls that were cut, and may be deeper than what is known near them.

        From a point that is gouged the gouge is followed straight into the solid, without a step over what was not cut,
        to its end or to the end of `STRIDES`; both that place and the one half way are returned. How deep they lie is
        for the solid to say.

        Args:
            deep: gives how deep a gouge round points (m, 2) is known to be, stock to leave counted, mm, >= 0: what is
                no deeper than that is left out, as no place is deeper than it lies in from the wall, nor than it lies
                below the top over it.
        """
        part, start = self.part, self.part.tolerance - self.part.leave
        asking = _WallPoints(*wall_points(part.solid, self.before.grid.pitch), self, part.solid.tree)
        asking = asking.only(asking.gouged(np.full(len(asking.points), start)))
        known = np.maximum(deep(asking.points) - part.leave + FINER * part.tolerance, start)
        some = asking.gouged(known, np.maximum(known, start))
        asking, known = asking.only(some), known[some]
        end = self._followed(asking, known)
        places = np.concatenate(
            [asking.points + asking.inwards * each[:, None] for each in (end, (known + end) / 2, end / 2)]
        )
        heights, motion = self.lowest(places)
        cut = motion >= 0
        return CutPlaces(places[cut], heights[cut], motion[cut])

    def _followed(self, asking: _WallPoints, start: Floats) -> Floats:
        """Return depths (m,) at which gouges still are that are at others (m,); where they end sooner than `STRIDES`,
        their end.
        """
        known, beyond, pitch = start.copy(), np.full(len(start), np.nan), self.before.grid.pitch
        for stride in STRIDES:
            open_ = np.flatnonzero(np.isnan(beyond))
            still = asking.only(open_).gouged(start[open_] + stride * pitch)
            known[open_[still]] = start[open_[still]] + stride * pitch
            beyond[open_[~still]] = start[open_[~still]] + stride * pitch
        passed = np.flatnonzero(~np.isnan(beyond))
        asking, low, high = asking.only(passed), known[passed], beyond[passed]
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            still = asking.gouged(middle)
            low, high = np.where(still, middle, low), np.where(still, high, middle)
        known[passed] = low
        return known


@dataclass(frozen=True, eq=False)
class _WallPoints:
    """Points on walls, the way into the solid there, and whom to ask.

    Attributes:
        points: (n, 3), mm. inwards: (n, 3), of length 1.
    """

    points: Floats
    inwards: Floats
    probe: WallProbe
    tree: TriangleTree

    def only(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> _WallPoints:
        """Return some of the points."""
        return _WallPoints(self.points[chosen], self.inwards[chosen], self.probe, self.tree)

    def gouged(self, depth: Floats, over: Floats | float = 0.0) -> NDArray[np.bool_]:
        """Return whether the solid was cut at depths (m,) in it, < 0 beside it, deeper than its tolerance, and `over`
        below its top.
        """
        if not len(depth):
            return np.zeros(0, np.bool_)
        places, part = self.points + self.inwards * depth[:, None], self.probe.part
        heights, motion = self.probe.lowest(places)
        target = self.tree.tops(self.points + self.inwards * np.maximum(depth, ASIDE)[:, None])
        stock = np.minimum(target, stock_at(self.probe.before, places))
        return np.asarray((motion >= 0) & (heights < stock - part.tolerance) & (heights < target - over))


def stock_at(workpiece: Workpiece, places: Floats) -> Floats:
    """Return how high metal is at places (m, 2), mm; -infinite beside its grid."""
    grid, heights = workpiece.grid, workpiece.heights
    cols, rows = (
        np.floor((places[:, axis] - start) / grid.pitch).astype(np.int64)
        for axis, start in ((0, grid.x0), (1, grid.y0))
    )
    beside = (rows < 0) | (rows >= grid.rows) | (cols < 0) | (cols >= grid.cols)
    there = heights[np.clip(rows, 0, grid.rows - 1), np.clip(cols, 0, grid.cols - 1)].astype(np.float64)
    return np.where(beside, -np.inf, there)


def unseen_walls(part: SolidPart, pitch: float) -> Iterator[Finding]:
    """Yield the remark that a solid has more walls than are looked at half a cell apart, and where gouges may hide."""
    apart = _step(_walls(part.solid).length, pitch)
    if apart > pitch / 2:
        text = (
            f"The walls of the solid are so long that they were asked every {apart:.3f} mm only, not every "
            f"{pitch / 2:.3f} mm; gouges narrower than that may be unseen beside the cells; look at a part of it "
            f"({option('window')})."
        )
        yield Finding(FindingKind.TOLERANCE, text, counts=False, amount=apart)


def wall_points(solid: SolidStock, pitch: float) -> tuple[Floats, Floats]:
    """Return points (m, 2) on a solid's walls seen from above, half a cell apart, and the way into the solid there, of
    length 1.
    """
    begin, end, inwards, length = _walls(solid)
    if not len(length):
        return np.zeros((0, 2)), np.zeros((0, 2))
    counts = np.maximum(1, np.ceil(length / _step(length, pitch))).astype(np.int64)
    owner = np.repeat(np.arange(len(length)), counts)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[owner]
    return begin[owner] + (end - begin)[owner] * share[:, None], inwards[owner]


def _step(length: Floats, pitch: float) -> float:
    """Return how far apart points on walls of some lengths lie, mm."""
    return max(pitch / 2, float(length.sum()) / MOST_POINTS)


class _WallTriangles(NamedTuple):
    """Walls as seen from above: both ends (n, 2), the way into the solid (n, 2), length (n,), mm."""

    begin: Floats
    end: Floats
    inwards: Floats
    length: Floats


def _walls(solid: SolidStock) -> _WallTriangles:
    """Return the triangles that are walls."""
    a, b, c = np.moveaxis(solid.triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    size = np.linalg.norm(normal, axis=1)
    wall = (size > 0) & (np.abs(normal[:, 2]) < STEEP * size)
    corners, normal = solid.triangles[wall], normal[wall]
    inwards = -normal[:, :2] / np.hypot(normal[:, 0], normal[:, 1])[:, None]
    along = np.column_stack([-inwards[:, 1], inwards[:, 0]])
    spread = np.einsum("ijk,ik->ij", corners[..., :2], along)
    each = np.arange(len(corners))
    begin, end = corners[each, np.argmin(spread, axis=1), :2], corners[each, np.argmax(spread, axis=1), :2]
    return _WallTriangles(begin, end, inwards, np.hypot(*(end - begin).T))
