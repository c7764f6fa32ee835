"""Gouges in a solid's walls that are narrower than the cells: points just inside each wall are asked one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..model.finding import Finding, FindingKind
from ..model.motion import Floats
from ..simulation.field.solid import SolidStock
from ..simulation.field.solid_rays import SolidRays
from ..simulation.field.workpiece import Workpiece
from .judgement import Spot, SpotKind
from .parts import SolidPart

STEEP = 0.45
"""Z of a triangle's normal up to which it is a wall: 63 degrees and more."""

MOST_POINTS = 60_000
"""Points on all walls; where half a cell apart would be more, they lie farther apart, and narrower gouges may go unseen."""

HALVINGS = 12
"""How a gouge's end is found: from a quarter of a cell on twice as deep each time, until it is passed, then between the last two."""

ASIDE = 1e-4
"""mm from a wall at which its top is asked."""

Probe = Callable[[Floats], tuple[Floats, NDArray[np.int64]]]
"""Gives the height that is left at points (m, 2), and the motion that cut it, -1 = none."""


@dataclass(frozen=True, eq=False)
class WallProbe:
    """What a probe of walls needs.

    Attributes:
        part: whose walls. lowest: gives the height that is cut down to, and by whom.
        before: the stock; on its grid, half a cell apart, lie the points.
        lines: NC line of each motion.
    """

    part: SolidPart
    lowest: Probe
    before: Workpiece
    lines: NDArray[np.int32]

    def spots(self) -> Iterator[Spot]:
        """Yield the gouges at the walls, one for each point that is gouged, the deepest first.

        How far a gouge goes on straight into the solid is looked for as far as that reaches, so the search has no other end.
        """
        part, pitch = self.part, self.before.grid.pitch
        asking = _Asking(*wall_points(part.solid, pitch), self, SolidRays(part.solid))
        start = part.tolerance - part.leave
        heights, motion, gouged = asking.at(np.full(len(asking.points), start))
        if not gouged.any():
            return
        asking = asking.only(gouged)
        heights, motion = heights[gouged], motion[gouged]
        known, beyond = self._passed(asking, start)
        for _ in range(HALVINGS):
            middle = (known + beyond) / 2
            still = asking.at(middle)[2]
            known, beyond = np.where(still, middle, known), np.where(still, beyond, middle)
        places = asking.points + asking.inwards * known[:, None]
        for k in np.argsort(-known, kind="stable").tolist():
            x, y = places[k].tolist()
            depth_mm, line = float(known[k]) + part.leave, int(self.lines[motion[k]])
            yield Spot(SpotKind.GOUGE, x, y, float(heights[k]), depth_mm, 0.0, 0.0, line, int(motion[k]))

    def _passed(self, asking: _Asking, start: float) -> tuple[Floats, Floats]:
        """Return depths (m,) at which gouges still are, and deeper ones at which they are no more."""
        pitch, extent = self.before.grid.pitch, np.ptp(self.part.solid.triangles[..., :2].reshape(-1, 2), axis=0)
        known, beyond = np.full(len(asking.points), start), np.full(len(asking.points), np.nan)
        step, last = pitch / 4, float(np.hypot(*extent)) + abs(start)
        while (open_ := np.flatnonzero(np.isnan(beyond))).size:
            still = asking.only(open_).at(np.full(len(open_), start + step))[2] & (step < last)
            known[open_[still]], beyond[open_[~still]] = start + step, start + step
            step *= 2
        return known, beyond


@dataclass(frozen=True, eq=False)
class _Asking:
    """Points on walls, the way into the solid there, and whom to ask."""

    points: Floats
    inwards: Floats
    probe: WallProbe
    rays: SolidRays

    def only(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> _Asking:
        """Return some of the points."""
        return _Asking(self.points[chosen], self.inwards[chosen], self.probe, self.rays)

    def at(self, depth: Floats) -> tuple[Floats, NDArray[np.int64], NDArray[np.bool_]]:
        """Return the heights that are cut down to at depths (m,) in the solid, < 0 beside it, by whom, and whether that is a gouge."""
        places = self.points + self.inwards * depth[:, None]
        heights, motion = self.probe.lowest(places)
        wanted = self.rays.tops(self.points + self.inwards * np.maximum(depth, ASIDE)[:, None])
        metal = np.minimum(wanted, metal_at(self.probe.before, places))
        return heights, motion, (motion >= 0) & (heights < metal - self.probe.part.tolerance)


def metal_at(workpiece: Workpiece, places: Floats) -> Floats:
    """Return how high metal is at places (m, 2), mm; -infinite beside its grid."""
    grid, heights = workpiece.grid, workpiece.heights
    cols, rows = (np.floor((places[:, axis] - start) / grid.pitch).astype(np.int64) for axis, start in ((0, grid.x0), (1, grid.y0)))
    beside = (rows < 0) | (rows >= grid.rows) | (cols < 0) | (cols >= grid.cols)
    there = heights[np.clip(rows, 0, grid.rows - 1), np.clip(cols, 0, grid.cols - 1)].astype(np.float64)
    return np.where(beside, -np.inf, there)


def unseen_walls(part: SolidPart, pitch: float) -> Iterator[Finding]:
    """Yield the remark that a solid has more walls than are looked at half a cell apart, and where gouges may hide."""
    apart = _step(_walls(part.solid)[2], pitch)
    if apart > pitch / 2:
        text = (f"The walls of the solid are so long that they were asked every {apart:.3f} mm only, not every {pitch / 2:.3f} mm; gouges "
                "narrower than that may be unseen beside the cells; look at a part of it (--window).")
        yield Finding(FindingKind.TOLERANCE, text, counts=False, amount=apart)


def wall_points(solid: SolidStock, pitch: float) -> tuple[Floats, Floats]:
    """Return points (m, 2) on a solid's walls seen from above, half a cell apart, and the way into the solid there, of length 1."""
    (begin, end), inwards, length = _walls(solid)
    if not len(length):
        return np.zeros((0, 2)), np.zeros((0, 2))
    counts = np.maximum(1, np.ceil(length / _step(length, pitch))).astype(np.int64)
    owner = np.repeat(np.arange(len(length)), counts)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[owner]
    return begin[owner] + (end - begin)[owner] * share[:, None], inwards[owner]


def _step(length: Floats, pitch: float) -> float:
    """Return how far apart points on walls of some lengths lie, mm."""
    return max(pitch / 2, float(length.sum()) / MOST_POINTS)


def _walls(solid: SolidStock) -> tuple[tuple[Floats, Floats], Floats, Floats]:
    """Return of each triangle that is a wall both ends (n, 2) as seen from above, the way into the solid (n, 2), and its length (n,)."""
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
    return (begin, end), inwards, np.hypot(*(end - begin).T)
