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
from ...gcode.interpreter.options import PATIENT, ReadOptions
from ...gcode.interpreter.program import NcProgram
from ...model.motion import MotionKind
from ...model.motion_path import lengths
from ...model.scene import Scene
from ...model.stock_box import StockBox
from ..cutting.cut import CutProgram, cut
from ..cutting.ready_setup import SetupRequest, setup_of
from ..examine import ExaminedProgram, ExamineOptions, examine
from ..scene.compute import compute
from ..scene_program.nc import WrittenScene, write_scene_nc
from ..smoothing.result import SmoothedProgram, SmoothOptions
from ..smoothing.smooth import smooth
from ..tolerance_budget import BudgetShare, Evidence, ToleranceBudget
from .area import PassArea
from .behind import surfaces_behind
from .comparison import compared
from .context import BetterContext, ToleranceShares, resolved
from .lifted import lifted_text
from .pieces import SmoothedPieces
from .raster import RasterProgram
from .result import BetterOptions, BetterProgram, ProgramFigures, SmoothSurfaces, SurfaceFigures
from .surface import NewPasses, SmoothedSurface, scene_of, usual_pitch

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
    context = resolved(name, data, options, request, progress.part(0.0, 0.1))
    found = surfaces_behind(context, progress.part(0.1, 0.4))
    old_cut = cut(context.ready.setup, context.look, progress.part(0.4, 0.55))
    made = _passes_anew(context, found, old_cut, progress.part(0.55, 0.7))
    curves = _curves(context, made, progress.part(0.7, 0.85))
    again = _cut_again(context, curves, progress.part(0.85, 1.0))
    area = made.smoothed.area
    return BetterProgram(
        name=name,
        options=options,
        ready=context.ready,
        old_cut=old_cut,
        new_cut=again.cut,
        smoothed=made.smoothed,
        figures=made.figures,
        scene=made.scene,
        written=made.written,
        curves=curves,
        comparison=compared(old_cut.cut.workpiece, again.cut.cut.workpiece, area),
        old=_figures(context.examined, context.program, _bend_of_passes(area)),
        new=_figures(again.examined, again.program, max((piece.after.bend for piece in curves.pieces), default=0.0)),
        budget=_budget(options.tolerance, context.shares, made, curves),
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


def _passes_anew(
    context: BetterContext, found: SmoothedSurface | SmoothedPieces, old_cut: CutProgram, progress: Progress
) -> _NewPasses:
    """Return new passes: over what a ball touches where its passes are straight and lie on one surface, else lifted."""
    if isinstance(found, SmoothedPieces):
        return _lifted(context, found, progress)
    return _over_one_surface(context, found, old_cut, progress)


def _over_one_surface(
    context: BetterContext, smoothed: SmoothedSurface, old_cut: CutProgram, progress: Progress
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


def _lifted(context: BetterContext, smoothed: SmoothedPieces, progress: Progress) -> _NewPasses:
    """Return the program's own passes, lifted onto the smooth surfaces; all else stays as it was."""
    reading = ReadOptions(context.dialect, limits=PATIENT, units=context.options.units)
    lifted = lifted_text(context.data, reading, smoothed, context.shares.chords, progress)
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


def _curves(context: BetterContext, made: _NewPasses, progress: Progress) -> SmoothedProgram:
    """Return the new passes as curves, proven on their own text."""
    asked = context.options
    options = SmoothOptions(
        context.shares.smoothing, asked.form, post=context.post, dialect=made.dialect, units=asked.units
    )
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


def _cut_again(context: BetterContext, curves: SmoothedProgram, progress: Progress) -> _NewCut:
    """Read the new text back, and cut it out of the old one's stock with the old one's tool, whatever its number."""
    examined = examine(context.name, curves.data, ExamineOptions(context.post.dialect, units=context.options.units))
    ready = setup_of((examined,), replace(context.request, stock=context.ready.setup.stock))
    tools = {number: replace(context.tool, number=each.number) for number, each in ready.setup.tools.items()}
    return _NewCut(examined, cut(replace(ready.setup, tools=tools), context.look, progress))


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


def _budget(tolerance: float, shares: ToleranceShares, made: _NewPasses, curves: SmoothedProgram) -> ToleranceBudget:
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
