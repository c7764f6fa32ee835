"""`hitofude better`: a program of passes over a surface becomes a better one.

    heights of B -> facets of D -> surface of C -> new passes -> certificate of E -> heights of B again

Nothing of the way is believed at its end: the text that is handed out is read back and cut out of the same stock as the
old one, and the two cuts are compared cell by cell, both ways.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.smoothness import of_points
from ...formats.scene.toml import sources_of
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.dialect_guess import guess_dialect
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts.post import Post
from ...gcode.posts.posts import load_post
from ...model.motion import MotionKind
from ...model.motion_path import lengths
from ...model.scene import Scene
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...model.tool_kind import ToolKind
from ...simulation.cutter import cutter_of
from ...simulation.sweeps.probe import PathProbe
from ...verify.course import course_of
from ..cut import CELLS, CutOptions, CutProgram, cut
from ..examine import ExaminedProgram, ExamineOptions, examine
from ..setup import ReadySetup, SetupRequest, setup_of
from ..smooth import OutputForm, SmoothedProgram, SmoothOptions, smooth
from ..smooth_source import usual_post
from ..surface import compute
from ..surface_nc import WrittenScene, write_scene_nc
from ..tolerance_budget import BudgetShare, Evidence, ToleranceBudget
from .comparison import CutComparison, compared
from .raster import RasterProgram, filled, raster_of
from .surface import FacetLimits, NewPasses, SmoothedSurface, scene_of, smooth_surface, surviving, usual_pitch

TOLERANCES = (0.002, 5.0)
"""mm; what the tolerance may be."""
_CHORD, _SMOOTHING = 0.1, 0.15
"""Of the tolerance: what chords of new passes, and their curves, may spend."""
_EPSILONS = (0.02, 0.05)
"""Of the tolerance: what is one facet is tried; far less than facets are off, more than their points are off them."""
_DIGITS = 5.0
"""Last decimals of a program within which points of one facet lie at least."""

_AS_TOLD = SetupRequest()


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
        dialect: of the old program; None: as it looks.
    """

    tolerance: float = 0.05
    epsilon: float | None = None
    pitch: float | None = None
    form: OutputForm = OutputForm.ARCS
    cells: int = CELLS
    post: str | None = None
    dialect: Dialect | None = None

    def __post_init__(self) -> None:
        if not TOLERANCES[0] <= self.tolerance <= TOLERANCES[1]:
            raise InputError(f"the tolerance is {self.tolerance:g} mm; use {TOLERANCES[0]:g} to {TOLERANCES[1]:g} mm.")

    def epsilons(self, digit: float) -> tuple[float, ...]:
        """Return how near to one plane points may be a facet, mm; `digit` is the last decimal of the program."""
        if self.epsilon is not None:
            return (self.epsilon,)
        return tuple(sorted({max(share * self.tolerance, _DIGITS * digit) for share in _EPSILONS}))


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
        smoothed: the surface between them. scene: as a scene of its own. written: its passes before they were curves.
        curves: the certificate of these. data: the new text.
        comparison: of both cuts. old, new: what they take. budget: who spent what of the tolerance.
    """

    name: str
    options: BetterOptions
    ready: ReadySetup
    old_cut: CutProgram
    new_cut: CutProgram
    smoothed: SmoothedSurface
    scene: Scene
    written: WrittenScene
    curves: SmoothedProgram
    comparison: CutComparison
    old: ProgramFigures
    new: ProgramFigures
    budget: ToleranceBudget

    @property
    def data(self) -> bytes:
        """The new text."""
        return self.curves.data


def better(
    name: str,
    data: bytes,
    options: BetterOptions = BetterOptions(),
    request: SetupRequest = _AS_TOLD,
    progress: Progress = NO_PROGRESS,
) -> BetterProgram:
    """Return a better program in place of one that goes over a surface in passes beside one another.

    Args:
        name: of the file, for messages. data: its bytes.
        options: tolerance and form. request: tools and stock that the program does not tell of itself.
        progress: told of how much is done.

    Raises:
        InputError: the program cannot be read, is no such program, or the tolerance does not hold its facets.
        HitofudeError: something cannot be computed. Cancelled: the job was asked to stop.
    """
    examined = examine(name, data, ExamineOptions(options.dialect), progress.part(0.0, 0.03))
    ready = setup_of((examined,), request, progress.part(0.03, 0.05))
    program, tool = ready.setup.programs[0], _ball(name, ready)
    raster = raster_of(name, program)
    post_name = options.post or usual_post(options.dialect or guess_dialect(data))
    post = load_post(post_name)
    digit = _digit(post, program)
    looked = CutOptions(options.cells, trace=False)
    old_cut = cut(ready.setup, looked, progress.part(0.1, 0.3))
    cutters = {number: cutter_of(each) for number, each in ready.setup.tools.items()}
    probe = PathProbe.of([course_of(program).course], cutters)
    alive = surviving(raster, tool.radius, probe, options.tolerance)
    alive = replace(alive, raster=filled(alive.raster))
    shares = _Shares.of(options.tolerance, digit)
    limits = FacetLimits(options.epsilons(digit), shares.facets)
    smoothed = smooth_surface(alive, tool.radius, limits, progress.part(0.3, 0.4))
    _ensure_within(name, smoothed, shares)
    how = NewPasses(options.pitch or usual_pitch(alive.raster), shares.chords, post_name)
    scene = _with_feeds(scene_of(_stem(name), smoothed, tool, _block(old_cut), how), raster, program)
    computed = compute(scene, sources_of(_no_file), progress.part(0.4, 0.55))
    written = write_scene_nc(computed, progress.part(0.55, 0.7))
    [file] = written.files
    asked = SmoothOptions(shares.smoothing, options.form, post=post, dialect=post.dialect)
    curves = smooth(name, file.nc.text.encode(), asked, progress.part(0.7, 0.85))
    again = examine(name, curves.data, ExamineOptions(post.dialect))
    anew = setup_of((again,), replace(request, stock=ready.setup.stock))
    new_cut = cut(replace(anew.setup, tools=_same(anew, tool)), looked, progress.part(0.85, 1.0))
    comparison = compared(old_cut.cut.workpiece, new_cut.cut.workpiece, smoothed)
    budget = _budget(options.tolerance, shares, smoothed, written, curves)
    rows = max(of_points(row, row[[0, -1]]).bend for row in raster.rows if len(row) > 2)
    bend = max((piece.after.bend for piece in curves.pieces), default=0.0)
    old, new = _figures(examined, program, rows), _figures(again, anew.setup.programs[0], bend)
    return BetterProgram(
        name,
        options,
        ready,
        old_cut,
        new_cut,
        smoothed,
        scene,
        written,
        curves,
        comparison,
        old,
        new,
        budget,
    )


@dataclass(frozen=True, slots=True)
class _Shares:
    """What each part of the way may spend, mm."""

    facets: float
    chords: float
    smoothing: float
    digits: float

    @staticmethod
    def of(tolerance: float, digit: float) -> _Shares:
        chords, smoothing, digits = _CHORD * tolerance, _SMOOTHING * tolerance, 2 * digit
        return _Shares(tolerance - chords - smoothing - digits, chords, smoothing, digits)


def _digit(post: Post, program: NcProgram) -> float:
    """Return the last decimal of an axis word, mm."""
    units = program.states[-1].units
    return float(10.0 ** -post.digits(units).X * units.value)


def _ball(name: str, ready: ReadySetup) -> Tool:
    """Return the only tool, which has to be a ball."""
    program = ready.setup.programs[0]
    states = np.unique(program.motions.state[program.motions.kind != MotionKind.RAPID])
    used = {program.states[k].tool for k in states.tolist()}
    if len(used) != 1:
        raise InputError(
            f"{name}: {len(used)} tools cut; a program that can be made better is the passes of one. Take the others "
            "apart, and give what they leave with --stock HEIGHTS.npy."
        )
    tool = ready.setup.tools[used.pop()]
    if tool.kind is not ToolKind.BALL:
        raise InputError(
            f"{name}: T{tool.number} is a {tool.kind.value} tool; only a ball's passes tell where it touched a "
            "surface. Use smooth, which takes any tool."
        )
    return tool


def _ensure_within(name: str, smoothed: SmoothedSurface, shares: _Shares) -> None:
    if smoothed.farthest_mm <= shares.facets:
        return
    at = int(np.argmax(np.abs(smoothed.off)))
    x, y, z = smoothed.raster.frame.outwards(smoothed.raster.points[at : at + 1])[0].tolist()
    spare = smoothed.farthest_mm / (1 - _CHORD - _SMOOTHING) * 1.02
    raise InputError(
        f"{name}: at X{x:.3f} Y{y:.3f} Z{z:.3f} the passes are {smoothed.farthest_mm:.4f} mm off the smooth surface "
        f"behind them, and facets may be {shares.facets:.4f} mm off; use --tolerance {spare:.2g} or more, or keep the "
        "program: a true edge is no facet."
    )


def _with_feeds(scene: Scene, raster: RasterProgram, program: NcProgram) -> Scene:
    """Return the scene with the feed and the speed of the old passes, in the program's units."""
    state = program.states[int(program.motions.state[np.flatnonzero(program.motions.kind == MotionKind.LINE)[-1]])]
    [passes], [tool] = scene.passes, scene.tools
    speed = state.speed if state.speed > 0 and not state.constant_surface else tool.spindle_speed
    tool = replace(tool, feed_rate=raster.feed, spindle_speed=speed, plunge_rate=min(tool.plunge_rate, raster.feed))
    return replace(scene, passes=(passes,), tools=(tool,), out_units=state.units)


def _block(done: CutProgram) -> StockBox:
    x0, y0, x1, y1 = done.setup.stock.box
    return StockBox(x0, y0, done.floor, x1, y1, done.top)


def _same(ready: ReadySetup, tool: Tool) -> dict[int, Tool]:
    """Return the tools of a new program's setup: the one tool, whatever its number is there."""
    return {number: replace(tool, number=each.number) for number, each in ready.setup.tools.items()}


def _stem(name: str) -> str:
    return name.rpartition(".")[0] or name


def _no_file(name: str) -> bytes:
    raise InputError(f"{name} is no part of the scene.")


def _budget(
    tolerance: float, shares: _Shares, smoothed: SmoothedSurface, written: WrittenScene, curves: SmoothedProgram
) -> ToleranceBudget:
    """Return who spent what."""
    proven = len(written.unproven) == 0
    return ToleranceBudget(
        tolerance,
        (
            BudgetShare(
                "facets",
                shares.facets,
                smoothed.farthest_mm,
                Evidence.MEASURED,
                "every point of the old passes beside the smooth surface",
            ),
            BudgetShare(
                "chords",
                shares.chords,
                shares.chords,
                Evidence.PROVEN if proven else Evidence.MEASURED,
                "new passes above the surface; none deeper than 0.0001 mm",
            ),
            BudgetShare(
                "smoothing", shares.smoothing, curves.bound, Evidence.PROVEN, "curves beside passes, as written"
            ),
            BudgetShare("digits", shares.digits, shares.digits, Evidence.PROVEN, "two steps of the last decimal"),
        ),
    )


def _figures(examined: ExaminedProgram, program: NcProgram, bend: float) -> ProgramFigures:
    motions = program.motions
    far = lengths(motions)
    fed = motions.kind != MotionKind.RAPID
    known = np.where(np.isfinite(far), far, 0.0)
    return ProgramFigures(
        int(fed.sum()),
        float(known[fed].sum()),
        examined.time.total,
        bend if math.isfinite(bend) else 0.0,
    )
