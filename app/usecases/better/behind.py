"""The smooth surfaces behind a program's passes, one or several; what is far off them is refused with its place."""

from __future__ import annotations

from dataclasses import replace

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import Progress
from ...simulation.cutter import cutter_of
from .context import CHORD_SHARE, SMOOTHING_SHARE, BetterContext
from .pieces import CutCourse, SmoothedPieces, smooth_pieces
from .raster import RasterProgram, filled
from .result import SmoothSurfaces
from .surface import SmoothedSurface, smooth_surface, surviving
from .tracks import TrackedProgram, tracks_of


def surfaces_behind(context: BetterContext, progress: Progress) -> SmoothedSurface | SmoothedPieces:
    """Return the one smooth surface that straight passes of a ball lie on, else the several that any passes do.

    Raises:
        InputError: they are farther off than their share of the tolerance. Cancelled: the job was asked to stop.
    """
    tracked = tracks_of(context.name, context.program) if context.raster is None else None
    if tracked is not None:
        several = _pieces(context, tracked, progress)
        _ensure_within(context, several)
        return several
    assert context.raster is not None
    single = _surface(context, context.raster, progress.part(0.0, 0.5))
    if single.farthest_mm <= context.shares.facets:
        return single
    found = _pieces_or_none(context, tracks_of(context.name, context.program), progress.part(0.5, 1.0))
    if found is None or found.farthest_mm > single.farthest_mm:
        _ensure_within(context, single)
    assert found is not None  # else the one surface was refused
    _ensure_within(context, found)
    return found


def _surface(context: BetterContext, raster: RasterProgram, progress: Progress) -> SmoothedSurface:
    """Return the one smooth surface behind straight passes, without what others have cut deeper."""
    alive = surviving(raster, context.tool.radius, context.heights, context.options.tolerance)
    alive = replace(alive, raster=filled(alive.raster))
    return smooth_surface(alive, context.tool.radius, context.limits, progress)


def _pieces(context: BetterContext, tracked: TrackedProgram, progress: Progress) -> SmoothedPieces:
    """Return the smooth surfaces behind passes of any kind."""
    course = CutCourse(cutter_of(context.tool), context.heights)
    return smooth_pieces(context.name, tracked, course, context.limits, progress)


def _pieces_or_none(context: BetterContext, tracked: TrackedProgram, progress: Progress) -> SmoothedPieces | None:
    """Return the smooth surfaces behind passes; None where they cannot be told apart."""
    try:
        return _pieces(context, tracked, progress)
    except InputError:
        return None


def _ensure_within(context: BetterContext, smoothed: SmoothSurfaces) -> None:
    share = context.shares.facets
    if smoothed.farthest_mm <= share:
        return
    x, y, z = smoothed.farthest_place.tolist()
    spare = smoothed.farthest_mm / (1 - CHORD_SHARE - SMOOTHING_SHARE) * 1.02
    raise InputError(
        f"{context.name}: at X{x:.3f} Y{y:.3f} Z{z:.3f} the passes are {smoothed.farthest_mm:.4f} mm off the smooth "
        f"surface behind them, and facets may be {share:.4f} mm off; use "
        f"{option('tolerance', f'{spare:.2g}')} or more, or keep the program: a true edge is no facet."
    )
