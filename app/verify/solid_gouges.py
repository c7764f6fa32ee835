"""Gouges in a solid: how deep each place is, measured on the solid and on the motions themselves, not on the cells that show it.

The cells tell where metal of the solid was cut away. At the centres of those that seem deepest the exact depth is asked, and from the
deepest ones on it is climbed between the cells: the program's height at any place, and the solid's distance there, are closed forms.
So what is told is the depth of a place that was cut; that nothing else is deeper by more than a cell's way, the certificate says.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..model.motion import Floats
from ..simulation.field.target import frozen
from ..simulation.field.workpiece import Heights, Workpiece
from .judgement import Spot, SpotKind
from .parts import SolidPart
from .places import CellPlace
from .solid_depth import Columns, DepthInSolid
from .wall_probe import metal_at

ASKED = 4000
"""Cells of a place that the solid is asked at, half of them those that seem deepest, the others spread; of all places ten times as many."""

STARTS, APART = 12, 0.5
"""Places that the depth is climbed from, so far apart, mm."""

ROUNDS, SIDE = 24, 2
"""Times that the places round the best one so far are asked, on (2 SIDE + 1)² places, nearer and nearer."""

Probe = Callable[[Floats], tuple[Floats, NDArray[np.int64]]]
"""Gives the height that is left at places (m, 2), and the motion that cut it, -1 = none."""


@dataclass(frozen=True, eq=False)
class SolidGouges:
    """What measures gouges in a solid.

    Attributes:
        part: the solid. lowest: gives the height that is cut down to, and by whom. before: the stock.
        heights: (rows, cols) that are left, on the stock's grid. gouged: which of the cells are. around: the solid, as in `Target`.
        lines: NC line of each motion.
    """

    part: SolidPart
    lowest: Probe
    before: Workpiece
    heights: Heights
    gouged: NDArray[np.bool_]
    around: Heights
    lines: NDArray[np.int32]

    def spots(self, places: Sequence[CellPlace], narrow: Sequence[Spot]) -> list[Spot]:
        """Return the gouges with their depths, the deepest first.

        Args:
            places: of cells. narrow: at walls, places between the cells; those that lie in a place of cells are that place's.
        """
        if not places and not narrow:
            return []
        depth_in = DepthInSolid(self.part.solid, self.part.leave)
        told = list(self._exact(narrow, depth_in))
        home = self._homes(places)
        found = []
        budget = max(64, 10 * ASKED // max(len(places), 10))
        for number, place in enumerate(places):
            own = [spot for spot in told if self._home(home, spot) == number]
            best = self._of_cells(place, depth_in, min(ASKED, budget))
            best = max([best, *own], key=lambda spot: spot.depth_mm)
            found.append(replace(best, area_mm2=place.area_mm2, disc_mm=place.disc_mm))
        found += [spot for spot in told if self._home(home, spot) < 0]
        found.sort(key=lambda spot: -spot.depth_mm)
        if found:
            found[0] = self._climbed(found[0], self._starts(found, places, depth_in), depth_in)
        return [spot for spot in found if spot.depth_mm > self.part.tolerance]

    def _exact(self, narrow: Sequence[Spot], depth_in: DepthInSolid) -> Iterator[Spot]:
        if not narrow:
            return
        places = np.array([(spot.x, spot.y) for spot in narrow])
        columns = Columns(places, np.array([spot.z for spot in narrow]), metal_at(self.before, places))
        for spot, depth in zip(narrow, depth_in.of(columns).tolist(), strict=True):
            yield replace(spot, depth_mm=depth)

    def _homes(self, places: Sequence[CellPlace]) -> NDArray[np.int64]:
        """Return the number of the place of each cell, -1: none, with a cell round each place."""
        import cv2

        count, labels = cv2.connectedComponents(self.gouged.astype(np.uint8), connectivity=8)
        numbers = np.full(count, -1, np.int64)
        for number, place in enumerate(places):
            numbers[labels[place.cell]] = number
        return numbers[cv2.dilate(labels.astype(np.float32), np.ones((3, 3), np.uint8)).astype(np.int64)]

    def _home(self, home: NDArray[np.int64], spot: Spot) -> int:
        grid = self.before.grid
        row, col = int((spot.y - grid.y0) / grid.pitch), int((spot.x - grid.x0) / grid.pitch)
        return int(home[min(max(row, 0), grid.rows - 1), min(max(col, 0), grid.cols - 1)])

    def _of_cells(self, place: CellPlace, depth_in: DepthInSolid, most: int) -> Spot:
        """Return a place's deepest cell of those that are asked."""
        cells = self._asked(place, most)
        depth = depth_in.of(self._columns(cells), fine=self.part.tolerance / 10)
        worst = int(np.argmax(depth))
        cell, grid = int(cells[worst]), self.before.grid
        x, y = grid.place(cell)
        z, motion = self.lowest(np.array([[x, y]]))
        line = int(self.lines[motion[0]]) if motion[0] >= 0 else 0
        return Spot(SpotKind.GOUGE, x, y, float(min(z[0], self.heights.ravel()[cell])), float(depth[worst]), 0.0, 0.0, line, int(motion[0]))

    def _asked(self, place: CellPlace, most: int) -> NDArray[np.int64]:
        """Return cells of a place: those that seem deepest by the cells round them, and others spread over it."""
        from ..simulation.field.judge_kernels import ways_out

        if len(place.cells) <= most:
            return place.cells
        seems = np.zeros(len(place.cells))
        ways_out(frozen(self.around), frozen(self.heights), place.cells, (self.before.grid.pitch, 0.0), seems)
        order = np.argsort(-seems, kind="stable")
        return np.unique(np.concatenate([place.cells[order[: most // 2]], place.cells[:: 1 + 2 * len(place.cells) // most]]))

    def _columns(self, cells: NDArray[np.int64]) -> Columns:
        """Return what was cut away over the centres of cells."""
        grid = self.before.grid
        rows, cols = np.divmod(cells, grid.cols)
        places = np.column_stack([grid.x0 + (cols + 0.5) * grid.pitch, grid.y0 + (rows + 0.5) * grid.pitch])
        return Columns(places, *(each.ravel()[cells].astype(np.float64) for each in (self.heights, self.before.heights)))

    def _starts(self, found: Sequence[Spot], places: Sequence[CellPlace], depth_in: DepthInSolid) -> Floats:
        """Return where to climb from (k, 2): the deepest spots, and cells that are nearly as deep as the deepest, apart from them."""
        best = found[0].depth_mm
        starts = [(spot.x, spot.y) for spot in found[:STARTS] if spot.depth_mm > best - 2 * self.before.grid.pitch]
        for place in places[:STARTS]:
            columns = self._columns(self._asked(place, ASKED // 4))
            depth = depth_in.of(columns, best - 2 * self.before.grid.pitch, self.part.tolerance)
            for k in np.argsort(-depth, kind="stable")[:ASKED].tolist():
                x, y = columns.places[k].tolist()
                if len(starts) >= 2 * STARTS or depth[k] < best - 2 * self.before.grid.pitch:
                    break
                if all(math.hypot(x - a, y - b) > APART for a, b in starts):
                    starts.append((x, y))
        return np.array(starts)

    def _climbed(self, spot: Spot, starts: Floats, depth_in: DepthInSolid) -> Spot:
        """Return the deepest place that is found between the cells from some places on."""
        side = np.arange(-SIDE, SIDE + 1) / SIDE
        around = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
        places, reach, each = starts, self.before.grid.pitch, len(around)
        best = np.full(len(starts), -1.0)
        for _ in range(ROUNDS):
            asked = (places[:, None] + around * reach).reshape(-1, 2)
            z, motion = self.lowest(asked)
            depth = depth_in.of(Columns(asked, np.where(motion >= 0, z, np.inf), metal_at(self.before, asked)))
            deepest = np.argmax(depth.reshape(-1, each), axis=1) + np.arange(len(places)) * each
            better = depth[deepest] > best
            places, best = np.where(better[:, None], asked[deepest], places), np.where(better, depth[deepest], best)
            k = int(deepest[int(np.argmax(depth[deepest]))])
            if depth[k] > spot.depth_mm:
                (x, y), row = asked[k].tolist(), int(motion[k])
                spot = replace(spot, x=x, y=y, z=float(z[k]), depth_mm=float(depth[k]), motion=row, line=int(self.lines[row]))
            reach *= 0.6
        return spot
