"""An NC program made ready for the film of text B: its stock and its tools as its head tells them, or as is said."""

from __future__ import annotations

from ...core.progress import NO_PROGRESS, Progress
from ...simulation.cutter import cutter_of
from ...usecases.cutting.ready_setup import SetupRequest, setup_of
from ...usecases.cutting.setup_stock import box_stock
from ...usecases.cutting.setup_tools import ToolSource
from ...usecases.examine import ExaminedProgram, examine
from ...verify.course import course_of
from .dexels import CutFilmInput
from .making import FilmSource

AS_THE_HEAD_TELLS = SetupRequest()


def input_of(source: FilmSource, progress: Progress = NO_PROGRESS) -> CutFilmInput:
    """Return what the film of a file cuts, with the tools and the stock that are known of it.

    Raises:
        HitofudeError: it cannot be read, or nobody tells what its tools are.
        Cancelled: the job was asked to stop.
    """
    tools = (ToolSource("the Cut view", source.tools),) if source.tools else ()
    stock = box_stock(source.stock) if source.stock is not None else None
    examined = examine(source.name, source.data, source.reading, progress.part(0.0, 0.8))
    return _cut_input(examined, None, SetupRequest(tools, stock=stock), progress.part(0.8, 1.0))


def program_input(
    source: FilmSource,
    facet: float | None = None,
    progress: Progress = NO_PROGRESS,
    told: SetupRequest = AS_THE_HEAD_TELLS,
) -> CutFilmInput:
    """Return what a film of a program cuts.

    Args:
        source: the program, and how it is read; its own tools and stock are not asked.
        facet: size of the facets, mm; None: twice the distance of the dexels.
        told: stock and tools that its head does not tell of.

    Raises:
        HitofudeError: it cannot be read, or nobody tells what its tools are.
        Cancelled: the job was asked to stop.
    """
    examined = examine(source.name, source.data, source.reading, progress.part(0.0, 0.8))
    return _cut_input(examined, facet, told, progress.part(0.8, 1.0))


def _cut_input(examined: ExaminedProgram, facet: float | None, told: SetupRequest, progress: Progress) -> CutFilmInput:
    ready = setup_of((examined,), told, progress)
    cutters = {number: cutter_of(tool) for number, tool in ready.setup.tools.items()}
    return CutFilmInput(examined.name, course_of(ready.setup.programs[0]).course, cutters, ready.setup.stock, facet)
