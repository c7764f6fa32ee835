"""One's own program for the film of text B and for figure 11: with the tools that it tells of, or that Cut was told. No
Qt.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.errors import InputError
from ....core.options import without_options
from ....core.progress import Progress

if TYPE_CHECKING:
    from ....exhibits.films.dexels import CutFilmInput
    from ....exhibits.films.making import FilmSource


def own_cut(source: FilmSource, progress: Progress) -> CutFilmInput:
    """Return what a program cuts; on the worker's thread.

    Raises:
        HitofudeError: it cannot be read; or nobody tells what its tools are, then with where to say it.
        Cancelled: the job was asked to stop.
    """
    from ....exhibits.films.program_input import input_of

    try:
        return input_of(source, progress)
    except InputError as error:
        if "--tool" not in str(error):
            raise InputError(without_options(str(error))) from error
        where = "Show its cut in NC (Ctrl+K), say there what it is, and come back."
        raise InputError(f"{without_options(str(error))} {where}") from error


def own_cut_of_ball(source: FilmSource, progress: Progress) -> CutFilmInput:
    """Return what a program cuts with a ball among its tools; on the worker's thread.

    Raises:
        HitofudeError: as `own_cut`; or no tool is a ball, then with where to choose one.
        Cancelled: the job was asked to stop.
    """
    from ....simulation.gpu.polyhedron import is_ball

    found = own_cut(source, progress)
    if not any(map(is_ball, found.cutters.values())):
        raise InputError(
            f"{source.name} has no ball cutter, and cylinders and wedges are the sweep of a ball. Choose one: Tools at "
            "the right of Draw; of a program that you opened, Tools and stock… at the right of its cut."
        )
    return found
