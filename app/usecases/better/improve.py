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
from ..cutting.cut import CutOptions, CutProgram, cut
from ..cutting.ready_setup import ReadySetup, SetupRequest, setup_of
from ..examine import ExaminedProgram, ExamineOptions, examine
from ..scene.compute import compute
from ..scene_program.nc import WrittenScene, write_scene_nc
from ..smoothing.result import SmoothedProgram, SmoothOptions
from ..smoothing.smooth import smooth
from ..smoothing.source import usual_post
from ..tolerance_budget import BudgetShare, Evidence, ToleranceBudget
from .comparison import compared
from .raster import RasterProgram, filled, raster_of
from .result import BetterOptions, BetterProgram, ProgramFigures
from .surface import FacetLimits, NewPasses, SmoothedSurface, scene_of, smooth_surface, surviving, usual_pitch

_CHORD, _SMOOTHING = 0.1, 0.15
"""Of the tolerance: what chords of new passes, and their curves, may spend."""

_AS_USUAL, _AS_TOLD = BetterOptions(), SetupRequest()


def better(
    name: str,
    data: bytes,
    options: BetterOptions = _AS_USUAL,
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
    context = _resolved(name, data, options, request, progress.part(0.0, 0.1))
    old_cut = cut(context.ready.setup, context.look, progress.part(0.1, 0.3))
    smoothed = _surface_behind(context, progress.part(0.3, 0.4))
    scene = _scene_with_passes(context, smoothed, old_cut)
    written = write_scene_nc(compute(scene, sources_of(_no_file), progress.part(0.4, 0.55)), progress.part(0.55, 0.7))
    curves = _curves(context, written, progress.part(0.7, 0.85))
    again = _cut_again(context, curves, progress.part(0.85, 1.0))
    return BetterProgram(
        name,
        options,
        context.ready,
        old_cut,
        again.cut,
        smoothed,
        scene,
        written,
        curves,
        compared(old_cut.cut.workpiece, again.cut.cut.workpiece, smoothed),
        _figures(context.examined, context.program, _bend_of_passes(context.raster)),
        _figures(again.examined, again.program, max((piece.after.bend for piece in curves.pieces), default=0.0)),
        _budget(options.tolerance, context.shares, smoothed, written, curves),
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


@dataclass(frozen=True, eq=False)
class _BetterContext:
    """What a better program is made with, resolved once, before anything is computed.

    Attributes:
        name: of the old file. options, request: as they were asked.
        examined: the old program. ready: what it is cut out of, and with what.
        tool: the one ball that cuts. raster: its passes.
        post: in whose words the new program is; post_name: its name. digit: the last decimal of the old program, mm.
        shares: of the tolerance. look: how finely both programs are cut.
    """

    name: str
    options: BetterOptions
    request: SetupRequest
    examined: ExaminedProgram
    ready: ReadySetup
    tool: Tool
    raster: RasterProgram
    post: Post
    post_name: str
    digit: float
    shares: _Shares
    look: CutOptions

    @property
    def program(self) -> NcProgram:
        """The old program, anchored."""
        return self.ready.setup.programs[0]


def _resolved(
    name: str, data: bytes, options: BetterOptions, request: SetupRequest, progress: Progress
) -> _BetterContext:
    """Return what a better program is made with."""
    examined = examine(name, data, ExamineOptions(options.dialect), progress.part(0.0, 0.3))
    ready = setup_of((examined,), request, progress.part(0.3, 0.5))
    tool, raster = _ball(name, ready), raster_of(name, ready.setup.programs[0])
    post_name = options.post or usual_post(options.dialect or guess_dialect(data))
    post = load_post(post_name)
    digit = _digit(post, ready.setup.programs[0])
    shares, look = _Shares.of(options.tolerance, digit), CutOptions(options.cells, trace=False)
    return _BetterContext(name, options, request, examined, ready, tool, raster, post, post_name, digit, shares, look)


def _surface_behind(context: _BetterContext, progress: Progress) -> SmoothedSurface:
    """Return the smooth surface behind the passes, without what others have cut deeper.

    Raises:
        InputError: facets are farther off it than their share of the tolerance.
    """
    cutters = {number: cutter_of(each) for number, each in context.ready.setup.tools.items()}
    probe = PathProbe.of([course_of(context.program).course], cutters)
    alive = surviving(context.raster, context.tool.radius, probe, context.options.tolerance)
    alive = replace(alive, raster=filled(alive.raster))
    limits = FacetLimits(context.options.epsilons(context.digit), context.shares.facets)
    smoothed = smooth_surface(alive, context.tool.radius, limits, progress)
    _ensure_within(context.name, smoothed, context.shares)
    return smoothed


def _scene_with_passes(context: _BetterContext, smoothed: SmoothedSurface, old_cut: CutProgram) -> Scene:
    """Return the surface with new passes over it, of the old ones' feed and speed."""
    pitch = context.options.pitch or usual_pitch(smoothed.raster)
    passes = NewPasses(pitch, context.shares.chords, context.post_name)
    scene = scene_of(_stem(context.name), smoothed, context.tool, _block(old_cut), passes)
    return _with_feeds(scene, context.raster, context.program)


def _curves(context: _BetterContext, written: WrittenScene, progress: Progress) -> SmoothedProgram:
    """Return the new passes as curves, proven on their own text."""
    post, [file] = context.post, written.files
    options = SmoothOptions(context.shares.smoothing, context.options.form, post=post, dialect=post.dialect)
    return smooth(context.name, file.nc.text.encode(), options, progress)


@dataclass(frozen=True, eq=False)
class _NewCut:
    """The new program as it was read back, and what it leaves of the old one's stock."""

    examined: ExaminedProgram
    cut: CutProgram

    @property
    def program(self) -> NcProgram:
        """The new program, anchored."""
        return self.cut.setup.programs[0]


def _cut_again(context: _BetterContext, curves: SmoothedProgram, progress: Progress) -> _NewCut:
    """Read the new text back, and cut it out of the old one's stock with the old one's tool, whatever its number."""
    examined = examine(context.name, curves.data, ExamineOptions(context.post.dialect))
    ready = setup_of((examined,), replace(context.request, stock=context.ready.setup.stock))
    tools = {number: replace(context.tool, number=each.number) for number, each in ready.setup.tools.items()}
    return _NewCut(examined, cut(replace(ready.setup, tools=tools), context.look, progress))


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


def _stem(name: str) -> str:
    return name.rpartition(".")[0] or name


def _no_file(name: str) -> bytes:
    raise InputError(f"{name} is no part of the scene.")


def _bend_of_passes(raster: RasterProgram) -> float:
    """Return the largest change of direction within a pass, radians."""
    return max(of_points(row, row[[0, -1]]).bend for row in raster.rows if len(row) > 2)


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
