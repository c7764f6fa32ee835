"""A file that is named where an NC program belongs: kinds that are certainly none are told apart by their names."""

from __future__ import annotations

from pathlib import Path

from ..core.errors import InputError
from ..formats.readers import suffixes

_OTHERS = (".toml", ".stl", ".obj", ".3mf", ".step", ".stp", ".png", ".jpg", ".jpeg", ".bmp")
"""Suffixes of scenes, jobs, solids and pictures."""


def ensure_program(path: Path) -> None:
    """Refuse a drawing, a scene, a solid or a picture where a program is asked for.

    Its text would be read as blocks, and the first letter of it called a syntax error.

    Raises:
        InputError: saying what becomes a program of it.
    """
    suffix = path.suffix.lower()
    if suffix in suffixes():
        raise InputError(
            f"{path.name} is a drawing, and an NC program is asked for; write one with `hitofude make {path.name} -o "
            f"{path.stem}.ngc` and name that"
        )
    if suffix in _OTHERS:
        raise InputError(f"{path.name} is no NC program, which is asked for; name one, such as {path.stem}.ngc")
