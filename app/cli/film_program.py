"""An NC program of one's own that a film is made of, or that figure 11 is measured on."""

from __future__ import annotations

from pathlib import Path

from ..core.input_file import read_input
from ..exhibits.films.making import FilmSource
from ..model.part import Units
from ..usecases.examine import ExamineOptions


def program_source(path: Path, units: Units | None = None) -> FilmSource:
    """Return a program that a film is made of, or that figure 11 is measured on.

    Args:
        path: of its file. units: of a program that names none; None = mm.

    Raises:
        InputError: it is of another kind, or cannot be read.
    """
    return FilmSource(
        path.name, read_input(path), lambda name: read_input(path.parent / name), ExamineOptions(units=units)
    )
