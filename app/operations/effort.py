"""How long a job will take to compute, before it is computed: from the areas, lengths and counts of its contours.

Seconds a piece are measured (squares, outlines of 2,000 lines, 100 to 1,600 circles, with tools of 0.5 to 6 mm); what
is computed and what proves it are counted together.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..geometry.outlines import Outlines
from ..model.operation import Operation
from ..model.part import Region
from ..model.tool import Tool

CONTOUR_S, ISLAND_S = 0.007, 0.02
"""A contour with a region of its own: entry, chaining, order. One inside a region: what is left is looked for beside
all of its walls.
"""

TILE_S = 5e-5
"""A piece of floor as long as the tool is wide and as wide as a step: whether it is covered is proven for each."""

PIECE_S = 1.4e-4
"""A line or arc of a ring: offset, linked, written, read back, measured."""

PASS_S = 1.4e-5
"""The same line or arc at one more depth."""


@dataclass(frozen=True, slots=True)
class Workload:
    """What the contours of a job come to.

    Attributes:
        area: of the regions, mm2. length: of their walls, mm.
        pieces: lines and arcs of the walls. regions, islands: how many there are.
    """

    area: float = 0.0
    length: float = 0.0
    pieces: int = 0
    regions: int = 0
    islands: int = 0

    @property
    def depth(self) -> float:
        """How far the middle is from the walls, mm, as in a square; in a strip it is half of that."""
        return 2.0 * self.area / self.length if self.length > 0 else 0.0


def workload_of(regions: Sequence[Region]) -> Workload:
    """Return what some regions come to."""
    walls = Outlines.of([contour for region in regions for contour in region.contours])
    return Workload(
        abs(float(walls.areas.sum())),
        float(walls.lengths.sum()),
        len(walls.rows),
        len(regions),
        len(walls) - len(regions),
    )


def along_walls(extent: Workload, operation: Operation, tool: Tool) -> float:
    """Return what paths along the walls take, s."""
    return extent.pieces * (PIECE_S + PASS_S * (_passes(operation) - 1))


def over_area(extent: Workload, operation: Operation, tool: Tool, step: float) -> float:
    """Return what paths over the whole area take, `step` mm beside one another, s.

    Rings have fewer lines and arcs the farther in they are: half of the walls' on the average.
    """
    tiles = extent.area / (step * tool.diameter)
    pieces = extent.pieces * extent.depth / step / 2
    return tiles * TILE_S + pieces * (PIECE_S + PASS_S * (_passes(operation) - 1))


def _passes(operation: Operation) -> int:
    return max(1, math.ceil(operation.cut.depth / operation.cut.stepdown - 1e-9))
