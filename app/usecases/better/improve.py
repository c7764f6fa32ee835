"""`hitofude better`: a program of passes over a surface becomes a better one.

    heights of B -> facets of D -> surface of C -> new passes -> certificate of E -> heights of B again

Nothing of the way is believed at its end: the text that is handed out is read back and cut out of the same stock as the
old one, and the two cuts are compared cell by cell, both ways.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...core.errors import InputError
from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.smoothness import of_points
from ...formats.scene.toml import sources_of
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.dialect_guess import guess_dialect
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts import Post, load_post
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
from .area import PassArea
from .comparison import compared
from .lifted import lifted_text
from .pieces import CutCourse, SmoothedPieces, smooth_pieces
from .raster import RasterProgram, filled, raster_of
from .result import BetterOptions, BetterProgram, ProgramFigures, SmoothSurfaces, SurfaceFigures
from .surface import FacetLimits, NewPasses, SmoothedSurface, scene_of, smooth_surface, surviving, usual_pitch
from .tracks import tracks_of

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
    """Return a better program in place of one that goes over surfaces in passes beside one another.

    Straight passes of a ball over one surface are made anew over what it touches. All others, of any cutter, fanned,
    bent or spiral, or over several surfaces, are lifted onto the smooth surfaces of the tip.

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
    made = _passes_anew(context, old_cut, progress.part(0.3, 0.7))
    curves = _curves(context, made, progress.part(0.7, 0.85))
    again = _cut_again(context, curves, progress.part(0.85, 1.0))
    area = made.smoothed.area
    return BetterProgram(
        name,
        options,
        context.ready,
        old_cut,
        again.cut,
        made.smoothed,
        made.figures,
        made.scene,
        made.written,
        curves,
        compared(old_cut.cut.workpiece, again.cut.cut.workpiece, area),
        _figures(context.examined, context.program, _bend_of_passes(area)),
        _figures(again.examined, again.program, max((piece.after.bend for piece in curves.pieces), default=0.0)),
        _budget(options.tolerance, context.shares, made, curves),
    )


@dataclass(frozen=True, eq=False)
class _NewPasses:
    """Passes over the smooth surfaces, before they are curves.

    Attributes:
        smoothed: the surfaces. figures: of these and the passes. text: the program with the passes in it; dialect: its
            control's. chords: what chords of passes spend of the tolerance.
        scene, written: of passes that were made over what a ball touches.
    """

    smoothed: SmoothSurfaces
    figures: SurfaceFigures
    text: bytes
    dialect: Dialect
    chords: BudgetShare
    scene: Scene | None = None
    written: WrittenScene | None = None


def _passes_anew(context: _BetterContext, old_cut: CutProgram, progress: Progress) -> _NewPasses:
    """Return new passes: over what a ball touches where its passes are straight and lie on one surface, else lifted.

    Raises:
        InputError: facets are farther off smooth surfaces than their share of the tolerance.
    """
    if context.raster is None:
        found = _pieces_behind(context, progress.part(0.0, 0.7))
        _ensure_within(context, found)
        return _lifted(context, found, progress.part(0.7, 1.0))
    single = _surface_behind(context, context.raster, progress.part(0.0, 0.3))
    if single.farthest_mm <= context.shares.facets:
        return _over_one_surface(context, single, old_cut, progress.part(0.3, 1.0))
    several = _pieces_or_none(context, progress.part(0.3, 0.7))
    if several is None or several.farthest_mm > single.farthest_mm:
        _ensure_within(context, single)
    assert several is not None  # else the one surface was refused
    _ensure_within(context, several)
    return _lifted(context, several, progress.part(0.7, 1.0))


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
    shares: _Shares
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


def _resolved(
    name: str, data: bytes, options: BetterOptions, request: SetupRequest, progress: Progress
) -> _BetterContext:
    """Return what a better program is made with."""
    examined = examine(name, data, ExamineOptions(options.dialect), progress.part(0.0, 0.3))
    ready = setup_of((examined,), request, progress.part(0.3, 0.5))
    tool = _only_tool(name, ready)
    dialect = options.dialect or guess_dialect(data)
    post_name = options.post or usual_post(dialect)
    post = load_post(post_name)
    digit = _digit(post, ready.setup.programs[0])
    shares, look = _Shares.of(options.tolerance, digit), CutOptions(options.cells, trace=False)
    raster = _straight_passes(name, ready.setup.programs[0]) if tool.kind is ToolKind.BALL else None
    tracked = None if raster is not None else tracks_of(name, ready.setup.programs[0])
    if tracked is not None and options.pitch is not None:
        raise InputError(
            f"{name}: a pitch is for straight passes of a ball; these are lifted where they are. Leave --pitch out."
        )
    return _BetterContext(
        name, data, options, request, examined, ready, tool, raster, dialect, post, post_name, digit, shares, look
    )


def _straight_passes(name: str, program: NcProgram) -> RasterProgram | None:
    """Return straight passes beside one another; None where the program's are others."""
    try:
        return raster_of(name, program)
    except InputError:
        return None


def _surface_behind(context: _BetterContext, raster: RasterProgram, progress: Progress) -> SmoothedSurface:
    """Return the one smooth surface behind straight passes, without what others have cut deeper."""
    alive = surviving(raster, context.tool.radius, context.heights, context.options.tolerance)
    alive = replace(alive, raster=filled(alive.raster))
    return smooth_surface(alive, context.tool.radius, context.limits, progress)


def _pieces_behind(context: _BetterContext, progress: Progress) -> SmoothedPieces:
    """Return the smooth surfaces behind passes of any kind."""
    tracked = tracks_of(context.name, context.program)
    course = CutCourse(cutter_of(context.tool), context.heights)
    return smooth_pieces(context.name, tracked, course, context.limits, progress)


def _pieces_or_none(context: _BetterContext, progress: Progress) -> SmoothedPieces | None:
    """Return the smooth surfaces behind passes; None where they cannot be told apart."""
    try:
        return _pieces_behind(context, progress)
    except InputError:
        return None


def _over_one_surface(
    context: _BetterContext, smoothed: SmoothedSurface, old_cut: CutProgram, progress: Progress
) -> _NewPasses:
    """Return new passes over what a ball touches, of the old ones' feed and speed, proven to go into it nowhere."""
    pitch = context.options.pitch or usual_pitch(smoothed.raster)
    passes = NewPasses(pitch, context.shares.chords, context.post_name)
    scene = scene_of(_stem(context.name), smoothed, context.tool, _block(old_cut), passes)
    scene = _with_feeds(scene, smoothed.raster, context.program)
    written = write_scene_nc(compute(scene, sources_of(_no_file), progress.part(0.0, 0.5)), progress.part(0.5, 1.0))
    [file], chords = written.files, context.shares.chords
    evidence = Evidence.PROVEN if len(written.unproven) == 0 else Evidence.MEASURED
    share = BudgetShare("chords", chords, chords, evidence, "new passes above the surface; none deeper than 0.0001 mm")
    text, dialect = file.nc.text.encode(), context.post.dialect
    return _NewPasses(smoothed, smoothed.figures, text, dialect, share, scene, written)


def _lifted(context: _BetterContext, smoothed: SmoothedPieces, progress: Progress) -> _NewPasses:
    """Return the program's own passes, lifted onto the smooth surfaces; all else stays as it was."""
    lifted = lifted_text(context.data, context.dialect, smoothed, context.shares.chords, progress)
    share = BudgetShare(
        "chords",
        context.shares.chords,
        lifted.chord_mm,
        Evidence.PROVEN,
        "each chord of lifted passes beside its surface, by the greatest second derivative between both ends",
    )
    figures = replace(
        smoothed.figures, boundaries=len(lifted.boundaries), apart_mm=float(lifted.apart.max(initial=0.0))
    )
    return _NewPasses(smoothed, figures, lifted.data, context.dialect, share)


def _curves(context: _BetterContext, made: _NewPasses, progress: Progress) -> SmoothedProgram:
    """Return the new passes as curves, proven on their own text."""
    options = SmoothOptions(context.shares.smoothing, context.options.form, post=context.post, dialect=made.dialect)
    return smooth(context.name, made.text, options, progress)


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


def _only_tool(name: str, ready: ReadySetup) -> Tool:
    """Return the only tool that cuts."""
    program = ready.setup.programs[0]
    states = np.unique(program.motions.state[program.motions.kind != MotionKind.RAPID])
    used = {program.states[k].tool for k in states.tolist()}
    if len(used) != 1:
        raise InputError(
            f"{name}: {len(used)} tools cut; a program that can be made better is the passes of one. Take the others "
            "apart, and give what they leave with --stock HEIGHTS.npy."
        )
    return ready.setup.tools[used.pop()]


def _ensure_within(context: _BetterContext, smoothed: SmoothSurfaces) -> None:
    share = context.shares.facets
    if smoothed.farthest_mm <= share:
        return
    x, y, z = smoothed.farthest_place.tolist()
    spare = smoothed.farthest_mm / (1 - _CHORD - _SMOOTHING) * 1.02
    raise InputError(
        f"{context.name}: at X{x:.3f} Y{y:.3f} Z{z:.3f} the passes are {smoothed.farthest_mm:.4f} mm off the smooth "
        f"surface behind them, and facets may be {share:.4f} mm off; use --tolerance {spare:.2g} or more, or keep the "
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


def _bend_of_passes(area: PassArea) -> float:
    """Return the largest change of direction within a pass, radians."""
    return max(of_points(line, line[[0, -1]]).bend for line in area.lines if len(line) > 2)


def _budget(tolerance: float, shares: _Shares, made: _NewPasses, curves: SmoothedProgram) -> ToleranceBudget:
    """Return who spent what."""
    return ToleranceBudget(
        tolerance,
        (
            BudgetShare(
                "facets",
                shares.facets,
                made.smoothed.farthest_mm,
                Evidence.MEASURED,
                "every place of the old passes beside the smooth surface",
            ),
            made.chords,
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
