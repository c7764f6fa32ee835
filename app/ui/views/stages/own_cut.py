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
