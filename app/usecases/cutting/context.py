"""A setup made ready to be cut: what each program is cut along, the cutters, the metal."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from ...core.effort import Reckoning
from ...core.progress import Progress
from ...model.motion import Floats
from ...model.stock_box import StockBox
from ...simulation.cutter import Cutter, cutter_of
from ...simulation.engines import Engine, Graphics, hardware
from ...simulation.field.workpiece import Grid, Heights, Workpiece, ensure_memory
from ...simulation.sweeps.course import TrimOptions
from ...simulation.sweeps.probe import LowestReach, PathProbe
from ...simulation.sweeps.trim import trim
from ...verify.course import KnownCourse, course_of
from ...verify.parts import FlatPart, SolidPart
from .effort import cut_effort
from .setup import CutOptions, CutSetup

TRIM_BYTES_A_CELL, BYTES_A_CELL = 18, 64
"""What cutting alone takes, and with judging: heights, owners, bounds, wanted heights, masks, labels."""


@dataclass(frozen=True, eq=False)
class CutContext:
    """What is cut, resolved once.

    Attributes:
        setup, options: as they were asked.
        courses: what each program is cut along, without what nobody knows.
        cutters: by T number.
        workpiece: the metal before it is cut.
        graphics: what computes heights where the options ask for it.
    """

    setup: CutSetup
    options: CutOptions
    courses: tuple[KnownCourse, ...]
    cutters: Mapping[int, Cutter]
    workpiece: Workpiece
    graphics: Graphics

    @staticmethod
    def of(setup: CutSetup, options: CutOptions, graphics: Graphics) -> CutContext:
        """Return a setup made ready.

        Raises:
            HitofudeError: a tool makes no shape, or there are more cells than memory holds.
        """
        grid = Grid.over(options.window or setup.stock.box, options.cells)
        ensure_memory(grid, BYTES_A_CELL if setup.part is not None and options.judge else TRIM_BYTES_A_CELL)
        cutters = {n: cutter_of(tool) for n, tool in setup.tools.items()}
        courses = tuple(course_of(program) for program in setup.programs)
        return CutContext(setup, options, courses, cutters, setup.stock.over(grid), graphics)

    @property
    def closely(self) -> bool:
        """Whether a solid is looked at between the cells, too; of surfaces the cells tell enough."""
        part = self.setup.part
        return self.options.judge and isinstance(part, SolidPart) and part.block is None

    @property
    def engine(self) -> Engine:
        """Which engine's heights are wanted."""
        if self.options.engine is not Engine.AUTO:
            return self.options.engine
        return Engine.GPU if self.options.stop is None and hardware(self.graphics) else Engine.CPU

    def effort(self) -> Reckoning:
        """Return how long cutting and judging will take."""
        judged = self.options.judge and self.setup.part is not None
        drawn = judged and isinstance(self.setup.part, FlatPart)
        return cut_effort(self.setup.programs, self.setup.tools, self.workpiece.grid.pitch, drawn, judged)

    def box(self) -> StockBox:
        """Return the box round all of the stock, program coordinates; of a window nobody knows how high the rest is."""
        x0, y0, x1, y1 = self.setup.stock.box
        top = float(self.workpiece.heights.max()) if self.options.window is None else math.inf
        return StockBox(x0, y0, self.workpiece.floor, x1, y1, top)

    def trimmed(self, cutters: Mapping[int, Cutter], options: TrimOptions, progress: Progress) -> Heights:
        """Return what all programs leave when they are cut with other cutters."""
        workpiece, count = self.workpiece, len(self.courses)
        for k, known in enumerate(self.courses):
            share = progress.part(k / count, (k + 1) / count)
            workpiece = trim(workpiece, known.course, cutters, options, share).workpiece
        return workpiece.heights

    @cached_property
    def _path(self) -> PathProbe:
        """All that the programs cut along, to be asked at single points; made when somebody asks."""
        return PathProbe.of([known.course for known in self.courses], self.cutters)

    def lowest(self, points: Floats) -> LowestReach:
        """Return the lowest height that all programs reach at points; motions are counted through all of them."""
        return self._path.lowest(points)
