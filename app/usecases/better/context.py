"""What a better program is made with: the program as it was read, its passes, its tool and stock, resolved once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import Progress
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.dialect_guess import guess_dialect
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts import Post, load_post
from ...model.motion import MotionKind
from ...model.tool import Tool
from ...model.tool_kind import ToolKind
from ...simulation.cutter import cutter_of
from ...simulation.sweeps.probe import PathProbe
from ...verify.course import course_of
from ..cutting.cut import CutOptions
from ..cutting.ready_setup import ReadySetup, SetupRequest, setup_of
from ..examine import ExaminedProgram, ExamineOptions, examine
from ..smoothing.source import usual_post
from .raster import RasterProgram, raster_of
from .result import BetterOptions
from .surface import FacetLimits
from .tracks import tracks_of

CHORD_SHARE, SMOOTHING_SHARE = 0.1, 0.15
"""Of the tolerance: what chords of new passes, and their curves, may spend."""


@dataclass(frozen=True, slots=True)
class ToleranceShares:
    """What each part of the way may spend, mm.

    Attributes:
        facets: from the surfaces to their triangles. chords: from the way over these to its points.
        smoothing: from the points to what is written for them. digits: from that to the decimals in the text.
    """

    facets: float
    chords: float
    smoothing: float
    digits: float

    @staticmethod
    def of(tolerance: float, digit: float) -> ToleranceShares:
        """Return the shares of a tolerance, mm, of a program whose last decimal is so much, mm."""
        chords, smoothing, digits = CHORD_SHARE * tolerance, SMOOTHING_SHARE * tolerance, 2 * digit
        return ToleranceShares(tolerance - chords - smoothing - digits, chords, smoothing, digits)


@dataclass(frozen=True, eq=False)
class BetterContext:
    """What a better program is made with, resolved once, before anything is computed.

    Attributes:
        name: of the old file. data: its bytes. options, request: as they were asked.
        examined: the old program. ready: what it is cut out of, and with what.
        tool: the one that cuts. raster: its passes, where they are straight and a ball's; else None.
        dialect: of the old program. post: in whose words the new program is; post_name: its name.
        digit: the last decimal of the old program, mm.
        shares: of the tolerance. look: how finely both programs are cut.
    """

    name: str
    data: bytes
    options: BetterOptions
    request: SetupRequest
    examined: ExaminedProgram
    ready: ReadySetup
    tool: Tool
    raster: RasterProgram | None
    dialect: Dialect
    post: Post
    post_name: str
    digit: float
    shares: ToleranceShares
    look: CutOptions

    @property
    def program(self) -> NcProgram:
        """The old program, anchored."""
        return self.ready.setup.programs[0]

    @property
    def limits(self) -> FacetLimits:
        """What may be a facet, and how far facets may be off."""
        return FacetLimits(self.options.epsilons(self.digit), self.shares.facets)

    @cached_property
    def heights(self) -> PathProbe:
        """What the old program leaves, at any place."""
        cutters = {number: cutter_of(each) for number, each in self.ready.setup.tools.items()}
        return PathProbe.of([course_of(self.program).course], cutters)


def resolved(
    name: str, data: bytes, options: BetterOptions, request: SetupRequest, progress: Progress
) -> BetterContext:
    """Return what a better program is made with."""
    examined = examine(name, data, ExamineOptions(options.dialect, units=options.units), progress.part(0.0, 0.3))
    ready = setup_of((examined,), request, progress.part(0.3, 0.5))
    tool = _only_tool(name, ready)
    dialect = options.dialect or guess_dialect(data)
    post_name = options.post or usual_post(dialect)
    post = load_post(post_name)
    digit = _digit(post, ready.setup.programs[0])
    shares, look = ToleranceShares.of(options.tolerance, digit), CutOptions(options.cells, trace=False)
    raster = _straight_passes(name, ready.setup.programs[0]) if tool.kind is ToolKind.BALL else None
    tracked = None if raster is not None else tracks_of(name, ready.setup.programs[0])
    if tracked is not None and options.pitch is not None:
        raise InputError(
            f"{name}: a pitch is for straight passes of a ball; these are lifted where they are. Leave "
            f"{option('pitch')} out."
        )
    return BetterContext(
        name, data, options, request, examined, ready, tool, raster, dialect, post, post_name, digit, shares, look
    )


def _straight_passes(name: str, program: NcProgram) -> RasterProgram | None:
    """Return straight passes beside one another; None where the program's are others."""
    try:
        return raster_of(name, program)
    except InputError:
        return None


def _digit(post: Post, program: NcProgram) -> float:
    """Return the last decimal of an axis word, mm."""
    units = program.states[-1].units
    return float(10.0 ** -post.digits(units).X * units.value)


def _only_tool(name: str, ready: ReadySetup) -> Tool:
    """Return the only tool that cuts."""
    program = ready.setup.programs[0]
    states = np.unique(program.motions.state[program.motions.kind != MotionKind.RAPID])
    used = {program.states[k].tool for k in states.tolist()}
    if len(used) != 1:
        raise InputError(
            f"{name}: {len(used)} tools cut; a program that can be made better is the passes of one. Take the others "
            f"apart, and give what they leave with {option('stock', 'HEIGHTS.npy')}."
        )
    return ready.setup.tools[used.pop()]
