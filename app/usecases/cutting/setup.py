"""What is cut out of what, and how finely one looks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...gcode.interpreter.program import NcProgram
from ...model.tool import Tool
from ...simulation.engines import Engine
from ...simulation.field.workpiece import StockShape
from ...verify.exact import ExactDeviations
from ...verify.parts import FlatPart, Part

CELLS = 1024
"""Along the stock's longer side, as on the text's screen."""


@dataclass(frozen=True, eq=False)
class CutSetup:
    """What is cut out of what, with what, to become what.

    Attributes:
        programs: of each file, at least one, in the order of cutting, anchored (`app.model.motion.anchored`).
        tools: by T number; 0 stands for the tool of a program that names none.
        stock: the metal, program coordinates.
        part: what is to come out; None = nobody has said.
        names: of the programs' files.
    """

    programs: tuple[NcProgram, ...]
    tools: Mapping[int, Tool]
    stock: StockShape
    part: Part | None = None
    names: tuple[str, ...] = ()

    def where(self, motion: int) -> str:
        """Return words for the place of a motion, counted through all programs; of several programs also which one."""
        ends = np.cumsum([len(program.motions) for program in self.programs])
        file = int(np.searchsorted(ends, motion, "right"))
        line = f"NC line {int(self.lines()[motion])}"
        if len(self.programs) == 1:
            return line
        return f"{line} of {self.names[file] if self.names else f'program {file + 1}'}"

    def measured(self, exact: ExactDeviations) -> CutSetup:
        """Return the setup with what is known to be cleared of its drawing."""
        if exact.coverage is None or not isinstance(self.part, FlatPart):
            return self
        return replace(self, part=replace(self.part, floors=exact.coverage.targets))

    def lines(self) -> NDArray[np.int32]:
        """Return the line of each motion of all programs, in its own file."""
        return np.concatenate([program.motions.line for program in self.programs])

    def numbers(self) -> NDArray[np.int32]:
        """Return the T number of each motion of all programs."""
        return np.concatenate([_tool_numbers(program) for program in self.programs])


@dataclass(frozen=True, slots=True)
class CutOptions:
    """How finely to look.

    Attributes:
        cells: along the longer side of the stock, or of the window.
        window: x0, y0, x1, y1, mm: only this part of the stock; None = all of it.
        trace: note who cut each cell last, and what each motion took.
        judge: measure on the motions and certify, and look on the whole stock for what goes wrong on the way; else the
            cells alone are compared with the part, which is quick.
        engine: whose heights are shown, judged and written; what only the engine of record can tell it tells beside
            them. A look that is neither traced nor judged is graphics hardware's alone under AUTO; then nobody tells of
            rapids in metal.
        stop: motions from this one on, counted through all files, are not done; None = all are. The engine of record
            tells alone then.
        facet: size of the facets of the published engine, mm; None = about two cells.
    """

    cells: int = CELLS
    window: tuple[float, float, float, float] | None = None
    trace: bool = True
    judge: bool = True
    engine: Engine = Engine.AUTO
    stop: int | None = None
    facet: float | None = None


def _tool_numbers(program: NcProgram) -> NDArray[np.int32]:
    return np.array([state.tool for state in program.states], np.int32)[program.motions.state]
