"""What a file is by its name, where an NC program is asked for."""

from __future__ import annotations

from pathlib import PurePath

from ..core.errors import InputError

_USUAL = frozenset({"", ".ngc", ".nc", ".tap", ".gcode", ".txt", ".cnc", ".eia", ".iso", ".min", ".mpf"})
"""Suffixes of programs: with one of these nothing else need be known."""


def ensure_program(name: str) -> None:
    """Refuse a drawing, a picture, a solid or a scene, whose first letter would be called a syntax error.

    Args:
        name: of the file; what it holds is not looked at.

    Raises:
        InputError: it is no program, saying what becomes one of it.
    """
    if PurePath(name).suffix.lower() in _USUAL:
        return
    from ..formats.readers import known_format
    from .pixels.options import is_picture
    from .scene.solid_files import is_solid

    kinds = {
        "a drawing": known_format(name) is not None,
        "a picture": is_picture(name),
        "a solid": is_solid(name),
        "a scene or a job": name.lower().endswith(".toml"),
    }
    kind = next((kind for kind, so in kinds.items() if so), None)
    if kind is not None:
        raise InputError(
            f"{name} is {kind}, and an NC program is asked for: compute it, and take the program that comes of it."
        )
