"""Gouges in a solid: how deep each place is, measured on the solid and on the motions themselves, not on the cells that
show it.

The cells tell where metal of the solid was cut away. At the centres of those that seem deepest the exact depth is
asked, points on the walls tell what lies between the cells, and from the deepest ones on it is climbed: the program's
height at any place, and the solid's distance there, are closed forms. So what is told is the depth of a place that was
cut; that nothing else is deeper by more than a cell's way, the certificate says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..model.motion import Floats
from ..simulation.field.target import frozen
from ..simulation.field.workpiece import Heights, Workpiece
from .clearance_kernels import told_apart
from .judgement import MOST, CellPlace, Spot, SpotKind
from .parts import SolidPart
from .solid_depth import CutColumns, DepthInSolid
from .wall_probe import Probe, WallProbe, stock_at

ASKED = 4000
"""Cells of a place that the solid is asked at, half of them those that seem deepest, the others spread; of all places
ten times as many.
"""

APART = 1.0
"""mm between gouges in walls that are told one by one."""

STARTS, NEAR = 12, 0.5
"""Places that the depth of the deepest gouge is climbed from, so far apart, mm; that of each other one from its own
deepest.
"""

ROUNDS, ROUNDS_OF_OTHERS, SIDE = 24, 12, 2
"""Times that the places round the best one so far are asked, on (2 SIDE + 1)² places, nearer and nearer."""


@dataclass(frozen=True, eq=False)
class SolidGouges:
    """What measures gouges in a solid.

    Attributes:
        part: the solid. lowest: gives the height that is cut down to, and by whom. before: the stock.
        heights: (rows, cols) that are left, on the stock's grid. gouged: which of the cells are. around: the solid, as
            in `TargetHeights`.
        lines: NC line of each motion.
        depths: gives what tells how deep places lie in the solid; asked where something is.
    """

    part: SolidPart
    lowest: Probe
    before: Workpiece
    heights: Heights
    gouged: NDArray[np.bool_]
    around: Heights
    lines: NDArray[np.int32]
    depths: Callable[[], DepthInSolid]

    def spots(self, places: Sequence[CellPlace], walls: WallProbe | None) -> list[Spot]:
        """Return the gouges with their depths, the deepest first.

        Args:
            places: of cells. walls: looks for what lies at walls between the cells; what it finds in places of cells is
                that place's.
        """
        home, most = self._homes(places), min(ASKED, max(64, 10 * ASKED // max(len(places), 10)))
        found = [self._of_cells(place, most) for place in places]
        depths = np.array([*(spot.depth_mm for spot in found), 0.0])  # the last one is that of no place
        if walls is not None:
            narrow = self._narrow(walls, lambda points: depths[self._home(home, points)])
            numbers = self._home(home, np.array([(spot.x, spot.y) for spot in narrow]).reshape(-1, 2)).tolist()
            for spot, number in zip(narrow, numbers, strict=True):
                if number < 0:
                    found.append(spot)
                elif spot.depth_mm > found[number].depth_mm:
                    found[number] = replace(spot, area_mm2=places[number].area_mm2, disc_mm=places[number].disc_mm)
        if not found:
            return []
        found.sort(key=lambda spot: -spot.depth_mm)
        found[:MOST] = [self._climbed(spot, np.array([(spot.x, spot.y)]), ROUNDS_OF_OTHERS) for spot in found[:MOST]]
        found.sort(key=lambda spot: -spot.depth_mm)
        found[0] = self._climbed(found[0], self._starts(found, places), ROUNDS)
        return [spot for spot in found if spot.depth_mm > self.part.tolerance]

    def _narrow(self, walls: WallProbe, deep: Callable[[Floats], Floats]) -> list[Spot]:
        """Return gouges in walls that are deeper than what is known round them, one within APART, the deepest first."""
        cut = walls.cut_places(deep)
        if not len(cut):
            return []
        columns, fine = CutColumns(cut.places, cut.heights, stock_at(self.before, cut.places)), self.part.tolerance / 10
        depth = self.depths().of(columns, fine=fine)
        self._measure(
            depth, columns, np.flatnonzero((depth <= self.part.tolerance) & (depth > self.part.tolerance - 2 * fine))
        )
        order = np.argsort(-depth, kind="stable")
        order = order[depth[order] > self.part.tolerance]
        reported = order[apart(cut.places[order])]
        self._measure(depth, columns, reported)
        return [
            self._spot(cut.places[k], float(cut.heights[k]), float(depth[k]), int(cut.motion[k]))
            for k in reported.tolist()
        ]

    def _measure(self, depth: Floats, columns: CutColumns, some: NDArray[np.int64]) -> None:
        """Measure the depths of some columns as finely as can be."""
        depth[some] = np.maximum(depth[some], self.depths().of(columns.only(some)))

    def _spot(self, place: Floats, z: float, depth: float, motion: int) -> Spot:
        line = int(self.lines[motion]) if motion >= 0 else 0
        return Spot(
            kind=SpotKind.GOUGE,
            x=float(place[0]),
            y=float(place[1]),
            z=z,
            depth_mm=depth,
            area_mm2=0.0,
            disc_mm=0.0,
            line=line,
            motion=motion,
        )

    def _homes(self, places: Sequence[CellPlace]) -> NDArray[np.int64]:
        """Return the number of the place of each cell, -1: none, with a cell round each place."""
        import cv2

        if not places:
            return np.full(self.gouged.shape, -1, np.int64)
        count, labels = cv2.connectedComponents(self.gouged.astype(np.uint8), connectivity=8)
        numbers = np.full(count, -1, np.int64)
        for number, place in enumerate(places):
            numbers[labels[place.cell]] = number
        return numbers[cv2.dilate(labels.astype(np.float32), np.ones((3, 3), np.uint8)).astype(np.int64)]

    def _home(self, home: NDArray[np.int64], points: Floats) -> NDArray[np.int64]:
        """Return the number of the place that each point (m, 2) lies in, -1: none."""
        grid = self.before.grid
        cols, rows = (
            np.floor((points[:, axis] - start) / grid.pitch).astype(np.int64)
            for axis, start in ((0, grid.x0), (1, grid.y0))
        )
        return home[np.clip(rows, 0, grid.rows - 1), np.clip(cols, 0, grid.cols - 1)]

    def _of_cells(self, place: CellPlace, most: int) -> Spot:
        """Return a place's deepest cell of those that are asked."""
        cells = self._asked(place, most)
        depth = self.depths().of(self._columns(cells), fine=self.part.tolerance / 10)
        worst = int(np.argmax(depth))
        at = np.array([self.before.grid.place(int(cells[worst]))])
        z, motion = self.lowest(at)
        spot = self._spot(
            at[0], float(min(z[0], self.heights.ravel()[cells[worst]])), float(depth[worst]), int(motion[0])
        )
        return replace(spot, area_mm2=place.area_mm2, disc_mm=place.disc_mm)

    def _asked(self, place: CellPlace, most: int) -> NDArray[np.int64]:
        """Return cells of a place: those that seem deepest by the cells round them, and others spread over it."""
        from ..simulation.field.judge_kernels import ways_out

        if len(place.cells) <= most:
            return place.cells
        seems = np.zeros(len(place.cells))
        ways_out(frozen(self.around), frozen(self.heights), place.cells, (self.before.grid.pitch, 0.0), seems)
        order = np.argsort(-seems, kind="stable")
        return np.unique(
            np.concatenate([place.cells[order[: most // 2]], place.cells[:: 1 + 2 * len(place.cells) // most]])
        )

    def _columns(self, cells: NDArray[np.int64]) -> CutColumns:
        """Return what was cut away over the centres of cells."""
        grid = self.before.grid
        rows, cols = np.divmod(cells, grid.cols)
        places = np.column_stack([grid.x0 + (cols + 0.5) * grid.pitch, grid.y0 + (rows + 0.5) * grid.pitch])
        return CutColumns(
            places, *(each.ravel()[cells].astype(np.float64) for each in (self.heights, self.before.heights))
        )

    def _starts(self, found: Sequence[Spot], places: Sequence[CellPlace]) -> Floats:
        """Return where to climb from (k, 2): the deepest spots, and cells that are nearly as deep as the deepest, apart
        from them.
        """
        best = found[0].depth_mm
        starts = [(spot.x, spot.y) for spot in found[:STARTS] if spot.depth_mm > best - 2 * self.before.grid.pitch]
        for place in places[:STARTS]:
            columns = self._columns(self._asked(place, ASKED // 4))
            depth = self.depths().of(columns, best - 2 * self.before.grid.pitch, self.part.tolerance)
            for k in np.argsort(-depth, kind="stable")[:ASKED].tolist():
                x, y = columns.places[k].tolist()
                if len(starts) >= 2 * STARTS or depth[k] < best - 2 * self.before.grid.pitch:
                    break
                if all(math.hypot(x - a, y - b) > NEAR for a, b in starts):
                    starts.append((x, y))
        return np.array(starts)

    def _climbed(self, spot: Spot, starts: Floats, rounds: int) -> Spot:
        """Return the deepest place that is found between the cells from some places (k, 2) on."""
        side = np.arange(-SIDE, SIDE + 1) / SIDE
        around = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
        places, reach, each = starts, self.before.grid.pitch, len(around)
        best = np.full(len(starts), -1.0)
        for _ in range(rounds):
            requested = (places[:, None] + around * reach).reshape(-1, 2)
            z, motion = self.lowest(requested)
            depth = self.depths().of(
                CutColumns(requested, np.where(motion >= 0, z, np.inf), stock_at(self.before, requested))
            )
            deepest = np.argmax(depth.reshape(-1, each), axis=1) + np.arange(len(places)) * each
            better = depth[deepest] > best
            places, best = np.where(better[:, None], requested[deepest], places), np.where(better, depth[deepest], best)
            k = int(deepest[int(np.argmax(depth[deepest]))])
            if depth[k] > spot.depth_mm:
                (x, y), row = requested[k].tolist(), int(motion[k])
                spot = replace(
                    spot, x=x, y=y, z=float(z[k]), depth_mm=float(depth[k]), motion=row, line=int(self.lines[row])
                )
            reach *= 0.6
        return spot


def apart(places: Floats) -> NDArray[np.int64]:
    """Return which of some places (m, 2), in order, are farther than APART from all of these before them."""
    cells = np.floor(places / APART).astype(np.int64)
    cells -= cells.min(axis=0, initial=0) - 1
    high = int(cells[:, 1].max(initial=0)) + 2
    squares, own = np.unique(cells[:, 0] * high + cells[:, 1], return_inverse=True)
    beside = squares[:, None] + np.array([dx * high + dy for dx in (-1, 0, 1) for dy in (-1, 0, 1)])
    at = np.minimum(np.searchsorted(squares, beside), len(squares) - 1)
    around = np.where(squares[at] == beside, at, -1)
    reported = np.empty(len(places), np.int64)
    return reported[
        : told_apart(np.ascontiguousarray(places), own.ravel(), np.ascontiguousarray(around), APART, reported)
    ]
