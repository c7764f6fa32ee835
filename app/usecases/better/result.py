"""What is asked of a better program, and what is known of one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from ...core.errors import InputError
from ...gcode.interpreter.dialect import Dialect
from ...model.motion import Floats
from ...model.part import Units
from ...model.scene import Scene
from ..cutting.cut import CELLS, CutProgram
from ..cutting.ready_setup import ReadySetup
from ..scene_program.nc import WrittenScene
from ..smoothing.result import OutputForm, SmoothedProgram
from ..tolerance_budget import ToleranceBudget
from .area import PassArea
from .comparison import CutComparison

TOLERANCES = (0.002, 5.0)
"""mm; what the tolerance may be."""
_EPSILONS = (0.02, 0.05)
"""Of the tolerance: what is one facet is tried; far less than facets are off, more than their points are off them."""
_DIGITS = 5.0
"""Last decimals of a program within which points of one facet lie at least."""


@dataclass(frozen=True)
class BetterOptions:
    """How a program is made better.

    Attributes:
        tolerance: by how much the new cut may differ from the old one, both ways, square to the surface, mm.
        epsilon: points so near to one plane are a facet, mm; None: what suits of a fiftieth and a
            twentieth of the tolerance.
        pitch: from pass to pass, mm; None: as the old passes.
        form: what curves are written as. cells: that cuts are compared on, along the longer side.
        post: by its name, in whose words the new program is; None: those of the old one's control.
        dialect: of the old program; None: as it looks. units: of one that names none; None: mm.
    """

    tolerance: float = 0.05
    epsilon: float | None = None
    pitch: float | None = None
    form: OutputForm = OutputForm.ARCS
    cells: int = CELLS
    post: str | None = None
    dialect: Dialect | None = None
    units: Units | None = None

    def __post_init__(self) -> None:
        if not TOLERANCES[0] <= self.tolerance <= TOLERANCES[1]:
            raise InputError(f"the tolerance is {self.tolerance:g} mm; use {TOLERANCES[0]:g} to {TOLERANCES[1]:g} mm.")

    def epsilons(self, digit: float) -> tuple[float, ...]:
        """Return how near to one plane points may be a facet, mm; `digit` is the last decimal of the program."""
        if self.epsilon is not None:
            return (self.epsilon,)
        return tuple(sorted({max(share * self.tolerance, _DIGITS * digit) for share in _EPSILONS}))


@dataclass(frozen=True, slots=True)
class SurfaceFigures:
    """What the smooth surfaces behind passes are.

    Attributes:
        passes: how many. places: of the program on them. cut_deeper: by other moves, so that they count for nothing.
        facets: how many there are. shape: of each surface how many places it goes by, and what they are.
        spans: of each surface. left_out_mm: how far places that a surface was not found by are from it.
        kept: places on no surface, which stay as they were. boundaries: places where passes go from one surface to
            the next. apart_mm: by how much two surfaces differ in height there at most.
    """

    passes: int
    places: int
    cut_deeper: int
    facets: int
    shape: tuple[tuple[int, str], ...]
    spans: tuple[tuple[int, int], ...]
    left_out_mm: float
    kept: int = 0
    boundaries: int = 0
    apart_mm: float = 0.0


class SmoothSurfaces(Protocol):
    """The smooth surfaces behind a program's passes."""

    @property
    def area(self) -> PassArea:
        """Where the passes are."""
        ...

    @property
    def farthest_mm(self) -> float:
        """How far a place of the program is from its surface at most, square to it, mm."""
        ...

    @property
    def farthest_place(self) -> Floats:
        """Where that is, (3,) mm, program coordinates."""
        ...

    @property
    def figures(self) -> SurfaceFigures:
        """What they are, in figures."""
        ...


@dataclass(frozen=True, slots=True)
class ProgramFigures:
    """What a program takes.

    Attributes:
        blocks: feed moves. length_mm: of them. time_s: on a usual machine.
        bend: largest change of direction within a pass, radians.
    """

    blocks: int
    length_mm: float
    time_s: float
    bend: float


@dataclass(frozen=True, eq=False)
class BetterProgram:
    """A program, and the better one that was made of it.

    Attributes:
        name: of the file that came in. options: what was asked. ready: how it was cut.
        old_cut, new_cut: what both leave of the same stock.
        smoothed: the surfaces between them. figures: of these and of the new passes. scene: the one surface that a ball
            touches, as a scene of its own; None where the passes were lifted. written: its passes before they were
            curves.
        curves: the certificate of these. data: the new text.
        comparison: of both cuts. old, new: what they take. budget: who spent what of the tolerance.
    """

    name: str
    options: BetterOptions
    ready: ReadySetup
    old_cut: CutProgram
    new_cut: CutProgram
    smoothed: SmoothSurfaces
    figures: SurfaceFigures
    scene: Scene | None
    written: WrittenScene | None
    curves: SmoothedProgram
    comparison: CutComparison
    old: ProgramFigures
    new: ProgramFigures
    budget: ToleranceBudget

    @property
    def data(self) -> bytes:
        """The new text."""
        return self.curves.data
